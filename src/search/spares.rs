//! Planes with spares: how many of their slots are vacant, and which ([M-64](crate::models#m-64)).

use crate::optimize::generator::Generator;

/// What is known of the satellites of planes with spares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SparedPlanes {
    /// Probability that a satellite is up, spares included, independently of the others.
    pub up: f64,
    /// Spares in the orbit of each plane, beside the satellites of its slots.
    pub spares: u32,
}

impl SparedPlanes {
    /// The probability that 0, 1, 2 … of the slots of a plane are vacant: of all satellites of the plane a binomial number is
    /// down, and the spares that are up fill vacant slots at once.
    #[must_use]
    pub fn vacancy_probabilities(&self, slots: usize) -> Vec<f64> {
        let satellites = slots + self.spares as usize;
        let (ln_up, ln_down) = (self.up.ln(), (-self.up).ln_1p());
        let mut ln_ways = 0.0;
        let mut vacancies = vec![0.0; slots + 1];
        for down in 0..=satellites {
            // 0 ln 0 is 0.
            let of = |count: usize, ln: f64| if count == 0 { 0.0 } else { count as f64 * ln };
            let probability = (ln_ways + of(satellites - down, ln_up) + of(down, ln_down)).exp();
            vacancies[down.saturating_sub(self.spares as usize)] += probability;
            ln_ways += ((satellites - down).max(1) as f64 / (down + 1) as f64).ln();
        }
        vacancies
    }

    /// The number of vacant slots that is expected of a plane.
    #[must_use]
    pub fn mean_vacancies(&self, slots: usize) -> f64 {
        let probabilities = self.vacancy_probabilities(slots).into_iter();
        probabilities
            .zip(0_u32..)
            .map(|(p, n)| p * f64::from(n))
            .sum()
    }

    /// Draws of the vacant slots of planes, each with the places of its satellites. The numbers of vacancies of each plane are
    /// stratified: one from each of as many parts of its distribution as there are draws, in random order. Which slots are
    /// vacant is drawn for each draw, all being equally likely.
    #[must_use]
    pub fn draws(&self, planes: &[Vec<usize>], draws: usize, seed: u64) -> Vec<Vec<usize>> {
        /// Apart from the streams of the optimisers, which count steps, and from that of the sets that fail together.
        const STREAM: u64 = 0x7370_6172;
        let mut generator = Generator::new(seed, STREAM);
        let mut sets = vec![Vec::new(); draws];
        for slots in planes {
            let probabilities = self.vacancy_probabilities(slots.len());
            let mut order: Vec<usize> = (0..draws).collect();
            shuffle(&mut order, &mut generator);
            for (set, part) in sets.iter_mut().zip(order) {
                let share = (part as f64 + generator.unit()) / draws as f64;
                let mut left = slots.clone();
                for _ in 0..quantile(&probabilities, share) {
                    set.push(left.swap_remove(generator.below(left.len())));
                }
            }
        }
        sets.iter_mut().for_each(|set| set.sort_unstable());
        sets
    }
}

/// The number that a share of the distribution reaches.
fn quantile(probabilities: &[f64], share: f64) -> usize {
    let mut reached = 0.0;
    let number = probabilities.iter().position(|probability| {
        reached += probability;
        share < reached
    });
    number.unwrap_or(probabilities.len() - 1)
}

/// Every order as likely (Fisher and Yates).
fn shuffle(order: &mut [usize], generator: &mut Generator) {
    for last in (1..order.len()).rev() {
        order.swap(last, generator.below(last + 1));
    }
}

#[cfg(test)]
mod tests;

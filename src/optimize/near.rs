//! The nearly feasible designs that a constrained search keeps as parents beside its population.
//!
//! By constraint domination every feasible design beats every infeasible one. Once a population is feasible, a design
//! that is better but for a small violation is lost at once, and the search reaches only what lies one step away:
//! with few satellites, for example, where feasible designs are a small island. So it remembers infeasible designs
//! whose objectives no feasible one matches, and draws some of its parents from them, after T. Ray, H. K. Singh,
//! A. Isaacs, W. Smith, "Infeasibility driven evolutionary algorithm for constrained optimization", in
//! Constraint-Handling in Evolutionary Optimization, Springer 2009. There they are a part of the population; here they
//! are beside it, so that they take no place from a feasible design.
//!
//! A search in which every design is feasible has none, and draws the same random numbers as without them.

use super::generator::Generator;
use super::problem::Individual;
use super::sorting::{non_dominated_sort, prune_one_by_one};

/// The chance that a parent is one of them, and their number as a share of the population: that of the infeasible
/// designs in the source.
const SHARE: f64 = 0.2;

/// The most that are kept beside a population.
pub(super) fn most(population: usize) -> usize {
    (SHARE * population as f64).ceil() as usize
}

/// Offers the designs of a generation; `population` is what was selected from it.
///
/// What is kept are designs that none of the others beats in its objectives and its violation together, then those
/// that only these beat, and so on, up to `most`.
pub(super) fn offer(
    near: &mut Vec<Individual>,
    found: impl IntoIterator<Item = Individual>,
    population: &[Individual],
    most: usize,
) {
    let is_new =
        |near: &[Individual], one: &Individual| near.iter().all(|a| a.genome != one.genome);
    for one in found {
        let has_values = one.objectives.iter().all(|value| value.is_finite());
        if !one.is_feasible() && has_values && is_new(near, &one) {
            near.push(one);
        }
    }
    near.retain(|one| !population.iter().any(|feasible| matches(feasible, one)));
    let points: Vec<Individual> = near.iter().map(with_violation).collect();
    let mut keep = vec![false; near.len()];
    let mut room = most;
    for front in non_dominated_sort(&points) {
        for member in prune_one_by_one(&points, &front, room) {
            keep[member] = true;
            room -= 1;
        }
    }
    let mut keep = keep.into_iter();
    near.retain(|_| keep.next().unwrap_or(false));
}

/// Whether a feasible design is as good as another one in every objective.
fn matches(feasible: &Individual, other: &Individual) -> bool {
    let pairs = feasible.objectives.iter().zip(&other.objectives);
    feasible.is_feasible() && pairs.into_iter().all(|(a, b)| a <= b)
}

/// The violation as one more objective.
fn with_violation(one: &Individual) -> Individual {
    let mut point = one.clone();
    point.objectives.push(one.violation);
    point.violation = 0.0;
    point
}

/// One of them as a parent, now and then: the less violated of two.
pub(super) fn parent<'a>(
    near: &'a [Individual],
    generator: &mut Generator,
) -> Option<&'a Individual> {
    if near.is_empty() || !generator.chance(SHARE) {
        return None;
    }
    let mut one = || &near[generator.below(near.len())];
    let (a, b) = (one(), one());
    Some(if b.violation < a.violation { b } else { a })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn individual(genome: f64, objectives: [f64; 2], violation: f64) -> Individual {
        Individual {
            genome: vec![genome],
            objectives: objectives.to_vec(),
            violation,
        }
    }

    /// What a feasible design matches in all objectives is of no use, nor what has no value; each genome is kept once.
    #[test]
    fn only_what_promises_more_than_the_feasible_is_kept() {
        let population = [
            individual(0.0, [2.0, 2.0], 0.0),
            individual(9.0, [0.0, 0.0], 3.0),
        ];
        let promising = individual(1.0, [1.0, 3.0], 0.5);
        let matched = individual(2.0, [2.0, 2.0], 0.1);
        let feasible = individual(3.0, [1.0, 1.0], 0.0);
        let without_value = individual(4.0, [0.0, f64::INFINITY], 0.1);
        let found = [
            promising.clone(),
            matched,
            feasible,
            without_value,
            promising.clone(),
        ];
        let mut near = Vec::new();
        offer(&mut near, found, &population, 9);
        assert_eq!(near, [promising]);
        // A new feasible design that is as good takes its place.
        offer(&mut near, [], &[individual(5.0, [1.0, 2.0], 0.0)], 9);
        assert_eq!(near, []);
    }

    /// The first are those that none beats in objectives and violation; there are no more than were asked for.
    #[test]
    fn the_least_violated_for_their_objectives_come_first() {
        let found = [
            individual(1.0, [1.0, 0.0], 5.0),
            individual(2.0, [2.0, 0.0], 1.0),
            individual(3.0, [2.0, 0.0], 2.0),
            individual(4.0, [1.0, 0.0], 6.0),
        ];
        for (most, genomes) in [(2, vec![1.0, 2.0]), (4, vec![1.0, 2.0, 3.0, 4.0])] {
            let mut near = Vec::new();
            offer(&mut near, found.clone(), &[], most);
            let kept: Vec<f64> = near.iter().map(|one| one.genome[0]).collect();
            assert_eq!(kept, genomes);
        }
        assert_eq!((most(60), most(30), most(1)), (12, 6, 1));
    }

    /// One parent of five, the less violated of two; none, and no random number, without them.
    #[test]
    fn some_parents_are_nearly_feasible() {
        let near = [
            individual(1.0, [0.0; 2], 1.0),
            individual(2.0, [0.0; 2], 2.0),
        ];
        let mut generator = Generator::new(1, 0);
        let mut counts = [0; 3];
        for _ in 0..10_000 {
            let place = parent(&near, &mut generator).map_or(0, |one| one.genome[0] as usize);
            counts[place] += 1;
        }
        // Five standard deviations of a count of 10 000: at most 250.
        for (count, expected) in counts.into_iter().zip([8000_i32, 1500, 500]) {
            assert!((expected - count).abs() < 250, "{counts:?}");
        }
        let mut untouched = Generator::new(1, 1);
        assert_eq!(parent(&[], &mut untouched), None);
        assert_eq!(untouched.unit(), Generator::new(1, 1).unit());
    }
}

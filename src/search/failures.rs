//! Sets of satellites that fail together: all of them, seeded draws, and a search for the worst.

use super::Quantity;
use crate::evaluate::Metrics;
use crate::optimize::generator::Generator;
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// Most sets that are all evaluated rather than drawn: all pairs of 45 satellites.
pub const ALL_UP_TO: usize = 1000;

/// How bad a value is. An unsolved sample is infinite: where one makes a quantity infinite, the unsolved share comes first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Harm {
    /// Share of the samples that are unsolved, if they make the quantity infinite.
    pub unsolved: f64,
    /// The value, larger being worse; infinite without one.
    pub value: f64,
}

impl Harm {
    /// The harm in the value of a quantity, among samples of which this fraction is solved.
    #[must_use]
    pub fn of(quantity: Quantity, value: Option<f64>, solved_fraction: f64) -> Self {
        Self {
            unsolved: quantity.unsolved_share(solved_fraction),
            value: value.map_or(f64::INFINITY, |value| quantity.minimised(value)),
        }
    }

    /// Whether an unsolved sample makes the value infinite.
    #[must_use]
    pub fn is_infinite(&self) -> bool {
        self.unsolved > 0.0 || self.value == f64::INFINITY
    }

    /// The order from harmless to bad.
    #[must_use]
    pub fn total_cmp(&self, other: &Self) -> Ordering {
        let by_unsolved = self.unsolved.total_cmp(&other.unsolved);
        by_unsolved.then(self.value.total_cmp(&other.value))
    }
}

/// How many sets of `k` of so many satellites there are, if they fit a count.
#[must_use]
pub fn set_count(satellites: usize, k: usize) -> Option<usize> {
    (0..k).try_fold(1_usize, |count, n| {
        Some(count.checked_mul(satellites.checked_sub(n)?)? / (n + 1))
    })
}

/// All sets of `k` satellites, in the order of their places.
#[must_use]
pub fn all_sets(satellites: usize, k: usize) -> Vec<Vec<usize>> {
    let mut sets = vec![Vec::new()];
    for _ in 0..k {
        let longer = |set: &Vec<usize>| {
            let first = set.last().map_or(0, |last| last + 1);
            let set = set.clone();
            (first..satellites).map(move |next| [&set[..], &[next]].concat())
        };
        sets = sets.iter().flat_map(longer).collect();
    }
    sets
}

/// Independent draws of `k` different satellites, all sets being equally likely.
#[must_use]
pub fn drawn_sets(satellites: usize, k: usize, draws: usize, seed: u64) -> Vec<Vec<usize>> {
    /// Apart from the streams of the optimisers, which count steps.
    const STREAM: u64 = 0x6661_696c;
    let mut generator = Generator::new(seed, STREAM);
    let mut draw = |_| {
        let mut set: Vec<usize> = Vec::with_capacity(k);
        while set.len() < k.min(satellites) {
            let next = generator.below(satellites);
            if !set.contains(&next) {
                set.push(next);
            }
        }
        set.sort_unstable();
        set
    };
    (0..draws).map(&mut draw).collect()
}

/// An evaluation without each of some sets of satellites, which may fail.
type SetEvaluation<'a, E> = Box<dyn FnMut(&[Vec<usize>]) -> Result<Vec<Metrics>, E> + 'a>;

/// Sets that were evaluated, each once.
pub struct FailureSearch<'a, E> {
    evaluate: SetEvaluation<'a, E>,
    known: BTreeMap<Vec<usize>, Metrics>,
    satellites: usize,
}

impl<'a, E> FailureSearch<'a, E> {
    /// With an evaluation of sets of places among so many satellites.
    pub fn new(
        satellites: usize,
        evaluate: impl FnMut(&[Vec<usize>]) -> Result<Vec<Metrics>, E> + 'a,
    ) -> Self {
        Self {
            evaluate: Box::new(evaluate),
            known: BTreeMap::new(),
            satellites,
        }
    }

    /// The metrics without each of some sets, which are in rising order each.
    ///
    /// # Errors
    /// If the evaluation fails.
    pub fn without(&mut self, sets: &[Vec<usize>]) -> Result<Vec<Metrics>, E> {
        let mut new: Vec<Vec<usize>> = sets.to_vec();
        new.retain(|set| !self.known.contains_key(set));
        new.sort_unstable();
        new.dedup();
        let metrics = (self.evaluate)(&new)?;
        self.known.extend(new.into_iter().zip(metrics));
        Ok(sets.iter().map(|set| self.known[set]).collect())
    }

    /// The sets of `k` satellites that were evaluated, in order.
    pub fn evaluated(&self, k: usize) -> impl Iterator<Item = (&Vec<usize>, &Metrics)> {
        self.known.iter().filter(move |(set, _)| set.len() == k)
    }

    /// Looks for the worst set of `k` satellites: the worst one, the worst second beside it and so on, then exchanges of one
    /// satellite as long as one makes it worse. What is found is the worst of these, and is not proved to be the worst of all.
    ///
    /// # Errors
    /// If the evaluation fails.
    pub fn search(&mut self, k: usize, harm: impl Fn(&Metrics) -> Harm) -> Result<Vec<usize>, E> {
        let mut best: Vec<usize> = Vec::new();
        for _ in 0..k {
            best = self.worst_beside(&best, &harm)?.0;
        }
        loop {
            let own = harm(&self.without(std::slice::from_ref(&best))?[0]);
            let mut exchanged = None;
            for place in 0..k {
                let mut rest = best.clone();
                rest.remove(place);
                let (set, found) = self.worst_beside(&rest, &harm)?;
                if found.total_cmp(&own) == Ordering::Greater {
                    exchanged = Some(set);
                    break;
                }
            }
            match exchanged {
                Some(set) => best = set,
                None => return Ok(best),
            }
        }
    }

    /// The worst set of some satellites and one more.
    fn worst_beside(
        &mut self,
        rest: &[usize],
        harm: &impl Fn(&Metrics) -> Harm,
    ) -> Result<(Vec<usize>, Harm), E> {
        let with = |next: usize| {
            let mut set = [rest, &[next]].concat();
            set.sort_unstable();
            set
        };
        let others = (0..self.satellites).filter(|place| !rest.contains(place));
        let sets: Vec<Vec<usize>> = others.map(with).collect();
        let harms: Vec<Harm> = self.without(&sets)?.iter().map(harm).collect();
        let mut worst = 0;
        for (number, harm) in harms.iter().enumerate() {
            if harm.total_cmp(&harms[worst]) == Ordering::Greater {
                worst = number;
            }
        }
        Ok((sets[worst].clone(), harms[worst]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::no_metrics;
    use std::collections::BTreeSet;
    use std::convert::Infallible;

    #[test]
    fn sets_are_all_and_different() {
        for (satellites, k) in [(5, 1), (7, 3), (4, 4), (3, 4)] {
            let sets = all_sets(satellites, k);
            assert_eq!(set_count(satellites, k), Some(sets.len()));
            assert_eq!(sets.iter().collect::<BTreeSet<_>>().len(), sets.len());
            assert!(
                sets.iter()
                    .all(|set| set.len() == k && set.is_sorted_by(|a, b| a < b))
            );
        }
        assert_eq!(set_count(40, 2), Some(780));
    }

    /// Each pair of five comes up with a tenth of the draws, within five standard deviations, and the seed decides.
    #[test]
    fn validate_draws_are_uniform() {
        let draws = drawn_sets(5, 2, 20_000, 7);
        let mut counts = BTreeMap::new();
        draws
            .iter()
            .for_each(|set| *counts.entry(set).or_insert(0.0) += 1.0);
        assert_eq!(counts.len(), 10);
        let deviation = (20_000.0_f64 * 0.1 * 0.9).sqrt();
        assert!(
            counts
                .values()
                .all(|count| (count - 2000.0_f64).abs() < 5.0 * deviation),
            "{counts:?}"
        );
        assert_eq!(draws, drawn_sets(5, 2, 20_000, 7));
        assert_ne!(draws[..9], drawn_sets(5, 2, 9, 8)[..]);
    }

    /// A harm of pairs that greed alone misses: the worst single is in no worst pair.
    #[test]
    fn exchanges_leave_what_greed_finds() {
        let harm = |set: &[usize]| match *set {
            [3] => 5.0,
            [_] => 1.0,
            [1, 3] => 6.0,
            [1, 4] => 7.0,
            [2, 4] => 9.0,
            _ => 2.0,
        };
        let evaluate = |sets: &[Vec<usize>]| {
            let of = |set: &Vec<usize>| Metrics {
                max_pdop: Some(harm(set)),
                solved_fraction: 1.0,
                ..no_metrics()
            };
            Ok::<_, Infallible>(sets.iter().map(of).collect())
        };
        let mut search = FailureSearch::new(6, evaluate);
        let of = |metrics: &Metrics| {
            Harm::of(Quantity::MaxPdop, metrics.max_pdop, metrics.solved_fraction)
        };
        assert_eq!(search.search(1, of).unwrap(), [3]);
        assert_eq!(search.search(2, of).unwrap(), [2, 4]);
        assert_eq!(search.evaluated(1).count(), 6);
    }

    #[test]
    fn unsolved_samples_are_worse_than_any_value() {
        let of = |value, solved| Harm::of(Quantity::CvarPdop, value, solved);
        let rising = [
            of(Some(3.0), 1.0),
            of(Some(90.0), 1.0),
            of(Some(2.0), 0.999),
            of(Some(2.5), 0.999),
            of(None, 0.0),
        ];
        assert!(rising.is_sorted_by(|a, b| a.total_cmp(b) == Ordering::Less));
        assert!(!rising[1].is_infinite() && rising[2].is_infinite());
        // A quantile of 95 % bears 5 % of unsolved samples, and more available is better.
        assert!(!Harm::of(Quantity::P95Pdop, Some(2.0), 0.96).is_infinite());
        let available = |share| Harm::of(Quantity::Availability, Some(share), 0.5);
        assert_eq!(available(0.9).total_cmp(&available(0.8)), Ordering::Less);
    }
}

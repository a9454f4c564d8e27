//! What is expected of satellites that are up with some probability, independently of each other ([M-57](crate::models#m-57)).
//!
//! Only the satellites that a sample sees matter to it: the sum goes over the subsets of these that are down, up to the number
//! beyond which the rest of the binomial distribution is negligible.

use super::mixture::StateDraws;
use super::pass::{Sets, Sighted, Worker};
use super::sight::SightTree;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Evaluator;
use crate::evaluate::counts::{COVERAGE_LEVELS, Coverage};
use crate::evaluate::fixed::PlainGnssSample;
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;
use thiserror::Error;

/// Probability of the states of a sample that may be left out.
pub const NEGLECTED: f64 = 1e-4;

/// Most states of all samples together: some minutes of work.
const MOST_STATES: f64 = 1e10;

/// Instants in a piece of work, whatever the number of threads, so that sums do not depend on it.
const PIECE: usize = 8;

/// Bits of an f64 that a bucket of PDOP ignores: a width of 1/4096.
const TRAILING_BITS: u32 = 40;

/// Least PDOP of a bucket: 2⁻⁷, below what any number of satellites gives.
const FIRST: u64 = (1023 - 7) << (52 - TRAILING_BITS);

/// The bucket of a PDOP.
pub(super) fn bucket_of(pdop: f64) -> usize {
    (pdop.to_bits() >> TRAILING_BITS).saturating_sub(FIRST) as usize
}

/// Metrics as expected over point, instant and state of the satellites.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ExpectedMetrics {
    /// Probability that a satellite is up.
    pub satellite_availability: f64,
    /// Mean visible LEO satellites.
    pub mean_visible: f64,
    /// Probability of at least n visible LEO satellites.
    pub coverage: Coverage,
    /// Probability that a sample is solved.
    pub solved_fraction: f64,
    /// Probability that a sample is solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Mean PDOP of the solved ones.
    pub mean_pdop: Option<f64>,
    /// 95 % quantile of their PDOP, to 1/4096 of its value.
    pub p95_pdop: Option<f64>,
    /// Conditional value-at-risk of their PDOP, likewise.
    pub cvar_pdop: Option<f64>,
    /// Largest probability of the states of a sample that are left out; their share counts as neither solved nor available.
    pub neglected: f64,
    /// If the states were drawn: how many, and what that leaves open.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub draws: Option<StateDraws>,
}

/// Why nothing can be said.
#[derive(Debug, Error)]
pub enum ExpectedError {
    /// A satellite cannot be propagated.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// So many satellites are in view, so often down, that their states are too many.
    #[error(
        "the states of the visible satellites are {states:.1e}, expected at most {MOST_STATES:.0e}: use fewer points or samples, a \
         higher reliability.availability, or the draws of --failures"
    )]
    TooMany {
        /// The states of all samples.
        states: f64,
    },
}

/// Probability that 0, 1, … n of n satellites are down, up to the number that leaves at most [`NEGLECTED`], and what is left.
fn down_probabilities(visible: usize, up: f64) -> (Vec<f64>, f64) {
    let (mut known, mut rest) = (Vec::new(), 1.0);
    let mut probability = up.powi(visible as i32);
    for down in 0..=visible {
        known.push(probability);
        rest -= probability;
        if rest <= NEGLECTED {
            break;
        }
        probability *= (visible - down) as f64 / (down + 1) as f64 * (1.0 - up) / up;
    }
    (known, rest.max(0.0))
}

/// Sums over states and samples, each sample with the weight of its point.
#[derive(Clone)]
struct ExpectedSums {
    weight: f64,
    visible: f64,
    coverage: [f64; COVERAGE_LEVELS],
    available: f64,
    /// Weight and weight times PDOP of the solved ones in each bucket.
    solved: Vec<(f64, f64)>,
    neglected: f64,
}

impl ExpectedSums {
    fn new() -> Self {
        Self {
            weight: 0.0,
            visible: 0.0,
            coverage: [0.0; COVERAGE_LEVELS],
            available: 0.0,
            solved: Vec::new(),
            neglected: 0.0,
        }
    }

    fn add_solved(&mut self, pdop: f64, weight: f64) {
        let bucket = bucket_of(pdop);
        if bucket >= self.solved.len() {
            self.solved.resize(bucket + 1, (0.0, 0.0));
        }
        self.solved[bucket].0 += weight;
        self.solved[bucket].1 += weight * pdop;
    }

    fn merge(&mut self, other: &Self) {
        self.weight += other.weight;
        self.visible += other.visible;
        self.available += other.available;
        self.neglected = self.neglected.max(other.neglected);
        for (mine, theirs) in self.coverage.iter_mut().zip(other.coverage) {
            *mine += theirs;
        }
        if self.solved.len() < other.solved.len() {
            self.solved.resize(other.solved.len(), (0.0, 0.0));
        }
        for (mine, theirs) in self.solved.iter_mut().zip(&other.solved) {
            mine.0 += theirs.0;
            mine.1 += theirs.1;
        }
    }

    fn metrics(&self, up: f64, level: f64) -> ExpectedMetrics {
        let solved: f64 = self.solved.iter().map(|(weight, _)| weight).sum();
        let sum: f64 = self.solved.iter().map(|(_, sum)| sum).sum();
        let [p95, cvar] = tail(&self.solved, level);
        ExpectedMetrics {
            satellite_availability: up,
            mean_visible: self.visible / self.weight,
            coverage: Coverage::from_shares(self.coverage.map(|share| share / self.weight)),
            solved_fraction: solved / self.weight,
            availability: self.available / self.weight,
            mean_pdop: (solved > 0.0).then(|| sum / solved),
            p95_pdop: p95,
            cvar_pdop: cvar,
            neglected: self.neglected,
            draws: None,
        }
    }
}

/// The 95 % quantile and the conditional value-at-risk of a distribution: weight, and weight times value, of each bucket.
pub(super) fn tail(buckets: &[(f64, f64)], level: f64) -> [Option<f64>; 2] {
    let all: f64 = buckets.iter().map(|(weight, _)| weight).sum();
    // The mean of the bucket that the weight from below reaches, and its number.
    let quantile = |level: f64| {
        let mut reached = 0.0;
        let wanted = level * all * (1.0 - 1e-12);
        let found = buckets.iter().enumerate().find(|(_, (weight, _))| {
            reached += weight;
            *weight > 0.0 && reached >= wanted
        });
        found.map(|(bucket, (weight, sum))| (bucket, sum / weight))
    };
    let cvar = quantile(level).map(|(bucket, value)| {
        let excess = buckets[bucket..].iter();
        let excess = excess.map(|(weight, sum)| (sum - weight * value).max(0.0));
        value + excess.sum::<f64>() / ((1.0 - level) * all)
    });
    [quantile(0.95).map(|(_, value)| value), cvar]
}

/// The states of one sample.
struct States<'a, 'w> {
    worker: &'a mut Worker<'w>,
    seen: &'a [Sighted],
    gnss: &'a PlainGnssSample,
    /// Probability of one state with so many satellites down.
    of_state: &'a [f64],
    weight: f64,
    available_up_to: f64,
    sums: &'a mut ExpectedSums,
}

impl States<'_, '_> {
    /// The states in which the satellites at `down` are down, and perhaps more from `first` on.
    fn visit(&mut self, down: &mut Vec<usize>, first: usize) {
        let weight = self.weight * self.of_state[down.len()];
        let pdop = self.worker.without(self.seen, down, self.gnss);
        if pdop.is_finite() {
            self.sums.add_solved(pdop, weight);
            self.sums.available += if pdop <= self.available_up_to {
                weight
            } else {
                0.0
            };
        }
        if down.len() + 1 < self.of_state.len() {
            for next in first..self.seen.len() {
                down.push(next);
                self.visit(down, next + 1);
                down.pop();
            }
        }
    }
}

impl Evaluator {
    /// What is expected if each satellite is up with some probability.
    ///
    /// # Errors
    /// If a satellite cannot be propagated, or the states are too many.
    pub fn expected(
        &self,
        ephemeris: &Ephemeris,
        up: f64,
    ) -> Result<ExpectedMetrics, ExpectedError> {
        let tree = SightTree::new(self.setup());
        let sets = Sets::new(self, ephemeris, &[]);
        let ranges = self.expected_pieces().into_par_iter();
        let states = ranges.map(|range| self.states(&tree, &sets, range, up));
        let states = states.collect::<Result<Vec<f64>, EphemerisError>>();
        let states: f64 = states?.iter().sum();
        if states > MOST_STATES {
            return Err(ExpectedError::TooMany { states });
        }
        Ok(self.expected_of_any(ephemeris, up)?)
    }

    /// The same for any number of states.
    pub(super) fn expected_of_any(
        &self,
        ephemeris: &Ephemeris,
        up: f64,
    ) -> Result<ExpectedMetrics, EphemerisError> {
        self.fixed()?;
        let tree = SightTree::new(self.setup());
        let sets = Sets::new(self, ephemeris, &[]);
        let ranges = self.expected_pieces().into_par_iter();
        let pieces = ranges.map(|range| self.expected_of(&tree, &sets, range, up));
        let mut all = ExpectedSums::new();
        let pieces = pieces.collect::<Result<Vec<ExpectedSums>, EphemerisError>>()?;
        pieces.iter().for_each(|piece| all.merge(piece));
        Ok(all.metrics(up, self.setup().metrics.cvar_level.get()))
    }

    fn expected_pieces(&self) -> Vec<Range<usize>> {
        let instants = self.setup().grid.len();
        let starts = (0..instants).step_by(PIECE);
        starts
            .map(|start| start..(start + PIECE).min(instants))
            .collect()
    }

    /// The number of states of some instants.
    fn states(
        &self,
        tree: &SightTree,
        sets: &Sets<'_>,
        range: Range<usize>,
        up: f64,
    ) -> Result<f64, EphemerisError> {
        let mut worker = Worker::new(self, tree, sets);
        let mut states = 0.0;
        for instant in range {
            worker.look(instant)?;
            for seen in worker.sky() {
                let most = down_probabilities(seen.len(), up).0.len();
                let mut sets_of_size = 1.0;
                for down in 0..most {
                    states += sets_of_size;
                    sets_of_size *= (seen.len() - down) as f64 / (down + 1) as f64;
                }
            }
        }
        Ok(states)
    }

    fn expected_of(
        &self,
        tree: &SightTree,
        sets: &Sets<'_>,
        range: Range<usize>,
        up: f64,
    ) -> Result<ExpectedSums, EphemerisError> {
        let fixed = self.fixed()?;
        let available_up_to = self.setup().metrics.availability_pdop;
        let mut worker = Worker::new(self, tree, sets);
        let mut sums = ExpectedSums::new();
        for instant in range {
            worker.look(instant)?;
            for (site, gnss) in fixed.at(instant).iter().enumerate() {
                let weight = self.weights.of(site) as f64;
                let seen = worker.take_sky(site);
                let (down, rest) = down_probabilities(seen.len(), up);
                sums.weight += weight;
                sums.visible += weight * up * seen.len() as f64;
                sums.neglected = sums.neglected.max(rest);
                add_coverage(&mut sums.coverage, seen.len(), up, weight);
                let mut sets_of_size = 1.0;
                let of_state = down.iter().enumerate().map(|(number, probability)| {
                    let each = probability / sets_of_size;
                    sets_of_size *= (seen.len() - number) as f64 / (number + 1) as f64;
                    each
                });
                let of_state: Vec<f64> = of_state.collect();
                worker.start(&seen, gnss);
                let mut states = States {
                    worker: &mut worker,
                    seen: &seen,
                    gnss,
                    of_state: &of_state,
                    weight,
                    available_up_to,
                    sums: &mut sums,
                };
                states.visit(&mut Vec::new(), 0);
                worker.give_sky(site, seen);
            }
        }
        Ok(sums)
    }
}

/// Adds the probability of at least 1, 2, … of the visible satellites being up, in closed form.
fn add_coverage(coverage: &mut [f64; COVERAGE_LEVELS], visible: usize, up: f64, weight: f64) {
    let mut exactly = (1.0 - up).powi(visible as i32);
    let mut fewer = 0.0;
    if up >= 1.0 {
        for share in coverage.iter_mut().take(visible) {
            *share += weight;
        }
        return;
    }
    for (n, share) in coverage.iter_mut().enumerate().take(visible) {
        fewer += exactly;
        *share += weight * (1.0 - fewer);
        exactly *= (visible - n) as f64 / (n + 1) as f64 * up / (1.0 - up);
    }
}

#[cfg(test)]
mod tests;

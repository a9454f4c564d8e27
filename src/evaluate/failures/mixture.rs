//! What is expected over states of the constellation that were drawn ([M-64](crate::models#m-64)).

use super::expected::{ExpectedMetrics, bucket_of, tail};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::counts::COVERAGE_LEVELS;
use crate::evaluate::kernel::SampleLosses;
use crate::evaluate::weights::WholeWeights;
use crate::evaluate::{Coverage, Evaluator, Metrics};
use serde::Serialize;

/// The states that were drawn.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct StateDraws {
    /// Number of draws.
    pub draws: usize,
    /// Standard error of the availability, as of independent draws.
    pub availability_standard_error: f64,
}

/// The PDOP of all samples in all states by its leading bits, as [`bucket_of`] counts them.
#[derive(Default)]
struct PooledPdop {
    /// Weight of the samples in each bucket, whole numbers so that what leaves a bucket leaves nothing behind.
    weights: Vec<i128>,
    /// Weight times PDOP.
    sums: Vec<f64>,
}

impl PooledPdop {
    /// Adds a sample of a weight some times, or takes it away.
    fn add(&mut self, pdop: f64, weight: u64, times: i32) {
        if !pdop.is_finite() {
            return;
        }
        let bucket = bucket_of(pdop);
        if bucket >= self.weights.len() {
            self.weights.resize(bucket + 1, 0);
            self.sums.resize(bucket + 1, 0.0);
        }
        self.weights[bucket] += i128::from(weight) * i128::from(times);
        self.sums[bucket] += weight as f64 * f64::from(times) * pdop;
    }

    /// Adds the samples of a pass in each of its states.
    fn add_pass(&mut self, weights: &WholeWeights, pieces: &[SampleLosses], states: usize) {
        for piece in pieces {
            for one in &piece.whole {
                self.add(one.pdop, weights.of(one.site as usize), states as i32);
            }
            for one in piece.changed.iter().flatten() {
                let whole = &piece.whole[(one.sample - piece.first) as usize];
                let weight = weights.of(whole.site as usize);
                self.add(whole.pdop, weight, -1);
                self.add(one.pdop, weight, 1);
            }
        }
    }

    /// Weight, and weight times PDOP, of each bucket.
    fn buckets(&self) -> Vec<(f64, f64)> {
        let pairs = self.weights.iter().zip(&self.sums);
        let pair = |(weight, sum): (&i128, &f64)| match weight {
            0 => (0.0, 0.0),
            _ => (*weight as f64, *sum),
        };
        pairs.map(pair).collect()
    }
}

impl Evaluator {
    /// What is expected over states that are equally likely, each given by the places of the satellites that are missing.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn expected_over(
        &self,
        ephemeris: &Ephemeris,
        up: f64,
        states: &[Vec<usize>],
    ) -> Result<ExpectedMetrics, EphemerisError> {
        let mut pooled = PooledPdop::default();
        let see = |pieces: &[SampleLosses], states: usize| {
            pooled.add_pass(&self.weights, pieces, states);
        };
        let each = self.without_each_seeing(ephemeris, states, see)?;
        let mean = |of: &dyn Fn(&Metrics) -> f64| -> f64 {
            each.iter().map(of).sum::<f64>() / each.len() as f64
        };
        let [p95_pdop, cvar_pdop] = tail(&pooled.buckets(), self.setup().metrics.cvar_level.get());
        let solved_fraction = mean(&|of| of.solved_fraction);
        let sum = mean(&|of| of.solved_fraction * of.mean_pdop.unwrap_or(0.0));
        let availability = mean(&|of| of.availability);
        let squares = mean(&|of| (of.availability - availability).powi(2));
        let coverage = |level: usize| mean(&|of| of.coverage.shares()[level]);
        Ok(ExpectedMetrics {
            satellite_availability: up,
            mean_visible: mean(&|of| of.mean_visible),
            coverage: Coverage::from_shares(std::array::from_fn::<f64, COVERAGE_LEVELS, _>(
                coverage,
            )),
            solved_fraction,
            availability,
            mean_pdop: (solved_fraction > 0.0).then(|| sum / solved_fraction),
            p95_pdop,
            cvar_pdop,
            neglected: 0.0,
            draws: Some(StateDraws {
                draws: each.len(),
                availability_standard_error: (squares / (each.len().max(2) - 1) as f64).sqrt(),
            }),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights and sums of a bucket are those of what was added and not taken away; an unsolved sample is in none.
    #[test]
    fn samples_are_pooled_by_bucket() {
        let mut pooled = PooledPdop::default();
        for (pdop, weight, times) in [
            (1.5, 2, 3),
            (4.0, 5, 1),
            (f64::INFINITY, 7, 1),
            (1.5, 2, -1),
            (2.5, 1, 1),
            (2.5, 1, -1),
        ] {
            pooled.add(pdop, weight, times);
        }
        let buckets = pooled.buckets();
        assert_eq!(buckets.len(), bucket_of(4.0) + 1);
        assert_eq!(buckets[bucket_of(1.5)], (4.0, 6.0));
        assert_eq!(buckets[bucket_of(4.0)], (5.0, 20.0));
        assert_eq!(buckets[bucket_of(2.5)], (0.0, 0.0));
        let whole: f64 = buckets.iter().map(|(weight, _)| weight).sum();
        assert_eq!(whole, 9.0);
    }
}

//! Metrics without some satellites, as evaluated anew, for many sets of satellites at once ([M-56](crate::models#m-56)).
//!
//! A satellite that fails changes only the samples that see it. Their sums are downdated instead of made anew; where
//! rounding of the difference could matter, they are made anew by the plain path. Everything is in f64.
//!
//! - [`sight`]: which satellites a point sees, by a tree of caps.
//! - [`pass`]: PDOP of all samples, and of those that change without each set.
//! - [`statistics`]: the metrics of each set, from those of the whole constellation and what changes.
//! - [`worst`]: the few metrics of each set that need no list of what changes.

mod by_point;
mod expected;
mod mixture;
mod one_lost;
mod pass;
mod sight;
mod statistics;
mod worst;

pub use by_point::PointOneLost;
pub use expected::{ExpectedError, ExpectedMetrics, NEGLECTED};
pub use mixture::StateDraws;
pub use one_lost::OneLost;

use super::kernel::{ChangedSample, SampleLosses};
use super::{Evaluator, Metrics};
use crate::ephemeris::{Ephemeris, EphemerisError};
use pass::Sets;
use rayon::prelude::*;
use sight::SightTree;
use statistics::{Scratch, Whole};

/// Memory of the samples that change without the sets of one pass, bytes.
const CHANGED_BYTES: usize = 512 << 20;

/// Largest share of the samples that see a satellite, as a multiple of the mean over the Earth: satellites dwell at the
/// latitude of their inclination.
const DWELL: f64 = 4.0;

impl Evaluator {
    /// The metrics without each of some sets of satellites, given by their places, as [`Evaluator::evaluate_plain`] finds
    /// them anew without the satellites; what is computed on demand is left out ([`Evaluator::with_further`]).
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    ///
    /// # Panics
    /// If a place is that of no satellite.
    pub fn without_each(
        &self,
        ephemeris: &Ephemeris,
        sets: &[Vec<usize>],
    ) -> Result<Vec<Metrics>, EphemerisError> {
        self.without_each_seeing(ephemeris, sets, |_, _| ())
    }

    /// The same, with a look at the samples of each pass.
    fn without_each_seeing(
        &self,
        ephemeris: &Ephemeris,
        sets: &[Vec<usize>],
        mut see: impl FnMut(&[SampleLosses], usize),
    ) -> Result<Vec<Metrics>, EphemerisError> {
        let tree = SightTree::new(self.setup());
        let mut found = Vec::with_capacity(sets.len());
        for batch in self.batches(ephemeris, sets)? {
            let sets = Sets::new(self, ephemeris, batch);
            let pieces = pass::pass(self, &tree, &sets)?;
            see(&pieces, batch.len());
            let whole = Whole::new(self, &pieces);
            let of = |scratch: &mut Scratch, number: usize| {
                let left = ephemeris.satellites().len() - batch[number].len();
                whole.without(number, left, scratch)
            };
            let numbers = (0..batch.len()).into_par_iter();
            let metrics = numbers.map_init(|| Scratch::new(&whole), of);
            found.extend(metrics.collect::<Vec<_>>());
        }
        Ok(found)
    }

    /// The metrics with what the setup asks for on demand: metres, windows, quantiles of HDOP and VDOP.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn with_further(
        &self,
        metrics: Metrics,
        ephemeris: &Ephemeris,
    ) -> Result<Metrics, EphemerisError> {
        let information = self.information_pdop(ephemeris)?;
        let metrics = metrics.with_on_demand(information, self.accuracy(ephemeris)?);
        if !self.setup().metrics.asks_for_hdop {
            return Ok(metrics);
        }
        let dops = self.dops_beside(&metrics, ephemeris)?;
        Ok(metrics.with_dops(&dops))
    }

    /// Whether there is anything of the kind.
    #[must_use]
    pub fn has_further(&self) -> bool {
        let setup = self.setup();
        setup.accuracy.is_some() || setup.window_s.is_some() || setup.metrics.asks_for_hdop
    }

    /// Sets whose changes fit in memory together.
    fn batches<'s>(
        &self,
        ephemeris: &Ephemeris,
        sets: &'s [Vec<usize>],
    ) -> Result<Vec<&'s [Vec<usize>]>, EphemerisError> {
        let setup = self.setup();
        let radii = ephemeris.satellites().iter().map(|satellite| {
            let state = ephemeris.state_or_gap(satellite, 0.0)?;
            Ok(state.map_or(f64::INFINITY, |state| state.position_km.km().norm()))
        });
        let largest = radii.collect::<Result<Vec<f64>, EphemerisError>>()?;
        let largest = largest.into_iter().fold(0.0, f64::max);
        let share = (DWELL * SightTree::new(setup).share_of_sphere(largest)).min(1.0);
        let seen_by_one = share * setup.sample_count() as f64;
        let of_set = |set: &Vec<usize>| {
            let samples = (seen_by_one * set.len() as f64).min(setup.sample_count() as f64);
            samples as usize * size_of::<ChangedSample>()
        };
        let (mut batches, mut first, mut bytes) = (Vec::new(), 0, 0);
        for (number, set) in sets.iter().enumerate() {
            if bytes > 0 && bytes + of_set(set) > CHANGED_BYTES {
                batches.push(&sets[first..number]);
                (first, bytes) = (number, 0);
            }
            bytes += of_set(set);
        }
        batches.push(&sets[first..]);
        Ok(batches)
    }
}

#[cfg(test)]
mod tests;

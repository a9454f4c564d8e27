//! The information of the observations in a window of time ([M-51](crate::models#m-51)).
//!
//! One position and, at each instant, clocks of their own: the contributions to the normal matrix of the position add up
//! over the instants. How far the lines of sight turn within the window is thereby part of the geometry.

use super::accuracy::SigmaSpread;
use super::kernel::WindowPdop;
use super::{Evaluator, plain};
use crate::dop::Geometry;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::stats::Weighted;
use serde::{Deserialize, Serialize};
use std::ops::AddAssign;

/// The PDOP of all observations in a window, over the points and the beginnings of the windows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InformationPdop {
    /// Mean over the solved windows; `None` if there are none.
    pub mean: Option<f64>,
    /// 95 % quantile over the solved windows.
    pub p95: Option<f64>,
    /// Conditional value-at-risk at the level of the metrics over the solved windows.
    pub cvar: Option<f64>,
    /// Fraction of the windows that are solved.
    pub solved_fraction: f64,
}

/// Lets a window that is a whole number of steps, up to rounding, end before its last instant.
const STEP_SLACK: f64 = 1e-9;

/// Instants in a window: every k·step < window, k from 0.
fn instants(window_s: f64, step_s: f64) -> usize {
    (window_s / step_s - STEP_SLACK).ceil().max(1.0) as usize
}

/// Memory of the windows of a point in so many instants, bytes.
pub(super) fn site_bytes(window_s: f64, step_s: f64, samples: usize) -> usize {
    let sliding = instants(window_s, step_s).saturating_mul(size_of::<Geometry>());
    sliding.saturating_add(samples * (size_of::<WindowPdop>() + size_of::<Weighted>()))
}

/// The sum over the last instants of some points, without subtraction, which would lose digits: a queue of two stacks.
#[derive(Clone, Default)]
pub(super) struct SlidingSum<S> {
    /// Sums from each instant of the older part to its end, the oldest last.
    older: Vec<S>,
    /// The newer part.
    newer: Vec<S>,
    newer_sum: S,
}

impl<S: Clone + Default + for<'a> AddAssign<&'a S>> SlidingSum<S> {
    /// Adds an instant and returns the sum over the last `count`, if there are as many.
    #[inline(always)]
    pub(super) fn push(&mut self, instant: S, count: usize) -> Option<S> {
        self.newer_sum += &instant;
        self.newer.push(instant);
        if self.older.len() + self.newer.len() < count {
            return None;
        }
        let mut sum = self.older.last().cloned().unwrap_or_default();
        sum += &self.newer_sum;
        if self.older.pop().is_none() {
            let mut running = S::default();
            while let Some(instant) = self.newer.pop() {
                running += &instant;
                self.older.push(running.clone());
            }
            self.older.pop();
            self.newer_sum = S::default();
        }
        Some(sum)
    }
}

/// The windows of all points, by their first instants and then by point.
struct Windows(Vec<WindowPdop>);

impl Windows {
    /// By the lanes, and where those leave a window open, all windows of its point by the plain path.
    fn new(
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
        count: usize,
    ) -> Result<Self, EphemerisError> {
        let mut all = Self(Vec::new());
        let take = |points: &[WindowPdop]| all.0.extend_from_slice(points);
        evaluator.kernel.windows(ephemeris, count, take)?;
        let points = evaluator.setup().sites.len();
        let mut is_open = vec![false; points];
        for (number, window) in all.0.iter().enumerate() {
            is_open[number % points] |= *window == WindowPdop::Open;
        }
        if is_open.contains(&true) {
            all.settle(evaluator, ephemeris, count, |site| is_open[site])?;
        }
        Ok(all)
    }

    /// Takes the windows of some points from the plain path.
    fn settle(
        &mut self,
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
        count: usize,
        is_wanted: impl Fn(usize) -> bool,
    ) -> Result<(), EphemerisError> {
        let setup = evaluator.setup();
        let points = setup.sites.len();
        let mut sums = vec![SlidingSum::<Geometry>::default(); points];
        plain::visit_geometries(evaluator, ephemeris, &is_wanted, |time, site, _, one| {
            if let Some(sum) = sums[site].push(one, count) {
                let pdop = sum.pdop(setup.pdop_cap);
                let first = time + 1 - count;
                self.0[first * points + site] =
                    pdop.map_or(WindowPdop::Unsolved, WindowPdop::Solved);
            }
        })
    }

    /// All by the plain path, the reference for the lanes.
    #[cfg(test)]
    fn plain(
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
        count: usize,
    ) -> Result<Self, EphemerisError> {
        let setup = evaluator.setup();
        let whole = (setup.grid.len() + 1).saturating_sub(count);
        let mut all = Self(vec![WindowPdop::Open; whole * setup.sites.len()]);
        all.settle(evaluator, ephemeris, count, |_| true)?;
        Ok(all)
    }

    /// PDOP of those that are solved, weighted by point.
    fn solved(&self, evaluator: &Evaluator) -> Vec<Weighted> {
        let points = evaluator.setup().sites.len();
        let numbered = self.0.iter().enumerate();
        let solved = numbered.filter_map(|(number, window)| match *window {
            WindowPdop::Solved(value) => Some(Weighted {
                value,
                weight: evaluator.weights.of(number % points) as f64,
            }),
            WindowPdop::Unsolved | WindowPdop::Open => None,
        });
        solved.collect()
    }

    fn statistics(&self, evaluator: &Evaluator) -> InformationPdop {
        let setup = evaluator.setup();
        let points = setup.sites.len();
        let weight = |site: usize| evaluator.weights.of(site) as f64;
        let total = (self.0.len() / points) as f64 * (0..points).map(weight).sum::<f64>();
        let mut pdop = self.solved(evaluator);
        let solved: f64 = pdop.iter().map(|window| window.weight).sum();
        let spread = SigmaSpread::of(&mut pdop, setup.metrics.cvar_level);
        InformationPdop {
            mean: spread.map(|one| one.mean),
            p95: spread.map(|one| one.p95),
            cvar: spread.map(|one| one.cvar),
            // A window longer than the span has no place in it.
            solved_fraction: if total > 0.0 { solved / total } else { 0.0 },
        }
    }
}

impl Evaluator {
    /// The PDOP of all observations in each window of the setup with some satellites; `None` without a window.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn information_pdop(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Option<InformationPdop>, EphemerisError> {
        let windows = self.windows(ephemeris)?;
        Ok(windows.map(|windows| windows.statistics(self)))
    }

    /// The PDOP of each window that is solved; `None` without a window.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn information_samples(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Option<Vec<Weighted>>, EphemerisError> {
        let windows = self.windows(ephemeris)?;
        Ok(windows.map(|windows| windows.solved(self)))
    }

    /// The PDOP of windows by the plain path, the reference for the lanes.
    #[cfg(test)]
    pub(super) fn information_pdop_plain(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<InformationPdop, EphemerisError> {
        let setup = self.setup();
        let count = instants(setup.window_s.unwrap_or(0.0), setup.grid.step_s());
        Ok(Windows::plain(self, ephemeris, count)?.statistics(self))
    }

    fn windows(&self, ephemeris: &Ephemeris) -> Result<Option<Windows>, EphemerisError> {
        let setup = self.setup();
        let count = setup.window_s.map(|s| instants(s, setup.grid.step_s()));
        let windows = count.map(|count| Windows::new(self, ephemeris, count));
        windows.transpose()
    }
}

#[cfg(test)]
mod tests;

//! The information of the observations in a window of time ([M-51](crate::models#m-51)), by the plain path.
//!
//! One position and, at each instant, clocks of their own: the contributions to the normal matrix of the position add up
//! over the instants. How far the lines of sight turn within the window is thereby part of the geometry.

use super::accuracy::SigmaSpread;
use super::{Evaluator, plain};
use crate::dop::Geometry;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::stats::Weighted;
use serde::{Deserialize, Serialize};

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

/// Memory of the windows of a point, bytes.
pub(super) fn site_bytes(window_s: f64, step_s: f64) -> usize {
    instants(window_s, step_s).saturating_mul(size_of::<Geometry>())
}

/// The sum over the last instants of one point, without subtraction, which would lose digits: a queue of two stacks.
#[derive(Clone, Default)]
struct SlidingSum {
    /// Sums from each instant of the older part to its end, the oldest last.
    older: Vec<Geometry>,
    /// The newer part.
    newer: Vec<Geometry>,
    newer_sum: Geometry,
}

impl SlidingSum {
    /// Adds an instant and returns the sum over the last `count`, if there are as many.
    fn push(&mut self, geometry: Geometry, count: usize) -> Option<Geometry> {
        self.newer.push(geometry);
        self.newer_sum += geometry;
        if self.older.len() + self.newer.len() < count {
            return None;
        }
        let mut sum = self.older.last().copied().unwrap_or_default();
        sum += self.newer_sum;
        if self.older.pop().is_none() {
            let mut running = Geometry::default();
            while let Some(geometry) = self.newer.pop() {
                running += geometry;
                self.older.push(running);
            }
            self.older.pop();
            self.newer_sum = Geometry::default();
        }
        Some(sum)
    }
}

/// The windows of all points.
#[derive(Default)]
struct Windows {
    /// PDOP of those that are solved.
    pdop: Vec<Weighted>,
    /// Weight of all.
    total: f64,
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
        let Some(Windows { mut pdop, total }) = self.windows(ephemeris)? else {
            return Ok(None);
        };
        let solved: f64 = pdop.iter().map(|window| window.weight).sum();
        let spread = SigmaSpread::of(&mut pdop, self.setup().metrics.cvar_level);
        Ok(Some(InformationPdop {
            mean: spread.map(|one| one.mean),
            p95: spread.map(|one| one.p95),
            cvar: spread.map(|one| one.cvar),
            // A window longer than the span has no place in it.
            solved_fraction: if total > 0.0 { solved / total } else { 0.0 },
        }))
    }

    /// The PDOP of each window that is solved; `None` without a window.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn information_samples(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Option<Vec<Weighted>>, EphemerisError> {
        Ok(self.windows(ephemeris)?.map(|windows| windows.pdop))
    }

    fn windows(&self, ephemeris: &Ephemeris) -> Result<Option<Windows>, EphemerisError> {
        let setup = self.setup();
        let Some(window_s) = setup.window_s else {
            return Ok(None);
        };
        let count = instants(window_s, setup.grid.step_s());
        let mut sums = vec![SlidingSum::default(); setup.sites.len()];
        let mut windows = Windows::default();
        plain::visit_geometries(self, ephemeris, |_, site, _, geometry| {
            let Some(sum) = sums[site].push(geometry, count) else {
                return;
            };
            let weight = self.weights.of(site) as f64;
            windows.total += weight;
            if let Some(value) = sum.pdop(setup.pdop_cap) {
                windows.pdop.push(Weighted { value, weight });
            }
        })?;
        Ok(Some(windows))
    }
}

#[cfg(test)]
mod tests;

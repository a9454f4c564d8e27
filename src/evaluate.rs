//! Designs and ephemerides to metrics.
//!
//! An [`Evaluator`] holds what does not depend on the design: the ground points, the sidereal
//! rotation of every sample and the geometry of the GNSS. It is immutable and can be shared by
//! threads; the result of a design does not depend on which thread computes it.

mod dops;
mod fixed;
mod metrics;
mod plain;
mod series;

pub use dops::{ClockDop, DopOptions, DopStatistics};
pub use metrics::{MetricOptions, Metrics};
pub use series::{EpochMetrics, PointMetrics, Series};

use crate::constellation::Design;
use crate::constellation::gnss::System;
use crate::dop::Clocks;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::ground::Site;
use crate::orbit::Model;
use crate::time::TimeGrid;
use crate::visibility::Mask;
use fixed::FixedGeometry;

/// Everything that an evaluation depends on, but for the design.
#[derive(Debug, Clone)]
pub struct Setup {
    /// Samples in time.
    pub grid: TimeGrid,
    /// Ground points.
    pub sites: Vec<Site>,
    /// Elevation mask of the LEO satellites.
    pub mask: Mask,
    /// Elevation mask of the GNSS satellites.
    pub gnss_mask: Mask,
    /// GNSS in view, each with a clock of its own if clocks are per system.
    pub gnss: Vec<System>,
    /// Clock states.
    pub clocks: Clocks,
    /// PDOP above which a sample counts as unsolved.
    pub pdop_cap: f64,
    /// Theory that flies the LEO design.
    pub model: Model,
    /// What is made of the samples.
    pub metrics: MetricOptions,
}

impl Setup {
    /// Points times samples.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        self.sites.len() * self.grid.len()
    }

    /// Whether all points count the same.
    #[must_use]
    pub fn has_equal_weights(&self) -> bool {
        let mut pairs = self.sites.windows(2);
        pairs.all(|pair| pair[0].weight == pair[1].weight)
    }

    /// Memory that an [`Evaluator`] and `threads` concurrent evaluations take, bytes.
    #[must_use]
    pub fn memory_bytes(&self, threads: usize) -> u64 {
        let samples = self.sample_count() as u64;
        let fixed = samples * size_of::<fixed::FixedSample>() as u64;
        let per_thread = samples * size_of::<f64>() as u64;
        fixed + per_thread * threads as u64
    }
}

/// Computes the metrics of designs under one [`Setup`].
pub struct Evaluator {
    setup: Setup,
    rotations: Vec<EarthRotation>,
    fixed: FixedGeometry,
}

impl Evaluator {
    /// Prepares everything that does not depend on the design.
    ///
    /// # Errors
    /// When a GNSS satellite cannot be propagated.
    pub fn new(setup: Setup) -> Result<Self, EphemerisError> {
        let epoch = setup.grid.epoch();
        let rotations: Vec<_> = setup
            .grid
            .iter()
            .map(|elapsed_s| EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)))
            .collect();
        let fixed = FixedGeometry::new(&setup, &rotations)?;
        Ok(Self {
            setup,
            rotations,
            fixed,
        })
    }

    /// What the evaluations depend on.
    #[must_use]
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The metrics of a design, flown by the model of the setup.
    ///
    /// # Errors
    /// When the model cannot fly a satellite of the design.
    pub fn design(&self, design: &Design) -> Result<Metrics, EphemerisError> {
        self.ephemeris(&Ephemeris::of_design(
            design,
            self.setup.model,
            self.setup.grid,
        )?)
    }

    /// The metrics of any satellites, on the grid of the setup.
    ///
    /// # Errors
    /// When a satellite cannot be propagated.
    pub fn ephemeris(&self, ephemeris: &Ephemeris) -> Result<Metrics, EphemerisError> {
        let satellites = ephemeris.satellites().len();
        let options = self.setup.metrics;
        if self.setup.has_equal_weights() {
            let samples = plain::evaluate(self, ephemeris)?;
            Ok(Metrics::from_samples(samples, options, satellites))
        } else {
            let samples = plain::evaluate_weighted(self, ephemeris)?;
            Ok(Metrics::from_weighted(samples, options, satellites))
        }
    }
}

#[cfg(test)]
mod tests;

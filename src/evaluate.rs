//! Designs and ephemerides to metrics.
//!
//! An [`Evaluator`] holds what does not depend on the design: the ground points, the sidereal
//! rotation of every sample and the geometry of the GNSS. It is immutable and can be shared by
//! threads; the result of a design does not depend on which thread computes it.

mod fixed;
mod kernel;
mod metrics;
mod plain;

pub use kernel::{InstructionSet, Retakes};
pub use metrics::{MetricOptions, Metrics};

use crate::constellation::Design;
use crate::constellation::gnss::Preset;
use crate::dop::Clocks;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::ground::Site;
use crate::orbit::Model;
use crate::time::TimeGrid;
use crate::visibility::Mask;
use kernel::Kernel;
use metrics::Evaluated;

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
    /// GNSS constellations in view, each one system.
    pub gnss: Vec<Preset>,
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

    /// Memory that an [`Evaluator`] and `threads` concurrent evaluations take, bytes; it does not
    /// grow beyond a limit with points times samples.
    #[must_use]
    pub fn memory_bytes(&self, threads: usize) -> u64 {
        kernel::memory_bytes(self, threads) as u64
    }
}

/// Computes the metrics of designs under one [`Setup`].
pub struct Evaluator {
    setup: Setup,
    rotations: Vec<EarthRotation>,
    kernel: Kernel,
}

impl Evaluator {
    /// Prepares everything that does not depend on the design.
    ///
    /// # Errors
    /// When a GNSS satellite cannot be propagated.
    pub fn new(setup: Setup) -> Result<Self, EphemerisError> {
        Self::with_instructions(setup, InstructionSet::detect())
    }

    /// Like [`Evaluator::new`], on a given instruction set. The results are the same to the bit;
    /// one that the processor lacks is replaced by [`InstructionSet::Baseline`].
    ///
    /// # Errors
    /// When a GNSS satellite cannot be propagated.
    pub fn with_instructions(
        setup: Setup,
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        let epoch = setup.grid.epoch();
        let rotations: Vec<_> = setup
            .grid
            .iter()
            .map(|elapsed_s| EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)))
            .collect();
        let kernel = Kernel::new(&setup, &rotations, instructions)?;
        Ok(Self {
            setup,
            rotations,
            kernel,
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
        Ok(self.design_counted(design)?.0)
    }

    /// The metrics of a design, and how many samples f32 could not hold.
    ///
    /// # Errors
    /// When the model cannot fly a satellite of the design.
    pub fn design_counted(&self, design: &Design) -> Result<(Metrics, Retakes), EphemerisError> {
        let ephemeris = Ephemeris::of_design(design, self.setup.model, self.setup.grid)?;
        let (evaluated, retakes) = self.kernel.evaluate(self, &ephemeris, Some(design))?;
        Ok((self.metrics(&evaluated, &ephemeris), retakes))
    }

    /// The metrics of any satellites, on the grid of the setup.
    ///
    /// # Errors
    /// When a satellite cannot be propagated.
    pub fn ephemeris(&self, ephemeris: &Ephemeris) -> Result<Metrics, EphemerisError> {
        let (evaluated, _) = self.kernel.evaluate(self, ephemeris, None)?;
        Ok(self.metrics(&evaluated, ephemeris))
    }

    /// The metrics of any satellites by the plain path, which the kernel is tested against: one
    /// sample after the other, in f64, and about twenty times slower.
    ///
    /// # Errors
    /// When a satellite cannot be propagated.
    pub fn plain(&self, ephemeris: &Ephemeris) -> Result<Metrics, EphemerisError> {
        let evaluated = plain::evaluate(self, ephemeris)?;
        Ok(self.metrics(&evaluated, ephemeris))
    }

    fn metrics(&self, evaluated: &Evaluated, ephemeris: &Ephemeris) -> Metrics {
        let satellites = ephemeris.satellites().len();
        Metrics::new(evaluated, self.setup.metrics, satellites)
    }
}

#[cfg(test)]
mod tests;

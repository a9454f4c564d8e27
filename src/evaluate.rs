//! From designs and ephemerides to metrics.
//!
//! An [`Evaluator`] has everything that does not depend on the design: the ground points, the sidereal
//! rotation of every instant and the geometry of the GNSS. It is immutable and can be shared between
//! threads; the result of a design does not depend on the thread.

mod accuracy;
mod counts;
mod dops;
mod failures;
mod fixed;
mod gain;
mod histograms;
mod kernel;
mod leo;
mod metrics;
mod on_demand;
mod outages;
mod phases;
mod plain;
mod probe;
mod series;
mod tiled;
mod weights;
mod window;

pub use accuracy::{Accuracy, AccuracyMetrics, RangeError, SigmaSpread};
pub use counts::{COVERAGE_COLUMNS, COVERAGE_LEVELS, COVERAGE_TOTAL_COLUMNS, Coverage};
pub use dops::{ClockDop, DopStatistics};
pub use failures::{ExpectedError, ExpectedMetrics, NEGLECTED, OneLost, PointOneLost, StateDraws};
pub use gain::Gain;
pub use histograms::{HistogramRow, ViewHistograms};
pub use kernel::{InstructionSet, Rechecks, SampleTile, SampleTiles};
pub use metrics::{MetricOptions, Metrics};
pub use on_demand::OnDemand;
pub use phases::PhaseError;
pub use series::{EpochMetrics, Outage, PointMetrics, SampleGrid, Series};
pub use tiled::{TileCounts, TileError};
pub use window::InformationPdop;

use crate::constellation::Design;
use crate::constellation::gnss::System;
use crate::dop::{Clocks, LeoClocks, ObservationWeights};
use crate::ephemeris::outages::SatelliteOutage;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::ground::{RegionMap, Site};
use crate::orbit::Model;
use crate::time::TimeGrid;
use crate::visibility::{Mask, MaskTable};
use fixed::FixedGeometry;
use histograms::ViewBins;
use kernel::Kernel;
use metrics::Evaluated;
use nalgebra::Vector3;
use std::sync::{Arc, OnceLock};
use weights::WholeWeights;

/// Everything that an evaluation depends on, except the design.
///
/// [`Setup::new`] takes the parameters without a default; the `with_` methods change the others.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Setup {
    /// Samples in time.
    pub grid: TimeGrid,
    /// Ground points.
    pub sites: Vec<Site>,
    /// What the points look like on a map; no result depends on it.
    pub map: RegionMap,
    /// Elevation mask of the LEO satellites.
    pub mask: Mask,
    /// Elevation mask of the GNSS satellites.
    pub gnss_mask: Mask,
    /// GNSS in view, each with its own clock if clocks are per system.
    pub gnss: Vec<System>,
    /// Clock states.
    pub clocks: Clocks,
    /// Clock states of the LEO satellites, if each system has its own.
    pub leo_clocks: LeoClocks,
    /// The weights of observations in least squares.
    pub observation_weights: ObservationWeights,
    /// PDOP above which a sample counts as unsolved.
    pub pdop_cap: f64,
    /// Theory that propagates the LEO design.
    pub model: Model,
    /// Parameters of the metrics.
    pub metrics: MetricOptions,
    /// Range errors, if the accuracy in metres is asked for.
    pub accuracy: Option<Accuracy>,
    /// Length of the windows whose information is asked for, seconds.
    pub window_s: Option<f64>,
    /// Satellites out of service, of the GNSS and of constellations.
    pub outages: Vec<SatelliteOutage>,
}

impl Setup {
    /// Samples in time and ground points, with the defaults of a scenario: 7° masks, one clock
    /// per system, unit weights, unsolved above a PDOP of 100 and secular J2; without GNSS.
    #[must_use]
    pub fn new(grid: TimeGrid, sites: Vec<Site>) -> Self {
        Self {
            grid,
            sites,
            map: RegionMap::default(),
            mask: Mask::default(),
            gnss_mask: Mask::default(),
            gnss: Vec::new(),
            clocks: Clocks::PerSystem,
            leo_clocks: LeoClocks::Shared,
            observation_weights: ObservationWeights::Unit,
            pdop_cap: 100.0,
            model: Model::J2,
            metrics: MetricOptions::default(),
            accuracy: None,
            window_s: None,
            outages: Vec::new(),
        }
    }

    /// What the points look like on a map.
    #[must_use]
    pub fn with_map(self, map: RegionMap) -> Self {
        Self { map, ..self }
    }

    /// One elevation mask for all satellites.
    #[must_use]
    pub fn with_mask(self, mask: Mask) -> Self {
        Self {
            mask,
            gnss_mask: mask,
            ..self
        }
    }

    /// A separate elevation mask for the GNSS satellites.
    #[must_use]
    pub fn with_gnss_mask(self, gnss_mask: Mask) -> Self {
        Self { gnss_mask, ..self }
    }

    /// The skyline of all points that have none of their own.
    #[must_use]
    pub fn with_skyline(mut self, skyline: MaskTable) -> Self {
        let skyline = Arc::new(skyline);
        for site in &mut self.sites {
            site.skyline.get_or_insert_with(|| Arc::clone(&skyline));
        }
        self
    }

    /// The skyline of a point, by its index: a mask by azimuth that every satellite must clear in addition.
    #[must_use]
    pub fn skyline_at(&self, point: usize) -> Option<&MaskTable> {
        self.sites.get(point)?.skyline.as_deref()
    }

    /// Whether any point has a skyline.
    #[must_use]
    pub fn has_skylines(&self) -> bool {
        self.sites.iter().any(|site| site.skyline.is_some())
    }

    /// The GNSS in view.
    #[must_use]
    pub fn with_gnss(self, gnss: Vec<System>) -> Self {
        Self { gnss, ..self }
    }

    /// The clock states.
    #[must_use]
    pub fn with_clocks(self, clocks: Clocks) -> Self {
        Self { clocks, ..self }
    }

    /// The clock states of the LEO satellites.
    #[must_use]
    pub fn with_leo_clocks(self, leo_clocks: LeoClocks) -> Self {
        Self { leo_clocks, ..self }
    }

    /// The weights of observations in least squares.
    #[must_use]
    pub fn with_observation_weights(self, observation_weights: ObservationWeights) -> Self {
        Self {
            observation_weights,
            ..self
        }
    }

    /// The PDOP above which a sample counts as unsolved.
    #[must_use]
    pub fn with_pdop_cap(self, pdop_cap: f64) -> Self {
        Self { pdop_cap, ..self }
    }

    /// The theory that propagates the LEO design.
    #[must_use]
    pub fn with_model(self, model: Model) -> Self {
        Self { model, ..self }
    }

    /// Parameters of the metrics.
    #[must_use]
    pub fn with_metrics(self, metrics: MetricOptions) -> Self {
        Self { metrics, ..self }
    }

    /// The range errors of all systems: the accuracy in metres is computed too.
    #[must_use]
    pub fn with_accuracy(self, accuracy: Accuracy) -> Self {
        Self {
            accuracy: Some(accuracy),
            ..self
        }
    }

    /// The length of windows, seconds: the PDOP of all observations in each is computed too.
    #[must_use]
    pub fn with_window_s(self, window_s: f64) -> Self {
        Self {
            window_s: Some(window_s),
            ..self
        }
    }

    /// Points times samples.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        self.sites.len() * self.grid.len()
    }

    /// Whether all points have the same weight.
    #[must_use]
    pub fn has_equal_weights(&self) -> bool {
        let mut pairs = self.sites.windows(2);
        pairs.all(|pair| pair[0].weight == pair[1].weight)
    }

    /// Maximum memory of an [`Evaluator`] and so many evaluations at a time on `threads` threads, bytes.
    #[must_use]
    pub fn memory_bytes(&self, threads: usize, evaluations: usize) -> u64 {
        let lanes = kernel::memory_bytes(self, threads, evaluations) as u64;
        // Several LEO clocks need the plain path once satellites are lost.
        let needs_plain = self.window_s.is_some() || self.may_have_several_leo_clocks();
        let plain = if needs_plain {
            self.plain_bytes(evaluations)
        } else {
            0
        };
        let metrics = lanes.saturating_add(plain);
        metrics.saturating_add(self.on_demand_bytes(evaluations))
    }

    /// Maximum memory of an [`Evaluator`] and a tile of time evaluated on `threads` threads, bytes.
    #[must_use]
    pub fn memory_of_tile_bytes(&self, threads: usize) -> u64 {
        kernel::memory_of_tile_bytes(self, threads) as u64
    }

    /// Memory of [`Evaluator::dops`] of one constellation in addition, bytes.
    #[must_use]
    pub fn dops_bytes(&self, threads: usize) -> u64 {
        kernel::dops_bytes(self, threads) as u64
    }

    /// Memory of [`Evaluator::series`] of one constellation in addition, bytes.
    #[must_use]
    pub fn series_bytes(&self) -> u64 {
        let samples = self.sample_count() as u64;
        samples * size_of::<f32>() as u64 + (self.grid.len() * size_of::<EpochMetrics>()) as u64
    }

    /// Of [`Setup::memory_bytes`], what is computed on demand.
    fn on_demand_bytes(&self, evaluations: usize) -> u64 {
        let samples = self.sample_count();
        let errors = self.accuracy.as_ref().map_or(0, |_| accuracy::SAMPLE_BYTES);
        let windows = self.window_s.map_or(0, |window_s| {
            let sums = window::site_bytes(window_s, self.grid.step_s(), self.grid.len());
            sums.saturating_mul(self.sites.len())
        });
        let each = samples.saturating_mul(errors).saturating_add(windows);
        let dops = match self.metrics.asks_for_hdop {
            true => self.dops_bytes(1).saturating_mul(evaluations as u64),
            false => 0,
        };
        dops.saturating_add(each.saturating_mul(evaluations) as u64)
    }

    /// Maximum number of clock states, with one LEO clock.
    fn clock_states(&self) -> usize {
        match self.clocks {
            Clocks::PerSystem => 1 + self.gnss.len(),
            Clocks::Shared => 1,
        }
    }

    /// Memory of the plain path.
    fn plain_bytes(&self, evaluations: usize) -> u64 {
        let samples = self.sample_count() as u64;
        let fixed = samples * size_of::<fixed::PlainGnssSample>() as u64;
        let each = samples * size_of::<crate::stats::Weighted>() as u64;
        fixed + each * evaluations as u64
    }

    /// The weight of an observation along a unit vector.
    fn observation_weight(&self, site: &Site, unit: Vector3<f64>) -> f64 {
        self.observation_weights.weight(unit.dot(&site.local.up))
    }
}

/// Computes the metrics of designs under one [`Setup`].
pub struct Evaluator {
    setup: Arc<Setup>,
    rotations: Arc<[EarthRotation]>,
    weights: WholeWeights,
    kernel: Kernel,
    /// For the plain path, created on first use, by one thread while others wait.
    fixed: OnceLock<Result<FixedGeometry, EphemerisError>>,
    /// The metrics of the GNSS alone, created on first use.
    gnss_only: OnceLock<(Metrics, ViewBins)>,
    /// The series of the GNSS alone, created on first use.
    gnss_series: OnceLock<Series>,
}

impl Evaluator {
    /// Prepares everything that does not depend on the design.
    ///
    /// # Errors
    /// If a GNSS satellite cannot be propagated.
    pub fn new(setup: Setup) -> Result<Self, EphemerisError> {
        Self::with_instructions(setup, InstructionSet::detect())
    }

    /// Like [`Evaluator::new`], on a given instruction set. The results are the same to the bit;
    /// one that the processor lacks is replaced by [`InstructionSet::Baseline`].
    ///
    /// # Errors
    /// If a GNSS satellite cannot be propagated.
    pub fn with_instructions(
        setup: Setup,
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        let epoch = setup.grid.epoch();
        let setup = Arc::new(setup);
        let rotations: Arc<[_]> = setup
            .grid
            .iter()
            .map(|elapsed_s| EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s)))
            .collect();
        let weights = WholeWeights::new(&setup);
        let kernel = Kernel::new(
            Arc::clone(&setup),
            &weights,
            Arc::clone(&rotations),
            instructions,
        )?;
        Ok(Self {
            setup,
            rotations,
            weights,
            kernel,
            fixed: OnceLock::new(),
            gnss_only: OnceLock::new(),
            gnss_series: OnceLock::new(),
        })
    }

    /// The setup of the evaluations.
    #[must_use]
    pub fn setup(&self) -> &Setup {
        &self.setup
    }

    /// The metrics of a design under the model of the setup.
    ///
    /// # Errors
    /// If the model cannot propagate a satellite of the design.
    pub fn evaluate(&self, design: &Design) -> Result<Metrics, EphemerisError> {
        Ok(self.evaluate_counted(design)?.0)
    }

    /// The metrics of a design, and how many samples were recomputed in f64.
    ///
    /// # Errors
    /// If the model cannot propagate a satellite of the design.
    pub fn evaluate_counted(&self, design: &Design) -> Result<(Metrics, Rechecks), EphemerisError> {
        let ephemeris = Ephemeris::of_design(design, self.setup.model, self.setup.grid)?;
        let (metrics, rechecks, _) = self.counted(&ephemeris, false)?;
        Ok((metrics, rechecks))
    }

    /// The metrics of some satellites, on the grid of the setup.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn evaluate_ephemeris(&self, ephemeris: &Ephemeris) -> Result<Metrics, EphemerisError> {
        Ok(self.counted(ephemeris, false)?.0)
    }

    /// The metrics of some satellites, and the histograms of the satellites in view.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn evaluate_views(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<(Metrics, ViewHistograms), EphemerisError> {
        let (metrics, _, bins) = self.counted(ephemeris, true)?;
        Ok((metrics, self.histograms(bins.unwrap_or_default())?))
    }

    /// The histograms of LEO satellites in view and of all, with those of the GNSS alone.
    fn histograms(&self, [leo, all]: [ViewBins; 2]) -> Result<ViewHistograms, EphemerisError> {
        let gnss = match self.gnss_alone()? {
            Some((_, gnss)) => gnss,
            None => &ViewBins::of_none(),
        };
        Ok(ViewHistograms::new(&leo, gnss, &all))
    }

    /// The metrics, the samples that were recomputed, and where asked for the satellites in view, LEO and all.
    fn counted(
        &self,
        ephemeris: &Ephemeris,
        histograms: bool,
    ) -> Result<(Metrics, Rechecks, Option<[ViewBins; 2]>), EphemerisError> {
        let (evaluated, rechecks) = self.kernel.evaluate(ephemeris, histograms)?;
        let mut metrics = self.metrics(&evaluated, ephemeris)?;
        metrics = self.with_failures(metrics, ephemeris)?;
        if self.setup.metrics.asks_for_hdop {
            let dops = self.dops_beside(&metrics, ephemeris)?;
            metrics = metrics.with_dops(&dops);
        }
        Ok((metrics, rechecks, evaluated.bins))
    }

    /// The metrics of some satellites by the plain path, the reference for the kernel: sample by sample in
    /// f64, and about twenty times slower.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn evaluate_plain(&self, ephemeris: &Ephemeris) -> Result<Metrics, EphemerisError> {
        let evaluated = plain::evaluate(self, ephemeris)?;
        self.metrics(&evaluated, ephemeris)
    }

    /// The GNSS part of the plain path.
    fn fixed(&self) -> Result<&FixedGeometry, EphemerisError> {
        let make = || FixedGeometry::new(&self.setup, &self.rotations);
        self.fixed.get_or_init(make).as_ref().map_err(Clone::clone)
    }

    fn metrics(
        &self,
        evaluated: &Evaluated,
        ephemeris: &Ephemeris,
    ) -> Result<Metrics, EphemerisError> {
        let satellites = ephemeris.satellites().len();
        let step_s = self.setup.grid.step_s();
        let metrics = Metrics::new(evaluated, self.setup.metrics, satellites, step_s);
        let information = self.information_pdop(ephemeris)?;
        Ok(metrics.with_on_demand(information, self.accuracy(ephemeris)?))
    }
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

//! Metrics per instant and per point, for figures and maps.

mod records;
mod samples;

pub use records::{EpochMetrics, Outage, PointMetrics};
pub use samples::SampleGrid;

use super::Evaluator;
use super::counts::{COVERAGE_LEVELS, Coverage, OutageRun, Outages, Threshold};
use super::histograms::{ViewBins, ViewHistograms};
#[cfg(test)]
use super::plain::{self, PlainSample};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::ground::Site;
use crate::stats::{Level, Weighted, quantile};

/// The cuts through the samples of an evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Instant by instant.
    pub epochs: Vec<EpochMetrics>,
    /// Point by point, in the order of the setup.
    pub points: Vec<PointMetrics>,
    /// Satellites in view over all samples.
    pub histograms: ViewHistograms,
    /// The outages of each point, with the number of instants and the step.
    outages: Vec<Vec<OutageRun>>,
    instants: u32,
    step_s: f64,
    /// PDOP of the solved instants of each point, and the weight of the point.
    solved: Vec<(Vec<f32>, f64)>,
}

impl Series {
    /// The outages of the point with this number, in the order of time.
    pub fn outages(&self, point: usize) -> impl Iterator<Item = Outage> {
        let runs = self.outages.get(point).into_iter().flatten();
        runs.map(|run| Outage {
            start_s: f64::from(run.first) * self.step_s,
            length_s: f64::from(run.samples) * self.step_s,
            is_cut: run.first == 0 || run.first + run.samples == self.instants,
        })
    }

    /// The same without what is of single samples.
    pub(super) fn without_samples(self) -> Self {
        Self {
            outages: Vec::new(),
            solved: Vec::new(),
            ..self
        }
    }

    /// Sets the gain over the series of the GNSS alone.
    fn with_gain_over(mut self, alone: &Self) -> Self {
        let gain = |alone: Option<f64>, own: Option<f64>| Some(alone? - own?);
        for (epoch, alone) in self.epochs.iter_mut().zip(&alone.epochs) {
            epoch.gain_mean_pdop = gain(alone.mean_pdop, epoch.mean_pdop);
        }
        for (point, alone) in self.points.iter_mut().zip(&alone.points) {
            point.gain_mean_pdop = gain(alone.mean_pdop, point.mean_pdop);
        }
        self
    }

    /// PDOP of every solved sample with the weight of its point, in ascending order.
    #[must_use]
    pub fn rising_pdop(&self) -> Vec<Weighted> {
        let of_point = |(pdop, weight): &(Vec<f32>, f64)| {
            let weight = *weight;
            let weighted = move |&value: &f32| Weighted {
                value: value.into(),
                weight,
            };
            pdop.iter().map(weighted).collect::<Vec<_>>()
        };
        let mut rising: Vec<_> = self.solved.iter().flat_map(of_point).collect();
        rising.sort_unstable_by(|a, b| a.value.total_cmp(&b.value));
        rising
    }
}

/// One point at one instant.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PointSample {
    /// Visible LEO satellites.
    pub(super) visible: u32,
    pub(super) gnss_visible: u32,
    /// PDOP, if solved, as [`Threshold::stored`].
    pub(super) pdop: Option<f32>,
}

/// All points at one instant.
#[derive(Debug, Clone)]
pub(super) struct Instant {
    /// Index into the grid.
    pub(super) number: usize,
    pub(super) points: Vec<PointSample>,
}

impl Instant {
    pub(super) fn new(points: usize) -> Self {
        Self {
            number: 0,
            points: vec![PointSample::default(); points],
        }
    }
}

/// Weighted sums over the points of one instant.
#[derive(Clone, Copy, Default)]
struct EpochSums {
    weight: f64,
    visible: f64,
    gnss_visible: f64,
    least_visible: Option<u32>,
    solved: f64,
    available: f64,
    pdop: f64,
    max: Option<f64>,
    leo_bins: [f64; COVERAGE_LEVELS + 1],
    all_bins: [f64; COVERAGE_LEVELS + 1],
}

/// Sums of one point over the instants.
#[derive(Clone, Default)]
struct PointSums {
    visible: u64,
    gnss_visible: u64,
    least_visible: Option<u32>,
    /// Of the solved instants.
    pdop: Vec<f32>,
    outages: Outages,
    runs: Vec<OutageRun>,
    leo_bins: [u32; COVERAGE_LEVELS + 1],
    all_bins: [u32; COVERAGE_LEVELS + 1],
}

impl Evaluator {
    /// The metrics of some satellites per instant and per point.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn series(&self, ephemeris: &Ephemeris) -> Result<Series, EphemerisError> {
        let series = self.cuts(ephemeris)?;
        let alone = self.gnss_series()?;
        Ok(match alone {
            Some(alone) => series.with_gain_over(alone),
            None => series,
        })
    }

    /// The same without gain.
    pub(super) fn cuts(&self, ephemeris: &Ephemeris) -> Result<Series, EphemerisError> {
        let mut cuts = SeriesSums::new(self);
        self.visit(ephemeris, |instant| cuts.add(instant))?;
        Ok(cuts.series())
    }

    /// Shows every instant, in the order of time.
    fn visit(
        &self,
        ephemeris: &Ephemeris,
        see: impl FnMut(&Instant),
    ) -> Result<(), EphemerisError> {
        self.kernel.visit(ephemeris, see)
    }

    /// The same by the plain path, the reference for the kernel.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    #[cfg(test)]
    pub(super) fn series_plain(&self, ephemeris: &Ephemeris) -> Result<Series, EphemerisError> {
        let mut cuts = SeriesSums::new(self);
        self.visit_plain(ephemeris, |instant| cuts.add(instant))?;
        Ok(cuts.series())
    }

    #[cfg(test)]
    fn visit_plain(
        &self,
        ephemeris: &Ephemeris,
        mut see: impl FnMut(&Instant),
    ) -> Result<(), EphemerisError> {
        let available = Threshold(self.setup().metrics.availability_pdop);
        let mut instant = Instant::new(self.setup().sites.len());
        plain::visit(self, ephemeris, |sample| {
            let PlainSample {
                site,
                visible,
                gnss_visible,
                pdop,
            } = sample;
            instant.points[site] = PointSample {
                visible,
                gnss_visible,
                pdop: pdop.map(|pdop| available.stored(pdop)),
            };
            if site + 1 == instant.points.len() {
                see(&instant);
                instant.number += 1;
            }
        })
    }
}

/// The cuts through the samples while they are made.
struct SeriesSums<'a> {
    evaluator: &'a Evaluator,
    available: f32,
    epochs: Vec<EpochMetrics>,
    points: Vec<PointSums>,
    /// LEO, GNSS and all.
    views: [ViewBins; 3],
}

impl<'a> SeriesSums<'a> {
    fn new(evaluator: &'a Evaluator) -> Self {
        let setup = evaluator.setup();
        Self {
            evaluator,
            available: Threshold(setup.metrics.availability_pdop).single(),
            epochs: Vec::with_capacity(setup.grid.len()),
            points: vec![PointSums::default(); setup.sites.len()],
            views: <[ViewBins; 3]>::default(),
        }
    }

    fn add(&mut self, instant: &Instant) {
        let setup = self.evaluator.setup();
        let mut epoch = EpochSums::default();
        let sums = self.points.iter_mut().enumerate();
        for (sample, (number, sums)) in instant.points.iter().zip(sums) {
            let is_available = sample.pdop.is_some_and(|pdop| pdop <= self.available);
            let weight = self.evaluator.weights.of(number);
            let (leo, gnss) = (sample.visible, sample.gnss_visible);
            for (views, visible) in self.views.iter_mut().zip([leo, gnss, leo + gnss]) {
                views.add(visible, weight);
            }
            epoch.add(sample, is_available, weight as f64);
            sums.add(sample, is_available);
        }
        let elapsed_s = setup.grid.elapsed_s(instant.number);
        self.epochs.push(epoch.metrics(elapsed_s));
    }

    fn series(self) -> Series {
        let setup = self.evaluator.setup();
        let (instants, step_s) = (setup.grid.len(), setup.grid.step_s());
        let mut scratch = Vec::with_capacity(instants);
        let sums = self.points.iter().zip(&setup.sites);
        let points = sums.map(|(sums, site)| sums.metrics(site, instants, step_s, &mut scratch));
        let points = points.collect();
        let weight = |number: usize| self.evaluator.weights.of(number) as f64;
        let [leo, gnss, all] = &self.views;
        let histograms = ViewHistograms::new(leo, gnss, all);
        let sums = self.points.into_iter().enumerate();
        let parts = sums.map(|(number, sums)| ((sums.pdop, weight(number)), sums.runs));
        let (solved, outages) = parts.unzip();
        Series {
            epochs: self.epochs,
            points,
            histograms,
            outages,
            instants: instants as u32,
            step_s,
            solved,
        }
    }
}

/// The bin of a number of satellites.
fn bin(visible: u32) -> usize {
    (visible as usize).min(COVERAGE_LEVELS)
}

/// The smaller of a number and what there may be already.
fn least(known: Option<u32>, number: u32) -> Option<u32> {
    Some(known.map_or(number, |known| known.min(number)))
}

impl EpochSums {
    fn add(&mut self, sample: &PointSample, is_available: bool, weight: f64) {
        self.weight += weight;
        self.visible += weight * f64::from(sample.visible);
        self.gnss_visible += weight * f64::from(sample.gnss_visible);
        self.least_visible = least(self.least_visible, sample.visible);
        self.leo_bins[bin(sample.visible)] += weight;
        self.all_bins[bin(sample.visible + sample.gnss_visible)] += weight;
        self.available += if is_available { weight } else { 0.0 };
        if let Some(pdop) = sample.pdop.map(f64::from) {
            self.solved += weight;
            self.pdop += weight * pdop;
            self.max = Some(self.max.map_or(pdop, |max| max.max(pdop)));
        }
    }

    fn metrics(&self, elapsed_s: f64) -> EpochMetrics {
        EpochMetrics {
            elapsed_s,
            mean_visible: self.visible / self.weight,
            mean_pdop: self.max.map(|_| self.pdop / self.solved),
            max_pdop: self.max,
            solved_fraction: self.solved / self.weight,
            availability: self.available / self.weight,
            least_visible: self.least_visible.unwrap_or(0),
            mean_gnss_visible: self.gnss_visible / self.weight,
            mean_total_visible: (self.visible + self.gnss_visible) / self.weight,
            gain_mean_pdop: None,
            coverage: Coverage::of_bins(&self.leo_bins, self.weight),
            coverage_total: Coverage::of_bins(&self.all_bins, self.weight),
        }
    }
}

impl PointSums {
    fn add(&mut self, sample: &PointSample, is_available: bool) {
        self.visible += u64::from(sample.visible);
        self.gnss_visible += u64::from(sample.gnss_visible);
        self.least_visible = least(self.least_visible, sample.visible);
        self.pdop.extend(sample.pdop);
        self.leo_bins[bin(sample.visible)] += 1;
        self.all_bins[bin(sample.visible + sample.gnss_visible)] += 1;
        let first = self.outages.samples;
        self.outages.add(!is_available);
        match (self.outages.last, self.runs.last_mut()) {
            (0, _) => {}
            (1, _) => self.runs.push(OutageRun { first, samples: 1 }),
            (samples, Some(run)) => run.samples = samples,
            (_, None) => {}
        }
    }

    /// `scratch` is memory for the values.
    fn metrics(
        &self,
        site: &Site,
        instants: usize,
        step_s: f64,
        scratch: &mut Vec<f64>,
    ) -> PointMetrics {
        let count = instants as f64;
        scratch.clear();
        scratch.extend(self.pdop.iter().map(|&pdop| f64::from(pdop)));
        let solved = scratch.len();
        let sum: f64 = scratch.iter().sum();
        let outages = self.outages;
        let p95 = Level::new(0.95).ok();
        let coverage =
            |bins: &[u32; COVERAGE_LEVELS + 1]| Coverage::of_bins(&bins.map(f64::from), count);
        PointMetrics {
            latitude_deg: site.latitude_deg,
            longitude_deg: site.longitude_deg,
            weight: site.weight,
            mean_visible: self.visible as f64 / count,
            mean_pdop: (solved > 0).then(|| sum / solved as f64),
            max_pdop: scratch.iter().copied().max_by(f64::total_cmp),
            p95_pdop: p95.and_then(|level| quantile(scratch, level)),
            solved_fraction: solved as f64 / count,
            availability: (count - f64::from(outages.total)) / count,
            least_visible: self.least_visible.unwrap_or(0),
            mean_gnss_visible: self.gnss_visible as f64 / count,
            mean_total_visible: (self.visible + self.gnss_visible) as f64 / count,
            outages: outages.number,
            longest_outage_s: f64::from(outages.longest) * step_s,
            total_outage_s: f64::from(outages.total) * step_s,
            outage_cut: outages.first + outages.last > 0,
            gain_mean_pdop: None,
            coverage: coverage(&self.leo_bins),
            coverage_total: coverage(&self.all_bins),
            name: site.name.clone(),
        }
    }
}

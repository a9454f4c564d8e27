//! Metrics per instant and per point, for figures and maps.

use super::Evaluator;
use super::counts::{Outages, Threshold};
use super::plain::{self, PlainSample};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::ground::Site;
use crate::stats::{Level, Weighted, quantile};
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// One instant, over all points with their weights ([M-31](crate::models#m-31)).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct EpochMetrics {
    /// Seconds since the epoch of the grid.
    pub elapsed_s: f64,
    /// Mean visible LEO satellites, equation (22) of the paper.
    pub mean_visible: f64,
    /// Mean PDOP over the solved points, equation (24); `None` if no point is solved.
    pub mean_pdop: Option<f64>,
    /// Maximum PDOP of a solved point: its maximum over time is equation (23).
    pub max_pdop: Option<f64>,
    /// Fraction of the points that are solved.
    pub solved_fraction: f64,
    /// Fraction of the points that are solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Least number of visible LEO satellites at any point.
    pub least_visible: u32,
    /// Mean visible GNSS satellites.
    pub mean_gnss_visible: f64,
    /// Mean visible satellites, LEO and GNSS.
    pub mean_total_visible: f64,
}

/// One point, over all instants.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PointMetrics {
    /// Latitude of the surface model, degrees.
    pub latitude_deg: f64,
    /// East longitude, degrees, as given.
    pub longitude_deg: f64,
    /// Mean visible LEO satellites.
    pub mean_visible: f64,
    /// Mean PDOP over the solved instants; `None` if there are none.
    pub mean_pdop: Option<f64>,
    /// 95 % quantile of PDOP over the solved instants.
    pub p95_pdop: Option<f64>,
    /// Maximum PDOP of a solved instant.
    pub max_pdop: Option<f64>,
    /// Fraction of the instants that are solved.
    pub solved_fraction: f64,
    /// Fraction of the instants that are solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Least number of visible LEO satellites at any instant.
    pub least_visible: u32,
    /// Mean visible GNSS satellites.
    pub mean_gnss_visible: f64,
    /// Mean visible satellites, LEO and GNSS.
    pub mean_total_visible: f64,
    /// Number of outages: runs of instants that are unsolved or above the availability threshold.
    pub outages: u32,
    /// Length of the longest outage, seconds: instants times the step.
    pub longest_outage_s: f64,
    /// Length of all outages together, seconds.
    pub total_outage_s: f64,
    /// Whether the start or the end of the span cuts an outage, which may be longer.
    pub outage_cut: bool,
    /// What the point is called, if anything.
    #[serde(serialize_with = "name")]
    pub name: Option<Arc<str>>,
}

fn name<S: Serializer>(name: &Option<Arc<str>>, serializer: S) -> Result<S::Ok, S::Error> {
    name.as_deref().serialize(serializer)
}

impl PointMetrics {
    /// How the point is called where it is shown: by its name, or else by its place.
    #[must_use]
    pub fn label(&self) -> String {
        match &self.name {
            Some(name) => name.to_string(),
            None => format!("{}°, {}°", self.latitude_deg, self.longitude_deg),
        }
    }
}

/// The cuts through the samples of an evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Instant by instant.
    pub epochs: Vec<EpochMetrics>,
    /// Point by point, in the order of the setup.
    pub points: Vec<PointMetrics>,
    /// PDOP of the solved instants of each point, and the weight of the point.
    solved: Vec<(Vec<f32>, f64)>,
}

impl Series {
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
}

impl Evaluator {
    /// The metrics of some satellites per instant and per point.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn series(&self, ephemeris: &Ephemeris) -> Result<Series, EphemerisError> {
        let mut cuts = SeriesSums::new(self);
        match self.kernel_for(ephemeris) {
            Some(kernel) => kernel.visit(ephemeris, |instant| cuts.add(instant))?,
            None => self.visit_plain(ephemeris, |instant| cuts.add(instant))?,
        }
        Ok(cuts.series())
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

    fn visit_plain(
        &self,
        ephemeris: &Ephemeris,
        mut see: impl FnMut(&Instant),
    ) -> Result<(), EphemerisError> {
        let available = Threshold(self.setup().metrics.availability_pdop);
        let mut instant = Instant::new(self.setup().sites.len());
        plain::visit(self, ephemeris, |sample| {
            let PlainSample {
                time,
                site,
                visible,
                gnss_visible,
                pdop,
            } = sample;
            instant.number = time;
            instant.points[site] = PointSample {
                visible,
                gnss_visible,
                pdop: pdop.map(|pdop| available.stored(pdop)),
            };
            if site + 1 == instant.points.len() {
                see(&instant);
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
}

impl<'a> SeriesSums<'a> {
    fn new(evaluator: &'a Evaluator) -> Self {
        let setup = evaluator.setup();
        Self {
            evaluator,
            available: Threshold(setup.metrics.availability_pdop).single(),
            epochs: Vec::with_capacity(setup.grid.len()),
            points: vec![PointSums::default(); setup.sites.len()],
        }
    }

    fn add(&mut self, instant: &Instant) {
        let setup = self.evaluator.setup();
        let mut epoch = EpochSums::default();
        let sums = self.points.iter_mut().enumerate();
        for (sample, (number, sums)) in instant.points.iter().zip(sums) {
            let is_available = sample.pdop.is_some_and(|pdop| pdop <= self.available);
            let weight = self.evaluator.weights.of(number) as f64;
            epoch.add(sample, is_available, weight);
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
        let sums = self.points.into_iter().enumerate();
        Series {
            epochs: self.epochs,
            points,
            solved: sums
                .map(|(number, sums)| (sums.pdop, weight(number)))
                .collect(),
        }
    }
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
        }
    }
}

impl PointSums {
    fn add(&mut self, sample: &PointSample, is_available: bool) {
        self.visible += u64::from(sample.visible);
        self.gnss_visible += u64::from(sample.gnss_visible);
        self.least_visible = least(self.least_visible, sample.visible);
        self.pdop.extend(sample.pdop);
        self.outages.add(!is_available);
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
        PointMetrics {
            latitude_deg: site.latitude_deg,
            longitude_deg: site.longitude_deg,
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
            name: site.name.clone(),
        }
    }
}

//! Metrics per instant and per point, for figures and maps.

use super::Evaluator;
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
    /// PDOP of every solved sample with the weight of its point, in ascending order.
    pub pdop: Vec<Weighted>,
}

/// Weighted sums over the points of one instant.
#[derive(Clone, Copy, Default)]
struct EpochSums {
    weight: f64,
    visible: f64,
    solved: f64,
    pdop: f64,
    max: Option<f64>,
}

/// Sums of one point over the instants.
#[derive(Clone, Default)]
struct PointSums {
    visible: u64,
    pdop: Vec<f64>,
}

impl Evaluator {
    /// The metrics of some satellites per instant and per point, by the plain path.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn series(&self, ephemeris: &Ephemeris) -> Result<Series, EphemerisError> {
        let setup = self.setup();
        let mut epochs = vec![EpochSums::default(); setup.grid.len()];
        let mut points = vec![PointSums::default(); setup.sites.len()];
        plain::visit(self, ephemeris, |sample| {
            epochs[sample.time].add(&sample, setup.sites[sample.site].weight);
            let point = &mut points[sample.site];
            point.visible += u64::from(sample.visible);
            point.pdop.extend(sample.pdop);
        })?;
        let elapsed = setup.grid.iter();
        let epochs = epochs.iter().zip(elapsed).map(|(sums, t)| sums.metrics(t));
        let mut pdop: Vec<Weighted> = points
            .iter()
            .zip(&setup.sites)
            .flat_map(|(sums, site)| {
                let weight = site.weight;
                sums.pdop
                    .iter()
                    .map(move |&value| Weighted { value, weight })
            })
            .collect();
        pdop.sort_unstable_by(|a, b| a.value.total_cmp(&b.value));
        let sites = setup.sites.iter();
        let points = points.into_iter().zip(sites).map(|(sums, site)| {
            sums.metrics(site, setup.grid.len(), setup.metrics.availability_pdop)
        });
        Ok(Series {
            epochs: epochs.collect(),
            points: points.collect(),
            pdop,
        })
    }
}

impl EpochSums {
    fn add(&mut self, sample: &PlainSample, weight: f64) {
        self.weight += weight;
        self.visible += weight * f64::from(sample.visible);
        if let Some(pdop) = sample.pdop {
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
        }
    }
}

impl PointSums {
    fn metrics(mut self, site: &Site, instants: usize, availability_pdop: f64) -> PointMetrics {
        let count = instants as f64;
        let solved = self.pdop.len();
        let sum: f64 = self.pdop.iter().sum();
        let available = self.pdop.iter().filter(|&&x| x <= availability_pdop);
        let available = available.count();
        let p95 = Level::new(0.95).ok();
        PointMetrics {
            latitude_deg: site.latitude_deg,
            longitude_deg: site.longitude_deg,
            mean_visible: self.visible as f64 / count,
            mean_pdop: (solved > 0).then(|| sum / solved as f64),
            p95_pdop: p95.and_then(|level| quantile(&mut self.pdop, level)),
            max_pdop: self.pdop.iter().copied().max_by(f64::total_cmp),
            solved_fraction: solved as f64 / count,
            availability: available as f64 / count,
            name: site.name.clone(),
        }
    }
}

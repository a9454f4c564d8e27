//! The accuracy of positions in metres, from a range error of each system ([M-49](crate::models#m-49) and
//! [M-50](crate::models#m-50)).

use super::fixed::{self, PlainPositions};
use super::kernel::RangeNormal;
use super::{Evaluator, Setup, leo};
use crate::dop::{ClockGroup, Clocks, Factor, Geometry};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthRotation, LocalFrame};
use crate::ground::Site;
use crate::stats::gaussian::length_exceeded_by;
use crate::stats::{Level, Weighted, weighted_cvar, weighted_mean, weighted_quantile};
use nalgebra::{Matrix2, Matrix3, Vector3};
use serde::{Deserialize, Serialize};

/// The share of the errors beyond a 95 % error.
const BEYOND: f64 = 0.05;

/// Share of the errors of the solved samples below which a length is not resolved: probabilities are good to 1e-10.
const LEAST_SHARE: f64 = 1e-8;

/// The error of the ranges to the satellites of a system: zero-mean, Gaussian and uncorrelated, with the standard
/// deviation sigma √(a² + b²/sin² E) at the elevation E.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RangeError {
    /// Standard deviation sigma, metres.
    pub sigma_m: f64,
    /// The part a that is the same at all elevations.
    pub constant: f64,
    /// The part b that grows towards the horizon.
    pub by_elevation: f64,
}

impl RangeError {
    /// An error that is the same at all elevations.
    #[must_use]
    pub fn constant(sigma_m: f64) -> Self {
        Self {
            sigma_m,
            constant: 1.0,
            by_elevation: 0.0,
        }
    }

    /// The weight 1/σ² of a range to a satellite whose elevation has this sine, 1/m²; 0 on the horizon if the error
    /// grows towards it.
    #[must_use]
    pub fn weight(&self, sin_elevation: f64) -> f64 {
        let [a2, b2] = [self.constant, self.by_elevation].map(|part| part * part);
        let sigma2 = self.sigma_m * self.sigma_m;
        if b2 == 0.0 {
            return 1.0 / (sigma2 * a2);
        }
        let sin2 = sin_elevation * sin_elevation;
        sin2 / (sigma2 * (a2 * sin2 + b2))
    }
}

/// The range errors of all systems of a setup.
#[derive(Debug, Clone, PartialEq)]
pub struct Accuracy {
    /// Of the LEO satellites.
    pub leo: RangeError,
    /// Of each GNSS, in the order of the setup; a system beyond the list has no part in the position.
    pub gnss: Vec<RangeError>,
}

/// Statistics of a standard deviation over the solved samples, weighted by point, metres.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SigmaSpread {
    /// Mean.
    pub mean: f64,
    /// 95 % quantile.
    pub p95: f64,
    /// Conditional value-at-risk at the level of the metrics.
    pub cvar: f64,
}

impl SigmaSpread {
    /// The statistics of a sample; `None` if it is empty. Reorders `sample`.
    pub(super) fn of(sample: &mut [Weighted], level: Level) -> Option<Self> {
        Some(Self {
            mean: weighted_mean(sample)?,
            p95: weighted_quantile(sample, Level::new(0.95).ok()?)?,
            cvar: weighted_cvar(sample, level)?,
        })
    }
}

/// The accuracy of positions.
///
/// A sample has an accuracy if its PDOP is solved and the geometry with the weights of the range errors is not singular.
/// Standard deviations are over those samples and `None` if there are none. An error is over all samples, where one
/// without accuracy exceeds any length: it is `None` if those are 5 % or more.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AccuracyMetrics {
    /// Fraction of the samples that have an accuracy.
    pub solved_fraction: f64,
    /// Standard deviation of the position.
    pub sigma_3d_m: Option<SigmaSpread>,
    /// Standard deviation of the horizontal position (DRMS).
    pub sigma_h_m: Option<SigmaSpread>,
    /// Standard deviation of the height.
    pub sigma_v_m: Option<SigmaSpread>,
    /// Length that 5 % of the position errors exceed.
    pub error95_3d_m: Option<f64>,
    /// Length that 5 % of the horizontal errors exceed.
    pub error95_h_m: Option<f64>,
    /// Length that 5 % of the height errors exceed.
    pub error95_v_m: Option<f64>,
}

/// The principal variances of the error of one sample, m², with the weight of its point.
#[derive(Default)]
struct Errors {
    whole: Vec<(f64, [f64; 3])>,
    horizontal: Vec<(f64, [f64; 2])>,
    vertical: Vec<(f64, [f64; 1])>,
    /// Weight of the samples that have an accuracy, and of all.
    solved: f64,
    total: f64,
}

/// Memory of one sample, bytes.
pub(super) const SAMPLE_BYTES: usize =
    size_of::<(f64, [f64; 3])>() + size_of::<(f64, [f64; 2])>() + size_of::<(f64, [f64; 1])>();

impl Evaluator {
    /// The accuracy of positions with some satellites and the GNSS of the setup, under its range errors; `None` without.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn accuracy(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Option<AccuracyMetrics>, EphemerisError> {
        let level = self.setup().metrics.cvar_level;
        let errors = self.position_errors(ephemeris)?;
        Ok(errors.map(|errors| errors.metrics(level)))
    }

    /// The standard deviation of the position, of the horizontal position and of the height of each sample that has an
    /// accuracy, metres; `None` without range errors.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn sigma_samples(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Option<[Vec<Weighted>; 3]>, EphemerisError> {
        let errors = self.position_errors(ephemeris)?;
        Ok(errors.map(|errors| {
            let Errors {
                whole,
                horizontal,
                vertical,
                ..
            } = &errors;
            [sigmas(whole), sigmas(horizontal), sigmas(vertical)]
        }))
    }

    /// The errors of the positions of all samples; `None` without range errors.
    fn position_errors(&self, ephemeris: &Ephemeris) -> Result<Option<Errors>, EphemerisError> {
        let setup = self.setup();
        let Some(accuracy) = &setup.accuracy else {
            return Ok(None);
        };
        let mut errors = Errors::default();
        let systems = fixed::systems(setup);
        self.kernel.range_normals(ephemeris, accuracy, |instant| {
            let is_open = |normal: &RangeNormal| matches!(normal, RangeNormal::Open);
            let skies = match instant.points.iter().any(is_open) {
                true => Skies::new(
                    self,
                    ephemeris,
                    &systems,
                    instant.elapsed_s,
                    instant.rotation,
                )?,
                false => Skies::default(),
            };
            for (number, normal) in instant.points.iter().enumerate() {
                let factor = match normal {
                    RangeNormal::Unsolved => None,
                    RangeNormal::Solved(factor) => Some(*factor),
                    RangeNormal::Open => skies.solve(setup, accuracy, number),
                };
                errors.add_sample(self, number, factor);
            }
            Ok(())
        })?;
        Ok(Some(errors))
    }

    /// The same by the plain path, the reference for the kernel.
    #[cfg(test)]
    fn position_errors_plain(
        &self,
        ephemeris: &Ephemeris,
        accuracy: &Accuracy,
    ) -> Result<Errors, EphemerisError> {
        let setup = self.setup();
        let mut errors = Errors::default();
        let systems = fixed::systems(setup);
        for (elapsed_s, &rotation) in setup.grid.iter().zip(self.rotations.iter()) {
            let skies = Skies::new(self, ephemeris, &systems, elapsed_s, rotation)?;
            for number in 0..setup.sites.len() {
                errors.add_sample(self, number, skies.solve(setup, accuracy, number));
            }
        }
        Ok(errors)
    }
}

/// The satellites at one instant by the plain path.
#[derive(Default)]
struct Skies {
    clocks: Vec<PlainPositions>,
    gnss: Vec<PlainPositions>,
}

impl Skies {
    fn new(
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
        systems: &[Ephemeris],
        elapsed_s: f64,
        rotation: EarthRotation,
    ) -> Result<Self, EphemerisError> {
        let mut clocks = Vec::new();
        leo::positions(
            evaluator.setup(),
            ephemeris,
            elapsed_s,
            rotation,
            &mut clocks,
        )?;
        let gnss = fixed::positions(systems, elapsed_s, rotation)?;
        Ok(Self { clocks, gnss })
    }

    /// The factor of the normal matrix of a point by range errors, where the PDOP is solved.
    fn solve(&self, setup: &Setup, accuracy: &Accuracy, number: usize) -> Option<Factor> {
        let site = &setup.sites[number];
        Sky::new(setup, accuracy, site, &self.clocks, &self.gnss).solve(setup)
    }
}

/// The observations at one point and instant by clock, each with its weight in the DOPs and by its range error.
struct Sky {
    dop: Geometry,
    metres: Geometry,
}

/// A clock group with the weights of the DOPs, and one with those of the range errors.
type DualGroup = [ClockGroup; 2];

impl Sky {
    fn new(
        setup: &Setup,
        accuracy: &Accuracy,
        site: &Site,
        leo: &[PlainPositions],
        gnss: &[PlainPositions],
    ) -> Self {
        let observe = |mask, error: Option<&RangeError>, positions: &PlainPositions| -> DualGroup {
            let mut pair = DualGroup::default();
            for &position in positions {
                if let Some(unit) = site.line_of_sight(mask, position) {
                    let metres = error.map_or(0.0, |error| error.weight(unit.dot(&site.local.up)));
                    pair[0].add(unit, setup.observation_weight(site, unit));
                    pair[1].add(unit, metres);
                }
            }
            pair
        };
        let mut geometries = [Geometry::default(); 2];
        let mut shared = DualGroup::default();
        // The order of the sums is that of the plain path, so that the same samples are solved.
        for (n, positions) in gnss.iter().enumerate() {
            let pair = observe(setup.gnss_mask, accuracy.gnss.get(n), positions);
            for (n, group) in pair.into_iter().enumerate() {
                match setup.clocks {
                    Clocks::PerSystem => geometries[n].add(&group),
                    Clocks::Shared => shared[n] += group,
                }
            }
        }
        for positions in leo {
            let pair = observe(setup.mask, Some(&accuracy.leo), positions);
            for (n, mut group) in pair.into_iter().enumerate() {
                group += std::mem::take(&mut shared[n]);
                geometries[n].add(&group);
            }
        }
        let [dop, metres] = geometries;
        Self { dop, metres }
    }

    /// The factor of the normal matrix by range errors, where the PDOP is solved.
    fn solve(&self, setup: &Setup) -> Option<Factor> {
        self.dop.solve(setup.pdop_cap)?;
        Some(self.metres.solve(f64::INFINITY)?.factor)
    }
}

impl Errors {
    /// Adds the next sample of a point, with the factor of its normal matrix if it has an accuracy.
    fn add_sample(&mut self, evaluator: &Evaluator, number: usize, factor: Option<Factor>) {
        let weight = evaluator.weights.of(number) as f64;
        self.total += weight;
        if let Some(factor) = factor {
            self.add(&factor, &evaluator.setup().sites[number].local, weight);
        }
    }

    fn add(&mut self, factor: &Factor, site: &LocalFrame, weight: f64) {
        let [east, north, up] = [site.east, site.north, site.up];
        let columns = [east, north, up].map(|axis| factor.solve(axis));
        let element = |axis: &Vector3<f64>, column: usize| axis.dot(&columns[column]);
        let [ee, en, eu] = [0, 1, 2].map(|column| element(&east, column));
        let [nn, nu, uu] = [element(&north, 1), element(&north, 2), element(&up, 2)];
        let whole = Matrix3::new(ee, en, eu, en, nn, nu, eu, nu, uu).symmetric_eigenvalues();
        let plane = Matrix2::new(ee, en, en, nn).symmetric_eigenvalues();
        // Rounding may leave a variance of 0 below it.
        let variance = |value: f64| value.max(0.0);
        self.whole
            .push((weight, [whole.x, whole.y, whole.z].map(variance)));
        self.horizontal
            .push((weight, [plane.x, plane.y].map(variance)));
        self.vertical.push((weight, [variance(uu)]));
        self.solved += weight;
    }

    /// The length that 5 % of the errors of all samples exceed, where a sample without accuracy exceeds any.
    fn exceeded<const D: usize>(&self, errors: &[(f64, [f64; D])]) -> Option<f64> {
        let share = (BEYOND * self.total - (self.total - self.solved)) / self.solved;
        (share > LEAST_SHARE).then(|| length_exceeded_by(share, errors))?
    }

    fn metrics(&self, level: Level) -> AccuracyMetrics {
        AccuracyMetrics {
            solved_fraction: self.solved / self.total,
            sigma_3d_m: sigma(&self.whole, level),
            sigma_h_m: sigma(&self.horizontal, level),
            sigma_v_m: sigma(&self.vertical, level),
            error95_3d_m: self.exceeded(&self.whole),
            error95_h_m: self.exceeded(&self.horizontal),
            error95_v_m: self.exceeded(&self.vertical),
        }
    }
}

fn sigma<const D: usize>(errors: &[(f64, [f64; D])], level: Level) -> Option<SigmaSpread> {
    SigmaSpread::of(&mut sigmas(errors), level)
}

/// The standard deviation of each sample.
fn sigmas<const D: usize>(errors: &[(f64, [f64; D])]) -> Vec<Weighted> {
    let one = |&(weight, variances): &(f64, [f64; D])| Weighted {
        value: variances.iter().sum::<f64>().sqrt(),
        weight,
    };
    errors.iter().map(one).collect()
}

#[cfg(test)]
mod tests;

//! Products of an export, read back and evaluated again under the scenario.
//!
//! A file is compared with the design under the theory of the file: states and mean elements with the
//! propagated design, element sets with SGP4 from the unrounded sets. Only the digits of a format can
//! therefore cause a difference, and the gates follow from them; the distance between SGP4 and the model
//! of the study is reported separately. A satellite displaced by d km moves its footprint by as much; at
//! 400 km the footprint's radius is 1600 km and its relative area changes by less than d/500 km, which
//! bounds mean visible, and the geometry changes by d over the range, 400 km or more.

pub(crate) mod gates;

use crate::constellation::{Design, Satellite, Shell};
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::evaluate::{Evaluator, Metrics};
use crate::exchange::import::{Fleet, FleetError};
use crate::formats::element_set;
use crate::formats::metadata::{ElementChoice, IdentityError, Object};
use crate::orbit::Model;
use crate::orbit::j2::SecularOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Orbit};
use crate::time::Epoch;
use gates::Extent;
use thiserror::Error;

pub use gates::{Grouping, ReadBack, ReadBackTheory};

/// SGP4 relative to a theory with J2 only, km: the frozen eccentricity of J3 (at most 8.1 km radial,
/// 16.2 km in-track), and the short-period terms and shift of the radius (1.75 J2 Re²/a,
/// 10.6 km at most); [M-40](crate::models#m-40) to [M-42](crate::models#m-42).
const SGP4_KM: f64 = 30.0;

/// Second-order secular in-track terms, km/day: 14 J2² (Re/a)⁴ n a at most
/// ([M-43](crate::models#m-43)).
const SGP4_KM_PER_DAY: f64 = 8.0;

/// Position error, km, below which mean visible or PDOP changes by less than 100 %.
const SCALE_KM: f64 = 500.0;

/// Satellites that may cross the mask at a sample by rounding only.
const FLIPS: f64 = 5.0;

/// Why a product cannot be checked.
#[derive(Debug, Error)]
pub enum RecheckError {
    /// The satellites of the file do not propagate the study.
    #[error(transparent)]
    Fleet(#[from] FleetError),
    /// A satellite has no state.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// A satellite cannot be named.
    #[error(transparent)]
    Identity(#[from] IdentityError),
    /// The satellites are not those of the design.
    #[error("{found} satellites were read back; the design has {expected}")]
    Satellites {
        /// In the file.
        found: usize,
        /// In the design.
        expected: usize,
    },
}

/// A difference and the bound on its magnitude; without a bound it is only reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// File minus design.
    pub value: f64,
    /// Bound on its magnitude.
    pub gate: Option<f64>,
}

impl Difference {
    /// Whether it is within the bound.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.gate.is_none_or(|gate| self.value.abs() <= gate)
    }
}

/// The comparison of a product with the design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recheck {
    /// Largest distance of a satellite from its position under the theory of the file, km.
    pub position_km: Difference,
    /// Largest distance between the theory of the file and the propagated design, km; none where they
    /// are the same.
    pub theory_km: Option<f64>,
    /// Mean visible.
    pub mean_visible: Difference,
    /// Mean PDOP; none where one side has no solved sample.
    pub mean_pdop: Option<Difference>,
}

impl Recheck {
    /// Whether every difference is within its bound, and both sides or neither have a PDOP.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.position_km.passed()
            && self.mean_visible.passed()
            && self.mean_pdop.is_none_or(|pdop| pdop.passed())
    }
}

/// The design that products are checked against.
pub struct Original<'a> {
    evaluator: &'a Evaluator,
    design: Design,
    propagated: Rescored,
}

/// Satellites and their metrics under the scenario.
struct Rescored {
    ephemeris: Ephemeris,
    metrics: Metrics,
}

impl<'a> Original<'a> {
    /// Evaluates the design.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn new(evaluator: &'a Evaluator, design: &Design) -> Result<Self, EphemerisError> {
        let setup = evaluator.setup();
        Ok(Self {
            evaluator,
            design: design.clone(),
            propagated: Rescored {
                ephemeris: Ephemeris::of_design(design, setup.model, setup.grid)?,
                metrics: evaluator.evaluate(design)?,
            },
        })
    }

    /// The design propagated by SGP4 from its unrounded element sets at `epoch`.
    fn by_sgp4(&self, epoch: Epoch) -> Result<Rescored, RecheckError> {
        let grid = self.evaluator.setup().grid;
        let since_s = epoch.seconds_since(grid.epoch());
        let satellites = self.propagated.ephemeris.satellites();
        let objects = Object::all(satellites, grid.epoch())?;
        let propagate =
            |((satellite, object), propagated): ((&Satellite, &Object), &EphemerisSatellite)| {
                let elements = SecularOrbit::j2(&satellite.elements).elements_at(since_s);
                let set = element_set(&elements, object, epoch, MeanMotionSlot::Kozai);
                let orbit = Sgp4Orbit::from_element_set(&set, grid.epoch());
                Ok(EphemerisSatellite {
                    name: propagated.name.clone(),
                    slot: propagated.slot,
                    propagator: Box::new(orbit.map_err(|source| EphemerisError {
                        name: propagated.name.clone(),
                        source,
                    })?),
                })
            };
        let of_design = self.design.satellites();
        let propagated = of_design
            .iter()
            .zip(&objects)
            .zip(satellites)
            .map(propagate);
        let ephemeris = Ephemeris::new(grid, propagated.collect::<Result<_, EphemerisError>>()?);
        let metrics = self.evaluator.evaluate_ephemeris(&ephemeris)?;
        Ok(Rescored { ephemeris, metrics })
    }

    /// Propagates what was read back and compares it; satellites are in the order of the design.
    /// `product` gives the digits and theory of the files, `sets` how their element sets, if any, are
    /// derived.
    ///
    /// # Errors
    /// If the satellites do not propagate the study, or are not those of the design.
    pub fn check(
        &self,
        product: &ReadBack,
        sets: ElementChoice,
        fleet: &Fleet,
    ) -> Result<Recheck, RecheckError> {
        let setup = self.evaluator.setup();
        let (found, expected) = (fleet.len(), self.propagated.ephemeris.satellites().len());
        if found != expected {
            return Err(RecheckError::Satellites { found, expected });
        }
        // A fitted set follows the propagated design, not the one that it started from.
        let epoch = match sets {
            ElementChoice::Fit => None,
            _ => product.theory.epoch_of_sets(setup.grid.epoch()),
        };
        let by_sgp4 = epoch.map(|epoch| self.by_sgp4(epoch)).transpose()?;
        let reference = by_sgp4.as_ref().unwrap_or(&self.propagated);
        let read_back = fleet.propagate(setup.grid, setup.model)?;
        let metrics = self.evaluator.evaluate_ephemeris(&read_back)?;
        let gate_km = self.position_gate_km(product, sets);
        let relative = gate_km.map(|km| km / SCALE_KM);
        let flips = FLIPS / setup.sample_count() as f64;
        let of = |value: f64| relative.map(|relative| value * relative + flips);
        let pdop = reference.metrics.mean_pdop.zip(metrics.mean_pdop);
        let visible = reference.metrics.mean_visible;
        let theory = by_sgp4.as_ref().map(|seen| &seen.ephemeris);
        Ok(Recheck {
            position_km: Difference {
                value: apart_km(&read_back, &reference.ephemeris)?,
                gate: gate_km,
            },
            theory_km: theory
                .map(|theory| apart_km(theory, &self.propagated.ephemeris))
                .transpose()?,
            mean_visible: Difference {
                value: metrics.mean_visible - visible,
                gate: of(visible),
            },
            // One satellite more or less at a sample changes its PDOP by less than 100 %.
            mean_pdop: pdop.map(|(expected, found)| Difference {
                value: found - expected,
                gate: of(expected),
            }),
        })
    }

    /// How far the satellites of a product may be from their positions under its theory, km; none for
    /// sets fitted to a theory that SGP4 does not approximate.
    fn position_gate_km(&self, product: &ReadBack, sets: ElementChoice) -> Option<f64> {
        let extent = Extent::new(&self.design, self.evaluator.setup().grid);
        let digits_km = (product.digits_km)(extent);
        match product.theory {
            ReadBackTheory::Study => Some(digits_km),
            ReadBackTheory::Sgp4 | ReadBackTheory::Sgp4OfTle => {
                let theory_km = self.theory_gate_km(sets, extent.days);
                theory_km.map(|km| km + digits_km)
            }
        }
    }

    /// How far SGP4 may take element sets from the trajectory they are compared with, km.
    fn theory_gate_km(&self, sets: ElementChoice, days: f64) -> Option<f64> {
        match (sets, self.evaluator.setup().model) {
            (ElementChoice::Kozai | ElementChoice::Kepler, _) => Some(0.0),
            (ElementChoice::Fit, Model::Sgp4) => Some(0.0),
            (ElementChoice::Fit, Model::J2 | Model::J2Osculating) => {
                let largest = self.design.shells().iter().map(Shell::eccentricity);
                let eccentric = 1.0 + 8.0 * largest.fold(0.0, f64::max);
                Some(eccentric * (SGP4_KM + SGP4_KM_PER_DAY * days))
            }
            (ElementChoice::Fit, Model::TwoBody) => None,
        }
    }
}

/// Largest distance of satellites in the same order, at the samples of the second.
fn apart_km(one: &Ephemeris, other: &Ephemeris) -> Result<f64, EphemerisError> {
    let mut worst_km = 0.0_f64;
    for (first, second) in one.satellites().iter().zip(other.satellites()) {
        for elapsed_s in other.grid().iter() {
            let first = one.state(first, elapsed_s)?.position_km;
            let second = other.state(second, elapsed_s)?.position_km;
            worst_km = worst_km.max((first - second).norm());
        }
    }
    Ok(worst_km)
}

#[cfg(test)]
mod tests;

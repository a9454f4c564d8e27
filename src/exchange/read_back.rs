//! Products of an export, read back and evaluated again: what the scenario makes of each file.
//!
//! A file is held against what its theory makes of the design: states and mean elements against
//! the propagated design, element sets against SGP4 of the unrounded sets. So the digits of a format
//! alone explain a difference, and gates follow from them; what SGP4 and the model of the study
//! are apart is told beside. A satellite that is d km from its place moves the circle that sees it
//! by as much; at 400 km the circle's radius is 1600 km and its area changes by less than d/500 km
//! of itself, which bounds the mean number in view, and the geometry changes by d over the
//! distance, 400 km or more.

pub(crate) mod gates;

use crate::constellation::{Design, Satellite};
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

/// SGP4 against a theory of J2 alone, km: the frozen eccentricity of J3 (8.1 km up and down, 16.2
/// along the track at most), and the short-period terms and shift of the radius (1.75 J2 Re²/a,
/// 10.6 km at most); [M-40](crate::models#m-40) to [M-42](crate::models#m-42).
const SGP4_KM: f64 = 30.0;

/// Second-order secular terms along the track, km/day: 14 J2² (Re/a)⁴ n a at most
/// ([M-43](crate::models#m-43)).
const SGP4_KM_PER_DAY: f64 = 8.0;

/// Kilometres off that change the mean in view, or a PDOP, by less than the whole of itself.
const SCALE_KM: f64 = 500.0;

/// Satellites that may cross the mask at a sample by rounding alone.
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
    /// There is no name for a satellite.
    #[error(transparent)]
    Identity(#[from] IdentityError),
    /// Other satellites than the design has.
    #[error("{found} satellites were read back; the design has {expected}")]
    Satellites {
        /// In the file.
        found: usize,
        /// In the design.
        expected: usize,
    },
}

/// A difference and the bound on its size; without a bound it is only reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// File less design.
    pub value: f64,
    /// Bound on its size.
    pub gate: Option<f64>,
}

impl Difference {
    /// Whether the bound is kept.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.gate.is_none_or(|gate| self.value.abs() <= gate)
    }
}

/// What a product says of the design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recheck {
    /// Largest distance of a satellite from where the theory of the file has it, km.
    pub position_km: Difference,
    /// Largest distance between the theory of the file and the propagated design, km; none where they
    /// are the same.
    pub theory_km: Option<f64>,
    /// Mean number of visible satellites.
    pub mean_visible: Difference,
    /// Mean PDOP; none where one side has no solved sample.
    pub mean_pdop: Option<Difference>,
}

impl Recheck {
    /// Whether every bound is kept, and both sides have a PDOP or none has.
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

/// Satellites and what the scenario makes of them.
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
            design: *design,
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

    /// Propagates what was read back and compares it; satellites stand in the order of the design.
    /// `product` says which digits and theory the files have, `sets` how their element sets are
    /// made, if they have any.
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
            // A satellite more or less at a sample changes its PDOP by less than the whole.
            mean_pdop: pdop.map(|(expected, found)| Difference {
                value: found - expected,
                gate: of(expected),
            }),
        })
    }

    /// How far the satellites of a product may be from where its theory has them, km; none for
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

    /// How far SGP4 may take element sets from the trajectory that they are held against, km.
    fn theory_gate_km(&self, sets: ElementChoice, days: f64) -> Option<f64> {
        match (sets, self.evaluator.setup().model) {
            (ElementChoice::Kozai | ElementChoice::Kepler, _) => Some(0.0),
            (ElementChoice::Fit, Model::Sgp4) => Some(0.0),
            (ElementChoice::Fit, Model::J2 | Model::J2Osculating) => {
                let eccentric = 1.0 + 8.0 * self.design.eccentricity();
                Some(eccentric * (SGP4_KM + SGP4_KM_PER_DAY * days))
            }
            (ElementChoice::Fit, Model::TwoBody) => None,
        }
    }
}

/// Largest distance of satellites that stand in the same order, at the samples of the second.
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

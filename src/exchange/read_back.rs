//! Products of an export, read back and evaluated again under the scenario.
//!
//! A file is compared with the constellation under the theory of the file: states and mean elements with the
//! propagated constellation, element sets with SGP4 from the unrounded sets. Only the digits of a format can
//! therefore cause a difference, and the gates follow from them; the distance between SGP4 and the model
//! of the study is reported separately. A satellite displaced by d km moves its footprint by as much; at
//! 400 km the footprint's radius is 1600 km and its relative area changes by less than d/500 km, which
//! bounds mean visible, and the geometry changes by d over the range, 400 km or more.

pub(crate) mod gates;

use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::evaluate::{Evaluator, Metrics};
use crate::exchange::element_sets::ElementSetRule;
use crate::exchange::export::ExportSource;
use crate::exchange::import::{Fleet, FleetError};
use crate::exchange::members::{ConstellationMember, Origin};
use crate::formats::metadata::{ElementChoice, Object};
use crate::orbit::Model;
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
    /// The satellites are not those of the constellation.
    #[error("{found} satellites were read back; the constellation has {expected}")]
    Satellites {
        /// In the file.
        found: usize,
        /// In the constellation.
        expected: usize,
    },
}

/// A difference and the bound on its magnitude; without a bound it is only reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// File minus constellation.
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

/// The comparison of a product with the constellation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Recheck {
    /// Largest distance of a satellite from its position under the theory of the file, km.
    pub position_km: Difference,
    /// Largest distance between the theory of the file and the propagated constellation, km; none where they
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

/// The constellation that products are checked against.
pub struct Original<'a> {
    evaluator: &'a Evaluator,
    source: &'a ExportSource<'a>,
    metrics: Metrics,
}

/// Satellites and their metrics under the scenario.
struct Rescored {
    ephemeris: Ephemeris,
    metrics: Metrics,
}

impl<'a> Original<'a> {
    /// Evaluates the constellation of an export in its own study.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn new(
        evaluator: &'a Evaluator,
        source: &'a ExportSource<'a>,
    ) -> Result<Self, RecheckError> {
        Ok(Self {
            evaluator,
            source,
            metrics: evaluator.evaluate_ephemeris(source.ephemeris())?,
        })
    }

    /// The constellation propagated by SGP4 from its unrounded element sets; none if a satellite has none.
    fn by_sgp4(&self, rounding: fn(Epoch) -> Epoch) -> Result<Option<Rescored>, RecheckError> {
        let setup = self.evaluator.setup();
        let grid = setup.grid;
        let rule = ElementSetRule {
            model: setup.model,
            epoch: grid.epoch(),
            slot: MeanMotionSlot::Kozai,
            rounding,
        };
        let sets = self.source.members.iter().zip(&self.source.objects);
        let sets = sets
            .map(|(member, object): (&ConstellationMember<'_>, &Object)| rule.set(member, object));
        let Some(sets) = sets.collect::<Option<Vec<_>>>() else {
            return Ok(None);
        };
        let propagate = |(set, known): (&sgp4::Elements, &EphemerisSatellite)| {
            let orbit = Sgp4Orbit::from_element_set(set, grid.epoch());
            Ok(EphemerisSatellite {
                name: known.name.clone(),
                slot: known.slot,
                propagator: Box::new(orbit.map_err(|source| EphemerisError {
                    name: known.name.clone(),
                    source,
                })?),
            })
        };
        let known = self.source.ephemeris().satellites();
        let propagated = sets.iter().zip(known).map(propagate);
        let parts = self.source.ephemeris().parts().to_vec();
        let propagated = propagated.collect::<Result<_, EphemerisError>>()?;
        let ephemeris = Ephemeris::new(grid, propagated).with_parts(parts);
        let metrics = self.evaluator.evaluate_ephemeris(&ephemeris)?;
        Ok(Some(Rescored { ephemeris, metrics }))
    }

    /// Propagates what was read back and compares it; satellites are in the order of the constellation.
    /// `product` gives the digits and theory of the files, `sets` how their element sets, if any, are
    /// derived.
    ///
    /// # Errors
    /// If the satellites do not propagate the study, or are not those of the constellation.
    pub fn check(
        &self,
        product: &ReadBack,
        sets: ElementChoice,
        fleet: &Fleet,
    ) -> Result<Recheck, RecheckError> {
        let setup = self.evaluator.setup();
        let propagated = self.source.ephemeris();
        let (found, expected) = (fleet.len(), propagated.satellites().len());
        if found != expected {
            return Err(RecheckError::Satellites { found, expected });
        }
        // A fitted set follows the propagated orbit, not the one that it started from.
        let rounding = match sets {
            ElementChoice::Fit => None,
            _ => product.theory.rounding_of_sets(),
        };
        let by_sgp4 = rounding.map(|rounding| self.by_sgp4(rounding));
        let by_sgp4 = by_sgp4.transpose()?.flatten();
        let (reference, expected) = match &by_sgp4 {
            Some(seen) => (&seen.ephemeris, &seen.metrics),
            None => (propagated, &self.metrics),
        };
        let read_back = fleet.propagate(setup.grid, setup.model)?;
        let read_back = read_back.with_parts(propagated.parts().to_vec());
        let metrics = self.evaluator.evaluate_ephemeris(&read_back)?;
        let gate_km = self.position_gate_km(product, sets)?;
        let relative = gate_km.map(|km| km / SCALE_KM);
        let flips = FLIPS / setup.sample_count() as f64;
        let of = |value: f64| relative.map(|relative| value * relative + flips);
        let pdop = expected.mean_pdop.zip(metrics.mean_pdop);
        let visible = expected.mean_visible;
        let theory = by_sgp4.as_ref().map(|seen| &seen.ephemeris);
        Ok(Recheck {
            position_km: Difference {
                value: apart_km(&read_back, reference)?,
                gate: gate_km,
            },
            theory_km: theory
                .map(|theory| apart_km(theory, propagated))
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
    fn position_gate_km(
        &self,
        product: &ReadBack,
        sets: ElementChoice,
    ) -> Result<Option<f64>, EphemerisError> {
        let extent = Extent::new(&self.source.members, self.source.ephemeris())?;
        let digits_km = (product.digits_km)(extent);
        Ok(match product.theory {
            ReadBackTheory::Study => Some(digits_km),
            ReadBackTheory::Sgp4 | ReadBackTheory::Sgp4OfTle => {
                let theory_km = self.theory_gate_km(sets, extent.days);
                theory_km.map(|km| km + digits_km)
            }
        })
    }

    /// How far SGP4 may take element sets from the trajectory they are compared with, km; none where there is no
    /// bound, as for states whose forces are not known.
    fn theory_gate_km(&self, sets: ElementChoice, days: f64) -> Option<f64> {
        if sets != ElementChoice::Fit {
            return Some(0.0);
        }
        let gate_km =
            |member: &ConstellationMember<'_>| match (&member.origin, self.evaluator.setup().model)
            {
                (Origin::Set(_), _) | (Origin::Mean { .. }, Model::Sgp4) => Some(0.0),
                (Origin::Mean { elements, .. }, Model::J2 | Model::J2Osculating) => {
                    let eccentric = 1.0 + 8.0 * elements.eccentricity;
                    Some(eccentric * (SGP4_KM + SGP4_KM_PER_DAY * days))
                }
                (Origin::Mean { .. }, Model::TwoBody) | (Origin::Sampled | Origin::Almanac, _) => {
                    None
                }
            };
        let gates: Option<Vec<f64>> = self.source.members.iter().map(gate_km).collect();
        Some(gates?.into_iter().fold(0.0, f64::max))
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

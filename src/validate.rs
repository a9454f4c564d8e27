//! Checks against standards that this library did not write: residuals, budgets and gates.
//!
//! The [`Parts`] of the library are under test; a [`Subject`] is a design in a study together with
//! the parts that propagate it and decide what is visible. A target (a standard) turns a subject
//! into [`Findings`].

pub mod analytic;
mod decisions;
pub mod distribution;
mod eccentricity;
pub mod file;
pub mod geodesic;
pub mod numerical;
mod paper;
pub mod residuals;
pub mod sgp4;

use self::sgp4::SweepCell;
use crate::constellation::{Design, Satellite, Slot};
use crate::dop::Clocks;
use crate::earth::Surface;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite, object_name};
use crate::evaluate::{Evaluator, Setup};
use crate::frames::{EarthFixed, LocalFrame, Position};
use crate::keyword::{Keyword, keywords};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::sgp4::MeanMotionSlot;
use crate::orbit::{MeanElements, Model, PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};
use crate::units::SECONDS_PER_DAY;
use distribution::Distribution;
use residuals::BudgetLine;
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use thiserror::Error;

/// One number of a validation, with the bound it must meet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Unique name, `target/case/quantity`.
    pub name: String,
    /// What was measured.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// The statistic.
    pub statistic: String,
    /// The value; JSON has `null` for one that is not finite.
    #[serde(deserialize_with = "null_is_nan")]
    pub value: f64,
    /// The bound on its magnitude; `None` if it is reported only.
    pub gate: Option<f64>,
    /// Whether the value is within its bound (true if there is none).
    pub passed: bool,
    /// The physical reason for the bound, or what the number shows.
    pub reason: String,
}

/// What the number of a [`Check`] is.
#[derive(Debug, Clone, Copy)]
pub struct CheckedQuantity<'a> {
    /// What was measured.
    pub quantity: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Which statistic of it.
    pub statistic: &'a str,
}

impl Check {
    /// A check whose gate bounds |value|; a value that is not a number never passes a gate.
    #[must_use]
    pub fn new(
        name: &str,
        measure: CheckedQuantity<'_>,
        value: f64,
        gate: Option<f64>,
        reason: &str,
    ) -> Self {
        Self {
            name: name.to_owned(),
            quantity: measure.quantity.to_owned(),
            unit: measure.unit.to_owned(),
            statistic: measure.statistic.to_owned(),
            value,
            gate,
            passed: gate.is_none_or(|gate| value.abs() <= gate),
            reason: reason.to_owned(),
        }
    }
}

fn null_is_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// A crate that validations rely on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Judge {
    /// Its name.
    pub name: Cow<'static, str>,
    /// The version built in.
    pub version: Cow<'static, str>,
    /// What it is used for.
    pub role: Cow<'static, str>,
}

/// The crates that act as references, in the versions pinned by the lock file.
pub const JUDGES: [Judge; 4] = [
    Judge {
        name: Cow::Borrowed("sgp4"),
        version: Cow::Borrowed("2.4.0"),
        role: Cow::Borrowed("SGP4 in AFSPC and improved mode"),
    },
    Judge {
        name: Cow::Borrowed("geographiclib-rs"),
        version: Cow::Borrowed("0.2.7"),
        role: Cow::Borrowed("geodesics on the ellipsoid"),
    },
    Judge {
        name: Cow::Borrowed("differential-equations"),
        version: Cow::Borrowed("0.7.0"),
        role: Cow::Borrowed("numerical integration, DOP853"),
    },
    Judge {
        name: Cow::Borrowed("sofars"),
        version: Cow::Borrowed("0.6.2"),
        role: Cow::Borrowed("sidereal time, precession and nutation"),
    },
];

/// What a validation found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, Default)]
pub struct Findings {
    /// The checks, in reading order.
    #[serde(default)]
    pub checks: Vec<Check>,
    /// The error budget by cause, for comparisons of trajectories.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub budget: Vec<BudgetLine>,
    /// The budget over inclinations and altitudes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sweep: Vec<SweepCell>,
    /// How residuals are distributed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub distributions: Vec<Distribution>,
    /// Comparisons with the ephemerides of other programs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<file::FileComparison>,
}

impl Findings {
    /// Whether every gate passed.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.checks.iter().all(|check| check.passed)
    }

    /// Adds what another target found.
    pub fn append(&mut self, mut other: Self) {
        self.checks.append(&mut other.checks);
        self.budget.append(&mut other.budget);
        self.sweep.append(&mut other.sweep);
        self.distributions.append(&mut other.distributions);
        self.files.append(&mut other.files);
    }
}

/// The parts of the library that are compared with standards.
///
/// Our own by default. A test replaces one by a faulty version to see which checks notice.
#[derive(Debug, Clone, Copy)]
pub struct Parts {
    /// Satellites and their slots.
    pub satellites: fn(&Design) -> Vec<Satellite>,
    /// The secular J2 theory.
    pub mean_j2: fn(&MeanElements) -> SecularOrbit,
    /// What exported element sets have in the mean motion field.
    pub slot: MeanMotionSlot,
    /// Argument of perigee at which the frozen eccentricity is cancelled in an element set, degrees.
    pub cancelling_perigee_deg: f64,
    /// Greenwich mean sidereal time a number of seconds after an epoch, radians.
    pub gmst_rad: fn(Epoch, f64) -> f64,
    /// East, north and up at a latitude and longitude, radians.
    pub local_frame: fn(Surface, f64, f64) -> LocalFrame,
    /// The clock states that are solved for, given those of the study.
    pub clocks: fn(Clocks) -> Clocks,
    /// Elevation and azimuth of a position, radians.
    pub look_angles: fn(&LocalFrame, Position<EarthFixed>) -> (f64, f64),
}

impl Default for Parts {
    fn default() -> Self {
        Self {
            satellites: Design::satellites,
            mean_j2: SecularOrbit::j2,
            slot: MeanMotionSlot::Kozai,
            cancelling_perigee_deg: 270.0,
            gmst_rad: Epoch::gmst_rad,
            local_frame: LocalFrame::new,
            clocks: |meant| meant,
            look_angles: LocalFrame::look_angles,
        }
    }
}

keywords! {
    /// What a design can be compared with.
    Target {
        /// SGP4: an error budget by cause.
        Sgp4 = "sgp4",
        /// Geodesics on the ellipsoid.
        GeographicLib = "geographiclib",
        /// Numerical integration.
        Numerical = "numerical",
        /// Closed forms and symmetries.
        Analytic = "analytic",
        /// The tables of the paper.
        Paper = "paper",
        /// All of these that apply to the study.
        All = "all",
    }
}

impl Target {
    /// Compares a design with this standard; `All` compares it with each of the others.
    ///
    /// # Errors
    /// If the validation cannot be carried out.
    pub fn findings(self, subject: &Subject<'_>) -> Result<Findings, ValidateError> {
        match self {
            Self::Sgp4 => sgp4::against_sgp4(subject),
            Self::GeographicLib => geodesic::against_geodesics(subject),
            Self::Numerical => numerical::against_integration(subject),
            Self::Analytic => analytic::against_closed_forms(subject),
            Self::Paper => Ok(paper::against_paper(subject.evaluator.setup())?),
            Self::All => {
                let mut findings = Findings::default();
                for target in self.each() {
                    findings.append(target.findings(subject)?);
                }
                Ok(findings)
            }
        }
    }

    /// The targets that this one covers: `All` covers each of the others.
    pub fn each(self) -> impl Iterator<Item = Self> {
        let stands_for = move |target: &&Self| match self {
            Self::All => **target != Self::All,
            one => **target == one,
        };
        Self::ALL.iter().filter(stands_for).copied()
    }
}

/// A design in a study, with the parts that propagate it and decide what is visible.
pub struct Subject<'a> {
    /// The design.
    pub design: Design,
    /// The study.
    pub evaluator: &'a Evaluator,
    /// The parts of the library under test.
    pub parts: Parts,
}

impl<'a> Subject<'a> {
    /// A design with the library's own parts.
    #[must_use]
    pub fn new(design: Design, evaluator: &'a Evaluator) -> Self {
        Self {
            design,
            evaluator,
            parts: Parts::default(),
        }
    }

    fn setup(&self) -> &'a Setup {
        self.evaluator.setup()
    }

    fn grid(&self) -> TimeGrid {
        self.setup().grid
    }

    fn epoch(&self) -> Epoch {
        self.grid().epoch()
    }

    fn days(&self) -> f64 {
        self.grid().len() as f64 * self.grid().step_s() / SECONDS_PER_DAY
    }

    /// Elements of the first satellite; all satellites share a, e and i.
    fn orbit(&self) -> MeanElements {
        self.design.elements(Slot { plane: 0, index: 0 })
    }

    fn satellites(&self) -> Vec<Satellite> {
        (self.parts.satellites)(&self.design)
    }

    /// The design propagated by a theory over the study.
    fn propagate<P: Propagator + 'static>(
        &self,
        theory: impl Fn(&MeanElements) -> Result<P, PropagationError>,
    ) -> Result<Ephemeris, EphemerisError> {
        self.propagate_on(self.grid(), theory)
    }

    /// The design propagated by a theory over a grid.
    fn propagate_on<P: Propagator + 'static>(
        &self,
        grid: TimeGrid,
        theory: impl Fn(&MeanElements) -> Result<P, PropagationError>,
    ) -> Result<Ephemeris, EphemerisError> {
        let one = |satellite: &Satellite| {
            let name = object_name(satellite.slot);
            match theory(&satellite.elements) {
                Ok(propagated) => Ok(EphemerisSatellite {
                    name,
                    slot: Some(satellite.slot),
                    propagator: Box::new(propagated),
                }),
                Err(source) => Err(EphemerisError { name, source }),
            }
        };
        let satellites = self.satellites().iter().map(one).collect::<Result<_, _>>();
        Ok(Ephemeris::new(grid, satellites?))
    }

    /// The design propagated by the model of the study.
    fn propagate_model(&self) -> Result<Ephemeris, EphemerisError> {
        match self.setup().model {
            Model::J2 => self.propagate_mean_j2(),
            model => Ephemeris::of_design(&self.design, model, self.grid()),
        }
    }

    /// The design propagated by mean J2.
    fn propagate_mean_j2(&self) -> Result<Ephemeris, EphemerisError> {
        self.propagate(|elements| Ok((self.parts.mean_j2)(elements)))
    }
}

/// Why a validation cannot be carried out.
#[derive(Debug, Error)]
pub enum ValidateError {
    /// A satellite cannot be propagated.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// An element exceeds the columns of a TLE.
    #[error(transparent)]
    Tle(#[from] crate::formats::tle::TleFieldError),
    /// The paper's study cannot be reproduced.
    #[error(transparent)]
    Paper(#[from] crate::study::paper::PaperError),
    /// A file cannot be compared.
    #[error(transparent)]
    File(#[from] file::FileError),
    /// An integration fails.
    #[error(transparent)]
    Integration(#[from] numerical::integrator::IntegrationError),
    /// A design of a sweep is invalid.
    #[error(transparent)]
    Design(#[from] crate::constellation::DesignError),
    /// A span does not give a time grid.
    #[error(transparent)]
    Time(#[from] crate::time::TimeError),
    /// No catalogue number or designator is left for a satellite.
    #[error(transparent)]
    Identity(#[from] crate::formats::metadata::IdentityError),
}

#[cfg(test)]
mod planted;
#[cfg(test)]
mod testing;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_bound_the_size() {
        let check = |value, gate| {
            Check::new(
                "a/b",
                CheckedQuantity {
                    quantity: "q",
                    unit: "km",
                    statistic: "max",
                },
                value,
                gate,
                "",
            )
            .passed
        };
        assert!(check(-1.0, Some(1.0)) && !check(-1.1, Some(1.0)));
        assert!(check(1e9, None));
        assert!(!check(f64::NAN, Some(1.0)));
    }
}

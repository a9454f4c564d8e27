//! Checks against standards that this library did not write: residuals, budgets and gates.
//!
//! The [`Parts`] of the library are under test; a [`Subject`] is a design in a study together with
//! the parts that propagate it and decide what is visible. A target (a standard) turns a subject
//! into [`Findings`].

pub mod analytic;
mod caught;
mod check;
mod decisions;
pub mod distribution;
mod eccentricity;
pub mod file;
pub mod geodesic;
pub mod numerical;
mod paper;
mod parts;
pub mod residuals;
pub mod sgp4;

pub use caught::{CAUGHT_ERRORS, CaughtError, caught_by};
pub use check::{Check, CheckedQuantity, Outcome, Tally};
pub use paper::{PaperError, against_paper};
pub use parts::{ModelPropagator, Parts};

use self::sgp4::SweepCell;
use crate::constellation::{Design, Satellite, Shell, Slot, shell_letters};
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite, object_name};
use crate::evaluate::{Evaluator, Setup};
use crate::formats::tle::TleFieldError;
use crate::keyword::{Keyword, keywords};
use crate::orbit::j2::SecularOrbit;
use crate::orbit::{MeanElements, Model, PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};
use crate::units::SECONDS_PER_DAY;
use distribution::Distribution;
use residuals::BudgetLine;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use thiserror::Error;

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
    /// What a target cannot judge about the model of the study, in sentences.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
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
        self.failures().next().is_none()
    }

    /// The checks that miss their gate.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks
            .iter()
            .filter(|check| check.outcome() == Outcome::Fail)
    }

    /// The same findings under names that begin with that of a shell or a constellation.
    #[must_use]
    pub fn prefixed(mut self, name: &str) -> Self {
        let named = |of: &mut String| *of = format!("{name}/{of}");
        self.checks.iter_mut().for_each(|one| named(&mut one.name));
        self.budget.iter_mut().for_each(|one| named(&mut one.case));
        let distributions = self.distributions.iter_mut();
        distributions.for_each(|one| named(&mut one.name));
        self.files.iter_mut().for_each(|one| named(&mut one.source));
        self
    }

    /// The findings of each shell of a design, named after it, and the budget of all shells together; those
    /// of the only shell as they are.
    #[must_use]
    pub fn of_design(design: &Design, mut shells: Vec<Self>) -> Self {
        if shells.len() == 1 {
            return shells.swap_remove(0);
        }
        let mut findings = Self::default();
        let counts: Vec<usize> = design.shells().iter().map(Shell::satellite_count).collect();
        let cases = shells.iter().map(|found| found.budget.len()).min();
        for case in 0..cases.unwrap_or(0) {
            let lines: Vec<_> = counts
                .iter()
                .zip(&shells)
                .map(|(count, found)| (*count, &found.budget[case]))
                .collect();
            findings.budget.extend(BudgetLine::pooled(&lines));
        }
        for (n, found) in shells.into_iter().enumerate() {
            findings.append(found.prefixed(&shell_letters(n)));
        }
        findings
    }

    /// Adds what another target found.
    pub fn append(&mut self, mut other: Self) {
        self.checks.append(&mut other.checks);
        self.notes.append(&mut other.notes);
        self.budget.append(&mut other.budget);
        self.sweep.append(&mut other.sweep);
        self.distributions.append(&mut other.distributions);
        self.files.append(&mut other.files);
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
            // Of a scenario, whatever is propagated in it: see `against_paper`.
            Self::Paper => Ok(Findings::default()),
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

/// A shell in a study, with the parts that propagate it and decide what is visible.
pub struct Subject<'a> {
    /// The shell: a design of one, or one of a design of several.
    pub shell: Shell,
    /// The study.
    pub evaluator: &'a Evaluator,
    /// The parts of the library under test.
    pub parts: Parts,
    /// Its place among the shells of a design of several.
    pub number: Option<usize>,
}

impl<'a> Subject<'a> {
    /// The only shell of a design, with the library's own parts.
    #[must_use]
    pub fn new(shell: Shell, evaluator: &'a Evaluator) -> Self {
        Self {
            shell,
            evaluator,
            parts: Parts::default(),
            number: None,
        }
    }

    /// The shells of a design, each with the library's own parts.
    #[must_use]
    pub fn of_shells(design: &Design, evaluator: &'a Evaluator) -> Vec<Self> {
        let among_several = design.only_shell().is_none();
        let shells = design.shells().iter().enumerate();
        let subject = |(n, shell): (usize, &Shell)| Self {
            number: among_several.then_some(n),
            ..Self::new(*shell, evaluator)
        };
        shells.map(subject).collect()
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
        self.shell.elements(Slot::FIRST)
    }

    fn satellites(&self) -> Vec<Satellite> {
        self.numbered((self.parts.satellites)(&self.shell))
    }

    /// The satellites of the shell by the library, whatever the parts under test.
    fn nominal_satellites(&self) -> Vec<Satellite> {
        self.numbered(self.shell.satellites())
    }

    fn numbered(&self, mut satellites: Vec<Satellite>) -> Vec<Satellite> {
        for satellite in &mut satellites {
            satellite.slot.shell = self.number;
        }
        satellites
    }

    /// The model that the study propagates the design with, which is on trial.
    fn model(&self) -> Model {
        self.setup().model
    }

    /// That model as the first of a case: J2 is `mean-j2`, as secular rates of mean elements.
    fn model_label(&self) -> &'static str {
        match self.model() {
            Model::J2 => MEAN_J2,
            other => other.keyword(),
        }
    }

    /// The propagator of the model of the study.
    fn model_propagator(
        &self,
        elements: &MeanElements,
    ) -> Result<Box<dyn Propagator>, PropagationError> {
        match self.model() {
            Model::J2 => Ok(Box::new((self.parts.mean_j2)(elements))),
            other => (self.parts.propagator)(other, elements, self.epoch()),
        }
    }

    /// The mean elements of the model after some time; SGP4 has none that compare.
    fn mean_elements_after(&self, elements: &MeanElements, elapsed_s: f64) -> Option<MeanElements> {
        match self.model() {
            Model::TwoBody => Some(SecularOrbit::two_body(elements).elements_at(elapsed_s)),
            Model::J2 | Model::J2Osculating => {
                Some((self.parts.mean_j2)(elements).elements_at(elapsed_s))
            }
            Model::Sgp4 => None,
        }
    }

    /// The design propagated by a theory over a grid.
    fn propagate_on(
        &self,
        grid: TimeGrid,
        theory: impl Fn(&MeanElements) -> Result<Box<dyn Propagator>, PropagationError>,
    ) -> Result<Ephemeris, EphemerisError> {
        let one = |satellite: &Satellite| {
            let name = object_name(satellite.slot);
            match theory(&satellite.elements) {
                Ok(propagator) => Ok(EphemerisSatellite {
                    name,
                    slot: Some(satellite.slot),
                    propagator,
                }),
                Err(source) => Err(EphemerisError { name, source }),
            }
        };
        let satellites = self.satellites().iter().map(one).collect::<Result<_, _>>();
        Ok(Ephemeris::new(grid, satellites?))
    }

    /// The design propagated by the model of the study.
    fn propagate_model(&self) -> Result<Ephemeris, EphemerisError> {
        self.propagate_model_on(self.grid())
    }

    /// The same over another grid.
    fn propagate_model_on(&self, grid: TimeGrid) -> Result<Ephemeris, EphemerisError> {
        self.propagate_on(grid, |elements| self.model_propagator(elements))
    }
}

/// Mean J2 in the names of cases and checks.
const MEAN_J2: &str = "mean-j2";

/// Why a validation cannot be carried out.
#[derive(Debug, Error)]
pub enum ValidateError {
    /// A satellite cannot be propagated.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// An element exceeds the columns of a TLE.
    #[error(transparent)]
    Tle(#[from] TleFieldError),
    /// The paper's study cannot be reproduced.
    #[error(transparent)]
    Paper(#[from] PaperError),
    /// A file cannot be compared.
    #[error(transparent)]
    File(#[from] file::FileError),
    /// An integration fails.
    #[error(transparent)]
    Integration(#[from] numerical::integrator::IntegrationError),
    /// A design of a sweep is invalid.
    #[error(transparent)]
    Shell(#[from] crate::constellation::DesignError),
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
    use residuals::{Ric, Worst};

    /// The budget of several shells counts each by its satellites, before the lines of the shells.
    #[test]
    fn the_budget_of_a_design_counts_every_shell() {
        let design: Design = "delta:53:20/5/1@1000+star:87:8/2/0@1100".parse().unwrap();
        let found = |km: f64| {
            let axes = Ric {
                radial: km,
                in_track: km,
                cross_track: km,
            };
            let line = BudgetLine {
                case: "first/second".to_owned(),
                cause: String::new(),
                rms_km: axes,
                max_km: axes,
                mean_km: axes,
                growth_km_per_day: axes,
                worst: Worst {
                    satellite: String::new(),
                    elapsed_s: 0.0,
                    distance_km: km,
                },
                distance: None,
            };
            Findings {
                budget: vec![line],
                ..Findings::default()
            }
        };
        let findings = Findings::of_design(&design, vec![found(1.0), found(5.0)]);
        let cases = findings.budget.iter().map(|line| line.case.as_str());
        let cases: Vec<&str> = cases.collect();
        assert_eq!(cases, ["first/second", "A/first/second", "B/first/second"]);
        let all = &findings.budget[0];
        // (20 · 1² + 8 · 5²) / 28, and (20 · 1 + 8 · 5) / 28; rounding.
        assert!((all.rms_km.radial - (220.0_f64 / 28.0).sqrt()).abs() < 1e-12);
        assert!((all.mean_km.in_track - 60.0 / 28.0).abs() < 1e-12);
        assert_eq!((all.max_km.radial, all.worst.distance_km), (5.0, 5.0));
    }
}

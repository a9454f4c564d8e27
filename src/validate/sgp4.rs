//! The model of a study against SGP4: an error budget by cause.
//!
//! The first cases compare the model of the study with SGP4, and only these have gates: what a J2
//! theory leaves out of SGP4. Two-body propagation fails them; SGP4 itself has no gate here, as it
//! would be its own judge.
//!
//! The cases of mean J2 are always included, as a single number would explain nothing. Mean J2 and
//! SGP4 differ by (a) the constant radius shift of the first-order short-period theory, (b) its
//! periodic terms, (c) the frozen eccentricity forced by J3, and (d) second-order secular terms. Each
//! has a closed form at e = 0 from which the gates are derived, so they follow the inclination and
//! altitude of the design.

pub(super) mod causes;
mod element_sets;
mod frozen;
pub(super) mod rates;
mod sweep;
mod verification;

use super::decisions::{TrajectoryPair, flip_gate};
use super::residuals::{BudgetLine, compare};
use super::{Check, CheckedQuantity, Findings, Subject, ValidateError};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::orbit::Model;
use crate::orbit::osculating::OsculatingOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Mode, Sgp4Orbit, Sgp4Theory, ZonalHarmonics};
use crate::time::TimeGrid;
use causes::{Causes, Leftover, is_deep_space};

pub use sweep::{SweepCell, SweepLine};
pub use verification::against_the_verification_set;

/// The design propagated by SGP4, by J2 and by the model of the study, each once.
struct Propagations {
    /// The model of the study and its label, unless it is mean J2.
    model: Option<(&'static str, Ephemeris)>,
    mean_j2: Ephemeris,
    osculating_j2: Ephemeris,
    sgp4: Ephemeris,
    no_j3j4: Ephemeris,
    no_j3: Ephemeris,
    kepler_slot: Ephemeris,
    design_constants: Ephemeris,
    improved: Ephemeris,
}

impl Propagations {
    fn new(subject: &Subject<'_>, grid: TimeGrid) -> Result<Self, EphemerisError> {
        let by = |slot: MeanMotionSlot, theory: Sgp4Theory| {
            subject.propagate_on(grid, |elements| {
                let epoch = subject.epoch();
                let orbit = Sgp4Orbit::from_mean_elements_with(elements, epoch, slot, theory)?;
                Ok(Box::new(orbit))
            })
        };
        let slot = subject.parts.slot;
        let zonals = |zonals| by(slot, subject.sgp4_theory(zonals));
        let model = match subject.model() {
            Model::J2 => None,
            _ => Some((subject.model_label(), subject.propagate_model_on(grid)?)),
        };
        Ok(Self {
            model,
            mean_j2: subject.propagate_on(grid, |elements| {
                Ok(Box::new((subject.parts.mean_j2)(elements)))
            })?,
            osculating_j2: subject.propagate_on(grid, |elements| {
                Ok(Box::new(OsculatingOrbit::new(elements)))
            })?,
            sgp4: zonals(ZonalHarmonics::Full)?,
            no_j3j4: zonals(ZonalHarmonics::J2Only)?,
            no_j3: zonals(ZonalHarmonics::WithoutJ3)?,
            kepler_slot: by(
                MeanMotionSlot::Kepler,
                subject.sgp4_theory(ZonalHarmonics::Full),
            )?,
            design_constants: by(slot, Sgp4Theory::with_design_constants())?,
            improved: by(
                slot,
                Sgp4Theory {
                    mode: Sgp4Mode::Improved,
                    ..subject.parts.sgp4
                },
            )?,
        })
    }

    /// The propagation by the model of the study.
    fn of_study(&self) -> &Ephemeris {
        self.model
            .as_ref()
            .map_or(&self.mean_j2, |(_, propagated)| propagated)
    }

    /// The cases of the model of the study, unless it is mean J2, whose cases are always included.
    fn model_cases(&self) -> Result<Vec<BudgetLine>, EphemerisError> {
        let Some((label, propagated)) = &self.model else {
            return Ok(Vec::new());
        };
        let all = "the model of the study: everything it leaves out of SGP4";
        let without = "the model of the study: everything it leaves out of J2";
        [
            ("sgp4", all, &self.sgp4),
            ("sgp4-no-j3j4", without, &self.no_j3j4),
        ]
        .into_iter()
        .map(|(standard, cause, second)| {
            compare(&format!("{label}/{standard}"), cause, propagated, second)
        })
        .collect()
    }

    /// The cases of J2 against SGP4.
    fn j2_cases(&self) -> Result<Vec<BudgetLine>, EphemerisError> {
        compare_each([
            (
                "mean-j2/sgp4",
                "everything mean J2 neglects; at e = 0 mostly J3's frozen eccentricity",
                &self.mean_j2,
                &self.sgp4,
            ),
            (
                "mean-j2/sgp4-no-j3j4",
                "J2's own short-period terms and radius shift",
                &self.mean_j2,
                &self.no_j3j4,
            ),
            (
                "osculating-j2/sgp4-no-j3j4",
                "second-order secular terms of J2",
                &self.osculating_j2,
                &self.no_j3j4,
            ),
            (
                "osculating-j2/sgp4",
                "J3's frozen eccentricity, J4 and second-order terms",
                &self.osculating_j2,
                &self.sgp4,
            ),
            (
                "kepler-slot",
                "sqrt(mu/a^3) in the Kozai mean motion field, a common mistake",
                &self.mean_j2,
                &self.kepler_slot,
            ),
        ])
    }

    /// What SGP4's own variants amount to.
    fn variants(&self) -> Result<Vec<BudgetLine>, EphemerisError> {
        compare_each([
            ("sgp4-no-j3j4/sgp4-no-j3", "J4", &self.no_j3j4, &self.no_j3),
            (
                "sgp4/sgp4-egm96",
                "gravity constants: mu, R and J2 of EGM96 instead of WGS-72",
                &self.sgp4,
                &self.design_constants,
            ),
            (
                "sgp4/sgp4-improved",
                "improved mode with its sidereal time instead of AFSPC mode",
                &self.sgp4,
                &self.improved,
            ),
        ])
    }

    /// The cases that are swept over inclination and altitude.
    fn budget(&self) -> Result<Vec<BudgetLine>, EphemerisError> {
        let mut budget = self.model_cases()?;
        budget.extend(self.j2_cases()?);
        Ok(budget)
    }
}

fn compare_each<const N: usize>(
    cases: [(&str, &str, &Ephemeris, &Ephemeris); N],
) -> Result<Vec<BudgetLine>, EphemerisError> {
    cases
        .into_iter()
        .map(|(case, cause, first, second)| compare(case, cause, first, second))
        .collect()
}

impl Subject<'_> {
    /// The judge with some of its harmonics.
    fn sgp4_theory(&self, zonals: ZonalHarmonics) -> Sgp4Theory {
        let full = self.parts.sgp4.geopotential;
        let (j3, j4) = match zonals {
            ZonalHarmonics::Full => (full.j3, full.j4),
            ZonalHarmonics::J2Only => (0.0, 0.0),
            ZonalHarmonics::WithoutJ3 => (0.0, full.j4),
        };
        Sgp4Theory {
            geopotential: ::sgp4::Geopotential { j3, j4, ..full },
            ..self.parts.sgp4
        }
    }
}

/// All checks of a design by SGP4: the budget by cause with its gates, the rates of node and
/// argument of latitude, the frozen eccentricity, the exported element sets, and the effect of the
/// differences on visibility decisions, passes and metrics.
///
/// Elements are unrounded, without drag, in WGS-72 unless a case says otherwise.
///
/// # Errors
/// If SGP4 rejects a satellite, for example because its orbit decays.
pub fn against_sgp4(subject: &Subject<'_>) -> Result<Findings, ValidateError> {
    let mut findings = against_the_verification_set(subject.parts.sgp4);
    let propagations = Propagations::new(subject, subject.grid())?;
    let mut budget = propagations.budget()?;
    budget.extend(propagations.variants()?);
    findings.notes.extend(note(subject));
    let scale = GateScale::of(subject, subject.grid());
    findings.checks.extend(scale.budget_checks(&budget));
    // The sweep is the same for every shell of a design.
    if subject.number.is_none_or(|number| number == 0) {
        findings.append(sweep::over_inclination_and_altitude(subject)?);
    }
    findings.checks.extend(rates::checks(subject, &scale)?);
    findings.checks.extend(frozen::checks(subject, &scale)?);
    let written = element_sets::WrittenSets::new(subject)?;
    findings.append(written.findings(subject, &propagations.sgp4)?);
    let flips = scale.flip_gate(subject);
    for (name, second) in [
        ("sgp4/decisions", &propagations.sgp4),
        ("sgp4/tle/decisions", &written.propagated),
    ] {
        let seen = TrajectoryPair {
            evaluator: subject.evaluator,
            first: propagations.of_study(),
            second,
        };
        findings.append(seen.compare(name, flips)?);
    }
    findings.budget.splice(0..0, budget);
    Ok(findings)
}

/// Two identical propagations differ by less than this, km or km/day.
const SAME_KM: f64 = 1e-9;

/// What SGP4 cannot say about the model of a study.
fn note(subject: &Subject<'_>) -> Option<String> {
    let text = match subject.model() {
        Model::Sgp4 => {
            "sgp4: the model of the study is SGP4 itself, so sgp4/sgp4 shows only that both get the same elements; SGP4 is judged by its verification set and by --against numerical"
        }
        Model::TwoBody => {
            "sgp4: the gates for two-body are what a J2 theory leaves out of SGP4; it has no secular drift, and fails them by the effect of J2 over the span"
        }
        Model::J2 | Model::J2Osculating => return None,
    };
    Some(text.to_owned())
}

/// The closed forms for this orbit and span, and the model that must meet them.
struct GateScale {
    model: Model,
    label: &'static str,
    causes: Causes,
    days: f64,
    leftover: Leftover,
    deep_space: bool,
}

impl GateScale {
    fn of(subject: &Subject<'_>, grid: TimeGrid) -> Self {
        let orbit = subject.orbit();
        let days = subject.days();
        Self {
            model: subject.model(),
            label: subject.model_label(),
            causes: Causes::of(&orbit),
            days,
            leftover: Leftover::of(&subject.shell.satellites(), grid),
            deep_space: is_deep_space(&orbit),
        }
    }

    /// A bound, except in deep space.
    fn gate(&self, bound: f64) -> Option<f64> {
        (!self.deep_space).then_some(bound)
    }

    /// The reason for a bound, or for its absence.
    fn reason<'a>(&self, reason: &'a str) -> &'a str {
        if self.deep_space {
            "reported only: SGP4 adds Sun, Moon and resonances at this period"
        } else {
            reason
        }
    }

    /// Bounds on the RMS of the model of the study against SGP4, km; none for SGP4 against a part of itself.
    fn rms_gates_km(&self, zonals: ZonalHarmonics) -> Option<[f64; 3]> {
        match self.model {
            Model::J2 | Model::TwoBody => {
                Some(self.causes.rms_gates_km(zonals, self.days, self.leftover))
            }
            Model::J2Osculating => Some(self.causes.osculating_gates_km(
                zonals,
                self.days,
                self.leftover,
            )),
            Model::Sgp4 => (zonals == ZonalHarmonics::Full).then_some([SAME_KM; 3]),
        }
    }

    /// In-track growth of the model of the study against SGP4 in closed form, km/day.
    fn known_growth_km_per_day(&self, zonals: ZonalHarmonics) -> f64 {
        let beyond_j2 = self.causes.drifts_km_per_day(zonals)[0];
        match self.model {
            Model::Sgp4 => beyond_j2 - self.causes.drifts_km_per_day(ZonalHarmonics::Full)[0],
            _ => beyond_j2,
        }
    }

    /// Bound on the growth of a mean in-track difference minus its closed form, km/day.
    fn growth_gate_km_per_day(&self, zonals: ZonalHarmonics) -> f64 {
        self.causes.growth_gate_km_per_day(zonals, self.leftover)
    }

    /// Bound on the share of flipped decisions.
    fn flip_gate(&self, subject: &Subject<'_>) -> Option<f64> {
        if self.model == Model::Sgp4 {
            return None;
        }
        let [radial, in_track, cross_track] = self.rms_gates_km(ZonalHarmonics::Full)?;
        let orbit = subject.orbit();
        let mask_deg = subject.setup().mask.degrees();
        let along = in_track.hypot(cross_track);
        let flips = flip_gate(orbit.semi_major_axis_km, mask_deg, radial, along);
        self.gate(flips)
    }

    fn budget_checks(&self, budget: &[BudgetLine]) -> Vec<Check> {
        let mut checks = Vec::new();
        for line in budget {
            let of_j2 = matches!(
                line.case.split_once('/'),
                Some((first, "sgp4" | "sgp4-no-j3j4")) if first == self.label || first.ends_with("-j2")
            );
            if of_j2 {
                checks.extend(self.line_checks(line));
            }
        }
        let case = |name: &str| budget.iter().find(|line| line.case == name);
        if let Some(line) = case("mean-j2/sgp4-no-j3j4") {
            checks.push(self.radius_check(line));
        }
        if let Some(line) = case("kepler-slot") {
            checks.extend(self.slot_checks(line));
        }
        checks
    }

    /// RMS of a case by axis, and the growth of its mean.
    fn line_checks(&self, line: &BudgetLine) -> Vec<Check> {
        let zonals = if line.case.ends_with("/sgp4") {
            ZonalHarmonics::Full
        } else {
            ZonalHarmonics::J2Only
        };
        // Only the model of the study is held to a gate.
        let of_study = line.case.starts_with(&format!("{}/", self.label));
        let bounds = self.rms_gates_km(zonals).filter(|_| of_study);
        let beside = if of_study {
            "reported only: what J3 and J4 amount to in the model of the study, which is the judge itself"
        } else {
            "reported only: beside the model of the study, to explain its difference by cause"
        };
        let itself = of_study && self.model == Model::Sgp4;
        let reason = |reason: &'static str| match bounds {
            Some(_) if itself => {
                "the model and the judge are SGP4 from the same elements: equal to rounding"
            }
            Some(_) => self.reason(reason),
            None => beside,
        };
        let (known_km_per_day, growth_gate) = match of_study {
            true if itself => (self.known_growth_km_per_day(zonals), SAME_KM),
            _ => (
                self.causes.drifts_km_per_day(zonals)[0],
                self.growth_gate_km_per_day(zonals),
            ),
        };
        let rms = [
            ("radial", line.rms_km.radial),
            ("in-track", line.rms_km.in_track),
            ("cross-track", line.rms_km.cross_track),
        ];
        let mut checks = Vec::new();
        for (n, (axis, value)) in rms.into_iter().enumerate() {
            checks.push(Check::new(
                &format!("sgp4/{}/{axis}-rms", line.case),
                CheckedQuantity {
                    quantity: &format!("{axis} difference"),
                    unit: "km",
                    statistic: "rms",
                },
                value,
                bounds.and_then(|bounds| self.gate(bounds[n])),
                reason("closed forms of radius shift, short-period terms, frozen eccentricity and second order, plus 15 %"),
            ));
        }
        checks.push(Check::new(
            &format!("sgp4/{}/in-track-growth", line.case),
            CheckedQuantity {
                quantity: "in-track growth minus that of the secular terms of J2^2 and J4",
                unit: "km/day",
                statistic: "slope",
            },
            line.growth_km_per_day.in_track - known_km_per_day,
            bounds.and_then(|_| self.gate(growth_gate)),
            reason("a theory of first order in J2 lacks the secular terms of J2^2 and J4, whose closed forms are subtracted; the remainder is third order, e, the constants and the slope of periodic terms"),
        ));
        checks
    }

    fn radius_check(&self, without_j3j4: &BudgetLine) -> Check {
        let causes = &self.causes;
        // Terms of relative order J2 of the short-period theory, SGP4's floor of e, what few samples leave of the
        // short-period term, and e itself.
        let bound = 0.005
            + 0.003 * causes.radius_shift_km.abs()
            + self.leftover.mean[1] * causes.short_period_km[0]
            + (causes.eccentric_factor - 1.0) * causes.short_period_km[0];
        Check::new(
            "sgp4/radius-shift/closed-form",
            CheckedQuantity {
                quantity: "mean radial difference minus 3/4 J2 R^2/a (1 - 3 cos^2 i)",
                unit: "km",
                statistic: "mean",
            },
            without_j3j4.mean_km.radial - causes.radius_shift_km,
            self.gate(bound),
            self.reason("the short-period theory of J2 shifts the mean radius by a constant that is known to first order; plus the mean of its periodic term over the samples"),
        )
    }

    fn slot_checks(&self, kepler: &BudgetLine) -> [Check; 2] {
        let growth = kepler.growth_km_per_day.in_track;
        [
            Check::new(
                "sgp4/kepler-slot/in-track-growth",
                CheckedQuantity {
                    quantity: "in-track growth",
                    unit: "km/day",
                    statistic: "slope",
                },
                growth,
                None,
                "reported only: drift caused by sqrt(mu/a^3) in the mean motion field of an element set",
            ),
            Check::new(
                "sgp4/kepler-slot/closed-form",
                CheckedQuantity {
                    quantity: "in-track growth minus -dM/dt(J2) a and the secular terms of J2^2 and J4",
                    unit: "km/day",
                    statistic: "slope",
                },
                growth
                    - self.causes.kepler_slot_km_per_day
                    - self.causes.drifts_km_per_day(ZonalHarmonics::Full)[0],
                // The chord of a drift of some degrees, and its own second order.
                self.gate(
                    self.growth_gate_km_per_day(ZonalHarmonics::Full)
                        + 3e-3 * self.causes.kepler_slot_km_per_day.abs(),
                ),
                self.reason("the drift is the J2 term of dM/dt, up to second order"),
            ),
        ]
    }
}

#[cfg(test)]
mod tests;

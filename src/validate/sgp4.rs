//! The J2 propagation against SGP4: an error budget by cause.
//!
//! A single number would explain nothing. Mean J2 and SGP4 differ by (a) the constant radius shift
//! of the first-order short-period theory, (b) its periodic terms, (c) the frozen eccentricity
//! forced by J3, and (d) second-order secular terms. Each has a closed form at e = 0 from which the
//! gates are derived, so they follow the inclination and altitude of the design.

pub(super) mod causes;
mod element_sets;
mod frozen;
pub(super) mod rates;
mod sweep;
mod verification;

use super::decisions::{DecisionGates, TrajectoryPair, flip_gate};
use super::residuals::{BudgetLine, compare};
use super::{Check, CheckedQuantity, Findings, Subject, ValidateError};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::orbit::osculating::OsculatingOrbit;
use crate::orbit::sgp4::{MeanMotionSlot, Sgp4Mode, Sgp4Orbit, Sgp4Theory, ZonalHarmonics};
use crate::time::TimeGrid;
use causes::{Causes, is_deep_space};

pub use sweep::{SweepCell, SweepLine};
pub use verification::against_the_verification_set;

/// The design propagated by SGP4 and by J2, each once.
struct Propagations {
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
                Sgp4Orbit::from_mean_elements_with(elements, subject.epoch(), slot, theory)
            })
        };
        let zonals = |zonals: ZonalHarmonics| Sgp4Theory {
            geopotential: zonals.wgs72(),
            ..Sgp4Theory::STANDARD
        };
        let slot = subject.parts.slot;
        Ok(Self {
            mean_j2: subject
                .propagate_on(grid, |elements| Ok((subject.parts.mean_j2)(elements)))?,
            osculating_j2: subject
                .propagate_on(grid, |elements| Ok(OsculatingOrbit::new(elements)))?,
            sgp4: by(slot, Sgp4Theory::STANDARD)?,
            no_j3j4: by(slot, zonals(ZonalHarmonics::J2Only))?,
            no_j3: by(slot, zonals(ZonalHarmonics::WithoutJ3))?,
            kepler_slot: by(MeanMotionSlot::Kepler, Sgp4Theory::STANDARD)?,
            design_constants: by(slot, Sgp4Theory::with_design_constants())?,
            improved: by(
                slot,
                Sgp4Theory {
                    mode: Sgp4Mode::Improved,
                    ..Sgp4Theory::STANDARD
                },
            )?,
        })
    }

    /// The first `count` cases of the budget: J2 against SGP4, then SGP4 against its own variants.
    fn budget(&self, count: usize) -> Result<Vec<BudgetLine>, EphemerisError> {
        let cases: [(&str, &str, &Ephemeris, &Ephemeris); 8] = [
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
        ];
        cases
            .into_iter()
            .take(count)
            .map(|(case, cause, first, second)| compare(case, cause, first, second))
            .collect()
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
    let mut findings = against_the_verification_set();
    let propagations = Propagations::new(subject, subject.grid())?;
    let budget = propagations.budget(usize::MAX)?;
    let scale = GateScale::of(subject);
    findings.checks.extend(scale.budget_checks(&budget));
    findings.append(sweep::over_inclination_and_altitude(subject)?);
    findings.checks.extend(rates::checks(subject, &scale)?);
    findings.checks.extend(frozen::checks(subject, &scale)?);
    let written = element_sets::WrittenSets::new(subject)?;
    findings.append(written.findings(subject, &propagations.sgp4)?);
    let gates = scale.decision_gates(subject);
    for (name, second) in [
        ("sgp4/decisions", &propagations.sgp4),
        ("sgp4/tle/decisions", &written.propagated),
    ] {
        let seen = TrajectoryPair {
            evaluator: subject.evaluator,
            first: &propagations.mean_j2,
            second,
        };
        findings.append(seen.compare(name, gates)?);
    }
    findings.budget.splice(0..0, budget);
    Ok(findings)
}

/// The closed forms for this orbit and span.
struct GateScale {
    causes: Causes,
    days: f64,
    deep_space: bool,
}

impl GateScale {
    fn of(subject: &Subject<'_>) -> Self {
        let orbit = subject.orbit();
        Self {
            causes: Causes::of(&orbit),
            days: subject.days(),
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

    fn decision_gates(&self, subject: &Subject<'_>) -> Option<DecisionGates> {
        let [radial, in_track, cross_track] =
            self.causes.rms_gates_km(ZonalHarmonics::Full, self.days);
        let orbit = subject.orbit();
        let mask_deg = subject.setup().mask.degrees();
        let along = in_track.hypot(cross_track);
        let flips = flip_gate(orbit.semi_major_axis_km, mask_deg, radial, along);
        self.gate(flips).map(|flips| DecisionGates {
            flips,
            satellites: subject.design.satellite_count() as f64,
        })
    }

    fn budget_checks(&self, budget: &[BudgetLine]) -> Vec<Check> {
        let causes = &self.causes;
        let bounds = |line: &BudgetLine| match line.case.as_str() {
            "mean-j2/sgp4" => Some(causes.rms_gates_km(ZonalHarmonics::Full, self.days)),
            "mean-j2/sgp4-no-j3j4" => Some(causes.rms_gates_km(ZonalHarmonics::J2Only, self.days)),
            "osculating-j2/sgp4-no-j3j4" => {
                Some(causes.osculating_gates_km(ZonalHarmonics::J2Only, self.days))
            }
            "osculating-j2/sgp4" => {
                Some(causes.osculating_gates_km(ZonalHarmonics::Full, self.days))
            }
            _ => None,
        };
        let mut checks = Vec::new();
        for line in budget {
            if let Some(bounds) = bounds(line) {
                checks.extend(self.line_checks(line, bounds));
            }
        }
        if let [_, without_j3j4, _, _, kepler, ..] = budget {
            checks.push(self.radius_check(without_j3j4));
            checks.extend(self.slot_checks(kepler));
        }
        checks
    }

    /// RMS of a case by axis, and the growth of its mean.
    fn line_checks(&self, line: &BudgetLine, bounds: [f64; 3]) -> Vec<Check> {
        let rms = [
            ("radial", line.rms_km.radial),
            ("in-track", line.rms_km.in_track),
            ("cross-track", line.rms_km.cross_track),
        ];
        let mut checks: Vec<Check> = rms
            .into_iter()
            .zip(bounds)
            .map(|((axis, value), bound)| {
                Check::new(
                    &format!("sgp4/{}/{axis}-rms", line.case),
                    CheckedQuantity {
                        quantity: &format!("{axis} difference"),
                        unit: "km",
                        statistic: "rms",
                    },
                    value,
                    self.gate(bound),
                    self.reason("closed forms of radius shift, short-period terms, frozen eccentricity and second order, plus 15 %"),
                )
            })
            .collect();
        checks.push(Check::new(
            &format!("sgp4/{}/in-track-growth", line.case),
            CheckedQuantity {
                quantity: "in-track growth",
                unit: "km/day",
                statistic: "slope",
            },
            line.growth_km_per_day.in_track,
            self.gate(self.causes.growth_gate_km_per_day(self.days)),
            self.reason("second-order secular terms of J2 and J4: (2 + 12 cos^4 i) J2^2 n a, plus the residual of an incomplete revolution"),
        ));
        checks
    }

    fn radius_check(&self, without_j3j4: &BudgetLine) -> Check {
        let causes = &self.causes;
        // Terms of relative order J2 of the short-period theory, SGP4's floor of e, and e itself.
        let bound = 0.03
            + 0.02 * causes.radius_shift_km.abs()
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
            self.reason("the short-period theory of J2 shifts the mean radius by a constant that is known to first order"),
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
                    quantity: "in-track growth minus -dM/dt(J2) a",
                    unit: "km/day",
                    statistic: "slope",
                },
                growth - self.causes.kepler_slot_km_per_day,
                self.gate(self.causes.growth_gate_km_per_day(self.days)),
                self.reason("the drift is the J2 term of dM/dt, up to second order"),
            ),
        ]
    }
}

#[cfg(test)]
mod tests;

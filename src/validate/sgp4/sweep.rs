//! The budget by cause over inclinations and altitudes: a closed form that is right for one design
//! may be so by chance.

use super::{GateScale, Propagations};
use crate::constellation::{Pattern, Shell, ShellParameters};
use crate::time::TimeGrid;
use crate::units::SECONDS_PER_DAY;
use crate::validate::distribution::{Distribution, Residual};
use crate::validate::residuals::Ric;
use crate::validate::{Check, CheckedQuantity, Findings, Subject, ValidateError};
use serde::{Deserialize, Serialize};

/// From where the mean radius shift is largest, past 54.7°, where the common mean motion mistake
/// cancels out, to a sun-synchronous orbit.
const INCLINATIONS_DEG: [f64; 8] = [30.0, 40.0, 50.0, 55.0, 60.0, 70.0, 86.4, 98.0];

const ALTITUDES_KM: [f64; 3] = [400.0, 925.0, 1500.0];

/// Time between samples, s: about eleven per revolution.
const STEP_S: f64 = 480.0;

/// A case of the budget in a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepLine {
    /// The case, as in the budget.
    pub case: String,
    /// Root mean square, km.
    pub rms_km: Ric,
    /// Slope of the mean of the constellation, km/day.
    pub growth_km_per_day: Ric,
}

/// The budget of a circular pattern at an inclination and altitude.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepCell {
    /// Inclination, degrees.
    pub inclination_deg: f64,
    /// Altitude, km.
    pub altitude_km: f64,
    /// The cases of the model of the study and of J2 against SGP4.
    pub budget: Vec<SweepLine>,
    /// The largest value of this cell as a fraction of its gate.
    pub share_of_gate: f64,
}

/// A value of a cell as a fraction of its gate.
type Share = Residual<(f64, f64, String)>;

/// The budget in each cell, and how close its values come to the gates from closed forms.
pub(super) fn over_inclination_and_altitude(
    subject: &Subject<'_>,
) -> Result<Findings, ValidateError> {
    let mut findings = Findings::default();
    let mut shares: Vec<Share> = Vec::new();
    for inclination_deg in INCLINATIONS_DEG {
        for altitude_km in ALTITUDES_KM {
            let shell = Shell::new(ShellParameters {
                pattern: Pattern::Delta,
                planes: 3,
                // Four satellites in a plane cancel harmonics of order one to three.
                satellites_per_plane: 4,
                phasing: 1,
                inclination_deg,
                altitude_km,
            })?;
            let (cell, found) = cell(&Subject { shell, ..*subject })?;
            findings.sweep.push(cell);
            shares.extend(found);
        }
    }
    let name = format!("sgp4/{}/sweep", subject.model_label());
    let name = name.as_str();
    let worst = shares.iter().map(|one| one.value).fold(0.0, f64::max);
    findings.checks.push(Check::new(
        name,
        CheckedQuantity {
            quantity: "largest fraction of a gate over inclination and altitude",
            unit: "1",
            statistic: "max",
        },
        worst,
        Some(1.0),
        "the closed forms are valid from 30 to 98 deg and from 400 to 1500 km, not just by chance for one design",
    ));
    findings.distributions.extend(Distribution::of(
        name,
        ["fraction of the gate", "1"],
        &shares,
        |(inclination, altitude, check)| format!("{check} at {inclination} deg, {altitude} km"),
    ));
    Ok(findings)
}

fn cell(subject: &Subject<'_>) -> Result<(SweepCell, Vec<Share>), ValidateError> {
    let span_s = subject.days() * SECONDS_PER_DAY;
    let step_s = STEP_S.max(subject.grid().step_s()).min(span_s);
    let grid = TimeGrid::new(subject.epoch(), span_s, step_s)?;
    let budget = Propagations::new(subject, grid)?.budget()?;
    let at = (subject.shell.inclination_deg(), subject.shell.altitude_km());
    let checks = GateScale::of(subject, grid).budget_checks(&budget);
    let shares: Vec<Share> = checks
        .into_iter()
        .filter_map(|check| {
            Some(Residual {
                value: check.value.abs() / check.gate?,
                input: (at.0, at.1, check.name),
            })
        })
        .collect();
    let lines = budget.into_iter().map(|line| SweepLine {
        case: line.case,
        rms_km: line.rms_km,
        growth_km_per_day: line.growth_km_per_day,
    });
    let cell = SweepCell {
        inclination_deg: at.0,
        altitude_km: at.1,
        budget: lines.collect(),
        share_of_gate: shares.iter().map(|one| one.value).fold(0.0, f64::max),
    };
    Ok((cell, shares))
}

//! The figures of a validation: its budget, how much of its gate each check uses, and the residuals.

use super::budget::budget;
use super::{Chart, RowChart};
use crate::run::ValidateResult;
use crate::validate::distribution::Distribution;

/// Caption and chart of each figure that the result has numbers for.
pub(crate) fn residual_figures(result: &ValidateResult) -> Vec<(&'static str, Chart)> {
    let mut figures = Vec::new();
    if let Ok(plate) = budget(Some(result)) {
        figures.push((
            "Root mean square differences of each case, by axis.",
            plate.chart,
        ));
    }
    if let Some(chart) = shares_of_gates(result) {
        figures.push((
            "Size of each check as a fraction of its gate: 1 is the gate; a check of exactly 0 has no mark.",
            Chart::Rows(chart),
        ));
    }
    let residuals = residuals(result).into_iter();
    figures.extend(residuals.map(|chart| {
        (
            "Residuals over all inputs: median, quantiles and the largest.",
            Chart::Rows(chart),
        )
    }));
    figures
}

fn shares_of_gates(result: &ValidateResult) -> Option<RowChart> {
    let checks = result.findings.checks.iter();
    let share = |gate: f64, value: f64| if gate > 0.0 { value.abs() / gate } else { 0.0 };
    let rows: Vec<(String, Vec<f64>)> = checks
        .filter_map(|check| Some((check.name.clone(), vec![share(check.gate?, check.value)])))
        .filter(|(_, share)| share[0].is_finite())
        .collect();
    (!rows.is_empty()).then(|| RowChart {
        title: "Checks and their gates".to_owned(),
        x: "size of the value by its gate".to_owned(),
        marks: vec!["value".to_owned()],
        rows,
    })
}

/// A chart for each unit.
fn residuals(result: &ValidateResult) -> Vec<RowChart> {
    let findings = &result.findings;
    let of_budget = findings
        .budget
        .iter()
        .filter_map(|line| line.distance.as_ref());
    let mut units: Vec<(&str, Vec<&Distribution>)> = Vec::new();
    for one in of_budget.chain(&findings.distributions) {
        match units.iter_mut().find(|(unit, _)| *unit == one.unit) {
            Some((_, of)) => of.push(one),
            None => units.push((&one.unit, vec![one])),
        }
    }
    let chart = |(unit, of): (&str, Vec<&Distribution>)| RowChart {
        title: "Residuals".to_owned(),
        x: format!("size of the difference ({unit})"),
        marks: ["median", "95 %", "99 %", "largest"]
            .map(str::to_owned)
            .to_vec(),
        rows: of
            .into_iter()
            .map(|one| {
                (
                    one.name.clone(),
                    vec![one.median, one.q95, one.q99, one.max],
                )
            })
            .collect(),
    };
    units.into_iter().map(chart).collect()
}

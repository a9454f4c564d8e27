//! The page of a merged sweep.

use super::evidence_page::{EvidencePageError, write_evidence};
use super::figures::{Better, sweep_figures};
use super::section::{Headline, ReportSection};
use super::sweep_summary::{MEASURES, SweepSummary, ValueRange};
use super::{Align, Table, shown};
use crate::run::sweep::{SweepIndex, SweepPlan};
use crate::units::counted;
use std::io::Write;

/// Writes the page of a merged sweep, of which `summary` has all designs.
///
/// # Errors
/// If a figure cannot be drawn, or writing fails.
pub fn write_sweep_page(
    plan: &SweepPlan,
    index: &SweepIndex,
    summary: &SweepSummary,
    to: impl Write,
) -> Result<(), EvidencePageError> {
    let scenario = &plan.scenario;
    let designs = |count: u64| counted(usize::try_from(count).unwrap_or(usize::MAX), "design");
    let mut notes = vec![format!(
        "{} has every design with every metric, SHA-256 {}",
        index.table, index.sha256
    )];
    if index.without_metrics > 0 {
        notes.push(format!(
            "{} without metrics: they cannot be propagated",
            designs(index.without_metrics)
        ));
    }
    let headline = Headline {
        title: format!("Sweep of {}", scenario.name),
        lines: vec![format!(
            "Scenario {} ({}), without its optimiser, navwalker {}.",
            scenario.name, scenario.hash, index.version
        )],
        verdict: format!("{} of the {}.", designs(index.designs), plan.source),
        notes,
    };
    let sections = vec![front(summary), metrics(summary)];
    // Their titles say what they show.
    let figures = sweep_figures(summary).into_iter();
    let figures = figures.map(|chart| (String::new(), chart));
    write_evidence(headline, figures.collect(), sections, to)
}

/// The designs that are better in the first measure than all with fewer satellites.
fn front(summary: &SweepSummary) -> ReportSection {
    let mut columns = vec![("satellites", Align::Right), ("design", Align::Left)];
    columns.push((MEASURES[0].0, Align::Right));
    let mut table = Table::new(&columns);
    let mut best = f64::INFINITY;
    for group in summary.variables[0].groups() {
        let found = group.ranges[0]
            .as_ref()
            .map(|range| range.best(Better::Low));
        let Some((value, design)) = found.filter(|(value, _)| *value < best) else {
            continue;
        };
        best = *value;
        let [low, high] = group.ends;
        let satellites = if low < high {
            format!("{low} to {high}")
        } else {
            low.to_string()
        };
        table.row([satellites, design.clone(), shown::pdop(Some(*value))]);
    }
    ReportSection {
        title: "Front of satellites against mean PDOP".to_owned(),
        caption: "The designs whose mean PDOP is below that of every design with fewer satellites; navwalker optimize \
                  --from gives the front for other goals."
            .to_owned(),
        table,
        remarks: Vec::new(),
    }
}

/// The range of each metric.
fn metrics(summary: &SweepSummary) -> ReportSection {
    let mut table = Table::new(&[
        ("metric", Align::Left),
        ("least", Align::Right),
        ("of", Align::Left),
        ("greatest", Align::Right),
        ("of", Align::Left),
        ("designs without", Align::Right),
    ]);
    for metric in &summary.metrics {
        let Some(ValueRange { least, greatest }) = &metric.range else {
            continue;
        };
        table.row([
            metric.name.clone(),
            shown::significant(least.0),
            least.1.clone(),
            shown::significant(greatest.0),
            greatest.1.clone(),
            metric.without.to_string(),
        ]);
    }
    ReportSection {
        title: "Metrics".to_owned(),
        caption: "Least and greatest value of each metric over all designs, and the first design that has it; names as \
                  in the table."
            .to_owned(),
        table,
        remarks: Vec::new(),
    }
}

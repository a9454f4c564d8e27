//! Results as CSV, with the unit of each column in its header.

use super::{ConstellationResult, DesignSummary, OptimizeResult};
use crate::evaluate::{DopStatistics, Metrics};
use crate::formats::csv::write_records;
use crate::optimize::Record;
use crate::stats::Summary;
use crate::validate::Check;
use ::csv::Writer;
use serde::Serialize;

/// Why a table cannot be written; a table in memory always can.
pub type CsvError = ::csv::Error;

const DESIGN_HEADER: [&str; 9] = [
    "notation",
    "pattern",
    "planes",
    "satellites_per_plane",
    "satellites",
    "phasing",
    "inclination_deg",
    "altitude_km",
    "eccentricity",
];

const METRICS_HEADER: [&str; 12] = [
    "mean_visible",
    "mean_pdop",
    "cvar_pdop",
    "cvar_level",
    "p50_pdop",
    "p95_pdop",
    "p99_pdop",
    "max_pdop",
    "solved_fraction",
    "availability",
    "j_pos",
    "j_cost",
];

fn design_cells(design: &DesignSummary) -> Vec<String> {
    vec![
        design.notation.clone(),
        design.pattern.clone(),
        design.planes.to_string(),
        design.satellites_per_plane.to_string(),
        design.satellites.to_string(),
        design.phasing.to_string(),
        design.inclination_deg.to_string(),
        design.altitude_km.to_string(),
        design.eccentricity.to_string(),
    ]
}

fn metrics_cells(metrics: &Metrics) -> Vec<String> {
    [
        Some(metrics.mean_visible),
        metrics.mean_pdop,
        metrics.cvar_pdop,
        Some(metrics.cvar_level),
        metrics.p50_pdop,
        metrics.p95_pdop,
        metrics.p99_pdop,
        metrics.max_pdop,
        Some(metrics.solved_fraction),
        Some(metrics.availability),
        metrics.j_pos,
        metrics.j_cost,
    ]
    .into_iter()
    .map(optional)
    .collect()
}

/// The shortest digits that read back; empty for a metric without a value.
pub(super) fn optional(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

pub(super) fn text(writer: Writer<Vec<u8>>) -> Result<String, CsvError> {
    let bytes = writer
        .into_inner()
        .map_err(|error| ::csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Designs and their metrics, one a row.
///
/// # Errors
/// Never for a table in memory.
pub fn metrics_csv<'a>(
    rows: impl IntoIterator<Item = (&'a DesignSummary, &'a Metrics)>,
) -> Result<String, CsvError> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(DESIGN_HEADER.iter().chain(&METRICS_HEADER))?;
    for (design, metrics) in rows {
        writer.write_record(
            design_cells(design)
                .into_iter()
                .chain(metrics_cells(metrics)),
        )?;
    }
    text(writer)
}

/// The metrics of a constellation from files, in one row.
///
/// # Errors
/// Never for a table in memory.
pub fn constellation_csv(result: &ConstellationResult) -> Result<String, CsvError> {
    let mut writer = Writer::from_writer(Vec::new());
    let header = ["constellation", "format", "content", "satellites"];
    writer.write_record(header.iter().chain(&METRICS_HEADER))?;
    let constellation = &result.constellation;
    let mut cells = vec![
        constellation.name.clone(),
        constellation.format.clone(),
        constellation.content.clone(),
        constellation.satellites.to_string(),
    ];
    cells.extend(metrics_cells(&result.metrics));
    writer.write_record(cells)?;
    text(writer)
}

/// The front of a search, one member a row.
///
/// # Errors
/// Never for a table in memory.
pub fn front_csv(result: &OptimizeResult) -> Result<String, CsvError> {
    let mut writer = Writer::from_writer(Vec::new());
    let header = ["index"]
        .iter()
        .chain(&DESIGN_HEADER)
        .chain(&METRICS_HEADER);
    writer.write_record(header.chain(&["membership", "membership_sum", "chosen"]))?;
    for member in &result.front {
        let mut cells = vec![member.index.to_string()];
        cells.extend(design_cells(&member.design));
        cells.extend(metrics_cells(&member.metrics));
        cells.extend([
            member.membership.to_string(),
            member.membership_sum.to_string(),
            member.chosen.to_string(),
        ]);
        writer.write_record(cells)?;
    }
    text(writer)
}

/// The generations of a search, one a row; `best_<objective>` as the optimiser minimises it.
///
/// # Errors
/// Never for a table in memory.
pub fn history_csv(history: &[Record], objectives: &[String]) -> Result<String, CsvError> {
    let mut writer = Writer::from_writer(Vec::new());
    let fixed = [
        "generation",
        "evaluations",
        "hypervolume",
        "front_size",
        "feasible",
    ];
    let best = objectives
        .iter()
        .map(|name| format!("best_{}", name.replace('-', "_")));
    writer.write_record(fixed.into_iter().map(str::to_owned).chain(best))?;
    for record in history {
        let mut cells = vec![
            record.generation.to_string(),
            record.evaluations.to_string(),
            optional(record.hypervolume),
            record.front_size.to_string(),
            record.feasible.to_string(),
        ];
        let ideal = |n: usize| {
            optional(
                record
                    .ideal
                    .as_ref()
                    .and_then(|ideal| ideal.get(n).copied()),
            )
        };
        cells.extend((0..objectives.len()).map(ideal));
        writer.write_record(cells)?;
    }
    text(writer)
}

/// Records whose fields are the columns, one a row: instants or points of a series.
///
/// # Errors
/// Never for a table in memory.
pub fn records_csv(rows: &[impl Serialize]) -> Result<String, CsvError> {
    let mut bytes = Vec::new();
    write_records(&mut bytes, rows)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The dilutions of precision of a design, one a row: name, mean, quantiles, maximum and tail.
///
/// # Errors
/// Never for a table in memory.
pub fn dops_csv(dops: &DopStatistics) -> Result<String, CsvError> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(["dop", "mean", "p50", "p95", "p99", "max", "cvar"])?;
    for (name, summary) in dops.named() {
        let cell = |value: fn(&Summary) -> f64| optional(summary.as_ref().map(value));
        writer.write_record([
            name,
            cell(|s| s.mean),
            cell(|s| s.p50),
            cell(|s| s.p95),
            cell(|s| s.p99),
            cell(|s| s.max),
            cell(|s| s.cvar),
        ])?;
    }
    text(writer)
}

/// The checks of a validation, one a row.
///
/// # Errors
/// Never for a table in memory.
pub fn checks_csv(checks: &[Check]) -> Result<String, CsvError> {
    records_csv(checks)
}

//! Results as CSV, with the unit of each column in its header.

use super::{ConstellationResult, ConstellationSummary, EvaluateResult};
use crate::evaluate::{DopStatistics, Metrics};
use crate::formats::csv::write_records;
use crate::run::DesignSummary;
use crate::run::columns::{cells, fields, optional};
use crate::run::tables::text;
use crate::stats::Summary;
use ::csv::Writer;
use serde::Serialize;
use std::io;

/// A design and its metrics in one row, with the constrained quantities that are in neither.
///
/// # Errors
/// Never for a table in memory.
pub fn metrics_csv(result: &EvaluateResult) -> io::Result<String> {
    let (of_design, of_metrics) = (DesignSummary::columns(), fields::<Metrics>());
    let columns = of_design.iter().chain(of_metrics).copied();
    let mut header: Vec<String> = columns.map(str::to_owned).collect();
    let mut row = cells(&result.design, of_design)?;
    row.extend(cells(&result.metrics, of_metrics)?);
    for check in &result.constraints {
        let column = check.quantity.replace('-', "_");
        if !header.contains(&column) {
            header.push(column);
            row.push(optional(check.value));
        }
    }
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    writer.write_record(row)?;
    text(writer)
}

/// The metrics of a constellation from files, in one row.
///
/// # Errors
/// Never for a table in memory.
pub fn constellation_csv(result: &ConstellationResult) -> io::Result<String> {
    let (of_files, of_metrics) = (fields::<ConstellationSummary>(), fields::<Metrics>());
    let mut writer = Writer::from_writer(Vec::new());
    let column = |name: &'static str| {
        if name == "name" {
            "constellation"
        } else {
            name
        }
    };
    let header = of_files.iter().map(|name| column(name));
    writer.write_record(header.chain(of_metrics.iter().copied()))?;
    let mut row = cells(&result.constellation, of_files)?;
    row.extend(cells(&result.metrics, of_metrics)?);
    writer.write_record(row)?;
    text(writer)
}

/// Records whose fields are the columns, one per row: instants or points of a series.
///
/// # Errors
/// Never for a table in memory.
pub fn records_csv(rows: &[impl Serialize]) -> io::Result<String> {
    let mut bytes = Vec::new();
    write_records(&mut bytes, rows)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// The dilutions of precision of a design, one per row: name, mean, quantiles, maximum and tail.
///
/// # Errors
/// Never for a table in memory.
pub fn dops_csv(dops: &DopStatistics) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let statistics = fields::<Summary>();
    writer.write_record(["dop"].iter().chain(statistics))?;
    for (name, summary) in dops.named() {
        let mut row = vec![name.to_owned()];
        row.extend(cells(&summary, statistics)?);
        writer.write_record(row)?;
    }
    text(writer)
}

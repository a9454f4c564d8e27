//! The files of a study: its tables, and the data of its figures.

use super::StudyResult;
use crate::run::columns::optional;
use crate::run::tables::text;
use crate::study::published::{Curve, FigureData, MeasuredTable, PlacedDesign};
use ::csv::Writer;
use std::io;

impl MeasuredTable {
    /// The stems of its files.
    pub(super) fn stems(&self) -> Vec<String> {
        let mut stems = vec![self.file.clone()];
        if !self.sensitivity.is_empty() {
            stems.push(format!("{}-sensitivity", self.file));
        }
        stems
    }
}

/// Name and contents of every table of a study, and of the data of its figures, as CSV.
///
/// # Errors
/// Never for tables in memory.
pub fn study_tables(study: &StudyResult) -> io::Result<Vec<(String, String)>> {
    let mut files = Vec::new();
    for table in &study.tables {
        let contents = [rows_csv(table)?, sensitivity_csv(table)?];
        files.extend(table.stems().into_iter().zip(contents));
    }
    for figure in &study.figures {
        let contents = match &figure.data {
            FigureData::Objectives { objectives, places } => places_csv(
                places,
                objectives.map(|objective| column(&objective.to_string())),
            )?,
            FigureData::VisibleDistribution(curves) => distribution_csv(curves)?,
            FigureData::MaxPdopCourse(curves) => course_csv(curves)?,
        };
        files.push((figure.name.clone(), contents));
    }
    let named = |(stem, contents)| (format!("{stem}.csv"), contents);
    Ok(files.into_iter().map(named).collect())
}

fn cell(value: f64) -> String {
    value.to_string()
}

/// The name of a metric as a column.
fn column(metric: &str) -> String {
    metric.replace('-', "_")
}

/// A table with the published numbers and ours, one row each.
fn rows_csv(table: &MeasuredTable) -> io::Result<String> {
    let metrics: Vec<String> = table
        .columns
        .iter()
        .map(|one| column(&one.metric))
        .collect();
    let printed = table.rows.first().map_or(0, |row| row.published.len());
    let mut header = ["row", "design", "satellites"].map(str::to_owned).to_vec();
    header.extend(
        metrics
            .iter()
            .take(printed)
            .map(|metric| format!("published_{metric}")),
    );
    header.extend(metrics.iter().cloned());
    for element in &table.fits {
        header.push(format!("fitting_{}", column(element)));
        header.extend(metrics.iter().map(|metric| format!("fitting_{metric}")));
    }
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(header)?;
    for row in &table.rows {
        let satellites = row.satellites.map_or_else(String::new, |n| n.to_string());
        let mut cells = vec![row.name.clone(), row.design.clone(), satellites];
        cells.extend(row.published.iter().map(|value| cell(*value)));
        cells.extend(row.computed.iter().map(|value| optional(*value)));
        for fit in &row.fits {
            cells.push(optional(fit.value));
            cells.extend(fit.computed.iter().map(|value| optional(*value)));
        }
        writer.write_record(cells)?;
    }
    text(writer)
}

/// The sensitivity of every row to every assumption.
fn sensitivity_csv(table: &MeasuredTable) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let metrics = table.columns.iter().map(|one| column(&one.metric));
    let first = ["assumption", "row"].map(str::to_owned);
    writer.write_record(first.into_iter().chain(metrics))?;
    for under in &table.sensitivity {
        for (row, values) in table.rows.iter().zip(&under.computed) {
            let first = [under.assumption.clone(), row.name.clone()];
            let values = values.iter().map(|value| optional(*value));
            writer.write_record(first.into_iter().chain(values))?;
        }
    }
    text(writer)
}

/// Designs in the plane of the objectives, with their fuzzy memberships over each set.
fn places_csv(places: &[PlacedDesign], objectives: [String; 2]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let [x, y] = &objectives;
    writer.write_record([
        "set",
        "scheme",
        "design",
        x,
        y,
        "membership",
        "membership_sum",
    ])?;
    for place in places {
        let [x, y] = place.objectives;
        let numbers = [x, y, place.membership, place.membership_sum];
        let names = [
            place.set.to_owned(),
            place.scheme.clone(),
            place.design.clone(),
        ];
        writer.write_record(names.into_iter().chain(numbers.map(cell)))?;
    }
    text(writer)
}

/// The distribution function of `E_g(N_visible)` over the instants.
fn distribution_csv(curves: &[Curve]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(["name", "design", "mean_visible", "cumulative_share"])?;
    for curve in curves {
        let sorted = curve.sorted_visible();
        for (k, visible) in sorted.iter().enumerate() {
            let share = (k + 1) as f64 / sorted.len() as f64;
            writer.write_record([
                curve.name.clone(),
                curve.design.clone(),
                cell(*visible),
                cell(share),
            ])?;
        }
    }
    text(writer)
}

/// `PDOP_max` and `E_g(PDOP)` over time.
fn course_csv(curves: &[Curve]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "name",
        "design",
        "elapsed_s",
        "mean_visible",
        "mean_pdop",
        "max_pdop",
    ])?;
    for curve in curves {
        for epoch in &curve.epochs {
            writer.write_record([
                curve.name.clone(),
                curve.design.clone(),
                cell(epoch.elapsed_s),
                cell(epoch.mean_visible),
                optional(epoch.mean_pdop),
                optional(epoch.max_pdop),
            ])?;
        }
    }
    text(writer)
}

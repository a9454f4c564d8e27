//! The files of the reproduction: its tables and the data of the paper's figures.

use super::ReproduceResult;
use crate::report::studies::rows_csv;
use crate::run::columns::optional;
use crate::run::tables::text;
use crate::study::paper::{Curve, PlacedDesign, Reproduction};
use ::csv::Writer;
use std::io;

/// Names of the tables of the study.
pub const REPRODUCTION_FILES: [&str; 8] = [
    "statements.csv",
    "table2.csv",
    "sensitivity.csv",
    "figure-2.csv",
    "figure-3a.csv",
    "figure-3b.csv",
    "figure-4a.csv",
    "figure-4b.csv",
];

/// Name and contents of every table of the study, as CSV.
///
/// # Errors
/// Never for tables in memory.
pub fn reproduction_files(result: &ReproduceResult) -> io::Result<Vec<(&'static str, String)>> {
    let (study, figures) = (&result.study, &result.study.figures);
    let tables = [
        rows_csv(result.statements.iter().map(|one| (result.name, one)))?,
        table2_csv(study)?,
        sensitivity_csv(study)?,
        places_csv(&figures.places)?,
        distribution_csv(&figures.constellations)?,
        course_csv(&figures.constellations)?,
        distribution_csv(&figures.strategies)?,
        course_csv(&figures.strategies)?,
    ];
    Ok(REPRODUCTION_FILES.into_iter().zip(tables).collect())
}

fn cell(value: f64) -> String {
    value.to_string()
}

/// Table II with the paper's values and ours, one row each.
fn table2_csv(study: &Reproduction) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "row",
        "design",
        "satellites",
        "paper_mean_visible",
        "paper_mean_pdop",
        "mean_visible",
        "mean_pdop",
        "j_pos",
        "j_cost",
        "fitting_inclination_deg",
        "fitting_mean_visible",
        "fitting_mean_pdop",
        "fitting_j_pos",
        "fitting_j_cost",
    ])?;
    for row in &study.rows {
        let mut cells = vec![
            row.name.clone(),
            row.design.clone(),
            row.satellites.to_string(),
            cell(row.paper_mean_visible),
            cell(row.paper_mean_pdop),
        ];
        let (printed, fitting) = (&row.as_printed, &row.at_fitting);
        cells.push(cell(printed.mean_visible));
        cells.extend([printed.mean_pdop, printed.j_pos, printed.j_cost].map(optional));
        cells.push(optional(row.fitting_inclination_deg));
        cells.push(cell(fitting.mean_visible));
        cells.extend([fitting.mean_pdop, fitting.j_pos, fitting.j_cost].map(optional));
        writer.write_record(cells)?;
    }
    text(writer)
}

/// The sensitivity of every row to every assumption.
fn sensitivity_csv(study: &Reproduction) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "assumption",
        "row",
        "mean_visible",
        "mean_pdop",
        "j_pos",
        "j_cost",
    ])?;
    for measured in &study.sensitivity {
        for (row, value) in study.rows.iter().zip(&measured.values) {
            writer.write_record([
                measured.assumption.clone(),
                row.name.clone(),
                cell(value.mean_visible),
                optional(value.mean_pdop),
                optional(value.j_pos),
                optional(value.j_cost),
            ])?;
        }
    }
    text(writer)
}

/// Figure 2: designs in the plane of both objectives, with their fuzzy memberships over each set.
fn places_csv(places: &[PlacedDesign]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "set",
        "scheme",
        "design",
        "j_pos",
        "j_cost",
        "membership",
        "membership_sum",
    ])?;
    for place in places {
        let numbers = [
            place.j_pos,
            place.j_cost,
            place.membership,
            place.membership_sum,
        ];
        let names = [
            place.set.to_owned(),
            place.scheme.clone(),
            place.design.clone(),
        ];
        writer.write_record(names.into_iter().chain(numbers.map(cell)))?;
    }
    text(writer)
}

/// Figures 3(a) and 4(a): the distribution function of `E_g(N_visible)` over the instants.
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

/// Figures 3(b) and 4(b): `PDOP_max` and `E_g(PDOP)` over the day.
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

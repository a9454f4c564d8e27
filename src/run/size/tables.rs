//! The tables of a search for the fewest satellites.

use super::super::columns::{cells, metric_columns, optional};
use super::super::results::DesignSummary;
use super::super::tables::text;
use super::{KeptConstraint, SizeResult};
use crate::search::size::{RejectionBasis, Witness};
use csv::Writer;
use std::io;

/// The designs with the fewest satellites, one per row, with their metrics and the margin of each constraint.
///
/// # Errors
/// Never for a table in memory.
pub fn size_csv(result: &SizeResult) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let metrics = metric_columns();
    let mut header = vec!["rank".to_owned()];
    header.extend(DesignSummary::columns().iter().map(|&name| name.to_owned()));
    header.extend(metrics.iter().map(|&name| name.to_owned()));
    header.push("margin".to_owned());
    let of = |constraint: &String| {
        let [value, margin] = ["value", "margin"].map(|what| format!("{what} of {constraint}"));
        [value, margin]
    };
    header.extend(result.constraints.iter().flat_map(of));
    writer.write_record(header)?;
    for one in &result.designs {
        let mut row = vec![one.rank.to_string()];
        row.extend(cells(&one.design, DesignSummary::columns())?);
        row.extend(cells(&one.metrics, &metrics)?);
        row.push(one.margin.to_string());
        let of = |one: &KeptConstraint| [optional(one.value), optional(one.margin)];
        row.extend(one.constraints.iter().flat_map(of));
        writer.write_record(row)?;
    }
    text(writer)
}

/// The columns of a certificate.
const CERTIFICATE_COLUMNS: [&str; 11] = [
    "satellites",
    "design",
    "constraint",
    "basis",
    "point",
    "latitude_deg",
    "longitude_deg",
    "elapsed_s",
    "share_at_rejection",
    "value_at_rejection",
    "samples_share",
];

/// The heading of a certificate.
#[must_use]
pub fn certificate_heading() -> String {
    CERTIFICATE_COLUMNS.join(",") + "\n"
}

/// The rows of a certificate.
///
/// # Errors
/// Never for a table in memory.
pub fn certificate_rows(witnesses: &[(usize, Witness)]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    for (satellites, one) in witnesses {
        let point = one.point.as_ref();
        writer.write_record([
            satellites.to_string(),
            one.design.clone(),
            one.constraint.clone(),
            basis_word(one.basis).to_owned(),
            point.map_or_else(String::new, |point| point.number.to_string()),
            optional(point.map(|point| point.latitude_deg)),
            optional(point.map(|point| point.longitude_deg)),
            optional(one.elapsed_s),
            optional(one.share_at_rejection),
            optional(one.value_at_rejection),
            one.samples_share.to_string(),
        ])?;
    }
    text(writer)
}

/// How a design was rejected, as in JSON.
#[must_use]
pub fn basis_word(basis: RejectionBasis) -> &'static str {
    match basis {
        RejectionBasis::Shells => "shells",
        RejectionBasis::Geometry => "geometry",
        RejectionBasis::Samples => "samples",
        RejectionBasis::Evaluation => "evaluation",
    }
}

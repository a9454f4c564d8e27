//! The tables of a run, with the unit of each column in its header.

use super::columns::{cells, fields, optional};
use super::{DesignSummary, FrontMember, OptimizeResult};
use crate::evaluate::Metrics;
use crate::optimize::Record;
use csv::Writer;
use std::io;

/// The front of a search, one member per row, including the fields of its design and metrics.
///
/// # Errors
/// Never for a table in memory.
pub fn front_csv(result: &OptimizeResult) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let header = fields::<FrontMember>().iter().flat_map(|name| match *name {
        "design" => fields::<DesignSummary>(),
        "metrics" => fields::<Metrics>(),
        // Objectives are metrics under another name.
        "objectives" => &[],
        _ => std::slice::from_ref(name),
    });
    writer.write_record(header)?;
    for member in &result.front {
        let mut row = Vec::new();
        for name in fields::<FrontMember>() {
            row.extend(match *name {
                "design" => cells(&member.design, fields::<DesignSummary>())?,
                "metrics" => cells(&member.metrics, fields::<Metrics>())?,
                "objectives" => Vec::new(),
                _ => cells(member, &[name])?,
            });
        }
        writer.write_record(row)?;
    }
    text(writer)
}

/// The generations of a search, one per row; `best_<objective>` as the optimiser minimises it.
///
/// # Errors
/// Never for a table in memory.
pub fn history_csv(history: &[Record], objectives: &[String]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let scalars: Vec<&str> = fields::<Record>()
        .iter()
        .filter(|name| !["ideal", "front"].contains(name))
        .copied()
        .collect();
    let best = objectives
        .iter()
        .map(|name| format!("best_{}", name.replace('-', "_")));
    writer.write_record(scalars.iter().map(|name| (*name).to_owned()).chain(best))?;
    for record in history {
        let ideal = |n: usize| optional(record.ideal.as_ref().and_then(|i| i.get(n).copied()));
        let mut row = cells(record, &scalars)?;
        row.extend((0..objectives.len()).map(ideal));
        writer.write_record(row)?;
    }
    text(writer)
}

/// The text of a table in memory.
pub(crate) fn text(writer: Writer<Vec<u8>>) -> io::Result<String> {
    let bytes = writer.into_inner().map_err(|error| error.into_error())?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

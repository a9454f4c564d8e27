//! The tables of a run, with the unit of each column in its header.

use super::columns::{cells, fields, metric_columns, optional};
use super::{DesignSummary, FrontMember};
use crate::constellation::shell_letters;
use crate::keyword::Keyword;
use crate::optimize::Record;
use crate::search::Quantity;
use csv::Writer;
use std::io;

/// The front of a search, one member per row, including the fields of its design and metrics and the
/// objectives and constrained quantities that are in neither; with names and files where members have them, and the
/// fields of each shell of a search among several (`a_planes`, `b_planes`), empty where it is.
///
/// # Errors
/// Never for a table in memory.
pub fn front_csv(front: &[FrontMember]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    let further = further_quantities(front);
    let shells = front.iter().map(|member| member.shells.len()).max();
    let shells = 0..shells.unwrap_or(0);
    let has_names = front.iter().any(|member| member.name.is_some());
    let has_files = front.iter().any(|member| member.files.is_some());
    let is_column = |name: &&&str| match **name {
        "name" => has_names,
        "files" => has_files,
        _ => true,
    };
    let columns: Vec<&str> = fields::<FrontMember>()
        .iter()
        .filter(is_column)
        .copied()
        .collect();
    let header = columns.iter().flat_map(|name| match *name {
        "design" => DesignSummary::columns().iter().map(|n| column(n)).collect(),
        "shells" => shells.clone().flat_map(shell_columns).collect(),
        "metrics" => {
            let first = front.iter().take(1);
            let on_demand = first.flat_map(|member| member.metrics.on_demand());
            let always = metric_columns().into_iter().map(column);
            always.chain(on_demand.map(|(name, _)| name)).collect()
        }
        "objectives" => further.iter().map(|name| column(name)).collect(),
        "constraints" => Vec::new(),
        _ => vec![column(name)],
    });
    writer.write_record(header)?;
    for member in front {
        let mut row = Vec::new();
        for name in &columns {
            row.extend(match *name {
                "design" => {
                    let has_others = member.files.is_some() || member.design.is_none();
                    let satellites = has_others.then(|| member.satellites());
                    design_cells(member.design.as_ref(), satellites)?
                }
                "files" => {
                    let files = member.files.as_ref();
                    vec![files.map_or_else(String::new, |files| files.names.join("+"))]
                }
                "shells" => {
                    let each = shells.clone().map(|place| shell_cells(member, place));
                    each.collect::<serde_json::Result<Vec<_>>>()?.concat()
                }
                "metrics" => {
                    let mut own = cells(&member.metrics, &metric_columns())?;
                    let on_demand = member.metrics.on_demand().into_iter();
                    own.extend(on_demand.map(|(_, value)| optional(value)));
                    own
                }
                "objectives" => {
                    let values = further.iter().map(|name| member.quantity(name));
                    values.map(optional).collect()
                }
                "constraints" => Vec::new(),
                _ => cells(member, &[name])?,
            });
        }
        writer.write_record(row)?;
    }
    text(writer)
}

/// The cells of a design. With `satellites`, the number of a constellation that also has satellites from files,
/// they say only that and the notation, since no other field describes all of them.
pub(crate) fn design_cells(
    design: Option<&DesignSummary>,
    satellites: Option<usize>,
) -> serde_json::Result<Vec<String>> {
    let columns = DesignSummary::columns();
    let mut row = match design {
        Some(design) => cells(design, columns)?,
        None => vec![String::new(); columns.len()],
    };
    let Some(satellites) = satellites else {
        return Ok(row);
    };
    for (name, cell) in columns.iter().zip(&mut row) {
        match *name {
            "notation" => {}
            "satellites" => *cell = satellites.to_string(),
            _ => cell.clear(),
        }
    }
    Ok(row)
}

/// The columns of a shell of the search.
fn shell_columns(place: usize) -> Vec<String> {
    let letters = shell_letters(place).to_lowercase();
    let columns = DesignSummary::columns().iter();
    columns.map(|name| format!("{letters}_{name}")).collect()
}

/// The cells of a shell of the search.
fn shell_cells(member: &FrontMember, place: usize) -> serde_json::Result<Vec<String>> {
    match member.shell(place) {
        Some(shell) => cells(shell, DesignSummary::columns()),
        None => Ok(vec![String::new(); DesignSummary::columns().len()]),
    }
}

/// The name of a quantity as a column.
fn column(name: &str) -> String {
    name.replace('-', "_")
}

/// Objectives and constrained quantities that are not columns of the design or the metrics.
fn further_quantities(front: &[FrontMember]) -> Vec<String> {
    let columns = [DesignSummary::columns(), &metric_columns()].concat();
    let first = front.first().into_iter();
    let names = first.flat_map(|member| {
        let objectives = member.objectives.iter().map(|(name, _)| name);
        objectives.chain(member.constraints.iter().map(|(name, _)| name))
    });
    names
        .filter(|name| !columns.contains(&column(name).as_str()))
        .filter(|name| !Quantity::from_keyword(name).is_ok_and(Quantity::is_on_demand))
        .cloned()
        .collect()
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

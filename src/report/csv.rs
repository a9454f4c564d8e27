//! Results as CSV, with the unit of each column in its header.

use super::evaluated::ConstellationEntry;
use super::phases::{PhaseRange, PhaseSpread, in_order};
use crate::evaluate::{DopStatistics, Series};
use crate::formats::csv::write_records;
use crate::run::DesignSummary;
use crate::run::columns::{cells, fields, metric_columns, optional};
use crate::run::tables::{design_cells, text};
use crate::search::Quantity;
use crate::stats::Summary;
use ::csv::Writer;
use serde::Serialize;
use std::io;

/// The columns of a table of constellations: name, design, files, metrics, further objectives and constrained
/// quantities, dilutions of precision, and the verdict on each constraint.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstellationColumns {
    /// Whether a constellation has satellites from files.
    has_files: bool,
    /// The metrics that are computed on demand, if they are.
    on_demand: Vec<String>,
    /// Objectives and constrained quantities that are in no other column.
    quantities: Vec<Quantity>,
    /// The dilutions of precision, if there are any, as they are named in columns.
    dops: Vec<String>,
    /// The metrics whose range over phases of the GNSS or over relative nodes is given, as columns begin.
    phases: Vec<String>,
    /// The constraints, as they are written.
    constraints: Vec<String>,
}

impl ConstellationColumns {
    /// The columns for constellations evaluated like this one; `has_files` if one of them has satellites from
    /// files.
    #[must_use]
    pub fn of(entry: &ConstellationEntry, has_files: bool) -> Self {
        let known = [DesignSummary::columns(), &metric_columns()].concat();
        let quantities = entry.evaluated.quantities.iter().map(|(one, _)| *one);
        let dops = entry.evaluated.dops.iter().flat_map(DopStatistics::named);
        let on_demand = entry.evaluated.metrics.on_demand().into_iter();
        let on_demand: Vec<String> = on_demand.map(|(name, _)| name).collect();
        let is_new = |one: &Quantity| !on_demand.contains(&column(&one.to_string()));
        let constraints = entry.evaluated.constraints.iter();
        Self {
            has_files,
            quantities: quantities
                .filter(|one| !known.contains(&column(&one.to_string()).as_str()))
                .filter(|one| !one.is_on_demand() && is_new(one))
                .collect(),
            on_demand,
            dops: dops.map(|(name, _)| column(&name.to_lowercase())).collect(),
            phases: ranges(entry).into_iter().map(|(name, _)| name).collect(),
            constraints: constraints.map(|one| one.constraint.clone()).collect(),
        }
    }

    /// The line of the names.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn header(&self) -> io::Result<String> {
        let mut names = vec!["name".to_owned()];
        let own = |names: &[&str]| {
            names
                .iter()
                .map(|name| (*name).to_owned())
                .collect::<Vec<_>>()
        };
        names.extend(own(DesignSummary::columns()));
        if self.has_files {
            names.extend(own(&["files", "format", "content"]));
        }
        names.extend(own(&metric_columns()));
        names.extend(self.on_demand.iter().cloned());
        names.extend(self.quantities.iter().map(|one| column(&one.to_string())));
        for dop in &self.dops {
            names.extend(fields::<Summary>().iter().map(|one| format!("{dop}_{one}")));
        }
        for name in &self.phases {
            names.extend(["min", "mean", "max"].map(|part| format!("{name}_{part}")));
        }
        names.extend(self.constraints.iter().cloned());
        line(&names)
    }

    /// The line of a constellation.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn row(&self, entry: &ConstellationEntry) -> io::Result<String> {
        let mut row = vec![entry.name.clone()];
        let is_design = entry.design.is_some() && entry.files.is_empty();
        let satellites = (!is_design).then_some(entry.satellites);
        row.extend(design_cells(entry.design.as_ref(), satellites)?);
        if self.has_files {
            let (format, content) = entry.format_and_content.clone().unwrap_or_default();
            row.extend([entry.files.join("+"), format, content]);
        }
        let evaluated = &entry.evaluated;
        row.extend(cells(&evaluated.metrics, &metric_columns())?);
        let on_demand = evaluated.metrics.on_demand().into_iter();
        row.extend(on_demand.map(|(_, value)| optional(value)));
        for quantity in &self.quantities {
            row.push(optional(evaluated.value(*quantity)));
        }
        let dops = evaluated.dops.iter().flat_map(DopStatistics::named);
        let mut dops = dops.map(|(_, summary)| summary);
        for _ in &self.dops {
            row.extend(match dops.next().flatten() {
                Some(summary) => cells(&summary, fields::<Summary>())?,
                None => vec![String::new(); fields::<Summary>().len()],
            });
        }
        let known = ranges(entry);
        for column in &self.phases {
            let found = known.iter().find(|(name, _)| name == column);
            let range = found.and_then(|(_, range)| *range);
            let parts = [
                range.map(|of| of.min),
                range.map(|of| of.mean),
                range.map(|of| of.max),
            ];
            row.extend(parts.map(optional));
        }
        let checks = evaluated.constraints.iter();
        row.extend(checks.map(|check| check.verdict().to_owned()));
        line(&row)
    }
}

/// The range of each metric over the phases of the GNSS, and over relative nodes.
fn ranges(entry: &ConstellationEntry) -> Vec<(String, Option<PhaseRange>)> {
    let phases = entry.evaluated.gnss_phases.iter();
    let phases = phases.flat_map(PhaseSpread::rows);
    let phases = phases.map(|(name, range)| (format!("{name}_phases"), range));
    let nodes = entry.evaluated.relative_nodes.iter();
    let nodes = nodes.flat_map(|of| &of.spread);
    let nodes = nodes.flat_map(|of| in_order(&of.spread.metrics));
    let nodes = nodes.map(|(name, range)| (format!("{name}_nodes"), range));
    phases.chain(nodes).collect()
}

/// A name as a column.
fn column(name: &str) -> String {
    name.replace(['-', ' '], "_")
}

fn line(cells: &[String]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(cells)?;
    text(writer)
}

/// The outages of all points, one per row.
///
/// # Errors
/// Never for a table in memory.
pub fn outages_csv(series: &Series) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(OUTAGE_COLUMNS)?;
    for (n, point) in series.points.iter().enumerate() {
        for outage in series.outages(n) {
            // As the numbers of the other tables are written.
            writer.serialize((
                point.latitude_deg,
                point.longitude_deg,
                outage.start_s,
                outage.length_s,
                outage.is_cut,
                point.name.as_deref().unwrap_or_default(),
            ))?;
        }
    }
    text(writer)
}

/// The columns of a table of outages.
pub(crate) const OUTAGE_COLUMNS: [&str; 6] = [
    "latitude_deg",
    "longitude_deg",
    "start_s",
    "length_s",
    "cut",
    "name",
];

/// Records whose fields are the columns, one per row: instants or points of a series.
///
/// # Errors
/// Never for a table in memory.
pub fn records_csv(rows: &[impl Serialize]) -> io::Result<String> {
    let mut bytes = Vec::new();
    write_records(&mut bytes, rows)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

//! Several constellations as a table for reading.

use super::EvaluationContext;
use super::designs::DesignList;
use crate::cli::output;
use crate::evaluate::DopStatistics;
use crate::exchange::constellation::Constellation;
use crate::report::{
    Align, ComparisonColumn, ConstellationEntry, PhaseRange, Table, comparison_columns, shown,
};
use crate::search::{CountedSatellites, Goals, Quantity};
use crate::units::counted;
use anyhow::Result;

/// Least width of the name in a table that is printed row by row, in characters: a notation with decimals.
const NAME_WIDTH: usize = 32;

/// A table with a row for each constellation and one for the GNSS alone.
pub(super) struct TextTable {
    title: String,
    columns: Vec<(String, Align)>,
    /// The numbers that every table has, the objectives and constrained quantities, and metrics on demand.
    numbers: Vec<ComparisonColumn>,
    goals: Goals,
    /// Metrics whose range over phases of the GNSS is shown.
    phases: &'static [(&'static str, &'static str)],
    /// Metrics whose range over relative nodes is shown.
    nodes: &'static [(&'static str, &'static str)],
    /// Whether constellations have names of their own.
    has_names: bool,
    has_dops: bool,
    has_constraints: bool,
    rows: Rows,
}

enum Rows {
    /// All rows, to be printed at the end.
    Kept(Table),
    /// Printed one by one, in columns of these widths.
    Streamed { widths: Vec<usize>, is_begun: bool },
}

impl TextTable {
    pub(super) fn new(
        work: &EvaluationContext<'_>,
        given: &[Constellation],
        list: Option<&DesignList>,
    ) -> Self {
        let goals = &work.goals;
        let numbers = comparison_columns(work.scenario);
        let is_named = |one: &Constellation| one.name != one.made_of();
        let may_name =
            |list: &DesignList| list.has_names() || !work.scenario.constellations.is_empty();
        let has_names = given.iter().any(is_named) || list.is_some_and(may_name);
        let count = match list {
            Some(_) => "constellations".to_owned(),
            None => counted(given.len(), "constellation"),
        };
        let columns = columns(work, has_names, &numbers);
        let rows = match list {
            None => Rows::Kept(table(&columns)),
            Some(_) => {
                let mut widths = vec![0; columns.len()];
                widths[..=usize::from(has_names)].fill(NAME_WIDTH);
                let is_begun = false;
                Rows::Streamed { widths, is_begun }
            }
        };
        Self {
            title: format!("{count} in scenario {}\n", work.scenario.name),
            numbers,
            goals: goals.clone(),
            phases: phases(work),
            nodes: nodes(work),
            has_names,
            has_dops: work.args.dops,
            has_constraints: !goals.constraints.is_empty(),
            columns,
            rows,
        }
    }

    /// Adds a row.
    pub(super) fn row(&mut self, entry: &ConstellationEntry) -> Result<()> {
        self.named(&entry.name, entry)
    }

    /// Adds the row of the GNSS alone, and prints what is not printed yet.
    pub(super) fn end(mut self, gnss_only: Option<&ConstellationEntry>) -> Result<()> {
        if let Some(entry) = gnss_only {
            self.named("GNSS alone", entry)?;
        }
        match self.rows {
            Rows::Kept(table) => output::result(&(self.title + &table.to_text())),
            Rows::Streamed { .. } => Ok(()),
        }
    }

    fn named(&mut self, name: &str, entry: &ConstellationEntry) -> Result<()> {
        let cells = self.cells(name, entry);
        match &mut self.rows {
            Rows::Kept(table) => {
                table.row(cells);
                Ok(())
            }
            Rows::Streamed { widths, is_begun } => {
                let mut table = table(&self.columns);
                table.row(cells);
                let mut text = String::new();
                if !*is_begun {
                    text = self.title.clone() + &table.heading_text(widths);
                }
                *is_begun = true;
                output::part(&(text + &table.rows_text(widths)))
            }
        }
    }

    fn cells(&self, name: &str, entry: &ConstellationEntry) -> Vec<String> {
        let evaluated = &entry.evaluated;
        let metrics = &evaluated.metrics;
        let mut cells = vec![name.to_owned()];
        if self.has_names {
            cells.push(entry.made_of());
        }
        let quantity = |one: Quantity| {
            let satellites = CountedSatellites {
                from_files: entry.satellites,
                ..CountedSatellites::default()
            };
            let of_metrics = || self.goals.value(one, satellites, metrics);
            evaluated.value(one).or_else(of_metrics)
        };
        let numbers = self.numbers.iter();
        cells.extend(numbers.map(|one| one.text(one.value(metrics, quantity))));
        for (_, name) in self.phases {
            let spread = evaluated.gnss_phases.as_ref();
            cells.push(range_cell(spread.and_then(|of| *of.metrics.get(*name)?)));
        }
        for (_, name) in self.nodes {
            let nodes = evaluated.relative_nodes.as_ref();
            let spread = nodes.and_then(|of| Some(&of.spread.as_ref()?.spread));
            cells.push(range_cell(spread.and_then(|of| *of.metrics.get(*name)?)));
        }
        if self.has_dops {
            let dops = evaluated.dops.iter().flat_map(DopStatistics::named);
            let both = |(_, one): (String, Option<crate::stats::Summary>)| {
                [one.map(|one| one.mean), one.map(|one| one.p95)]
            };
            cells.extend(dops.flat_map(both).map(shown::pdop));
        }
        if self.has_constraints {
            cells.push(verdicts(entry));
        }
        cells
    }
}

fn range_cell(range: Option<PhaseRange>) -> String {
    range.map_or_else(
        || shown::NONE.to_owned(),
        |of| format!("{:.4}-{:.4}", of.min, of.max),
    )
}

fn table(columns: &[(String, Align)]) -> Table {
    let columns = columns.iter().map(|(name, align)| (name.as_str(), *align));
    Table::new(&columns.collect::<Vec<_>>())
}

fn columns(
    work: &EvaluationContext<'_>,
    has_names: bool,
    numbers: &[ComparisonColumn],
) -> Vec<(String, Align)> {
    let numbers = numbers.iter();
    let mut names: Vec<String> = numbers.map(|one| one.heading(work.scenario)).collect();
    names.extend(
        phases(work)
            .iter()
            .map(|(name, _)| format!("{name}\nover phases")),
    );
    let over_nodes = nodes(work).iter();
    names.extend(over_nodes.map(|(name, _)| format!("{name}\nover nodes")));
    if work.args.dops {
        for name in work.evaluator.dop_names() {
            names.extend(["mean", "95 %"].map(|statistic| format!("{name}\n{statistic}")));
        }
    }
    let left: &[&str] = if has_names {
        &["name", "constellation"]
    } else {
        &["constellation"]
    };
    let left = left.iter().map(|name| ((*name).to_owned(), Align::Left));
    let mut columns: Vec<_> = left.collect();
    columns.extend(names.into_iter().map(|name| (name, Align::Right)));
    if !work.goals.constraints.is_empty() {
        columns.push(("constraints".to_owned(), Align::Left));
    }
    columns
}

/// Heading and name of the metrics whose range over phases of the GNSS is shown.
fn phases(work: &EvaluationContext<'_>) -> &'static [(&'static str, &'static str)] {
    let is_shown = work.args.gnss_phases.is_some();
    if is_shown { &RANGES } else { &[] }
}

/// The same over relative nodes.
fn nodes(work: &EvaluationContext<'_>) -> &'static [(&'static str, &'static str)] {
    let is_shown = work.args.relative_nodes.is_some();
    if is_shown { &RANGES } else { &[] }
}

/// Heading and name of the metrics whose ranges are shown.
const RANGES: [(&str, &str); 3] = [
    ("mean PDOP", "mean_pdop"),
    ("maximum PDOP", "max_pdop"),
    ("availability", "availability"),
];

/// `met`, or the constraints that are not.
fn verdicts(entry: &ConstellationEntry) -> String {
    let checks = &entry.evaluated.constraints;
    let of = |verdict: &str| {
        let found = checks.iter().filter(|check| check.verdict() == verdict);
        let found: Vec<_> = found.map(|check| check.constraint.as_str()).collect();
        (!found.is_empty()).then(|| format!("{verdict}: {}", found.join(", ")))
    };
    let told: Vec<String> = ["violated", "not defined"]
        .into_iter()
        .filter_map(of)
        .collect();
    if told.is_empty() {
        return "met".to_owned();
    }
    told.join("; ")
}

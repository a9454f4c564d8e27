//! Several constellations as a table for reading.

use super::EvaluationContext;
use super::designs::DesignList;
use crate::cli::output;
use crate::evaluate::DopStatistics;
use crate::exchange::constellation::Constellation;
use crate::report::{Align, ConstellationEntry, Table, shown};
use crate::search::Quantity;
use crate::units::{counted, round_decimal};
use anyhow::Result;

/// Quantities that have a column in every table.
const ALWAYS: [Quantity; 8] = [
    Quantity::Satellites,
    Quantity::MeanVisible,
    Quantity::MeanPdop,
    Quantity::CvarPdop,
    Quantity::MaxPdop,
    Quantity::Availability,
    Quantity::JPos,
    Quantity::JCost,
];

/// Least width of the name in a table that is printed row by row, in characters: a notation with decimals.
const NAME_WIDTH: usize = 32;

/// A table with a row for each constellation and one for the GNSS alone.
pub(super) struct TextTable {
    title: String,
    columns: Vec<(String, Align)>,
    /// Objectives and constrained quantities outside [`ALWAYS`].
    further: Vec<Quantity>,
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
        let quantities = goals.objectives.iter().copied();
        let quantities = quantities.chain(goals.constrained());
        let further: Vec<_> = quantities.filter(|one| !ALWAYS.contains(one)).collect();
        let is_named = |one: &Constellation| one.name != one.made_of();
        let has_names = given.iter().any(is_named) || list.is_some_and(DesignList::has_names);
        let count = match list {
            Some(_) => "constellations".to_owned(),
            None => counted(given.len(), "constellation"),
        };
        let columns = columns(work, has_names, &further);
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
            further,
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
        cells.push(entry.satellites.to_string());
        cells.push(shown::pdop(Some(metrics.mean_visible)));
        cells.extend([metrics.mean_pdop, metrics.cvar_pdop, metrics.max_pdop].map(shown::pdop));
        cells
            .extend([metrics.solved_fraction, metrics.availability].map(|x| shown::share(Some(x))));
        cells.push(shown::quantity(
            Quantity::LeastVisible,
            Some(metrics.least_visible.into()),
        ));
        cells.push(shown::quantity(
            Quantity::LongestOutageS,
            Some(metrics.longest_outage_s),
        ));
        cells.extend([metrics.j_pos, metrics.j_cost].map(shown::pdop));
        for further in &self.further {
            cells.push(shown::quantity(*further, evaluated.value(*further)));
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

fn table(columns: &[(String, Align)]) -> Table {
    let columns = columns.iter().map(|(name, align)| (name.as_str(), *align));
    Table::new(&columns.collect::<Vec<_>>())
}

fn columns(
    work: &EvaluationContext<'_>,
    has_names: bool,
    further: &[Quantity],
) -> Vec<(String, Align)> {
    let options = work.evaluator.setup().metrics;
    let tail = round_decimal(100.0 * (1.0 - options.cvar_level.get()), 4);
    let mut names: Vec<String> = [
        "satellites",
        "mean\nvisible",
        "mean\nPDOP",
        &format!("CVaR of PDOP\n(worst {tail} %)"),
        "maximum\nPDOP",
        "solved\nfraction",
        &format!("availability\n(PDOP <= {})", options.availability_pdop),
        "least\nvisible",
        "longest\noutage (s)",
        "J_pos",
        "J_cost",
    ]
    .map(str::to_owned)
    .into();
    names.extend(further.iter().map(ToString::to_string));
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

//! Every evaluation of a search as a table: a row for each vector, with its design and metrics, from which they are read back
//! to the bit.

use super::ScenarioStamp;
use super::columns::{cells, fields, metric_columns, optional};
use super::tables::text;
use crate::evaluate::Metrics;
use crate::optimize::{OptimizeError, Problem};
use crate::search::{DesignProblem, Quantity, RecordedEvaluation};
use csv::{StringRecord, Writer};
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};
use std::io;
use thiserror::Error;

/// The evaluations of a search as a table.
pub const EVALUATIONS_CSV: &str = "evaluations.csv";
/// What they are evaluations of.
pub const EVALUATIONS_JSON: &str = "evaluations.json";
/// Those of a search that is under way.
pub const EVALUATIONS_PARTIAL: &str = "evaluations.partial.csv";

/// All of these, which a run may have.
pub const EVALUATIONS_FILES: [&str; 3] = [EVALUATIONS_CSV, EVALUATIONS_JSON, EVALUATIONS_PARTIAL];

/// The content of [`EVALUATIONS_JSON`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EvaluationsStamp {
    /// The study.
    pub scenario: ScenarioStamp,
    /// Seed of the search.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// Rows of the table.
    pub evaluations: u64,
    /// SHA-256 of the table, hex.
    pub sha256: String,
}

/// Why a table of evaluations cannot be read.
#[derive(Debug, Error)]
pub enum EvaluationsError {
    /// Not a table.
    #[error("not a table of evaluations: {0}")]
    Table(#[from] csv::Error),
    /// A column that every such table has is missing.
    #[error("no column {column}: not the evaluations of this search space")]
    Column {
        /// The column.
        column: String,
    },
    /// A cell that is not a value.
    #[error("line {line}, column {column}: found {found:?}, expected a number")]
    Cell {
        /// Line from 1.
        line: u64,
        /// The column.
        column: String,
        /// The cell.
        found: String,
    },
    /// A vector outside the search space.
    #[error("line {line}: {source}")]
    Vector {
        /// Line from 1.
        line: u64,
        /// What is wrong with it.
        source: OptimizeError,
    },
    /// Metrics that are not complete.
    #[error("line {line}: not the metrics of this version: {source}")]
    Metrics {
        /// Line from 1.
        line: u64,
        /// What is wrong with them.
        source: serde_json::Error,
    },
}

/// The columns before the variables.
const FIRST: [&str; 2] = ["evaluation", "generation"];
/// The columns after the variables.
const ABOUT_DESIGN: [&str; 3] = ["notation", "planes", "satellites"];
/// The last column.
const VIOLATION: &str = "violation";
/// A design whose metrics show which ones are computed on demand.
const PROBE: &str = "delta:55:1/1/0@1000";

/// The columns of the evaluations of a search.
pub struct EvaluationColumns {
    variables: Vec<String>,
    metrics: Vec<&'static str>,
    on_demand: Vec<String>,
    /// Objectives and constrained quantities without a column of their own.
    further: Vec<Quantity>,
}

impl EvaluationColumns {
    /// Those of a search: evaluates one satellite, to know what is computed on demand.
    #[must_use]
    pub fn new(problem: &DesignProblem<'_>) -> Self {
        let probe = PROBE.parse().ok();
        let probed = probe.and_then(|probe| problem.judged(&probe));
        let on_demand = probed.map_or_else(Vec::new, |(metrics, _)| metrics.on_demand());
        let mut columns = Self {
            variables: variable_columns(problem),
            metrics: metric_columns(),
            on_demand: on_demand.into_iter().map(|(name, _)| name).collect(),
            further: Vec::new(),
        };
        let goals = problem.goals();
        let all = goals.objectives.iter().copied().chain(goals.constrained());
        let lacks = |quantity: &Quantity| {
            let name = column(*quantity);
            let of_design = ABOUT_DESIGN.contains(&name.as_str());
            let is_metric = columns.metrics.contains(&name.as_str());
            !of_design
                && !is_metric
                && !quantity.is_on_demand()
                && !columns.on_demand.contains(&name)
        };
        columns.further = all.filter(lacks).collect();
        columns
    }

    /// The heading of the table.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn heading(&self) -> io::Result<String> {
        let further = self.further.iter().map(|quantity| column(*quantity));
        let before = FIRST.iter().map(|name| (*name).to_owned());
        let about = ABOUT_DESIGN.iter().chain(&self.metrics);
        let all = before
            .chain(self.variables.iter().cloned())
            .chain(about.map(|name| (*name).to_owned()))
            .chain(self.on_demand.iter().cloned())
            .chain(further)
            .chain([VIOLATION.to_owned()]);
        let mut writer = Writer::from_writer(Vec::new());
        writer.write_record(all)?;
        text(writer)
    }

    /// The rows of the evaluations of a generation, of which `first` is the number of the first one.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn rows(
        &self,
        problem: &DesignProblem<'_>,
        generation: u64,
        first: u64,
        evaluations: &[RecordedEvaluation],
    ) -> io::Result<String> {
        let mut writer = Writer::from_writer(Vec::new());
        for (number, one) in (first..).zip(evaluations) {
            let mut row = vec![number.to_string(), generation.to_string()];
            row.extend(one.genome.iter().map(ToString::to_string));
            row.extend(self.about(problem, one)?);
            row.push(one.violation.to_string());
            writer.write_record(row)?;
        }
        text(writer)
    }

    /// Design and metrics; empty where a vector cannot be propagated.
    fn about(
        &self,
        problem: &DesignProblem<'_>,
        one: &RecordedEvaluation,
    ) -> io::Result<Vec<String>> {
        let Some((design, metrics)) = &one.evaluated else {
            let empty = self.metrics.len() + self.on_demand.len() + self.further.len();
            return Ok(vec![String::new(); ABOUT_DESIGN.len() + empty]);
        };
        let design = design.as_ref();
        let value = |quantity| optional(problem.value(quantity, design, metrics));
        let mut row = vec![
            design.map_or_else(String::new, ToString::to_string),
            value(Quantity::Planes),
            value(Quantity::Satellites),
        ];
        row.extend(cells(metrics, &self.metrics)?);
        let found = metrics.on_demand();
        row.extend(self.on_demand.iter().map(|name| {
            let same = found.iter().find(|(other, _)| other == name);
            optional(same.and_then(|(_, value)| *value))
        }));
        row.extend(self.further.iter().map(|quantity| value(*quantity)));
        Ok(row)
    }
}

/// The evaluations in a table of the same search space.
///
/// # Errors
/// If it is not such a table.
pub fn read_evaluations(
    bytes: &[u8],
    problem: &DesignProblem<'_>,
) -> Result<Vec<RecordedEvaluation>, EvaluationsError> {
    let mut reader = csv::Reader::from_reader(bytes);
    let heading = reader.headers()?.clone();
    let place = |name: &str| {
        let found = heading.iter().position(|other| other == name);
        found.ok_or_else(|| EvaluationsError::Column {
            column: name.to_owned(),
        })
    };
    let variables = variable_columns(problem);
    let variables: Vec<usize> = variables
        .iter()
        .map(|name| place(name))
        .collect::<Result<_, _>>()?;
    let violation = place(VIOLATION)?;
    for name in metric_columns() {
        place(name)?;
    }
    let mut evaluations = Vec::new();
    for record in reader.records() {
        let row = EvaluationRow {
            heading: &heading,
            record: record?,
        };
        let genome: Vec<f64> = variables
            .iter()
            .map(|n| row.number(*n))
            .collect::<Result<_, _>>()?;
        let outside = |source| EvaluationsError::Vector {
            line: row.line(),
            source,
        };
        problem.space().check(&genome).map_err(outside)?;
        let metrics = row.metrics()?;
        let design = problem.designs().design(&genome).ok();
        evaluations.push(RecordedEvaluation {
            evaluated: design.zip(metrics),
            violation: row.number(violation)?,
            genome,
        });
    }
    Ok(evaluations)
}

/// A row with its heading.
struct EvaluationRow<'a> {
    heading: &'a StringRecord,
    record: StringRecord,
}

impl EvaluationRow<'_> {
    fn line(&self) -> u64 {
        self.record.position().map_or(0, csv::Position::line)
    }

    fn cell(&self, place: usize) -> &str {
        self.record.get(place).unwrap_or_default()
    }

    fn wrong(&self, place: usize) -> EvaluationsError {
        EvaluationsError::Cell {
            line: self.line(),
            column: self.heading.get(place).unwrap_or_default().to_owned(),
            found: self.cell(place).to_owned(),
        }
    }

    fn number(&self, place: usize) -> Result<f64, EvaluationsError> {
        let number = self.cell(place).parse().ok();
        let number = number.filter(|number: &f64| number.is_finite());
        number.ok_or_else(|| self.wrong(place))
    }

    /// The metrics; `None` where there are none.
    fn metrics(&self) -> Result<Option<Metrics>, EvaluationsError> {
        let mut cells = Vec::new();
        for (place, column) in self.heading.iter().enumerate() {
            if field_of(column).is_some() {
                cells.push((column, self.value(place)?));
            }
        }
        let line = self.line();
        metrics_of_cells(cells).map_err(|source| EvaluationsError::Metrics { line, source })
    }

    fn value(&self, place: usize) -> Result<Value, EvaluationsError> {
        let text = self.cell(place);
        if text.is_empty() {
            return Ok(Value::Null);
        }
        let is_value = |value: &Value| value.is_number() || value.is_boolean();
        let value = serde_json::from_str(text).ok().filter(is_value);
        value.ok_or_else(|| self.wrong(place))
    }
}

/// The metrics in the cells of a row, by column; `None` where all are empty. Other columns are passed over.
///
/// # Errors
/// If the metrics are not complete.
pub(crate) fn metrics_of_cells<'a>(
    cells: impl IntoIterator<Item = (&'a str, Value)>,
) -> serde_json::Result<Option<Metrics>> {
    let mut all = Map::new();
    let mut has_value = false;
    for (column, value) in cells {
        let Some((field, part)) = field_of(column) else {
            continue;
        };
        has_value |= !value.is_null();
        let Some(part) = part else {
            all.insert(field.to_owned(), value);
            continue;
        };
        let whole = all
            .entry(field)
            .or_insert_with(|| Value::Object(Map::new()));
        if let Some(whole) = whole.as_object_mut() {
            whole.insert(part.to_owned(), value);
        }
    }
    if !has_value {
        return Ok(None);
    }
    for whole in all.values_mut() {
        // The parts of a metric without a value have none.
        let parts = whole
            .as_object()
            .map(|parts| parts.values().all(Value::is_null));
        if parts == Some(true) {
            *whole = Value::Null;
        }
    }
    serde_json::from_value(Value::Object(all)).map(Some)
}

/// The field of the metrics that a column is, or is a part of.
fn field_of(column: &str) -> Option<(&'static str, Option<&str>)> {
    let all = fields::<Metrics>().iter().copied();
    let matching = all.filter_map(|field| match column.strip_prefix(field)? {
        "" => Some((field, None)),
        rest => Some((field, Some(rest.strip_prefix('_')?))),
    });
    matching.max_by_key(|(field, _)| field.len())
}

/// The columns of the variables: `x_` and the name.
fn variable_columns(problem: &DesignProblem<'_>) -> Vec<String> {
    let variables = problem.space().variables().iter();
    let name = |name: &str| format!("x_{}", name.replace(['-', '.'], "_").to_lowercase());
    variables.map(|variable| name(&variable.name)).collect()
}

/// The name of a quantity as a column.
fn column(quantity: Quantity) -> String {
    quantity.to_string().replace('-', "_")
}

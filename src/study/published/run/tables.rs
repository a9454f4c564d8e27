//! The tables of a study measured: as printed, at what fits, and under each assumption.

use super::{StudyRun, StudyRunError, Under};
use crate::constellation::Design;
use crate::scenario::Scenario;
use crate::study::judge::Statement;
use crate::study::published::steps::{
    ColumnTolerance, StudyReference, StudyRow, StudyTable, StudyValue,
};
use crate::study::published::{PublishedStudy, StudyKeys, StudyMetric};
use serde::Serialize;
use std::io;

/// A table of a study with ours beside what is printed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredTable {
    /// Its name.
    pub name: String,
    /// Stem of its file.
    pub file: String,
    /// What is printed, and then what is computed beside it.
    pub columns: Vec<MeasuredColumn>,
    /// The fits that move designs: the element that each varies.
    pub fits: Vec<String>,
    /// The rows.
    pub rows: Vec<MeasuredRow>,
    /// Under the scenario and then under each assumption that changes it.
    pub sensitivity: Vec<RowsUnder>,
    /// The rows of which reports show that.
    pub shown: Vec<String>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredColumn {
    /// What is computed.
    pub metric: String,
    /// Its name.
    pub name: String,
    /// Unit of its numbers.
    pub unit: &'static str,
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeasuredRow {
    /// Its name.
    pub name: String,
    /// The constellation as printed.
    pub design: String,
    /// Satellites T, of a design.
    pub satellites: Option<usize>,
    /// What is printed, for the first columns.
    pub published: Vec<f64>,
    /// Ours as printed, for every column.
    pub computed: Vec<Option<f64>>,
    /// Ours with each fit.
    pub fits: Vec<RowAtFit>,
}

/// A row with a fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowAtFit {
    /// The value of the fit; `None` if the row stays as printed.
    pub value: Option<f64>,
    /// Ours there.
    pub computed: Vec<Option<f64>>,
}

/// All rows under one assumption, in the order of the table, for every column.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowsUnder {
    /// What is assumed, in words.
    pub assumption: String,
    /// Row by row.
    pub computed: Vec<Vec<Option<f64>>>,
}

/// A number that is not judged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ComputedValue {
    /// What it is.
    pub name: String,
    /// The constellation.
    pub of: String,
    /// What is computed.
    pub metric: String,
    /// The number.
    pub computed: Option<f64>,
    /// Its unit.
    pub unit: &'static str,
}

/// A number of a table, judged.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedRow {
    /// The row.
    pub row: String,
    /// The metric of its column.
    pub metric: StudyMetric,
    /// Name of its column.
    pub column: String,
    /// What is printed.
    pub published: f64,
    /// The largest difference.
    pub tolerance: f64,
    /// The same in percent of the number, if the column gives it so.
    pub tolerance_percent: Option<f64>,
    /// Whether the number is known to be reproduced.
    pub is_gated: bool,
    /// Why the tolerance is what it is.
    pub reason: Option<String>,
    /// The statement with its verdict.
    pub statement: Statement,
}

impl PublishedStudy {
    /// The numbers of the tables that have a file, judged under another scenario in place of that of the study, with
    /// the same verdicts that the whole study gives them.
    ///
    /// # Errors
    /// If a constellation cannot be propagated under the scenario.
    pub fn judged_rows(
        &self,
        scenario: &Scenario,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<Vec<JudgedRow>, StudyRunError> {
        let (text, keys) = (scenario.to_toml(), StudyKeys::default());
        let mut run = self.begin(&text, &keys, &[], read)?;
        run.fit()?;
        run.measure_rows()?;
        let mut found = Vec::new();
        for table in self.tables.iter().filter(|table| table.file.is_some()) {
            for (name, row, column, _) in table.numbers() {
                let mut statements = self.statements.iter();
                let Some(statement) = statements.find(|one| one.name == name) else {
                    continue;
                };
                let at = table.column(column.metric).unwrap_or(0);
                let Some(judged) = run.judged(statement)? else {
                    continue;
                };
                let (tolerance, tolerance_percent) = match column.tolerance {
                    ColumnTolerance::Absolute(tolerance) => (tolerance, None),
                    ColumnTolerance::Percent(percent) => {
                        (row.values[at].abs() * percent / 100.0, Some(percent))
                    }
                };
                found.push(JudgedRow {
                    row: row.name.clone(),
                    metric: column.metric,
                    column: column.name.clone(),
                    published: row.values[at],
                    tolerance,
                    tolerance_percent,
                    is_gated: row.gates.contains(&column.metric),
                    reason: column.reason.clone(),
                    statement: judged.statement,
                });
            }
        }
        Ok(found)
    }
}

impl StudyTable {
    fn metrics(&self) -> Vec<StudyMetric> {
        let printed = self.columns.iter().map(|column| column.metric);
        printed.chain(self.beside.iter().copied()).collect()
    }
}

impl<'r> StudyRun<'r> {
    /// Measures the designs of the tables that have a file, as printed, at what fits, and under each assumption.
    pub(super) fn measure_rows(&mut self) -> Result<(), StudyRunError> {
        let study = self.study;
        for table in study.tables.iter().filter(|table| table.file.is_some()) {
            for under in self.tried(table)? {
                let place = self.place(under, &StudyKeys::default())?;
                let mut designs: Vec<(String, Design)> = Vec::new();
                for row in &table.rows {
                    let of = self.text_of(&row.name, under);
                    let is_notation = matches!(StudyReference::of(&of), StudyReference::One(_));
                    if is_notation && let Ok(design) = self.worlds[place].scenario.design(&of) {
                        designs.push((of, design));
                    }
                }
                designs.dedup_by(|a, b| a.0 == b.0);
                let line = table.rows.first().map_or(1, |row| row.line);
                self.measure_all(place, &designs, line)?;
            }
        }
        Ok(())
    }

    /// What a table is measured under: the scenario, its fits, and each assumption that changes the scenario.
    fn tried(&mut self, table: &StudyTable) -> Result<Vec<Under<'r>>, StudyRunError> {
        let study = self.study;
        let mut tried = vec![Under::Scenario];
        tried.extend(self.moving(table).into_iter().map(Under::Fit));
        for assumption in &study.assumptions {
            let changes = assumption.instead.is_empty();
            if changes && self.is_changed(assumption, &StudyKeys::default())? {
                tried.push(Under::Assumption(assumption));
            }
        }
        Ok(tried)
    }

    /// The places of the fits that move rows of a table.
    fn moving(&self, table: &StudyTable) -> Vec<usize> {
        let moves = self.moves.iter().enumerate();
        let of_table = moves.filter(|(_, moves)| {
            let mut rows = table.rows.iter();
            rows.any(|row| moves.notation(&row.name).is_some())
        });
        of_table.map(|(n, _)| n).collect()
    }

    fn row_values(
        &mut self,
        table: &StudyTable,
        row: &StudyRow,
        under: Under<'_>,
    ) -> Result<Vec<Option<f64>>, StudyRunError> {
        let place = self.place(under, &StudyKeys::default())?;
        let of = self.text_of(&row.name, under);
        let metrics = table.metrics().into_iter();
        metrics
            .map(|metric| self.metric_of(place, metric, &of, None, row.line))
            .collect()
    }

    /// The tables that have a file.
    pub(super) fn tables(&mut self) -> Result<Vec<MeasuredTable>, StudyRunError> {
        let study = self.study;
        let mut tables = Vec::new();
        for table in &study.tables {
            if let Some(file) = &table.file {
                tables.push(self.measured_table(table, file)?);
            }
        }
        Ok(tables)
    }

    fn measured_table(
        &mut self,
        table: &StudyTable,
        file: &str,
    ) -> Result<MeasuredTable, StudyRunError> {
        let place = self.place(Under::Scenario, &StudyKeys::default())?;
        let moving = self.moving(table);
        let mut rows = Vec::new();
        for row in &table.rows {
            let mut fits = Vec::new();
            for n in &moving {
                let found = &self.fits[self.moves[*n].fit];
                let mut values = found.rows.iter();
                let value = values
                    .find(|one| one.row == row.name)
                    .and_then(|one| one.value);
                let computed = self.row_values(table, row, Under::Fit(*n))?;
                fits.push(RowAtFit { value, computed });
            }
            let design = self.worlds[place].scenario.design(&row.of).ok();
            rows.push(MeasuredRow {
                name: row.name.clone(),
                design: row.of.clone(),
                satellites: design.map(|design| design.satellite_count()),
                published: row.values.clone(),
                computed: self.row_values(table, row, Under::Scenario)?,
                fits,
            });
        }
        let printed = table.columns.iter().map(|column| MeasuredColumn {
            metric: column.metric.to_string(),
            name: column.name.clone(),
            unit: column.metric.unit(),
        });
        let beside = table.beside.iter().map(|metric| MeasuredColumn {
            metric: metric.to_string(),
            name: metric.to_string(),
            unit: metric.unit(),
        });
        Ok(MeasuredTable {
            name: table.name.clone(),
            file: file.to_owned(),
            columns: printed.chain(beside).collect(),
            fits: (moving
                .iter()
                .map(|n| self.fits[self.moves[*n].fit].vary.clone()))
            .collect(),
            rows,
            sensitivity: self.sensitivity(table)?,
            shown: table.shown.clone(),
        })
    }

    fn sensitivity(&mut self, table: &StudyTable) -> Result<Vec<RowsUnder>, StudyRunError> {
        if table.shown.is_empty() {
            return Ok(Vec::new());
        }
        let mut found = Vec::new();
        for under in self.tried(table)? {
            if matches!(under, Under::Fit(_)) {
                continue;
            }
            let rows = table.rows.iter();
            let computed = rows.map(|row| self.row_values(table, row, under));
            let computed = computed.collect::<Result<_, _>>()?;
            found.push(RowsUnder {
                assumption: self.words_of(under).to_owned(),
                computed,
            });
        }
        Ok(found)
    }

    /// The numbers that are not judged.
    pub(super) fn values(&mut self) -> Result<Vec<ComputedValue>, StudyRunError> {
        let place = self.place(Under::Scenario, &StudyKeys::default())?;
        let study = self.study;
        let one = |value: &StudyValue| {
            let of = self.text_of(&value.of, Under::Scenario);
            Ok(ComputedValue {
                name: value.name.clone(),
                of: value.of.clone(),
                metric: value.metric.to_string(),
                computed: self.metric_of(place, value.metric, &of, None, value.line)?,
                unit: value.metric.unit(),
            })
        };
        study.values.iter().map(one).collect()
    }
}

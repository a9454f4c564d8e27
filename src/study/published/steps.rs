//! What a study does beside single numbers: tables of numbers, fits, searches, and figures.

use super::{PublishedNumber, StudyKeys, StudyMetric};
use crate::keyword::keywords;
use crate::study::judge::Expected;
use std::collections::BTreeMap;

/// A table of numbers: each is a statement.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudyTable {
    /// Its name, which is the source of its numbers.
    pub(super) name: String,
    /// Stem of the file in which its numbers are written beside ours; without it they are statements only.
    pub(super) file: Option<String>,
    /// What is printed of each row.
    pub(super) columns: Vec<TableColumn>,
    /// What is computed of each row and not printed.
    pub(super) beside: Vec<StudyMetric>,
    /// The rows of which reports show what each assumption does.
    pub(super) shown: Vec<String>,
    /// The rows.
    pub(super) rows: Vec<StudyRow>,
}

/// A column of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct TableColumn {
    pub(super) metric: StudyMetric,
    /// Its name in statements.
    pub(super) name: String,
    pub(super) tolerance: ColumnTolerance,
    /// Why the tolerance is what it is.
    pub(super) reason: Option<String>,
}

/// The largest difference from a number of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ColumnTolerance {
    /// In the unit of the numbers.
    Absolute(f64),
    /// In percent of each number.
    Percent(f64),
}

impl TableColumn {
    /// What a row prints there.
    pub(super) fn expected(&self, value: f64) -> Expected {
        let tolerance = match self.tolerance {
            ColumnTolerance::Absolute(tolerance) => tolerance,
            ColumnTolerance::Percent(percent) => value.abs() * percent / 100.0,
        };
        Expected::Value { value, tolerance }
    }
}

/// A row of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudyRow {
    pub(super) name: String,
    /// Rows that belong together, such as those of one method.
    pub(super) group: Option<String>,
    /// The constellation.
    pub(super) of: String,
    /// The numbers, one for each column.
    pub(super) values: Vec<f64>,
    /// The columns whose number is known to be reproduced, so that `validate` gates it.
    pub(super) gates: Vec<StudyMetric>,
    /// Line of the study, from 1.
    pub(super) line: usize,
}

/// A value that is varied, row by row, until the number of a column comes out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudyFit {
    pub(super) name: String,
    pub(super) vary: FitVariable,
    /// The metric of the column.
    pub(super) to: StudyMetric,
    /// Between which values, or for elements of designs also within which.
    pub(super) range: [f64; 2],
    /// Deviation from the median within which a row agrees.
    pub(super) agree_within: Option<f64>,
    /// Line of the study, from 1.
    pub(super) line: usize,
}

/// What a fit varies.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FitVariable {
    /// A key of the scenario: the fit tells which value each row implies.
    Key(String),
    /// An element of the designs of rows that are not met as printed: the fit is an assumption.
    Element {
        element: DesignElement,
        /// The farthest from the printed value.
        within: f64,
        /// Steps in which the nearest solution is bracketed.
        step: f64,
        /// Decimals to which the value is rounded.
        decimals: u32,
        /// The assumption in words.
        assumption: String,
    },
}

keywords! {
    /// An element of a design that a fit varies.
    DesignElement {
        /// The inclination, degrees.
        Inclination = "inclination-deg",
        /// The altitude, km.
        Altitude = "altitude-km",
    }
}

/// A search that statements refer to, under the scenario with some keys changed.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudySearch {
    pub(super) name: String,
    pub(super) scenario: StudyKeys,
    /// Line of the study, from 1.
    pub(super) line: usize,
}

/// A number that is computed and not judged.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudyValue {
    pub(super) name: String,
    pub(super) of: String,
    pub(super) metric: StudyMetric,
    /// Line of the study, from 1.
    pub(super) line: usize,
}

/// A figure of a study.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct StudyFigure {
    /// Stem of its files.
    pub(super) name: String,
    pub(super) title: String,
    pub(super) plot: StudyPlot,
    /// What is drawn.
    pub(super) of: Vec<String>,
    /// Line of the study, from 1.
    pub(super) line: usize,
}

keywords! {
    /// What a figure of a study shows.
    StudyPlot {
        /// Designs in the plane of the two objectives, with their fuzzy memberships.
        Objectives = "objectives",
        /// The distribution of the mean visible satellites over the instants.
        VisibleDistribution = "mean-visible-distribution",
        /// The maximum PDOP over time.
        MaxPdopCourse = "max-pdop-over-time",
    }
}

/// A change that no key of a scenario makes.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct AssumedChange {
    /// GNSS satellites, by the beginnings of their names, that are left out.
    pub(super) without: Vec<String>,
    /// GNSS satellites, by the beginnings of their names, that are turned.
    pub(super) turned: Vec<String>,
    /// By how much to the east, degrees.
    pub(super) turn_deg: f64,
    /// By how much the epoch is later, hours.
    pub(super) epoch_shift_h: f64,
}

impl AssumedChange {
    /// Whether it changes nothing.
    pub(super) fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// What stands for what in an assumption.
pub(super) type Replaced = BTreeMap<String, String>;

/// What a text in a study refers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum StudyReference<'t> {
    /// `gnss:BEGINNING`: the GNSS satellites whose names begin so.
    Gnss(&'t str),
    /// `search:NAME`: the set that a search found, or its fuzzy pick.
    Search(&'t str),
    /// `rows:NAME,…`: rows by name or group.
    Rows(&'t str),
    /// `table:NAME`: the rows of a table.
    Table(&'t str),
    /// `fit:NAME`.
    Fit(&'t str),
    /// A row, a notation, a constellation or a sky by name, or `gnss-only`.
    One(&'t str),
}

impl<'t> StudyReference<'t> {
    pub(super) fn of(text: &'t str) -> Self {
        match text.split_once(':') {
            Some(("gnss", beginning)) => Self::Gnss(beginning),
            Some(("search", name)) => Self::Search(name),
            Some(("rows", names)) => Self::Rows(names),
            Some(("table", name)) => Self::Table(name),
            Some(("fit", name)) => Self::Fit(name),
            _ => Self::One(text),
        }
    }
}

impl StudyTable {
    /// The statements of its rows: name, row, column and number of each.
    pub(super) fn numbers(
        &self,
    ) -> impl Iterator<Item = (String, &StudyRow, &TableColumn, PublishedNumber)> {
        self.rows.iter().flat_map(move |row| {
            let numbers = self.columns.iter().zip(&row.values);
            numbers.map(move |(column, value)| {
                let name = format!("{} {}", row.name, column.name);
                let number = PublishedNumber::Stated(column.expected(*value));
                (name, row, column, number)
            })
        })
    }

    /// The place of the column of a metric.
    pub(super) fn column(&self, metric: StudyMetric) -> Option<usize> {
        self.columns
            .iter()
            .position(|column| column.metric == metric)
    }
}

/// The rows that a text names, of all tables in their order.
pub(super) fn rows_of<'s>(tables: &'s [StudyTable], text: &str) -> Vec<&'s StudyRow> {
    let all = tables.iter().flat_map(|table| &table.rows);
    match StudyReference::of(text) {
        StudyReference::One(name) => all.filter(|row| row.name == name).collect(),
        StudyReference::Rows(names) => {
            let names: Vec<&str> = names.split(',').map(str::trim).collect();
            let is_meant = |name: &str| names.contains(&name);
            let is_row =
                |row: &&StudyRow| is_meant(&row.name) || row.group.as_deref().is_some_and(is_meant);
            all.filter(is_row).collect()
        }
        StudyReference::Table(name) => {
            let table = tables.iter().find(|table| table.name == name);
            table.into_iter().flat_map(|table| &table.rows).collect()
        }
        _ => Vec::new(),
    }
}

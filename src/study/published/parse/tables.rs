//! Tables of numbers as written, checked.

use super::{FileProblems, StudyKeys, StudyMetric};
use crate::study::judge::Provenance;
use crate::study::published::PublishedStatement;
use crate::study::published::steps::{ColumnTolerance, StudyRow, StudyTable, TableColumn};
use serde::Deserialize;
use toml::Spanned;

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct WrittenTable {
    name: Spanned<String>,
    file: Option<Spanned<String>>,
    columns: Vec<Spanned<WrittenColumn>>,
    #[serde(default)]
    beside: Vec<Spanned<String>>,
    #[serde(default)]
    sensitivity: Vec<Spanned<String>>,
    rows: Vec<Spanned<WrittenRow>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WrittenColumn {
    metric: Spanned<String>,
    name: String,
    tolerance: Option<Spanned<f64>>,
    tolerance_percent: Option<Spanned<f64>>,
    #[serde(default)]
    fitted: bool,
    #[serde(default)]
    input: bool,
    reason: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WrittenRow {
    name: String,
    group: Option<String>,
    of: String,
    values: Vec<f64>,
    #[serde(default)]
    gates: Vec<Spanned<String>>,
    disagreement: Option<String>,
    #[serde(default = "super::confirmed")]
    confirmed: bool,
}

/// The tables, and the statements of each with where it begins.
pub(super) fn tables(
    written: Vec<Spanned<WrittenTable>>,
    problems: &mut FileProblems<'_>,
) -> (Vec<StudyTable>, Vec<(usize, PublishedStatement)>) {
    let mut tables: Vec<StudyTable> = Vec::new();
    let mut statements = Vec::new();
    for written in written {
        let start = written.span().start;
        let written = written.into_inner();
        let others = tables.iter().map(|table| &table.name);
        let span = written.name.span();
        problems.unlike("tables", written.name.get_ref(), others, span);
        if let Some(file) = &written.file {
            problems.stem("file", file);
            problems
                .stems
                .push(format!("{}-sensitivity", file.get_ref()));
        }
        let columns: Vec<_> = written
            .columns
            .into_iter()
            .map(Spanned::into_inner)
            .collect();
        let provenances: Vec<Provenance> = columns.iter().map(provenance).collect();
        let found: Vec<_> = columns
            .into_iter()
            .map(|one| column(one, problems))
            .collect();
        let beside = written.beside.iter();
        let beside: Vec<_> = beside
            .filter_map(|text| problems.metric("beside", text))
            .collect();
        let count = found.len();
        let mut table = StudyTable {
            name: written.name.into_inner(),
            file: written.file.map(Spanned::into_inner),
            columns: found.into_iter().flatten().collect(),
            beside,
            shown: Vec::new(),
            rows: Vec::new(),
        };
        let mut told = Vec::new();
        for row in written.rows {
            let known = tables.iter().flat_map(|table| &table.rows);
            let known = known.chain(&table.rows).map(|row| &row.name);
            let (row, disagreement, is_confirmed) = self::row(row, count, known, problems);
            table.rows.push(row);
            told.push((disagreement, is_confirmed));
        }
        for shown in written.sensitivity {
            if table.rows.iter().all(|row| row.name != *shown.get_ref()) {
                let what = format!("sensitivity: the table has no row {:?}", shown.get_ref());
                problems.add(shown.span(), what);
            }
            table.shown.push(shown.into_inner());
        }
        if table.columns.len() == count {
            let of_rows = statements_of(&table, &provenances, &told);
            statements.extend(of_rows.map(|statement| (start, statement)));
        }
        tables.push(table);
    }
    (tables, statements)
}

fn provenance(column: &WrittenColumn) -> Provenance {
    match (column.input, column.fitted) {
        (true, _) => Provenance::Input,
        (_, true) => Provenance::Fitted,
        _ => Provenance::Computed,
    }
}

/// The statements of a table; `told` is what is known of a disagreement of each row, and whether it is confirmed.
fn statements_of<'t>(
    table: &'t StudyTable,
    provenances: &'t [Provenance],
    told: &'t [(Option<String>, bool)],
) -> impl Iterator<Item = PublishedStatement> + 't {
    let per_row = table.columns.len().max(1);
    let numbers = table.numbers().enumerate();
    numbers.map(move |(n, (name, row, column, expected))| {
        let (disagreement, is_confirmed) = &told[n / per_row];
        PublishedStatement {
            name,
            of: row.name.clone(),
            comparison: None,
            satellite: None,
            metric: column.metric,
            expected,
            source: table.name.clone(),
            provenance: provenances[n % per_row],
            is_confirmed: *is_confirmed,
            disagreement: disagreement.clone(),
            tried: None,
            scenario: StudyKeys::default(),
            line: row.line,
        }
    })
}

fn column(written: WrittenColumn, problems: &mut FileProblems<'_>) -> Option<TableColumn> {
    let metric = problems.metric("metric", &written.metric);
    let tolerance = match (&written.tolerance, &written.tolerance_percent) {
        (Some(tolerance), None) => problems
            .positive("tolerance", tolerance)
            .map(ColumnTolerance::Absolute),
        (None, Some(percent)) => problems
            .positive("tolerance-percent", percent)
            .map(ColumnTolerance::Percent),
        _ => {
            let what = format!(
                "column {:?} needs tolerance or tolerance-percent",
                written.name
            );
            problems.add(written.metric.span(), what);
            None
        }
    };
    let computed_otherwise =
        |metric: &StudyMetric| matches!(metric, StudyMetric::Sets(_) | StudyMetric::Implied);
    if let Some(metric) = metric.filter(computed_otherwise) {
        let what = format!("metric: {metric} is not of a constellation");
        problems.add(written.metric.span(), what);
    }
    Some(TableColumn {
        metric: metric?,
        name: written.name,
        tolerance: tolerance?,
        reason: written.reason,
    })
}

fn row<'n>(
    written: Spanned<WrittenRow>,
    columns: usize,
    known: impl Iterator<Item = &'n String>,
    problems: &mut FileProblems<'_>,
) -> (StudyRow, Option<String>, bool) {
    let span = written.span();
    let written = written.into_inner();
    problems.unlike("rows", &written.name, known, span.clone());
    let names = [Some(&written.name), written.group.as_ref()];
    if names
        .into_iter()
        .flatten()
        .any(|name| name.contains([',', ':']))
    {
        let what = format!("row {:?}: a name or group has no ',' or ':'", written.name);
        problems.add(span.clone(), what);
    }
    if written.values.len() != columns || !written.values.iter().all(|value| value.is_finite()) {
        let what = format!(
            "row {:?}: values: found {}, expected {columns} finite numbers, one for each column",
            written.name,
            written.values.len()
        );
        problems.add(span.clone(), what);
    }
    let gates = written.gates.iter();
    let row = StudyRow {
        gates: gates
            .filter_map(|gate| problems.metric("gates", gate))
            .collect(),
        name: written.name,
        group: written.group,
        of: written.of,
        values: written.values,
        line: problems.line(&span),
    };
    (row, written.disagreement, written.confirmed)
}

//! `navwalker lint`.

use crate::cli::args::{LintArgs, OutputFormat};
use crate::cli::output::shown_path;
use crate::cli::{Status, output};
use crate::exchange::lint::{LintReport, lint};
use crate::formats::text::finding::Severity;
use anyhow::{Context, Result};
use serde::Serialize;
use std::fs::File;
use std::io::BufReader;
use std::path::Path;

/// The findings reported for one file.
const MOST_FINDINGS: usize = 100;

/// One finding, as written to JSON and CSV.
#[derive(Serialize)]
struct FindingRow {
    file: String,
    format: String,
    line: usize,
    column: usize,
    severity: &'static str,
    rule: &'static str,
    message: String,
}

pub(crate) fn run(args: &LintArgs) -> Result<Status> {
    let mut rows = Vec::new();
    let mut clean = String::new();
    let mut unread = Vec::new();
    for path in &args.files {
        let report = match check(path, args) {
            Ok(report) => report,
            Err(error) => {
                unread.push(error);
                continue;
            }
        };
        if let (Some(format), []) = (report.format, report.findings.as_slice()) {
            clean += &format!("{}: no findings as {format}\n", shown_path(path));
        }
        rows.extend(rows_of(path, report));
    }
    match args.output {
        OutputFormat::Text if rows.is_empty() && clean.is_empty() => {}
        OutputFormat::Text => output::result(&(text(&rows) + &clean))?,
        OutputFormat::Json => output::result(&crate::printable::json(&rows)?)?,
        OutputFormat::Csv => output::result(&crate::report::records_csv(&rows)?)?,
    }
    unread.iter().for_each(output::error);
    Ok(if !unread.is_empty() {
        Status::CouldNotRun
    } else if rows.is_empty() {
        Status::Done
    } else {
        Status::Failed
    })
}

fn check(path: &Path, args: &LintArgs) -> Result<LintReport> {
    let read = || {
        let input = BufReader::new(File::open(path)?);
        let name = path.file_name().map(|name| name.to_string_lossy());
        lint(input, args.format, name.as_deref(), MOST_FINDINGS)
    };
    read().with_context(|| format!("cannot read {}", shown_path(path)))
}

fn rows_of(path: &Path, report: LintReport) -> impl Iterator<Item = FindingRow> {
    let file = shown_path(path);
    report.findings.into_iter().map(move |finding| FindingRow {
        file: file.clone(),
        format: report
            .format
            .map_or("unknown".to_owned(), |format| format.to_string()),
        line: finding.line,
        column: finding.column,
        severity: match finding.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
        },
        rule: finding.rule,
        message: finding.message,
    })
}

fn text(rows: &[FindingRow]) -> String {
    let line = |row: &FindingRow| {
        let FindingRow {
            file,
            line,
            column,
            severity,
            rule,
            message,
            ..
        } = row;
        format!("{file}:{line}:{column}: {severity}: {message} [{rule}]\n")
    };
    rows.iter().map(line).collect()
}

//! The results of `evaluate` on stdout, one constellation after the other.

use super::designs::DesignList;
use super::table::TextTable;
use super::{EvaluationContext, single};
use crate::cli::args::OutputFormat;
use crate::cli::output;
use crate::exchange::constellation::Constellation;
use crate::report::{ConstellationColumns, ConstellationEntry};
use crate::run::VERSION;
use crate::scenario::Scenario;
use anyhow::Result;
use serde::Serialize;

/// Prints constellations in the format that is asked for. Nothing of a list is kept.
pub(super) struct Printer<'a> {
    work: &'a EvaluationContext<'a>,
    form: PrintForm,
    /// Whether cases of failures were printed.
    has_cases: bool,
    /// What is printed below the table.
    below: String,
}

enum PrintForm {
    /// One constellation, printed at the end in the form of its kind.
    Alone(Option<Box<ConstellationEntry>>),
    /// A table for reading.
    Text(TextTable),
    /// The elements of an array.
    Json { is_begun: bool },
    /// A table with the columns of its first row.
    Csv {
        has_files: bool,
        columns: Option<ConstellationColumns>,
    },
}

impl<'a> Printer<'a> {
    /// A printer of the constellations given one by one and those of a list.
    pub(super) fn new(
        work: &'a EvaluationContext<'a>,
        given: &[Constellation],
        list: Option<&DesignList>,
    ) -> Self {
        let is_of_one_kind = |one: &Constellation| one.design.is_none() || one.files.is_none();
        let is_alone = list.is_none() && matches!(given, [one] if is_of_one_kind(one));
        let form = match work.args.format {
            OutputFormat::Csv => PrintForm::Csv {
                has_files: given.iter().any(|one| one.files.is_some())
                    || list.is_some() && names_files(work.scenario),
                columns: None,
            },
            _ if is_alone => PrintForm::Alone(None),
            OutputFormat::Text => PrintForm::Text(TextTable::new(work, given, list)),
            OutputFormat::Json => PrintForm::Json { is_begun: false },
        };
        Self {
            work,
            form,
            has_cases: false,
            below: String::new(),
        }
    }

    /// Prints the next constellation.
    pub(super) fn entry(&mut self, entry: ConstellationEntry) -> Result<()> {
        match &mut self.form {
            PrintForm::Alone(kept) => {
                *kept = Some(Box::new(entry));
                Ok(())
            }
            PrintForm::Text(table) => {
                if let Some(expected) = &entry.evaluated.expected {
                    let table = expected.to_text();
                    self.below += &format!("\n{}:{table}", entry.name);
                }
                if let Some(phases) = &entry.evaluated.phases {
                    self.below += &format!("\n{}:{}", entry.name, phases.to_text());
                }
                if let Some(failures) = &entry.evaluated.failures {
                    self.below += &format!("\n{}:{}", entry.name, failures.to_text());
                }
                table.row(&entry)
            }
            PrintForm::Json { is_begun } => {
                let before = if *is_begun {
                    ",\n"
                } else {
                    "{\n  \"constellations\": [\n"
                };
                *is_begun = true;
                output::part(&format!("{before}{}", indented(&entry, 4)?))
            }
            PrintForm::Csv { columns: None, .. } if has_cases(&entry) => {
                let with_header = !std::mem::replace(&mut self.has_cases, true);
                if let Some(failures) = &entry.evaluated.failures {
                    output::part(&failures.to_csv(&entry.name, with_header)?)?;
                }
                if let Some(phases) = &entry.evaluated.phases {
                    output::part(&phases.to_csv(&entry.name, with_header)?)?;
                }
                Ok(())
            }
            PrintForm::Csv { has_files, columns } => {
                if let Some(columns) = columns {
                    return output::part(&columns.row(&entry)?);
                }
                let new = ConstellationColumns::of(&entry, *has_files);
                output::part(&(new.header()? + &new.row(&entry)?))?;
                *columns = Some(new);
                Ok(())
            }
        }
    }

    /// Prints what follows the constellations: the GNSS alone, and the study.
    pub(super) fn end(self) -> Result<()> {
        let gnss_only = self.work.gnss_only.as_ref();
        let gnss_row = gnss_only.map(ConstellationEntry::of_gnss);
        match self.form {
            PrintForm::Alone(None) => Ok(()),
            PrintForm::Alone(Some(entry)) => single::print(self.work, *entry),
            PrintForm::Text(table) => {
                table.end(gnss_row.as_ref())?;
                output::part(&self.below)
            }
            PrintForm::Json { .. } => {
                let (gnss, stamp) = (indented(&gnss_only, 2)?, &self.work.stamp);
                output::result(&format!(
                    "\n  ],\n  \"gnss_only\": {},\n  \"scenario\": {},\n  \"version\": \"{VERSION}\"\n}}",
                    gnss.trim_start(),
                    indented(stamp, 2)?.trim_start(),
                ))
            }
            PrintForm::Csv { columns, .. } => match (columns, gnss_row) {
                (Some(columns), Some(row)) => output::part(&columns.row(&row)?),
                _ => Ok(()),
            },
        }
    }
}

/// Whether failures or phases are printed in place of the constellation.
fn has_cases(entry: &ConstellationEntry) -> bool {
    entry.evaluated.failures.is_some() || entry.evaluated.phases.is_some()
}

/// Whether a list may name a constellation with satellites from files.
fn names_files(scenario: &Scenario) -> bool {
    let named = &scenario.constellations;
    named.iter().any(|one| !one.parts.files.is_empty())
}

/// JSON in lines, indented as a part of a larger object.
fn indented(value: &impl Serialize, by: usize) -> Result<String> {
    let text = crate::printable::json(value)?;
    let lines = text.lines().map(|line| format!("{:by$}{line}", ""));
    Ok(lines.collect::<Vec<_>>().join("\n"))
}

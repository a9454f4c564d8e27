//! A validation as the appendix of a paper: for each check its gate, the reason, and the planted errors that fail it.

use super::{
    budget_table, check_table, comparison_lines, conventions, digits, distribution_table,
    distributions, satellite_table, sweep_table, verdict,
};
use crate::printable::markdown;
use crate::report::section::{Headline, ReportSection};
use crate::report::{Align, Table};
use crate::run::ValidateResult;
use crate::validate::{Check, caught_by};
use std::fmt::Write;

/// What is validated.
pub(crate) fn headline(result: &ValidateResult) -> Headline {
    Headline {
        title: format!("Validation of {}", result.subject()),
        lines: vec![
            format!(
                "Scenario {} ({}), propagation model {}, navwalker {}.",
                result.scenario.name, result.scenario.hash, result.model, result.version
            ),
            conventions(&result.basis) + ".",
        ],
        verdict: verdict(result),
        notes: result.findings.notes.clone(),
    }
}

/// The parts that a result has.
pub(crate) fn sections(result: &ValidateResult) -> Vec<ReportSection> {
    let findings = &result.findings;
    let mut sections = Vec::new();
    if !findings.budget.is_empty() {
        sections.push(ReportSection {
            title: "Error budget".to_owned(),
            caption:
                "Second minus first, in the radial, in-track and cross-track axes of the first."
                    .to_owned(),
            table: budget_table(&findings.budget),
            remarks: budget_remarks(result),
        });
    }
    if !findings.sweep.is_empty() {
        sections.push(ReportSection {
            title: "Over inclination and altitude".to_owned(),
            caption: "Circular patterns of 12 satellites; cases as in the budget. The last column is the largest fraction of a gate.".to_owned(),
            table: sweep_table(&findings.sweep),
            remarks: Vec::new(),
        });
    }
    sections.push(ReportSection {
        title: "Checks".to_owned(),
        caption: "A check without a gate is reported for information (info) and counts neither as passed nor as failed. \
                  The last column names errors that were planted in the library to see the gate fail.".to_owned(),
        table: explained_checks(&findings.checks),
        remarks: Vec::new(),
    });
    let residuals = distributions(result);
    if !residuals.is_empty() {
        sections.push(ReportSection {
            title: "Residuals".to_owned(),
            caption: "Magnitudes, and the input that gives the largest.".to_owned(),
            table: distribution_table(&residuals),
            remarks: Vec::new(),
        });
    }
    sections.extend(findings.files.iter().map(|comparison| ReportSection {
        title: format!("File {}", comparison.source),
        caption: "The satellites that differ most.".to_owned(),
        table: satellite_table(comparison),
        remarks: comparison_lines(comparison),
    }));
    sections
}

fn budget_remarks(result: &ValidateResult) -> Vec<String> {
    let lines = result.findings.budget.iter();
    lines
        .map(|line| {
            let worst = &line.worst;
            format!(
                "{}: {}; worst {} at {} s, {} km",
                line.case,
                line.cause,
                worst.satellite,
                worst.elapsed_s,
                digits(worst.distance_km)
            )
        })
        .collect()
}

/// The checks with what a reviewer asks of each.
fn explained_checks(checks: &[Check]) -> Table {
    let further = [("reason", Align::Left), ("fails under", Align::Left)];
    check_table(checks, further, |check| {
        let errors: Vec<&str> = match check.gate {
            Some(_) => caught_by(&check.name).collect(),
            None => Vec::new(),
        };
        [check.reason.clone(), errors.join("; ")]
    })
}

/// The validation in Markdown.
#[must_use]
pub fn validation_markdown(result: &ValidateResult) -> String {
    let headline = headline(result);
    let mut text = format!("# {}\n\n", markdown(&headline.title));
    for line in &headline.lines {
        let _ = writeln!(text, "{}\n", markdown(line));
    }
    let _ = writeln!(text, "**{}**", headline.verdict);
    let list = |text: &mut String, items: &[String]| {
        if !items.is_empty() {
            text.push('\n');
        }
        for item in items {
            let _ = writeln!(text, "- {}", markdown(item));
        }
    };
    list(&mut text, &headline.notes);
    for section in sections(result) {
        let _ = writeln!(
            text,
            "\n## {}\n\n{}\n",
            markdown(&section.title),
            section.caption
        );
        text += &section.table.to_markdown();
        list(&mut text, &section.remarks);
    }
    text
}

//! Studies of published numbers: their statements with verdicts, as text, Markdown, CSV and JSON.

use super::reproduction::{ReproduceResult, round};
use super::{Align, Table};
use crate::keyword::Keyword;
use crate::printable::{markdown, printable};
use crate::run::VERSION;
use crate::run::columns::optional;
use crate::run::tables::text;
use crate::study::published::{JudgedStatement, JudgedStudy};
use crate::study::{Expected, Statement, Verdict};
use ::csv::Writer;
use serde::Serialize;
use std::fmt::Write;
use std::io;

/// The output of `reproduce`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudiesResult {
    /// The studies, in the order asked for.
    pub studies: Vec<StudyResult>,
    /// Version of the program.
    pub version: &'static str,
}

/// One study of an output.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum StudyResult {
    /// The paper's, with its tables, searches and figures.
    Paper(Box<ReproduceResult>),
    /// One of published numbers.
    Published(PublishedResult),
}

/// A study of published numbers, judged.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PublishedResult {
    /// Its name.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Where the numbers are from.
    pub source: String,
    /// What is known about them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// SHA-256 of the study and the overrides of its scenario, hex.
    pub sha256: String,
    /// The statements.
    pub statements: Vec<StatementRecord>,
}

/// A statement of a study with its verdict.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StatementRecord {
    /// What is stated.
    pub name: String,
    /// The constellation; the paper's statements name it in words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub of: Option<String>,
    /// What is computed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub metric: Option<String>,
    /// The published number.
    pub expected: f64,
    /// `within` the tolerance, `at-least` or `more-than`.
    pub relation: &'static str,
    /// The largest difference; `None` for a bound.
    pub tolerance: Option<f64>,
    /// Ours under the scenario of the study.
    pub computed: Option<f64>,
    /// Unit of the numbers.
    pub unit: String,
    /// The place in the source.
    pub source: String,
    /// The verdict.
    pub verdict: Verdict,
    /// The assumption under which it is met, if it is not under the scenario.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub assumption: Option<String>,
    /// Ours under that assumption.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub computed_there: Option<f64>,
    /// What is known of a disagreement.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub disagreement: Option<String>,
}

/// A text of a study as it is shown everywhere.
fn shown(text: &str) -> String {
    printable(text).into_owned()
}

impl From<&Statement> for StatementRecord {
    fn from(statement: &Statement) -> Self {
        let (expected, relation, tolerance) = match statement.expected {
            Expected::Value { value, tolerance } => (value, "within", Some(tolerance)),
            Expected::AtLeast(bound) => (bound, "at-least", None),
            Expected::MoreThan(bound) => (bound, MORE_THAN, None),
        };
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        Self {
            name: shown(&statement.statement),
            of: None,
            metric: None,
            expected,
            relation,
            tolerance,
            computed: finite(statement.ours),
            unit: statement.unit.clone(),
            source: shown(&statement.place),
            verdict: statement.verdict,
            assumption: statement.assumption.as_deref().map(shown),
            computed_there: finite(statement.ours_there),
            disagreement: None,
        }
    }
}

impl StatementRecord {
    /// Verdict, statement, published and computed number, unit, source, assumption and the number computed under it.
    pub(super) fn cells(&self) -> [String; 8] {
        let shown = |value: f64| computed(value, self);
        [
            self.verdict.to_string(),
            self.name.clone(),
            expected(self),
            self.computed.map_or_else(|| "-".to_owned(), shown),
            self.unit.clone(),
            self.source.clone(),
            self.assumption.clone().unwrap_or_default(),
            self.computed_there.map_or_else(String::new, shown),
        ]
    }
}

impl From<&JudgedStatement> for StatementRecord {
    fn from(judged: &JudgedStatement) -> Self {
        Self {
            of: Some(shown(&judged.of)),
            metric: Some(judged.metric.to_string()),
            disagreement: judged.disagreement.as_deref().map(shown),
            ..Self::from(&judged.statement)
        }
    }
}

impl PublishedResult {
    /// The result of a study, which `sha256` identifies.
    #[must_use]
    pub fn new(study: &JudgedStudy, sha256: String) -> Self {
        Self {
            name: study.name.clone(),
            title: shown(&study.title),
            source: shown(&study.source),
            notes: study.notes.iter().map(|note| shown(note)).collect(),
            sha256,
            statements: study.statements.iter().map(Into::into).collect(),
        }
    }
}

impl StudyResult {
    /// Its name.
    #[must_use]
    pub fn name(&self) -> &str {
        match self {
            Self::Paper(paper) => paper.name,
            Self::Published(study) => &study.name,
        }
    }

    /// The statements.
    #[must_use]
    pub fn statements(&self) -> &[StatementRecord] {
        match self {
            Self::Paper(paper) => &paper.statements,
            Self::Published(study) => &study.statements,
        }
    }

    /// What it is.
    pub(super) fn title(&self) -> &str {
        match self {
            Self::Paper(_) => {
                "The paper that this program implements; alone, it prints its tables too"
            }
            Self::Published(study) => &study.title,
        }
    }

    /// Where its numbers are from, and what is known of them.
    pub(super) fn source_and_notes(&self) -> (Option<&str>, &[String]) {
        match self {
            Self::Paper(_) => (None, &[]),
            Self::Published(study) => (Some(&study.source), &study.notes),
        }
    }

    /// What is said of the numbers that disagree, or that nothing is known of them.
    pub(super) fn disagreements(&self) -> Vec<String> {
        let published = matches!(self, Self::Published(_));
        let told = self.statements().iter().filter_map(|one| {
            let known = one.disagreement.as_deref();
            match (one.verdict, known) {
                (Verdict::NotMet, None) if published => {
                    Some(format!("{}: not met, and not explained", one.name))
                }
                (Verdict::NotMet | Verdict::MetUnderAssumption, Some(known)) => {
                    Some(format!("{}: {known}", one.name))
                }
                _ => None,
            }
        });
        told.collect()
    }

    /// Number of statements with each verdict, in the order of [`Verdict::ALL`].
    pub(super) fn counts(&self) -> Vec<(Verdict, usize)> {
        let statements = self.statements().iter();
        let count = |verdict: &Verdict| {
            let with = statements.clone().filter(|one| one.verdict == *verdict);
            (*verdict, with.count())
        };
        Verdict::ALL.iter().map(count).collect()
    }
}

const LEFT: Align = Align::Left;
const RIGHT: Align = Align::Right;

fn statements_table(study: &StudyResult) -> Table {
    let mut columns = vec![
        ("verdict", LEFT),
        ("statement", LEFT),
        ("published", RIGHT),
        ("computed", RIGHT),
        ("unit", LEFT),
        ("source", LEFT),
    ];
    let mut statements = study.statements().iter();
    if statements.any(|one| one.assumption.is_some()) {
        columns.push(("assumption under which it is met", LEFT));
        columns.push(("computed under it", RIGHT));
    }
    let mut table = Table::new(&columns);
    for one in study.statements() {
        table.row(one.cells());
    }
    table
}

/// The published number, and three digits of its tolerance.
fn expected(one: &StatementRecord) -> String {
    let value = crate::units::round_decimal(one.expected, 8);
    match (one.tolerance, one.relation) {
        (Some(tolerance), _) => format!("{value} ± {}", three_digits(tolerance)),
        (None, MORE_THAN) => format!("> {value}"),
        (None, _) => format!(">= {value}"),
    }
}

fn three_digits(value: f64) -> f64 {
    let text = format!("{value:.2e}");
    text.parse().unwrap_or(value)
}

/// The relation of a number that must be above a bound.
const MORE_THAN: &str = "more-than";

/// A computed number with two digits more than its tolerance, or as many as bounds need.
fn computed(value: f64, one: &StatementRecord) -> String {
    match one.tolerance {
        Some(tolerance) if tolerance < 1e-2 => {
            let digits = (2.0 - tolerance.log10().floor()).clamp(0.0, 12.0) as usize;
            format!("{value:.digits$}")
        }
        Some(_) => round(value),
        None => format!("{}", crate::units::round_decimal(value, 8)),
    }
}

/// How many statements of each study have which verdict.
fn summary_table(result: &StudiesResult) -> Table {
    let mut columns = vec![("study", LEFT), ("statements", RIGHT)];
    columns.extend(Verdict::ALL.iter().map(|one| (one.keyword(), RIGHT)));
    let mut table = Table::new(&columns);
    for study in &result.studies {
        let counts = study.counts().into_iter();
        let mut cells = vec![
            study.name().to_owned(),
            study.statements().len().to_string(),
        ];
        cells.extend(counts.map(|(_, count)| count.to_string()));
        table.row(cells);
    }
    table
}

/// The studies for a terminal.
#[must_use]
pub fn studies_text(result: &StudiesResult) -> String {
    let mut text = String::new();
    for study in &result.studies {
        let _ = writeln!(text, "{}: {}", study.name(), study.title());
        let (source, notes) = study.source_and_notes();
        if let Some(source) = source {
            let _ = writeln!(text, "{source}");
        }
        let _ = write!(text, "\n{}\n", statements_table(study).to_text());
        for note in notes.iter().chain(&study.disagreements()) {
            let _ = writeln!(text, "note: {note}");
        }
        text.push('\n');
    }
    if result.studies.len() > 1 {
        text += &summary_table(result).to_text();
    }
    text
}

/// The studies for an appendix.
#[must_use]
pub fn studies_markdown(result: &StudiesResult) -> String {
    let mut text = format!(
        "# Published numbers\n\nnavwalker {}.\n\n{}\n",
        result.version,
        summary_table(result).to_markdown()
    );
    for study in &result.studies {
        let title = markdown(study.title());
        let _ = write!(text, "\n## {}\n\n{title}.\n", study.name());
        let (source, notes) = study.source_and_notes();
        if let Some(source) = source {
            let _ = writeln!(text, "\nSource: {}.", markdown(source));
        }
        let _ = write!(text, "\n{}\n", statements_table(study).to_markdown());
        for note in notes.iter().chain(&study.disagreements()) {
            let _ = writeln!(text, "- {}", markdown(note));
        }
    }
    text
}

/// The statements of studies, one per row.
///
/// # Errors
/// Never for a table in memory.
pub fn statements_csv(studies: &[StudyResult]) -> io::Result<String> {
    let rows = studies.iter().flat_map(|study| {
        let statements = study.statements().iter();
        statements.map(|one| (study.name(), one))
    });
    rows_csv(rows)
}

/// The same of one study.
pub(super) fn rows_csv<'s>(
    rows: impl Iterator<Item = (&'s str, &'s StatementRecord)>,
) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record([
        "study",
        "name",
        "expected",
        "relation",
        "tolerance",
        "computed",
        "unit",
        "source",
        "verdict",
        "assumption",
        "computed_there",
    ])?;
    for (study, one) in rows {
        writer.write_record([
            study.to_owned(),
            one.name.clone(),
            one.expected.to_string(),
            one.relation.to_owned(),
            optional(one.tolerance),
            optional(one.computed),
            one.unit.clone(),
            one.source.clone(),
            one.verdict.to_string(),
            one.assumption.clone().unwrap_or_default(),
            optional(one.computed_there),
        ])?;
    }
    text(writer)
}

impl StudiesResult {
    /// The result of some studies.
    #[must_use]
    pub fn new(studies: Vec<StudyResult>) -> Self {
        Self {
            studies,
            version: VERSION,
        }
    }
}

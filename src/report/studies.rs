//! Studies of published numbers: their statements with verdicts, as text, Markdown, CSV and JSON.

use super::section::ReportSection;
use super::study_sections::sections;
use super::{Align, Table};
use crate::keyword::Keyword;
use crate::printable::{markdown, printable};
use crate::run::columns::optional;
use crate::run::tables::text;
use crate::run::{ScenarioStamp, VERSION};
use crate::study::published::{
    ComputedValue, FigureData, FoundFigure, FoundFit, FoundSet, JudgedStatement, JudgedStudy,
    MeasuredTable,
};
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
pub struct StudyResult {
    /// Its name.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Where the numbers are from.
    pub source: String,
    /// What is known about them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// What identifies it.
    #[serde(flatten)]
    pub stamp: StudyStamp,
    /// The statements.
    pub statements: Vec<StatementRecord>,
    /// What the numbers of tables imply.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fits: Vec<FoundFit>,
    /// Tables with ours beside what is printed.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tables: Vec<MeasuredTable>,
    /// Numbers that are not judged.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub values: Vec<ComputedValue>,
    /// The searches.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub searches: Vec<FoundSet>,
    /// Stems of the figures and tables beside the report.
    pub files: Vec<String>,
    /// The data of the figures, which are files of their own.
    #[serde(skip)]
    pub figures: Vec<FoundFigure>,
}

/// What identifies a study and its results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StudyStamp {
    /// Its scenario.
    pub scenario: ScenarioStamp,
    /// Seed of its searches; `None` without any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// SHA-256 of the study and the overrides of its scenario, hex.
    pub sha256: String,
}

/// A statement of a study with its verdict.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StatementRecord {
    /// What is stated.
    pub name: String,
    /// The constellation.
    pub of: String,
    /// What it is compared with.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub compared_with: Option<String>,
    /// What is computed.
    pub metric: String,
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
pub(super) fn shown(text: &str) -> String {
    printable(text).into_owned()
}

impl From<&JudgedStatement> for StatementRecord {
    fn from(judged: &JudgedStatement) -> Self {
        let statement: &Statement = &judged.statement;
        let (expected, relation, tolerance) = match statement.expected {
            Expected::Value { value, tolerance } => (value, "within", Some(tolerance)),
            Expected::AtLeast(bound) => (bound, "at-least", None),
            Expected::MoreThan(bound) => (bound, MORE_THAN, None),
        };
        let finite = |value: Option<f64>| value.filter(|value| value.is_finite());
        Self {
            name: shown(&statement.statement),
            of: shown(&judged.of),
            compared_with: judged.compared_with.as_deref().map(shown),
            metric: judged.metric.to_string(),
            expected,
            relation,
            tolerance,
            computed: finite(statement.ours),
            unit: statement.unit.clone(),
            source: shown(&statement.place),
            verdict: statement.verdict,
            assumption: statement.assumption.as_deref().map(shown),
            computed_there: finite(statement.ours_there),
            disagreement: judged.disagreement.as_deref().map(shown),
        }
    }
}

impl StatementRecord {
    /// Verdict, statement, published and computed number, unit, source, assumption and the number computed under it.
    fn cells(&self) -> [String; 8] {
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

impl StudyResult {
    /// The result of a study.
    #[must_use]
    pub fn new(study: JudgedStudy, stamp: StudyStamp) -> Self {
        let mut result = Self {
            title: shown(&study.title),
            source: shown(&study.source),
            notes: study.notes.iter().map(|note| shown(note)).collect(),
            stamp,
            statements: study.statements.iter().map(Into::into).collect(),
            name: study.name,
            fits: study.fits,
            tables: study.tables,
            values: study.values,
            searches: study.searches,
            figures: study.figures,
            files: Vec::new(),
        };
        result.make_printable();
        let tables = result.tables.iter().flat_map(|table| table.stems());
        let figures = result.figures.iter().map(|figure| figure.name.clone());
        result.files = tables.chain(figures).collect();
        result
    }

    /// Escapes what a terminal would obey in the texts of the study.
    fn make_printable(&mut self) {
        let safe = |text: &mut String| *text = shown(text);
        for fit in &mut self.fits {
            safe(&mut fit.name);
            fit.assumption.iter_mut().for_each(safe);
            fit.rows.iter_mut().for_each(|row| safe(&mut row.row));
        }
        for table in &mut self.tables {
            safe(&mut table.name);
            table
                .columns
                .iter_mut()
                .for_each(|column| safe(&mut column.name));
            table.shown.iter_mut().for_each(safe);
            table
                .sensitivity
                .iter_mut()
                .for_each(|one| safe(&mut one.assumption));
            for row in &mut table.rows {
                safe(&mut row.name);
                safe(&mut row.design);
            }
        }
        for value in &mut self.values {
            safe(&mut value.name);
            safe(&mut value.of);
        }
        self.searches
            .iter_mut()
            .for_each(|search| safe(&mut search.name));
        for figure in &mut self.figures {
            safe(&mut figure.title);
            match &mut figure.data {
                FigureData::Objectives { places, .. } => {
                    for place in places {
                        safe(&mut place.scheme);
                        place.table.iter_mut().for_each(safe);
                        safe(&mut place.design);
                    }
                }
                FigureData::VisibleDistribution(curves) | FigureData::MaxPdopCourse(curves) => {
                    for curve in curves {
                        safe(&mut curve.name);
                        safe(&mut curve.design);
                    }
                }
            }
        }
    }

    /// What is shown of it beside its statements.
    pub(super) fn sections(&self) -> Vec<ReportSection> {
        sections(self)
    }

    /// What is said of the numbers that disagree, or that nothing is known of them.
    pub(super) fn disagreements(&self) -> Vec<String> {
        let told = self.statements.iter().filter_map(|one| {
            let known = one.disagreement.as_deref();
            match (one.verdict, known) {
                (Verdict::NotMet, None) => {
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
        let statements = self.statements.iter();
        let count = |verdict: &Verdict| {
            let with = statements.clone().filter(|one| one.verdict == *verdict);
            (*verdict, with.count())
        };
        Verdict::ALL.iter().map(count).collect()
    }
}

const LEFT: Align = Align::Left;
const RIGHT: Align = Align::Right;

/// The statements of a study with what was computed.
pub(super) fn statements_table(study: &StudyResult) -> Table {
    let mut columns = vec![
        ("verdict", LEFT),
        ("statement", LEFT),
        ("published", RIGHT),
        ("computed", RIGHT),
        ("unit", LEFT),
        ("source", LEFT),
    ];
    let mut statements = study.statements.iter();
    if statements.any(|one| one.assumption.is_some()) {
        columns.push(("assumption under which it is met", LEFT));
        columns.push(("computed under it", RIGHT));
    }
    let mut table = Table::new(&columns);
    for one in &study.statements {
        table.row(one.cells());
    }
    table
}

/// The published number, and three digits of its tolerance.
fn expected(one: &StatementRecord) -> String {
    // What a fit implies has more digits than it is good for.
    let digits = one
        .tolerance
        .map_or(8, |tolerance| decimals(tolerance).max(4));
    let value = crate::units::round_decimal(one.expected, digits);
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
            let digits = decimals(tolerance);
            format!("{value:.digits$}")
        }
        Some(_) => round(value),
        None if one.unit == "%" => round(value),
        None => format!("{}", crate::units::round_decimal(value, 8)),
    }
}

/// Decimals of a number that is good to a tolerance, and two more.
fn decimals(tolerance: f64) -> usize {
    (2.0 - tolerance.log10().floor()).clamp(0.0, 12.0) as usize
}

/// At most four decimals, without trailing zeros.
pub(super) fn round(value: f64) -> String {
    let text = format!("{value:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// How many statements of each study have which verdict.
fn summary_table(result: &StudiesResult) -> Table {
    let mut columns = vec![("study", LEFT), ("statements", RIGHT)];
    columns.extend(Verdict::ALL.iter().map(|one| (one.keyword(), RIGHT)));
    let mut table = Table::new(&columns);
    for study in &result.studies {
        let counts = study.counts().into_iter();
        let mut cells = vec![study.name.clone(), study.statements.len().to_string()];
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
        let _ = writeln!(text, "{}: {}\n{}", study.name, study.title, study.source);
        let _ = write!(text, "\n{}\n", statements_table(study).to_text());
        for note in study.notes.iter().chain(&study.disagreements()) {
            let _ = writeln!(text, "note: {note}");
        }
        text.push('\n');
        if result.studies.len() == 1 {
            for ReportSection {
                title,
                caption,
                table,
                ..
            } in study.sections()
            {
                let _ = writeln!(text, "{title}. {caption}\n{}", table.to_text());
            }
        } else if !study.sections().is_empty() {
            let _ = writeln!(
                text,
                "note: its tables, fits and searches are printed when it is run alone\n"
            );
        }
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
        let title = markdown(&study.title);
        let _ = write!(text, "\n## {}\n\n{title}.\n", study.name);
        let scenario = &study.stamp.scenario;
        let _ = write!(
            text,
            "\nSource: {}.\n\nScenario {} (`{}`)",
            markdown(&study.source),
            markdown(&scenario.name),
            scenario.hash
        );
        if let Some(seed) = study.stamp.seed {
            let _ = write!(text, ", seed {seed}");
        }
        text.push_str(".\n");
        let _ = write!(text, "\n{}\n", statements_table(study).to_markdown());
        for note in study.notes.iter().chain(&study.disagreements()) {
            let _ = writeln!(text, "- {}", markdown(note));
        }
        if result.studies.len() == 1 {
            for ReportSection {
                title,
                caption,
                table,
                ..
            } in study.sections()
            {
                let (title, caption) = (markdown(&title), markdown(&caption));
                let table = table.to_markdown();
                let _ = write!(text, "\n## {title}\n\n{caption}\n\n{table}");
            }
        }
    }
    text
}

/// The statements of studies, one per row.
///
/// # Errors
/// Never for a table in memory.
pub fn statements_csv(studies: &[StudyResult]) -> io::Result<String> {
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
    let rows = studies.iter().flat_map(|study| {
        let statements = study.statements.iter();
        statements.map(|one| (&study.name, one))
    });
    for (study, one) in rows {
        writer.write_record([
            study.clone(),
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

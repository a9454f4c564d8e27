//! A study as written in TOML, checked.

mod references;
mod steps;
mod tables;

use super::sky::{SkySource, StudySky};
use super::{
    OrbitQuantity, PublishedNumber, PublishedStatement, PublishedStudy, StatementComparison,
    StudyKeys, StudyMetric,
};
use crate::keyword::nearest;
use crate::scenario::builtin;
use crate::study::judge::{Expected, Provenance};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fmt;
use std::ops::Range;
use toml::{Spanned, Table, Value};

/// What is wrong with the file of a study.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyFileError {
    /// Every problem: line, from 1, and what is wrong.
    problems: Vec<(usize, String)>,
    /// The file as named by the caller.
    label: String,
}

impl fmt::Display for StudyFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (n, (line, what)) in self.problems.iter().enumerate() {
            if n > 0 {
                writeln!(f)?;
            }
            write!(f, "{}:{line}: {what}", self.label)?;
        }
        Ok(())
    }
}

impl std::error::Error for StudyFileError {}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct StudyFile {
    name: Spanned<String>,
    title: Spanned<String>,
    source: Spanned<String>,
    #[serde(default)]
    notes: Vec<String>,
    base: Option<Spanned<String>>,
    scenario: Option<Spanned<Table>>,
    #[serde(default)]
    skies: BTreeMap<String, Spanned<SkySource>>,
    #[serde(default)]
    assumption: Vec<Spanned<steps::WrittenAssumption>>,
    #[serde(default)]
    fit: Vec<Spanned<steps::WrittenFit>>,
    #[serde(default)]
    search: Vec<Spanned<steps::WrittenSearch>>,
    #[serde(default)]
    table: Vec<Spanned<tables::WrittenTable>>,
    #[serde(default)]
    value: Vec<Spanned<steps::WrittenValue>>,
    #[serde(default)]
    figure: Vec<Spanned<steps::WrittenFigure>>,
    #[serde(default)]
    statement: Vec<Spanned<StatementTable>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct StatementTable {
    name: Spanned<String>,
    #[serde(default = "gnss_only")]
    of: String,
    against: Option<String>,
    percent_above: Option<String>,
    percent_below: Option<String>,
    satellite: Option<Spanned<String>>,
    metric: Spanned<String>,
    expected: Option<Spanned<f64>>,
    tolerance: Option<Spanned<f64>>,
    at_least: Option<f64>,
    more_than: Option<f64>,
    source: Option<Spanned<String>>,
    #[serde(default = "confirmed")]
    confirmed: bool,
    #[serde(default)]
    fitted: bool,
    #[serde(default)]
    input: bool,
    disagreement: Option<String>,
    assumptions: Option<Vec<String>>,
    scenario: Option<Spanned<Table>>,
}

fn gnss_only() -> String {
    crate::exchange::constellation::GNSS_ONLY.to_owned()
}

fn confirmed() -> bool {
    true
}

/// The problems found so far, with their places in the text.
struct FileProblems<'t> {
    text: &'t str,
    found: Vec<(usize, String)>,
    /// Stems of the files of the study.
    stems: Vec<String>,
}

impl FileProblems<'_> {
    fn add(&mut self, span: Range<usize>, what: String) {
        let line = self.line(&span);
        self.add_at(line, what);
    }

    fn add_at(&mut self, line: usize, what: String) {
        self.found.push((line, what));
    }

    /// The line where a span begins, from 1.
    fn line(&self, span: &Range<usize>) -> usize {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        before.matches('\n').count() + 1
    }

    /// The keys of a scenario with their line.
    fn keys(&self, scenario: Option<Spanned<Table>>) -> StudyKeys {
        scenario.map_or_else(StudyKeys::default, |scenario| StudyKeys {
            line: self.line(&scenario.span()),
            keys: keys(scenario.get_ref()),
        })
    }
}

impl PublishedStudy {
    /// Reads a study; `label` names the file in errors. What its scenario says is checked when it is run.
    ///
    /// # Errors
    /// Everything that is wrong, each with its line.
    pub fn parse(label: &str, text: &str) -> Result<Self, StudyFileError> {
        let mut problems = FileProblems {
            text,
            found: Vec::new(),
            stems: Vec::new(),
        };
        let study = match toml::from_str::<StudyFile>(text) {
            Ok(file) => study(label, file, &mut problems),
            Err(error) => {
                let what = error.message().lines().collect::<Vec<_>>().join("; ");
                let what = with_nearest(what);
                problems.add(error.span().unwrap_or_default(), what);
                None
            }
        };
        problems.found.sort_by_key(|(line, _)| *line);
        match study {
            Some(study) if problems.found.is_empty() => Ok(study),
            _ => Err(StudyFileError {
                problems: problems.found,
                label: label.to_owned(),
            }),
        }
    }
}

fn study(label: &str, file: StudyFile, problems: &mut FileProblems<'_>) -> Option<PublishedStudy> {
    for (key, text) in [
        ("name", &file.name),
        ("title", &file.title),
        ("source", &file.source),
    ] {
        if text.get_ref().trim().is_empty() {
            problems.add(text.span(), format!("{key}: found an empty text"));
        }
    }
    if !is_study_name(file.name.get_ref()) {
        let what = format!(
            "name: found {:?}, expected letters, digits and '-'",
            file.name.get_ref()
        );
        problems.add(file.name.span(), what);
    }
    if let Some(base) = &file.base
        && let Err(error) = builtin(base.get_ref())
    {
        problems.add(base.span(), format!("base: {error}"));
    }
    let skies = file.skies.into_iter().map(|(name, table)| StudySky {
        line: problems.line(&table.span()),
        table: table.into_inner(),
        name,
    });
    let skies: Vec<StudySky> = skies.collect();
    let assumptions = steps::assumptions(file.assumption, problems);
    let searches = steps::searches(file.search, problems);
    let (tables, of_tables) = tables::tables(file.table, problems);
    let fits = steps::fits(file.fit, &tables, problems);
    let values = steps::values(file.value, problems);
    let figures = steps::figures(file.figure, problems);
    let statements = statements(file.statement, of_tables, &skies, problems);
    let study = PublishedStudy {
        name: file.name.into_inner(),
        title: file.title.into_inner(),
        source: file.source.into_inner(),
        notes: file.notes,
        label: label.to_owned(),
        base: file.base.map(Spanned::into_inner),
        scenario: problems.keys(file.scenario),
        skies,
        assumptions,
        fits,
        searches,
        tables,
        values,
        figures,
        statements,
    };
    references::check(&study, problems);
    Some(study)
}

/// The statements by themselves and those of tables, in the order of the file.
fn statements(
    written: Vec<Spanned<StatementTable>>,
    of_tables: Vec<(usize, PublishedStatement)>,
    skies: &[StudySky],
    problems: &mut FileProblems<'_>,
) -> Vec<PublishedStatement> {
    if written.is_empty() && of_tables.is_empty() {
        let what = "found no [[statement]] or [[table]], expected at least one";
        problems.add(0..0, what.to_owned());
    }
    let mut all = of_tables;
    for table in written {
        let span = table.span();
        if let Some(statement) = statement(table.into_inner(), span.clone(), problems) {
            if let Some(what) = no_such_sky(&statement, skies) {
                problems.add(span.clone(), what);
            }
            all.push((span.start, statement));
        }
    }
    all.sort_by_key(|(start, _)| *start);
    let mut statements: Vec<PublishedStatement> = Vec::new();
    for (_, statement) in all {
        if statements.iter().any(|known| known.name == statement.name) {
            let what = format!("name: there are two statements {:?}", statement.name);
            problems.add_at(statement.line, what);
        }
        statements.push(statement);
    }
    statements
}

/// What is wrong with a statement about a sky that the study does not have.
fn no_such_sky(statement: &PublishedStatement, skies: &[StudySky]) -> Option<String> {
    let StudyMetric::Sky(dilution) = statement.metric else {
        return None;
    };
    let known: Vec<&str> = skies.iter().map(|sky| sky.name.as_str()).collect();
    if known.contains(&statement.of.as_str()) {
        return None;
    }
    let meant = nearest(&statement.of, &known);
    let meant = meant.map_or_else(String::new, |name| format!(", did you mean {name:?}?"));
    Some(format!(
        "of: {dilution} is of a sky, and [skies] has no {:?}{meant}",
        statement.of
    ))
}

/// The message about an unknown key, with the nearest of those that it lists.
fn with_nearest(message: String) -> String {
    let mut quoted = message.split('`').skip(1).step_by(2);
    let (Some(found), true) = (quoted.next(), message.starts_with("unknown field")) else {
        return message;
    };
    let known: Vec<&str> = quoted.collect();
    match nearest(found, &known) {
        Some(name) => format!("{message}; did you mean `{name}`?"),
        None => message,
    }
}

fn is_study_name(name: &str) -> bool {
    let is_known = |c: char| c.is_ascii_alphanumeric() || c == '-';
    !name.is_empty() && name.chars().all(is_known)
}

fn statement(
    table: StatementTable,
    span: Range<usize>,
    problems: &mut FileProblems<'_>,
) -> Option<PublishedStatement> {
    let line = span.clone();
    let metric = problems.metric("metric", &table.metric);
    let comparison = comparison(&table, &span, problems);
    let expected = number(&table, metric, &span, problems);
    let source = match table.source {
        Some(source) if !source.get_ref().trim().is_empty() => Some(source.into_inner()),
        Some(source) => {
            problems.add(source.span(), "source: found an empty text".to_owned());
            None
        }
        None => {
            let what = format!(
                "statement {:?} has no source: say where the number is, with its page or table",
                table.name.get_ref()
            );
            problems.add(span.clone(), what);
            None
        }
    };
    let has_slot = |metric| {
        matches!(
            metric,
            StudyMetric::Orbit(OrbitQuantity::Raan | OrbitQuantity::ArgLatitude)
        )
    };
    if let (Some(satellite), Some(metric)) = (&table.satellite, metric)
        && !has_slot(metric)
    {
        let what = format!(
            "satellite: {metric} is not of one satellite; expected raan-deg or arg-latitude-deg"
        );
        problems.add(satellite.span(), what);
    }
    Some(PublishedStatement {
        name: table.name.into_inner(),
        of: table.of,
        comparison,
        satellite: table.satellite.map(Spanned::into_inner),
        metric: metric?,
        expected: expected?,
        source: source?,
        provenance: match (table.input, table.fitted) {
            (true, _) => Provenance::Input,
            (_, true) => Provenance::Fitted,
            _ => Provenance::Computed,
        },
        is_confirmed: table.confirmed,
        disagreement: table.disagreement,
        tried: table.assumptions,
        scenario: problems.keys(table.scenario),
        line: problems.line(&line),
    })
}

/// What the number of a statement is compared with.
fn comparison(
    table: &StatementTable,
    span: &Range<usize>,
    problems: &mut FileProblems<'_>,
) -> Option<StatementComparison> {
    let written = [
        table.against.clone().map(StatementComparison::Against),
        (table.percent_above.clone()).map(StatementComparison::PercentAbove),
        (table.percent_below.clone()).map(StatementComparison::PercentBelow),
    ];
    let mut written = written.into_iter().flatten();
    let first = written.next();
    if written.next().is_some() {
        let what = format!(
            "statement {:?}: expected one of against, percent-above and percent-below",
            table.name.get_ref()
        );
        problems.add(span.clone(), what);
    }
    first
}

/// The number or bound that is stated; of a fit the tolerance.
fn number(
    table: &StatementTable,
    metric: Option<StudyMetric>,
    span: &Range<usize>,
    problems: &mut FileProblems<'_>,
) -> Option<PublishedNumber> {
    let stated = (&table.expected, table.at_least, table.more_than);
    if metric == Some(StudyMetric::Implied) {
        if let (Some(tolerance), (None, None, None)) = (&table.tolerance, stated) {
            let tolerance = problems.positive("tolerance", tolerance)?;
            return Some(PublishedNumber::OfFit { tolerance });
        }
        let what = format!(
            "statement {:?} needs tolerance alone: its number is that of the fit",
            table.name.get_ref()
        );
        problems.add(span.clone(), what);
        return None;
    }
    let expected = match stated {
        (Some(value), None, None) => within(value, table.tolerance.as_ref(), span, problems),
        (None, Some(bound), None) if table.tolerance.is_none() && bound.is_finite() => {
            Some(Expected::AtLeast(bound))
        }
        (None, None, Some(bound)) if table.tolerance.is_none() && bound.is_finite() => {
            Some(Expected::MoreThan(bound))
        }
        _ => {
            let what = format!(
                "statement {:?} needs expected with tolerance, or one finite bound without: at-least or more-than",
                table.name.get_ref()
            );
            problems.add(span.clone(), what);
            None
        }
    };
    expected.map(PublishedNumber::Stated)
}

/// A number with its tolerance, which is above 0.
fn within(
    value: &Spanned<f64>,
    tolerance: Option<&Spanned<f64>>,
    statement: &Range<usize>,
    problems: &mut FileProblems<'_>,
) -> Option<Expected> {
    let Some(tolerance) = tolerance else {
        let what = "expected has no tolerance: give half of the last digit that is published, or more, with its reason";
        problems.add(statement.clone(), what.to_owned());
        return None;
    };
    if !value.get_ref().is_finite() {
        let what = format!(
            "expected: found {}, expected a finite number",
            value.get_ref()
        );
        problems.add(value.span(), what);
        return None;
    }
    Some(Expected::Value {
        value: *value.get_ref(),
        tolerance: problems.positive("tolerance", tolerance)?,
    })
}

/// The keys of a scenario table, as for `--set`: those of a section one by one.
fn keys(scenario: &Table) -> Vec<String> {
    let mut keys = Vec::new();
    for (name, value) in scenario {
        match value {
            Value::Table(section) => {
                let of_section = section.iter();
                keys.extend(of_section.map(|(key, value)| format!("{name}.{key}={value}")));
            }
            value => keys.push(format!("{name}={value}")),
        }
    }
    keys
}

#[cfg(test)]
mod tests {
    use super::*;

    const STUDY: &str = "name = \"two\"
title = \"Two numbers\"
source = \"A book\"
[scenario]
time = { step-s = 600 }
gnss = { constellations = [\"gps\"] }
[[assumption]]
name = \"another mask\"
scenario = { visibility = { mask-deg = 10 } }
[[statement]]
name = \"first\"
metric = \"p95-hdop\"
expected = 1.25
tolerance = 0.01
source = \"page 1\"
[[statement]]
name = \"second\"
of = \"delta:55:4/2/1@900\"
metric = \"mean-visible\"
at-least = 0.5
source = \"page 2\"
";

    fn told(text: &str) -> String {
        PublishedStudy::parse("two.toml", text)
            .unwrap_err()
            .to_string()
    }

    #[test]
    fn a_study_is_read() {
        let study = PublishedStudy::parse("two.toml", STUDY).unwrap();
        assert_eq!(
            study.scenario.keys,
            ["time.step-s=600", "gnss.constellations=[\"gps\"]"]
        );
        assert_eq!(
            study.assumptions[0].scenario.keys,
            ["visibility.mask-deg=10"]
        );
        let [first, second] = study.statements.as_slice() else {
            panic!("{study:?}");
        };
        assert_eq!(first.of, "gnss-only");
        let expected = Expected::Value {
            value: 1.25,
            tolerance: 0.01,
        };
        assert_eq!(first.expected, PublishedNumber::Stated(expected));
        let bound = PublishedNumber::Stated(Expected::AtLeast(0.5));
        assert_eq!(second.expected, bound);
        assert!(first.is_confirmed);
    }

    /// A metric that is unknown, a number without a source, a tolerance of 0: each with its line, all at once.
    #[test]
    fn what_is_wrong_is_told_with_its_line() {
        let wrong = STUDY
            .replace("p95-hdop", "p95-hdob")
            .replace("tolerance = 0.01", "tolerance = 0")
            .replace("source = \"page 1\"\n", "");
        let told = told(&wrong);
        let lines: Vec<&str> = told.lines().collect();
        assert!(
            lines[0].starts_with("two.toml:10: statement \"first\" has no source"),
            "{told}"
        );
        assert!(
            lines[1].starts_with(
                "two.toml:12: metric: unknown metric \"p95-hdob\", did you mean \"p95-hdop\"?"
            ),
            "{told}"
        );
        assert_eq!(
            lines[2],
            "two.toml:14: tolerance: found 0, expected a number above 0"
        );
        assert_eq!(lines.len(), 3);
    }

    #[test]
    fn other_faults_are_told() {
        for (from, to, expected) in [
            (
                "tolerance = 0.01\n",
                "",
                "two.toml:10: expected has no tolerance",
            ),
            (
                "tolerance = 0.01",
                "tolerance = nan",
                "tolerance: found NaN, expected a number above 0",
            ),
            (
                "expected = 1.25",
                "expected = inf",
                "expected: found inf, expected a finite number",
            ),
            (
                "at-least = 0.5\n",
                "",
                "needs expected with tolerance, or one finite bound",
            ),
            (
                "at-least = 0.5\n",
                "at-least = inf\n",
                "needs expected with tolerance, or one finite bound",
            ),
            (
                "at-least = 0.5\n",
                "at-least = 0.5\ntolerance = 1\n",
                "needs expected with",
            ),
            (
                "name = \"second\"",
                "name = \"first\"",
                "there are two statements \"first\"",
            ),
            (
                "name = \"two\"",
                "name = \"a b\"",
                "two.toml:1: name: found \"a b\"",
            ),
            (
                "metric = \"mean",
                "metrik = \"mean",
                "two.toml:19: unknown field `metrik`",
            ),
            (
                "source = \"A book\"",
                "source = \" \"",
                "two.toml:3: source: found an empty text",
            ),
            ("title = \"Two", "title = Two", "two.toml:2: "),
            (
                "scenario = { vis",
                "scenaro = { vis",
                "two.toml:9: unknown field `scenaro`, expected one of `name`, `scenario`, `gnss`, `epoch-shift-h`, `instead`; did you mean `scenario`?",
            ),
            (
                "scenario = { visibility = { mask-deg = 10 } }",
                "scenario = {}",
                "two.toml:9: scenario: found no keys, expected what the assumption changes",
            ),
            (
                "name = \"another mask\"",
                "name = \"\"",
                "two.toml:8: name: found an empty text",
            ),
            (
                "metric = \"p95-hdop\"",
                "metric = \"hdop\"",
                "two.toml:10: of: hdop is of a sky, and [skies] has no \"gnss-only\"",
            ),
            (
                "metric = \"mean-visible\"",
                "metric = \"mean-visible\"\nsatellite = \"NW-P01-S01\"",
                "two.toml:20: satellite: mean-visible is not of one satellite",
            ),
        ] {
            let told = told(&STUDY.replace(from, to));
            assert!(told.contains(expected), "{told}");
        }
        assert!(
            told("name = \"a\"\ntitle = \"b\"\nsource = \"c\"")
                .contains("found no [[statement]] or [[table]]")
        );
    }
}

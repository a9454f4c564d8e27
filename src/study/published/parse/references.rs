//! Whether what a study refers to is in it.

use super::FileProblems;
use crate::keyword::nearest;
use crate::study::published::steps::{FitVariable, StudyReference};
use crate::study::published::{
    PublishedStatement, PublishedStudy, StatementComparison, StudyMetric,
};

/// Adds a problem for each name that the study does not have, and for each statement of a kind that its metric is not.
pub(super) fn check(study: &PublishedStudy, problems: &mut FileProblems<'_>) {
    for statement in &study.statements {
        let line = statement.line;
        for text in statement.references() {
            add(study, text, line, problems);
        }
        if let Some(what) = misfit(study, statement) {
            problems.add_at(line, format!("statement {:?}: {what}", statement.name));
        }
        for name in statement.tried.iter().flatten() {
            let known = assumption_names(study);
            if !known.contains(&name.as_str()) {
                let what = format!("assumptions: {}", unknown("assumption", name, &known));
                problems.add_at(line, what);
            }
        }
    }
    for assumption in &study.assumptions {
        let line = assumption.scenario.line;
        for text in assumption.instead.iter().flat_map(|(from, to)| [from, to]) {
            add(study, text, line, problems);
        }
    }
    for figure in &study.figures {
        for text in &figure.of {
            add(study, text, figure.line, problems);
        }
    }
    for value in &study.values {
        add(study, &value.of, value.line, problems);
    }
}

fn add(study: &PublishedStudy, text: &str, line: usize, problems: &mut FileProblems<'_>) {
    if let Some(what) = missing(study, text) {
        problems.add_at(line, format!("{text}: {what}"));
    }
}

fn assumption_names(study: &PublishedStudy) -> Vec<&str> {
    let of_fits = study.fits.iter().filter_map(|fit| match &fit.vary {
        FitVariable::Element { assumption, .. } => Some(assumption.as_str()),
        FitVariable::Key(_) => None,
    });
    let others = study.assumptions.iter().map(|one| one.name.as_str());
    of_fits.chain(others).collect()
}

fn unknown(kind: &str, name: &str, known: &[&str]) -> String {
    let meant = nearest(name, known);
    let meant = meant.map_or_else(String::new, |name| format!(", did you mean {name:?}?"));
    format!("the study has no {kind} {name:?}{meant}")
}

/// What a text names that the study does not have.
fn missing(study: &PublishedStudy, text: &str) -> Option<String> {
    let among = |kind: &str, name: &str, known: Vec<&str>| {
        (!known.contains(&name)).then(|| unknown(kind, name, &known))
    };
    match StudyReference::of(text) {
        StudyReference::One(_) | StudyReference::Gnss(_) => None,
        StudyReference::Search(name) => {
            let known = study.searches.iter().map(|one| one.name.as_str());
            among("search", name, known.collect())
        }
        StudyReference::Fit(name) => {
            let known = study.fits.iter().map(|one| one.name.as_str());
            among("fit", name, known.collect())
        }
        StudyReference::Table(name) => {
            let known = study.tables.iter().map(|one| one.name.as_str());
            among("table", name, known.collect())
        }
        StudyReference::Rows(names) => {
            let rows = study.tables.iter().flat_map(|table| &table.rows);
            let known = rows.flat_map(|row| [Some(row.name.as_str()), row.group.as_deref()]);
            let known: Vec<&str> = known.flatten().collect();
            let mut names = names.split(',').map(str::trim);
            names.find_map(|name| among("row or group", name, known.clone()))
        }
    }
}

/// Why the metric of a statement is not one of what it is about.
fn misfit(study: &PublishedStudy, statement: &PublishedStatement) -> Option<String> {
    let of = StudyReference::of(&statement.of);
    let against = matches!(statement.comparison, Some(StatementComparison::Against(_)));
    let metric = statement.metric;
    match (metric, of) {
        (StudyMetric::Implied, StudyReference::Fit(name)) => {
            let fit = study.fits.iter().find(|fit| fit.name == name)?;
            match fit.vary {
                FitVariable::Key(_) => None,
                FitVariable::Element { .. } => Some(format!(
                    "fit {name:?} varies an element of each design, and implies no one value"
                )),
            }
        }
        (StudyMetric::Implied, _) => {
            Some("implied is of a fit, as in of = \"fit:NAME\"".to_owned())
        }
        (StudyMetric::Sets(_), StudyReference::Fit(_) | StudyReference::Gnss(_)) => {
            Some(format!("{metric} is of designs"))
        }
        (StudyMetric::Sets(_), _) if !against => Some(format!(
            "{metric} needs against, the designs to compare with"
        )),
        (StudyMetric::Sets(_), _) => None,
        (_, StudyReference::Fit(_)) => Some(format!("{metric} is not of a fit; expected implied")),
        _ if against => Some(format!(
            "{metric} is of one constellation, and compares with none; leave out against"
        )),
        (_, StudyReference::Rows(_)) => {
            Some(format!("{metric} is of one constellation, not of rows"))
        }
        (_, StudyReference::Table(name)) => {
            let table = study.tables.iter().find(|table| table.name == name)?;
            let is_column = table.column(metric).is_some() && statement.comparison.is_none();
            (!is_column).then(|| format!("{name:?} has no column of {metric}"))
        }
        _ => None,
    }
}

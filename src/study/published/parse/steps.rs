//! Assumptions, fits, searches, values and figures as written, checked.

use super::{FileProblems, StudyKeys, StudyMetric};
use crate::keyword::{Keyword, nearest};
use crate::study::published::StudyAssumption;
use crate::study::published::steps::{
    AssumedChange, DesignElement, FitVariable, Replaced, StudyFigure, StudyFit, StudyPlot,
    StudySearch, StudyTable, StudyValue,
};
use serde::Deserialize;
use std::ops::Range;
use toml::{Spanned, Table};

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct WrittenAssumption {
    name: Spanned<String>,
    scenario: Option<Spanned<Table>>,
    gnss: Option<WrittenChange>,
    epoch_shift_h: Option<Spanned<f64>>,
    #[serde(default)]
    instead: Replaced,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
struct WrittenChange {
    #[serde(default)]
    without: Vec<String>,
    #[serde(default)]
    satellites: Vec<String>,
    turn_deg: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct WrittenFit {
    name: String,
    vary: Spanned<String>,
    to: Spanned<String>,
    range: Spanned<[f64; 2]>,
    within: Option<f64>,
    step: Option<f64>,
    decimals: Option<u32>,
    assumption: Option<String>,
    agree_within: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct WrittenSearch {
    name: String,
    scenario: Option<Spanned<Table>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct WrittenValue {
    name: String,
    of: String,
    metric: Spanned<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct WrittenFigure {
    name: Spanned<String>,
    title: String,
    plot: Spanned<String>,
    of: Vec<String>,
}

impl FileProblems<'_> {
    /// A metric, or a problem.
    pub(super) fn metric(&mut self, key: &str, text: &Spanned<String>) -> Option<StudyMetric> {
        let metric = text.get_ref().parse();
        metric
            .map_err(|error| self.add(text.span(), format!("{key}: {error}")))
            .ok()
    }

    /// A number above 0, or a problem.
    pub(super) fn positive(&mut self, key: &str, number: &Spanned<f64>) -> Option<f64> {
        let (span, number) = (number.span(), *number.get_ref());
        if number > 0.0 && number.is_finite() {
            return Some(number);
        }
        let what = format!("{key}: found {number}, expected a number above 0");
        self.add(span, what);
        None
    }

    /// The stem of a file, or a problem.
    pub(super) fn stem(&mut self, key: &str, stem: &Spanned<String>) {
        const TAKEN: [&str; 3] = ["report", "scenario", "statements"];
        let name = stem.get_ref();
        if !super::is_study_name(name) || name.starts_with("deviations-") {
            let what = format!(
                "{key}: found {name:?}, expected letters, digits and '-', not from deviations-"
            );
            self.add(stem.span(), what);
        }
        if TAKEN.contains(&name.as_str()) || self.stems.contains(name) {
            self.add(stem.span(), format!("{key}: {name:?} is another file"));
        }
        self.stems.push(name.clone());
    }

    /// A name that the others of its kind do not have, or a problem.
    pub(super) fn unlike<'n>(
        &mut self,
        kind: &str,
        name: &str,
        mut known: impl Iterator<Item = &'n String>,
        span: Range<usize>,
    ) {
        if name.trim().is_empty() {
            self.add(span, "name: found an empty text".to_owned());
        } else if known.any(|one| one == name) {
            self.add(span, format!("name: there are two {kind} {name:?}"));
        }
    }
}

pub(super) fn assumptions(
    written: Vec<Spanned<WrittenAssumption>>,
    problems: &mut FileProblems<'_>,
) -> Vec<StudyAssumption> {
    let one = |written: Spanned<WrittenAssumption>| {
        let span = written.span();
        let written = written.into_inner();
        if written.name.get_ref().trim().is_empty() {
            problems.add(written.name.span(), "name: found an empty text".to_owned());
        }
        if let Some(scenario) = &written.scenario
            && scenario.get_ref().is_empty()
        {
            let what = "scenario: found no keys, expected what the assumption changes";
            problems.add(scenario.span(), what.to_owned());
        }
        let change = change(&written, span.clone(), problems);
        if written.scenario.is_none() && change.is_none() && written.instead.is_empty() {
            let what = "found no change, expected scenario, gnss, epoch-shift-h or instead";
            problems.add(span.clone(), what.to_owned());
        }
        let line = problems.line(&span);
        let mut scenario = problems.keys(written.scenario);
        if scenario.keys.is_empty() {
            scenario.line = line;
        }
        StudyAssumption {
            scenario,
            name: written.name.into_inner(),
            change,
            instead: written.instead,
        }
    };
    written.into_iter().map(one).collect()
}

fn change(
    written: &WrittenAssumption,
    span: Range<usize>,
    problems: &mut FileProblems<'_>,
) -> AssumedChange {
    let mut change = AssumedChange::default();
    if let Some(hours) = &written.epoch_shift_h {
        // A year: what turns the Earth under the constellations is a day.
        if hours.get_ref().abs() <= 8784.0 {
            change.epoch_shift_h = *hours.get_ref();
        } else {
            let what = format!(
                "epoch-shift-h: found {}, expected at most a year of 8784 hours",
                hours.get_ref()
            );
            problems.add(hours.span(), what);
        }
    }
    if let Some(gnss) = &written.gnss {
        let turns = !gnss.satellites.is_empty() && gnss.turn_deg.is_some_and(f64::is_finite);
        let neither = gnss.satellites.is_empty() && gnss.turn_deg.is_none();
        if !(turns || neither && !gnss.without.is_empty()) {
            let what = "gnss: expected without = [\"…\"], or satellites = [\"…\"] and turn-deg";
            problems.add(span, what.to_owned());
        }
        change.without.clone_from(&gnss.without);
        change.turned.clone_from(&gnss.satellites);
        change.turn_deg = gnss.turn_deg.unwrap_or(0.0);
    }
    change
}

pub(super) fn fits(
    written: Vec<Spanned<WrittenFit>>,
    tables: &[StudyTable],
    problems: &mut FileProblems<'_>,
) -> Vec<StudyFit> {
    let mut fits: Vec<StudyFit> = Vec::new();
    for written in written {
        let span = written.span();
        let written = written.into_inner();
        let others = fits.iter().map(|fit| &fit.name);
        problems.unlike("fits", &written.name, others, span.clone());
        let range = *written.range.get_ref();
        if !(range[0] < range[1] && range.iter().all(|end| end.is_finite())) {
            let what = format!("range: found {range:?}, expected two numbers, the lower first");
            problems.add(written.range.span(), what);
        }
        let to = problems.metric("to", &written.to);
        if let Some(metric) = to
            && tables.iter().all(|table| table.column(metric).is_none())
        {
            let what = format!("to: no table has a column of {metric}");
            problems.add(written.to.span(), what);
        }
        let vary = variable(&written, span.clone(), problems);
        if let (Some(vary), Some(to)) = (vary, to) {
            fits.push(StudyFit {
                name: written.name,
                vary,
                to,
                range,
                agree_within: written.agree_within,
                line: problems.line(&span),
            });
        }
    }
    fits
}

/// Most steps of a fit to either side.
const MOST_STEPS: f64 = 1000.0;

fn variable(
    written: &WrittenFit,
    span: Range<usize>,
    problems: &mut FileProblems<'_>,
) -> Option<FitVariable> {
    let vary = written.vary.get_ref();
    let Ok(element) = DesignElement::from_keyword(vary) else {
        if !vary.contains('.') {
            let meant = nearest(vary, &DesignElement::choices());
            let meant = meant.map_or_else(String::new, |name| format!(", did you mean {name:?}?"));
            let what = format!(
                "vary: found {vary:?}{meant}; expected {} of designs, or a key of the scenario as visibility.mask-deg",
                DesignElement::choices().join(" or ")
            );
            problems.add(written.vary.span(), what);
            return None;
        }
        let of_elements = written.within.is_some()
            || written.step.is_some()
            || written.decimals.is_some()
            || written.assumption.is_some();
        if of_elements {
            let what = format!(
                "within, step, decimals and assumption are of fits of {}",
                DesignElement::choices().join(" or ")
            );
            problems.add(span, what);
        }
        return Some(FitVariable::Key(vary.clone()));
    };
    let decimals = written.decimals.unwrap_or(1);
    match (written.within, written.step, &written.assumption) {
        (Some(within), Some(step), Some(assumption))
            if step > 0.0
                && within >= step
                && within / step <= MOST_STEPS
                && decimals <= 9
                && !assumption.trim().is_empty() =>
        {
            Some(FitVariable::Element {
                element,
                within,
                step,
                decimals,
                assumption: assumption.clone(),
            })
        }
        _ => {
            let what = format!(
                "a fit of {vary} needs step above 0, within from step to {MOST_STEPS} steps, decimals up to 9, and assumption, its name in words"
            );
            problems.add(span, what);
            None
        }
    }
}

pub(super) fn searches(
    written: Vec<Spanned<WrittenSearch>>,
    problems: &mut FileProblems<'_>,
) -> Vec<StudySearch> {
    let mut searches: Vec<StudySearch> = Vec::new();
    for written in written {
        let span = written.span();
        let written = written.into_inner();
        let others = searches.iter().map(|search| &search.name);
        problems.unlike("searches", &written.name, others, span.clone());
        let line = problems.line(&span);
        searches.push(StudySearch {
            name: written.name,
            scenario: match written.scenario {
                Some(scenario) => problems.keys(Some(scenario)),
                None => StudyKeys {
                    line,
                    ..StudyKeys::default()
                },
            },
            line,
        });
    }
    searches
}

pub(super) fn values(
    written: Vec<Spanned<WrittenValue>>,
    problems: &mut FileProblems<'_>,
) -> Vec<StudyValue> {
    let one = |written: Spanned<WrittenValue>| {
        let line = problems.line(&written.span());
        let written = written.into_inner();
        Some(StudyValue {
            metric: problems.metric("metric", &written.metric)?,
            name: written.name,
            of: written.of,
            line,
        })
    };
    written.into_iter().filter_map(one).collect()
}

pub(super) fn figures(
    written: Vec<Spanned<WrittenFigure>>,
    problems: &mut FileProblems<'_>,
) -> Vec<StudyFigure> {
    let one = |written: Spanned<WrittenFigure>| {
        let span = written.span();
        let written = written.into_inner();
        problems.stem("name", &written.name);
        if written.of.is_empty() {
            problems.add(span.clone(), "of: found nothing to draw".to_owned());
        }
        let plot = StudyPlot::from_keyword(written.plot.get_ref());
        let plot =
            plot.map_err(|error| problems.add(written.plot.span(), format!("plot: {error}")));
        Some(StudyFigure {
            name: written.name.into_inner(),
            title: written.title,
            plot: plot.ok()?,
            of: written.of,
            line: problems.line(&span),
        })
    };
    written.into_iter().filter_map(one).collect()
}

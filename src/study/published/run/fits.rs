//! Fits: what the numbers of a column imply of a key of the scenario, or of an element of each design.

use super::worlds::measure;
use super::{StudyRun, StudyRunError};
use crate::constellation::{Design, Shell, ShellParameters};
use crate::evaluate::{Evaluator, Setup};
use crate::exchange::constellation::Constellation;
use crate::search::{Goals, Quantity};
use crate::study::judge::Expected;
use crate::study::published::metric::StudyMetric;
use crate::study::published::steps::{
    DesignElement, FitVariable, StudyFit, StudyRow, StudyTable, rows_of,
};
use crate::study::published::{PublishedStatement, StudyKeys};
use rayon::prelude::*;
use serde::Serialize;

/// The part of its tolerance to which a fit meets a number.
const CLOSE: f64 = 1.0 / 30.0;

/// Most evaluations of a fit: bisection alone narrows 90° to 1e-4°.
const MOST_STEPS: usize = 20;

/// What a fit found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FoundFit {
    /// Its name.
    pub name: String,
    /// The key or element that was varied.
    pub vary: String,
    /// The metric whose numbers were fitted.
    pub to: String,
    /// The assumption that it makes, if it moves designs.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub assumption: Option<String>,
    /// Row by row.
    pub rows: Vec<FittedRow>,
    /// Their median, which rows that are misprinted do not affect; of a key only.
    pub median: Option<f64>,
    /// Rows close to the median, if the study says how close.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agreeing: Option<usize>,
    /// How close.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agree_within: Option<f64>,
}

/// The value that a row implies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FittedRow {
    /// The row.
    pub row: String,
    /// The value at which its number comes out; `None` if there is none, or none is needed.
    pub value: Option<f64>,
}

/// The designs that a fit moves.
pub(super) struct FitMoves {
    /// The place of the fit among all.
    pub(super) fit: usize,
    /// Its name.
    name: String,
    /// The assumption in words.
    pub(super) assumption: String,
    element: DesignElement,
    /// Row, value and notation.
    moved: Vec<(String, f64, String)>,
}

impl FitMoves {
    /// The notation of a row that is moved.
    pub(super) fn notation(&self, row: &str) -> Option<&str> {
        let moved = self.moved.iter().find(|(name, ..)| name == row);
        moved.map(|(.., notation)| notation.as_str())
    }

    /// The assumption for one row that is moved.
    pub(super) fn of_row(&self, row: &str) -> Option<String> {
        let (_, value, _) = self.moved.iter().find(|(name, ..)| name == row)?;
        let unit = match self.element {
            DesignElement::Inclination => "°",
            DesignElement::Altitude => " km",
        };
        Some(format!("{} {value}{unit}", self.name))
    }

    /// Whether a statement is about a row that is moved.
    pub(super) fn concern(&self, tables: &[StudyTable], statement: &PublishedStatement) -> bool {
        let mut rows = statement
            .references()
            .flat_map(|text| rows_of(tables, text));
        rows.any(|row| self.notation(&row.name).is_some())
    }
}

/// The number of a row that a fit meets.
struct FitTarget<'s> {
    row: &'s StudyRow,
    expected: Expected,
    value: f64,
}

impl FitTarget<'_> {
    /// Half of the width within which a fit stops.
    fn close(&self) -> f64 {
        match self.expected {
            Expected::Value { tolerance, .. } => tolerance * CLOSE,
            Expected::AtLeast(_) | Expected::MoreThan(_) => 0.0,
        }
    }
}

fn targets<'s>(tables: &'s [StudyTable], metric: StudyMetric) -> Vec<FitTarget<'s>> {
    let mut found = Vec::new();
    for table in tables {
        let Some(at) = table.column(metric) else {
            continue;
        };
        found.extend(table.rows.iter().map(|row| FitTarget {
            row,
            expected: table.columns[at].expected(row.values[at]),
            value: row.values[at],
        }));
    }
    found
}

/// Fails if the key of a fit is not one of the scenario, or cannot have the ends of its range.
pub(super) fn check(run: &StudyRun<'_>, fit: &StudyFit) -> Result<(), StudyRunError> {
    if let FitVariable::Key(key) = &fit.vary {
        for end in fit.range {
            run.with_keys(&set(key, end, fit.line))?;
        }
    }
    Ok(())
}

fn set(key: &str, value: f64, line: usize) -> StudyKeys {
    StudyKeys {
        keys: vec![format!("{key}={}", toml::Value::Float(value))],
        line,
    }
}

/// The setup for a metric: LEO satellites in view need no GNSS.
fn setup_for(metric: StudyMetric, setup: Setup) -> Setup {
    match metric {
        StudyMetric::Quantity(Quantity::MeanVisible) => Setup {
            gnss: Vec::new(),
            ..setup
        },
        _ => setup,
    }
}

fn metric_at(
    evaluator: &Evaluator,
    goals: &Goals,
    metric: StudyMetric,
    design: Design,
) -> Result<Option<f64>, StudyRunError> {
    let measured = measure(evaluator, Some(Constellation::of_design(design)))?;
    Ok(measured.value(evaluator, goals, metric)?)
}

impl StudyRun<'_> {
    /// Carries out the fits of the study.
    pub(super) fn fit(&mut self) -> Result<(), StudyRunError> {
        for fit in &self.study.fits {
            let found = match &fit.vary {
                FitVariable::Key(key) => self.implied_key(fit, key)?,
                FitVariable::Element { element, .. } => self.fitting_designs(fit, *element)?,
            };
            self.fits.push(found);
        }
        Ok(())
    }

    fn implied_key(&mut self, fit: &StudyFit, key: &str) -> Result<FoundFit, StudyRunError> {
        let place = self.world(None, &StudyKeys::default())?;
        let mut rows = Vec::new();
        for target in targets(&self.study.tables, fit.to) {
            let design = self.design(place, &target.row.of, target.row.line)?;
            let excess = |value: f64| {
                let scenario = self.with_keys(&set(key, value, fit.line))?;
                let setup = scenario.setup(self.read);
                let setup = setup.map_err(|error| self.not_set_up(fit.line, error))?;
                let evaluator = Evaluator::new(setup_for(fit.to, setup))?;
                let found = metric_at(&evaluator, &scenario.goals(), fit.to, design.clone())?;
                Ok(found.map(|found| found - target.value))
            };
            rows.push(FittedRow {
                row: target.row.name.clone(),
                value: crossing(excess, fit.range, target.close())?,
            });
        }
        let mut known: Vec<f64> = rows.iter().filter_map(|row| row.value).collect();
        known.sort_by(f64::total_cmp);
        let median = (!known.is_empty()).then(|| known[(known.len() - 1) / 2]);
        let agreeing = fit.agree_within.map(|within| {
            let near =
                |value: &&f64| median.is_some_and(|median| (**value - median).abs() <= within);
            known.iter().filter(near).count()
        });
        Ok(FoundFit {
            name: fit.name.clone(),
            vary: key.to_owned(),
            to: fit.to.to_string(),
            assumption: None,
            rows,
            median,
            agreeing,
            agree_within: fit.agree_within,
        })
    }

    fn fitting_designs(
        &mut self,
        fit: &StudyFit,
        element: DesignElement,
    ) -> Result<FoundFit, StudyRunError> {
        let FitVariable::Element { assumption, .. } = &fit.vary else {
            return Err(self
                .study
                .wrong_at(fit.line, "no element of a design".to_owned()));
        };
        let place = self.world(None, &StudyKeys::default())?;
        let targets = targets(&self.study.tables, fit.to);
        let printed = targets.iter();
        let printed = printed.map(|target| self.design(place, &target.row.of, target.row.line));
        let printed: Vec<Design> = printed.collect::<Result<_, _>>()?;
        let setup = self.worlds[place].scenario.setup(self.read);
        let setup = setup.map_err(|error| self.not_set_up(fit.line, error))?;
        let evaluator = Evaluator::new(setup_for(fit.to, setup))?;
        let goals = self.worlds[place].scenario.goals();
        let found: Vec<Option<f64>> = (targets.par_iter().zip(&printed))
            .map(|(target, design)| fitting_element(&evaluator, &goals, fit, target, design))
            .collect::<Result<_, _>>()?;
        let mut moves = FitMoves {
            fit: self.fits.len(),
            name: fit.name.clone(),
            assumption: assumption.clone(),
            element,
            moved: Vec::new(),
        };
        for ((target, design), value) in targets.iter().zip(&printed).zip(&found) {
            if let Some(value) = value {
                let design = moved(design, element, *value);
                let design = design.map_err(|error| self.study.wrong_at(target.row.line, error))?;
                let row = target.row.name.clone();
                moves.moved.push((row, *value, design.to_string()));
            }
        }
        self.moves.push(moves);
        let rows = targets.iter().zip(found);
        let rows = rows.map(|(target, value)| FittedRow {
            row: target.row.name.clone(),
            value,
        });
        Ok(FoundFit {
            name: fit.name.clone(),
            vary: element.to_string(),
            to: fit.to.to_string(),
            assumption: Some(assumption.clone()),
            rows: rows.collect(),
            median: None,
            agreeing: None,
            agree_within: None,
        })
    }
}

/// A design with another value of an element in every shell.
fn moved(design: &Design, element: DesignElement, value: f64) -> Result<Design, String> {
    let shell = |shell: &Shell| {
        let mut parameters: ShellParameters = shell.parameters();
        match element {
            DesignElement::Inclination => parameters.inclination_deg = value,
            DesignElement::Altitude => parameters.altitude_km = value,
        }
        Shell::new(parameters)
    };
    let shells = design.shells().iter().map(shell);
    let shells: Result<Vec<Shell>, _> = shells.collect();
    let design = shells.and_then(Design::new);
    design.map_err(|error| error.to_string())
}

/// The value of an element nearest to the printed one at which the number comes out; `None` if the printed one gives
/// it, or none within reach does.
fn fitting_element(
    evaluator: &Evaluator,
    goals: &Goals,
    fit: &StudyFit,
    target: &FitTarget<'_>,
    design: &Design,
) -> Result<Option<f64>, StudyRunError> {
    let FitVariable::Element {
        element,
        within,
        step,
        decimals,
        ..
    } = &fit.vary
    else {
        return Ok(None);
    };
    let Some(shell) = design.shells().first() else {
        return Ok(None);
    };
    let printed = match element {
        DesignElement::Inclination => shell.inclination_deg(),
        DesignElement::Altitude => shell.altitude_km(),
    };
    let excess = |value: f64| {
        let Ok(design) = moved(design, *element, value) else {
            return Ok(None);
        };
        let found = metric_at(evaluator, goals, fit.to, design)?;
        Ok::<Option<f64>, StudyRunError>(found.map(|found| found - target.value))
    };
    let as_printed = metric_at(evaluator, goals, fit.to, design.clone())?;
    if as_printed.is_some_and(|found| target.expected.holds(found)) {
        return Ok(None);
    }
    let Some(here) = excess(printed)? else {
        return Ok(None);
    };
    let mut sides = [(-1.0, printed, here), (1.0, printed, here)];
    let steps = (within / step).round() as u32;
    for n in 1..=steps {
        for (sign, from, at_from) in &mut sides {
            let to = printed + *sign * step * f64::from(n);
            if !(fit.range[0]..=fit.range[1]).contains(&to) {
                continue;
            }
            let Some(at_to) = excess(to)? else {
                continue;
            };
            if *at_from * at_to <= 0.0 {
                let found = crossing(excess, [*from, to], target.close())?;
                let scale = 10.0_f64.powi(i32::try_from(*decimals).unwrap_or(0));
                return Ok(found.map(|x| (scale * x).round() / scale));
            }
            (*from, *at_from) = (to, at_to);
        }
    }
    Ok(None)
}

/// The zero of a function between two arguments of opposite sign, by regula falsi (Illinois variant), to where the
/// function is `close` to 0; `None` if the signs are equal, or it has no value somewhere.
fn crossing(
    mut function: impl FnMut(f64) -> Result<Option<f64>, StudyRunError>,
    [mut a, mut b]: [f64; 2],
    close: f64,
) -> Result<Option<f64>, StudyRunError> {
    let (Some(mut at_a), Some(mut at_b)) = (function(a)?, function(b)?) else {
        return Ok(None);
    };
    if at_a * at_b > 0.0 {
        return Ok(None);
    }
    let mut x = if at_a.abs() < at_b.abs() { a } else { b };
    let mut side = 0;
    for _ in 0..MOST_STEPS {
        if at_a == at_b {
            break;
        }
        x = b - at_b * (b - a) / (at_b - at_a);
        let Some(at_x) = function(x)? else {
            return Ok(None);
        };
        if at_x.abs() < close {
            break;
        }
        if at_x * at_b > 0.0 {
            (b, at_b) = (x, at_x);
            at_a *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (a, at_a) = (x, at_x);
            at_b *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    Ok(Some(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validate_crossing_of_a_cube() {
        let root = crossing(|x| Ok(Some(x * x * x - 2.0)), [0.0, 5.0], 5e-4)
            .unwrap()
            .unwrap();
        // The slope there is 3 * 2^(2/3) = 4.8.
        assert!((root - 2.0_f64.cbrt()).abs() < 5e-4 / 4.7, "{root}");
        let never = |x: f64| Ok(Some(x + 1.0));
        assert_eq!(crossing(never, [0.0, 5.0], 5e-4).unwrap(), None);
    }
}

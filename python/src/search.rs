//! The search of a scenario, for optimisers of others.

use crate::engine::Engine;
use crate::errors;
use crate::interruptible::{Shared, on_pool};
use navwalker::optimize::{Evaluation, Pick, Problem, VariableKind};
use navwalker::run::FrontMember;
use numpy::{PyArray1, PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Name, kind and bounds of a variable.
type Variable = (String, &'static str, f64, f64);

/// Objectives, violations, the vectors as evaluated, and the notations of the designs.
type Answers<'py> = (
    Bound<'py, PyArray2<f64>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray2<f64>>,
    Vec<Option<String>>,
);

/// The variables of the search and the names of its objectives.
#[pyfunction]
pub(crate) fn search_space(
    py: Python<'_>,
    engine: &Engine,
) -> PyResult<(Vec<Variable>, Vec<String>)> {
    let evaluator = engine.evaluator(py)?;
    let study = engine.study().clone();
    let work = move |_: &Shared| -> anyhow::Result<_> {
        let problem = study.problem(&evaluator)?;
        let variables = problem.space().variables().iter().map(variable).collect();
        Ok((variables, problem.objective_names().to_vec()))
    };
    let found = on_pool(py, engine.threads, None, work)?;
    found.map_err(|error| errors::scenario(&error))
}

fn variable(one: &navwalker::optimize::Variable) -> Variable {
    let kind = match one.kind {
        VariableKind::Integer { .. } => "integer",
        VariableKind::Real { .. } => "real",
        VariableKind::Category { .. } => "category",
    };
    let (lo, hi) = one.kind.bounds();
    (one.name.clone(), kind, lo, hi)
}

/// Evaluates vectors of the space: each value is moved to the nearest that its variable can take. Objectives are as
/// minimised, infinite where they have no value.
#[pyfunction]
pub(crate) fn answers<'py>(
    py: Python<'py>,
    engine: &Engine,
    vectors: PyReadonlyArray2<'py, f64>,
) -> PyResult<Answers<'py>> {
    let evaluator = engine.evaluator(py)?;
    let study = engine.study().clone();
    let rows: Vec<Vec<f64>> = vectors
        .as_array()
        .rows()
        .into_iter()
        .map(|row| row.to_vec())
        .collect();
    let work = move |shared: &Shared| -> anyhow::Result<_> {
        let problem = study.problem(&evaluator)?;
        let nearest = |mut genome: Vec<f64>| {
            problem.space().clamp(&mut genome);
            problem.repair(&mut genome);
            genome
        };
        let rows: Vec<Vec<f64>> = rows.into_iter().map(nearest).collect();
        let answer = |genome: &Vec<f64>| -> Option<Evaluation> {
            if shared.is_asked_to_stop() {
                return None;
            }
            problem.evaluate(std::slice::from_ref(genome)).pop()
        };
        let answers: Vec<Option<Evaluation>> = rows.par_iter().map(answer).collect();
        let notation = |genome: &Vec<f64>| {
            let design = problem.designs().design(genome).ok().flatten();
            design.map(|design| design.to_string())
        };
        let notations: Vec<_> = rows.iter().map(notation).collect();
        Ok((rows, answers, notations, problem.objective_names().len()))
    };
    let found = on_pool(py, engine.threads, None, work)?;
    let (rows, answers, notations, objectives) = found.map_err(|error| errors::scenario(&error))?;
    let (mut all, mut violations) = (Vec::new(), Vec::new());
    for answer in answers {
        let answer = answer.unwrap_or_else(|| Evaluation {
            objectives: vec![f64::INFINITY; objectives],
            violation: f64::INFINITY,
        });
        all.push(answer.objectives);
        violations.push(answer.violation);
    }
    Ok((
        PyArray2::from_vec2(py, &all)?,
        PyArray1::from_vec(py, violations),
        PyArray2::from_vec2(py, &rows)?,
        notations,
    ))
}

/// The place from 0 of the design that a decision method or an index picks, in a front as JSON.
#[pyfunction]
pub(crate) fn picked(front: &str, how: &str) -> PyResult<usize> {
    let wrong = |error: String| errors::NavwalkerError::new_err(error);
    let members: Vec<FrontMember> =
        serde_json::from_str(front).map_err(|error| wrong(error.to_string()))?;
    let pick: Pick = how
        .parse()
        .map_err(|error| wrong(format!("there is no pick '{how}': {error}")))?;
    let minimised: Vec<Vec<f64>> = members.iter().map(FrontMember::minimised).collect();
    let found = pick.apply(&minimised);
    let found = found.ok_or_else(|| {
        wrong(format!(
            "there is no pick '{how}' among {} designs",
            members.len()
        ))
    })?;
    Ok(found.place)
}

//! A search with objectives that Python computes, once a batch, from the table of its designs.

use crate::columns::Columns;
use crate::design_columns::{self, Evaluated};
use crate::engine::Engine;
use crate::errors::{self, NavwalkerError};
use crate::interruptible::{Shared, in_thread};
use crate::pools::pool;
use navwalker::cli::embedded::{Reached, Study};
use navwalker::evaluate::Evaluator;
use navwalker::optimize::{Evaluation, Problem, Space, Strategy};
use navwalker::run::history_csv;
use navwalker::search::DesignProblem;
use numpy::{PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use rayon::ThreadPool;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// An objective: that of the scenario with this number, or a function of the table.
enum Objective {
    Own(usize),
    Function(Py<PyAny>),
}

/// The designs of the scenario's search under other objectives.
struct CustomProblem<'a> {
    designs: DesignProblem<'a>,
    objectives: Vec<Objective>,
    names: Vec<String>,
    shared: &'a Shared,
    pool: Arc<ThreadPool>,
    /// What was evaluated, by the bits of the vector.
    known: Mutex<BTreeMap<Vec<u64>, Evaluated>>,
    /// Why a function failed, which ends the search.
    failure: Mutex<Option<PyErr>>,
}

fn bits(genome: &[f64]) -> Vec<u64> {
    genome.iter().map(|value| value.to_bits()).collect()
}

impl CustomProblem<'_> {
    /// A design with its metrics, and what the scenario's own objectives and constraints say of it.
    fn one(&self, genome: &[f64]) -> Option<(Evaluated, Evaluation)> {
        if self.shared.is_asked_to_stop() {
            return None;
        }
        let found = self.designs.evaluated(genome);
        let own = self.designs.evaluation(found.as_ref());
        let (design, metrics) = found?;
        let beside = self.designs.satellites_beside();
        let satellites = design
            .as_ref()
            .map_or(0, navwalker::constellation::Design::satellite_count);
        let evaluated = Evaluated {
            name: design.as_ref().map(ToString::to_string).unwrap_or_default(),
            satellites: satellites + beside,
            design,
            metrics: Ok(metrics),
        };
        Some((evaluated, own))
    }

    /// The values of a function for the designs of a table, checked.
    fn values(&self, function: &Py<PyAny>, table: &Columns, count: usize) -> PyResult<Vec<f64>> {
        Python::attach(|py| {
            let found = function.call1(py, (table.clone(),))?;
            let found: PyReadonlyArray1<'_, f64> = found.extract(py)?;
            let values = found.as_array().to_vec();
            if values.len() != count {
                let why = format!(
                    "an objective gave {} values for {count} designs",
                    values.len()
                );
                return Err(NavwalkerError::new_err(why));
            }
            match values
                .iter()
                .find(|value| value.is_nan() || **value == f64::NEG_INFINITY)
            {
                Some(value) => Err(NavwalkerError::new_err(format!(
                    "an objective gave {value}, expected numbers, or inf for none"
                ))),
                None => Ok(values),
            }
        })
    }

    /// The values of every function, each for all designs of a table.
    fn by_function(&self, table: &[Evaluated]) -> PyResult<Vec<Vec<f64>>> {
        let columns = design_columns::table(table, false)
            .map_err(|error| NavwalkerError::new_err(error.to_string()))?;
        let functions = self.objectives.iter().filter_map(|one| match one {
            Objective::Function(function) => Some(function),
            Objective::Own(_) => None,
        });
        functions
            .map(|function| self.values(function, &columns, table.len()))
            .collect()
    }
}

impl Problem for CustomProblem<'_> {
    fn space(&self) -> &Space {
        self.designs.space()
    }

    fn objective_names(&self) -> &[String] {
        &self.names
    }

    fn repair(&self, genome: &mut [f64]) {
        self.designs.repair(genome);
    }

    fn unify(&self, genome: &mut [f64]) {
        self.designs.unify(genome);
    }

    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        let without_value = || Evaluation {
            objectives: vec![f64::INFINITY; self.objectives.len()],
            violation: 2.0,
        };
        let all = || batch.par_iter().map(|genome| self.one(genome)).collect();
        let found: Vec<_> = self.pool.install(all);
        let table: Vec<Evaluated> = found.iter().flatten().map(|(one, _)| one.clone()).collect();
        let mut failure = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
        if failure.is_some() || table.is_empty() {
            return batch.iter().map(|_| without_value()).collect();
        }
        let values = match self.by_function(&table) {
            Ok(values) => values,
            Err(error) => {
                *failure = Some(error);
                return batch.iter().map(|_| without_value()).collect();
            }
        };
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let mut row = 0;
        let mut answer = |(genome, found): (&Vec<f64>, Option<(Evaluated, Evaluation)>)| {
            let Some((evaluated, own)) = found else {
                return without_value();
            };
            let mut functions = values.iter();
            let value = |objective: &Objective| match objective {
                Objective::Own(place) => own.objectives[*place],
                Objective::Function(_) => functions.next().map_or(f64::INFINITY, |of| of[row]),
            };
            let objectives: Vec<f64> = self.objectives.iter().map(value).collect();
            row += 1;
            known.insert(bits(genome), evaluated);
            let is_defined = objectives.iter().all(|one| one.is_finite());
            let violation = if is_defined {
                own.violation
            } else {
                own.violation.max(1.0)
            };
            Evaluation {
                objectives,
                violation,
            }
        };
        batch.iter().zip(found).map(&mut answer).collect()
    }
}

/// Searches as the scenario says, with objectives that are numbers of its own or functions of a table, to minimise: the
/// table of the front, its objectives, and the generations.
#[pyfunction]
pub(crate) fn search_custom<'py>(
    py: Python<'py>,
    engine: &Engine,
    seed: Option<u64>,
    objectives: Vec<Bound<'py, PyAny>>,
    tick: Option<Bound<'py, PyAny>>,
) -> PyResult<(Columns, Bound<'py, PyArray2<f64>>, Columns)> {
    let evaluator = engine.evaluator(py)?;
    let study = engine.study().clone();
    let objective = |one: &Bound<'py, PyAny>| match one.extract::<usize>() {
        Ok(place) => Objective::Own(place),
        Err(_) => Objective::Function(one.clone().unbind()),
    };
    let objectives: Vec<Objective> = objectives.iter().map(objective).collect();
    let pool = pool(engine.threads)?;
    let work = move |shared: &Shared| -> PyResult<_> {
        let wrong = |error: anyhow::Error| errors::scenario(&error);
        let mut scenario = study.scenario.clone();
        let designs = pool.install(|| own(study, &evaluator));
        let problem = CustomProblem {
            designs: designs.map_err(wrong)?,
            names: (0..objectives.len())
                .map(|place| place.to_string())
                .collect(),
            objectives,
            shared,
            pool,
            known: Mutex::default(),
            failure: Mutex::default(),
        };
        // That of the scenario is for its own objectives; the search takes one from its first generation.
        scenario.objectives.hypervolume_reference = None;
        let seed = seed.unwrap_or(scenario.optimizer.seed);
        let method = scenario.method();
        let mut search = method
            .start(&problem, seed)
            .map_err(|error| wrong(error.into()))?;
        while !search.is_done() && !shared.is_asked_to_stop() {
            shared.progress.set(Reached::of(&search));
            search.step(&problem).map_err(|error| wrong(error.into()))?;
            let failure = problem
                .failure
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .take();
            if let Some(failure) = failure {
                return Err(failure);
            }
        }
        shared.progress.set(Reached::of(&search));
        let front = search.front();
        let known = problem.known.lock().unwrap_or_else(PoisonError::into_inner);
        let designs = front
            .iter()
            .filter_map(|one| known.get(&bits(&one.genome)).cloned());
        let table = design_columns::table(&designs.collect::<Vec<_>>(), false);
        let table = table.map_err(|error| wrong(error.into()))?;
        let history = history_csv(search.history(), &problem.names);
        let history = history.map_err(|error| wrong(error.into()))?;
        let history = Columns::read(&history).map_err(|error| wrong(error.into()))?;
        let values: Vec<Vec<f64>> = front.into_iter().map(|one| one.objectives).collect();
        Ok((table, values, history))
    };
    let (table, values, history) = in_thread(py, tick.as_ref(), || {}, work)??;
    Ok((table, PyArray2::from_vec2(py, &values)?, history))
}

/// The search of a study, which goes with the thread that makes it.
fn own(study: Study, evaluator: &Evaluator) -> anyhow::Result<DesignProblem<'_>> {
    study.problem(evaluator)
}

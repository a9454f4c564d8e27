//! Sweeps: the store of one, and chunks that are evaluated anywhere.

use crate::columns::Columns;
use crate::engine::Engine;
use crate::errors::{self, DesignError, FileError, NavwalkerError, NavwalkerWarning};
use crate::interruptible::{Shared, on_pool};
use anyhow::Context;
use navwalker::cli::embedded::{self, ChunkState, Study, SweepStore};
use navwalker::evaluate::Evaluator;
use navwalker::run::sweep::{
    SampleShape, SweepChunk, SweepDesigns, SweepPlan, SweptDesign, TableFormat, read_chunk,
    sweep_time_s,
};
use navwalker::run::typed_columns::TypedColumns;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::ffi::CString;
use std::fs;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

/// Designs of a sweep that is large: a table of 10 GB.
const LARGE: u64 = 20_000_000;

/// A sweep in its store.
#[pyclass(frozen, module = "navwalker._native")]
pub(crate) struct NativeSweep {
    store: Arc<SweepStore>,
    study: Mutex<Study>,
    evaluator: Arc<Evaluator>,
    /// The designs of a list; without it those of the search space.
    list: Option<SweepDesigns<'static>>,
}

/// The designs of a sweep: of its list, or of the search space of a study.
fn with_designs<T>(
    list: Option<&SweepDesigns<'static>>,
    (study, evaluator): (&Study, &Evaluator),
    work: impl FnOnce(&SweepDesigns<'_>) -> anyhow::Result<T>,
) -> anyhow::Result<T> {
    match list {
        Some(list) => work(list),
        None => {
            let problem = study.problem(evaluator)?;
            work(&SweepDesigns::of_space(&problem))
        }
    }
}

/// A design of a list by its notation or its name in the scenario, perhaps under another name.
fn swept(study: &Study, (text, name): (String, Option<String>)) -> Result<SweptDesign, String> {
    let found = embedded::constellation(study, &text);
    let found = found.map_err(|error| format!("{text}: {}", embedded::error_text(&error)))?;
    let design = found.only_design();
    let design = design
        .ok_or_else(|| format!("{text} has satellites from files, and a sweep is of designs"))?;
    let notation = design.to_string();
    let name = name.unwrap_or(found.name);
    Ok(SweptDesign {
        name: Some(name).filter(|name| *name != notation),
        notation,
    })
}

/// The sweep of a scenario in a store: the one that is there, or a new one. Without a list it is of the search space.
#[pyfunction]
#[pyo3(signature = (engine, store, list, chunk, format, force, allow_large))]
#[expect(clippy::too_many_arguments, reason = "what a sweep is")]
pub(crate) fn begin_sweep(
    py: Python<'_>,
    engine: &Engine,
    store: PathBuf,
    list: Option<Vec<(String, Option<String>)>>,
    chunk: Option<u64>,
    format: Option<&str>,
    force: bool,
    allow_large: bool,
) -> PyResult<NativeSweep> {
    let format = format.map(str::parse::<TableFormat>).transpose();
    let format = format.map_err(|error| NavwalkerError::new_err(format!("format: {error}")))?;
    if chunk == Some(0) {
        return Err(NavwalkerError::new_err("chunk is 0, expected at least 1"));
    }
    let study = engine.study().for_sweep();
    let study = study.map_err(|error| errors::scenario(&error))?;
    let list = list.map(|list| -> Result<_, String> {
        let all = list.into_iter().map(|one| swept(&study, one));
        Ok(SweepDesigns::List(all.collect::<Result<_, _>>()?))
    });
    let list = list.transpose().map_err(DesignError::new_err)?;
    let evaluator = engine.evaluator(py)?;
    let work = move |_: &Shared| {
        let opened = with_designs(list.as_ref(), (&study, &evaluator), |designs| {
            let (points, samples) = (designs.points()?, SampleShape::from(evaluator.setup()));
            if points > LARGE && !allow_large {
                let time_s = sweep_time_s(points as f64, samples, designs.mean_satellites()?);
                anyhow::bail!(
                    "the sweep would have {points} designs and take {:.0} h on one thread; more than {LARGE} need \
                     allow_large=True, or use larger steps or intervals in [search]",
                    time_s / 3600.0
                );
            }
            // Its lock ends here, so that it can be replaced.
            let held = SweepStore::read(&store)
                .ok()
                .map(|store| store.plan().clone());
            let format = format.or(held.as_ref().map(|plan| plan.format));
            let chunk = chunk.or(held.as_ref().map(|plan| plan.chunk));
            let size = (chunk, samples);
            let format = format.unwrap_or(TableFormat::Parquet);
            let plan = SweepPlan::new(study.stamp()?, designs, format, size)?;
            SweepStore::open(&store, &study, plan, designs, (true, force))
        });
        let sweep = |store| NativeSweep {
            store: Arc::new(store),
            study: Mutex::new(study),
            evaluator,
            list,
        };
        opened.map(sweep)
    };
    let found = on_pool(py, engine.threads, None, work)?;
    found.map_err(|error| FileError::new_err(in_python(&embedded::error_text(&error))))
}

/// A message that names flags of the program with the arguments that they are here.
fn in_python(text: &str) -> String {
    let names = [
        ("--out", "store"),
        ("--force", "force=True"),
        ("--as", "format"),
        ("--chunk", "chunk"),
    ];
    names.iter().fold(text.to_owned(), |text, (flag, name)| {
        text.replace(flag, name)
    })
}

#[pymethods]
impl NativeSweep {
    /// Number of its designs.
    #[getter]
    fn designs(&self) -> u64 {
        self.store.chunks().iter().map(|chunk| chunk.designs).sum()
    }

    /// Number of its chunks.
    #[getter]
    fn chunks(&self) -> usize {
        self.store.chunks().len()
    }

    /// Number of designs in a chunk.
    fn size(&self, number: usize) -> u64 {
        self.store.chunks()[number].designs
    }

    /// The chunks that are not done, by number from 0; a warning tells of those that are damaged.
    fn open(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        let store = Arc::clone(&self.store);
        let states = on_pool(py, None, None, move |_: &Shared| store.states())?;
        let mut open = Vec::new();
        for (number, state) in states.into_iter().enumerate() {
            if let ChunkState::Damaged(reason) = &state {
                let text = format!("chunk {}: {reason}; it is computed again", number + 1);
                let category = py.get_type::<NavwalkerWarning>();
                PyErr::warn(py, &category, &CString::new(text)?, 2)?;
            }
            if state != ChunkState::Done {
                open.push(number);
            }
        }
        Ok(open)
    }

    /// The name of a chunk, and what a process needs to evaluate it beside the scenario.
    fn chunk<'py>(
        &self,
        py: Python<'py>,
        number: usize,
    ) -> PyResult<(String, Bound<'py, PyBytes>)> {
        let made = py.detach(|| {
            let study = self.study.lock().unwrap_or_else(PoisonError::into_inner);
            with_designs(self.list.as_ref(), (&study, &self.evaluator), |designs| {
                let chunk = self.store.chunk(number, designs)?;
                let job = serde_json::to_vec(&(self.store.plan().format, &chunk))?;
                Ok((chunk.name, job))
            })
        });
        let (name, job) = made.map_err(|error| errors::file(&error))?;
        Ok((name, PyBytes::new(py, &job)))
    }

    /// Puts the result of a chunk in its place.
    fn put(&self, py: Python<'_>, number: usize, result: &[u8]) -> PyResult<()> {
        let put = py.detach(|| self.store.put(number, result));
        put.map_err(|error| errors::file(&error))
    }

    /// Writes the merged table and its index.
    fn merge(&self, py: Python<'_>) -> PyResult<()> {
        let store = Arc::clone(&self.store);
        let merged = on_pool(py, None, None, move |_: &Shared| store.merge())?;
        match merged.map_err(|error| errors::file(&error))? {
            Ok(_) => Ok(()),
            Err(open) => {
                let why = format!("{} chunks have no result that can be used", open.len());
                Err(FileError::new_err(why))
            }
        }
    }
}

/// The table of the sweep in a store, from the results of its chunks.
#[pyfunction]
#[expect(
    clippy::disallowed_methods,
    reason = "the module reads stores; only the library opens no path"
)]
pub(crate) fn read_sweep(py: Python<'_>, store: PathBuf) -> PyResult<Columns> {
    let read = move || -> anyhow::Result<Option<TypedColumns>> {
        let store = SweepStore::read(&store)?;
        let plan = store.plan();
        let mut all: Option<TypedColumns> = None;
        for chunk in store.chunks() {
            let path = store.path().join(plan.chunk_path(&chunk.name));
            let told = || format!("cannot read {}", path.display());
            let bytes = fs::read(&path).with_context(told)?;
            let table = read_chunk(plan.format, &chunk.name, bytes).with_context(told)?;
            match &mut all {
                Some(all) => anyhow::ensure!(
                    all.append(table),
                    "{}: it has other columns",
                    path.display()
                ),
                None => all = Some(table),
            }
        }
        Ok(all)
    };
    let found = py.detach(read).map_err(|error| errors::file(&error))?;
    let found = found.ok_or_else(|| FileError::new_err("the sweep has no chunk"))?;
    Ok(Columns::new(found))
}

/// Evaluates a chunk, as [`NativeSweep::chunk`] gives it, into the bytes of its result.
#[pyfunction]
pub(crate) fn run_chunk<'py>(
    py: Python<'py>,
    engine: &Engine,
    chunk: &[u8],
) -> PyResult<Bound<'py, PyBytes>> {
    let read: Result<(TableFormat, SweepChunk), _> = serde_json::from_slice(chunk);
    let wrong = |error: &dyn std::fmt::Display| NavwalkerError::new_err(error.to_string());
    let (format, chunk) = read.map_err(|error| wrong(&error))?;
    let evaluator = engine.evaluator(py)?;
    let study = engine.study().clone();
    let work = move |shared: &Shared| {
        let is_stopped = || shared.is_asked_to_stop();
        embedded::sweep_chunk(&study, &evaluator, (&chunk, format), &is_stopped)
    };
    let found = on_pool(py, engine.threads, None, work)?;
    let found = found.map_err(|error| errors::scenario(&error))?;
    let found = found.ok_or_else(|| NavwalkerError::new_err("the chunk was stopped"))?;
    Ok(PyBytes::new(py, &found))
}

//! One evaluation in tiles that are evaluated anywhere.

use crate::constellation::NativeConstellation;
use crate::engine::Engine;
use crate::errors::{self, NavwalkerError};
use crate::interruptible::{Shared, on_pool};
use crate::metrics::dictionary;
use navwalker::cli::embedded;
use navwalker::run::VERSION;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::path::PathBuf;

/// What a process needs to evaluate a tile beside the scenario: the version and the hash of the scenario, which it checks, the
/// notation, the number of the tile, from 1, and that of all.
type TileJob = (String, String, String, usize, usize);

/// What each process gets to evaluate a tile of a design, tile by tile; refuses what cannot be cut into so many.
#[pyfunction]
pub(crate) fn tile_jobs<'py>(
    py: Python<'py>,
    engine: &Engine,
    one: &NativeConstellation,
    tiles: i64,
) -> PyResult<Vec<Bound<'py, PyBytes>>> {
    let evaluator = engine.evaluator_in_tiles(py)?;
    let instants = evaluator.setup().grid.len();
    let given = usize::try_from(tiles).ok();
    let Some(tiles) = given.filter(|tiles| (1..=instants).contains(tiles)) else {
        return Err(NavwalkerError::new_err(format!(
            "tiles is {tiles}, expected 1 to {instants}, one for each instant"
        )));
    };
    // A tile would refuse it as well, but somewhere else and later.
    one.propagate(evaluator.setup())
        .map_err(|error| errors::design(&error))?;
    let divisible = evaluator.require_divisible();
    divisible.map_err(|error| errors::scenario(&error.into()))?;
    let stamp = engine.study().for_sweep().and_then(|study| study.stamp());
    let hash = stamp.map_err(|error| errors::scenario(&error))?.hash;
    let design = one.all.made_of();
    let job = |tile: usize| (VERSION, &hash, &design, tile, tiles);
    let written = (1..=tiles).map(|tile| serde_json::to_vec(&job(tile)));
    let all: Result<Vec<Vec<u8>>, _> = written.collect();
    let all = all.map_err(|error| NavwalkerError::new_err(error.to_string()))?;
    Ok(all.iter().map(|bytes| PyBytes::new(py, bytes)).collect())
}

/// Evaluates a tile, as [`tile_jobs`] gives it, into the bytes of its file.
#[pyfunction]
pub(crate) fn run_tile<'py>(
    py: Python<'py>,
    engine: &Engine,
    job: &[u8],
) -> PyResult<Bound<'py, PyBytes>> {
    let job: Result<TileJob, _> = serde_json::from_slice(job);
    let job = job.map_err(|error| NavwalkerError::new_err(error.to_string()))?;
    let (version, hash, design, tile, tiles) = job;
    let evaluator = engine.evaluator_in_tiles(py)?;
    let study = engine.study().for_sweep();
    let study = study.map_err(|error| errors::scenario(&error))?;
    let work = move |_: &Shared| -> anyhow::Result<Vec<u8>> {
        anyhow::ensure!(
            version == VERSION && hash == study.stamp()?.hash,
            "the tile is of another version or scenario than that of this worker"
        );
        let one = embedded::constellation(&study, &design)?;
        embedded::design_tile(&study, &evaluator, &one, (tile, tiles))
    };
    let found = on_pool(py, engine.threads, None, work)?;
    let found = found.map_err(|error| errors::scenario(&error))?;
    Ok(PyBytes::new(py, &found))
}

/// The metrics of a design from the files of all its tiles.
#[pyfunction]
pub(crate) fn merge_tiles<'py>(
    py: Python<'py>,
    engine: &Engine,
    one: &NativeConstellation,
    paths: Vec<PathBuf>,
) -> PyResult<Bound<'py, PyDict>> {
    let evaluator = engine.evaluator_in_tiles(py)?;
    let study = engine.study().for_sweep();
    let study = study.map_err(|error| errors::scenario(&error))?;
    let all = one.all.clone();
    let work = move |_: &Shared| embedded::merged_design(&study, &evaluator, &all, paths);
    let found = on_pool(py, engine.threads, None, work)?;
    let found = found.map_err(|error| errors::file(&error))?;
    dictionary(py, &found)
}

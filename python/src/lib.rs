//! The native part of the Python module `navwalker`: what the Python files of the package build upon.
//!
//! Work goes on without the interpreter's lock, in other threads, so that Ctrl-C is seen while it lasts.

mod columns;
mod command;
mod constellation;
mod custom;
mod design_columns;
mod engine;
mod errors;
mod interruptible;
mod metrics;
mod pools;
mod search;
mod sky;
mod states;
mod sweep;
mod tiles;

use pyo3::prelude::*;

/// The native part of navwalker.
#[pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use super::columns::Columns;
    #[pymodule_export]
    use super::command::{keys, main, run_command};
    #[pymodule_export]
    use super::constellation::NativeConstellation;
    #[pymodule_export]
    use super::custom::search_custom;
    #[pymodule_export]
    use super::engine::Engine;
    #[pymodule_export]
    use super::errors::{DesignError, FileError, NavwalkerError, NavwalkerWarning, ScenarioError};
    #[pymodule_export]
    use super::search::{answers, picked, search_space};
    #[pymodule_export]
    use super::sky::dilutions;
    #[pymodule_export]
    use super::sweep::{NativeSweep, begin_sweep, read_sweep, run_chunk};
    #[pymodule_export]
    use super::tiles::{merge_tiles, run_tile, tile_jobs};

    /// Adds what is no function or class.
    #[pymodule_init]
    fn init(module: &super::Bound<'_, super::PyModule>) -> super::PyResult<()> {
        use super::PyModuleMethods;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

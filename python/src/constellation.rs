//! Constellations.

use crate::errors;
use crate::interruptible::{Shared, on_pool};
use navwalker::cli::embedded;
use navwalker::constellation::Design;
use navwalker::ephemeris::Ephemeris;
use navwalker::ephemeris::outages::SatelliteOutage;
use navwalker::evaluate::Setup;
use navwalker::exchange::constellation::Constellation;
use navwalker::exchange::import::SatelliteFilter;
use pyo3::prelude::*;
use std::path::PathBuf;
use std::sync::Arc;

/// A constellation with the satellites that are taken out of it.
#[pyclass(frozen, module = "navwalker._native")]
#[derive(Clone)]
pub(crate) struct NativeConstellation {
    pub(crate) all: Arc<Constellation>,
    without: Arc<[String]>,
}

impl NativeConstellation {
    pub(crate) fn new(all: Constellation) -> Self {
        Self {
            all: Arc::new(all),
            without: Arc::new([]),
        }
    }

    /// The satellites that are left, on the grid of a setup.
    pub(crate) fn propagate(&self, setup: &Setup) -> anyhow::Result<Ephemeris> {
        let found = embedded::propagate(&self.all, setup)?;
        if self.without.is_empty() {
            return Ok(found);
        }
        let outage = |name: &String| SatelliteOutage {
            satellite: name.clone(),
            origin: "without".to_owned(),
            interval_s: None,
        };
        let only = Setup::new(setup.grid, setup.sites.clone());
        let only = only.with_outages(self.without.iter().map(outage).collect())?;
        Ok(only.in_service(&self.all.name, found)?)
    }
}

#[pymethods]
impl NativeConstellation {
    /// The shells of a notation.
    #[staticmethod]
    fn of_notation(notation: &str) -> PyResult<Self> {
        let design: Result<Design, _> = notation.parse();
        let design = design.map_err(|error| errors::design(&anyhow::Error::new(error)))?;
        Ok(Self::new(Constellation::of_design(design)))
    }

    /// The satellites of files.
    #[staticmethod]
    #[pyo3(signature = (paths, format, only, exclude))]
    fn of_files(
        py: Python<'_>,
        paths: Vec<PathBuf>,
        format: Option<&str>,
        only: Vec<String>,
        exclude: Vec<String>,
    ) -> PyResult<Self> {
        let format = format.map(embedded::format).transpose();
        let format = format.map_err(|error| errors::file(&error))?;
        let filter = SatelliteFilter { only, exclude };
        let read = move |_: &Shared| embedded::noting(|| embedded::read(&paths, format, &filter));
        let (found, printed) = on_pool(py, None, None, read)?;
        errors::warn(py, &printed)?;
        Ok(Self::new(found.map_err(|error| errors::file(&error))?))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.all.name
    }

    /// Its shells as a notation.
    #[getter]
    fn notation(&self) -> Option<String> {
        self.all.design.as_ref().map(ToString::to_string)
    }

    /// Whether it has satellites from files.
    #[getter]
    fn has_files(&self) -> bool {
        self.all.files.is_some()
    }

    /// What its satellites are.
    #[getter]
    fn made_of(&self) -> String {
        self.all.made_of()
    }

    /// Number of satellites, before any is taken out.
    #[getter]
    fn satellites(&self) -> usize {
        self.all.satellite_count()
    }

    #[getter]
    fn out_of_service(&self) -> Vec<String> {
        self.without.to_vec()
    }

    /// The same under another name.
    fn named(&self, name: String) -> Self {
        Self {
            all: Arc::new(self.all.as_ref().clone().named(name)),
            without: Arc::clone(&self.without),
        }
    }

    /// The same without further satellites.
    fn taking_out(&self, names: Vec<String>) -> Self {
        let own = self.without.iter().cloned();
        Self {
            all: Arc::clone(&self.all),
            without: own.chain(names).collect(),
        }
    }
}

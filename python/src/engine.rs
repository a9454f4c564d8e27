//! A scenario, ready to evaluate constellations.

use crate::columns::Columns;
use crate::constellation::NativeConstellation;
use crate::design_columns::{self, Evaluated};
use crate::errors::{self, DesignError, NavwalkerError};
use crate::interruptible::{Shared, Tick, on_pool};
use crate::metrics::dictionary;
use crate::states;
use navwalker::cli::embedded::{self, PackedStudy, ScenarioText, Study, error_text};
use navwalker::constellation::{Pattern, Shell, ShellParameters};
use navwalker::evaluate::{Evaluator, Metrics};
use navwalker::exchange::constellation::Constellation;
use navwalker::frames::Frame;
use navwalker::ground::Site;
use navwalker::report::records_csv;
use navwalker::run::typed_columns::{ColumnKind, TypedColumns};
use numpy::{PyArray1, PyArray2, PyArray3, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use rayon::prelude::*;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// PDOP, and visible LEO and GNSS satellites, of every sample, by instant and in it by point.
type SampleArrays<'py> = (
    Bound<'py, PyArray1<f32>>,
    Bound<'py, PyArray1<u32>>,
    Bound<'py, PyArray1<u32>>,
);

/// Azimuths and elevations, by satellite and in it by instant.
type LookAngles<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<f64>>);

/// A scenario with every key, and the contents of its files.
type Pack<'py> = (String, Vec<Bound<'py, PyBytes>>);

/// A scenario and its evaluator, which is made when it is first needed.
#[pyclass(frozen, module = "navwalker._native")]
pub(crate) struct Engine {
    pub(crate) study: Mutex<Study>,
    /// Of evaluations of any size, in tiles.
    evaluator: OnceLock<Arc<Evaluator>>,
    /// Set once a whole evaluation is known not to be too large.
    is_whole: OnceLock<()>,
    pub(crate) threads: Option<usize>,
}

impl Engine {
    pub(crate) fn study(&self) -> MutexGuard<'_, Study> {
        self.study.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The evaluator, unless one evaluation is very large.
    pub(crate) fn evaluator(&self, py: Python<'_>) -> PyResult<Arc<Evaluator>> {
        let evaluator = match self.evaluator.get() {
            Some(known) if self.is_whole.get().is_some() => return Ok(Arc::clone(known)),
            Some(known) => {
                embedded::require_whole(known.setup()).map_err(|error| errors::refused(&error))?;
                Arc::clone(known)
            }
            // Refused before it is made, which takes long if it is very large.
            None => self.made(py, Study::evaluator)?,
        };
        self.is_whole.get_or_init(|| ());
        Ok(evaluator)
    }

    /// The evaluator for evaluations in tiles, of any size.
    pub(crate) fn evaluator_in_tiles(&self, py: Python<'_>) -> PyResult<Arc<Evaluator>> {
        match self.evaluator.get() {
            Some(known) => Ok(Arc::clone(known)),
            None => self.made(py, Study::evaluator_in_tiles),
        }
    }

    fn made(
        &self,
        py: Python<'_>,
        make: fn(&Study) -> anyhow::Result<Evaluator>,
    ) -> PyResult<Arc<Evaluator>> {
        let study = self.study().clone();
        let work = move |_: &Shared| embedded::noting(|| make(&study));
        let (made, printed) = on_pool(py, self.threads, None, work)?;
        errors::warn(py, &printed)?;
        let made = Arc::new(made.map_err(|error| errors::refused(&error))?);
        Ok(Arc::clone(self.evaluator.get_or_init(|| made)))
    }

    /// Evaluates constellations, each with its error, and gives their table.
    fn evaluated(
        &self,
        py: Python<'_>,
        all: Vec<Result<NativeConstellation, (String, String)>>,
        keeps_errors: bool,
        tick: Tick<'_, '_>,
    ) -> PyResult<Columns> {
        let evaluator = self.evaluator(py)?;
        let work = move |shared: &Shared| {
            shared.begin(all.len());
            let one = |given| evaluated(&evaluator, given, shared);
            let found: Vec<_> = all.into_par_iter().map(one).collect();
            let first = found.iter().find_map(|one| one.metrics.as_ref().err());
            match first.filter(|_| !keeps_errors) {
                Some(why) => Err(why.clone()),
                None => Ok(design_columns::table(&found, keeps_errors)),
            }
        };
        let found = on_pool(py, self.threads, tick, work)?.map_err(DesignError::new_err)?;
        found.map_err(|error| NavwalkerError::new_err(error.to_string()))
    }
}

/// A constellation as the result of its evaluation; one that cannot be made is given by its text and why.
fn evaluated(
    evaluator: &Evaluator,
    given: Result<NativeConstellation, (String, String)>,
    shared: &Shared,
) -> Evaluated {
    let found = match given {
        Ok(one) => Evaluated {
            name: one.all.name.clone(),
            design: one.all.design.clone(),
            satellites: one.all.satellite_count(),
            metrics: if shared.is_asked_to_stop() {
                Err("interrupted".to_owned())
            } else {
                let metrics = metrics(evaluator, &one);
                metrics.map_err(|error| format!("{}: {}", one.all.name, error_text(&error)))
            },
        },
        Err((text, why)) => Evaluated {
            name: text,
            design: None,
            satellites: 0,
            metrics: Err(why),
        },
    };
    shared.progress.one_more();
    found
}

fn metrics(evaluator: &Evaluator, one: &NativeConstellation) -> anyhow::Result<Metrics> {
    let ephemeris = one.propagate(evaluator.setup())?;
    let metrics = evaluator.evaluate_ephemeris(&ephemeris)?;
    Ok(evaluator.with_gain(metrics)?)
}

#[pymethods]
impl Engine {
    /// The scenario of a name or file, or of a text whose files are relative to a directory.
    #[new]
    fn new(
        source: &str,
        text: Option<&str>,
        directory: PathBuf,
        overrides: Vec<String>,
        threads: Option<usize>,
    ) -> PyResult<Self> {
        let study = match text {
            Some(text) => {
                let of = ScenarioText {
                    label: source.to_owned(),
                    text: text.to_owned(),
                    directory,
                };
                Study::of_text(&of, &overrides)
            }
            None => Study::open(source, &overrides),
        };
        Ok(Self {
            study: Mutex::new(study.map_err(|error| errors::scenario(&error))?),
            evaluator: OnceLock::new(),
            is_whole: OnceLock::new(),
            threads,
        })
    }

    /// The scenario of a pack, as [`Engine::packed`] gives it.
    #[staticmethod]
    fn unpacked(toml: String, contents: Vec<Vec<u8>>, threads: Option<usize>) -> PyResult<Self> {
        let study = Study::unpacked(PackedStudy { toml, contents });
        Ok(Self {
            study: Mutex::new(study.map_err(|error| errors::scenario(&error))?),
            evaluator: OnceLock::new(),
            is_whole: OnceLock::new(),
            threads,
        })
    }

    /// All that the metrics depend on, for another process: the scenario with every key, and the contents of its files.
    fn packed<'py>(&self, py: Python<'py>) -> PyResult<Pack<'py>> {
        let pack = py.detach(|| self.study().for_sweep()?.packed());
        let pack = pack.map_err(|error| errors::scenario(&error))?;
        let contents = pack.contents.iter().map(|bytes| PyBytes::new(py, bytes));
        Ok((pack.toml, contents.collect()))
    }

    /// Makes what does not depend on a constellation, unless it is there.
    fn prepare(&self, py: Python<'_>) -> PyResult<()> {
        self.evaluator_in_tiles(py).map(drop)
    }

    #[getter]
    fn threads(&self) -> Option<usize> {
        self.threads
    }

    #[getter]
    fn name(&self) -> String {
        self.study().scenario.name.clone()
    }

    /// Identifies everything that determines the results, files included.
    #[getter]
    fn hash(&self) -> PyResult<String> {
        let stamp = self.study().stamp();
        Ok(stamp.map_err(|error| errors::scenario(&error))?.hash)
    }

    /// The scenario with every key.
    fn to_toml(&self) -> String {
        self.study().scenario.to_toml()
    }

    #[getter]
    fn reference_design(&self) -> PyResult<String> {
        let design = self.study().reference_design();
        Ok(design
            .map_err(|error| errors::scenario(&error))?
            .to_string())
    }

    /// Seconds since the epoch of each instant.
    #[getter]
    fn elapsed_s<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let grid = self.evaluator(py)?.setup().grid;
        Ok(PyArray1::from_iter(py, grid.iter()))
    }

    /// UTC of each instant, ISO 8601.
    #[getter]
    fn utc(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        let grid = self.evaluator(py)?.setup().grid;
        let at = |elapsed_s| grid.epoch().plus_seconds(elapsed_s).to_string();
        Ok(grid.iter().map(at).collect())
    }

    /// The ground points: latitude_deg, longitude_deg, height_m, weight and name.
    fn points(&self, py: Python<'_>) -> PyResult<Columns> {
        let evaluator = self.evaluator(py)?;
        let names = [
            "latitude_deg",
            "longitude_deg",
            "height_m",
            "weight",
            "name",
        ];
        let columns = names.map(|name| (name.to_owned(), ColumnKind::of(name)));
        let row = |site: &Site| {
            let numbers = [
                site.latitude_deg,
                site.longitude_deg,
                site.height_m,
                site.weight,
            ];
            let name = Value::from(site.name.as_deref());
            numbers.map(Value::from).into_iter().chain([name]).collect()
        };
        let rows: Vec<Vec<Value>> = evaluator.setup().sites.iter().map(row).collect();
        Ok(Columns::new(TypedColumns::new(&columns, &rows)))
    }

    /// The borders of the region, as closed lines of longitudes and latitudes, degrees.
    fn outlines(&self, py: Python<'_>) -> PyResult<Vec<Vec<[f64; 2]>>> {
        Ok(self.evaluator(py)?.setup().map.outlines.to_vec())
    }

    /// A constellation by its name in the scenario, or by its notation.
    fn constellation(&self, py: Python<'_>, text: &str) -> PyResult<NativeConstellation> {
        let read = || embedded::noting(|| embedded::constellation(&self.study(), text));
        let (found, printed) = py.detach(read);
        errors::warn(py, &printed)?;
        let found = found.map_err(|error| errors::design(&error))?;
        Ok(NativeConstellation::new(found))
    }

    /// The constellations that the scenario names.
    fn constellations(&self, py: Python<'_>) -> PyResult<Vec<NativeConstellation>> {
        let read = || embedded::noting(|| embedded::constellations(&self.study()));
        let (found, printed) = py.detach(read);
        errors::warn(py, &printed)?;
        let found = found.map_err(|error| errors::scenario(&error))?;
        Ok(found.into_iter().map(NativeConstellation::new).collect())
    }

    /// The metrics of a constellation, named as in tables.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        one: &NativeConstellation,
    ) -> PyResult<Bound<'py, PyDict>> {
        let evaluator = self.evaluator(py)?;
        let one = one.clone();
        let work = move |_: &Shared| embedded::noting(|| metrics(&evaluator, &one));
        let (found, printed) = on_pool(py, self.threads, None, work)?;
        errors::warn(py, &printed)?;
        let found = found.map_err(|error| errors::design(&error))?;
        dictionary(py, &found)
    }

    /// The metrics of the GNSS alone; None without GNSS.
    fn gnss_only<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let evaluator = self.evaluator(py)?;
        let work = move |_: &Shared| evaluator.gnss_only().map(Option::<&Metrics>::copied);
        let found = on_pool(py, self.threads, None, work)?;
        let found = found.map_err(|error| errors::scenario(&error.into()))?;
        found.map(|metrics| dictionary(py, &metrics)).transpose()
    }

    /// The table of several constellations.
    fn evaluate_all(
        &self,
        py: Python<'_>,
        all: Vec<PyRef<'_, NativeConstellation>>,
        keeps_errors: bool,
        tick: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Columns> {
        let all = all.iter().map(|one| Ok(NativeConstellation::clone(one)));
        self.evaluated(py, all.collect(), keeps_errors, tick.as_ref())
    }

    /// The table of several notations or names of the scenario.
    fn evaluate_texts(
        &self,
        py: Python<'_>,
        texts: Vec<String>,
        keeps_errors: bool,
        tick: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Columns> {
        let all = py.detach(|| {
            let study = self.study();
            let read = |text: String| {
                let found = embedded::constellation(&study, &text);
                let found = found.map(NativeConstellation::new);
                found.map_err(|error| (text.clone(), format!("{text}: {}", error_text(&error))))
            };
            texts.into_iter().map(read).collect()
        });
        self.evaluated(py, all, keeps_errors, tick.as_ref())
    }

    /// The table of shells by columns of one length.
    #[expect(clippy::too_many_arguments, reason = "a column each")]
    fn evaluate_columns(
        &self,
        py: Python<'_>,
        pattern: &str,
        planes: PyReadonlyArray1<'_, i64>,
        satellites_per_plane: PyReadonlyArray1<'_, i64>,
        phasing: PyReadonlyArray1<'_, i64>,
        inclination_deg: PyReadonlyArray1<'_, f64>,
        altitude_km: PyReadonlyArray1<'_, f64>,
        keeps_errors: bool,
        tick: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Columns> {
        let pattern: Pattern = pattern
            .parse()
            .map_err(|error| errors::design(&anyhow::Error::new(error)))?;
        let counts = [&planes, &satellites_per_plane, &phasing];
        let [planes, per_plane, phasing] = counts.map(|column| column.as_array().to_vec());
        let inclinations = inclination_deg.as_array().to_vec();
        let altitudes = altitude_km.as_array().to_vec();
        let rows = planes.len();
        let shell = |row: usize| {
            let [planes, per_plane, phasing] = [planes[row], per_plane[row], phasing[row]];
            let (inclination_deg, altitude_km) = (inclinations[row], altitudes[row]);
            let count = |value: i64, what: &str| {
                usize::try_from(value).map_err(|_| format!("{what} is {value}, expected 0 or more"))
            };
            let shell = || -> Result<Shell, String> {
                let parameters = ShellParameters {
                    pattern,
                    planes: count(planes, "planes")?,
                    satellites_per_plane: count(per_plane, "satellites_per_plane")?,
                    phasing: count(phasing, "phasing")?,
                    inclination_deg,
                    altitude_km,
                };
                Shell::new(parameters).map_err(|error| error.to_string())
            };
            let made = shell()
                .map(|shell| NativeConstellation::new(Constellation::of_design(shell.into())));
            made.map_err(|why| {
                let text = format!("row {row}");
                (text.clone(), format!("{text}: {why}"))
            })
        };
        let all = py.detach(|| (0..rows).map(shell).collect());
        self.evaluated(py, all, keeps_errors, tick.as_ref())
    }

    /// The tables of instants and of points.
    fn series(&self, py: Python<'_>, one: &NativeConstellation) -> PyResult<(Columns, Columns)> {
        let evaluator = self.evaluator(py)?;
        let one = one.clone();
        let work = move |_: &Shared| {
            embedded::noting(|| -> anyhow::Result<_> {
                let series = evaluator.series(&one.propagate(evaluator.setup())?)?;
                let table = |csv: std::io::Result<String>| -> anyhow::Result<Columns> {
                    Ok(Columns::read(&csv?)?)
                };
                let epochs = table(records_csv(&series.epochs))?;
                Ok((epochs, table(records_csv(&series.points))?))
            })
        };
        let (found, printed) = on_pool(py, self.threads, None, work)?;
        errors::warn(py, &printed)?;
        found.map_err(|error| errors::design(&error))
    }

    /// Every sample by itself.
    fn samples<'py>(
        &self,
        py: Python<'py>,
        one: &NativeConstellation,
    ) -> PyResult<SampleArrays<'py>> {
        let evaluator = self.evaluator(py)?;
        let one = one.clone();
        let work = move |_: &Shared| {
            embedded::noting(|| -> anyhow::Result<_> {
                let samples = evaluator.samples(&one.propagate(evaluator.setup())?)?;
                let pdop = samples.pdop.iter().map(|one| one.unwrap_or(f32::NAN));
                Ok((
                    pdop.collect::<Vec<_>>(),
                    samples.visible,
                    samples.gnss_visible,
                ))
            })
        };
        let (found, printed) = on_pool(py, self.threads, None, work)?;
        errors::warn(py, &printed)?;
        let (pdop, visible, gnss) = found.map_err(|error| errors::design(&error))?;
        Ok((
            PyArray1::from_vec(py, pdop),
            PyArray1::from_vec(py, visible),
            PyArray1::from_vec(py, gnss),
        ))
    }

    /// Azimuths and elevations of satellites at the instants from a ground point, degrees, with NaN where there is no
    /// state.
    fn look_angles<'py>(
        &self,
        py: Python<'py>,
        one: &NativeConstellation,
        point: usize,
    ) -> PyResult<LookAngles<'py>> {
        let evaluator = self.evaluator(py)?;
        let one = one.clone();
        let work = move |_: &Shared| {
            embedded::noting(|| states::look_angles(&one, evaluator.setup(), point))
        };
        let (found, printed) = on_pool(py, self.threads, None, work)?;
        errors::warn(py, &printed)?;
        let (azimuths, elevations) = found.map_err(|error| errors::design(&error))?;
        Ok((
            PyArray2::from_vec2(py, &azimuths)?,
            PyArray2::from_vec2(py, &elevations)?,
        ))
    }

    /// Positions of satellites at the instants, km, with NaN where there is none; and the names of the satellites.
    fn positions<'py>(
        &self,
        py: Python<'py>,
        one: &NativeConstellation,
        frame: &str,
    ) -> PyResult<(Bound<'py, PyArray3<f64>>, Vec<String>)> {
        let frame: Frame = frame
            .parse()
            .map_err(|error| NavwalkerError::new_err(format!("frame: {error}")))?;
        let evaluator = self.evaluator(py)?;
        let one = one.clone();
        let work = move |_: &Shared| {
            embedded::noting(|| states::positions(&one, evaluator.setup(), frame))
        };
        let (found, printed) = on_pool(py, self.threads, None, work)?;
        errors::warn(py, &printed)?;
        let (all, names, instants) = found.map_err(|error| errors::design(&error))?;
        let array = PyArray1::from_vec(py, all);
        let array = numpy::PyArrayMethods::reshape(&array, [names.len(), instants, 3])?;
        Ok((array, names))
    }
}

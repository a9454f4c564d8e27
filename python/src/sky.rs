//! Dilutions of precision of skies.

use crate::interruptible::{Shared, on_pool};
use navwalker::dop::{SkyRule, SkySatellite, SkyView};
use numpy::{PyArray2, PyArrayMethods, PyReadonlyArray2};
use pyo3::prelude::*;
use rayon::prelude::*;

/// Rows that are not worth another thread: some tens of microseconds.
const MIN_ROWS: usize = 64;

/// GDOP, PDOP, HDOP, VDOP and the TDOP of each clock of every row of directions, degrees; a clock is the number of a
/// system from 0, and a direction that is NaN is not there. NaN where a geometry is not solved.
#[pyfunction]
pub(crate) fn dilutions<'py>(
    py: Python<'py>,
    azimuth_deg: PyReadonlyArray2<'py, f64>,
    elevation_deg: PyReadonlyArray2<'py, f64>,
    system: PyReadonlyArray2<'py, i64>,
    systems: usize,
    mask_deg: f64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (azimuth_deg, elevation_deg) =
        (azimuth_deg.to_owned_array(), elevation_deg.to_owned_array());
    let system = system.to_owned_array();
    let names: Vec<String> = (0..systems).map(|system| system.to_string()).collect();
    let count = azimuth_deg.nrows();
    let rule = SkyRule {
        mask_deg,
        ..SkyRule::default()
    };
    let of_row = move |row: usize| -> Vec<f64> {
        let satellite = |column: usize| SkySatellite {
            azimuth_deg: azimuth_deg[[row, column]],
            elevation_deg: elevation_deg[[row, column]],
            system: system[[row, column]].to_string(),
        };
        let is_there =
            |one: &SkySatellite| !(one.azimuth_deg.is_nan() || one.elevation_deg.is_nan());
        let satellites = (0..azimuth_deg.ncols()).map(satellite).filter(is_there);
        let view = SkyView {
            name: None,
            satellites: satellites.collect(),
        };
        let found = view.dops(rule);
        let tdop = |name: &String| {
            let clock = found.clocks.iter().find(|clock| clock.system == *name);
            clock.and_then(|clock| clock.tdop).unwrap_or(f64::NAN)
        };
        let position = match &found.dops {
            Some(of) => [of.gdop, of.pdop, of.hdop, of.vdop],
            None => [f64::NAN; 4],
        };
        position.into_iter().chain(names.iter().map(tdop)).collect()
    };
    let work = move |shared: &Shared| -> Vec<Vec<f64>> {
        let wanted = |row| match shared.is_asked_to_stop() {
            true => Vec::new(),
            false => of_row(row),
        };
        let rows = (0..count).into_par_iter().with_min_len(MIN_ROWS);
        rows.map(wanted).collect()
    };
    let rows = on_pool(py, None, None, work)?;
    Ok(PyArray2::from_vec2(py, &rows)?)
}

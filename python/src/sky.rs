//! Dilutions of precision of skies.

use navwalker::dop::{SkyRule, SkySatellite, SkyView};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;

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
    let (azimuth_deg, elevation_deg) = (azimuth_deg.as_array(), elevation_deg.as_array());
    let system = system.as_array();
    let names: Vec<String> = (0..systems).map(|system| system.to_string()).collect();
    let rule = SkyRule {
        mask_deg,
        ..SkyRule::default()
    };
    let of_row = |row: usize| {
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
    let rows: Vec<Vec<f64>> = (0..azimuth_deg.nrows()).map(of_row).collect();
    Ok(PyArray2::from_vec2(py, &rows)?)
}

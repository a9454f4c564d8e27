//! Dilutions of precision of skies.

use crate::errors::NavwalkerError;
use navwalker::dop::{ClockGroup, DopFamily, MOST_PDOP_CAP, ObservationWeights};
use navwalker::earth::Surface;
use navwalker::frames::LocalFrame;
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
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let (azimuth_deg, elevation_deg) = (azimuth_deg.as_array(), elevation_deg.as_array());
    let system = system.as_array();
    let site = LocalFrame::new(Surface::Sphere, 0.0, 0.0);
    let mut rows = Vec::with_capacity(azimuth_deg.nrows());
    for row in 0..azimuth_deg.nrows() {
        let mut groups = vec![ClockGroup::default(); systems];
        for column in 0..azimuth_deg.ncols() {
            let place = [row, column];
            let (azimuth, elevation) = (azimuth_deg[place], elevation_deg[place]);
            if azimuth.is_nan() || elevation.is_nan() {
                continue;
            }
            let clock = usize::try_from(system[place]).ok();
            let group = clock.and_then(|clock| groups.get_mut(clock));
            let group = group.ok_or_else(|| {
                NavwalkerError::new_err(format!("there is no system {}", system[place]))
            })?;
            let (sin_e, cos_e) = elevation.to_radians().sin_cos();
            let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
            let unit = (site.east * sin_a + site.north * cos_a) * cos_e + site.up * sin_e;
            group.add(unit, ObservationWeights::Unit.weight(sin_e));
        }
        let found = DopFamily::of(&groups, &site, MOST_PDOP_CAP);
        rows.push(match found {
            Some(of) => {
                let clocks = of.tdop.iter().map(|one| one.unwrap_or(f64::NAN));
                [of.gdop, of.pdop, of.hdop, of.vdop]
                    .into_iter()
                    .chain(clocks)
                    .collect()
            }
            None => vec![f64::NAN; 4 + systems],
        });
    }
    Ok(PyArray2::from_vec2(py, &rows)?)
}

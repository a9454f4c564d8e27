//! A study for tests, and its observations one by one.

use super::Setup;
use crate::constellation::gnss::Preset;
use crate::ephemeris::Ephemeris;
use crate::frames::EarthRotation;
use crate::ground::Site;
use crate::time::TimeGrid;
use crate::visibility::Mask;
use nalgebra::DMatrix;

/// The paper's assumptions with given points and instants, and one mask for all satellites.
pub(crate) fn setup(grid: TimeGrid, sites: Vec<Site>, mask_deg: f64) -> Setup {
    Setup::new(grid, sites)
        .with_mask(Mask::from_degrees(mask_deg).unwrap())
        .with_gnss(vec![Preset::Beidou3.into()])
}

/// A satellite in view.
pub(crate) struct Observed {
    /// Towards it: east, north, up.
    pub(crate) unit: [f64; 3],
    /// The LEO satellites come first, then each GNSS.
    pub(crate) system: usize,
    /// The part of the LEO satellites.
    pub(crate) part: usize,
}

/// The satellites in view of a point, by look angles.
pub(crate) fn observed(
    setup: &Setup,
    leo: &Ephemeris,
    site: &Site,
    elapsed_s: f64,
) -> Vec<Observed> {
    let epoch = setup.grid.epoch();
    let rotation = EarthRotation::from_gmst(epoch.gmst_rad(elapsed_s));
    let gnss: Vec<Ephemeris> = setup
        .gnss
        .iter()
        .map(|system| Ephemeris::of_gnss(system.satellites(epoch), setup.grid))
        .collect();
    let mut found = Vec::new();
    for (system, ephemeris) in std::iter::once(leo).chain(&gnss).enumerate() {
        let mask = if system == 0 {
            setup.mask
        } else {
            setup.gnss_mask
        };
        for (satellite, &part) in ephemeris.satellites().iter().zip(ephemeris.parts()) {
            let state = ephemeris.state(satellite, elapsed_s).unwrap();
            let position = rotation.to_earth_fixed(state.position_km);
            let (elevation, azimuth) = site.local.look_angles(position);
            if elevation.to_degrees() >= mask.degrees() {
                let (sin_e, cos_e) = elevation.sin_cos();
                let (sin_a, cos_a) = azimuth.sin_cos();
                found.push(Observed {
                    unit: [cos_e * sin_a, cos_e * cos_a, sin_e],
                    system,
                    part,
                });
            }
        }
    }
    found
}

/// The geometry matrix of observations: position, and a clock for each number that occurs among `clocks`.
pub(crate) fn design_matrix(observed: &[&Observed], clocks: &[usize]) -> DMatrix<f64> {
    let mut known = clocks.to_vec();
    known.sort_unstable();
    known.dedup();
    let mut rows = DMatrix::zeros(observed.len(), 3 + known.len());
    for (n, (one, clock)) in observed.iter().zip(clocks).enumerate() {
        for axis in 0..3 {
            rows[(n, axis)] = one.unit[axis];
        }
        let place = known.iter().position(|other| other == clock).unwrap();
        rows[(n, 3 + place)] = 1.0;
    }
    rows
}

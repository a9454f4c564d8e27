//! A study for tests, and its observations one by one.

use super::{Coverage, Metrics, Setup};
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

/// Metrics for tests that do not depend on them.
pub(crate) fn no_metrics() -> Metrics {
    Metrics {
        mean_visible: 0.0,
        mean_pdop: None,
        cvar_pdop: None,
        cvar_level: 0.95,
        p50_pdop: None,
        p95_pdop: None,
        p99_pdop: None,
        max_pdop: None,
        solved_fraction: 0.0,
        availability: 0.0,
        j_pos: None,
        j_cost: None,
        least_visible: 0,
        coverage: Coverage::default(),
        mean_gnss_visible: 0.0,
        mean_total_visible: 0.0,
        coverage_total: Coverage::default(),
        longest_outage_s: 0.0,
        longest_outage_cut: false,
        p95_hdop: None,
        p95_vdop: None,
        n1: None,
        expected_availability: None,
        information_pdop: None,
        sigma_3d_m: None,
        sigma_h_m: None,
        sigma_v_m: None,
        error95_3d_m: None,
        error95_h_m: None,
        error95_v_m: None,
    }
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

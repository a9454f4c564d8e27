//! A study for the tests of this crate.

use super::{MetricOptions, Setup};
use crate::constellation::gnss::Preset;
use crate::dop::{Clocks, ObservationWeights};
use crate::ground::Site;
use crate::orbit::Model;
use crate::stats::Level;
use crate::time::TimeGrid;
use crate::visibility::Mask;

/// The paper's assumptions over any points and instants, with one mask for all satellites.
pub(crate) fn setup(grid: TimeGrid, sites: Vec<Site>, mask_deg: f64) -> Setup {
    Setup {
        grid,
        sites,
        mask: Mask::from_degrees(mask_deg).unwrap(),
        gnss_mask: Mask::from_degrees(mask_deg).unwrap(),
        gnss: vec![Preset::Beidou3.into()],
        clocks: Clocks::PerSystem,
        skyline: None,
        observation_weights: ObservationWeights::Unit,
        pdop_cap: 100.0,
        model: Model::J2,
        metrics: MetricOptions {
            cvar_weight: 0.5,
            cvar_level: Level::new(0.95).unwrap(),
            availability_pdop: 6.0,
        },
    }
}

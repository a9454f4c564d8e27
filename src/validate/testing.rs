//! Small studies for the tests of this module.

use crate::constellation::gnss::System;
use crate::dop::{Clocks, ObservationWeights};
use crate::earth::Surface;
use crate::evaluate::{Evaluator, MetricOptions, Setup};
use crate::ground::{Grid, PointWeights};
use crate::orbit::Model;
use crate::stats::Level;
use crate::time::TimeGrid;
use crate::visibility::Mask;

/// Twelve points on WGS 84 with BeiDou-3, at 10°.
pub(super) fn setup(grid: TimeGrid) -> Setup {
    let points = Grid {
        latitude_deg: [5.0, 55.0],
        longitude_deg: [80.0, 130.0],
        step_deg: [25.0, 16.0],
        weights: PointWeights::Equal,
    };
    Setup {
        grid,
        sites: points.sites(Surface::Wgs84).unwrap(),
        mask: Mask::from_degrees(10.0).unwrap(),
        gnss_mask: Mask::from_degrees(10.0).unwrap(),
        skyline: None,
        gnss: vec![System::from(crate::constellation::gnss::Preset::Beidou3)],
        clocks: Clocks::PerSystem,
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

pub(super) fn evaluator(grid: TimeGrid) -> Evaluator {
    Evaluator::new(setup(grid)).unwrap()
}

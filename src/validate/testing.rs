//! Small studies for tests.

use crate::earth::Surface;
use crate::evaluate::{Evaluator, Setup, testing};
use crate::ground::{Grid, PointWeights};
use crate::orbit::Model;
use crate::time::TimeGrid;

/// Twelve points on WGS 84 with BeiDou-3, at 10°.
pub(super) fn setup(grid: TimeGrid) -> Setup {
    let points = Grid {
        latitude_deg: [5.0, 55.0],
        longitude_deg: [80.0, 130.0],
        step_deg: [25.0, 16.0],
        weights: PointWeights::Equal,
    };
    testing::setup(grid, points.sites(Surface::Wgs84).unwrap(), 10.0)
}

pub(super) fn evaluator(grid: TimeGrid) -> Evaluator {
    Evaluator::new(setup(grid)).unwrap()
}

/// The same with the design propagated by a model.
pub(super) fn evaluator_of(model: Model, grid: TimeGrid) -> Evaluator {
    Evaluator::new(Setup {
        model,
        ..setup(grid)
    })
    .unwrap()
}

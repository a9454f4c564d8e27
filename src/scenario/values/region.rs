//! The points where the receivers are: a grid or a file.

use super::count;
use crate::ground::Grid;
use crate::scenario::PointWeights;
use crate::scenario::keys::{Section, Walk, key, paths, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Eastward, Interval, Number, OneOf, Steps, Text};

/// Maximum points of a grid: the globe at every quarter of a degree.
const MAX_POINTS: u64 = 1_040_000;

/// The points where the receivers are.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// A grid in latitude and longitude.
    Grid(Grid),
    /// The points of a CSV file.
    Points {
        /// The path as written; relative to the scenario file.
        file: String,
    },
}

section! {
    impl Grid in "region", finish check_grid {
        /// Southern and northern limit of the grid.
        latitude_deg = Interval { of: Number::from_to(-90.0, 90.0), or_single: false }, unit "deg",
            default [3.0, 54.0];
        /// Western and eastern limit of the grid; [160, -155] crosses the date line.
        longitude_deg = Eastward, unit "deg", default [73.0, 136.0];
        /// Step of the grid from its south-western corner.
        step_deg = Steps(Number::above_to(0.0, 360.0)), unit "deg", default [5.0, 5.0];
        /// Weights of the points of the grid in means and quantiles.
        weights = OneOf::new(), default PointWeights::Equal;
    }
}

section! {
    /// The key of a points file instead of a grid.
    pub(in crate::scenario) struct PointsFile in "region" {
        /// CSV file with the columns latitude_deg, longitude_deg and, optionally, weight and name,
        /// instead of the grid; path relative to this file.
        pub points: String = Text::Any, follows "the grid", example "points.csv".to_owned();
    }
}

impl Section for Region {
    const SECTION: &'static str = Grid::SECTION;

    fn walk(walk: &mut impl Walk, values: Option<&Self>) -> Self {
        let (grid, file) = match values {
            None => (None, None),
            Some(Self::Grid(grid)) => (Some(grid), None),
            Some(Self::Points { file }) => (
                None,
                Some(PointsFile {
                    points: file.clone(),
                }),
            ),
        };
        let grid = Grid::walk(walk, grid);
        let file = PointsFile::walk(walk, file.as_ref()).points;
        walk.finish(Self::Grid(grid), |region, reader| {
            if reader.is_given(key!(PointsFile.points)) {
                refuse_grid(reader);
                *region = Self::Points { file };
            }
        })
    }
}

/// Rejects grid keys together with a points file.
fn refuse_grid(reader: &mut Reader<'_>) {
    for rival in paths::<Grid>() {
        if reader.is_given(rival) {
            let other = key!(PointsFile.points).to_string();
            reader.refuse(&[rival], Fault::Excluded { other });
        }
    }
}

fn check_grid(grid: &mut Grid, reader: &mut Reader<'_>) {
    let (latitude, weights) = (key!(Grid.latitude_deg), key!(Grid.weights));
    let keys = [key!(Grid.step_deg), latitude, key!(Grid.longitude_deg)];
    reader.at_most(MAX_POINTS, points(grid), "grid points", &keys);
    if grid.weights == PointWeights::CosLatitude && has_only_poles(grid) {
        reader.refuse(&[latitude, weights], Fault::Weightless);
    }
}

/// Number of points of a grid, before a closing meridian is dropped.
pub(in crate::scenario) fn points(grid: &Grid) -> f64 {
    count(grid.latitude_deg, grid.step_deg[0]) * count(grid.longitude_deg, grid.step_deg[1])
}

/// Whether every latitude of the grid is a pole.
fn has_only_poles(grid: &Grid) -> bool {
    let step = grid.step_deg[0];
    let one_row = count(grid.latitude_deg, step) < 2.0;
    grid.latitude_deg[0].abs() == 90.0 && (one_row || step >= 180.0)
}

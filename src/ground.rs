//! Ground points, of a grid, an area or a list, with their verticals and weights.

mod area;
mod authalic;
mod cells;
mod countries;
mod map;
mod points;
mod raster;
pub(crate) mod shapes;
mod skylines;
mod terrain;
mod weighting;

pub use area::{AreaError, AreaPoints, ServiceArea};
pub use cells::{CellRow, EqualAreaCells};
pub use countries::{Country, UnknownCountry};
pub use map::{RegionMap, Tiling};
pub(crate) use points::line_of;
pub use points::{ignored_columns, sites_from_csv};
pub use raster::{Raster, RasterError};
pub use skylines::with_inline_skylines;
pub use terrain::{Terrain, TerrainError};
pub use weighting::WeightingError;

use crate::earth::Surface;
use crate::frames::{EarthFixed, LocalFrame, Position};
use crate::keyword::keywords;
use crate::units::{counted, wrap_360};
use crate::visibility::{Mask, MaskTable};
use area::FINEST_STEP_DEG;
use cells::FINEST_SPACING_KM;
use nalgebra::Vector3;
use std::sync::Arc;
use thiserror::Error;

/// Why a region is rejected.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum GroundError {
    /// Latitudes outside [-90°, 90°] or in the wrong order.
    #[error("latitudes [{0}, {1}] must run from south to north within -90 to 90 degrees")]
    Latitudes(f64, f64),
    /// Longitudes outside [`LONGITUDES_DEG`] or more than a full turn.
    #[error("longitudes [{0}, {1}] must lie within {range} and span at most 360", range = longitude_range())]
    Longitudes(f64, f64),
    /// A step that is not a positive number of degrees.
    #[error("grid step {0} is not a positive number of degrees")]
    Step(f64),
    /// A step too fine for an area.
    #[error("grid step {0} is finer than {FINEST_STEP_DEG} degrees, the finest in an area")]
    FineStep(f64),
    /// A spacing that is not a number of kilometres, or too fine.
    #[error("spacing {0} is not a number of km of at least {FINEST_SPACING_KM}")]
    Spacing(f64),
    /// Polygons that are not an area.
    #[error(transparent)]
    Area(#[from] AreaError),
    /// An area between the points.
    #[error("no point lies inside the area of {} km²: {}", shown_km2(*.area_km2), finer_spacing(.points, *.suggested))]
    NoPoint {
        /// Which points were looked for.
        points: AreaPoints,
        /// The area, km².
        area_km2: f64,
        /// The largest round spacing that gives points, and how many; `None` if none was found.
        suggested: Option<(f64, usize)>,
    },
    /// More points than [`MAX_POINTS`].
    #[error("{points} grid points exceed the limit of {MAX_POINTS}")]
    TooMany {
        /// Number of points of the grid.
        points: f64,
    },
    /// A point out of range.
    #[error(
        "latitude {latitude_deg}, longitude {longitude_deg} is out of range: latitudes are -90 to 90, longitudes {}",
        longitude_range()
    )]
    Point {
        /// Latitude, degrees.
        latitude_deg: f64,
        /// Longitude, degrees.
        longitude_deg: f64,
    },
    /// A height outside [`HEIGHTS_M`].
    #[error("height {0} m is outside {least} to {most} m", least = HEIGHTS_M[0], most = HEIGHTS_M[1])]
    Height(f64),
    /// A weight that is not a positive number.
    #[error("weight {0} is not a positive number; leave out a point that is not to count")]
    Weight(f64),
    /// A line of a point list that cannot be read.
    #[error("line {line}: {reason}")]
    Line {
        /// Line, from 1.
        line: u64,
        /// What is wrong with it.
        reason: String,
    },
    /// An empty list.
    #[error("the list is empty")]
    Empty,
}

/// An area with three digits or more.
fn shown_km2(area_km2: f64) -> String {
    if area_km2 < 100.0 {
        format!("{area_km2:.3}")
    } else {
        format!("{area_km2:.0}")
    }
}

/// What to do about an area without points.
fn finer_spacing(points: &AreaPoints, suggested: Option<(f64, usize)>) -> String {
    let (key, value, unit) = points.spacing();
    match suggested {
        Some((finer, points)) => format!(
            "{key} is {value} {unit}; {finer} gives {}",
            counted(points, "point")
        ),
        None => format!("{key} is {value} {unit}; give a smaller one, or a list of points"),
    }
}

/// Accepted longitudes of grids and points, degrees: a turn beyond the usual ranges on either side, so
/// that an interval across the antimeridian can be written in ascending order.
pub const LONGITUDES_DEG: [f64; 2] = [-360.0, 720.0];

fn longitude_range() -> String {
    let [lowest, highest] = LONGITUDES_DEG;
    format!("{lowest} to {highest} degrees")
}

fn is_longitude(degrees: f64) -> bool {
    (LONGITUDES_DEG[0]..=LONGITUDES_DEG[1]).contains(&degrees)
}

/// Accepted heights of sites over the surface, m: from the Dead Sea to airliners.
pub const HEIGHTS_M: [f64; 2] = [-500.0, 20_000.0];

/// Maximum number of points of a region: a global grid at 0.1°.
pub const MAX_POINTS: usize = 6_500_000;

keywords! {
    /// How grid points are weighted in means and tails.
    PointWeights {
        /// Equally.
        Equal = "equal",
        /// By the cosine of latitude, that is, by area.
        CosLatitude = "cos-latitude",
    }
}

/// A ground point.
#[derive(Debug, Clone, PartialEq)]
pub struct Site {
    /// Its name, if it has one.
    pub name: Option<Arc<str>>,
    /// Latitude of the surface model (geodetic on WGS 84), degrees.
    pub latitude_deg: f64,
    /// East longitude, degrees, as given (not wrapped).
    pub longitude_deg: f64,
    /// Height over the surface (over the ellipsoid on WGS 84), m.
    pub height_m: f64,
    /// Whether the height is given, and not that of the surface for want of one.
    pub is_height_given: bool,
    /// Weight in means and tails.
    pub weight: f64,
    /// Position and local axes, Earth-fixed.
    pub local: LocalFrame,
    /// A mask by azimuth that every satellite must clear in addition; points with the same one may share it.
    pub skyline: Option<Arc<MaskTable>>,
}

impl Site {
    /// The point of `surface` at a latitude and longitude in degrees.
    ///
    /// # Errors
    /// If the point is out of range or the weight is not positive.
    pub fn new(
        surface: Surface,
        latitude_deg: f64,
        longitude_deg: f64,
        weight: f64,
    ) -> Result<Self, GroundError> {
        if !((-90.0..=90.0).contains(&latitude_deg) && is_longitude(longitude_deg)) {
            return Err(GroundError::Point {
                latitude_deg,
                longitude_deg,
            });
        }
        if !(weight > 0.0 && weight.is_finite()) {
            return Err(GroundError::Weight(weight));
        }
        let within_a_turn_deg = if longitude_deg > 360.0 {
            longitude_deg - 360.0
        } else {
            longitude_deg
        };
        let local = LocalFrame::new(
            surface,
            latitude_deg.to_radians(),
            within_a_turn_deg.to_radians(),
        );
        Ok(Self {
            name: None,
            latitude_deg,
            longitude_deg,
            height_m: 0.0,
            is_height_given: false,
            weight,
            local,
            skyline: None,
        })
    }

    /// The same site at a height over the surface, m, along its vertical ([M-21](crate::models#m-21)).
    ///
    /// # Errors
    /// If the height is outside [`HEIGHTS_M`].
    pub fn at_height_m(mut self, height_m: f64) -> Result<Self, GroundError> {
        if !(HEIGHTS_M[0]..=HEIGHTS_M[1]).contains(&height_m) {
            return Err(GroundError::Height(height_m));
        }
        self.is_height_given = true;
        if height_m != 0.0 {
            self.height_m = height_m;
            self.local.origin_km = self.local.origin_km + self.local.up * (height_m / 1000.0);
        }
        Ok(self)
    }

    /// The unit vector (Earth-fixed axes) to a satellite that clears the mask and the skyline of the point.
    #[must_use]
    pub fn line_of_sight(
        &self,
        mask: Mask,
        target_km: Position<EarthFixed>,
    ) -> Option<Vector3<f64>> {
        let clears = |unit: &Vector3<f64>| {
            let mut skyline = self.skyline.iter();
            skyline.all(|skyline| skyline.clears(&self.local, *unit))
        };
        mask.line_of_sight(&self.local, target_km).filter(clears)
    }
}

/// A latitude-longitude grid, with equal steps from its south-west corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// South and north edge, degrees.
    pub latitude_deg: [f64; 2],
    /// West and east edge, degrees; it runs eastwards, so [160, -155] is [160, 205].
    pub longitude_deg: [f64; 2],
    /// Steps in latitude and longitude, degrees.
    pub step_deg: [f64; 2],
    /// How points are weighted.
    pub weights: PointWeights,
}

impl Grid {
    /// The latitudes of the rows, from the south, degrees.
    ///
    /// # Errors
    /// If the edges or the step are out of range.
    pub fn latitudes_deg(&self) -> Result<Vec<f64>, GroundError> {
        let [south, north] = self.latitude_deg;
        if !(-90.0 <= south && south <= north && north <= 90.0) {
            return Err(GroundError::Latitudes(south, north));
        }
        steps(south, north - south, self.step_deg[0])
    }

    /// The longitudes of the columns, from the west, degrees, increasing.
    ///
    /// # Errors
    /// If the edges or the step are out of range.
    pub fn longitudes_deg(&self) -> Result<Vec<f64>, GroundError> {
        let (west, span) = longitude_span(self.longitude_deg)?;
        let mut values = steps(west, span, self.step_deg[1])?;
        // A full turn would count its first meridian twice.
        if values.len() > 1
            && values
                .last()
                .is_some_and(|last| last - west >= 360.0 - 1e-9)
        {
            values.pop();
        }
        Ok(values)
    }

    /// The grid points, row by row from the south, each row from the west.
    ///
    /// # Errors
    /// If the edges or the steps are out of range, or there are too many points.
    pub fn sites(&self, surface: Surface) -> Result<Vec<Site>, GroundError> {
        let (latitudes, longitudes) = (self.latitudes_deg()?, self.longitudes_deg()?);
        let points = latitudes.len() as f64 * longitudes.len() as f64;
        if points > MAX_POINTS as f64 {
            return Err(GroundError::TooMany { points });
        }
        let mut sites = Vec::with_capacity(points as usize);
        for &latitude in &latitudes {
            let weight = row_weight(self.weights, latitude, self.step_deg[0]);
            for &longitude in &longitudes {
                sites.push(Site::new(surface, latitude, longitude, weight)?);
            }
        }
        Ok(sites)
    }
}

/// The weight of the points of a row, by its latitude and the step between rows, degrees.
fn row_weight(weights: PointWeights, latitude_deg: f64, step_deg: f64) -> f64 {
    match weights {
        PointWeights::Equal => 1.0,
        // The cosine vanishes at a pole, whose points get the weight of the cap within half a step.
        PointWeights::CosLatitude => latitude_deg
            .to_radians()
            .cos()
            .max((step_deg / 4.0).to_radians().sin()),
    }
}

/// Western end and width of an interval of longitude that runs eastwards, degrees.
fn longitude_span([west, east]: [f64; 2]) -> Result<(f64, f64), GroundError> {
    if !(is_longitude(west) && is_longitude(east)) || east - west > 360.0 {
        return Err(GroundError::Longitudes(west, east));
    }
    let span = if east >= west {
        east - west
    } else {
        wrap_360(east - west)
    };
    // An interval whose east edge is written below its west edge may end beyond the range.
    let west = if west + span > LONGITUDES_DEG[1] {
        west - 360.0
    } else {
        west
    };
    Ok((west, span))
}

/// floor(span/step + 1e-9) + 1 values from `start` (the 1e-9 keeps a last value that rounding
/// would drop).
fn steps(start: f64, span: f64, step: f64) -> Result<Vec<f64>, GroundError> {
    if !(step > 0.0 && step.is_finite()) {
        return Err(GroundError::Step(step));
    }
    let count = (span / step + 1e-9).floor() + 1.0;
    if count > MAX_POINTS as f64 {
        return Err(GroundError::TooMany { points: count });
    }
    Ok((0..count as usize)
        .map(|n| start + n as f64 * step)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grid(latitude_deg: [f64; 2], longitude_deg: [f64; 2], step: f64) -> Grid {
        Grid {
            latitude_deg,
            longitude_deg,
            step_deg: [step, step],
            weights: PointWeights::Equal,
        }
    }

    #[test]
    fn the_region_of_the_paper_has_143_points() {
        let sites = grid([3.0, 54.0], [73.0, 136.0], 5.0)
            .sites(Surface::Sphere)
            .unwrap();
        assert_eq!(sites.len(), 143);
        assert_eq!((sites[0].latitude_deg, sites[0].longitude_deg), (3.0, 73.0));
        assert_eq!(
            (sites[142].latitude_deg, sites[142].longitude_deg),
            (53.0, 133.0)
        );
    }

    #[test]
    fn longitudes_run_eastwards() {
        let across = grid([0.0, 0.0], [160.0, -155.0], 15.0)
            .longitudes_deg()
            .unwrap();
        assert_eq!(across, [160.0, 175.0, 190.0, 205.0]);
        let globe = grid([-90.0, 90.0], [-180.0, 180.0], 90.0);
        assert_eq!(globe.longitudes_deg().unwrap(), [-180.0, -90.0, 0.0, 90.0]);
        // A pole is kept once per longitude.
        assert_eq!(globe.sites(Surface::Wgs84).unwrap().len(), 12);
        let far = grid([0.0, 0.0], [350.0, 10.0], 10.0)
            .sites(Surface::Sphere)
            .unwrap();
        assert_eq!(far[2].longitude_deg, 370.0);
    }

    /// One rule for grids and points: what a scenario accepts is accepted here, and a turn more or
    /// less is the same place.
    #[test]
    fn longitudes_reach_from_minus_360_to_720() {
        for (longitude_deg, first) in [
            ([350.0, 370.0], 350.0),
            ([-360.0, -340.0], -360.0),
            ([700.0, 720.0], 700.0),
            ([715.0, 375.0], 355.0),
        ] {
            let sites = grid([0.0, 0.0], longitude_deg, 10.0).sites(Surface::Sphere);
            let sites = sites.unwrap();
            assert_eq!((sites.len(), sites[0].longitude_deg), (3, first));
        }
        let near = Site::new(Surface::Wgs84, 50.0, 10.0, 1.0).unwrap();
        for turns in [-1.0, 1.0] {
            let far = Site::new(Surface::Wgs84, 50.0, 10.0 + 360.0 * turns, 1.0).unwrap();
            let apart = far.local.origin_km.km() - near.local.origin_km.km();
            // The rounding error of 2 pi, times the radius.
            assert!(apart.norm() < 1e-11, "{apart}");
        }
        for longitude_deg in [-360.1, 720.1] {
            assert!(Site::new(Surface::Wgs84, 0.0, longitude_deg, 1.0).is_err());
        }
    }

    #[test]
    fn bad_grids_are_named() {
        let error = |g: Grid| g.sites(Surface::Wgs84).unwrap_err();
        assert_eq!(
            error(grid([54.0, 3.0], [0.0, 1.0], 1.0)),
            GroundError::Latitudes(54.0, 3.0)
        );
        assert_eq!(
            error(grid([0.0, 1.0], [0.0, 361.0], 1.0)),
            GroundError::Longitudes(0.0, 361.0)
        );
        assert_eq!(
            error(grid([0.0, 1.0], [700.0, 721.0], 1.0)),
            GroundError::Longitudes(700.0, 721.0)
        );
        assert_eq!(
            error(grid([0.0, 1.0], [0.0, 1.0], 0.0)),
            GroundError::Step(0.0)
        );
        assert!(matches!(
            error(grid([-90.0, 90.0], [0.0, 360.0], 0.01)),
            GroundError::TooMany { .. }
        ));
        assert!(matches!(
            error(grid([f64::NAN, 1.0], [0.0, 1.0], 1.0)),
            GroundError::Latitudes(..)
        ));
    }
}

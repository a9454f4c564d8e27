//! Terrain: heights on a lattice of latitude and longitude, and the skylines that points have on it.

mod horizon;

use super::{Raster, RasterError, Site};
use crate::earth::Surface;
use crate::units::counted;
use crate::visibility::MaskTable;
use rayon::prelude::*;
use std::sync::Arc;
use thiserror::Error;

/// Accepted heights of terrain, m: from below the Dead Sea to above Mount Everest.
const HEIGHTS_M: [f64; 2] = [-500.0, 9_000.0];

/// Most points whose skylines are computed.
const MAX_POINTS: usize = 10_000;

/// How far an antenna may be below the terrain, m: the rounding of heights in files.
const BURIED_M: f64 = 0.01;

/// Skylines that are nowhere higher, degrees, are rounding.
const ROUNDING_DEG: f64 = 1e-6;

/// Why a terrain is rejected, or a point has no skyline on it.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TerrainError {
    /// The heights are not a raster.
    #[error(transparent)]
    Raster(#[from] RasterError),
    /// A height outside `HEIGHTS_M`.
    #[error(
        "height {height_m} m at latitude {latitude_deg}, longitude {longitude_deg} is outside {least} to {most} m: a value for \
         missing heights must be declared as NODATA, and the sea is at 0",
        least = HEIGHTS_M[0], most = HEIGHTS_M[1]
    )]
    Height {
        /// The height, m.
        height_m: f64,
        /// Its latitude.
        latitude_deg: f64,
        /// Its longitude.
        longitude_deg: f64,
    },
    /// More points than `MAX_POINTS`.
    #[error("the skylines of {0} points are too many; at most {MAX_POINTS} can stand on a terrain")]
    TooManyPoints(usize),
    /// A point that is not on the terrain.
    #[error(
        "{site} is outside the terrain, which reaches from latitude {south_deg:.4} to {north_deg:.4} and longitude {west_deg:.4} \
         to {east_deg:.4}"
    )]
    Outside {
        /// Which point.
        site: String,
        /// Southern end.
        south_deg: f64,
        /// Northern end.
        north_deg: f64,
        /// Western end.
        west_deg: f64,
        /// Eastern end.
        east_deg: f64,
    },
    /// A point below the terrain.
    #[error(
        "{site} is at {height_m} m, {depth_m:.2} m below the terrain of {terrain_m:.2} m there"
    )]
    Buried {
        /// Which point.
        site: String,
        /// Its height, m.
        height_m: f64,
        /// How far below, m.
        depth_m: f64,
        /// The terrain, m.
        terrain_m: f64,
    },
    /// A point too high for its receiver, from terrain and antenna.
    #[error("{site}: {reason}")]
    Site {
        /// Which point.
        site: String,
        /// What is wrong.
        reason: String,
    },
    /// A hole in sight of a point.
    #[error(
        "the terrain has a hole (NODATA) at latitude {latitude_deg:.5}, longitude {longitude_deg:.5}, in sight of {site}; \
         fill it (gdal_fillnodata), or give the sea its height of 0"
    )]
    Hole {
        /// Which point.
        site: String,
        /// Latitude of the hole.
        latitude_deg: f64,
        /// Longitude of the hole.
        longitude_deg: f64,
    },
}

/// Heights over the surface at the nodes of a lattice of latitude and longitude, linear between them in both.
#[derive(Debug, Clone, PartialEq)]
pub struct Terrain {
    /// Heights, m.
    raster: Raster,
    highest_m: f64,
}

impl Terrain {
    /// The terrain of heights in m.
    ///
    /// # Errors
    /// If a height is out of range.
    pub fn new(raster: Raster) -> Result<Self, TerrainError> {
        let range = HEIGHTS_M[0]..=HEIGHTS_M[1];
        let wrong = |height: &f32| !height.is_nan() && !range.contains(&f64::from(*height));
        if let Some(at) = raster.values.iter().position(wrong) {
            let [latitude_deg, longitude_deg] = raster.node_of_value_deg(at);
            return Err(TerrainError::Height {
                height_m: f64::from(raster.values[at]),
                latitude_deg,
                longitude_deg,
            });
        }
        let highest = raster.values.iter().copied().fold(f32::MIN, f32::max);
        Ok(Self {
            highest_m: f64::from(highest),
            raster,
        })
    }

    /// A point in steps from the south-western node, northwards and eastwards, if it is on the terrain. Longitudes a turn
    /// apart are one place.
    fn place(&self, latitude_deg: f64, longitude_deg: f64) -> Option<[f64; 2]> {
        // A point of a lattice may miss the edge by rounding.
        let within = |at: f64, last: usize| {
            let last = last as f64;
            let slack = 1e-9;
            (-slack..=last + slack)
                .contains(&at)
                .then(|| at.clamp(0.0, last))
        };
        let north = (latitude_deg - self.raster.south_west_deg[0]) / self.raster.step_deg[0];
        let east_deg = longitude_deg - self.raster.south_west_deg[1];
        let turns = [east_deg, east_deg.rem_euclid(360.0)];
        let east = turns.into_iter().find_map(|east_deg| {
            within(east_deg / self.raster.step_deg[1], self.raster.columns - 1)
        });
        Some([within(north, self.raster.rows - 1)?, east?])
    }

    /// Whether a place in steps is between the outermost nodes.
    fn contains(&self, [north, east]: [f64; 2]) -> bool {
        let (last_row, last_column) = (
            (self.raster.rows - 1) as f64,
            (self.raster.columns - 1) as f64,
        );
        (0.0..=last_row).contains(&north) && (0.0..=last_column).contains(&east)
    }

    /// The height of a node, m.
    fn node_m(&self, row: usize, column: usize) -> f64 {
        f64::from(self.raster.values[row * self.raster.columns + column])
    }

    /// The height at a place in steps, by bilinear interpolation, m; NaN in a cell with a hole.
    fn height_m(&self, [north, east]: [f64; 2]) -> f64 {
        let row = (north as usize).min(self.raster.rows - 2);
        let column = (east as usize).min(self.raster.columns - 2);
        let (up, right) = (north - row as f64, east - column as f64);
        let along = |row: usize| {
            let (west_m, east_m) = (self.node_m(row, column), self.node_m(row, column + 1));
            west_m + (east_m - west_m) * right
        };
        let (south_m, north_m) = (along(row), along(row + 1));
        south_m + (north_m - south_m) * up
    }

    /// Puts points on the terrain: those without a height at `antenna_m` over it, and those without a skyline of their
    /// own under the one that the terrain gives them ([M-58](crate::models#m-58)). Returns the shortest distance from a
    /// point at which a skyline ended with the terrain, km, if one did.
    ///
    /// # Errors
    /// If a point is outside or below the terrain, or sees a hole.
    pub fn carry(
        &self,
        sites: &mut [Site],
        surface: Surface,
        antenna_m: f64,
    ) -> Result<Option<f64>, TerrainError> {
        let scanned = sites.iter().filter(|site| site.skyline.is_none()).count();
        if scanned > MAX_POINTS {
            return Err(TerrainError::TooManyPoints(scanned));
        }
        let one = |site: &mut Site| self.carry_one(site, surface, antenna_m);
        // The first error in the order of the points, whatever the threads.
        let ends: Vec<_> = sites.par_iter_mut().map(one).collect();
        let mut nearest = None;
        for end in ends {
            if let Some(end_km) = end? {
                nearest = Some(f64::min(end_km, nearest.unwrap_or(f64::INFINITY)));
            }
        }
        Ok(nearest)
    }

    fn carry_one(
        &self,
        site: &mut Site,
        surface: Surface,
        antenna_m: f64,
    ) -> Result<Option<f64>, TerrainError> {
        let place = self.place(site.latitude_deg, site.longitude_deg);
        let [south_deg, north_deg, west_deg, east_deg] = self.raster.edges_deg();
        let place = place.ok_or_else(|| TerrainError::Outside {
            site: label(site),
            south_deg,
            north_deg,
            west_deg,
            east_deg,
        })?;
        let terrain_m = self.height_m(place);
        if terrain_m.is_nan() {
            return Err(TerrainError::Hole {
                site: label(site),
                latitude_deg: site.latitude_deg,
                longitude_deg: site.longitude_deg,
            });
        }
        if !site.is_height_given {
            let raised = site.clone().at_height_m(terrain_m + antenna_m);
            *site = raised.map_err(|error| TerrainError::Site {
                site: label(site),
                reason: error.to_string(),
            })?;
        }
        let depth_m = terrain_m - site.height_m;
        if depth_m > BURIED_M {
            return Err(TerrainError::Buried {
                site: label(site),
                height_m: site.height_m,
                depth_m,
                terrain_m,
            });
        }
        if site.skyline.is_some() {
            return Ok(None);
        }
        let horizon = horizon::Scan::new(self, site, place, surface).horizon();
        let horizon = horizon.map_err(|[north, east]| TerrainError::Hole {
            site: label(site),
            latitude_deg: south_deg + north * self.raster.step_deg[0],
            longitude_deg: west_deg + east * self.raster.step_deg[1],
        })?;
        if horizon.highest_deg() > ROUNDING_DEG {
            let skyline = MaskTable::new(horizon.vertices_deg);
            site.skyline = skyline.ok().map(Arc::new);
        }
        Ok(horizon.end_km)
    }

    /// What it is, in a sentence: `3601 x 3601 heights from -2 to 812 m`.
    #[must_use]
    pub fn told(&self) -> String {
        let holes = self
            .raster
            .values
            .iter()
            .filter(|height| height.is_nan())
            .count();
        let lowest = self.raster.values.iter().copied().fold(f32::MAX, f32::min);
        let mut told = format!(
            "{} x {} heights from {lowest} to {} m",
            self.raster.rows, self.raster.columns, self.highest_m
        );
        if holes > 0 {
            told += &format!(", {}", counted(holes, "hole"));
        }
        told
    }
}

/// A point by its name or its place.
fn label(site: &Site) -> String {
    match &site.name {
        Some(name) => format!("the site {name}"),
        None => format!(
            "the point at latitude {}, longitude {}",
            site.latitude_deg, site.longitude_deg
        ),
    }
}

#[cfg(test)]
mod tests;

//! What a region looks like on a map.

use super::shapes::{LonLat, cell};
use super::{AreaPoints, CellRow, EqualAreaCells, Grid, GroundError, PointWeights, ServiceArea};
use crate::earth::Surface;
use std::sync::Arc;

/// The cells around the points of a region.
#[derive(Debug, Clone, PartialEq)]
pub enum Tiling {
    /// Steps in latitude and longitude, degrees.
    Steps([f64; 2]),
    /// Rows of cells of equal area, from the south.
    Rows(Arc<[CellRow]>),
}

impl Tiling {
    /// South-west and north-east corner of the cell around a point [longitude, latitude], degrees.
    #[must_use]
    pub fn cell(&self, place: [f64; 2]) -> [[f64; 2]; 2] {
        match self {
            Self::Steps(step_deg) => cell(*step_deg, place),
            Self::Rows(rows) => {
                let Some(row) = self.row(place[1]).map(|n| &rows[n]) else {
                    return [place; 2];
                };
                let [south, north] = row.edges_deg;
                let half = 0.5 * row.width_deg;
                [[place[0] - half, south], [place[0] + half, north]]
            }
        }
    }

    /// The row of the points at a latitude, if cells are in rows.
    pub(crate) fn row(&self, latitude_deg: f64) -> Option<usize> {
        match self {
            Self::Steps(_) => None,
            Self::Rows(rows) => {
                let above = rows.partition_point(|row| row.edges_deg[1] < latitude_deg);
                (above < rows.len()).then_some(above)
            }
        }
    }

    /// The largest step between rows or columns, degrees; of rows of equal area, their greatest height.
    #[must_use]
    pub fn step_deg(&self) -> f64 {
        match self {
            Self::Steps([a, b]) => a.max(*b),
            Self::Rows(rows) => rows
                .iter()
                .map(|row| row.edges_deg[1] - row.edges_deg[0])
                .fold(0.0, f64::max),
        }
    }
}

/// What a region looks like on a map: its cells and its borders.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RegionMap {
    /// The cells around the points; none for a list of points.
    pub tiling: Option<Tiling>,
    /// The borders of an area, as closed lines of [longitude, latitude], degrees.
    pub outlines: Arc<[Vec<[f64; 2]>]>,
    /// South-west and north-east corner of the rectangle that the points fill, if it is one: [longitude, latitude], degrees,
    /// as written.
    pub rectangle: Option<[[f64; 2]; 2]>,
    /// What the points are, to follow their number; empty for a list.
    pub told: String,
}

impl RegionMap {
    /// The map of a grid.
    #[must_use]
    pub fn of_grid(grid: &Grid) -> Self {
        let [south, north] = grid.latitude_deg;
        let [west, east] = grid.longitude_deg;
        let [rows_deg, columns_deg] = grid.step_deg;
        Self {
            tiling: Some(Tiling::Steps(grid.step_deg)),
            outlines: Arc::new([]),
            rectangle: Some([[west, south], [east, north]]),
            told: format!(
                "latitudes {south} to {north}° by {rows_deg}°, longitudes {west} to {east}° by {columns_deg}°, \
                 from the south-west corner; point weights {}",
                grid.weights
            ),
        }
    }

    /// The map of cells of equal area over a rectangle.
    ///
    /// # Errors
    /// As for [`EqualAreaCells::rows`].
    pub fn of_cells(cells: &EqualAreaCells, surface: Surface) -> Result<Self, GroundError> {
        let [south, north] = cells.latitude_deg;
        let [west, east] = cells.longitude_deg;
        Ok(Self {
            tiling: Some(Tiling::Rows(cells.rows(surface)?.into())),
            outlines: Arc::new([]),
            rectangle: Some([[west, south], [east, north]]),
            told: format!(
                "latitudes {south} to {north}°, longitudes {west} to {east}°, in the middle of cells of equal area of about \
                 {} km by {} km",
                cells.spacing_km, cells.spacing_km
            ),
        })
    }

    /// The map of the points in an area, which is told as `name`.
    ///
    /// # Errors
    /// As for [`EqualAreaCells::rows`].
    pub fn of_area(
        name: &str,
        area: &ServiceArea,
        points: &AreaPoints,
        surface: Surface,
    ) -> Result<Self, GroundError> {
        let (tiling, spacing) = match *points {
            AreaPoints::Lattice { step_deg, weights } => {
                let weights = match weights {
                    PointWeights::Equal => String::new(),
                    other => format!("; point weights {other}"),
                };
                let [rows, columns] = step_deg;
                let told = format!(
                    "at multiples of {rows}° of latitude and {columns}° of longitude{weights}"
                );
                (Tiling::Steps(step_deg), told)
            }
            AreaPoints::Cells { spacing_km } => {
                let rows = EqualAreaCells::globe(spacing_km).rows(surface)?;
                let told = format!(
                    "in the middle of cells of equal area of about {spacing_km} km by {spacing_km} km"
                );
                (Tiling::Rows(rows.into()), told)
            }
        };
        Ok(Self {
            tiling: Some(tiling),
            outlines: area.outlines().into(),
            rectangle: None,
            told: format!("inside {name}, {spacing}"),
        })
    }

    /// The cell around a point: south-west and north-east corner; none for a list of points.
    #[must_use]
    pub fn cell(&self, place: LonLat) -> Option<[LonLat; 2]> {
        Some(self.tiling.as_ref()?.cell(place))
    }

    /// The steps of the points in latitude and longitude, degrees, if they are the same everywhere.
    #[must_use]
    pub fn step_deg(&self) -> Option<[f64; 2]> {
        match self.tiling {
            Some(Tiling::Steps(step_deg)) => Some(step_deg),
            _ => None,
        }
    }

    /// Degrees around the points that a map shows: half a cell, or a whole one where there are borders.
    #[must_use]
    pub fn margin_deg(&self) -> f64 {
        let of_list = 3.0;
        let cells = if self.outlines.is_empty() { 0.5 } else { 1.0 };
        let of_tiling = |tiling: &Tiling| cells * tiling.step_deg();
        self.tiling.as_ref().map_or(of_list, of_tiling)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_of_equal_cells_is_in_the_middle_of_its_own() {
        let cells = EqualAreaCells {
            latitude_deg: [-90.0, 60.0],
            longitude_deg: [160.0, -155.0],
            spacing_km: 400.0,
        };
        let map = RegionMap::of_cells(&cells, Surface::Wgs84).unwrap();
        let rows = cells.rows(Surface::Wgs84).unwrap();
        for row in &rows {
            let mut west = 160.0;
            for longitude in row.longitudes_deg() {
                let [low, high] = map.cell([longitude, row.latitude_deg]).unwrap();
                assert_eq!([low[1], high[1]], row.edges_deg);
                assert!((low[0] - west).abs() < 1e-9, "{low:?} {west}");
                west = high[0];
            }
            assert!((west - 205.0).abs() < 1e-9);
        }
        assert_eq!(map.step_deg(), None);
    }
}

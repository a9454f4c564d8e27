//! Values on a lattice of latitude and longitude.

use thiserror::Error;

/// Most cells of a raster.
const MAX_CELLS: usize = 200_000_000;

/// Why values are not a raster.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum RasterError {
    /// Fewer than two rows or columns, or more than `MAX_CELLS` in all.
    #[error(
        "{rows} rows and {columns} columns: expected at least 2 of each and at most {MAX_CELLS} cells"
    )]
    Shape {
        /// Rows.
        rows: usize,
        /// Columns.
        columns: usize,
    },
    /// Coordinates that are not degrees.
    #[error(
        "latitudes {south_deg} to {north_deg} and longitudes {west_deg} to {east_deg} are not degrees on the globe; \
         expected latitude and longitude of WGS 84 (EPSG:4326; gdalwarp -t_srs EPSG:4326 converts others)"
    )]
    Degrees {
        /// Southern end.
        south_deg: f64,
        /// Northern end.
        north_deg: f64,
        /// Western end.
        west_deg: f64,
        /// Eastern end.
        east_deg: f64,
    },
}

/// Values at the nodes of a lattice, which are the middles of its cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Raster {
    /// Latitude of the first row and longitude of the first column, degrees.
    pub(super) south_west_deg: [f64; 2],
    /// Steps northwards and eastwards, degrees.
    pub(super) step_deg: [f64; 2],
    pub(super) rows: usize,
    pub(super) columns: usize,
    /// Row by row from the south, each from the west; NaN in a hole.
    pub(super) values: Vec<f32>,
}

impl Raster {
    /// The raster with a south-western node, steps northwards and eastwards (degrees) and values row by row from the south,
    /// each from the west; NaN is a hole.
    ///
    /// # Errors
    /// If there are too few or too many cells, or the nodes leave the globe.
    pub fn new(
        south_west_deg: [f64; 2],
        step_deg: [f64; 2],
        columns: usize,
        values: Vec<f32>,
    ) -> Result<Self, RasterError> {
        let rows = values.len() / columns.max(1);
        if rows < 2 || columns < 2 || values.len() > MAX_CELLS {
            return Err(RasterError::Shape { rows, columns });
        }
        let raster = Self {
            south_west_deg,
            step_deg,
            rows,
            columns,
            values,
        };
        let [south_deg, north_deg, west_deg, east_deg] = raster.edges_deg();
        let is_sound = step_deg.iter().all(|step| *step > 0.0)
            && south_deg >= -90.0
            && north_deg <= 90.0 + 1e-9
            && super::is_longitude(west_deg)
            && super::is_longitude(east_deg)
            && east_deg - west_deg <= 360.0 + 1e-9;
        match is_sound {
            true => Ok(raster),
            false => Err(RasterError::Degrees {
                south_deg,
                north_deg,
                west_deg,
                east_deg,
            }),
        }
    }

    /// Latitude of the southern and northern nodes, longitude of the western and eastern ones, degrees.
    pub(super) fn edges_deg(&self) -> [f64; 4] {
        let [south, west] = self.south_west_deg;
        let [north, east] = self.node_deg(self.rows - 1, self.columns - 1);
        [south, north, west, east]
    }

    /// Latitude and longitude of a node, degrees.
    pub(super) fn node_deg(&self, row: usize, column: usize) -> [f64; 2] {
        [
            self.south_west_deg[0] + row as f64 * self.step_deg[0],
            self.south_west_deg[1] + column as f64 * self.step_deg[1],
        ]
    }

    /// Latitude and longitude of the node of a value, degrees.
    pub(super) fn node_of_value_deg(&self, at: usize) -> [f64; 2] {
        self.node_deg(at / self.columns, at % self.columns)
    }
}

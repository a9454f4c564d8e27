//! Weights of the points of a region from a raster of counts, such as people.

use super::shapes::LonLat;
use super::{Raster, RegionMap, Site};
use thiserror::Error;

/// Why a raster does not weight a region.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum WeightingError {
    /// A value below 0.
    #[error(
        "value {value} at latitude {latitude_deg}, longitude {longitude_deg} is below 0: what is not known must be declared as \
         NODATA"
    )]
    Negative {
        /// The value.
        value: f32,
        /// Its latitude.
        latitude_deg: f64,
        /// Its longitude.
        longitude_deg: f64,
    },
    /// Points without cells around them.
    #[error("a list of points has no cells to count in; give its column weight instead")]
    NoCells,
    /// Nothing in any cell.
    #[error(
        "no cell of the region has a value above 0; the raster reaches from latitude {south_deg:.4} to {north_deg:.4} and longitude {west_deg:.4} to {east_deg:.4}"
    )]
    Nothing {
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

/// The cells around the points of a row, which have the same latitudes.
struct CellsOfRow {
    /// Southern and northern edge, degrees.
    edges_deg: [f64; 2],
    /// Western and eastern edge, degrees, the western from 0 to below 360, and the point, from the west.
    cells: Vec<([f64; 2], usize)>,
}

impl Raster {
    /// Gives each point what the raster counts in the cell around it, of each cell of the raster the share of the area that
    /// lies in it ([M-28](crate::models#m-28)). Points without any are dropped; their number.
    ///
    /// # Errors
    /// If a value is negative, or no point is left.
    pub fn weigh(&self, sites: &mut Vec<Site>, map: &RegionMap) -> Result<usize, WeightingError> {
        if let Some(at) = self.values.iter().position(|value| *value < 0.0) {
            let [latitude_deg, longitude_deg] = self.node_of_value_deg(at);
            return Err(WeightingError::Negative {
                value: self.values[at],
                latitude_deg,
                longitude_deg,
            });
        }
        let rows = rows(sites, map)?;
        let mut weights = vec![0.0; sites.len()];
        for (at, &value) in self.values.iter().enumerate() {
            if value > 0.0 && value.is_finite() {
                self.spread(at, f64::from(value), &rows, &mut weights);
            }
        }
        let before = sites.len();
        let mut each = weights.into_iter();
        sites.retain_mut(|site| {
            site.weight = each.next().unwrap_or_default();
            site.weight > 0.0
        });
        if sites.is_empty() {
            let [south_deg, north_deg, west_deg, east_deg] = self.edges_deg();
            return Err(WeightingError::Nothing {
                south_deg,
                north_deg,
                west_deg,
                east_deg,
            });
        }
        Ok(before - sites.len())
    }

    /// Adds a value to the points in whose cells parts of its own cell lie.
    fn spread(&self, at: usize, value: f64, rows: &[CellsOfRow], weights: &mut [f64]) {
        let [latitude, longitude] = self.node_of_value_deg(at);
        let [half_height, half_width] = self.step_deg.map(|step| 0.5 * step);
        let own = [
            (latitude - half_height).max(-90.0),
            (latitude + half_height).min(90.0),
        ];
        let west = (longitude - half_width).rem_euclid(360.0);
        // Cells from 0° on may reach beyond 360°, and so may its own.
        let turns = [west - 360.0, west, west + 360.0].map(|west| [west, west + 2.0 * half_width]);
        let whole = band(own) * 2.0 * half_width;
        let first = rows.partition_point(|row| row.edges_deg[1] <= own[0]);
        for row in &rows[first..] {
            if row.edges_deg[0] >= own[1] {
                break;
            }
            let height = band(common(row.edges_deg, own));
            for turn in turns {
                let from = row.cells.partition_point(|(cell, _)| cell[1] <= turn[0]);
                let cells = row.cells[from..].iter();
                for (cell, point) in cells.take_while(|(cell, _)| cell[0] < turn[1]) {
                    let [west, east] = common(*cell, turn);
                    weights[*point] += value * height * (east - west) / whole;
                }
            }
        }
    }
}

/// What two intervals have in common, if anything.
fn common(one: [f64; 2], other: [f64; 2]) -> [f64; 2] {
    [one[0].max(other[0]), one[1].min(other[1])]
}

/// Area of a band of latitudes, of a sphere of radius 1 and a radian of longitude.
fn band([south_deg, north_deg]: [f64; 2]) -> f64 {
    north_deg.to_radians().sin() - south_deg.to_radians().sin()
}

/// The cells of a region by row, from the south.
fn rows(sites: &[Site], map: &RegionMap) -> Result<Vec<CellsOfRow>, WeightingError> {
    let mut cells: Vec<([LonLat; 2], usize)> = Vec::with_capacity(sites.len());
    for (point, site) in sites.iter().enumerate() {
        let place = [site.longitude_deg, site.latitude_deg];
        let corners = map.cell(place).ok_or(WeightingError::NoCells)?;
        cells.push((corners, point));
    }
    cells.sort_by(|(a, _), (b, _)| a[0][1].total_cmp(&b[0][1]));
    // Edges of one row are the same to the rounding of its latitude.
    let is_one_row = |a: &([LonLat; 2], usize), b: &([LonLat; 2], usize)| {
        b.0[0][1] - a.0[0][1] < 0.5 * (a.0[1][1] - a.0[0][1])
    };
    let row = |cells: &[([LonLat; 2], usize)]| {
        let [[_, south], [_, north]] = cells[0].0;
        let edges = |([[west, _], [east, _]], point): &([LonLat; 2], usize)| {
            let from = west.rem_euclid(360.0);
            ([from, from + (east - west)], *point)
        };
        let mut cells: Vec<([f64; 2], usize)> = cells.iter().map(edges).collect();
        cells.sort_by(|(a, _), (b, _)| a[0].total_cmp(&b[0]));
        CellsOfRow {
            edges_deg: [south, north],
            cells,
        }
    };
    Ok(cells.chunk_by(is_one_row).map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;
    use crate::ground::{EqualAreaCells, Grid, PointWeights};

    fn grid(
        latitude_deg: [f64; 2],
        longitude_deg: [f64; 2],
        step_deg: f64,
    ) -> (Vec<Site>, RegionMap) {
        let grid = Grid {
            latitude_deg,
            longitude_deg,
            step_deg: [step_deg; 2],
            weights: PointWeights::Equal,
        };
        (
            grid.sites(Surface::Sphere).unwrap(),
            RegionMap::of_grid(&grid),
        )
    }

    /// A raster of the globe in cells of `step` degrees, with a value for each latitude and longitude.
    fn globe(step: f64, value: impl Fn(f64, f64) -> f32) -> Raster {
        let (rows, columns) = ((180.0 / step) as usize, (360.0 / step) as usize);
        let first = [-90.0 + step / 2.0, -180.0 + step / 2.0];
        let nodes = (0..rows * columns).map(|at| {
            let (row, column) = (at / columns, at % columns);
            value(
                first[0] + row as f64 * step,
                first[1] + column as f64 * step,
            )
        });
        Raster::new(first, [step; 2], columns, nodes.collect()).unwrap()
    }

    fn weights(sites: &[Site]) -> Vec<f64> {
        sites.iter().map(|site| site.weight).collect()
    }

    /// What is counted is conserved, on cells coarser and finer than the raster, across the antimeridian and at the poles.
    #[test]
    fn nothing_is_lost_or_counted_twice() {
        let people = |latitude: f64, longitude: f64| (latitude + 2.0 * longitude + 500.0) as f32;
        let raster = globe(1.5, people);
        let total: f64 = raster.values.iter().copied().map(f64::from).sum();
        for step in [10.0, 7.5, 1.5, 1.0] {
            let (mut sites, map) = grid([-90.0, 90.0], [-180.0, 180.0], step);
            raster.weigh(&mut sites, &map).unwrap();
            let sum: f64 = weights(&sites).iter().sum();
            // As many roundings as there are shares.
            assert!((sum / total - 1.0).abs() < 1e-11, "{step}: {}", sum / total);
        }
        let cells = EqualAreaCells::globe(700.0);
        let mut sites = cells.sites(Surface::Sphere).unwrap();
        let map = RegionMap::of_cells(&cells, Surface::Sphere).unwrap();
        raster.weigh(&mut sites, &map).unwrap();
        let sum: f64 = weights(&sites).iter().sum();
        assert!((sum / total - 1.0).abs() < 1e-11, "{}", sum / total);
    }

    /// 1000 in a cell that four cells share: by area, where sin 10° is in the middle of the southern and northern halves.
    #[test]
    fn validate_shares_of_a_cell() {
        let mut values = vec![f32::NAN; 4];
        values[0] = 1000.0;
        let raster = Raster::new([10.0, 179.0], [4.0, 4.0], 2, values).unwrap();
        let (mut sites, map) = grid([5.0, 15.0], [175.0, 185.0], 10.0);
        assert_eq!(raster.weigh(&mut sites, &map).unwrap(), 0);
        let sin = |degrees: f64| degrees.to_radians().sin();
        let south = (sin(10.0) - sin(8.0)) / (sin(12.0) - sin(8.0));
        // From 177° to 180° and on to 181°.
        let expected = [
            1000.0 * south * 0.75,
            1000.0 * south * 0.25,
            1000.0 * (1.0 - south) * 0.75,
            1000.0 * (1.0 - south) * 0.25,
        ];
        for (found, expected) in weights(&sites).iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }

    #[test]
    fn points_without_a_count_are_dropped() {
        let raster = globe(1.0, |latitude, _| if latitude > 0.0 { 1.0 } else { 0.0 });
        let (mut sites, map) = grid([-20.0, 20.0], [0.0, 20.0], 10.0);
        assert_eq!(raster.weigh(&mut sites, &map), Ok(6));
        let latitudes: Vec<f64> = sites.iter().map(|site| site.latitude_deg).collect();
        assert_eq!(
            latitudes,
            [0.0, 0.0, 0.0, 10.0, 10.0, 10.0, 20.0, 20.0, 20.0]
        );
        // Half of the cells around the equator.
        let weights = weights(&sites);
        assert!((weights[0] - 50.0).abs() < 1e-9 && (weights[3] - 100.0).abs() < 1e-9);
        let refused = |raster: &Raster, sites: &mut Vec<Site>, map: &RegionMap| {
            raster.weigh(sites, map).unwrap_err().to_string()
        };
        let (mut south, map) = grid([-40.0, -20.0], [0.0, 20.0], 10.0);
        let nothing = refused(&raster, &mut south, &map);
        assert!(
            nothing.starts_with("no cell of the region has a value above 0"),
            "{nothing}"
        );
        let debt = globe(10.0, |latitude, _| latitude as f32);
        let negative = refused(&debt, &mut sites, &map);
        assert!(
            negative.starts_with("value -85 at latitude -85, longitude -175 is below 0"),
            "{negative}"
        );
        let listed = refused(&raster, &mut sites, &RegionMap::default());
        assert!(
            listed.starts_with("a list of points has no cells"),
            "{listed}"
        );
    }
}

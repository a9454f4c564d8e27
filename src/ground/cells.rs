//! Cells of equal area: a grid whose points all stand for the same area.

use super::authalic::Authalic;
use super::{GroundError, MAX_POINTS, Site, longitude_span};
use crate::earth::Surface;

/// Finest spacing, km, with 200 000 rows from pole to pole.
pub(super) const FINEST_SPACING_KM: f64 = 0.1;

/// Cells of equal area in rows along parallels, over a rectangle of latitude and longitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EqualAreaCells {
    /// South and north edge, degrees.
    pub latitude_deg: [f64; 2],
    /// West and east edge, degrees; it runs eastwards, so [160, -155] is [160, 205].
    pub longitude_deg: [f64; 2],
    /// Side of a square of about the area of a cell, km.
    pub spacing_km: f64,
}

/// A row of cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CellRow {
    /// Latitude of the points, which halves the area of the row, degrees.
    pub latitude_deg: f64,
    /// South and north edge, degrees.
    pub edges_deg: [f64; 2],
    /// Western edge of the first cell, degrees.
    pub west_deg: f64,
    /// Width of a cell, degrees.
    pub width_deg: f64,
    /// Number of cells.
    pub cells: usize,
}

impl CellRow {
    /// The longitude of the k-th point from the west, in the middle of its cell, degrees.
    #[must_use]
    pub fn longitude_deg(&self, k: usize) -> f64 {
        self.west_deg + (k as f64 + 0.5) * self.width_deg
    }

    /// The longitudes of the points from the west, degrees.
    pub fn longitudes_deg(self) -> impl Iterator<Item = f64> {
        (0..self.cells).map(move |k| self.longitude_deg(k))
    }
}

impl EqualAreaCells {
    /// The cells of the globe, from 180° W.
    #[must_use]
    pub fn globe(spacing_km: f64) -> Self {
        Self {
            latitude_deg: [-90.0, 90.0],
            longitude_deg: [-180.0, 180.0],
            spacing_km,
        }
    }

    /// The rows from the south ([M-55](crate::models#m-55)).
    ///
    /// # Errors
    /// If the edges or the spacing are out of range, or the rectangle has no area.
    pub fn rows(&self, surface: Surface) -> Result<Vec<CellRow>, GroundError> {
        let [south, north] = self.latitude_deg;
        if !(-90.0 <= south && south < north && north <= 90.0) {
            return Err(GroundError::Latitudes(south, north));
        }
        let (west_deg, span_deg) = longitude_span(self.longitude_deg)?;
        if span_deg == 0.0 {
            let [west, east] = self.longitude_deg;
            return Err(GroundError::Longitudes(west, east));
        }
        if !(self.spacing_km >= FINEST_SPACING_KM && self.spacing_km.is_finite()) {
            return Err(GroundError::Spacing(self.spacing_km));
        }
        let authalic = Authalic::new(surface);
        let [low, high] = [south, north].map(|edge| authalic.sine(edge.to_radians()));
        let per_row = self.cells_per_row(authalic, [low.asin(), high.asin()], span_deg);
        let all: usize = per_row.iter().sum();
        let mut before = 0;
        let row = |cells: usize| {
            let sine = |cells: f64| low + (high - low) * cells / all as f64;
            let at = |sine: f64| authalic.latitude_deg(sine);
            let (from, to) = (before as f64, (before + cells) as f64);
            before += cells;
            CellRow {
                latitude_deg: at(sine(0.5 * (from + to))),
                edges_deg: [at(sine(from)), at(sine(to))],
                west_deg,
                width_deg: span_deg / cells as f64,
                cells,
            }
        };
        Ok(per_row.into_iter().map(row).collect())
    }

    /// The number of cells of each row: rows of equal authalic latitude, cells as wide as the spacing in their middle.
    fn cells_per_row(
        &self,
        authalic: Authalic,
        [low, high]: [f64; 2],
        span_deg: f64,
    ) -> Vec<usize> {
        let spacing = self.spacing_km / authalic.radius2_km2().sqrt();
        let span = span_deg.to_radians();
        let rows = ((high - low) / spacing).round().max(1.0);
        let middle = |k: usize| low + (high - low) * (k as f64 + 0.5) / rows;
        let cells = |k: usize| (span * middle(k).cos() / spacing).round().max(1.0) as usize;
        (0..rows as usize).map(cells).collect()
    }

    /// The points in the middle of the cells, row by row from the south, each row from the west; all have weight 1.
    ///
    /// # Errors
    /// As for [`EqualAreaCells::rows`], or if there are too many.
    pub fn sites(&self, surface: Surface) -> Result<Vec<Site>, GroundError> {
        let rows = self.rows(surface)?;
        let points: usize = rows.iter().map(|row| row.cells).sum();
        if points > MAX_POINTS {
            let points = points as f64;
            return Err(GroundError::TooMany { points });
        }
        let row = |row: CellRow| {
            row.longitudes_deg()
                .map(move |longitude| Site::new(surface, row.latitude_deg, longitude, 1.0))
        };
        rows.into_iter().flat_map(row).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::RADIUS_KM;
    use std::f64::consts::PI;

    fn areas(cells: EqualAreaCells, surface: Surface) -> Vec<f64> {
        let authalic = Authalic::new(surface);
        let of = |row: &CellRow| {
            let [a, b] = row.edges_deg.map(|edge| authalic.sine(edge.to_radians()));
            authalic.radius2_km2() * (b - a) * row.width_deg.to_radians()
        };
        cells.rows(surface).unwrap().iter().map(of).collect()
    }

    /// Rounding of latitudes is 1e-14 degrees, of which a row of 50 km has 0.5; at the poles the arc sine loses
    /// half of the digits.
    #[test]
    fn every_cell_has_the_same_area_and_they_cover_the_rectangle() {
        for surface in [Surface::Wgs84, Surface::Sphere] {
            for cells in [
                EqualAreaCells::globe(250.0),
                EqualAreaCells {
                    latitude_deg: [3.0, 54.0],
                    longitude_deg: [160.0, -155.0],
                    spacing_km: 50.0,
                },
            ] {
                let areas = areas(cells, surface);
                let first = areas[1];
                assert!(areas.iter().all(|area| (area / first - 1.0).abs() < 1e-9));
                assert!(
                    (first.sqrt() / cells.spacing_km - 1.0).abs() < 0.01,
                    "{first}"
                );
            }
            let globe = EqualAreaCells::globe(500.0).rows(surface).unwrap();
            assert_eq!(
                (globe[0].edges_deg[0], globe[globe.len() - 1].edges_deg[1]),
                (-90.0, 90.0)
            );
            assert!(
                globe
                    .windows(2)
                    .all(|pair| pair[0].edges_deg[1] == pair[1].edges_deg[0])
            );
        }
        let globe = EqualAreaCells::globe(100.0).sites(Surface::Sphere).unwrap();
        let expected = 4.0 * PI * RADIUS_KM * RADIUS_KM / 1e4;
        // Rounding the number of rows to 200 is half a row.
        assert!(
            (globe.len() as f64 / expected - 1.0).abs() < 0.5 / 200.0,
            "{}",
            globe.len()
        );
        assert!(globe.iter().all(|site| site.weight == 1.0));
    }

    #[test]
    fn one_cell_is_the_whole_rectangle() {
        let one = EqualAreaCells {
            latitude_deg: [-10.0, 10.0],
            longitude_deg: [20.0, 30.0],
            spacing_km: 20_000.0,
        };
        let rows = one.rows(Surface::Wgs84).unwrap();
        assert_eq!((rows.len(), rows[0].cells), (1, 1));
        let sites = one.sites(Surface::Wgs84).unwrap();
        assert_eq!((sites[0].latitude_deg, sites[0].longitude_deg), (0.0, 25.0));
    }

    #[test]
    fn bad_cells_are_named() {
        let cells = |latitude_deg, longitude_deg, spacing_km| {
            EqualAreaCells {
                latitude_deg,
                longitude_deg,
                spacing_km,
            }
            .sites(Surface::Wgs84)
            .unwrap_err()
        };
        let (a, b) = ([0.0, 10.0], [0.0, 10.0]);
        assert_eq!(
            cells([5.0, 5.0], b, 100.0),
            GroundError::Latitudes(5.0, 5.0)
        );
        assert_eq!(
            cells(a, [5.0, 5.0], 100.0),
            GroundError::Longitudes(5.0, 5.0)
        );
        assert_eq!(cells(a, b, 0.0), GroundError::Spacing(0.0));
        assert_eq!(cells(a, b, 0.09), GroundError::Spacing(0.09));
        assert!(cells(a, b, f64::NAN).to_string().contains("NaN"));
        let many = cells([-90.0, 90.0], [0.0, 360.0], 1.0);
        assert!(matches!(many, GroundError::TooMany { .. }), "{many}");
    }
}

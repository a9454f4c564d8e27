//! From latitude and longitude to the plane of a map.

use crate::report::coastline::Bounds;
use crate::report::figures::Projection;

/// Longest part of an edge that is drawn straight where meridians are curved, degrees.
const STRAIGHT_DEG: f64 = 2.5;

/// Coefficients of Equal Earth: Šavrič, Patterson and Jenny (2018), equation 3.
const A: [f64; 4] = [1.340_264, -0.081_106, 0.000_893, 0.003_796];

/// A part of the Earth on a plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Plane {
    projection: Projection,
    bounds: Bounds,
    x: [f64; 2],
    y: [f64; 2],
}

impl Plane {
    pub(super) fn new(projection: Projection, bounds: Bounds) -> Self {
        let mut plane = Self {
            projection,
            bounds,
            x: [f64::INFINITY, f64::NEG_INFINITY],
            y: [f64::INFINITY, f64::NEG_INFINITY],
        };
        for point in plane.border() {
            let (x, y) = plane.projected(point);
            plane.x = [plane.x[0].min(x), plane.x[1].max(x)];
            plane.y = [plane.y[0].min(y), plane.y[1].max(y)];
        }
        plane
    }

    /// The border of the map, closed: longitude and latitude, degrees.
    pub(super) fn border(&self) -> Vec<[f64; 2]> {
        self.ring(self.bounds.longitude_deg, self.bounds.latitude_deg)
    }

    /// The ring around a cell.
    pub(super) fn ring(&self, [west, east]: [f64; 2], [south, north]: [f64; 2]) -> Vec<[f64; 2]> {
        let corners = [
            [west, south],
            [east, south],
            [east, north],
            [west, north],
            [west, south],
        ];
        let edges = corners
            .windows(2)
            .flat_map(|ends| self.edge(ends[0], ends[1]));
        edges.chain([corners[0]]).collect()
    }

    /// Points along a straight edge, from its start to before its end.
    pub(super) fn edge(&self, from: [f64; 2], to: [f64; 2]) -> Vec<[f64; 2]> {
        let rise = (to[1] - from[1]).abs();
        let parts = match self.projection {
            Projection::PlateCarree => 1,
            Projection::EqualEarth => (rise / STRAIGHT_DEG).ceil().clamp(1.0, 200.0) as u32,
        };
        let along = (0..parts).map(|n| f64::from(n) / f64::from(parts));
        let at = |share: f64| [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        along.map(at).collect()
    }

    /// Height by width.
    pub(super) fn aspect(&self) -> f64 {
        (self.y[1] - self.y[0]) / (self.x[1] - self.x[0])
    }

    /// The place of a longitude and latitude as shares of the width and height.
    pub(super) fn share(&self, place: [f64; 2]) -> (f64, f64) {
        let (x, y) = self.projected(place);
        let share = |at: f64, [low, high]: [f64; 2]| (at - low) / (high - low);
        (share(x, self.x), share(y, self.y))
    }

    fn projected(&self, [longitude_deg, latitude_deg]: [f64; 2]) -> (f64, f64) {
        let [[south, north], [west, east]] = [self.bounds.latitude_deg, self.bounds.longitude_deg];
        match self.projection {
            Projection::PlateCarree => {
                // Degrees of both have the same scale at the middle latitude.
                let scale = (0.5 * (south + north)).to_radians().cos().max(0.1);
                (longitude_deg * scale, latitude_deg)
            }
            Projection::EqualEarth => {
                let from_middle = (longitude_deg - 0.5 * (west + east)).to_radians();
                equal_earth(from_middle, latitude_deg.to_radians())
            }
        }
    }
}

fn equal_earth(longitude_rad: f64, latitude_rad: f64) -> (f64, f64) {
    let half_root = 0.5 * 3_f64.sqrt();
    let theta = (half_root * latitude_rad.sin()).asin();
    let squared = theta * theta;
    let sixth = squared * squared * squared;
    let slope = A[0] + 3.0 * A[1] * squared + sixth * (7.0 * A[2] + 9.0 * A[3] * squared);
    let x = longitude_rad * theta.cos() / (half_root * slope);
    let y = theta * (A[0] + A[1] * squared + sixth * (A[2] + A[3] * squared));
    (x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The half axes of the projection, as published and in PROJ: the equator has a half length of 2.706630, the
    /// meridian of 1.317363; and areas are in proportion: a cell of the equator and one of 60° have the areas of the sphere.
    #[test]
    fn validate_equal_earth_has_its_published_size_and_equal_areas() {
        let (x, _) = equal_earth(std::f64::consts::PI, 0.0);
        let (_, y) = equal_earth(0.0, std::f64::consts::FRAC_PI_2);
        assert!((x - 2.706_630).abs() < 1e-6, "{x}");
        assert!((y - 1.317_363).abs() < 1e-6, "{y}");
        // Width is linear in longitude, so that a thin strip has the area width * height; 1e-6 is its thinness squared.
        let share = |latitude: f64| {
            let half = 1e-3;
            let width = equal_earth(1.0, latitude).0;
            let height = equal_earth(0.0, latitude + half).1 - equal_earth(0.0, latitude - half).1;
            width * height / (2.0 * half * latitude.cos())
        };
        for latitude_deg in [0.0_f64, 30.0, 60.0, 85.0] {
            let found = share(latitude_deg.to_radians());
            assert!((found - 1.0).abs() < 1e-5, "{latitude_deg}: {found}");
        }
    }
}

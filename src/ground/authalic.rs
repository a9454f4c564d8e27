//! Areas on the surface, by the authalic latitude: that of the sphere of equal area.

use crate::earth::{RADIUS_KM, Surface};

/// Steps of Newton's method from a sine to its latitude; the third is below rounding on WGS 84.
const STEPS: usize = 4;

/// The map from a surface to the sphere of equal area ([M-53](crate::models#m-53)).
#[derive(Debug, Clone, Copy)]
pub(super) struct Authalic {
    /// Square of the eccentricity.
    e2: f64,
    /// q at the pole.
    pole: f64,
}

impl Authalic {
    pub(super) fn new(surface: Surface) -> Self {
        let f = surface.flattening();
        let e2 = f * (2.0 - f);
        Self {
            e2,
            pole: q(e2, 1.0),
        }
    }

    /// The sine of the authalic latitude at a latitude, radians.
    pub(super) fn sine(self, latitude_rad: f64) -> f64 {
        q(self.e2, latitude_rad.sin()) / self.pole
    }

    /// The latitude of the surface at the sine of an authalic latitude, degrees.
    pub(super) fn latitude_deg(self, sine: f64) -> f64 {
        let wanted = sine * self.pole;
        let mut x = sine;
        for _ in 0..STEPS {
            let flat = 1.0 - self.e2 * x * x;
            x += (wanted - q(self.e2, x)) * flat * flat / (2.0 * (1.0 - self.e2));
        }
        x.clamp(-1.0, 1.0).asin().to_degrees()
    }

    /// Square of the radius of the sphere of equal area, km²: the area of the surface between two
    /// latitudes is this, times the difference of their sines, times the difference of longitudes.
    pub(super) fn radius2_km2(self) -> f64 {
        0.5 * RADIUS_KM * RADIUS_KM * self.pole
    }
}

/// Snyder's q at the sine of a latitude, for the square of an eccentricity; to the bit the same on both hemispheres.
fn q(e2: f64, sine: f64) -> f64 {
    let e = e2.sqrt();
    let size = sine.abs();
    let slope = if e > 0.0 {
        (e * size).atanh() / e
    } else {
        size
    };
    let q = (1.0 - e2) * (size / (1.0 - e2 * size * size) + slope);
    q.copysign(sine)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Snyder, *Map Projections*, USGS PP 1395 (1987), p. 187, uses Clarke's ellipsoid; for WGS 84 the
    /// surface is 510 065 621.724 km² (NIMA TR 8350.2, table 3.3: authalic radius 6371.007 181 km).
    #[test]
    fn validate_the_area_of_the_earth() {
        let radius_km = Authalic::new(Surface::Wgs84).radius2_km2().sqrt();
        assert!((radius_km - 6_371.007_180_9).abs() < 1e-6, "{radius_km}");
        let sphere = Authalic::new(Surface::Sphere).radius2_km2();
        assert!((sphere / (RADIUS_KM * RADIUS_KM) - 1.0).abs() < 1e-15);
        assert!((4.0 * PI * radius_km * radius_km - 510_065_621.72).abs() < 0.05);
    }

    #[test]
    fn the_latitude_is_the_inverse_of_the_sine() {
        for surface in [Surface::Wgs84, Surface::Sphere] {
            let map = Authalic::new(surface);
            for latitude_deg in [-90.0, -89.9, -45.0, -1e-9, 0.0, 30.0, 60.0, 89.0, 90.0_f64] {
                let back = map.latitude_deg(map.sine(latitude_deg.to_radians()));
                // Of the arc sine: rounding of 1e-16 over the cosine, and its root at a pole.
                let cos = latitude_deg.to_radians().cos();
                let tolerance = (5e-14 / cos.max(2.5e-8)).max(1e-13);
                assert!(
                    (back - latitude_deg).abs() < tolerance,
                    "{latitude_deg} {back}"
                );
            }
        }
        // The authalic latitude at 45° is 44.8719° on WGS 84 (Snyder's 3-18: 45° - 0.1281°).
        let beta = Authalic::new(Surface::Wgs84)
            .sine(45_f64.to_radians())
            .asin();
        assert!(
            (beta.to_degrees() - 44.871_7).abs() < 1e-3,
            "{}",
            beta.to_degrees()
        );
    }
}

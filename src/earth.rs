//! The one set of physical constants, and the surface on which ground points lie.

use crate::keyword::keywords;
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Gravitational parameter of the Earth, km³/s² (WGS 84 and EGM96).
pub const MU_KM3_S2: f64 = 398_600.441_8;

/// Equatorial radius, km (WGS 84); also the radius of [`Surface::Sphere`].
pub const RADIUS_KM: f64 = 6_378.137;

/// Second zonal harmonic, unnormalised (EGM96: -√5 C̄₂₀).
pub const J2: f64 = 1.082_626_68e-3;

/// Third zonal harmonic, unnormalised (EGM96: -√7 C̄₃₀, C̄₃₀ = 0.957 254 173 792e-6; Lemoine et al.,
/// NASA/TP-1998-206861). Only SGP4 propagates with it, using the WGS-72 value; here it
/// gives the size of the frozen eccentricity.
pub const J3: f64 = -2.532_656_485_33e-6;

/// Fourth zonal harmonic, unnormalised (EGM96: -√9 C̄₄₀, C̄₄₀ = 0.539 873 863 789e-6; same report).
pub const J4: f64 = -1.619_621_591_367e-6;

/// Flattening of the WGS 84 ellipsoid.
pub const FLATTENING: f64 = 1.0 / 298.257_223_563;

/// Rate of Greenwich mean sidereal time, rad/s (derivative of the IAU 1982 expression,
/// Aoki et al., *Astron. Astrophys.* 105 (1982) 359).
pub const GMST_RATE_RAD_S: f64 = 7.292_115_855_3e-5;

/// Mean rate of the Sun in right ascension, rad/s: a turn in a tropical year of 365.2422 days. The node of a
/// sun-synchronous orbit follows it.
pub const MEAN_SUN_RATE_RAD_S: f64 = TAU / (365.242_2 * 86_400.0);

/// Semi-major axis of the geosynchronous satellites of the presets, km.
pub const GEOSYNCHRONOUS_RADIUS_KM: f64 = 42_164.17;

/// Gravitational parameter prescribed for users of GPS ephemerides, m³/s² (IS-GPS-200,
/// 20.3.3.4.3.3).
pub const GPS_MU_M3_S2: f64 = 3.986_005e14;

/// Rotation rate of the Earth prescribed with it, rad/s (same section).
pub const GPS_EARTH_RATE_RAD_S: f64 = 7.292_115_146_7e-5;

keywords! {
    /// Reference surface of ground points, heights and verticals.
    Surface {
        /// The WGS 84 ellipsoid: latitudes are geodetic, the vertical is its normal.
        Wgs84 = "wgs84",
        /// A sphere of radius [`RADIUS_KM`]: latitudes are geocentric, the vertical is radial.
        Sphere = "sphere",
    }
}

impl Surface {
    /// Flattening of the surface.
    #[must_use]
    pub fn flattening(self) -> f64 {
        match self {
            Self::Wgs84 => FLATTENING,
            Self::Sphere => 0.0,
        }
    }

    /// Earth-fixed position of a point at height 0, km.
    ///
    /// Latitude and longitude in radians. Source: Hofmann-Wellenhof et al.,
    /// *GNSS* (2008), equation 8.8, with h = 0 ([M-21](crate::models#m-21)).
    #[must_use]
    pub fn position_km(self, latitude_rad: f64, longitude_rad: f64) -> Vector3<f64> {
        let f = self.flattening();
        let e2 = f * (2.0 - f);
        let (sin_lat, cos_lat) = latitude_rad.sin_cos();
        let (sin_lon, cos_lon) = longitude_rad.sin_cos();
        // N = a / sqrt(1 - e² sin² φ), radius of curvature in the prime vertical
        let n = RADIUS_KM / (1.0 - e2 * sin_lat * sin_lat).sqrt();
        Vector3::new(
            n * cos_lat * cos_lon,
            n * cos_lat * sin_lon,
            n * (1.0 - e2) * sin_lat,
        )
    }

    /// Latitude and longitude of the point below an Earth-fixed position, radians: where the vertical
    /// of the surface passes through it ([M-37](crate::models#m-37)). Bowring, *Survey Review* 23 (1976)
    /// 323, iterated to convergence; 0 at the centre of the Earth, where it is undefined.
    #[must_use]
    pub fn below_rad(self, position_km: Vector3<f64>) -> (f64, f64) {
        let f = self.flattening();
        let e2 = f * (2.0 - f);
        let polar_km = RADIUS_KM * (1.0 - f);
        let second_e2 = e2 / (1.0 - e2);
        let axis_km = position_km.x.hypot(position_km.y);
        // Start from the parametric latitude on the sphere through the position.
        let mut reduced = (position_km.z * RADIUS_KM).atan2(axis_km * polar_km);
        let mut latitude = 0.0;
        for _ in 0..4 {
            let (sin, cos) = reduced.sin_cos();
            let up = position_km.z + second_e2 * polar_km * sin.powi(3);
            let out = axis_km - e2 * RADIUS_KM * cos.powi(3);
            latitude = up.atan2(out);
            reduced = ((1.0 - f) * latitude.sin()).atan2(latitude.cos());
        }
        (latitude, position_km.y.atan2(position_km.x))
    }

    /// Earth-fixed unit vector of the local vertical, upwards.
    ///
    /// The same expression serves both surfaces, because the latitude of each is the
    /// angle between its own vertical and the equator.
    #[must_use]
    pub fn vertical(self, latitude_rad: f64, longitude_rad: f64) -> Vector3<f64> {
        let (sin_lat, cos_lat) = latitude_rad.sin_cos();
        let (sin_lon, cos_lon) = longitude_rad.sin_cos();
        Vector3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The rate is the one-day difference of the sidereal time that the frames use.
    #[test]
    fn validate_gmst_rate_against_the_iau_1982_expression() {
        let day = sofars::erst::gmst82(2_451_545.0, 1.0) - sofars::erst::gmst82(2_451_545.0, 0.0);
        let rate = (day + std::f64::consts::TAU) / 86_400.0;
        // One day of gmst82 in doubles is good to about 1e-15 rad/s; the constant has 11 digits.
        assert!((rate - GMST_RATE_RAD_S).abs() < 5e-15, "{rate:e}");
    }

    /// The coefficient as EGM96 prints it, fully normalised.
    #[test]
    fn validate_j3_against_the_normalised_coefficient() {
        // Twelve digits are printed.
        assert!((J3 / (-7_f64.sqrt() * 0.957_254_173_792e-6) - 1.0).abs() < 1e-12);
        assert!((J4 / (-3.0 * 0.539_873_863_789e-6) - 1.0).abs() < 1e-12);
    }

    /// Semi-minor axis of WGS 84: 6356.752 314 245 km (NIMA TR8350.2, table 3.3).
    #[test]
    fn validate_polar_radius() {
        let pole = Surface::Wgs84.position_km(std::f64::consts::FRAC_PI_2, 0.0);
        assert!((pole.z - 6_356.752_314_245).abs() < 1e-9);
        assert!(pole.x.abs() < 1e-9);
        let pole = Surface::Sphere.position_km(std::f64::consts::FRAC_PI_2, 0.0);
        assert!((pole.z - RADIUS_KM).abs() < 1e-9);
    }

    /// The point below a raised ground point is that ground point.
    #[test]
    fn a_point_lies_below_its_own_vertical() {
        for surface in [Surface::Wgs84, Surface::Sphere] {
            for latitude in [-1.56, -0.8, 0.0, 0.3, 1.2, 1.5] {
                for height_km in [0.0, 400.0, 36_000.0] {
                    let vertical = surface.vertical(latitude, 2.5);
                    let above = surface.position_km(latitude, 2.5) + vertical * height_km;
                    let (found, longitude) = surface.below_rad(above);
                    // A part in 1e12 is 6 micrometres on the ground.
                    assert!((found - latitude).abs() < 1e-12, "{latitude} {height_km}");
                    assert!((longitude - 2.5).abs() < 1e-12);
                }
            }
        }
    }

    /// Geodetic 45°: the geocentric latitude is atan((1 - f)²), 11.5 arcmin less.
    #[test]
    fn validate_geocentric_latitude_of_a_geodetic_point() {
        let point = Surface::Wgs84.position_km(std::f64::consts::FRAC_PI_4, 0.3);
        let geocentric = (point.z / point.norm()).asin();
        let expected = ((1.0 - FLATTENING) * (1.0 - FLATTENING)).atan();
        assert!((geocentric - expected).abs() < 1e-15);
    }
}

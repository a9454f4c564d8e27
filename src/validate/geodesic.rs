//! Elevation, azimuth and footprints against geodesics on the ellipsoid, by GeographicLib.
//!
//! The judge is a local frame built from geodesics: the direct problem is solved a short distance
//! north, south, east and west of a station, and the resulting Earth-fixed points span the horizon,
//! without any definition of the vertical. The teacher is the textbook curvature method: azimuth and
//! distance from the inverse problem, and a circle with Euler's radius of curvature in between. It
//! is accurate to a few hundredths of a degree for low orbits and degrades above.

mod footprint;
mod surfaces;

use super::distribution::{Distribution, Residual};
use super::{Check, CheckedQuantity, Findings, Subject, ValidateError};
use crate::earth::{FLATTENING, RADIUS_KM, Surface};
use crate::frames::{EarthFixed, Position};
use geographiclib_rs::{DirectGeodesic, Geodesic, InverseGeodesic};
use nalgebra::Vector3;

/// Distance from the station to the points that span its horizon, m: far enough that 15 nm are
/// 1e-11 rad, near enough that the geodesic's change of curvature is 1e-11 rad.
const ARM_M: f64 = 1_000.0;

/// Gate on elevation and azimuth, degrees.
const ANGLE_GATE_DEG: f64 = 1e-8;

/// Gate on the curvature method in low orbit, degrees.
const TEACHER_GATE_DEG: f64 = 0.04;

/// Heights of the satellites, km: low orbit, the design's neighbours, navigation, geosynchronous.
const HEIGHTS_KM: [f64; 6] = [400.0, 925.0, 1_500.0, 2_000.0, 20_180.0, 35_786.0];

/// Highest orbit that counts as low, km.
const LOW_ORBIT_KM: f64 = 2_000.0;

/// Stations: poles, equator, antimeridian, and between.
const LATITUDES_DEG: [f64; 11] = [
    -90.0, -89.9999, -60.0, -33.9, -1e-7, 0.0, 3.0, 30.0, 53.0, 78.2, 90.0,
];
const LONGITUDES_DEG: [f64; 6] = [-179.999_999, -70.7, 0.0, 73.0, 116.4, 180.0];

/// Distances from the station to the sub-satellite point, degrees of arc, starting at the zenith.
const WAYS_DEG: [f64; 7] = [1e-6, 0.1, 3.0, 10.0, 20.0, 45.0, 70.0];

/// Azimuths of the sub-satellite point, degrees.
const BEARINGS_DEG: [f64; 6] = [0.0, 45.0, 90.0, 171.3, 260.0, 359.0];

/// A station and a sub-satellite point, degrees, and the height of the satellite.
#[derive(Debug, Clone, Copy)]
struct Case {
    station_deg: [f64; 2],
    below_deg: [f64; 2],
    height_km: f64,
}

impl std::fmt::Display for Case {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [latitude, longitude] = self.station_deg;
        let [below_latitude, below_longitude] = self.below_deg;
        write!(
            formatter,
            "station {latitude}, {longitude} deg; satellite over {below_latitude:.6}, {below_longitude:.6} deg at {} km",
            self.height_km
        )
    }
}

/// Position of a geodetic point at a height over WGS 84.
///
/// Source: Hofmann-Wellenhof et al., *GNSS* (2008), equation 8.8.
fn geodetic_position_km(
    [latitude_deg, longitude_deg]: [f64; 2],
    height_km: f64,
) -> Position<EarthFixed> {
    let e2 = FLATTENING * (2.0 - FLATTENING);
    let (sin_lat, cos_lat) = latitude_deg.to_radians().sin_cos();
    let (sin_lon, cos_lon) = longitude_deg.to_radians().sin_cos();
    let n = RADIUS_KM / (1.0 - e2 * sin_lat * sin_lat).sqrt();
    Position::new(Vector3::new(
        (n + height_km) * cos_lat * cos_lon,
        (n + height_km) * cos_lat * sin_lon,
        (n * (1.0 - e2) + height_km) * sin_lat,
    ))
}

fn stations() -> impl Iterator<Item = [f64; 2]> {
    LATITUDES_DEG.iter().flat_map(|&latitude| {
        LONGITUDES_DEG
            .iter()
            .map(move |&longitude| [latitude, longitude])
    })
}

/// The satellites observed from a station.
fn cases_of(earth: &Geodesic, station_deg: [f64; 2]) -> Vec<Case> {
    let [latitude, longitude] = station_deg;
    let mut cases = Vec::new();
    for (way, bearing) in pairs(&WAYS_DEG, &BEARINGS_DEG) {
        let way_m = way.to_radians() * RADIUS_KM * 1e3;
        let (below_lat, below_lon): (f64, f64) = earth.direct(latitude, longitude, bearing, way_m);
        cases.extend(HEIGHTS_KM.map(|height_km| Case {
            station_deg,
            below_deg: [below_lat, below_lon],
            height_km,
        }));
    }
    cases
}

fn pairs<'a>(a: &'a [f64], b: &'a [f64]) -> impl Iterator<Item = (f64, f64)> + 'a {
    a.iter().flat_map(|&x| b.iter().map(move |&y| (x, y)))
}

/// The horizon of a station from geodesics.
struct GeodesicHorizon {
    origin_km: Position<EarthFixed>,
    east: Vector3<f64>,
    north: Vector3<f64>,
    up: Vector3<f64>,
}

impl GeodesicHorizon {
    fn new(earth: &Geodesic, [latitude, longitude]: [f64; 2]) -> Self {
        let point = |bearing: f64| {
            let (lat, lon): (f64, f64) = earth.direct(latitude, longitude, bearing, ARM_M);
            geodetic_position_km([lat, lon], 0.0)
        };
        let north = (point(0.0) - point(180.0)).normalize();
        let east = (point(90.0) - point(270.0)).normalize();
        let up = east.cross(&north).normalize();
        Self {
            origin_km: geodetic_position_km([latitude, longitude], 0.0),
            east,
            north,
            up,
        }
    }

    /// Elevation and azimuth, degrees.
    fn look_angles_deg(&self, target_km: Position<EarthFixed>) -> [f64; 2] {
        let line = target_km - self.origin_km;
        let [e, n, u] = [&self.east, &self.north, &self.up].map(|axis| line.dot(axis));
        [u.atan2(e.hypot(n)).to_degrees(), e.atan2(n).to_degrees()]
    }
}

/// Elevation by the curvature method, degrees.
fn taught_elevation_deg(earth: &Geodesic, case: &Case) -> f64 {
    let [latitude, longitude] = case.station_deg;
    let [below_lat, below_lon] = case.below_deg;
    let (way_m, azimuth, _, _): (f64, f64, f64, f64) =
        earth.inverse(latitude, longitude, below_lat, below_lon);
    let e2 = FLATTENING * (2.0 - FLATTENING);
    let sin2 = latitude.to_radians().sin().powi(2);
    let prime_vertical = RADIUS_KM / (1.0 - e2 * sin2).sqrt();
    let meridian = RADIUS_KM * (1.0 - e2) / (1.0 - e2 * sin2).powf(1.5);
    // Euler: 1/R = cos² A/M + sin² A/N
    let (sin_a, cos_a) = azimuth.to_radians().sin_cos();
    let radius = 1.0 / (cos_a * cos_a / meridian + sin_a * sin_a / prime_vertical);
    let arc = way_m / 1e3 / radius;
    let (sin, cos) = arc.sin_cos();
    (cos - radius / (radius + case.height_km))
        .atan2(sin)
        .to_degrees()
}

/// All checks by geodesics: the stations and the footprint of a design.
///
/// # Errors
/// If the design cannot be propagated.
pub fn against_geodesics(subject: &Subject<'_>) -> Result<Findings, ValidateError> {
    let mut findings = look_angles(subject);
    findings.checks.extend(footprint::checks(subject));
    findings.append(surfaces::findings(subject)?);
    Ok(findings)
}

/// Elevation and azimuth of our local frame, and of the teacher, compared with the judge.
fn look_angles(subject: &Subject<'_>) -> Findings {
    let earth = Geodesic::wgs84();
    let (mut elevations, mut azimuths) = (Vec::new(), Vec::new());
    let (mut low, mut high) = (Vec::new(), Vec::new());
    for station_deg in stations() {
        let [latitude, longitude] = station_deg.map(f64::to_radians);
        let ours = (subject.parts.local_frame)(Surface::Wgs84, latitude, longitude);
        let horizon = GeodesicHorizon::new(&earth, station_deg);
        for case in cases_of(&earth, station_deg) {
            let target = geodetic_position_km(case.below_deg, case.height_km);
            let (elevation, azimuth) = (subject.parts.look_angles)(&ours, target);
            let [judged, judged_azimuth] = horizon.look_angles_deg(target);
            let turn = (azimuth.to_degrees() - judged_azimuth + 540.0).rem_euclid(360.0) - 180.0;
            let residual = |value| Residual { value, input: case };
            elevations.push(residual(elevation.to_degrees() - judged));
            azimuths.push(residual(turn * judged.to_radians().cos()));
            if judged < 0.0 {
                continue;
            }
            let taught = residual(elevation.to_degrees() - taught_elevation_deg(&earth, &case));
            if case.height_km <= LOW_ORBIT_KM {
                low.push(taught);
            } else {
                high.push(taught);
            }
        }
    }
    let mut findings = Findings::default();
    let judge = "two constructions of the same plane: GeographicLib's 15 nm over an arm of 1 km, plus rounding";
    let teacher = "the ellipsoid approximated by a circle with its curvature along the azimuth: accurate out to a low satellite";
    let limits = "reported only: the curvature method is not valid out to a high satellite";
    for (name, quantity, residuals, gate, reason) in [
        (
            "elevation",
            "elevation",
            &elevations,
            Some(ANGLE_GATE_DEG),
            judge,
        ),
        (
            "azimuth",
            "azimuth times cos(elevation)",
            &azimuths,
            Some(ANGLE_GATE_DEG),
            judge,
        ),
        (
            "curvature-method/low",
            "elevation by the curvature method",
            &low,
            Some(TEACHER_GATE_DEG),
            teacher,
        ),
        (
            "curvature-method/high",
            "elevation by the curvature method",
            &high,
            None,
            limits,
        ),
    ] {
        findings.add(
            &format!("geographiclib/{name}"),
            [quantity, "deg"],
            residuals,
            gate,
            reason,
        );
    }
    findings
}

impl Findings {
    /// The largest residual as a check, and the distribution.
    pub(super) fn add<I: std::fmt::Display>(
        &mut self,
        name: &str,
        [quantity, unit]: [&str; 2],
        residuals: &[Residual<I>],
        gate: Option<f64>,
        reason: &str,
    ) {
        let found = Distribution::of(name, [quantity, unit], residuals, I::to_string);
        if let Some(found) = found {
            let measure = CheckedQuantity {
                quantity,
                unit,
                statistic: "max",
            };
            self.checks
                .push(Check::new(name, measure, found.max, gate, reason));
            self.distributions.push(found);
        }
    }
}

#[cfg(test)]
mod tests;

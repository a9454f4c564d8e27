//! The area that a satellite sees, by geodesic polygons, against the spherical cap.

use crate::earth::{FLATTENING, RADIUS_KM, Surface};
use crate::validate::{Check, CheckedQuantity, Subject};
use geographiclib_rs::{DirectGeodesic, Geodesic, PolygonArea, Winding};
use std::f64::consts::PI;

use super::geodetic_position_km;

/// Corners of a polygon; a regular one of 180 covers (2π/180)²/6 = 2e-4 less than its circle.
const CORNERS: usize = 180;

/// Latitudes of the sub-satellite point, degrees.
const LATITUDES_DEG: [f64; 5] = [0.0, 20.0, 45.0, 55.0, 80.0];

/// Distance from the sub-satellite point, m, at which the elevation equals the mask.
fn edge_m(subject: &Subject<'_>, earth: &Geodesic, latitude: f64, bearing: f64) -> f64 {
    let height_km = subject.shell.altitude_km();
    let satellite = geodetic_position_km([latitude, 0.0], height_km);
    let mask_rad = subject.setup().mask.degrees().to_radians();
    let (mut near, mut far) = (0.0, 0.5 * PI * RADIUS_KM * 1e3);
    // 50 halvings of 10 000 km leave 10 nm.
    for _ in 0..50 {
        let middle = 0.5 * (near + far);
        let (lat, lon): (f64, f64) = earth.direct(latitude, 0.0, bearing, middle);
        let local = (subject.parts.local_frame)(Surface::Wgs84, lat.to_radians(), lon.to_radians());
        if (subject.parts.look_angles)(&local, satellite).0 > mask_rad {
            near = middle;
        } else {
            far = middle;
        }
    }
    0.5 * (near + far)
}

/// Area of a footprint, km².
fn area_km2(subject: &Subject<'_>, earth: &Geodesic, latitude: f64) -> f64 {
    let mut polygon = PolygonArea::new(earth, Winding::Clockwise);
    for corner in 0..CORNERS {
        let bearing = 360.0 * corner as f64 / CORNERS as f64;
        let way = edge_m(subject, earth, latitude, bearing);
        let (lat, lon): (f64, f64) = earth.direct(latitude, 0.0, bearing, way);
        polygon.add_point(lat, lon);
    }
    polygon.compute(false).1 / 1e6
}

/// Footprints of the design's altitude and mask at several latitudes.
pub(super) fn checks(subject: &Subject<'_>) -> Vec<Check> {
    let earth = Geodesic::wgs84();
    let mask_rad = subject.setup().mask.degrees().to_radians();
    let reach = RADIUS_KM * mask_rad.cos() / (RADIUS_KM + subject.shell.altitude_km());
    let cap_km2 = 2.0 * PI * RADIUS_KM * RADIUS_KM * (1.0 - (reach.acos() - mask_rad).cos());
    let worst = LATITUDES_DEG
        .map(|latitude| area_km2(subject, &earth, latitude) / cap_km2 - 1.0)
        .into_iter()
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))
        .unwrap_or(f64::NAN);
    vec![
        Check::new(
            "geographiclib/footprint/cap",
            CheckedQuantity {
                quantity: "footprint area by the spherical cap formula",
                unit: "km^2",
                statistic: "value",
            },
            cap_km2,
            None,
            "2 pi R^2 (1 - cos psi) on the sphere of the equatorial radius",
        ),
        Check::new(
            "geographiclib/footprint/geodesic-polygon",
            CheckedQuantity {
                quantity: "footprint area by geodesic polygon relative to the cap, minus 1",
                unit: "1",
                statistic: "max",
            },
            worst,
            // Radii of curvature are between R (1 - 2f) and R (1 + f); at a fixed height the area            // is proportional to the radius.
            Some(2.0 * FLATTENING + 3e-4),
            "the ellipsoid's radii of curvature differ from the equatorial radius by up to 2 f; a polygon of 180 corners loses 2e-4",
        ),
    ]
}

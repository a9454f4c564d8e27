//! The coverage radius of a shell: how far from the nearest sub-satellite point a place on the ground can ever be.

use super::{Shell, Slot};
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// Satellites up to which the radius is computed: every three of them are looked at, at many instants.
pub const MOST_COVERING_SATELLITES: usize = 24;

/// The radius is the true one or below it by at most this, degrees.
pub const COVERAGE_RADIUS_TOLERANCE_DEG: f64 = 1e-3;

/// Instants at which the radius is computed before the bound decides where to look closer.
const COARSE: u32 = 256;

/// Length below which three points have no plane, in units of the sphere's radius, squared.
const NO_AREA: f64 = 1e-9;

/// How far a point may lie beyond a facet by rounding, in units of the sphere's radius.
const ROUNDING: f64 = 1e-12;

/// The coverage radius of circular orbits ([M-59](crate::models#m-59)), degrees, over all places and all times: within
/// [`COVERAGE_RADIUS_TOLERANCE_DEG`]. It does not depend on the altitude, nor on the rotation of the Earth.
///
/// `None` for ellipses, and for fewer than 3 or more than [`MOST_COVERING_SATELLITES`] satellites.
///
/// A. H. Ballard, "Rosette constellations of Earth satellites", IEEE Trans. Aerospace and Electronic Systems 16(5), 1980.
#[must_use]
pub fn coverage_radius_deg(shell: &Shell) -> Option<f64> {
    let count = 3..=MOST_COVERING_SATELLITES;
    if shell.eccentricity() != 0.0 || !count.contains(&shell.satellite_count()) {
        return None;
    }
    // One slot onwards, each plane is as before.
    let period = TAU / shell.satellites_per_plane() as f64;
    let radius = |phase: f64| radius_at(&sub_points(shell, phase));
    Some(largest(&radius, period).to_degrees())
}

/// The largest radius over a period of phases, but for the tolerance.
fn largest(radius: &impl Fn(f64) -> f64, period: f64) -> f64 {
    let coarse = (0..COARSE).map(|n| radius(period * f64::from(n) / f64::from(COARSE)));
    let mut most = coarse.fold(0.0, f64::max);
    raise(radius, [0.0, period], &mut most);
    most
}

/// Raises `most` to the largest radius in an interval of phases, but for the tolerance: as each satellite moves by the
/// phase, the radius changes by no more.
fn raise(radius: &impl Fn(f64) -> f64, [from, to]: [f64; 2], most: &mut f64) {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let here = radius(middle);
    *most = most.max(here);
    if here + half > *most + COVERAGE_RADIUS_TOLERANCE_DEG.to_radians() {
        raise(radius, [from, middle], most);
        raise(radius, [middle, to], most);
    }
}

/// Unit vectors to the satellites when their arguments of latitude have advanced by `phase`, radians.
fn sub_points(shell: &Shell, phase: f64) -> Vec<Vector3<f64>> {
    let point = |slot: Slot| {
        let elements = shell.elements(slot);
        let (sin_u, cos_u) = (elements.mean_argument_of_latitude_rad() + phase).sin_cos();
        let (sin_node, cos_node) = elements.raan_rad.sin_cos();
        let (sin_i, cos_i) = elements.inclination_rad.sin_cos();
        Vector3::new(
            cos_node * cos_u - sin_node * sin_u * cos_i,
            sin_node * cos_u + cos_node * sin_u * cos_i,
            sin_u * sin_i,
        )
    };
    shell.slots().map(point).collect()
}

/// The largest distance of a point of the unit sphere from the nearest of some of its points, radians: the angular
/// radius of the largest cap that has none inside, which is cut off by a facet of their convex hull. Above π/2 if the
/// centre is outside of the hull.
fn radius_at(points: &[Vector3<f64>]) -> f64 {
    let mut least: f64 = 1.0;
    let mut has_facet = false;
    for (i, a) in points.iter().enumerate() {
        for (j, b) in points.iter().enumerate().skip(i + 1) {
            for c in &points[j + 1..] {
                let normal = (b - a).cross(&(c - a));
                let Some(normal) = normal.try_normalize(NO_AREA) else {
                    continue;
                };
                let distance = normal.dot(a);
                let beyond = |side: f64| {
                    points
                        .iter()
                        .any(|p| side * (normal.dot(p) - distance) > ROUNDING)
                };
                for side in [1.0, -1.0] {
                    if !beyond(side) {
                        has_facet = true;
                        least = least.min(side * distance);
                    }
                }
            }
        }
    }
    // Points that are all in one place.
    if has_facet {
        least.clamp(-1.0, 1.0).acos()
    } else {
        PI
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(notation: &str) -> Shell {
        notation.parse().unwrap()
    }

    fn of(notation: &str) -> f64 {
        coverage_radius_deg(&shell(notation)).unwrap()
    }

    /// Ballard's best rosettes of 5, 6 and 7 satellites, to the last digit that he gives; the radius here may be too small
    /// by its tolerance.
    #[test]
    fn validate_rosettes() {
        for (notation, expected) in [
            ("delta:43.66:5/5/1@1000", 69.15),
            ("delta:53.13:6/6/4@1000", 66.42),
            ("delta:55.69:7/7/5@1000", 60.26),
        ] {
            let found = of(notation);
            assert!(
                (found - expected).abs() < 0.005 + 0.001,
                "{notation}: {found}"
            );
        }
    }

    /// The corners of an octahedron are as far from the middle of its faces as 1/√3 is from 1; on one great circle its
    /// poles are the farthest; and half a sphere without satellites is more than a right angle away.
    #[test]
    fn validate_points_by_hand() {
        let octahedron: Vec<Vector3<f64>> = [
            [1, 0, 0],
            [-1, 0, 0],
            [0, 1, 0],
            [0, -1, 0],
            [0, 0, 1],
            [0, 0, -1],
        ]
        .map(|[x, y, z]: [i32; 3]| Vector3::new(x.into(), y.into(), z.into()))
        .to_vec();
        let expected = (1.0 / 3.0_f64.sqrt()).acos();
        assert!((radius_at(&octahedron) - expected).abs() < 1e-12);
        assert!((radius_at(&octahedron[..4]) - PI / 2.0).abs() < 1e-12);
        // A small triangle around the pole: its antipode is the farthest, less the triangle's radius.
        let around = |degrees: f64| {
            Vector3::new(
                0.1 * degrees.to_radians().cos(),
                0.1 * degrees.to_radians().sin(),
                0.99_f64.sqrt(),
            )
        };
        let triangle = [around(0.0), around(120.0), around(240.0)];
        assert!((radius_at(&triangle) - (PI - 0.1_f64.asin())).abs() < 1e-12);
        assert_eq!(radius_at(&[Vector3::x(); 3]), PI);
    }

    /// A peak between the phases that are tried first is found, as steep as a radius can be.
    #[test]
    fn a_narrow_peak_is_found() {
        let radius = |phase: f64| (1.0 - (phase - 1.2345).abs()).max(0.9);
        let found = largest(&radius, TAU);
        assert!(
            found <= 1.0 && found > 1.0 - COVERAGE_RADIUS_TOLERANCE_DEG.to_radians(),
            "{found}"
        );
        let tried = (0..COARSE).map(|n| radius(TAU * f64::from(n) / f64::from(COARSE)));
        assert!(tried.fold(0.0, f64::max) < 0.999);
    }

    /// No place that is tried is farther, and one is nearly as far, at every phase that is tried.
    #[test]
    fn validate_against_places_and_instants() {
        let shell = shell("delta:50:8/4/1@1000");
        let most = coverage_radius_deg(&shell).unwrap();
        let mut farthest: f64 = 0.0;
        for phase in 0..90 {
            let points = sub_points(&shell, f64::from(phase).to_radians());
            for latitude in -45..=45 {
                for longitude in 0..90 {
                    let (latitude, longitude) = (
                        (2.0 * f64::from(latitude)).to_radians(),
                        (4.0 * f64::from(longitude)).to_radians(),
                    );
                    let place = Vector3::new(
                        latitude.cos() * longitude.cos(),
                        latitude.cos() * longitude.sin(),
                        latitude.sin(),
                    );
                    let nearest = points.iter().map(|p| p.dot(&place)).fold(-1.0, f64::max);
                    farthest = farthest.max(nearest.acos());
                }
            }
        }
        let farthest = farthest.to_degrees();
        // Half a diagonal of the grid, and half a step in phase.
        assert!(
            farthest <= most + 1e-3 && farthest > most - 2.3 - 0.5,
            "{farthest} {most}"
        );
    }

    #[test]
    fn other_shells_have_no_radius() {
        for notation in [
            "delta:50:2/2/1@1000",
            "delta:50:25/5/1@1000",
            "delta:50:6/3/1@1000,e=0.01",
        ] {
            assert_eq!(coverage_radius_deg(&shell(notation)), None, "{notation}");
        }
    }
}

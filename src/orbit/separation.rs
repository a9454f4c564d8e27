//! How close two satellites on mean orbits come to each other.

use super::MeanElements;
use super::j2::SecularOrbit;
use super::kepler::eccentric_anomaly;
use crate::frames::OrbitPlane;
use nalgebra::Vector3;
use std::f64::consts::{PI, TAU};

/// The closest approach of two satellites that keep their places with respect to each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MatesApproach {
    /// Least distance, km.
    pub distance_km: f64,
    /// Geocentric latitude, north and south, of both where they are closest on circular orbits, radians; `None` on ellipses.
    pub latitude_rad: Option<f64>,
}

/// The closest approach, over all time, of two satellites with the same semi-major axis, eccentricity, inclination and
/// argument of perigee: under secular J2 their nodes and mean anomalies keep their differences. On circular orbits by
/// a closed form ([M-65](crate::models#m-65)), on ellipses over all mean anomalies and arguments of perigee.
#[must_use]
pub fn mates_approach(one: &MeanElements, other: &MeanElements) -> MatesApproach {
    if one.eccentricity == 0.0 {
        on_circles(one, other)
    } else {
        MatesApproach {
            distance_km: Ellipses::of(one, other).least_distance_km(),
            latitude_rad: None,
        }
    }
}

/// 2a |cos(γ/2) sin(ΔF/2)| with the angle γ between the planes, where one satellite is as far before the line in which
/// they intersect as the other is behind it.
fn on_circles(one: &MeanElements, other: &MeanElements) -> MatesApproach {
    let (sin_i, cos_i) = one.inclination_rad.sin_cos();
    let nodes = other.raan_rad - one.raan_rad;
    let (sin_half, cos_half) = (0.5 * nodes).sin_cos();
    let arguments = other.mean_argument_of_latitude_rad() - one.mean_argument_of_latitude_rad();
    // The difference of the angles from the line of intersection.
    let phases = arguments + 2.0 * (sin_half * cos_i).atan2(cos_half);
    // cos² i + sin² i cos²(ΔΩ/2) = (1 + cos² i + sin² i cos ΔΩ)/2
    let cos_half_angle = cos_i.hypot(sin_i * cos_half);
    let radius_km = one.semi_major_axis_km;
    MatesApproach {
        distance_km: 2.0 * radius_km * (cos_half_angle * (0.5 * phases).sin()).abs(),
        // Their arguments of latitude are then 90° ± half their difference.
        latitude_rad: Some((sin_i * (0.5 * arguments).cos()).abs().asin()),
    }
}

/// Two ellipses of one shape whose perigees turn together.
struct Ellipses {
    semi_major_axis_km: f64,
    eccentricity: f64,
    /// From the mean anomaly of one satellite to that of the other, radians.
    behind_rad: f64,
    planes: [OrbitPlane; 2],
}

/// Mean anomalies, and arguments of perigee, at which distances are computed on orbits that are nearly circular.
const ANOMALIES: f64 = 72.0;
const PERIGEES: usize = 36;
/// Of these, the closest from which the search goes on.
const STARTS: usize = 4;
/// Resolution of the search, radians: less than a millimetre in low orbit.
const FINEST_RAD: f64 = 1e-7;

impl Ellipses {
    fn of(one: &MeanElements, other: &MeanElements) -> Self {
        Self {
            semi_major_axis_km: one.semi_major_axis_km,
            eccentricity: one.eccentricity,
            behind_rad: other.mean_anomaly_rad - one.mean_anomaly_rad,
            planes: [one, other].map(|of| OrbitPlane::new(of.raan_rad, of.inclination_rad)),
        }
    }

    /// Perifocal position of a mean anomaly, km.
    fn perifocal(&self, mean_anomaly_rad: f64) -> [f64; 2] {
        let e = self.eccentricity;
        let (sin, cos) = eccentric_anomaly(mean_anomaly_rad.rem_euclid(TAU), e).sin_cos();
        let a = self.semi_major_axis_km;
        [a * (cos - e), a * (1.0 - e * e).sqrt() * sin]
    }

    /// Square of the distance at perifocal positions, the perigee being turned by an angle.
    fn square_km2(&self, places: [[f64; 2]; 2], (sin, cos): (f64, f64)) -> f64 {
        let [one, other] = [0, 1].map(|n: usize| {
            let [x, y] = places[n];
            self.planes[n].vector(x * cos - y * sin, x * sin + y * cos)
        });
        (one - other).norm_squared()
    }

    fn square_at(&self, [anomaly, perigee]: [f64; 2]) -> f64 {
        let places = [anomaly, anomaly + self.behind_rad].map(|m| self.perifocal(m));
        self.square_km2(places, perigee.sin_cos())
    }

    fn least_distance_km(&self) -> f64 {
        // Near the perigee of a long ellipse little time passes.
        let anomalies = (ANOMALIES / (1.0 - self.eccentricity).powf(1.5)) as usize;
        let steps = [TAU / anomalies as f64, TAU / PERIGEES as f64];
        let turns = (0..PERIGEES).map(|n| (n as f64 * steps[1]).sin_cos());
        let turns: Vec<_> = turns.collect();
        let mut found: Vec<(f64, [f64; 2])> = Vec::with_capacity(anomalies * PERIGEES);
        for n in 0..anomalies {
            let anomaly = n as f64 * steps[0];
            let places = [anomaly, anomaly + self.behind_rad].map(|m| self.perifocal(m));
            for (k, turn) in turns.iter().enumerate() {
                let square = self.square_km2(places, *turn);
                found.push((square, [anomaly, k as f64 * steps[1]]));
            }
        }
        // There are more than these by far.
        found.select_nth_unstable_by(STARTS, |a, b| a.0.total_cmp(&b.0));
        let starts = found.into_iter().take(STARTS);
        let least = starts.map(|(square, at)| self.descend(square, at, steps));
        least.fold(f64::INFINITY, f64::min).sqrt()
    }

    /// The square of the distance at the minimum next to a place: the best of its neighbours, at half the distance
    /// where none is better.
    fn descend(&self, mut least: f64, mut at: [f64; 2], mut steps: [f64; 2]) -> f64 {
        while steps[0].max(steps[1]) > FINEST_RAD {
            let mut moved = false;
            for [x, y] in [
                [1.0, 0.0],
                [-1.0, 0.0],
                [0.0, 1.0],
                [0.0, -1.0],
                [1.0, 1.0],
                [-1.0, -1.0],
                [1.0, -1.0],
                [-1.0, 1.0],
            ] {
                let next = [at[0] + x * steps[0], at[1] + y * steps[1]];
                let square = self.square_at(next);
                if square < least {
                    (least, at, moved) = (square, next, true);
                }
            }
            if !moved {
                steps = steps.map(|step| 0.5 * step);
            }
        }
        least
    }
}

/// The closest approach of two satellites within an interval in which they pass each other once at most.
#[must_use]
pub(crate) fn passing(
    one: &SecularOrbit,
    other: &SecularOrbit,
    [from_s, to_s]: [f64; 2],
) -> (f64, f64) {
    /// The interval is halved to this: no rate of change is left to tell.
    const FINEST_S: f64 = 1e-7;
    let relative = |elapsed_s: f64| {
        let (one, other) = (one.state(elapsed_s), other.state(elapsed_s));
        let apart: Vector3<f64> = other.position_km.km() - one.position_km.km();
        (apart, other.velocity_km_s - one.velocity_km_s)
    };
    let recedes = |elapsed_s: f64| {
        let (apart, rate) = relative(elapsed_s);
        apart.dot(&rate) >= 0.0
    };
    let (mut low, mut high) = (from_s, to_s);
    while high - low > FINEST_S {
        let middle = 0.5 * (low + high);
        if recedes(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    let at = 0.5 * (low + high);
    (relative(at).0.norm(), at)
}

/// The first instant at which two satellites on circular orbits that keep their places are closest: the mean of their
/// arguments of latitude is 90° or 270°. Seconds after the epoch.
#[must_use]
pub(crate) fn first_closest_s(one: &MeanElements, other: &MeanElements) -> f64 {
    let rates = SecularOrbit::j2(one).rates();
    let arguments = [one, other].map(MeanElements::mean_argument_of_latitude_rad);
    let half_way = 0.5 * (arguments[0] + arguments[1]);
    (0.5 * PI - half_way).rem_euclid(PI) / rates.arg_latitude_rad_s()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(eccentricity: f64, inclination_deg: f64, [raan, anomaly]: [f64; 2]) -> MeanElements {
        MeanElements {
            semi_major_axis_km: 8000.0,
            eccentricity,
            inclination_rad: inclination_deg.to_radians(),
            raan_rad: raan,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: anomaly,
        }
    }

    /// Two-body ellipses turned through all perigees, at steps of 0.5° in both angles. A place is off by at most half a
    /// step of each; about a minimum the distance grows with the square of that, and no faster than it is moved.
    #[test]
    fn validate_ellipses_by_brute_force() {
        for (e, i, difference) in [
            (0.01, 63.4, [0.9, 2.0]),
            (0.1, 63.4, [3.0, 0.4]),
            (0.4, 30.0, [1.0, 5.0]),
            (0.05, 90.0, [0.2, 3.0]),
        ] {
            let (one, other) = (at(e, i, [0.0, 0.0]), at(e, i, difference));
            let ours = mates_approach(&one, &other).distance_km;
            let least = (0..720 * 720).map(|n| {
                let step = TAU / 720.0;
                let (anomaly, perigee) = ((n / 720) as f64 * step, (n % 720) as f64 * step);
                let place = |of: &MeanElements| {
                    let turned = MeanElements {
                        arg_perigee_rad: perigee,
                        mean_anomaly_rad: of.mean_anomaly_rad + anomaly,
                        ..*of
                    };
                    SecularOrbit::two_body(&turned).state(0.0).position_km.km()
                };
                (place(&one) - place(&other)).norm()
            });
            let least = least.fold(f64::INFINITY, f64::min);
            // At most 2 a (1 + e)/(1 - e) half a step of either angle.
            let coarse = 2.0 * 8000.0 * (1.0 + e) / (1.0 - e) * TAU / 720.0;
            assert!(
                (-1e-6..coarse).contains(&(least - ours)),
                "{e} {i}: {least} {ours}"
            );
        }
    }

    /// As an ellipse becomes a circle, so does the least distance.
    #[test]
    fn validate_small_ellipses_by_the_closed_form() {
        let circles = [at(0.0, 55.0, [0.0, 0.0]), at(0.0, 55.0, [1.2, 0.3])];
        let ellipses = [at(1e-9, 55.0, [0.0, 0.0]), at(1e-9, 55.0, [1.2, 0.3])];
        let [circle, ellipse] =
            [circles, ellipses].map(|[a, b]| mates_approach(&a, &b).distance_km);
        assert!((circle - ellipse).abs() < 1e-4, "{circle} {ellipse}");
    }

    /// The instant and the latitude are those of the propagated satellites.
    #[test]
    fn validate_place_and_time_by_the_propagator() {
        for difference in [[1.2, 0.3], [0.3, 4.0], [-2.5, 1.0], [3.1, 3.0]] {
            let (one, other) = (at(0.0, 55.0, [0.4, 1.0]), at(0.0, 55.0, difference));
            let approach = mates_approach(&one, &other);
            let time_s = first_closest_s(&one, &other);
            let places =
                [one, other].map(|of| SecularOrbit::j2(&of).state(time_s).position_km.km());
            let distance_km = (places[0] - places[1]).norm();
            assert!((distance_km - approach.distance_km).abs() < 1e-6);
            for place in places {
                let latitude = (place.z / place.norm()).asin().abs();
                assert!((latitude - approach.latitude_rad.unwrap()).abs() < 1e-9);
            }
            // And it is a minimum, found again by its root.
            let window = [time_s - 300.0, time_s + 300.0];
            let orbits = [one, other].map(|of| SecularOrbit::j2(&of));
            let (found_km, found_s) = passing(&orbits[0], &orbits[1], window);
            assert!((found_km - distance_km).abs() < 1e-6 && (found_s - time_s).abs() < 1e-3);
        }
    }
}

//! The secular rates of J2 from Lagrange's planetary equations and the potential averaged by
//! quadrature (Vallado, *Fundamentals of Astrodynamics* (4th ed.), section 9.3.1).

use crate::earth::{J2, MU_KM3_S2, RADIUS_KM};
use crate::orbit::{MeanElements, Model};
use crate::units::{SECONDS_PER_DAY, wrap_pi};
use crate::validate::{Check, CheckedQuantity, Subject};
use std::f64::consts::TAU;

/// Nodes of the quadrature over the true anomaly; the integrand is a trigonometric polynomial of
/// degree 3.
const NODES: usize = 64;

/// Relative step of the central differences.
const STEP: f64 = 1e-4;

/// The J2 potential averaged over the mean anomaly, km²/s²; positive as a force function.
fn averaged([a, e, i]: [f64; 3]) -> f64 {
    let parameter = a * (1.0 - e * e);
    let sum: f64 = (0..NODES)
        .map(|k| {
            let f = TAU * k as f64 / NODES as f64;
            let r = parameter / (1.0 + e * f.cos());
            // The argument of perigee averages out of sin² (ω + f), as adding a quarter turn shows.
            let s2 = i.sin().powi(2) * (0.7 + f).sin().powi(2);
            let potential = -MU_KM3_S2 / r * J2 * (RADIUS_KM / r).powi(2) * 0.5 * (3.0 * s2 - 1.0);
            // dM = (r/a)²/sqrt(1 - e²) df
            potential * (r / a).powi(2) / (1.0 - e * e).sqrt()
        })
        .sum();
    sum / NODES as f64
}

fn derivative(at: [f64; 3], n: usize, step: f64) -> f64 {
    let moved = |by: f64| {
        let mut place = at;
        place[n] += by;
        averaged(place)
    };
    // Fourth order: the error is that of the rounding.
    (8.0 * (moved(step) - moved(-step)) - (moved(2.0 * step) - moved(-2.0 * step))) / (12.0 * step)
}

/// Rates of the node and of ω + M, rad/s.
fn rates(orbit: &MeanElements) -> [f64; 2] {
    let (a, e, i) = (
        orbit.semi_major_axis_km,
        orbit.eccentricity,
        orbit.inclination_rad,
    );
    let place = [a, e, i];
    let n = (MU_KM3_S2 / (a * a * a)).sqrt();
    let eta = (1.0 - e * e).sqrt();
    let by_a = derivative(place, 0, STEP * a);
    let by_i = derivative(place, 2, STEP);
    // In dω/dt + dM/dt the derivative by e has the factor η(1 - η)/e, which vanishes with e.
    let by_e = if e > 0.0 {
        eta * (1.0 - eta) / e * derivative(place, 1, STEP.min(0.25 * e))
    } else {
        0.0
    };
    let (sin_i, cos_i) = i.sin_cos();
    let na2 = n * a * a;
    let node = by_i / (na2 * eta * sin_i);
    [node, n - 2.0 / (n * a) * by_a + by_e / na2 - cos_i * node]
}

/// Rates of the model, by its mean elements after a day.
fn propagated_rates(orbit: &MeanElements, after: &MeanElements, expected: [f64; 2]) -> [f64; 2] {
    let turned = [
        after.raan_rad - orbit.raan_rad,
        after.mean_argument_of_latitude_rad() - orbit.mean_argument_of_latitude_rad(),
    ];
    // The number of full revolutions is the expected one.
    [0, 1].map(|n| {
        let excess = wrap_pi(turned[n] - expected[n] * SECONDS_PER_DAY);
        expected[n] + excess / SECONDS_PER_DAY
    })
}

/// The rates of the mean elements of the model against those of the averaged potential of its field.
pub(super) fn checks(subject: &Subject<'_>) -> Vec<Check> {
    let orbit = subject.orbit();
    // Without a node its rate and that of ω cannot be separated.
    if orbit.inclination_rad.sin() < 0.02 {
        return Vec::new();
    }
    let Some(after) = subject.mean_elements_after(&orbit, SECONDS_PER_DAY) else {
        return Vec::new();
    };
    let (expected, reason) = match subject.model() {
        Model::TwoBody => (
            [0.0, orbit.kepler_mean_motion_rad_s()],
            "two bodies: the node stays fixed, and the argument of latitude advances at Kepler's mean motion; rounding only",
        ),
        _ => (
            rates(&orbit),
            "Lagrange's equations with the J2 potential averaged by quadrature; fourth-order central differences, accurate to 1e-10 of the J2 rates",
        ),
    };
    let found = propagated_rates(&orbit, &after, expected);
    ["node", "argument-of-latitude"]
        .into_iter()
        .zip([0, 1])
        .map(|(name, n)| {
            let apart = (found[n] - expected[n]) * SECONDS_PER_DAY;
            Check::new(
                &format!("analytic/rates/{name}"),
                CheckedQuantity {
                    quantity: &format!("rate of the {name} minus that of the averaged potential"),
                    unit: "deg/day",
                    statistic: "value",
                },
                apart.to_degrees(),
                Some(1e-9),
                reason,
            )
        })
        .collect()
}

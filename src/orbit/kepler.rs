//! Kepler's equation, and his third law.

use crate::earth::MU_KM3_S2;
use crate::frames::State;
use crate::units::wrap_pi;
use std::f64::consts::TAU;

/// The period of the unperturbed orbit through a state, s; `None` if it is not closed.
#[must_use]
pub fn period_s<F>(state: &State<F>) -> Option<f64> {
    let speed2 = state.velocity_km_s.norm_squared();
    let a_km = 1.0 / (2.0 / state.position_km.norm() - speed2 / MU_KM3_S2);
    let is_closed = a_km.is_finite() && a_km > 0.0;
    is_closed.then(|| TAU * (a_km.powi(3) / MU_KM3_S2).sqrt())
}

/// Eccentric anomaly E of E - e sin E = M, radians; for 0 <= e < 1 ([M-5](crate::models#m-5)).
///
/// Newton's iteration from the start E = M + 0.85 e sign(sin M) of Danby and Burkardt,
/// *Celestial Mechanics* 31 (1983) 95, on M wrapped to [-π, π); it stops when a step no
/// longer changes E, or E alternates between two neighbouring doubles.
#[must_use]
pub fn eccentric_anomaly(mean_anomaly_rad: f64, eccentricity: f64) -> f64 {
    let mean = wrap_pi(mean_anomaly_rad);
    if eccentricity == 0.0 {
        return mean;
    }
    let mut anomaly = mean + 0.85 * eccentricity * mean.signum();
    let mut last_step = f64::INFINITY;
    // Newton converges in fewer than ten steps for e < 0.9; the bound only guards against oscillation.
    for _ in 0..32 {
        let (sin, cos) = anomaly.sin_cos();
        let step = (anomaly - eccentricity * sin - mean) / (1.0 - eccentricity * cos);
        anomaly -= step;
        if step == 0.0 || (step.abs() < 1e-12 && step.abs() >= last_step) {
            break;
        }
        last_step = step.abs();
    }
    anomaly
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::MeanElements;
    use crate::orbit::j2::SecularOrbit;
    use proptest::prelude::*;

    proptest! {
        /// The equation itself is the reference: the residual is a few ulp of M, without
        /// magnification, for every e below 0.9.
        #[test]
        fn validate_the_equation_is_satisfied(e in 0.0..0.9_f64, m in -3.1..3.1_f64) {
            let anomaly = eccentric_anomaly(m, e);
            let residual = anomaly - e * anomaly.sin() - m;
            prop_assert!(residual.abs() < 1e-15, "{residual:e}");
        }
    }

    /// The period of mean elements from any of their states, and none of a hyperbola.
    #[test]
    fn a_state_has_the_period_of_its_elements() {
        let elements = MeanElements {
            semi_major_axis_km: 8_000.0,
            eccentricity: 0.1,
            inclination_rad: 1.0,
            raan_rad: 2.0,
            arg_perigee_rad: 3.0,
            mean_anomaly_rad: 0.5,
        };
        let expected_s = TAU / elements.kepler_mean_motion_rad_s();
        let orbit = SecularOrbit::two_body(&elements);
        for elapsed_s in [0.0, 1_000.0, 4_000.0] {
            let found_s = period_s(&orbit.state(elapsed_s)).unwrap();
            // Rounding of the difference of two energies.
            assert!((found_s / expected_s - 1.0).abs() < 1e-13, "{found_s}");
        }
        let mut open = orbit.state(0.0);
        open.velocity_km_s *= 1.5;
        assert_eq!(period_s(&open), None);
    }

    #[test]
    fn apses_are_exact() {
        assert_eq!(eccentric_anomaly(0.0, 0.5), 0.0);
        let apogee = eccentric_anomaly(std::f64::consts::PI, 0.5);
        assert!((apogee.abs() - std::f64::consts::PI).abs() < 1e-15);
    }
}

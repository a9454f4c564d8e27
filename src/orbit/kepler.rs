//! Kepler's equation.

use crate::units::wrap_pi;

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

    #[test]
    fn apses_are_exact() {
        assert_eq!(eccentric_anomaly(0.0, 0.5), 0.0);
        let apogee = eccentric_anomaly(std::f64::consts::PI, 0.5);
        assert!((apogee.abs() - std::f64::consts::PI).abs() < 1e-15);
    }
}

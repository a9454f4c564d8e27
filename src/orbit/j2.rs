//! Secular J2: mean elements whose angles advance at constant rates.
//!
//! This is the class of model that STK names *J2Perturbation*: semi-major axis, eccentricity
//! and inclination are constant, and the state follows from the mean elements as in the two-body
//! problem, without short-period terms.

use super::kepler::eccentric_anomaly;
use super::{MeanElements, PropagationError, Propagator};
use crate::earth::{J2, RADIUS_KM};
use crate::frames::{OrbitPlane, PerifocalAxes, State, Teme};
use crate::units::wrap_two_pi;

/// Constant rates of the angles, rad/s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecularRates {
    /// Of the right ascension of the ascending node.
    pub raan_rad_s: f64,
    /// Of the argument of perigee.
    pub arg_perigee_rad_s: f64,
    /// Of the mean anomaly, Kepler's mean motion included.
    pub mean_anomaly_rad_s: f64,
}

impl SecularRates {
    /// The rates of the two-body problem.
    #[must_use]
    pub fn two_body(elements: &MeanElements) -> Self {
        Self {
            raan_rad_s: 0.0,
            arg_perigee_rad_s: 0.0,
            mean_anomaly_rad_s: elements.kepler_mean_motion_rad_s(),
        }
    }

    /// The first-order secular rates of J2 ([M-6](crate::models#m-6) to [M-8](crate::models#m-8)):
    /// Brouwer, *Astron. J.* 64 (1959) 378; Vallado, *Fundamentals of Astrodynamics* (4th ed.),
    /// equations 9-38, 9-40 and 9-41.
    #[must_use]
    pub fn j2(elements: &MeanElements) -> Self {
        let n = elements.kepler_mean_motion_rad_s();
        let eta2 = 1.0 - elements.eccentricity * elements.eccentricity;
        let parameter_km = elements.semi_major_axis_km * eta2;
        let (sin_i, cos_i) = elements.inclination_rad.sin_cos();
        // g = 3/2 J2 (R/p)² n
        let g = 1.5 * J2 * (RADIUS_KM / parameter_km).powi(2) * n;
        Self {
            // dΩ/dt = -g cos i
            raan_rad_s: -g * cos_i,
            // dω/dt = g (2 - 5/2 sin² i)
            arg_perigee_rad_s: g * (2.0 - 2.5 * sin_i * sin_i),
            // dM/dt = n + g sqrt(1 - e²) (1 - 3/2 sin² i)
            mean_anomaly_rad_s: n + g * eta2.sqrt() * (1.0 - 1.5 * sin_i * sin_i),
        }
    }

    /// Of the argument of latitude, rad/s.
    #[must_use]
    pub fn arg_latitude_rad_s(&self) -> f64 {
        self.arg_perigee_rad_s + self.mean_anomaly_rad_s
    }
}

/// A satellite whose mean elements advance at constant rates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SecularOrbit {
    elements: MeanElements,
    rates: SecularRates,
}

impl SecularOrbit {
    /// Propagates `elements` at the given rates.
    #[must_use]
    pub fn new(elements: &MeanElements, rates: SecularRates) -> Self {
        Self {
            elements: *elements,
            rates,
        }
    }

    /// Propagates `elements` around a point mass.
    #[must_use]
    pub fn two_body(elements: &MeanElements) -> Self {
        Self::new(elements, SecularRates::two_body(elements))
    }

    /// Propagates `elements` under secular J2.
    #[must_use]
    pub fn j2(elements: &MeanElements) -> Self {
        Self::new(elements, SecularRates::j2(elements))
    }

    /// The constant rates.
    #[must_use]
    pub fn rates(&self) -> SecularRates {
        self.rates
    }

    /// The mean elements `elapsed_s` seconds after the epoch.
    #[must_use]
    pub fn elements_at(&self, elapsed_s: f64) -> MeanElements {
        let start = self.elements;
        MeanElements {
            raan_rad: wrap_two_pi(start.raan_rad + self.rates.raan_rad_s * elapsed_s),
            arg_perigee_rad: wrap_two_pi(
                start.arg_perigee_rad + self.rates.arg_perigee_rad_s * elapsed_s,
            ),
            mean_anomaly_rad: wrap_two_pi(
                start.mean_anomaly_rad + self.rates.mean_anomaly_rad_s * elapsed_s,
            ),
            ..start
        }
    }

    /// The TEME state `elapsed_s` seconds after the epoch; defined for every instant.
    #[must_use]
    pub fn state(&self, elapsed_s: f64) -> State<Teme> {
        two_body_state(&self.elements_at(elapsed_s), &self.rates)
    }
}

impl Propagator for SecularOrbit {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        Ok(self.state(elapsed_s))
    }
}

/// Position of the elements on their ellipse, and its time derivative under the secular rates
/// ([M-9](crate::models#m-9), [M-10](crate::models#m-10)). The rates of the node and the perigee
/// rotate the ellipse, so the velocity is the derivative of the position and not Kepler's, which is
/// off by up to 10 m/s.
fn two_body_state(elements: &MeanElements, rates: &SecularRates) -> State<Teme> {
    let e = elements.eccentricity;
    let eta = (1.0 - e * e).sqrt();
    let anomaly = eccentric_anomaly(elements.mean_anomaly_rad, e);
    let (sin_e, cos_e) = anomaly.sin_cos();
    // Perifocal position, and its derivative with dE/dt = (dM/dt) / (1 - e cos E)
    let a = elements.semi_major_axis_km;
    let (x, y) = (a * (cos_e - e), a * eta * sin_e);
    let anomaly_rate = rates.mean_anomaly_rad_s / (1.0 - e * cos_e);
    let (vx, vy) = (-a * sin_e * anomaly_rate, a * eta * cos_e * anomaly_rate);
    // Rotated by the argument of perigee to node axes
    let perifocal = PerifocalAxes::new(elements.arg_perigee_rad);
    let (node_x, node_y) = perifocal.to_node_axes(x, y);
    let (turned_vx, turned_vy) = perifocal.to_node_axes(vx, vy);
    let (node_vx, node_vy) = (
        turned_vx - rates.arg_perigee_rad_s * node_y,
        turned_vy + rates.arg_perigee_rad_s * node_x,
    );
    let plane = OrbitPlane::new(elements.raan_rad, elements.inclination_rad);
    let position_km = plane.vector(node_x, node_y);
    let mut velocity_km_s = plane.vector(node_vx, node_vy);
    velocity_km_s.x -= rates.raan_rad_s * position_km.y;
    velocity_km_s.y += rates.raan_rad_s * position_km.x;
    State::new(position_km, velocity_km_s)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::MU_KM3_S2;
    use std::f64::consts::{FRAC_PI_2, TAU};

    fn elements(altitude_km: f64, eccentricity: f64, inclination_deg: f64) -> MeanElements {
        MeanElements {
            semi_major_axis_km: RADIUS_KM + altitude_km,
            eccentricity,
            inclination_rad: inclination_deg.to_radians(),
            raan_rad: 0.4,
            arg_perigee_rad: 1.1,
            mean_anomaly_rad: 2.0,
        }
    }

    /// The node of a Sun-synchronous orbit moves 360° in a tropical year, 0.985 647 4°/day;
    /// at 800 km that requires 98.603° (Vallado, 4th ed., figure 11-14: 98.6°).
    #[test]
    fn validate_sun_synchronous_node_rate() {
        let rates = SecularRates::j2(&elements(800.0, 0.0, 98.603));
        let deg_per_day = (rates.raan_rad_s * 86_400.0).to_degrees();
        // 0.001° of inclination corresponds to 1.1e-4 °/day here.
        assert!((deg_per_day - 0.985_647).abs() < 2e-4, "{deg_per_day}");
    }

    /// The perigee is stationary at sin² i = 4/5, the mean anomaly advances at Kepler's rate at
    /// sin² i = 2/3, and a polar node is stationary.
    #[test]
    fn validate_critical_inclinations() {
        let at = |sin2: f64| elements(925.0, 0.02, sin2.sqrt().asin().to_degrees());
        assert!(SecularRates::j2(&at(0.8)).arg_perigee_rad_s.abs() < 1e-20);
        let neutral = at(2.0 / 3.0);
        let excess =
            SecularRates::j2(&neutral).mean_anomaly_rad_s - neutral.kepler_mean_motion_rad_s();
        assert!(excess.abs() < 1e-18);
        let polar = MeanElements {
            inclination_rad: FRAC_PI_2,
            ..neutral
        };
        assert!(SecularRates::j2(&polar).raan_rad_s.abs() < 1e-20);
    }

    /// Two-body: energy and angular momentum are those of the elements.
    #[test]
    fn validate_two_body_invariants() {
        let orbit = elements(1200.0, 0.1, 63.0);
        let period = TAU / orbit.kepler_mean_motion_rad_s();
        for k in 0..50 {
            let state = SecularOrbit::two_body(&orbit).state(period * 0.37 * f64::from(k));
            let energy =
                state.velocity_km_s.norm_squared() / 2.0 - MU_KM3_S2 / state.position_km.norm();
            let expected = -MU_KM3_S2 / (2.0 * orbit.semi_major_axis_km);
            assert!((energy / expected - 1.0).abs() < 1e-12);
            let momentum = state.position_km.km().cross(&state.velocity_km_s);
            let size = (MU_KM3_S2 * orbit.semi_major_axis_km * (1.0 - 0.01)).sqrt();
            assert!((momentum.norm() / size - 1.0).abs() < 1e-12);
            assert!((momentum.z / momentum.norm() - orbit.inclination_rad.cos()).abs() < 1e-12);
        }
    }

    /// The velocity is the derivative of the position.
    #[test]
    fn velocity_is_the_derivative() {
        for orbit in [elements(925.0, 0.0, 55.0), elements(2000.0, 0.2, 100.0)] {
            let propagated = SecularOrbit::j2(&orbit);
            for t in [0.0, 1234.5, 86_000.0] {
                let h = 0.5;
                let slope = (propagated.state(t + h).position_km
                    - propagated.state(t - h).position_km)
                    / (2.0 * h);
                // Central difference: r n³ h²/6 = 4e-7 km/s in low orbit.
                assert!((slope - propagated.state(t).velocity_km_s).norm() < 5e-7);
            }
        }
    }
}

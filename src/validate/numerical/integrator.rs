//! Point mass with zonal harmonics, integrated numerically.
//!
//! Integrator: DOP853 of Dormand and Prince with dense output (Hairer, Nørsett and Wanner, *Solving
//! Ordinary Differential Equations I* (2nd ed.), section II.5), by the crate
//! `differential-equations`: maintained, and on the same linear algebra as this library.

use crate::earth::{J2, J3, MU_KM3_S2, RADIUS_KM};
use crate::frames::{State, Teme};
use crate::orbit::Model;
use differential_equations::prelude::*;
use nalgebra::Vector3;
use std::f64::consts::TAU;
use thiserror::Error;

/// Relative and absolute (km, km/s) tolerance of a step.
const TOLERANCE: f64 = 1e-13;

/// Minimum steps per revolution: longer steps would be accurate at their ends but not in between,
/// where the dense output is of lower order.
const STEPS_PER_REVOLUTION: f64 = 128.0;

/// More steps than 30 days of the lowest orbit take.
const MAX_STEPS: usize = 5_000_000;

/// An integration that failed.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("the integration over {span_s} s gave {found} of {wanted} states")]
pub struct IntegrationError {
    /// Length of the span, s.
    span_s: f64,
    /// States requested.
    wanted: usize,
    /// States returned.
    found: usize,
}

/// A point mass with zonal harmonics, unnormalised.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ZonalField {
    /// Gravitational parameter, km³/s².
    pub mu_km3_s2: f64,
    /// Radius that the harmonics refer to, km.
    pub radius_km: f64,
    /// Second harmonic.
    pub j2: f64,
    /// Third harmonic.
    pub j3: f64,
    /// Fourth harmonic.
    pub j4: f64,
}

/// An acceleration of a field at a position in TEME, km and km/s².
pub type Acceleration = fn(&ZonalField, Vector3<f64>) -> Vector3<f64>;

impl ZonalField {
    /// The Earth as a point mass.
    pub const POINT_MASS: Self = Self {
        mu_km3_s2: MU_KM3_S2,
        radius_km: RADIUS_KM,
        j2: 0.0,
        j3: 0.0,
        j4: 0.0,
    };

    /// Point mass and J2.
    pub const J2: Self = Self {
        j2: J2,
        ..Self::POINT_MASS
    };

    /// Point mass, J2 and J3.
    pub const J2_J3: Self = Self { j3: J3, ..Self::J2 };

    /// The field that a model is a theory of: a theory is judged in its own field, and SGP4 in the
    /// constants of WGS-72.
    #[must_use]
    pub fn of(model: Model) -> Self {
        let wgs72 = ::sgp4::WGS72;
        match model {
            Model::TwoBody => Self::POINT_MASS,
            Model::J2 | Model::J2Osculating => Self::J2,
            Model::Sgp4 => Self {
                // k_e = sqrt(μ) in Earth radii^1.5 per minute
                mu_km3_s2: wgs72.ae.powi(3) * (wgs72.ke / 60.0).powi(2),
                radius_km: wgs72.ae,
                j2: wgs72.j2,
                j3: wgs72.j3,
                j4: wgs72.j4,
            },
        }
    }

    /// The acceleration at a position, km/s².
    ///
    /// The gradient of μ/r [1 - Σ Jₙ (R/r)ⁿ Pₙ(s)], s = z/r, is
    /// -μ r̂/r² + Σ μ Jₙ Rⁿ/rⁿ⁺² [P'ₙ₊₁(s) r̂ - P'ₙ(s) ẑ].
    #[must_use]
    pub fn acceleration(&self, position_km: Vector3<f64>) -> Vector3<f64> {
        let r = position_km.norm();
        let radial = position_km / r;
        let s = radial.z;
        let s2 = s * s;
        let ratio = self.radius_km / r;
        // P'₂ to P'₅
        let second = 3.0 * s;
        let third = 0.5 * (15.0 * s2 - 3.0);
        let fourth = 0.5 * s * (35.0 * s2 - 15.0);
        let fifth = 0.125 * (315.0 * s2 * s2 - 210.0 * s2 + 15.0);
        let [j2, j3, j4] = [self.j2, self.j3 * ratio, self.j4 * ratio * ratio];
        let along_radial = j2 * third + j3 * fourth + j4 * fifth;
        let along_pole = j2 * second + j3 * third + j4 * fourth;
        let gravity = self.mu_km3_s2 / (r * r);
        let perturbed =
            (radial * along_radial - Vector3::z() * along_pole) * (gravity * ratio * ratio);
        perturbed - radial * gravity
    }

    /// Energy per mass, km²/s².
    pub(in crate::validate) fn energy(&self, state: &State<Teme>) -> f64 {
        let r = state.position_km.norm();
        let s = state.position_km.km().z / r;
        let s2 = s * s;
        let ratio = self.radius_km / r;
        let p2 = 0.5 * (3.0 * s2 - 1.0);
        let p3 = 0.5 * s * (5.0 * s2 - 3.0);
        let p4 = 0.125 * (35.0 * s2 * s2 - 30.0 * s2 + 3.0);
        let zonal = ratio * ratio * (self.j2 * p2 + ratio * (self.j3 * p3 + ratio * self.j4 * p4));
        0.5 * state.velocity_km_s.norm_squared() - self.mu_km3_s2 / r * (1.0 - zonal)
    }

    /// The states at `times_s`, which increase from 0, from the state at 0.
    pub(in crate::validate) fn integrate(
        &self,
        acceleration: Acceleration,
        start: &State<Teme>,
        times_s: &[f64],
    ) -> Result<Vec<State<Teme>>, IntegrationError> {
        let span_s = times_s.last().copied().unwrap_or(0.0);
        let failed = |found: usize| IntegrationError {
            span_s,
            wanted: times_s.len(),
            found,
        };
        let derivative = |_: f64, y: &[f64; 6], rate: &mut [f64; 6]| {
            let pull = acceleration(self, Vector3::new(y[0], y[1], y[2]));
            *rate = [y[3], y[4], y[5], pull.x, pull.y, pull.z];
        };
        let (r, v) = (start.position_km.km(), start.velocity_km_s);
        let revolution_s = TAU * (r.norm().powi(3) / self.mu_km3_s2).sqrt();
        let solution = IVP::ode_from_fn(derivative, 0.0, span_s, [r.x, r.y, r.z, v.x, v.y, v.z])
            .t_eval(times_s)
            .method(
                ExplicitRungeKutta::dop853()
                    .rtol(TOLERANCE)
                    .atol(TOLERANCE)
                    .h_max(revolution_s / STEPS_PER_REVOLUTION)
                    .max_steps(MAX_STEPS),
            )
            .solve()
            .map_err(|_| failed(0))?;
        if solution.y.len() != times_s.len() {
            return Err(failed(solution.y.len()));
        }
        Ok(solution.y.iter().map(state_of).collect())
    }
}

fn state_of(y: &[f64; 6]) -> State<Teme> {
    State::new(
        Vector3::new(y[0], y[1], y[2]),
        Vector3::new(y[3], y[4], y[5]),
    )
}

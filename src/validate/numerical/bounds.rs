//! Bounds on the difference between a model and the integration of its field, and their reasons.

use super::CONSERVED;
use crate::orbit::sgp4::ZonalHarmonics;
use crate::orbit::{MeanElements, Model};
use crate::units::SECONDS_PER_DAY;
use crate::validate::Subject;
use crate::validate::sgp4::causes::{Causes, FIRST_ORDER_MARGIN};
use std::f64::consts::SQRT_2;

/// The bounds for one design and model.
pub(super) struct IntegrationBounds {
    model: Model,
    causes: Causes,
    eccentricity: f64,
    a_km: f64,
    /// Drift in-track by a change of the semi-major axis, 3/2 n, per day.
    pub(super) drift_per_a_per_day: f64,
    /// Bound on the in-track drift, km/day; `None` where none is known.
    pub(super) drift_km_per_day: Option<f64>,
    /// Why it is there.
    pub(super) drift_reason: &'static str,
    /// Node rate that the model leaves out, in closed form, degrees a day.
    pub(super) known_node_deg_per_day: f64,
    /// Bound on the remaining node rate, degrees a day.
    pub(super) node_deg_per_day: f64,
    /// Why it is there.
    pub(super) node_reason: &'static str,
    /// Why there are, or are not, bounds on what remains after the fit.
    pub(super) after_fit_reason: &'static str,
}

impl IntegrationBounds {
    pub(super) fn of(subject: &Subject<'_>) -> Self {
        let model = subject.model();
        let orbit = subject.orbit();
        let causes = Causes::of(&orbit);
        let a_km = orbit.semi_major_axis_km;
        let second_order = causes.eccentric_factor * causes.second_order_km_per_day;
        let drift_per_a_per_day = 1.5 * orbit.kepler_mean_motion_rad_s() * SECONDS_PER_DAY;
        // What the integration does not conserve changes its semi-major axis.
        let integrator = drift_per_a_per_day * CONSERVED * a_km;
        let over_node = |km: f64| (km / a_km / orbit.inclination_rad.sin().max(1e-3)).to_degrees();
        let excess = causes.excess_rad_s(ZonalHarmonics::J2Only)[0] * SECONDS_PER_DAY;
        let (drift_km_per_day, known_node_deg_per_day, node_km) = match model {
            Model::TwoBody => (Some(integrator), 0.0, integrator),
            Model::J2 | Model::J2Osculating => {
                let start = largest_drift_from_start_km_per_day(&orbit);
                let drift = start + causes.third_order_km_per_day();
                (Some(drift), excess.to_degrees(), 0.05 * second_order)
            }
            Model::Sgp4 => (None, 0.0, 0.05 * second_order),
        };
        let (drift_reason, node_reason, after_fit_reason) = match model {
            Model::TwoBody => {
                let same = "Kepler's orbit is exact in this field: what the integration does not conserve of the energy";
                (same, same, same)
            }
            Model::J2 => (
                START,
                NODE,
                "short-period terms, which secular J2 leaves out, by their closed forms with 15 %; the node drifts by its terms in J2^2",
            ),
            Model::J2Osculating => (
                START,
                NODE,
                "the start has an eccentricity of O(J2^2), in closed form at the equator, where it is largest; long-period terms of order e J2; the node drifts by its terms in J2^2",
            ),
            Model::Sgp4 => (
                "reported only: the starting semi-major axis of SGP4 is known to O(J2^2), and its drift is as large as that by J4",
                "SGP4 has the secular terms of J2^2 and J4: third order and the start are left",
                "reported only: the periodic terms of second order and of J3 and J4 that SGP4 leaves out",
            ),
        };
        Self {
            model,
            causes,
            eccentricity: orbit.eccentricity,
            a_km,
            drift_per_a_per_day,
            drift_km_per_day,
            drift_reason,
            known_node_deg_per_day,
            node_deg_per_day: over_node(node_km),
            node_reason,
            after_fit_reason,
        }
    }

    /// Bounds on the RMS in-track, after the fit, and cross-track, km.
    pub(super) fn after_fit_km(&self, days: f64) -> [Option<f64>; 2] {
        let causes = &self.causes;
        let integrator = CONSERVED * self.drift_per_a_per_day * self.a_km * days.powi(2);
        let across =
            causes.drifts_km_per_day(ZonalHarmonics::J2Only)[1].abs() * days / 6_f64.sqrt();
        let first_order = |amplitude: f64| amplitude / SQRT_2;
        let [_, along_km, across_km] = causes.short_period_km;
        // e J2 a grows through a turn of the perigee, which takes months.
        let long_period = 3.0 * self.eccentricity * crate::earth::J2 * self.a_km * (1.0 + days);
        // Periodic terms of second order, J2² a: 9 m.
        let periodic_km = FIRST_ORDER_MARGIN * crate::earth::J2.powi(2) * self.a_km;
        let higher = periodic_km + first_order(self.second_order_in_track_km()) + long_period;
        let whole = |km: f64| FIRST_ORDER_MARGIN * causes.eccentric_factor * km + higher;
        match self.model {
            Model::TwoBody => [Some(integrator), Some(integrator)],
            Model::J2 => [
                Some(whole(first_order(along_km))),
                Some(whole(first_order(across_km).hypot(across))),
            ],
            Model::J2Osculating => [Some(higher), Some(whole(across))],
            Model::Sgp4 => [None, None],
        }
    }

    /// In-track amplitude of the second-order eccentricity of the start, km, by [M-48](crate::models#m-48).
    fn second_order_in_track_km(&self) -> f64 {
        let parameter_km = self.a_km * (1.0 - self.eccentricity * self.eccentricity);
        126.0 * epsilon(parameter_km).powi(2) * self.a_km
    }
}

/// ε = J2 R²/(2 p²).
fn epsilon(parameter_km: f64) -> f64 {
    0.5 * crate::earth::J2 * (crate::earth::RADIUS_KM / parameter_km).powi(2)
}

/// Largest in-track drift, over the argument of latitude θ of the start, of an orbit that starts from
/// the first-order osculating state at e = 0, km/day.
///
/// Equation [M-47](crate::models#m-47).
fn largest_drift_from_start_km_per_day(orbit: &MeanElements) -> f64 {
    let a_km = orbit.semi_major_axis_km;
    let parameter_km = a_km * (1.0 - orbit.eccentricity * orbit.eccentricity);
    let c2 = orbit.inclination_rad.cos().powi(2);
    let mean = 9.0 - 58.0 * c2 + 105.0 * c2 * c2;
    let twice = (1.0 - c2) * (1.0 + 11.0 * c2);
    let four_times = (1.0 - c2) * (1.0 - 4.0 * c2);
    let km_per_day = orbit.kepler_mean_motion_rad_s() * a_km * SECONDS_PER_DAY;
    let scale = 2.25 * epsilon(parameter_km).powi(2) * km_per_day;
    scale * (mean.abs() + twice + four_times.abs())
}

/// Why the drift of a J2 theory is bounded.
const START: &str = "the starting semi-major axis is known to O(J2^2), some metres, which drifts by 3/2 n per metre: no error of the rates, and known in closed form";

/// Why the node of a J2 theory is bounded.
const NODE: &str = "the terms in J2^2 of the node rate are known in closed form: a twentieth of their largest size is left for third order and the start";

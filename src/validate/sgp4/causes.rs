//! Closed forms of the terms that mean J2 neglects, from which the gates are derived.

use crate::earth::{J2, RADIUS_KM};
use crate::orbit::sgp4::ZonalHarmonics;
use crate::orbit::{MeanElements, osculating};
use crate::units::SECONDS_PER_DAY;
use std::f64::consts::{SQRT_2, TAU};

/// SGP4 adds the Sun, the Moon and resonances at periods from 225 minutes on (Hoots and
/// Roehrich, *Spacetrack Report* 3 (1980), section 6), which no J2 model has.
const DEEP_SPACE_PERIOD_S: f64 = 225.0 * 60.0;

/// -J3/J2 of WGS-72, the constants of SGP4 (Vallado et al., AIAA 2006-6753, table 1).
const J3_OVER_J2_WGS72: f64 = -::sgp4::WGS72.j3 / ::sgp4::WGS72.j2;

/// Fraction by which a first-order closed form at e = 0 may be exceeded: terms of order e and J2,
/// the rotation of the frozen eccentricity in a day, and the sampling of the extremes.
const FIRST_ORDER_MARGIN: f64 = 1.15;

/// Closed forms of the causes, for one orbit; all at e = 0 ([M-40](crate::models#m-40) to
/// [M-45](crate::models#m-45)).
#[derive(Debug, Clone, Copy)]
pub(in crate::validate) struct Causes {
    /// Constant shift of the radius, km.
    pub(in crate::validate) radius_shift_km: f64,
    /// Amplitudes of the short-period terms, km.
    pub(in crate::validate) short_period_km: [f64; 3],
    /// Amplitude of the radial effect of the frozen eccentricity, km; in-track is twice that.
    pub(in crate::validate) frozen_km: f64,
    /// Bound on the in-track rate of second-order terms, km/day.
    pub(in crate::validate) second_order_km_per_day: f64,
    /// In-track rate of sqrt(μ/a³) in the Kozai mean motion field, km/day.
    pub(in crate::validate) kepler_slot_km_per_day: f64,
    /// Factor by which the eccentricity increases first-order terms.
    pub(in crate::validate) eccentric_factor: f64,
}

impl Causes {
    pub(in crate::validate) fn of(orbit: &MeanElements) -> Self {
        let (sin_i, cos_i) = orbit.inclination_rad.sin_cos();
        let a = orbit.semi_major_axis_km;
        let e = orbit.eccentricity;
        let parameter_km = a * (1.0 - e * e);
        let n = orbit.kepler_mean_motion_rad_s();
        let first_order_km = J2 * RADIUS_KM * RADIUS_KM / parameter_km;
        let km_per_day = n * a * SECONDS_PER_DAY;
        let ratio2 = (RADIUS_KM / parameter_km).powi(2);
        Self {
            radius_shift_km: osculating::radius_shift_km(orbit),
            short_period_km: [
                // 1/4 J2 (R²/p) sin² i
                0.25 * first_order_km * sin_i * sin_i,
                // 1/8 J2 (R²/p) sin² i
                0.125 * first_order_km * sin_i * sin_i,
                // 3/4 J2 (R²/p) sin i |cos i|
                0.75 * first_order_km * sin_i * cos_i.abs(),
            ],
            // a e_f = |J3 / (2 J2)| R sin i
            frozen_km: 0.5 * J3_OVER_J2_WGS72 * RADIUS_KM * sin_i,
            // (2 + 12 cos⁴ i) J2² (R/p)⁴ n a
            second_order_km_per_day: (2.0 + 12.0 * cos_i.powi(4))
                * J2
                * J2
                * ratio2
                * ratio2
                * km_per_day,
            // -3/2 J2 (R/p)² sqrt(1 - e²) (1 - 3/2 sin² i) n a
            kepler_slot_km_per_day: -1.5
                * J2
                * ratio2
                * (1.0 - e * e).sqrt()
                * (1.0 - 1.5 * sin_i * sin_i)
                * km_per_day,
            eccentric_factor: 1.0 + 8.0 * e,
        }
    }

    /// Bounds on the RMS of mean J2 against SGP4 over a span, km.
    pub(in crate::validate) fn rms_gates_km(&self, zonals: ZonalHarmonics, days: f64) -> [f64; 3] {
        let frozen = match zonals {
            ZonalHarmonics::Full => self.frozen_km / SQRT_2,
            ZonalHarmonics::J2Only | ZonalHarmonics::WithoutJ3 => 0.0,
        };
        let periodic = self.short_period_km.map(|amplitude| amplitude / SQRT_2);
        let drift = self.second_order_km_per_day * days / 3_f64.sqrt();
        let first_order = [
            self.radius_shift_km.hypot(periodic[0]).hypot(frozen),
            periodic[1].hypot(2.0 * frozen),
            periodic[2],
        ];
        let second_order = [0.05 * drift, drift, drift];
        std::array::from_fn(|axis| {
            FIRST_ORDER_MARGIN * self.eccentric_factor * first_order[axis].hypot(second_order[axis])
        })
    }

    /// The bounds that remain when the short-period terms of J2 are propagated too.
    pub(in crate::validate) fn osculating_gates_km(
        &self,
        zonals: ZonalHarmonics,
        days: f64,
    ) -> [f64; 3] {
        let mut without = *self;
        // SGP4's minimum eccentricity of 1e-6 is 7 m; first-order terms are accurate to a fraction J2.
        without.radius_shift_km = 0.02;
        without.short_period_km = self
            .short_period_km
            .map(|amplitude| 0.01 * amplitude + 0.02);
        without.rms_gates_km(zonals, days)
    }

    /// Bound on the slope of the mean in-track difference, km/day: second order, plus the periodic
    /// part for spans so short that the mean over the constellation is not yet a mean over the
    /// orbit.
    pub(in crate::validate) fn growth_gate_km_per_day(&self, days: f64) -> f64 {
        let periodic = self.short_period_km[1] + 2.0 * self.frozen_km;
        let leftover = 0.02 * periodic / days.min(1.0);
        self.eccentric_factor * (self.second_order_km_per_day + leftover)
    }
}

/// Whether SGP4 uses its deep-space theory for an orbit.
pub(in crate::validate) fn is_deep_space(orbit: &MeanElements) -> bool {
    TAU / orbit.kepler_mean_motion_rad_s() >= DEEP_SPACE_PERIOD_S
}

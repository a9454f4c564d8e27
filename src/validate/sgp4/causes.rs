//! Closed forms of the terms that mean J2 neglects, from which the gates are derived.

use crate::constellation::Satellite;
use crate::earth::{J2, RADIUS_KM};
use crate::orbit::sgp4::ZonalHarmonics;
use crate::orbit::{MeanElements, osculating};
use crate::time::TimeGrid;
use crate::units::SECONDS_PER_DAY;
use std::f64::consts::TAU;

/// SGP4 adds the Sun, the Moon and resonances at periods from 225 minutes on (Hoots and
/// Roehrich, *Spacetrack Report* 3 (1980), section 6), which no J2 model has.
const DEEP_SPACE_PERIOD_S: f64 = 225.0 * 60.0;

/// -J3/J2 of WGS-72, the constants of SGP4 (Vallado et al., AIAA 2006-6753, table 1).
const J3_OVER_J2_WGS72: f64 = -::sgp4::WGS72.j3 / ::sgp4::WGS72.j2;

/// Factor by which a first-order closed form at e = 0 may be exceeded: terms of order e and J2, the
/// rotation of the frozen eccentricity in a day, and the sampling of the extremes.
pub(in crate::validate) const FIRST_ORDER_MARGIN: f64 = 1.15;

/// Secular rates that SGP4 has beyond first-order J2, rad/s ([M-46](crate::models#m-46)): Hoots and
/// Roehrich, *Spacetrack Report* 3 (1980), section 6, the terms of the node, of ω and of M in J2² and J4,
/// and what recovering the mean motion from Kozai's leaves of second order.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct SecularExcess {
    /// Of the node.
    node: f64,
    /// Of the argument of latitude, ω + M.
    latitude: f64,
}

impl SecularExcess {
    /// The terms of J2² and those of J4.
    fn of(orbit: &MeanElements) -> [Self; 2] {
        let eta2 = 1.0 - orbit.eccentricity * orbit.eccentricity;
        let ratio2 = (RADIUS_KM / (orbit.semi_major_axis_km * eta2)).powi(2);
        let n = orbit.kepler_mean_motion_rad_s();
        let c = orbit.inclination_rad.cos();
        let (c2, c4) = (c.powi(2), c.powi(4));
        let second = 0.75 * J2 * J2 * ratio2 * ratio2 * n;
        let perigee = 7.0 - 114.0 * c2 + 395.0 * c4;
        let anomaly = eta2.sqrt() * (13.0 - 78.0 * c2 + 137.0 * c4);
        // SGP4 unfolds the mean motion δ of its slot at a semi-major axis that is δ smaller: n (1 - 2 δ²).
        let slot = -2.0 * (0.75 * J2 * ratio2 * eta2.sqrt() * (3.0 * c2 - 1.0)).powi(2) * n;
        let fourth = -0.46875 * ::sgp4::WGS72.j4 * ratio2 * ratio2 * n;
        [
            Self {
                node: 0.5 * second * (4.0 - 19.0 * c2) * c,
                latitude: 0.0625 * second * (perigee + anomaly) + slot,
            },
            Self {
                node: 2.0 * fourth * (3.0 - 7.0 * c2) * c,
                latitude: fourth * (3.0 - 36.0 * c2 + 49.0 * c4),
            },
        ]
    }
}

/// Closed forms of the causes, for one orbit; all at e = 0 ([M-40](crate::models#m-40) to
/// [M-45](crate::models#m-45)).
#[derive(Debug, Clone, Copy)]
pub(in crate::validate) struct Causes {
    /// Constant shift of the radius, km.
    pub(in crate::validate) radius_shift_km: f64,
    /// Amplitudes of the short-period terms, km.
    pub(in crate::validate) short_period_km: [f64; 3],
    /// Amplitudes of the short-period terms of the node and of the argument of latitude, rad.
    short_period_rad: [f64; 2],
    /// Amplitude of the radial effect of the frozen eccentricity, km; in-track is twice that.
    pub(in crate::validate) frozen_km: f64,
    /// Bound on the in-track rate of second-order terms, km/day: a scale for what is of higher order.
    pub(in crate::validate) second_order_km_per_day: f64,
    /// Second-order secular rates of J2, and first-order ones of J4.
    secular: [SecularExcess; 2],
    /// Semi-major axis, km.
    a_km: f64,
    /// Sine and cosine of the inclination.
    inclination: [f64; 2],
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
            short_period_rad: [
                // 3/4 J2 (R/p)² |cos i|
                0.75 * J2 * ratio2 * cos_i.abs(),
                // 1/8 J2 (R/p)² |7 cos² i - 1|
                0.125 * J2 * ratio2 * (7.0 * cos_i * cos_i - 1.0).abs(),
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
            secular: SecularExcess::of(orbit),
            a_km: a,
            inclination: [sin_i, cos_i],
        }
    }

    /// Rates of the node and of ω + M beyond first-order J2, rad/s.
    pub(in crate::validate) fn excess_rad_s(&self, zonals: ZonalHarmonics) -> [f64; 2] {
        let [second, fourth] = self.secular;
        match zonals {
            ZonalHarmonics::J2Only => [second.node, second.latitude],
            ZonalHarmonics::Full | ZonalHarmonics::WithoutJ3 => {
                [second.node + fourth.node, second.latitude + fourth.latitude]
            }
        }
    }

    /// The same as drifts in-track, and cross-track at the largest, km/day.
    pub(in crate::validate) fn drifts_km_per_day(&self, zonals: ZonalHarmonics) -> [f64; 2] {
        let [node, latitude] = self.excess_rad_s(zonals);
        let [sin_i, cos_i] = self.inclination;
        [latitude + cos_i * node, sin_i * node].map(|rate| rate * self.a_km * SECONDS_PER_DAY)
    }

    /// Bounds on the RMS of mean J2 against SGP4 over a span, km.
    ///
    /// The mean square of a sine over samples is half that of its amplitude, plus what the samples leave of the mean of
    /// twice its frequency.
    pub(in crate::validate) fn rms_gates_km(
        &self,
        zonals: ZonalHarmonics,
        days: f64,
        leftover: Leftover,
    ) -> [f64; 3] {
        let [_, of_two, of_four] = leftover.mean;
        let frozen = match zonals {
            ZonalHarmonics::Full => self.frozen_km * (0.5 * (1.0 + of_two)).sqrt(),
            ZonalHarmonics::J2Only | ZonalHarmonics::WithoutJ3 => 0.0,
        };
        let of_twice = (0.5 * (1.0 + of_four)).sqrt();
        let periodic = self.short_period_km.map(|amplitude| amplitude * of_twice);
        // The shift of the radius and its periodic term do not average out either.
        let shift = self.radius_shift_km.abs();
        let both = 2.0 * shift * self.short_period_km[0] * of_two;
        let radial = (shift * shift + both).sqrt();
        let first_order = [
            radial.hypot(periodic[0]).hypot(frozen),
            periodic[1].hypot(2.0 * frozen),
            periodic[2],
        ];
        let [along, across] = self.drifts_km_per_day(zonals);
        // RMS of a ramp; across the track it swings with the argument of latitude.
        let ramp_days = days / 3_f64.sqrt();
        let swing = (0.5 * (1.0 + of_two)).sqrt();
        let second_order = [0.0, along * ramp_days, across * ramp_days * swing];
        std::array::from_fn(|axis| {
            let size = first_order[axis].hypot(second_order[axis]);
            FIRST_ORDER_MARGIN * self.eccentric_factor * size + HIGHER_ORDER_KM
        })
    }

    /// The bounds that remain when the short-period terms of J2 are propagated too.
    pub(in crate::validate) fn osculating_gates_km(
        &self,
        zonals: ZonalHarmonics,
        days: f64,
        leftover: Leftover,
    ) -> [f64; 3] {
        let mut without = *self;
        // First-order terms are accurate to a fraction J2 of their size, times a factor of a few.
        without.radius_shift_km = 3e-3 * self.radius_shift_km;
        without.short_period_km = self
            .short_period_km
            .map(|amplitude| 0.01 * amplitude + HIGHER_ORDER_KM);
        without.rms_gates_km(zonals, days, leftover)
    }

    /// What the closed forms at e = 0 leave out of a drift in-track: third order in J2, 2 % of the second,
    /// and second order times the eccentricity, km/day.
    pub(in crate::validate) fn third_order_km_per_day(&self) -> f64 {
        (self.eccentric_factor - 1.0 + 0.02) * self.second_order_km_per_day
    }

    /// Bound on the slope of the mean in-track difference minus its closed form, km/day: what is of higher
    /// order, and the slope left by the periodic terms, as fractions of the amplitudes at once and twice per
    /// revolution.
    pub(in crate::validate) fn growth_gate_km_per_day(
        &self,
        zonals: ZonalHarmonics,
        leftover: Leftover,
    ) -> f64 {
        let once = match zonals {
            ZonalHarmonics::Full => 2.0 * self.frozen_km,
            ZonalHarmonics::J2Only | ZonalHarmonics::WithoutJ3 => 0.0,
        };
        let twice = self.short_period_km[1];
        let [per_once, per_twice, _] = leftover.slope_per_day;
        let periodic = once * per_once + twice * per_twice;
        self.higher_order_km_per_day() + self.eccentric_factor * periodic
    }

    /// What the closed form of a drift in-track leaves out, km/day: third order in J2, the eccentricity, and the
    /// constants (5 m/day).
    pub(in crate::validate) fn higher_order_km_per_day(&self) -> f64 {
        self.third_order_km_per_day() + 0.01
    }

    /// Bounds on the slopes that the periodic terms leave in the node and in the argument of latitude, rad/day: the
    /// short-period terms of J2 ([M-41](crate::models#m-41)), and twice the frozen eccentricity in the latter.
    pub(in crate::validate) fn periodic_rates_rad_per_day(&self, leftover: Leftover) -> [f64; 2] {
        let [once, twice, _] = leftover.slope_per_day;
        let frozen = 2.0 * self.frozen_km / self.a_km * once;
        let [node, latitude] = self.short_period_rad;
        [node * twice, latitude * twice + frozen].map(|rate| self.eccentric_factor * rate)
    }
}

/// Sizes of second-order periodic terms, of SGP4's floor of the eccentricity (1e-6, 15 m in-track) and
/// of the difference of the gravity constants (5 m), km.
const HIGHER_ORDER_KM: f64 = 0.01;

/// What periodic terms leave in the mean over a constellation and over its samples, per unit of amplitude, for terms
/// with one, two and four periods per revolution.
#[derive(Debug, Clone, Copy)]
pub(in crate::validate) struct Leftover {
    /// Of the mean over the samples.
    pub(in crate::validate) mean: [f64; 3],
    /// Of the slope of the straight line through the samples, per day.
    pub(in crate::validate) slope_per_day: [f64; 3],
}

impl Leftover {
    /// Bounds in closed form ([M-41](crate::models#m-41)).
    pub(in crate::validate) fn of(satellites: &[Satellite], grid: TimeGrid) -> Self {
        let Some(first) = satellites.first() else {
            return Self {
                mean: [0.0; 3],
                slope_per_day: [0.0; 3],
            };
        };
        let span_s = grid.len() as f64 * grid.step_s();
        let n = first.elements.kepler_mean_motion_rad_s();
        let bounds = [1.0, 2.0, 4.0].map(|harmonic: f64| {
            let (mut sine, mut cosine) = (0.0, 0.0);
            for satellite in satellites {
                let angle = harmonic * satellite.elements.mean_argument_of_latitude_rad();
                let (s, c) = angle.sin_cos();
                (sine, cosine) = (sine + s, cosine + c);
            }
            let left = f64::hypot(sine, cosine) / satellites.len() as f64;
            // What the samples see of the frequency: with a step near the period it is close to zero.
            let seen_rad_s = 2.0 * (0.5 * harmonic * n * grid.step_s()).sin().abs() / grid.step_s();
            let radians = seen_rad_s * span_s;
            let slope = (12.0 / radians).min(radians) / (span_s / SECONDS_PER_DAY);
            [left * (2.0 / radians).min(1.0), left * slope]
        });
        Self {
            mean: bounds.map(|[mean, _]| mean),
            slope_per_day: bounds.map(|[_, slope]| slope),
        }
    }
}

/// Whether SGP4 uses its deep-space theory for an orbit.
pub(in crate::validate) fn is_deep_space(orbit: &MeanElements) -> bool {
    TAU / orbit.kepler_mean_motion_rad_s() >= DEEP_SPACE_PERIOD_S
}

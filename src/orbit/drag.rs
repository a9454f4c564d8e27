//! Circular orbits in the upper atmosphere: how fast they decay, and what it takes to stay or to leave.

use super::atmosphere::{ALTITUDES_KM, SolarActivity, mean_density_kg_m3};
use crate::earth::{GMST_RATE_RAD_S, MU_KM3_S2, RADIUS_KM};
use crate::units::{DAYS_PER_YEAR, SECONDS_PER_DAY};
use thiserror::Error;

/// Altitude at which a satellite is down, km: within a revolution it burns up.
pub const REENTRY_ALTITUDE_KM: f64 = 120.0;

/// Perigee of a deorbit, km: deep enough for the next revolution to end it.
pub const DEORBIT_PERIGEE_KM: f64 = 50.0;

/// Steps of the sum over altitude, km; the scale height is 6 km at the least.
const STEP_KM: f64 = 0.5;

/// Largest mass, kg, area, m², and drag coefficient that are accepted: those of a space station and beyond.
const MOST: [f64; 3] = [1e6, 1e5, 100.0];

/// Why there is no drag to compute.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum DragError {
    /// A mass, an area or a coefficient that is none.
    #[error("{what} must be above 0 and at most {most}, not {found}")]
    Spacecraft {
        /// What is wrong.
        what: &'static str,
        /// The greatest that is accepted.
        most: f64,
        /// As given.
        found: f64,
    },
    /// Below re-entry.
    #[error(
        "an altitude of {altitude_km} km is in the atmosphere: a circular orbit must be above {REENTRY_ALTITUDE_KM} km"
    )]
    InTheAtmosphere {
        /// The altitude, km.
        altitude_km: f64,
    },
}

/// A satellite as the air sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DragSpacecraft {
    ballistic_m2_kg: f64,
}

impl DragSpacecraft {
    /// Of a mass in kg, an area across the track in m², and a drag coefficient.
    ///
    /// # Errors
    /// If one of them is not above 0, or beyond all satellites.
    pub fn new(mass_kg: f64, area_m2: f64, drag_coefficient: f64) -> Result<Self, DragError> {
        for (what, found, most) in [
            ("the mass in kg", mass_kg, MOST[0]),
            ("the area in m²", area_m2, MOST[1]),
            ("the drag coefficient", drag_coefficient, MOST[2]),
        ] {
            if !(found > 0.0 && found <= most) {
                return Err(DragError::Spacecraft { what, most, found });
            }
        }
        Ok(Self {
            ballistic_m2_kg: drag_coefficient * area_m2 / mass_kg,
        })
    }

    /// Drag coefficient times area by mass, m²/kg.
    #[must_use]
    pub fn ballistic_m2_kg(&self) -> f64 {
        self.ballistic_m2_kg
    }
}

/// A satellite on a circular orbit in the mean atmosphere of a solar activity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DragOrbit {
    altitude_km: f64,
    inclination_rad: f64,
    spacecraft: DragSpacecraft,
    activity: SolarActivity,
}

/// How a slot is kept against drag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotKeeping {
    /// Between manoeuvres, days.
    pub interval_days: f64,
    /// Of each, m/s.
    pub delta_v_m_s: f64,
}

impl DragOrbit {
    /// At an altitude over the equatorial radius.
    ///
    /// # Errors
    /// Below [`REENTRY_ALTITUDE_KM`].
    pub fn new(
        altitude_km: f64,
        inclination_rad: f64,
        spacecraft: DragSpacecraft,
        activity: SolarActivity,
    ) -> Result<Self, DragError> {
        if altitude_km > REENTRY_ALTITUDE_KM {
            Ok(Self {
                altitude_km,
                inclination_rad,
                spacecraft,
                activity,
            })
        } else {
            Err(DragError::InTheAtmosphere { altitude_km })
        }
    }

    /// Mean density, kg/m³; `None` above the tabulated atmosphere.
    #[must_use]
    pub fn density_kg_m3(&self) -> Option<f64> {
        mean_density_kg_m3(self.altitude_km, self.activity)
    }

    /// How fast the altitude falls, m/s ([M-69](crate::models#m-69)); `None` above the tabulated atmosphere.
    #[must_use]
    pub fn decay_m_s(&self) -> Option<f64> {
        self.decay_at_m_s(self.altitude_km)
    }

    fn decay_at_m_s(&self, altitude_km: f64) -> Option<f64> {
        let density = mean_density_kg_m3(altitude_km, self.activity)?;
        let a_km = RADIUS_KM + altitude_km;
        let root = (MU_KM3_S2 * a_km).sqrt() * 1e6;
        let speed_km_s = (MU_KM3_S2 / a_km).sqrt();
        // The air turns with the Earth: King-Hele's factor F.
        let turning = 1.0 - a_km * GMST_RATE_RAD_S * self.inclination_rad.cos() / speed_km_s;
        Some(density * self.spacecraft.ballistic_m2_kg * root * turning * turning)
    }

    /// Years from here down to another altitude without control; `None` from above the tabulated atmosphere.
    #[must_use]
    pub fn years_down_to(&self, altitude_km: f64) -> Option<f64> {
        let span_km = self.altitude_km - altitude_km;
        if span_km <= 0.0 {
            return Some(0.0);
        }
        let steps = (span_km / STEP_KM).ceil();
        let width_km = span_km / steps;
        let mut seconds = 0.0;
        let mut middle_km = altitude_km + width_km / 2.0;
        while middle_km < self.altitude_km {
            seconds += width_km * 1e3 / self.decay_at_m_s(middle_km)?;
            middle_km += width_km;
        }
        Some(seconds / (SECONDS_PER_DAY * DAYS_PER_YEAR))
    }

    /// The highest altitude up to here from which it comes down within `years`, km; `None` from above the tabulated atmosphere.
    #[must_use]
    pub fn altitude_of_decay_within_km(&self, years: f64) -> Option<f64> {
        let down_from = |altitude_km: f64| {
            Self {
                altitude_km,
                ..*self
            }
            .years_down_to(REENTRY_ALTITUDE_KM)
        };
        let top_km = self.altitude_km.min(ALTITUDES_KM[1]);
        let (mut low, mut high) = (REENTRY_ALTITUDE_KM, top_km);
        if down_from(high)? <= years {
            return Some(high);
        }
        // To 0.1 km; the altitude is not known so well.
        while high - low > 0.1 {
            let middle = (low + high) / 2.0;
            if down_from(middle)? <= years {
                low = middle;
            } else {
                high = middle;
            }
        }
        Some(low)
    }

    /// What making up for drag takes in a year, m/s: the speed v/(2a) for each metre of altitude.
    #[must_use]
    pub fn make_up_m_s_per_year(&self) -> Option<f64> {
        let seconds = SECONDS_PER_DAY * DAYS_PER_YEAR;
        Some(self.speed_per_metre() * self.decay_m_s()? * seconds)
    }

    /// Manoeuvres that keep a satellite within `half_width_km` along the track of its slot ([M-69](crate::models#m-69)).
    #[must_use]
    pub fn slot_keeping(&self, half_width_km: f64) -> Option<SlotKeeping> {
        let decay_m_s = self.decay_m_s()?;
        let a_km = RADIUS_KM + self.altitude_km;
        let mean_motion = (MU_KM3_S2 / a_km.powi(3)).sqrt();
        // Along the track it accelerates by 3/2 n |da/dt|, from one end of the box to the other and back.
        let interval_s = 4.0 * (half_width_km * 1e3 / (1.5 * mean_motion * decay_m_s)).sqrt();
        Some(SlotKeeping {
            interval_days: interval_s / SECONDS_PER_DAY,
            delta_v_m_s: self.speed_per_metre() * decay_m_s * interval_s,
        })
    }

    fn speed_per_metre(&self) -> f64 {
        let a_km = RADIUS_KM + self.altitude_km;
        (MU_KM3_S2 / a_km).sqrt() * 1e3 / (2.0 * a_km * 1e3)
    }
}

/// What lowering the perigee of a circular orbit to another altitude takes, m/s.
#[must_use]
pub fn perigee_lowering_m_s(altitude_km: f64, perigee_km: f64) -> f64 {
    let [high, low] = [altitude_km, perigee_km].map(|km| RADIUS_KM + km);
    let speed_m_s = (MU_KM3_S2 / high).sqrt() * 1e3;
    speed_m_s * (1.0 - (2.0 * low / (high + low)).sqrt())
}

/// What a Hohmann transfer between circular orbits takes, m/s.
#[must_use]
pub fn hohmann_m_s(from_km: f64, to_km: f64) -> f64 {
    let [from, to] = [from_km, to_km].map(|km| RADIUS_KM + km);
    let first = (MU_KM3_S2 / from).sqrt() * ((2.0 * to / (from + to)).sqrt() - 1.0);
    let second = (MU_KM3_S2 / to).sqrt() * (1.0 - (2.0 * from / (from + to)).sqrt());
    (first.abs() + second.abs()) * 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orbit(altitude_km: f64, inclination_deg: f64, activity: SolarActivity) -> DragOrbit {
        let spacecraft = DragSpacecraft::new(200.0, 2.0, 2.2).unwrap();
        DragOrbit::new(
            altitude_km,
            inclination_deg.to_radians(),
            spacecraft,
            activity,
        )
        .unwrap()
    }

    /// Integrations over 7 days from 2025-01-01 at 925 km by brahe 1.8.0 with NRLMSISE-00 (`validation/reports/full-force.md`, 200 kg,
    /// 2 m², 2.2), the mean of two satellites: offsets of the semi-major axis fitted to the drift along the track, m. A steady decay drifts with the square of
    /// time, of which a line takes the offset at half the span.
    #[test]
    fn validate_decay_by_integration() {
        use SolarActivity::{High, Low};
        for (inclination_deg, activity, offset_m) in [
            (40.0, Low, 0.359),
            (40.0, High, 12.613),
            (55.0, Low, 0.385),
            (55.0, High, 12.800),
            (90.0, Low, 0.411),
            (90.0, High, 13.197),
        ] {
            let integrated = offset_m * 2.0 / (7.0 * SECONDS_PER_DAY);
            let ratio = orbit(925.0, inclination_deg, activity).decay_m_s().unwrap() / integrated;
            // A week in one plane against the mean of the year, which revolutions are 0.54 to 1.46 times of. Another activity
            // is off by a factor of 4 or more.
            assert!(
                (1.0 / 1.46..1.0 / 0.54).contains(&ratio),
                "{inclination_deg} {activity}: {ratio}"
            );
        }
    }

    /// In an atmosphere of one scale height H, a circular orbit comes down in H/(ρ (C_D A/m) sqrt(μ a)) (King-Hele, *Satellite
    /// Orbits in an Atmosphere*, 1987, chapter 4, to first order in H/a).
    #[test]
    fn validate_decay_time_against_the_exponential_atmosphere() {
        use SolarActivity::Moderate;
        // Between 580 and 600 km the table is exponential; the time down these 20 km is that to the ground of either less.
        let [high, low] = [600.0, 580.0].map(|km| orbit(km, 90.0, Moderate));
        let [top, bottom] = [high, low].map(|of| of.density_kg_m3().unwrap());
        let scale_m = 20e3 / (bottom / top).ln();
        let time = |of: DragOrbit| scale_m / of.decay_m_s().unwrap();
        let expected = (time(high) - time(low)) / (SECONDS_PER_DAY * DAYS_PER_YEAR);
        let found = high.years_down_to(580.0).unwrap();
        // sqrt(a) changes by 0.14 % over the span, 0.5 % of the difference of the two times.
        assert!((found / expected - 1.0).abs() < 6e-3, "{found} {expected}");
    }

    /// By the vis-viva equation.
    #[test]
    fn validate_transfers_by_energy() {
        let speed = |r: f64, a: f64| (MU_KM3_S2 * (2.0 / r - 1.0 / a)).sqrt() * 1e3;
        let (high, low) = (RADIUS_KM + 925.0, RADIUS_KM + 50.0);
        let transfer = (high + low) / 2.0;
        let lowering = speed(high, high) - speed(high, transfer);
        assert!((perigee_lowering_m_s(925.0, 50.0) - lowering).abs() < 1e-9);
        let whole = lowering + speed(low, transfer) - speed(low, low);
        assert!((hohmann_m_s(925.0, 50.0) - whole).abs() < 1e-9);
        assert!((hohmann_m_s(50.0, 925.0) - whole).abs() < 1e-9);
    }

    /// A box of ±D: simulated drift from one end to the other and back under constant decay.
    #[test]
    fn validate_slot_keeping_by_simulated_drift() {
        let orbit = orbit(550.0, 53.0, SolarActivity::Moderate);
        let keeping = orbit.slot_keeping(5.0).unwrap();
        let decay = orbit.decay_m_s().unwrap();
        let mean_motion = (MU_KM3_S2 / (RADIUS_KM + 550.0).powi(3)).sqrt();
        let interval_s = keeping.interval_days * SECONDS_PER_DAY;
        // The manoeuvre raises the orbit by what is lost until the next one.
        let (mut offset_m, mut place_m, mut range_m) =
            (decay * interval_s / 2.0, 0.0, [0.0_f64; 2]);
        let steps = 100_000;
        for _ in 0..steps {
            let step_s = interval_s / f64::from(steps);
            place_m -= 1.5 * mean_motion * (offset_m - decay * step_s / 2.0) * step_s;
            offset_m -= decay * step_s;
            range_m = [range_m[0].min(place_m), range_m[1].max(place_m)];
        }
        assert!(place_m.abs() < 1e-3, "{place_m}");
        assert!((range_m[1] - range_m[0] - 10e3).abs() < 1e-3, "{range_m:?}");
        let year = keeping.delta_v_m_s * DAYS_PER_YEAR / keeping.interval_days;
        assert!((year / orbit.make_up_m_s_per_year().unwrap() - 1.0).abs() < 1e-12);
    }

    #[test]
    fn limits_are_told() {
        for (spacecraft, what) in [
            ([0.0, 2.0, 2.2], "mass"),
            ([200.0, f64::NAN, 2.2], "area"),
            ([200.0, 2.0, -1.0], "coefficient"),
        ] {
            let [mass, area, coefficient] = spacecraft;
            let error = DragSpacecraft::new(mass, area, coefficient).unwrap_err();
            assert!(error.to_string().contains(what), "{error}");
        }
        let spacecraft = DragSpacecraft::new(200.0, 2.0, 2.2).unwrap();
        assert!(DragOrbit::new(120.0, 1.0, spacecraft, SolarActivity::Low).is_err());
        let high = orbit(1600.0, 55.0, SolarActivity::Low);
        assert_eq!(high.decay_m_s(), None);
        assert_eq!(high.years_down_to(120.0), None);
        let low = orbit(300.0, 55.0, SolarActivity::High);
        assert_eq!(low.altitude_of_decay_within_km(5.0), Some(300.0));
        let within = orbit(925.0, 55.0, SolarActivity::Moderate);
        let altitude_km = within.altitude_of_decay_within_km(5.0).unwrap();
        let years = |km: f64| {
            orbit(km, 55.0, SolarActivity::Moderate)
                .years_down_to(REENTRY_ALTITUDE_KM)
                .unwrap()
        };
        assert!(years(altitude_km) <= 5.0 && years(altitude_km + 0.2) > 5.0);
    }
}

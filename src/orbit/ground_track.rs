//! The ground track of an orbit under secular J2: when it repeats, and which orbits follow the Sun.

use super::MeanElements;
use super::j2::SecularRates;
use crate::earth::{GMST_RATE_RAD_S, J2, MEAN_SUN_RATE_RAD_S, RADIUS_KM};
use std::f64::consts::TAU;

/// Steps of the semi-major axis to that of an exact repeat: each leaves a few thousandths of the error.
const STEPS: usize = 12;

/// The time from node to node, and that of the Earth below the plane ([M-62](crate::models#m-62)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundTrack {
    /// From one ascending node to the next, s.
    pub nodal_period_s: f64,
    /// A turn of the Earth as seen from the orbital plane, s.
    pub nodal_day_s: f64,
}

/// A whole number of revolutions in a whole number of nodal days.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TrackRepeat {
    /// Nodal days.
    pub days: u32,
    /// Revolutions in this time.
    pub revolutions: u32,
    /// The distance after this time from the first ascending node to the one that returns, along the equator and positive
    /// to the east, km.
    pub miss_km: f64,
    /// Altitude over the equatorial radius at which the track repeats exactly, with the same eccentricity and inclination;
    /// `None` if its perigee is below the ground. km.
    pub altitude_km: Option<f64>,
}

impl GroundTrack {
    /// The ground track of an orbit.
    #[must_use]
    pub fn of(elements: &MeanElements) -> Self {
        let rates = SecularRates::j2(elements);
        Self {
            nodal_period_s: TAU / rates.arg_latitude_rad_s(),
            nodal_day_s: TAU / (GMST_RATE_RAD_S - rates.raan_rad_s),
        }
    }

    /// Revolutions in a nodal day.
    #[must_use]
    pub fn revolutions_per_day(&self) -> f64 {
        self.nodal_day_s / self.nodal_period_s
    }

    /// How much further east each ascending node is than the one before, degrees; negative to the west.
    #[must_use]
    pub fn node_step_deg(&self) -> f64 {
        -360.0 / self.revolutions_per_day()
    }
}

/// The repeats of a ground track in at most so many nodal days: each misses the first node by less than all that are
/// shorter.
#[must_use]
pub fn track_repeats(elements: &MeanElements, most_days: u32) -> Vec<TrackRepeat> {
    let per_day = GroundTrack::of(elements).revolutions_per_day();
    let mut found: Vec<TrackRepeat> = Vec::new();
    for days in 1..=most_days {
        let revolutions = (per_day * f64::from(days)).round();
        if revolutions < 1.0 {
            continue;
        }
        let miss_km = TAU * RADIUS_KM * (f64::from(days) - revolutions / per_day);
        if found
            .last()
            .is_some_and(|best| miss_km.abs() >= best.miss_km.abs())
        {
            continue;
        }
        found.push(TrackRepeat {
            days,
            // Below the 17 revolutions a day of the lowest orbit.
            revolutions: revolutions as u32,
            miss_km,
            altitude_km: repeating_altitude_km(elements, revolutions / f64::from(days)),
        });
    }
    found
}

/// The altitude at which an orbit makes so many revolutions in a nodal day.
pub(super) fn repeating_altitude_km(elements: &MeanElements, per_day: f64) -> Option<f64> {
    let mut orbit = *elements;
    for _ in 0..STEPS {
        // Revolutions go with the power -3/2 of the semi-major axis, but for J2.
        let now = GroundTrack::of(&orbit).revolutions_per_day();
        orbit.semi_major_axis_km *= (now / per_day).powf(2.0 / 3.0);
    }
    let perigee_km = orbit.semi_major_axis_km * (1.0 - orbit.eccentricity);
    (perigee_km > RADIUS_KM).then_some(orbit.semi_major_axis_km - RADIUS_KM)
}

/// The inclination at which the node of an orbit of this size and shape follows the mean Sun
/// ([M-63](crate::models#m-63)), degrees; `None` above the altitude of some 6000 km up to which there is one.
#[must_use]
pub fn sun_synchronous_inclination_deg(elements: &MeanElements) -> Option<f64> {
    let parameter_km =
        elements.semi_major_axis_km * (1.0 - elements.eccentricity * elements.eccentricity);
    let polar_rate =
        1.5 * J2 * (RADIUS_KM / parameter_km).powi(2) * elements.kepler_mean_motion_rad_s();
    let cosine = -MEAN_SUN_RATE_RAD_S / polar_rate;
    (cosine >= -1.0).then(|| cosine.acos().to_degrees())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn circular(semi_major_axis_km: f64, inclination_deg: f64) -> MeanElements {
        MeanElements {
            semi_major_axis_km,
            eccentricity: 0.0,
            inclination_rad: inclination_deg.to_radians(),
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        }
    }

    /// cos i = -Ω'/(3/2 J2 (R/a)² n) worked out in Python with the same constants, to the last digit given.
    #[test]
    fn validate_sun_synchronous_inclinations() {
        for (altitude_km, inclination_deg) in [(500.0, 97.4018), (800.0, 98.6031), (925.0, 99.1434)]
        {
            let orbit = circular(RADIUS_KM + altitude_km, 0.0);
            let ours = sun_synchronous_inclination_deg(&orbit).unwrap();
            assert!(
                (ours - inclination_deg).abs() < 5e-5,
                "{altitude_km}: {ours}"
            );
            // The rate of the propagator at that inclination is the Sun's.
            let rate = SecularRates::j2(&circular(orbit.semi_major_axis_km, ours)).raan_rad_s;
            assert!((rate / MEAN_SUN_RATE_RAD_S - 1.0).abs() < 1e-12, "{rate:e}");
        }
        assert_eq!(
            sun_synchronous_inclination_deg(&circular(13_000.0, 0.0)),
            None
        );
    }

    /// TOPEX/Poseidon repeats 127 revolutions in 10 nodal days; its reference orbit has a = 7714.42938 km and
    /// i = 66.0408° (Bhat, Shapiro, Frauenholz and Leavitt 1998). J4, J2² and the other harmonics, which secular J2
    /// leaves out, are some 1e-5 of the period: 4 km of ground track in 10 days, and 0.05 km of altitude.
    #[test]
    fn validate_the_repeat_of_topex() {
        let orbit = circular(7_714.429_38, 66.040_8);
        let repeats = track_repeats(&orbit, 15);
        let best = repeats.last().unwrap();
        assert_eq!((best.days, best.revolutions), (10, 127));
        assert!(best.miss_km.abs() < 4.0, "{best:?}");
        let altitude_km = 7_714.429_38 - RADIUS_KM;
        assert!(
            (best.altitude_km.unwrap() - altitude_km).abs() < 0.05,
            "{best:?}"
        );
    }

    #[test]
    fn an_exact_repeat_misses_by_nothing() {
        let near = circular(RADIUS_KM + 700.0, 98.2);
        let repeats = track_repeats(&near, 20);
        assert!(
            repeats
                .windows(2)
                .all(|two| two[1].miss_km.abs() < two[0].miss_km.abs())
        );
        for repeat in repeats {
            let exact = circular(RADIUS_KM + repeat.altitude_km.unwrap(), 98.2);
            let again = track_repeats(&exact, repeat.days);
            let last = again.last().unwrap();
            assert_eq!(
                (last.days, last.revolutions),
                (repeat.days, repeat.revolutions)
            );
            assert!(last.miss_km.abs() < 1e-6, "{last:?}");
        }
        // The node moves east where a revolution is shorter than a turn of the plane would need.
        assert!(GroundTrack::of(&near).node_step_deg() < -24.0);
    }

    /// The nodal period of a satellite that is propagated: its latitude is zero again, northwards.
    #[test]
    fn validate_the_nodal_period_against_the_propagator() {
        let orbit = circular(RADIUS_KM + 925.0, 55.0);
        let track = GroundTrack::of(&orbit);
        let propagated = crate::orbit::j2::SecularOrbit::j2(&orbit);
        let state = propagated.state(track.nodal_period_s);
        assert!(state.position_km.km().z.abs() < 1e-6);
        assert!(state.velocity_km_s.z > 0.0);
    }
}

//! SGP4 in AFSPC mode (WGS-72), by the `sgp4` crate, from mean elements or from element sets.

use super::earth_orbit::check_inertial;
use super::j2::SecularRates;
use super::{MeanElements, PropagationError, Propagator};
use crate::earth::{J2, MU_KM3_S2, RADIUS_KM};
use crate::frames::{State, Teme};
use crate::time::Epoch;
use crate::units::{MINUTES_PER_DAY, wrap_two_pi};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// The content of the mean motion field of an SGP4 element set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeanMotionSlot {
    /// dM/dt of secular J2, which is Kozai's mean motion to first order: the right one
    /// ([M-11](crate::models#m-11)).
    Kozai,
    /// sqrt(μ/a³), a common mistake; up to 400 km/day in-track.
    Kepler,
}

/// Which zonal harmonics SGP4 includes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZonalHarmonics {
    /// J2, J3 and J4 of WGS-72.
    Full,
    /// J2 alone: J3 = J4 = 0.
    J2Only,
    /// J2 and J4: J3 = 0.
    WithoutJ3,
}

impl ZonalHarmonics {
    /// The constants of WGS-72 with these harmonics.
    #[must_use]
    pub fn wgs72(self) -> ::sgp4::Geopotential {
        let full = ::sgp4::WGS72;
        match self {
            Self::Full => full,
            Self::J2Only => ::sgp4::Geopotential {
                j3: 0.0,
                j4: 0.0,
                ..full
            },
            Self::WithoutJ3 => ::sgp4::Geopotential { j3: 0.0, ..full },
        }
    }
}

/// The two ways in which SGP4 is run (Vallado et al., AIAA 2006-6753, section II).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sgp4Mode {
    /// As run by the United States Space Force; the mode that element sets are made for.
    Afspc,
    /// With the corrections of AIAA 2006-6753: another sidereal time, and a continuous Lyddane choice.
    Improved,
}

impl Sgp4Mode {
    fn sidereal_time(self) -> fn(f64) -> f64 {
        match self {
            Self::Afspc => ::sgp4::afspc_epoch_to_sidereal_time,
            Self::Improved => ::sgp4::iau_epoch_to_sidereal_time,
        }
    }

    fn years_since_j2000(self, epoch: &chrono::NaiveDateTime) -> f64 {
        match self {
            Self::Afspc => ::sgp4::julian_years_since_j2000_afspc_compatibility_mode(epoch),
            Self::Improved => ::sgp4::julian_years_since_j2000(epoch),
        }
    }
}

/// Settings of SGP4.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sgp4Theory {
    /// The constants.
    pub geopotential: ::sgp4::Geopotential,
    /// The mode.
    pub mode: Sgp4Mode,
}

impl Sgp4Theory {
    /// What element sets are made for: WGS-72, AFSPC mode.
    pub const STANDARD: Self = Self {
        geopotential: ::sgp4::WGS72,
        mode: Sgp4Mode::Afspc,
    };

    /// SGP4 with this library's μ, R and J2 instead of those of WGS-72: not an SGP4 for element sets, but
    /// it isolates the effect of the constants.
    #[must_use]
    pub fn with_design_constants() -> Self {
        Self {
            geopotential: ::sgp4::Geopotential {
                ae: RADIUS_KM,
                // k_e = sqrt(μ) in Earth radii^1.5 per minute
                ke: 60.0 * (MU_KM3_S2 / RADIUS_KM.powi(3)).sqrt(),
                j2: J2,
                ..::sgp4::WGS72
            },
            ..Self::STANDARD
        }
    }
}

impl MeanMotionSlot {
    /// The mean motion in an element set of `elements`, rad/s.
    #[must_use]
    pub fn mean_motion_rad_s(self, elements: &MeanElements) -> f64 {
        match self {
            Self::Kozai => SecularRates::j2(elements).mean_anomaly_rad_s,
            Self::Kepler => elements.kepler_mean_motion_rad_s(),
        }
    }

    /// The same in revolutions per day, the unit of a TLE and an OMM.
    #[must_use]
    pub fn mean_motion_rev_day(self, elements: &MeanElements) -> f64 {
        self.mean_motion_rad_s(elements) * 60.0 * MINUTES_PER_DAY / TAU
    }
}

/// A satellite propagated by SGP4.
#[derive(Debug, Clone)]
pub struct Sgp4Orbit {
    constants: ::sgp4::Constants,
    mode: Sgp4Mode,
    /// Equatorial radius of the theory, km; below it an orbit has decayed.
    least_km: f64,
    /// Epoch of the set.
    epoch: Epoch,
    /// Seconds from the time origin of [`Propagator::state_at`] to the epoch of the set.
    epoch_offset_s: f64,
}

impl Sgp4Orbit {
    /// SGP4 without drag from unrounded mean elements at `epoch`.
    ///
    /// # Errors
    /// If SGP4 rejects the elements.
    pub fn from_mean_elements(
        elements: &MeanElements,
        epoch: Epoch,
        slot: MeanMotionSlot,
        zonals: ZonalHarmonics,
    ) -> Result<Self, PropagationError> {
        let theory = Sgp4Theory {
            geopotential: zonals.wgs72(),
            ..Sgp4Theory::STANDARD
        };
        Self::from_mean_elements_with(elements, epoch, slot, theory)
    }

    /// The same with any variant of SGP4.
    ///
    /// # Errors
    /// If SGP4 rejects the elements.
    pub fn from_mean_elements_with(
        elements: &MeanElements,
        epoch: Epoch,
        slot: MeanMotionSlot,
        theory: Sgp4Theory,
    ) -> Result<Self, PropagationError> {
        let orbit = ::sgp4::Orbit::from_kozai_elements(
            &theory.geopotential,
            elements.inclination_rad,
            wrap_two_pi(elements.raan_rad),
            elements.eccentricity,
            wrap_two_pi(elements.arg_perigee_rad),
            wrap_two_pi(elements.mean_anomaly_rad),
            slot.mean_motion_rad_s(elements) * 60.0,
        )
        .map_err(refused)?;
        Self::new(orbit, epoch, 0.0, theory, 0.0)
    }

    /// SGP4 from an element set as read from a file; time runs from `origin`.
    ///
    /// # Errors
    /// If SGP4 rejects the elements.
    pub fn from_element_set(
        set: &::sgp4::Elements,
        origin: Epoch,
    ) -> Result<Self, PropagationError> {
        Self::from_element_set_with(set, origin, Sgp4Theory::STANDARD)
    }

    /// The same with any variant of SGP4.
    ///
    /// # Errors
    /// If SGP4 rejects the elements.
    pub fn from_element_set_with(
        set: &::sgp4::Elements,
        origin: Epoch,
        theory: Sgp4Theory,
    ) -> Result<Self, PropagationError> {
        let orbit = ::sgp4::Orbit::from_kozai_elements(
            &theory.geopotential,
            set.inclination.to_radians(),
            set.right_ascension.to_radians(),
            set.eccentricity,
            set.argument_of_perigee.to_radians(),
            set.mean_anomaly.to_radians(),
            set.mean_motion * TAU / MINUTES_PER_DAY,
        )
        .map_err(refused)?;
        let epoch = Epoch::from_utc(set.datetime.and_utc());
        let epoch_offset_s = epoch.seconds_since(origin);
        Self::new(orbit, epoch, set.drag_term, theory, epoch_offset_s)
    }

    fn new(
        orbit: ::sgp4::Orbit,
        epoch: Epoch,
        drag_term: f64,
        theory: Sgp4Theory,
        epoch_offset_s: f64,
    ) -> Result<Self, PropagationError> {
        let constants = ::sgp4::Constants::new(
            theory.geopotential,
            theory.mode.sidereal_time(),
            theory.mode.years_since_j2000(&epoch.utc().naive_utc()),
            drag_term,
            orbit,
        )
        .map_err(refused)?;
        Ok(Self {
            constants,
            mode: theory.mode,
            least_km: theory.geopotential.ae,
            epoch,
            epoch_offset_s,
        })
    }

    /// The same satellite with a time origin that is `seconds` later.
    #[must_use]
    pub fn with_origin_moved(&self, seconds: f64) -> Self {
        Self {
            constants: self.constants.clone(),
            mode: self.mode,
            least_km: self.least_km,
            epoch: self.epoch,
            epoch_offset_s: self.epoch_offset_s - seconds,
        }
    }
}

fn refused(error: impl std::fmt::Display) -> PropagationError {
    PropagationError::Sgp4Elements {
        reason: error.to_string(),
    }
}

impl Propagator for Sgp4Orbit {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let since_epoch_s = elapsed_s - self.epoch_offset_s;
        let minutes = ::sgp4::MinutesSinceEpoch(since_epoch_s / 60.0);
        let at = || self.epoch.plus_seconds(since_epoch_s);
        let prediction = match self.mode {
            Sgp4Mode::Afspc => self.constants.propagate_afspc_compatibility_mode(minutes),
            Sgp4Mode::Improved => self.constants.propagate(minutes),
        };
        let prediction = prediction.map_err(|error| PropagationError::Sgp4State {
            at: at(),
            reason: error.to_string(),
        })?;
        let position_km = Vector3::from(prediction.position);
        let radius_km = position_km.norm();
        // Error 6 of the authors' code, which the crate leaves to the caller.
        if radius_km < self.least_km {
            return Err(PropagationError::Decayed {
                at: at(),
                radius_km,
                least_km: self.least_km,
            });
        }
        let velocity_km_s = Vector3::from(prediction.velocity);
        check_inertial(&position_km, &velocity_km_s)
            .map_err(|problem| PropagationError::Implausible { at: at(), problem })?;
        Ok(State::new(position_km, velocity_km_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Case 00005 of the AIAA 2006-6753 verification set (SGP4-VER.TLE, tcppver.out): an
    /// eccentric near-Earth orbit, states at 0 and 360 minutes.
    const VANGUARD: (&str, &str) = (
        "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753",
        "2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667",
    );

    /// Set 29141 of the same list, which decays 440 minutes after its epoch (error 6 of the authors'
    /// code); its last printed state, at 420 minutes, is 4.5 km above the radius.
    #[test]
    fn validate_a_published_decay() {
        let set = ::sgp4::Elements::from_tle(
            None,
            b"1 29141U 85108AA  06170.26783845  .99999999  00000-0  13519-0 0   718",
            b"2 29141  82.4288 273.4882 0015848 277.2124  83.9133 15.93343074  6828",
        )
        .unwrap();
        let epoch = Epoch::from_utc(set.datetime.and_utc());
        let orbit = Sgp4Orbit::from_element_set(&set, epoch).unwrap();
        assert!(orbit.state_at(420.0 * 60.0).is_ok());
        let error = orbit.state_at(440.0 * 60.0).unwrap_err();
        let decayed = epoch.plus_seconds(26_400.0);
        assert!(
            matches!(error, PropagationError::Decayed { at, .. } if at == decayed),
            "{error}"
        );
    }

    /// The constants of designs are close to those of WGS-84 in the crate, whose unit of k_e they have: k_e goes with √μ, and
    /// the two values of μ differ by 1.5e-7.
    #[test]
    fn validate_the_design_constants() {
        let own = Sgp4Theory::with_design_constants();
        let (ours, theirs) = (own.geopotential, ::sgp4::WGS84);
        assert_eq!(ours.ae, theirs.ae);
        assert!((ours.ke / theirs.ke - 1.0).abs() < 0.8e-7, "{}", ours.ke);
        // EGM96 and WGS-84 differ by 3.1e-6 of J2; J3 and J4 are those of SGP4.
        assert!((ours.j2 / theirs.j2 - 1.0).abs() < 3.2e-6, "{}", ours.j2);
        assert_eq!((ours.j3, ours.j4), (::sgp4::WGS72.j3, ::sgp4::WGS72.j4));
        assert_eq!(own.mode, Sgp4Theory::STANDARD.mode);
    }

    #[test]
    fn validate_a_published_verification_case() {
        let set =
            ::sgp4::Elements::from_tle(None, VANGUARD.0.as_bytes(), VANGUARD.1.as_bytes()).unwrap();
        let orbit =
            Sgp4Orbit::from_element_set(&set, Epoch::from_utc(set.datetime.and_utc())).unwrap();
        let cases = [
            (
                0.0,
                [7022.46529266, -1400.08296755, 0.03995155],
                [1.893841015, 6.405893759, 4.534807250],
            ),
            (
                360.0,
                [-7154.03120202, -3783.17682504, -3536.19412294],
                [4.741887409, -4.151817765, -2.093935425],
            ),
        ];
        for (minutes, position, velocity) in cases {
            let state = orbit.state_at(minutes * 60.0).unwrap();
            // The list prints 1e-8 km and 1e-9 km/s; the epoch in doubles adds a little.
            assert!(
                (state.position_km.km() - Vector3::from(position)).norm() < 2e-8,
                "{minutes}"
            );
            assert!(
                (state.velocity_km_s - Vector3::from(velocity)).norm() < 2e-9,
                "{minutes}"
            );
        }
    }

    /// From noon before the leap second of 2016-12-31 to the midnight after it are 43 201 s.
    #[test]
    fn minutes_are_of_si_seconds_over_a_leap_second() {
        let utc = |text: &str| Epoch::from_utc(text.parse().unwrap());
        let (noon, midnight) = (utc("2016-12-31T12:00:00Z"), utc("2017-01-01T00:00:00Z"));
        let mut set =
            ::sgp4::Elements::from_tle(None, VANGUARD.0.as_bytes(), VANGUARD.1.as_bytes()).unwrap();
        set.datetime = noon.utc().naive_utc();
        let state = |origin, elapsed_s| {
            let orbit = Sgp4Orbit::from_element_set(&set, origin).unwrap();
            orbit.state_at(elapsed_s).unwrap()
        };
        assert_eq!(state(midnight, 0.0), state(noon, 43_201.0));
    }

    #[test]
    fn refusals_are_errors() {
        let elements = MeanElements {
            semi_major_axis_km: 7000.0,
            eccentricity: 1.5,
            inclination_rad: 1.0,
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        };
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let result = Sgp4Orbit::from_mean_elements(
            &elements,
            epoch,
            MeanMotionSlot::Kepler,
            ZonalHarmonics::Full,
        );
        assert!(matches!(result, Err(PropagationError::Sgp4Elements { .. })));
    }

    /// The naive mean motion equals the right one only where 3 sin² i = 2.
    #[test]
    fn slots_agree_only_near_54_7_degrees() {
        let at = |deg: f64| MeanElements {
            semi_major_axis_km: 7303.137,
            eccentricity: 0.0,
            inclination_rad: deg.to_radians(),
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        };
        let gap = |deg: f64| {
            MeanMotionSlot::Kozai.mean_motion_rev_day(&at(deg))
                - MeanMotionSlot::Kepler.mean_motion_rev_day(&at(deg))
        };
        assert!(gap(54.735_610_317_245_346).abs() < 1e-12);
        assert!(gap(40.0) > 6e-3 && gap(90.0) < -8e-3);
    }
}

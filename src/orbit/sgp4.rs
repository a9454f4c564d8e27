//! SGP4 in AFSPC mode (WGS-72), by the `sgp4` crate, from mean elements or from element sets.

use super::j2::SecularRates;
use super::{MeanElements, PropagationError, Propagator};
use crate::frames::State;
use crate::time::Epoch;
use crate::units::{MINUTES_PER_DAY, wrap_two_pi};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// What stands in the mean motion slot of an SGP4 element set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeanMotionSlot {
    /// dM/dt of secular J2, which is Kozai's mean motion to first order: the right one (M-10).
    Kozai,
    /// sqrt(μ/a³), the common mistake; up to 400 km/day along the track.
    Kepler,
}

/// Which zonal harmonics SGP4 flies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ZonalHarmonics {
    /// J2, J3 and J4 of WGS-72.
    Full,
    /// J2 alone: J3 = J4 = 0.
    J2Only,
}

impl MeanMotionSlot {
    /// The mean motion that an element set of `elements` carries, rad/s.
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

/// A satellite flown by SGP4.
#[derive(Debug, Clone)]
pub struct Sgp4Orbit {
    constants: ::sgp4::Constants,
    /// Seconds from the time origin of [`Propagator::state_at`] to the epoch of the set.
    epoch_offset_s: f64,
}

impl Sgp4Orbit {
    /// SGP4 without drag from unrounded mean elements at `epoch`.
    ///
    /// # Errors
    /// When SGP4 refuses the elements.
    pub fn from_mean_elements(
        elements: &MeanElements,
        epoch: Epoch,
        slot: MeanMotionSlot,
        zonals: ZonalHarmonics,
    ) -> Result<Self, PropagationError> {
        let geopotential = match zonals {
            ZonalHarmonics::Full => ::sgp4::WGS72,
            ZonalHarmonics::J2Only => ::sgp4::Geopotential {
                j3: 0.0,
                j4: 0.0,
                ..::sgp4::WGS72
            },
        };
        let orbit = ::sgp4::Orbit::from_kozai_elements(
            &geopotential,
            elements.inclination_rad,
            wrap_two_pi(elements.raan_rad),
            elements.eccentricity,
            wrap_two_pi(elements.arg_perigee_rad),
            wrap_two_pi(elements.mean_anomaly_rad),
            slot.mean_motion_rad_s(elements) * 60.0,
        )
        .map_err(refused)?;
        let years =
            ::sgp4::julian_years_since_j2000_afspc_compatibility_mode(&epoch.utc().naive_utc());
        let constants = ::sgp4::Constants::new(
            geopotential,
            ::sgp4::afspc_epoch_to_sidereal_time,
            years,
            0.0,
            orbit,
        )
        .map_err(refused)?;
        Ok(Self {
            constants,
            epoch_offset_s: 0.0,
        })
    }

    /// SGP4 from an element set as read from a file; time runs from `origin`.
    ///
    /// # Errors
    /// When SGP4 refuses the elements.
    pub fn from_element_set(
        set: &::sgp4::Elements,
        origin: Epoch,
    ) -> Result<Self, PropagationError> {
        let constants =
            ::sgp4::Constants::from_elements_afspc_compatibility_mode(set).map_err(refused)?;
        let epoch_offset_s = Epoch::from_utc(set.datetime.and_utc()).seconds_since(origin);
        Ok(Self {
            constants,
            epoch_offset_s,
        })
    }

    /// The same satellite with a time origin that is `seconds` later.
    #[must_use]
    pub fn with_origin_moved(&self, seconds: f64) -> Self {
        Self {
            constants: self.constants.clone(),
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
    fn state_at(&self, elapsed_s: f64) -> Result<State, PropagationError> {
        let minutes = ::sgp4::MinutesSinceEpoch((elapsed_s - self.epoch_offset_s) / 60.0);
        let prediction = self
            .constants
            .propagate_afspc_compatibility_mode(minutes)
            .map_err(|error| PropagationError::Sgp4State {
                elapsed_s,
                reason: error.to_string(),
            })?;
        Ok(State {
            position_km: Vector3::from(prediction.position),
            velocity_km_s: Vector3::from(prediction.velocity),
        })
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
                (state.position_km - Vector3::from(position)).norm() < 2e-8,
                "{minutes}"
            );
            assert!(
                (state.velocity_km_s - Vector3::from(velocity)).norm() < 2e-9,
                "{minutes}"
            );
        }
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

    /// The naive slot equals the right one where 3 sin² i = 2, and nowhere else.
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

//! Plausibility of a state as an Earth orbit: one rule for files and propagators alike.
//!
//! A unit wrong by a factor of 1000, a frame of another body and a diverged theory all give finite numbers; only
//! their magnitude shows that they are meaningless.

use crate::earth::MU_KM3_S2;
use crate::frames::{EarthRotation, Frame, State};
use nalgebra::Vector3;
use thiserror::Error;

/// Least distance from the centre of the Earth, km: below the ground at every latitude.
pub const LEAST_DISTANCE_KM: f64 = 6_300.0;

/// Greatest distance from the centre of the Earth, km: beyond the Moon at its apogee.
pub const MOST_DISTANCE_KM: f64 = 500_000.0;

/// Greatest speed as a multiple of the local escape speed, with a margin for rounding and departure orbits.
pub const MOST_OF_ESCAPE: f64 = 1.1;

/// The reason why a state is not an Earth orbit.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ImplausibleState {
    /// Inside the Earth.
    #[error(
        "it is {distance_km:.3} km from the centre of the Earth, below {LEAST_DISTANCE_KM} km: not an Earth orbit"
    )]
    TooLow {
        /// Distance from the centre, km.
        distance_km: f64,
    },
    /// Beyond the Moon, or not a number.
    #[error(
        "it is {distance_km:.0} km from the centre of the Earth, beyond {MOST_DISTANCE_KM} km: not an Earth orbit"
    )]
    TooHigh {
        /// Distance from the centre, km.
        distance_km: f64,
    },
    /// Faster than escape.
    #[error(
        "its speed is {speed_km_s:.3} km/s, above {MOST_OF_ESCAPE} times the escape speed there, {escape_km_s:.3} km/s: not an Earth orbit"
    )]
    TooFast {
        /// Inertial speed, km/s.
        speed_km_s: f64,
        /// Escape speed at its distance, km/s.
        escape_km_s: f64,
    },
}

/// Checks only the distance from the centre of the Earth.
///
/// # Errors
/// If the position is not plausible for an Earth orbit.
pub fn check_position(position_km: &Vector3<f64>) -> Result<(), ImplausibleState> {
    let distance_km = position_km.norm();
    if distance_km < LEAST_DISTANCE_KM {
        return Err(ImplausibleState::TooLow { distance_km });
    }
    // NaN counts as infinitely far.
    if distance_km <= MOST_DISTANCE_KM {
        Ok(())
    } else {
        Err(ImplausibleState::TooHigh { distance_km })
    }
}

/// Checks the distance and the speed of an inertial state.
///
/// # Errors
/// If the state is not plausible for an Earth orbit.
pub fn check_inertial(
    position_km: &Vector3<f64>,
    velocity_km_s: &Vector3<f64>,
) -> Result<(), ImplausibleState> {
    check_position(position_km)?;
    let speed_km_s = velocity_km_s.norm();
    let escape_km_s = (2.0 * MU_KM3_S2 / position_km.norm()).sqrt();
    if speed_km_s <= MOST_OF_ESCAPE * escape_km_s {
        Ok(())
    } else {
        Err(ImplausibleState::TooFast {
            speed_km_s,
            escape_km_s,
        })
    }
}

/// Checks a state in any frame; an Earth-fixed velocity is converted to inertial first.
///
/// # Errors
/// If the state is not plausible for an Earth orbit.
pub fn check_state(frame: Frame, state: &State<Frame>) -> Result<(), ImplausibleState> {
    let position_km = &state.position_km.km();
    match frame {
        Frame::Teme | Frame::Eme2000 | Frame::Gcrf => {
            check_inertial(position_km, &state.velocity_km_s)
        }
        Frame::EarthFixed => {
            // Any sidereal time will do: it rotates the axes and does not change the speed.
            let fixed = State::new(*position_km, state.velocity_km_s);
            let inertial = EarthRotation::from_gmst(0.0).state_to_teme(fixed);
            check_inertial(&inertial.position_km.km(), &inertial.velocity_km_s)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(distance_km: f64, speed_km_s: f64) -> State<Frame> {
        let (r, v) = (Vector3::x() * distance_km, Vector3::y() * speed_km_s);
        State::new(r, v)
    }

    #[test]
    fn what_cannot_orbit_the_earth_is_refused() {
        let check = |frame, r, v| check_state(frame, &state(r, v));
        for frame in [Frame::Teme, Frame::Eme2000, Frame::Gcrf] {
            for (r, v) in [
                (6_300.0, 7.9),
                (7_000.0, 7.5),
                (42_164.0, 3.07),
                (500_000.0, 0.9),
            ] {
                assert_eq!(check(frame, r, v), Ok(()), "{r}");
            }
            // Kilometres taken for metres, metres for kilometres, and a theory that has diverged.
            let low = check(frame, 7.0, 0.0075).unwrap_err();
            assert!(matches!(low, ImplausibleState::TooLow { .. }));
            for r in [500_001.0, 7e6, 1e14, f64::NAN, f64::INFINITY] {
                let far = check(frame, r, 0.1).unwrap_err();
                assert!(matches!(far, ImplausibleState::TooHigh { .. }), "{r}");
            }
            // Escape at 7 000 km is sqrt(2 · 398 600 / 7 000) = 10.67 km/s; a tenth more is 11.74.
            assert_eq!(check(frame, 7_000.0, 11.7), Ok(()));
            for v in [11.8, f64::NAN] {
                let fast = check(frame, 7_000.0, v).unwrap_err();
                assert!(matches!(fast, ImplausibleState::TooFast { .. }), "{v}");
            }
        }
        assert!(check(Frame::EarthFixed, 6_299.0, 7.0).is_err());
    }

    /// A geostationary satellite stands still in the Earth-fixed frame; at 400 000 km the axes move at 29 km/s,
    /// so that a satellite that hardly moves against the stars is that fast against them.
    #[test]
    fn earth_fixed_speeds_are_made_inertial() {
        let check = |r, v| check_state(Frame::EarthFixed, &state(r, v));
        assert_eq!(check(42_164.0, 0.0), Ok(()));
        assert_eq!(check(400_000.0, -29.2), Ok(()));
        assert!(check(400_000.0, 0.0).is_err());
    }
}

//! Mean Keplerian elements.

use crate::earth::{MU_KM3_S2, RADIUS_KM};
use crate::units::wrap_two_pi;
use thiserror::Error;

/// Elements that describe no closed orbit above the ground.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum ElementsError {
    /// Eccentricity outside [0, 0.9).
    #[error("eccentricity {0} is outside [0, 0.9)")]
    Eccentricity(f64),
    /// Inclination outside [0°, 180°].
    #[error("inclination {0}° is outside [0°, 180°]")]
    Inclination(f64),
    /// Perigee not above the equatorial radius.
    #[error("perigee height {perigee_km} km is not above the ground")]
    Perigee {
        /// Height of the perigee over the equatorial radius, km.
        perigee_km: f64,
    },
    /// An angle or length that is not a finite number.
    #[error("{name} is not a finite number")]
    NotFinite {
        /// The element.
        name: &'static str,
    },
}

/// Mean elements at an epoch, in TEME: the input of the secular theories.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeanElements {
    /// Semi-major axis, km.
    pub semi_major_axis_km: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Inclination, radians.
    pub inclination_rad: f64,
    /// Right ascension of the ascending node, radians.
    pub raan_rad: f64,
    /// Argument of perigee, radians.
    pub arg_perigee_rad: f64,
    /// Mean anomaly, radians.
    pub mean_anomaly_rad: f64,
}

impl MeanElements {
    /// Largest eccentricity that is accepted (exclusive).
    pub const MAX_ECCENTRICITY: f64 = 0.9;

    /// The elements, if they describe a closed orbit whose perigee is above the ground.
    ///
    /// # Errors
    /// Names the element that is out of range.
    pub fn checked(self) -> Result<Self, ElementsError> {
        let named = [
            ("semi-major axis", self.semi_major_axis_km),
            ("inclination", self.inclination_rad),
            ("right ascension of the ascending node", self.raan_rad),
            ("argument of perigee", self.arg_perigee_rad),
            ("mean anomaly", self.mean_anomaly_rad),
        ];
        if let Some((name, _)) = named.into_iter().find(|(_, value)| !value.is_finite()) {
            return Err(ElementsError::NotFinite { name });
        }
        if !(0.0..Self::MAX_ECCENTRICITY).contains(&self.eccentricity) {
            return Err(ElementsError::Eccentricity(self.eccentricity));
        }
        let inclination_deg = self.inclination_rad.to_degrees();
        if !(0.0..=180.0).contains(&inclination_deg) {
            return Err(ElementsError::Inclination(inclination_deg));
        }
        let perigee_km = self.semi_major_axis_km * (1.0 - self.eccentricity) - RADIUS_KM;
        if perigee_km <= 0.0 {
            return Err(ElementsError::Perigee { perigee_km });
        }
        Ok(self)
    }

    /// Kepler's mean motion sqrt(μ/a³), rad/s.
    #[must_use]
    pub fn kepler_mean_motion_rad_s(&self) -> f64 {
        (MU_KM3_S2 / self.semi_major_axis_km.powi(3)).sqrt()
    }

    /// Mean argument of latitude ω + M, [0, 2π) radians.
    #[must_use]
    pub fn mean_argument_of_latitude_rad(&self) -> f64 {
        wrap_two_pi(self.arg_perigee_rad + self.mean_anomaly_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn low() -> MeanElements {
        MeanElements {
            semi_major_axis_km: 7303.137,
            eccentricity: 0.01,
            inclination_rad: 0.9,
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        }
    }

    /// Perigee at 350° and 30° after it: 20° from the node.
    #[test]
    fn the_argument_of_latitude_is_counted_from_the_node() {
        let elements = MeanElements {
            arg_perigee_rad: 350_f64.to_radians(),
            mean_anomaly_rad: 30_f64.to_radians(),
            ..low()
        };
        let degrees = elements.mean_argument_of_latitude_rad().to_degrees();
        assert!((degrees - 20.0).abs() < 1e-12, "{degrees}");
    }

    #[test]
    fn impossible_orbits_are_named() {
        assert!(low().checked().is_ok());
        let grazing = MeanElements {
            eccentricity: 0.13,
            ..low()
        }
        .checked()
        .unwrap_err();
        assert!(matches!(grazing, ElementsError::Perigee { .. }));
        let open = MeanElements {
            eccentricity: 0.9,
            ..low()
        }
        .checked()
        .unwrap_err();
        assert_eq!(open.to_string(), "eccentricity 0.9 is outside [0, 0.9)");
        let tilted = MeanElements {
            inclination_rad: 4.0,
            ..low()
        }
        .checked();
        assert!(matches!(tilted, Err(ElementsError::Inclination(_))));
        let lost = MeanElements {
            raan_rad: f64::NAN,
            ..low()
        }
        .checked()
        .unwrap_err();
        assert_eq!(
            lost.to_string(),
            "right ascension of the ascending node is not a finite number"
        );
    }
}

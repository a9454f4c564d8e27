//! An altitude or an inclination that follows from what the orbit is for.

use super::MeanElements;
use super::ground_track::{repeating_altitude_km, sun_synchronous_inclination_deg};
use crate::earth::RADIUS_KM;
use crate::units::round_decimal;
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Decimals of a kilometre and of a degree to which altitudes and inclinations are solved for: a millimetre, and
/// as much of a satellite's place.
const DECIMALS: usize = 6;

/// Times that altitude and inclination are solved in turn: a kilometre of altitude is a few thousandths of a degree, and
/// a degree of inclination a few kilometres.
const TURNS: usize = 12;

/// Why there is no such orbit.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum RelationError {
    /// Not the form of a repeat.
    #[error(
        "a repeat of the ground track is written repeat:REVOLUTIONS/DAYS, each a whole number from 1 to 9999, such as repeat:15/1"
    )]
    Form,
    /// Below the ground, or not an orbit at all.
    #[error(
        "{ratio} needs an orbit whose perigee is below the ground: at most some 16 revolutions a day are above it"
    )]
    NoRepeat {
        /// The repeat.
        ratio: RepeatRatio,
    },
    /// The node of no inclination follows the Sun.
    #[error(
        "no inclination is sun-synchronous at an altitude of {altitude_km} km and an eccentricity of {eccentricity}; circular orbits are up to some 5970 km"
    )]
    NotSunSynchronous {
        /// The altitude, km.
        altitude_km: f64,
        /// The eccentricity.
        eccentricity: f64,
    },
}

/// A ground track that repeats after some revolutions in some nodal days: `repeat:15/1`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RepeatRatio {
    revolutions: u16,
    days: u16,
}

impl RepeatRatio {
    /// What a repeat begins with.
    pub(crate) const PREFIX: &'static str = "repeat:";
    /// The form for a JSON schema.
    pub(crate) const PATTERN: &'static str = "^repeat:[1-9][0-9]{0,3}/[1-9][0-9]{0,3}$";

    fn per_day(self) -> f64 {
        f64::from(self.revolutions) / f64::from(self.days)
    }
}

impl FromStr for RepeatRatio {
    type Err = RelationError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let numbers = text
            .strip_prefix(Self::PREFIX)
            .and_then(|of| of.split_once('/'));
        let (revolutions, days) = numbers.ok_or(RelationError::Form)?;
        let whole = |text: &str| {
            let is_plain = text.len() <= 4
                && !text.starts_with('0')
                && text.bytes().all(|byte| byte.is_ascii_digit());
            let number = text.parse().ok();
            number.filter(|_| is_plain).ok_or(RelationError::Form)
        };
        Ok(Self {
            revolutions: whole(revolutions)?,
            days: whole(days)?,
        })
    }
}

impl fmt::Display for RepeatRatio {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            formatter,
            "{}{}/{}",
            Self::PREFIX,
            self.revolutions,
            self.days
        )
    }
}

/// The inclination at which the node follows the mean Sun: `sun-synchronous`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SunSynchronous;

impl SunSynchronous {
    /// Its name.
    pub(crate) const NAME: &'static str = "sun-synchronous";
}

impl FromStr for SunSynchronous {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        (text == Self::NAME).then_some(Self).ok_or(())
    }
}

impl fmt::Display for SunSynchronous {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(Self::NAME)
    }
}

/// A number, or what it follows from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NumberOr<F> {
    /// The number.
    Number(f64),
    /// What it follows from.
    Following(F),
}

/// Inclination (degrees) and altitude (km) of an orbit of an eccentricity under secular J2
/// ([M-62](crate::models#m-62), [M-63](crate::models#m-63)); numbers as they are, what follows to the sixth decimal.
///
/// # Errors
/// If there is no such orbit.
pub fn inclination_and_altitude(
    inclination_deg: NumberOr<SunSynchronous>,
    altitude_km: NumberOr<RepeatRatio>,
    eccentricity: f64,
) -> Result<(f64, f64), RelationError> {
    let elements = |inclination_deg: f64, altitude_km: f64| MeanElements {
        semi_major_axis_km: RADIUS_KM + altitude_km,
        eccentricity,
        inclination_rad: inclination_deg.to_radians(),
        raan_rad: 0.0,
        arg_perigee_rad: 0.0,
        mean_anomaly_rad: 0.0,
    };
    let inclination = |altitude_km: f64| match inclination_deg {
        NumberOr::Number(degrees) => Ok(degrees),
        NumberOr::Following(SunSynchronous) => {
            let found = sun_synchronous_inclination_deg(&elements(90.0, altitude_km));
            let found = found.map(|degrees| round_decimal(degrees, DECIMALS));
            found.ok_or(RelationError::NotSunSynchronous {
                altitude_km: round_decimal(altitude_km, DECIMALS),
                eccentricity,
            })
        }
    };
    let altitude = |inclination_deg: f64| match altitude_km {
        NumberOr::Number(km) => Ok(km),
        NumberOr::Following(ratio) => {
            // From a low orbit, whose rates are far from singular.
            let start = elements(inclination_deg, 700.0);
            let found = repeating_altitude_km(&start, ratio.per_day());
            let found = found.map(|km| round_decimal(km, DECIMALS));
            found.ok_or(RelationError::NoRepeat { ratio })
        }
    };
    let NumberOr::Following(_) = inclination_deg else {
        let degrees = inclination(0.0)?;
        return Ok((degrees, altitude(degrees)?));
    };
    let mut degrees = 98.0;
    for _ in 0..TURNS {
        degrees = inclination(altitude(degrees)?)?;
    }
    Ok((degrees, altitude(degrees)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::orbit::ground_track::GroundTrack;

    fn at(inclination_deg: f64, ratio: &str) -> f64 {
        let ratio = NumberOr::Following(ratio.parse().unwrap());
        inclination_and_altitude(NumberOr::Number(inclination_deg), ratio, 0.0)
            .unwrap()
            .1
    }

    /// Solved elsewhere from du/dt D = R (ω - dΩ/dt) with the rates of M-6 to M-8 and the same constants; to the digits
    /// given.
    #[test]
    fn validate_repeating_altitudes() {
        for (inclination_deg, ratio, altitude_km) in [
            (55.0, "repeat:15/1", 500.669),
            (55.0, "repeat:14/1", 833.050),
            (55.0, "repeat:13/1", 1206.427),
            (90.0, "repeat:15/1", 547.882),
            (90.0, "repeat:14/1", 874.473),
            (90.0, "repeat:13/1", 1242.392),
        ] {
            let ours = at(inclination_deg, ratio);
            assert!((ours - altitude_km).abs() <= 5e-4, "{ratio}: {ours}");
        }
    }

    /// Both at once: Landsat 8 repeats 233 revolutions in 16 days on a sun-synchronous orbit of 98.2° at 705 km over the
    /// equator (Landsat 8 Data Users Handbook, LSDS-1574, section 2.1).
    #[test]
    fn validate_the_orbit_of_landsat() {
        let ratio = NumberOr::Following("repeat:233/16".parse().unwrap());
        let both = inclination_and_altitude(NumberOr::Following(SunSynchronous), ratio, 0.0);
        let (inclination_deg, altitude_km) = both.unwrap();
        assert!((inclination_deg - 98.2).abs() < 0.05, "{inclination_deg}");
        // Of its semi-major axis the handbook gives no decimals.
        assert!((altitude_km - 705.0).abs() < 10.0, "{altitude_km}");
        let track = GroundTrack::of(&MeanElements {
            semi_major_axis_km: RADIUS_KM + altitude_km,
            eccentricity: 0.0,
            inclination_rad: inclination_deg.to_radians(),
            raan_rad: 0.0,
            arg_perigee_rad: 0.0,
            mean_anomaly_rad: 0.0,
        });
        assert!((track.revolutions_per_day() - 233.0 / 16.0).abs() < 1e-8);
        // A nodal day of such an orbit is a mean solar day.
        assert!(
            (track.nodal_day_s - 86_400.0).abs() < 1e-2,
            "{}",
            track.nodal_day_s
        );
    }

    #[test]
    fn what_is_no_orbit_is_refused() {
        for text in [
            "repeat:15",
            "repeat:0/1",
            "repeat:15/01",
            "repeat:+5/1",
            "repeat:10000/1",
            "15/1",
        ] {
            assert_eq!(
                text.parse::<RepeatRatio>(),
                Err(RelationError::Form),
                "{text}"
            );
        }
        let ratio = NumberOr::Following("repeat:18/1".parse().unwrap());
        let low = inclination_and_altitude(NumberOr::Number(55.0), ratio, 0.0);
        assert!(
            low.unwrap_err()
                .to_string()
                .starts_with("repeat:18/1 needs")
        );
        let sun = NumberOr::Following(SunSynchronous);
        let high = inclination_and_altitude(sun, NumberOr::Number(7000.0), 0.0);
        assert!(high.unwrap_err().to_string().contains("7000 km"));
    }
}

//! UTC epochs, their sidereal time, and the sampling of a span.
//!
//! chrono carries UTC; sidereal time and leap seconds come from the SOFA port.
//! UT1 is taken to equal UTC throughout (|UT1 - UTC| < 0.9 s, at most 0.42 km along the equator,
//! absorbed by the pseudo-Earth-fixed frame).

use crate::units::SECONDS_PER_DAY;
use chrono::{DateTime, Datelike, TimeDelta, Timelike, Utc};
use std::fmt;
use thiserror::Error;

/// Why a time span cannot be sampled.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum TimeError {
    /// The step is not a positive number of seconds.
    #[error("step of {0} s is not positive")]
    Step(f64),
    /// The span is not a positive number of seconds.
    #[error("span of {duration_s} s is not positive")]
    NoSample {
        /// Length of the span, s.
        duration_s: f64,
    },
    /// More samples than [`TimeGrid::MAX_SAMPLES`].
    #[error("{samples} samples exceed the limit of {limit}")]
    TooMany {
        /// Samples requested.
        samples: f64,
        /// Maximum number of samples.
        limit: usize,
    },
}

/// An instant of UTC.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Epoch(DateTime<Utc>);

impl Epoch {
    /// The epoch of a UTC date and time.
    #[must_use]
    pub fn from_utc(utc: DateTime<Utc>) -> Self {
        Self(utc)
    }

    /// The date and time in UTC.
    #[must_use]
    pub fn utc(self) -> DateTime<Utc> {
        self.0
    }

    /// This epoch moved by a number of seconds, to the nearest nanosecond.
    ///
    /// Saturates beyond the range of the calendar.
    #[must_use]
    pub fn plus_seconds(self, seconds: f64) -> Self {
        let whole = seconds.floor();
        let nanos = ((seconds - whole) * 1e9).round() as i64;
        let delta = TimeDelta::try_seconds(whole as i64).unwrap_or(TimeDelta::MAX);
        let moved = self
            .0
            .checked_add_signed(delta)
            .unwrap_or(DateTime::<Utc>::MAX_UTC);
        Self(
            moved
                .checked_add_signed(TimeDelta::nanoseconds(nanos))
                .unwrap_or(moved),
        )
    }

    /// Seconds from `earlier` to this epoch.
    #[must_use]
    pub fn seconds_since(self, earlier: Self) -> f64 {
        let delta = self.0 - earlier.0;
        delta.num_seconds() as f64 + f64::from(delta.subsec_nanos()) * 1e-9
    }

    /// UTC as a two-part Julian date: the preceding midnight, and the fraction of the day.
    #[must_use]
    pub fn julian_date(self) -> (f64, f64) {
        let days_from_ce = f64::from(self.0.num_days_from_ce());
        // Day 1 of the proleptic Gregorian calendar began at JD 1721425.5.
        let midnight = days_from_ce + 1_721_424.5;
        let seconds =
            f64::from(self.0.num_seconds_from_midnight()) + f64::from(self.0.nanosecond()) * 1e-9;
        (midnight, seconds / SECONDS_PER_DAY)
    }

    /// Julian date of Terrestrial Time, two-part: UTC + leap seconds + 32.184 s.
    #[must_use]
    pub fn terrestrial_julian_date(self) -> (f64, f64) {
        let (midnight, fraction) = self.julian_date();
        (
            midnight,
            fraction + (self.leap_seconds() + 32.184) / SECONDS_PER_DAY,
        )
    }

    /// TAI - UTC in seconds.
    ///
    /// 0 before 1960, when UTC did not exist; constant after the last known leap second.
    #[must_use]
    pub fn leap_seconds(self) -> f64 {
        let (_, fraction) = self.julian_date();
        let date = (self.0.year(), self.0.month() as i32, self.0.day() as i32);
        sofars::ts::dat(date.0, date.1, date.2, fraction).unwrap_or(0.0)
    }

    /// Greenwich mean sidereal time (IAU 1982) `elapsed_s` after this epoch, in [0, 2π) radians.
    ///
    /// Source: Aoki et al. (1982), by the SOFA routine `gmst82`, with UT1 = UTC
    /// ([M-17](crate::models#m-17)).
    #[must_use]
    pub fn gmst_rad(self, elapsed_s: f64) -> f64 {
        let (midnight, fraction) = self.julian_date();
        sofars::erst::gmst82(midnight, fraction + elapsed_s / SECONDS_PER_DAY)
    }
}

impl fmt::Display for Epoch {
    /// ISO 8601 with as many digits as needed: `2025-01-01T00:00:00Z`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = self.0.to_rfc3339_opts(chrono::SecondsFormat::AutoSi, true);
        formatter.write_str(&text)
    }
}

/// Equally spaced instants of a span from an epoch: every k·step < duration, from k = 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeGrid {
    epoch: Epoch,
    step_s: f64,
    samples: usize,
}

impl TimeGrid {
    /// Maximum number of samples: ample for one per second over a leap year.
    pub const MAX_SAMPLES: usize = 100_000_000;

    /// The samples of the span of `duration_s` seconds from `epoch`.
    ///
    /// # Errors
    /// If the step or the duration is not positive, or there would be too many samples.
    pub fn new(epoch: Epoch, duration_s: f64, step_s: f64) -> Result<Self, TimeError> {
        if !(step_s > 0.0 && step_s.is_finite()) {
            return Err(TimeError::Step(step_s));
        }
        if !(duration_s > 0.0 && duration_s.is_finite()) {
            return Err(TimeError::NoSample { duration_s });
        }
        let mut samples = (duration_s / step_s).ceil();
        if samples > Self::MAX_SAMPLES as f64 {
            return Err(TimeError::TooMany {
                samples,
                limit: Self::MAX_SAMPLES,
            });
        }
        // The quotient may round either way at a whole number; the product decides.
        while samples > 1.0 && (samples - 1.0) * step_s >= duration_s {
            samples -= 1.0;
        }
        Ok(Self {
            epoch,
            step_s,
            samples: samples as usize,
        })
    }

    /// First sample.
    #[must_use]
    pub fn epoch(&self) -> Epoch {
        self.epoch
    }

    /// Step, s.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        self.step_s
    }

    /// Number of samples, at least 1.
    #[must_use]
    pub fn len(&self) -> usize {
        self.samples
    }

    /// Always false: a grid has at least one sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Seconds from the epoch to sample `k`.
    #[must_use]
    pub fn elapsed_s(&self, k: usize) -> f64 {
        k as f64 * self.step_s
    }

    /// Seconds from the epoch to each sample.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = f64> + use<> {
        let step_s = self.step_s;
        (0..self.samples).map(move |k| k as f64 * step_s)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn epoch(text: &str) -> Epoch {
        Epoch::from_utc(text.parse().unwrap())
    }

    /// Meeus, *Astronomical Algorithms* (2nd ed.), examples 12.a and 12.b: mean sidereal time at
    /// Greenwich on 1987-04-10 is 13h 10m 46.3668s at 0h UT and 8h 34m 57.0896s at 19h 21m UT.
    #[test]
    fn validate_gmst_of_published_epochs() {
        let midnight = epoch("1987-04-10T00:00:00Z");
        let expected_deg = (13.0 + 10.0 / 60.0 + 46.366_8 / 3600.0) * 15.0;
        // Half of the last printed digit: 0.000 05 s of time is 2.1e-7°.
        assert!((midnight.gmst_rad(0.0).to_degrees() - expected_deg).abs() < 2.1e-7);
        let evening = midnight.gmst_rad(19.0 * 3600.0 + 21.0 * 60.0).to_degrees();
        let expected_deg = (8.0 + 34.0 / 60.0 + 57.089_6 / 3600.0) * 15.0;
        assert!((evening - expected_deg).abs() < 2.1e-7, "{evening}");
        assert_eq!(
            epoch("1987-04-10T19:21:00Z").gmst_rad(0.0).to_degrees(),
            evening
        );
    }

    /// The verification value of the SOFA library for `iauGmst82` at MJD 53736.0.
    #[test]
    fn validate_gmst_of_the_sofa_test_case() {
        let gmst = epoch("2006-01-01T00:00:00Z").gmst_rad(0.0);
        assert!((gmst - 1.754_174_981_860_675).abs() < 1e-12);
    }

    /// J2000.0 is JD 2451545.0; TAI - UTC was 32 s then and is 37 s since 2017.
    #[test]
    fn validate_julian_date_and_leap_seconds() {
        let (midnight, fraction) = epoch("2000-01-01T12:00:00Z").julian_date();
        assert_eq!((midnight, fraction), (2_451_544.5, 0.5));
        assert_eq!(epoch("2000-01-01T12:00:00Z").leap_seconds(), 32.0);
        assert_eq!(epoch("2026-03-21T12:34:56Z").leap_seconds(), 37.0);
        let (_, tt) = epoch("2026-03-21T00:00:00Z").terrestrial_julian_date();
        assert!((tt * 86_400.0 - 69.184).abs() < 1e-9);
    }

    #[test]
    fn samples_stop_before_the_end() {
        let at = epoch("2025-01-01T00:00:00Z");
        assert_eq!(TimeGrid::new(at, 86_400.0, 60.0).unwrap().len(), 1440);
        assert_eq!(TimeGrid::new(at, 25_200.0, 97.0).unwrap().len(), 260);
        assert_eq!(TimeGrid::new(at, 0.3, 0.1).unwrap().len(), 3);
        assert_eq!(TimeGrid::new(at, 10.0, 60.0).unwrap().len(), 1);
        assert_eq!(TimeGrid::new(at, 10.0, 0.0), Err(TimeError::Step(0.0)));
        assert!(TimeGrid::new(at, f64::NAN, 1.0).is_err());
        assert!(TimeGrid::new(at, 1e12, 1.0).is_err());
    }

    #[test]
    fn epochs_move_and_print() {
        let at = epoch("2025-01-01T00:00:00Z");
        assert_eq!(at.to_string(), "2025-01-01T00:00:00Z");
        let moved = at.plus_seconds(-0.25);
        assert_eq!(moved.to_string(), "2024-12-31T23:59:59.750Z");
        assert_eq!(moved.seconds_since(at), -0.25);
    }
}

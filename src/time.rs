//! Instants and their UTC labels, sidereal time, and the sampling of a time span.
//!
//! Time is counted in SI seconds. An [`Epoch`] is an instant in TAI, so that differences between instants are
//! elapsed seconds, even across a leap second; its UTC label, in which the leap second is 23:59:60, is a chrono
//! date and time. Sidereal time and leap seconds come from `sofars`, a port of SOFA.
//!
//! UT1 equals UTC at the epoch of the scenario and advances in SI seconds from there, so that the Earth
//! rotates evenly through a leap second (|UT1 - UTC| < 0.9 s, at most 0.42 km along the equator, absorbed by the
//! pseudo-Earth-fixed frame).

mod leap;
mod ut1;

pub use leap::{FIRST_YEAR, LEAP_SECONDS_END, ends_with_leap_second, leap_seconds_note};
pub use ut1::{MOST_UT1_MINUS_UTC_S, ut1_minus_utc_s};

use crate::units::SECONDS_PER_DAY;
use chrono::{DateTime, Datelike, NaiveDateTime, Timelike, Utc};
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

/// TT - TAI, s.
pub(crate) const TT_MINUS_TAI_S: f64 = 32.184;

/// An instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Epoch {
    /// Whole seconds of TAI since 1970-01-01T00:00:00 TAI.
    tai_s: i64,
    /// Nanoseconds of the second, below 1e9.
    nanosecond: u32,
}

/// Nanoseconds in a second.
const NANOSECONDS: i64 = 1_000_000_000;

impl Epoch {
    /// The instant of a UTC date and time; chrono writes 23:59:60 as 23:59:59 with 1e9 nanoseconds or more.
    ///
    /// On a day without a leap second, 23:59:60 is the following midnight.
    #[must_use]
    pub fn from_utc(utc: DateTime<Utc>) -> Self {
        let tai_minus_utc_s = leap::tai_minus_utc_s(utc.date_naive());
        let nanosecond = i64::from(utc.nanosecond());
        Self {
            tai_s: utc.timestamp() + nanosecond / NANOSECONDS + tai_minus_utc_s,
            nanosecond: (nanosecond % NANOSECONDS) as u32,
        }
    }

    /// The date and time in UTC; chrono writes 23:59:60 as 23:59:59 with 1e9 nanoseconds or more.
    ///
    /// Saturates at the ends of chrono's calendar.
    #[must_use]
    pub fn utc(self) -> DateTime<Utc> {
        let label = |seconds, nanosecond| {
            let label = DateTime::from_timestamp(seconds, nanosecond);
            label.unwrap_or(DateTime::<Utc>::MAX_UTC)
        };
        // UTC is less than a day behind TAI: its date is that of TAI or the day before.
        let date = label(self.tai_s, 0).date_naive();
        let later = label(self.tai_s - leap::tai_minus_utc_s(date), self.nanosecond);
        if later.date_naive() == date {
            return later;
        }
        let date = date.pred_opt().unwrap_or(date);
        let seconds = self.tai_s - leap::tai_minus_utc_s(date);
        let earlier = label(seconds, self.nanosecond);
        if earlier.date_naive() == date {
            return earlier;
        }
        label(seconds - 1, self.nanosecond + NANOSECONDS as u32)
    }

    /// The instant of a TAI date and time.
    #[must_use]
    pub fn from_tai(tai: NaiveDateTime) -> Self {
        let nanosecond = i64::from(tai.nanosecond());
        Self {
            tai_s: tai.and_utc().timestamp() + nanosecond / NANOSECONDS,
            nanosecond: (nanosecond % NANOSECONDS) as u32,
        }
    }

    /// The date and time in TAI.
    ///
    /// Saturates at the ends of chrono's calendar.
    #[must_use]
    pub fn tai(self) -> NaiveDateTime {
        let label = DateTime::from_timestamp(self.tai_s, self.nanosecond);
        label.unwrap_or(DateTime::<Utc>::MAX_UTC).naive_utc()
    }

    /// This instant moved by a number of SI seconds, to the nearest nanosecond.
    ///
    /// Saturates 100 000 years from 1970.
    #[must_use]
    pub fn plus_seconds(self, seconds: f64) -> Self {
        const MOST_S: f64 = 1e5 * 366.0 * SECONDS_PER_DAY;
        let seconds = seconds.clamp(-MOST_S, MOST_S);
        let whole = seconds.floor();
        let nanoseconds =
            i64::from(self.nanosecond) + ((seconds - whole) * NANOSECONDS as f64).round() as i64;
        let tai_s = self.tai_s + whole as i64 + nanoseconds.div_euclid(NANOSECONDS);
        Self {
            tai_s: tai_s.clamp(-MOST_S as i64, MOST_S as i64),
            nanosecond: nanoseconds.rem_euclid(NANOSECONDS) as u32,
        }
    }

    /// SI seconds from `earlier` to this instant.
    #[must_use]
    pub fn seconds_since(self, earlier: Self) -> f64 {
        let nanoseconds = i64::from(self.nanosecond) - i64::from(earlier.nanosecond);
        (self.tai_s - earlier.tai_s) as f64 + nanoseconds as f64 * 1e-9
    }

    /// UTC as a two-part Julian date: the preceding midnight, and the fraction of a day of 86 400 s, which
    /// is 1 or more during a leap second.
    #[must_use]
    pub fn julian_date(self) -> (f64, f64) {
        let utc = self.utc();
        let days_from_ce = f64::from(utc.num_days_from_ce());
        // Day 1 of the proleptic Gregorian calendar began at JD 1721425.5.
        let midnight = days_from_ce + 1_721_424.5;
        let seconds =
            f64::from(utc.num_seconds_from_midnight()) + f64::from(utc.nanosecond()) * 1e-9;
        (midnight, seconds / SECONDS_PER_DAY)
    }

    /// Terrestrial Time as a two-part Julian date: UTC + leap seconds + 32.184 s.
    #[must_use]
    pub fn terrestrial_julian_date(self) -> (f64, f64) {
        let (midnight, fraction) = self.julian_date();
        (
            midnight,
            fraction + (self.leap_seconds() + TT_MINUS_TAI_S) / SECONDS_PER_DAY,
        )
    }

    /// TAI - UTC, s; during a leap second, the value that holds before it.
    ///
    /// 10 s before 1972; constant after the last leap second so far, that of 2016-12-31.
    #[must_use]
    pub fn leap_seconds(self) -> f64 {
        leap::tai_minus_utc_s(self.utc().date_naive()) as f64
    }

    /// Seconds from this instant to the beginning of each leap second within the next `duration_s`.
    #[must_use]
    pub fn leap_seconds_within(self, duration_s: f64) -> Vec<f64> {
        let last = self.plus_seconds(duration_s).utc().date_naive();
        let days = self.utc().date_naive().iter_days();
        days.take_while(|day| *day <= last)
            .filter(|day| ends_with_leap_second(*day))
            .filter_map(|day| day.and_hms_opt(23, 59, 59))
            .map(|before| Self::from_utc(before.and_utc()).seconds_since(self) + 1.0)
            .filter(|start_s| (0.0..duration_s).contains(start_s))
            .collect()
    }

    /// Greenwich mean sidereal time (IAU 1982) `elapsed_s` after this epoch, in [0, 2π) radians.
    ///
    /// UT1 equals UTC at this epoch and advances in SI seconds from there, even through a leap second:
    /// within a scenario, always start from the scenario's epoch.
    ///
    /// Source: Aoki et al. (1982), as computed by SOFA's `gmst82` ([M-17](crate::models#m-17)).
    #[must_use]
    pub fn gmst_rad(self, elapsed_s: f64) -> f64 {
        let (midnight, fraction) = self.julian_date();
        sofars::erst::gmst82(midnight, fraction + elapsed_s / SECONDS_PER_DAY)
    }
}

impl fmt::Display for Epoch {
    /// ISO 8601 with as many digits as needed: `2025-01-01T00:00:00Z`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = self
            .utc()
            .to_rfc3339_opts(chrono::SecondsFormat::AutoSi, true);
        formatter.write_str(&text)
    }
}

/// Equally spaced instants from an epoch: k·step for every k ≥ 0 with k·step < duration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeGrid {
    epoch: Epoch,
    step_s: f64,
    samples: usize,
}

impl TimeGrid {
    /// Maximum number of samples: enough for one per second over a leap year.
    pub const MAX_SAMPLES: usize = 100_000_000;

    /// The samples of `duration_s` seconds from `epoch`; the end instant is excluded.
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
        // Near a whole number the quotient may round either way; the product decides.
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

    /// UTC over the leap seconds of 2015-06-30 and 2016-12-31 (IERS Bulletins C 49 and C 52): each has its own
    /// label, and TAI - UTC is 36 s and 37 s after them.
    #[test]
    fn validate_labels_over_leap_seconds() {
        for (start, ahead_s, labels) in [
            (
                "2015-06-30T23:59:59Z",
                35.0,
                ["2015-06-30T23:59:60Z", "2015-07-01T00:00:00Z"],
            ),
            (
                "2016-12-31T23:59:59Z",
                36.0,
                ["2016-12-31T23:59:60Z", "2017-01-01T00:00:00Z"],
            ),
        ] {
            let [inside, after] = labels.map(epoch);
            let start = epoch(start);
            assert_eq!(start.plus_seconds(1.0), inside);
            assert_eq!(start.plus_seconds(2.0), after);
            assert_eq!(after.seconds_since(start), 2.0);
            assert_eq!([inside, after].map(|at| at.to_string()), labels);
            let offsets = [start, inside, after].map(Epoch::leap_seconds);
            assert_eq!(offsets, [ahead_s, ahead_s, ahead_s + 1.0]);
            let half = inside.plus_seconds(0.5).to_string();
            assert_eq!(half, labels[0].replace('Z', ".500Z"));
        }
        let tai = epoch("2016-12-31T23:59:60Z").tai().to_string();
        assert_eq!(tai, "2017-01-01 00:00:36");
        // An ordinary day has 86 400 s.
        let ordinary = epoch("2016-12-30T23:59:59Z").plus_seconds(1.0);
        assert_eq!(ordinary, epoch("2016-12-31T00:00:00Z"));
    }

    #[test]
    fn leap_seconds_of_a_span_are_found() {
        let year_s = 366.0 * SECONDS_PER_DAY;
        let start = epoch("2016-12-31T22:00:00Z");
        assert_eq!(start.leap_seconds_within(year_s), [7_200.0]);
        assert_eq!(start.leap_seconds_within(7_200.0), [0.0; 0]);
        let inside = epoch("2016-12-31T23:59:60.5Z");
        assert_eq!(inside.leap_seconds_within(year_s), [0.0; 0]);
        let both = epoch("2015-06-30T23:59:59Z").leap_seconds_within(2.0 * year_s);
        // The two are 550 days apart, plus the first leap second itself.
        assert_eq!(both, [1.0, 550.0 * SECONDS_PER_DAY + 2.0]);
    }

    /// TAI and TT run evenly through a leap second, and so does the Earth's rotation.
    #[test]
    fn nothing_jumps_at_a_leap_second() {
        let start = epoch("2016-12-31T23:59:58Z");
        let inside = start.plus_seconds(2.25);
        for k in 0..20 {
            let elapsed_s = f64::from(k) * 0.25;
            let at = start.plus_seconds(elapsed_s);
            assert_eq!(Epoch::from_tai(at.tai()), at);
            assert_eq!(Epoch::from_utc(at.utc()), at);
            let (start_jd, tt_jd) = (
                start.terrestrial_julian_date(),
                at.terrestrial_julian_date(),
            );
            let tt_s = (tt_jd.0 - start_jd.0 + tt_jd.1 - start_jd.1) * SECONDS_PER_DAY;
            // An f64 resolves a fraction of a day to 1e-11 s.
            assert!((tt_s - elapsed_s).abs() < 1e-10, "{at}: {tt_s}");
            // A leap second would be 7.3e-5 rad; an f64 resolves a fraction of a day to 1e-15 rad.
            let turned = crate::units::wrap_pi(start.gmst_rad(elapsed_s) - start.gmst_rad(0.0));
            assert!((turned - crate::earth::GMST_RATE_RAD_S * elapsed_s).abs() < 1e-12);
        }
        // At an epoch inside the leap second, UT1 = UTC uses the offset that holds before it.
        let gmst = crate::units::wrap_pi(inside.gmst_rad(0.0) - start.gmst_rad(2.25));
        assert!(gmst.abs() < 1e-12);
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

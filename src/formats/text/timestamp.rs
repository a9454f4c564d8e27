//! Dates and times as written in files, and their time systems.

use crate::keyword::keywords;
use crate::time::{Epoch, TT_MINUS_TAI_S, TimeGrid, ends_with_leap_second};
use chrono::{Datelike, NaiveDate, NaiveDateTime, TimeDelta, Timelike};

/// TAI - GPS time, s (IS-GPS-200: GPS time was UTC in January 1980, when TAI - UTC was 19 s).
const TAI_MINUS_GPS_S: f64 = 19.0;

/// TAI - BeiDou time, s (BDS-SIS-ICD: BeiDou time was UTC in January 2006, when TAI - UTC was 33 s).
const TAI_MINUS_BDT_S: f64 = 33.0;

keywords! {
    /// A time system of an exchanged file.
    TimeSystem {
        /// Coordinated Universal Time.
        Utc = "UTC",
        /// GPS time.
        Gps = "GPS",
        /// International Atomic Time.
        Tai = "TAI",
        /// Terrestrial Time.
        Tt = "TT",
        /// BeiDou time.
        Bdt = "BDT",
    }
}

impl TimeSystem {
    /// Whether a stamp exists in the system: second 60 is found in UTC only.
    #[must_use]
    pub fn has(self, stamp: NaiveDateTime) -> bool {
        // chrono writes second 60 as second 59 with 1e9 nanoseconds or more.
        self == Self::Utc || stamp.nanosecond() < 1_000_000_000
    }

    /// The instant of a stamp that this system [has](Self::has).
    #[must_use]
    pub fn epoch(self, stamp: NaiveDateTime) -> Epoch {
        match self.ahead_of_tai_s() {
            None => Epoch::from_utc(stamp.and_utc()),
            Some(ahead_of_tai_s) => Epoch::from_tai(stamp).plus_seconds(-ahead_of_tai_s),
        }
    }

    /// The stamp of an instant in this system.
    #[must_use]
    pub fn stamp(self, epoch: Epoch) -> NaiveDateTime {
        match self.ahead_of_tai_s() {
            None => epoch.utc().naive_utc(),
            Some(ahead_of_tai_s) => epoch.plus_seconds(ahead_of_tai_s).tai(),
        }
    }

    /// This system minus TAI, s; `None` for UTC, whose offset varies.
    fn ahead_of_tai_s(self) -> Option<f64> {
        match self {
            Self::Utc => None,
            Self::Gps => Some(-TAI_MINUS_GPS_S),
            Self::Tai => Some(0.0),
            Self::Tt => Some(TT_MINUS_TAI_S),
            Self::Bdt => Some(-TAI_MINUS_BDT_S),
        }
    }
}

/// The number of decimals written for seconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct SecondDigits(usize);

impl SecondDigits {
    /// Minimum number of decimals: milliseconds.
    pub const FEWEST: Self = Self(3);

    /// The decimals that show every sample of a grid without rounding, up to nanoseconds.
    #[must_use]
    pub fn of_grid(grid: &TimeGrid) -> Self {
        let start = Self::of_nanoseconds(grid.epoch().utc().nanosecond());
        if grid.len() == 1 {
            return start;
        }
        let step_ns = (grid.step_s().fract() * 1e9).round() as u32;
        start.max(Self::of_nanoseconds(step_ns))
    }

    /// The decimals that show a stamp without rounding.
    #[must_use]
    pub fn of_stamp(stamp: NaiveDateTime) -> Self {
        Self::of_nanoseconds(stamp.nanosecond())
    }

    fn of_nanoseconds(nanoseconds: u32) -> Self {
        let mut digits = 9;
        let mut rest = nanoseconds;
        while digits > Self::FEWEST.0 && rest.is_multiple_of(10) {
            rest /= 10;
            digits -= 1;
        }
        Self(digits)
    }
}

/// A stamp in CCSDS ASCII time code A: `2025-01-01T00:00:00.000`.
#[must_use]
pub fn calendar(stamp: NaiveDateTime, digits: SecondDigits) -> String {
    // chrono writes second 60 as second 59 with 1e9 nanoseconds or more.
    let leap = stamp.nanosecond() / 1_000_000_000;
    // Not by chrono's formatter, which interprets its pattern anew for each of millions of stamps.
    let mut text = format!(
        "{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:09}",
        stamp.year(),
        stamp.month(),
        stamp.day(),
        stamp.hour(),
        stamp.minute(),
        stamp.second() + leap,
        stamp.nanosecond() % 1_000_000_000
    );
    text.truncate(text.len() - 9 + digits.0);
    text
}

/// Reads CCSDS ASCII time code A or B (CCSDS 502.0-B-3, 7.5.10): calendar day or day of year,
/// any number of decimals, an optional `Z`. Decimals past nanoseconds are rounded. The second is 60 only
/// at the end of a day that has a leap second.
#[must_use]
pub fn parse(text: &str) -> Option<NaiveDateTime> {
    let text = text.strip_suffix('Z').unwrap_or(text);
    let (date, time) = text.split_once('T')?;
    let fields: Vec<&str> = date.split('-').collect();
    let date = match fields[..] {
        [year, day] => NaiveDate::from_yo_opt(digits(year, 4)? as i32, digits(day, 3)?)?,
        [year, month, day] => {
            NaiveDate::from_ymd_opt(digits(year, 4)? as i32, digits(month, 2)?, digits(day, 2)?)?
        }
        _ => return None,
    };
    let fields: Vec<&str> = time.split(':').collect();
    let [hour, minute, second] = fields[..] else {
        return None;
    };
    let (second, nanoseconds) = match second.split_once('.') {
        Some((second, fraction)) => (digits(second, 2)?, nanoseconds(fraction)?),
        None => (digits(second, 2)?, 0),
    };
    let (hour, minute) = (digits(hour, 2)?, digits(minute, 2)?);
    stamp(date, (hour, minute, second), nanoseconds)
}

/// The stamp of a date, a time of day and nanoseconds; `None` for a second that the day does not have.
#[must_use]
pub fn stamp(
    date: NaiveDate,
    (hour, minute, second): (u32, u32, u32),
    nanoseconds: i64,
) -> Option<NaiveDateTime> {
    let start = match (hour, minute, second) {
        (23, 59, 60) if ends_with_leap_second(date) => {
            // chrono writes second 60 as second 59 with 1e9 nanoseconds or more.
            date.and_hms_nano_opt(hour, minute, 59, 1_000_000_000)?
        }
        _ => date.and_hms_opt(hour, minute, second)?,
    };
    start.checked_add_signed(TimeDelta::nanoseconds(nanoseconds))
}

/// Reads a date and time of ISO 8601 with an offset from UTC, or none for UTC itself: `…+02:00`, `…-0530`,
/// `…Z`.
#[must_use]
pub fn parse_with_offset(text: &str) -> Option<NaiveDateTime> {
    let (date, time) = text.split_once('T')?;
    // 24:00:00 ends a day, as in 9999-12-31T24:00:00Z, which CZML writes for an open end.
    if let Some(rest) = time.strip_prefix("24:00:00") {
        let start = parse_with_offset(&format!("{date}T00:00:00{rest}"))?;
        return start.checked_add_signed(TimeDelta::days(1));
    }
    let Some(at) = time.rfind(['+', '-']) else {
        return parse(text);
    };
    let (local, offset) = text.split_at(text.len() - time.len() + at);
    let (hours, minutes) = match offset[1..].split_once(':') {
        Some((hours, minutes)) => (digits(hours, 2)?, digits(minutes, 2)?),
        None if offset.len() == 3 => (digits(&offset[1..], 2)?, 0),
        None => (digits(offset.get(1..3)?, 2)?, digits(&offset[3..], 2)?),
    };
    let minutes = i64::from(hours) * 60 + i64::from(minutes);
    let ahead = if offset.starts_with('-') {
        -minutes
    } else {
        minutes
    };
    parse(local)?.checked_sub_signed(TimeDelta::minutes(ahead))
}

/// A number of exactly `count` decimal digits.
fn digits(text: &str, count: usize) -> Option<u32> {
    let all_digits = text.len() == count && text.bytes().all(|byte| byte.is_ascii_digit());
    all_digits.then(|| text.parse().ok())?
}

/// The fraction of a second in nanoseconds, rounded.
fn nanoseconds(fraction: &str) -> Option<i64> {
    if fraction.is_empty() || !fraction.bytes().all(|byte| byte.is_ascii_digit()) {
        return None;
    }
    let (kept, rest) = fraction.split_at(fraction.len().min(9));
    let scale = 10_i64.pow(9 - kept.len() as u32);
    let round_up = rest.bytes().next().is_some_and(|digit| digit >= b'5');
    Some(kept.parse::<i64>().ok()? * scale + i64::from(round_up))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn epoch(text: &str) -> Epoch {
        Epoch::from_utc(text.parse().unwrap())
    }

    #[test]
    fn both_time_codes_are_read() {
        let day = parse("1996-12-18T14:28:15.1172").unwrap();
        assert_eq!(parse("1996-353T14:28:15.1172Z"), Some(day));
        assert_eq!(day.nanosecond(), 117_200_000);
        assert_eq!(
            calendar(day, SecondDigits::FEWEST),
            "1996-12-18T14:28:15.117"
        );
        assert_eq!(
            calendar(day, SecondDigits::of_stamp(day)),
            "1996-12-18T14:28:15.1172"
        );
        let leap = parse("2016-12-31T23:59:60.5").unwrap();
        assert_eq!(
            calendar(leap, SecondDigits::FEWEST),
            "2016-12-31T23:59:60.500"
        );
        for wrong in [
            "2025-13-01T00:00:00",
            "2025-01-01 00:00:00",
            "2025-1-1T00:00:00",
            "2025-01-01T00:00",
            "2025-01-01T00:00:61",
            "2016-12-30T23:59:60",
            "2016-12-31T22:59:60",
            "2025-366T00:00:00",
            "2025-01-01T00:00:00.",
            "+025-01-01T00:00:00",
            "",
        ] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }

    /// GPS time has been 18 s ahead of UTC since 2017, TAI 37 s, TT 69.184 s (IERS Bulletin C), BeiDou time
    /// is always 14 s behind GPS time (BDS-SIS-ICD).
    #[test]
    fn validate_offsets_of_time_systems() {
        let utc = epoch("2025-01-01T00:00:00Z");
        for (system, seconds) in [
            (TimeSystem::Utc, 0.0),
            (TimeSystem::Gps, 18.0),
            (TimeSystem::Tai, 37.0),
            (TimeSystem::Tt, 69.184),
            (TimeSystem::Bdt, 4.0),
        ] {
            let stamp = system.stamp(utc);
            let ahead = (stamp - utc.utc().naive_utc()).as_seconds_f64();
            assert!((ahead - seconds).abs() < 1e-9, "{system}");
            assert_eq!(system.epoch(stamp), utc);
        }
    }

    /// The labels of the leap second of 2016-12-31 and of the adjacent seconds, from ERFA's `utctai` and the
    /// fixed offsets of the other systems.
    #[test]
    fn validate_stamps_over_a_leap_second() {
        for (system, labels) in [
            (
                TimeSystem::Utc,
                [
                    "2016-12-31T23:59:59",
                    "2016-12-31T23:59:60",
                    "2017-01-01T00:00:00",
                ],
            ),
            (
                TimeSystem::Gps,
                [
                    "2017-01-01T00:00:16",
                    "2017-01-01T00:00:17",
                    "2017-01-01T00:00:18",
                ],
            ),
            (
                TimeSystem::Tai,
                [
                    "2017-01-01T00:00:35",
                    "2017-01-01T00:00:36",
                    "2017-01-01T00:00:37",
                ],
            ),
            (
                TimeSystem::Tt,
                [
                    "2017-01-01T00:01:07.184",
                    "2017-01-01T00:01:08.184",
                    "2017-01-01T00:01:09.184",
                ],
            ),
            (
                TimeSystem::Bdt,
                [
                    "2017-01-01T00:00:02",
                    "2017-01-01T00:00:03",
                    "2017-01-01T00:00:04",
                ],
            ),
        ] {
            for (elapsed_s, label) in (0..).zip(labels) {
                let at = epoch("2016-12-31T23:59:59Z").plus_seconds(f64::from(elapsed_s));
                let stamp = parse(label).unwrap();
                assert_eq!(system.stamp(at), stamp, "{system}");
                assert_eq!(system.epoch(stamp), at, "{system}");
            }
        }
    }

    #[test]
    fn digits_follow_the_step() {
        let grid = |step_s| TimeGrid::new(epoch("2025-01-01T00:00:00Z"), 100.0, step_s).unwrap();
        assert_eq!(SecondDigits::of_grid(&grid(60.0)), SecondDigits(3));
        assert_eq!(SecondDigits::of_grid(&grid(0.1)), SecondDigits(3));
        assert_eq!(SecondDigits::of_grid(&grid(0.0625)), SecondDigits(4));
        assert_eq!(SecondDigits::of_grid(&grid(1.0 / 3.0)), SecondDigits(9));
    }
}

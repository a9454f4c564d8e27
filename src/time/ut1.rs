//! Observed UT1 - UTC.

use super::Epoch;
use super::leap::{FIRST_YEAR, tai_minus_utc_s};
use chrono::{Datelike, NaiveDate};

/// UT1 - TAI on the first of each month, one line per year; see `data/MANIFEST.toml`.
const UT1_MINUS_TAI: &str = include_str!("../../data/earth-rotation/ut1-tai.txt");

/// The bound on |UT1 - UTC|, s, that leap seconds maintain (ITU-R TF.460-6).
pub const MOST_UT1_MINUS_UTC_S: f64 = 0.9;

/// UT1 - UTC at an instant, s, accurate to 0.01 s; `None` outside the stored IERS series, which begins in 1972.
#[must_use]
pub fn ut1_minus_utc_s(at: Epoch) -> Option<f64> {
    let date = at.utc().date_naive();
    let first = date.with_day(1)?;
    let next = first.checked_add_months(chrono::Months::new(1))?;
    let (before_s, after_s) = (ut1_minus_tai_s(first)?, ut1_minus_tai_s(next)?);
    let of = |date: NaiveDate| Epoch::from_utc(date.and_time(chrono::NaiveTime::MIN).and_utc());
    let month_s = of(next).seconds_since(of(first));
    let share = at.seconds_since(of(first)) / month_s;
    Some(before_s + share * (after_s - before_s) + tai_minus_utc_s(date) as f64)
}

/// The tabulated value for the first of a month.
fn ut1_minus_tai_s(first: NaiveDate) -> Option<f64> {
    let line = usize::try_from(first.year() - FIRST_YEAR).ok()?;
    let line = UT1_MINUS_TAI.lines().nth(line)?;
    let mut values = line.split(' ').skip(1);
    values.nth(first.month0() as usize)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(text: &str) -> Option<f64> {
        ut1_minus_utc_s(Epoch::from_utc(text.parse().unwrap()))
    }

    /// Values of EOP (IERS) 20 C04 at 0h UTC, one of them in the middle of a month and two across a leap second.
    #[test]
    fn validate_ut1_against_the_iers() {
        for (instant, expected_s) in [
            ("2015-06-30T00:00:00Z", -0.676_031),
            ("2015-07-01T00:00:00Z", 0.323_364),
            ("2025-01-01T00:00:00Z", 0.046_322),
            ("2026-08-15T00:00:00Z", 0.009_450),
        ] {
            let found_s = at(instant).unwrap();
            assert!((found_s - expected_s).abs() < 0.01, "{instant}: {found_s}");
        }
        assert_eq!(at("2030-01-01T00:00:00Z"), None);
        assert_eq!(at("1971-12-31T00:00:00Z"), None);
    }

    #[test]
    fn ut1_stays_near_utc() {
        let first = NaiveDate::from_ymd_opt(1972, 1, 1).unwrap();
        let values: Vec<f64> = (0..)
            .map(|month| first + chrono::Months::new(month))
            .map_while(|date| {
                ut1_minus_utc_s(Epoch::from_utc(date.and_hms_opt(0, 0, 0)?.and_utc()))
            })
            .collect();
        assert!(values.len() > 600);
        assert!(values.iter().all(|s| s.abs() < MOST_UT1_MINUS_UTC_S));
    }
}

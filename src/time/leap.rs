//! Leap seconds: TAI - UTC by date.

use chrono::{Datelike, NaiveDate};

/// The date up to which the table is complete (IERS Bulletin C 72, July 2026); no leap second is assumed after
/// that.
pub const LEAP_SECONDS_END: NaiveDate = NaiveDate::from_ymd_opt(2027, 6, 28).unwrap();

/// The year in which UTC began to differ from TAI by whole seconds.
pub const FIRST_YEAR: i32 = 1972;

/// TAI - UTC on a UTC date, s, including any leap second at its end.
///
/// From SOFA's table. Before 1972, when UTC seconds differed in length from SI seconds, the initial value
/// of 10 s is used.
pub(super) fn tai_minus_utc_s(date: NaiveDate) -> i64 {
    let year = date.year();
    if year < FIRST_YEAR {
        return 10;
    }
    let seconds = sofars::ts::dat(year, date.month() as i32, date.day() as i32, 0.0);
    // The table is in whole seconds and covers every date since 1972.
    seconds.unwrap_or(0.0) as i64
}

/// Whether a UTC date ends with a leap second.
#[must_use]
pub fn ends_with_leap_second(date: NaiveDate) -> bool {
    let next = |date: NaiveDate| date.succ_opt();
    next(date).is_some_and(|next| tai_minus_utc_s(next) > tai_minus_utc_s(date))
}

/// The note on leap seconds that results carry.
#[must_use]
pub fn leap_seconds_note() -> String {
    format!(
        "leap seconds as announced by the IERS up to {LEAP_SECONDS_END}; none is assumed after it"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// IERS Bulletin C: the months that ended with a leap second, and none after the table's end.
    #[test]
    fn validate_leap_seconds_of_the_iers() {
        let first = NaiveDate::from_ymd_opt(1960, 1, 1).unwrap();
        let dates: Vec<String> = first
            .iter_days()
            .take_while(|date| date.year() <= 2100)
            .filter(|date| ends_with_leap_second(*date))
            .map(|date| date.format("%y%m").to_string())
            .collect();
        let expected = "7206 7212 7312 7412 7512 7612 7712 7812 7912 8106 8206 8306 8506 8712 8912 \
                        9012 9206 9306 9406 9512 9706 9812 0512 0812 1206 1506 1612";
        assert_eq!(dates.join(" "), expected);
    }
}

//! Two-line element sets with a name line (3LE), written and read.
//!
//! Columns and digits: Hoots and Roehrich, *Spacetrack Report No. 3* (1980); Vallado et al.,
//! AIAA 2006-6753, appendix B; Space-Track, *Basic Description of the Two Line Element Format*
//! and *Alpha-5*. The name line is the bare name, as `CelesTrak` writes it; the reader also
//! accepts it after `0 `.

mod read;

pub use read::{TleRecord, parse, read};

use crate::formats::WriteError;
use crate::formats::metadata::{CatalogNumber, IdentityError};
use crate::time::Epoch;
use chrono::{Datelike, NaiveDateTime, NaiveTime, TimeDelta, Timelike};
use std::io::Write;
use thiserror::Error;

/// Length of the two lines.
const LINE: usize = 69;

/// Longest name.
const NAME: usize = 24;

/// Nanoseconds in 1e-8 day, the step of a TLE epoch.
const EPOCH_STEP_NS: i64 = 864_000;

/// Nanoseconds in a day without a leap second.
const DAY_NS: i64 = 86_400_000_000_000;

/// An element that exceeds its columns.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TleFieldError {
    /// A number out of the range of its columns.
    #[error("a TLE cannot hold {field} {value}; {bound}")]
    Number {
        /// The element.
        field: &'static str,
        /// Its value.
        value: f64,
        /// What would fit.
        bound: &'static str,
    },
    /// A text that exceeds its columns.
    #[error("a TLE cannot hold {field} '{value}'; {bound}")]
    Text {
        /// The element.
        field: &'static str,
        /// Its value.
        value: String,
        /// What would fit.
        bound: &'static str,
    },
    /// An epoch outside 1957 to 2056, between two steps of 1e-8 day, or inside a leap second.
    #[error(
        "a TLE cannot hold the epoch {0}; it covers 1957 to 2056 in steps of 1e-8 day, without leap seconds"
    )]
    Epoch(NaiveDateTime),
    /// A catalogue number past Alpha-5.
    #[error(transparent)]
    Identity(#[from] IdentityError),
    /// Lines that another reader refuses.
    #[error("the lines cannot be read back: {0}")]
    Unreadable(sgp4::TleError),
}

/// `epoch` on the nearest step of a TLE epoch, 1e-8 day.
///
/// A fraction of a day cannot tell 23:59:60 from the midnight after it: inside a leap second it is that midnight.
#[must_use]
pub fn rounded_epoch(epoch: Epoch) -> Epoch {
    let utc = epoch.utc().naive_utc();
    let step = (since_midnight_ns(utc) + EPOCH_STEP_NS / 2).div_euclid(EPOCH_STEP_NS);
    let since_midnight = TimeDelta::nanoseconds((step * EPOCH_STEP_NS).min(DAY_NS));
    let midnight = utc.date().and_time(NaiveTime::MIN);
    let rounded = midnight.checked_add_signed(since_midnight);
    rounded.map_or(epoch, |rounded| Epoch::from_utc(rounded.and_utc()))
}

fn since_midnight_ns(stamp: NaiveDateTime) -> i64 {
    i64::from(stamp.num_seconds_from_midnight()) * 1_000_000_000 + i64::from(stamp.nanosecond())
}

/// Writes one element set: its name, if it has one, and its two lines.
///
/// # Errors
/// If an element exceeds its columns, or the output fails.
pub fn write(out: &mut impl Write, set: &sgp4::Elements) -> Result<(), WriteError> {
    if let Some(name) = &set.object_name {
        writeln!(out, "{}", name_field(name)?)?;
    }
    for line in lines(set)? {
        writeln!(out, "{line}")?;
    }
    Ok(())
}

/// The two lines of an element set, with their checksums.
///
/// # Errors
/// If an element exceeds its columns.
pub fn lines(set: &sgp4::Elements) -> Result<[String; 2], TleFieldError> {
    let number = u32::try_from(set.norad_id).unwrap_or(u32::MAX);
    let number = CatalogNumber::new(number)?;
    let class = match set.classification {
        sgp4::Classification::Unclassified => 'U',
        sgp4::Classification::Classified => 'C',
        sgp4::Classification::Secret => 'S',
    };
    let first = format!(
        "1 {number}{class} {} {} {} {} {} {} {:>4}",
        designator_field(set.international_designator.as_deref())?,
        epoch_field(set.datetime)?,
        rate_field(set.mean_motion_dot)?,
        exponent_field("mean motion second derivative", set.mean_motion_ddot)?,
        exponent_field("B*", set.drag_term)?,
        counter("ephemeris type", u64::from(set.ephemeris_type), 9)?,
        counter("element set number", set.element_set_number, 9999)?,
    );
    let second = format!(
        "2 {number} {} {} {} {} {} {}{:>5}",
        angle_field("inclination", set.inclination)?,
        angle_field("right ascension", set.right_ascension)?,
        eccentricity_field(set.eccentricity)?,
        angle_field("argument of perigee", set.argument_of_perigee)?,
        angle_field("mean anomaly", set.mean_anomaly)?,
        mean_motion_field(set.mean_motion)?,
        counter("revolution number", set.revolution_number, 99_999)?,
    );
    Ok([first, second].map(|line| {
        let sum = checksum(line.as_bytes());
        format!("{line}{sum}")
    }))
}

/// The element set that a reader finds in the two lines.
///
/// # Errors
/// If an element exceeds its columns.
pub fn as_written(set: &sgp4::Elements) -> Result<sgp4::Elements, TleFieldError> {
    let [first, second] = lines(set)?;
    let name = set.object_name.clone();
    read::set_of_lines(name, [&first, &second]).map_err(TleFieldError::Unreadable)
}

/// Sum of the digits modulo 10, a minus sign counting 1.
fn checksum(line: &[u8]) -> u32 {
    let value = |byte: &u8| match byte {
        b'0'..=b'9' => u32::from(byte - b'0'),
        b'-' => 1,
        _ => 0,
    };
    line.iter().map(value).sum::<u32>() % 10
}

/// Whether a TLE can hold an international designator.
pub(crate) fn holds_designator(designator: &str) -> bool {
    designator_field(Some(designator)).is_ok()
}

/// A name that begins with what marks a name line is marked itself.
fn name_field(name: &str) -> Result<String, TleFieldError> {
    let printable = name.bytes().all(|byte| (b' '..=b'~').contains(&byte));
    let fits = (1..=NAME).contains(&name.len()) && printable && name.trim() == name;
    if fits {
        let mark = if name.starts_with("0 ") { "0 " } else { "" };
        return Ok(format!("{mark}{name}"));
    }
    Err(TleFieldError::Text {
        field: "name",
        value: name.to_owned(),
        bound: "1 to 24 printable ASCII characters",
    })
}

/// `1998-067A` as `98067A  `; blank if there is none.
fn designator_field(designator: Option<&str>) -> Result<String, TleFieldError> {
    let Some(text) = designator else {
        return Ok(" ".repeat(8));
    };
    let wrong = || TleFieldError::Text {
        field: "international designator",
        value: text.to_owned(),
        bound: "year-launch-piece as 1998-067A, years 1957 to 2056",
    };
    let (year, rest) = text.split_once('-').ok_or_else(wrong)?;
    let (launch, piece) = rest.split_at_checked(3).ok_or_else(wrong)?;
    let digits = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    let letters = piece.bytes().all(|byte| byte.is_ascii_uppercase());
    let year: i32 = year.parse().map_err(|_| wrong())?;
    let year = two_digit_year(year).ok_or_else(wrong)?;
    if digits(launch) && letters && (1..=3).contains(&piece.len()) {
        Ok(format!("{year:02}{launch}{piece:<3}"))
    } else {
        Err(wrong())
    }
}

fn two_digit_year(year: i32) -> Option<i32> {
    (1957..=2056).contains(&year).then_some(year % 100)
}

fn epoch_field(epoch: NaiveDateTime) -> Result<String, TleFieldError> {
    let wrong = || TleFieldError::Epoch(epoch);
    let year = two_digit_year(epoch.year()).ok_or_else(wrong)?;
    let since_midnight = since_midnight_ns(epoch);
    if since_midnight % EPOCH_STEP_NS != 0 || since_midnight >= DAY_NS {
        return Err(wrong());
    }
    let fraction = since_midnight / EPOCH_STEP_NS;
    Ok(format!("{year:02}{:03}.{fraction:08}", epoch.ordinal()))
}

/// The sign of a column that has no room for a plus.
fn sign(value: f64) -> char {
    if value < 0.0 { '-' } else { ' ' }
}

/// `-0.00002182` as `-.00002182`.
fn rate_field(value: f64) -> Result<String, TleFieldError> {
    let digits = format!("{:.8}", value.abs());
    match digits.strip_prefix("0.") {
        Some(decimals) => Ok(format!("{}.{decimals}", sign(value))),
        None => Err(TleFieldError::Number {
            field: "mean motion derivative",
            value,
            bound: "its columns allow less than 1 rev/day²",
        }),
    }
}

/// `-0.11606e-4` as `-11606-4`: five digits after an assumed decimal point, and a power of ten.
fn exponent_field(field: &'static str, value: f64) -> Result<String, TleFieldError> {
    // Below the smallest power of ten the mantissa has zeros in front; less than half a digit is 0.
    let last_digits = (value.abs() * 1e14).round();
    if last_digits == 0.0 {
        return Ok(" 00000-0".to_owned());
    }
    if last_digits < 10_000.0 {
        return Ok(format!("{}{last_digits:05}-9", sign(value)));
    }
    let wrong = TleFieldError::Number {
        field,
        value,
        bound: "its columns allow less than 1e9",
    };
    // One digit before the point in Rust's notation, none in a TLE's.
    let scientific = format!("{:.4e}", value.abs());
    let Some((mantissa, exponent)) = scientific.split_once('e') else {
        return Err(wrong);
    };
    let mantissa: String = mantissa.chars().filter(char::is_ascii_digit).collect();
    match exponent.parse::<i32>() {
        Ok(exponent) if (-10..=8).contains(&exponent) && mantissa.len() == 5 => {
            let exponent = exponent + 1;
            let exponent_sign = if exponent < 0 { '-' } else { '+' };
            let size = exponent.abs();
            Ok(format!("{}{mantissa}{exponent_sign}{size}", sign(value)))
        }
        _ => Err(wrong),
    }
}

fn angle_field(field: &'static str, degrees: f64) -> Result<String, TleFieldError> {
    let text = format!("{degrees:8.4}");
    match text.as_str() {
        "360.0000" if field != "inclination" => Ok("  0.0000".to_owned()),
        "360.0000" => Err(angle_error(field, degrees)),
        _ if (0.0..360.0).contains(&degrees) => Ok(text),
        _ => Err(angle_error(field, degrees)),
    }
}

fn angle_error(field: &'static str, value: f64) -> TleFieldError {
    TleFieldError::Number {
        field,
        value,
        bound: "angles must be within 0 to 360°",
    }
}

fn eccentricity_field(value: f64) -> Result<String, TleFieldError> {
    let text = format!("{value:.7}");
    text.strip_prefix("0.")
        .map(str::to_owned)
        .ok_or(TleFieldError::Number {
            field: "eccentricity",
            value,
            bound: "its columns allow 0 to 0.9999999",
        })
}

fn mean_motion_field(rev_day: f64) -> Result<String, TleFieldError> {
    let text = format!("{rev_day:11.8}");
    if rev_day > 0.0 && text.len() == 11 {
        Ok(text)
    } else {
        Err(TleFieldError::Number {
            field: "mean motion",
            value: rev_day,
            bound: "its columns allow 0 to 99.99999999 rev/day",
        })
    }
}

fn counter(field: &'static str, value: u64, most: u64) -> Result<u64, TleFieldError> {
    if value <= most {
        return Ok(value);
    }
    Err(TleFieldError::Number {
        field,
        value: value as f64,
        bound: "the number has too many digits",
    })
}

#[cfg(test)]
mod tests;

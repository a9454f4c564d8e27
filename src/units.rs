//! Angle and time units, decimal rounding and counts.

use std::f64::consts::{PI, TAU};

/// Seconds in a day of 86 400 SI seconds.
pub const SECONDS_PER_DAY: f64 = 86_400.0;
/// Days of a Julian year.
pub const DAYS_PER_YEAR: f64 = 365.25;

/// Seconds in an hour.
pub const SECONDS_PER_HOUR: f64 = 3_600.0;

/// Minutes in a day.
pub const MINUTES_PER_DAY: f64 = 1_440.0;

/// An angle wrapped to [0, 2π), radians.
#[must_use]
pub fn wrap_two_pi(angle_rad: f64) -> f64 {
    let wrapped = angle_rad.rem_euclid(TAU);
    // rem_euclid of a tiny negative number rounds up to the modulus itself.
    if wrapped >= TAU { 0.0 } else { wrapped }
}

/// An angle wrapped to [-π, π), radians.
#[must_use]
pub fn wrap_pi(angle_rad: f64) -> f64 {
    wrap_two_pi(angle_rad + PI) - PI
}

/// An angle wrapped to [0, 360), degrees.
#[must_use]
pub fn wrap_360(angle_deg: f64) -> f64 {
    let wrapped = angle_deg.rem_euclid(360.0);
    if wrapped >= 360.0 { 0.0 } else { wrapped }
}

/// `value` rounded to `digits` decimals: the double nearest to its decimal text.
///
/// Going through text keeps the shortest round-trip form short: `0.1 + 0.2`
/// rounded to three digits is the double nearest 0.3, which prints as `0.3`.
#[must_use]
pub fn round_decimal(value: f64, digits: usize) -> f64 {
    let text = format!("{value:.digits$}");
    // A formatted finite number always parses; anything else is returned unchanged.
    text.parse().map_or(value, |rounded: f64| rounded + 0.0)
}

/// A count with its noun: `1 satellite`, `2 satellites`.
#[must_use]
pub fn counted(count: usize, noun: &str) -> String {
    let plural = if count == 1 { "" } else { "s" };
    format!("{count} {noun}{plural}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrapping_stays_below_the_modulus() {
        assert_eq!(wrap_two_pi(-1e-20), 0.0);
        assert_eq!(wrap_360(-1e-20), 0.0);
        assert_eq!(wrap_360(725.0), 5.0);
        assert!((wrap_pi(1.5 * PI) + 0.5 * PI).abs() < 1e-15);
    }

    #[test]
    fn decimal_rounding_gives_short_numbers() {
        assert_eq!(round_decimal(0.1 + 0.2, 3).to_string(), "0.3");
        assert_eq!(round_decimal(-1e-9, 4).to_string(), "0");
        assert_eq!(round_decimal(43.827_364_651, 4).to_string(), "43.8274");
    }
}

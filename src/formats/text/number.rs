//! Decimal numbers in formats that do not define a notation for them.

use crate::formats::text::finding::FindingList;

/// Largest magnitude that is read: rounded to fewer digits it is still a number, and no quantity is as large.
const LARGEST: f64 = 1e300;

/// A finite decimal number with a C or Fortran exponent; a finding under `rule` if the text is not one.
pub(crate) fn read(
    text: &str,
    place: (usize, usize),
    rule: &'static str,
    findings: &mut FindingList,
) -> Option<f64> {
    let is_of_number = |byte: u8| {
        byte.is_ascii_digit() || matches!(byte, b'+' | b'-' | b'.' | b'e' | b'E' | b'd' | b'D')
    };
    // Rust would also accept "inf" and "nan".
    let value = match text.bytes().all(is_of_number) {
        true => text.replace(['d', 'D'], "e").parse::<f64>().ok(),
        false => None,
    };
    let value = value.filter(|value| value.abs() <= LARGEST);
    if value.is_none() {
        findings.error(place, rule, format!("'{text}' is not a number"));
    }
    value
}

/// A number read by [`read`] as a count, an identifier or a code; a finding under `rule` if it is not whole, or
/// negative.
pub(crate) fn whole(
    value: f64,
    place: (usize, usize),
    rule: &'static str,
    findings: &mut FindingList,
) -> Option<u32> {
    let is_whole = value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value);
    if !is_whole {
        let message = format!("{value} is not a whole number, 0 or more");
        findings.error(place, rule, message);
    }
    is_whole.then_some(value as u32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_c_and_fortran_are_read() {
        let mut findings = FindingList::of_linter(20);
        for (text, value) in [
            ("1", Some(1.0)),
            (".5", Some(0.5)),
            ("-2.", Some(-2.0)),
            ("+3.5E-003", Some(0.0035)),
            ("1.25D+02", Some(125.0)),
            ("0.12345678901234567890", Some(0.123_456_789_012_345_68)),
            ("nan", None),
            ("inf", None),
            ("1e999", None),
            ("-1.7976931348623157e308", None),
            ("", None),
            ("1,5", None),
        ] {
            assert_eq!(
                read(text, (1, 1), "a-number", &mut findings),
                value,
                "{text}"
            );
        }
        assert_eq!(findings.into_vec().len(), 6);
    }
}

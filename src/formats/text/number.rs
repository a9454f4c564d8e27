//! Decimal numbers, as every format writes them.

use crate::formats::text::finding::FindingList;

/// A finite decimal number, perhaps with an exponent; Rust alone would also take `inf` and `nan`.
pub(crate) fn decimal(text: &str) -> Option<f64> {
    let is_decimal = |byte: u8| byte.is_ascii_digit() || b"+-.eE".contains(&byte);
    let value = text.parse::<f64>().ok()?;
    (value.is_finite() && text.bytes().all(is_decimal)).then_some(value)
}

/// Reads a number; a finding of `rule` if it is none.
pub(crate) fn read_number(
    text: &str,
    place: (usize, usize),
    rule: &'static str,
    findings: &mut FindingList,
) -> Option<f64> {
    let value = decimal(text);
    if value.is_none() {
        findings.error(place, rule, format!("'{text}' is not a number"));
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_finite_decimals() {
        for (text, value) in [
            ("1", Some(1.0)),
            ("-.5e-3", Some(-0.5e-3)),
            ("+7.", Some(7.0)),
            ("nan", None),
            ("-inf", None),
            ("infinity", None),
            ("1e999", None),
            ("0x10", None),
            ("1_0", None),
            ("", None),
        ] {
            assert_eq!(decimal(text), value, "{text}");
        }
    }
}

//! Numbers as they are written into a scenario file.

/// Whole numbers up to here are written without point or exponent; every one
/// of them is exact in an `f64` and an integer of TOML.
const PLAIN_WHOLE: f64 = 1e15;

/// The shortest TOML number that reads back as the same finite `f64`.
pub(super) fn toml_number(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < PLAIN_WHOLE {
        format!("{number}")
    } else {
        format!("{number:?}")
    }
}

/// A basic TOML string. The rules of text values let no control character in.
pub(super) fn toml_text(text: &str) -> String {
    let escaped = text.replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{escaped}\"")
}

//! Numbers as written to a scenario file.

/// Integers up to this value are written without point or exponent; each is exact in an
/// `f64` and in a TOML integer.
const PLAIN_WHOLE: f64 = 1e15;

/// The shortest TOML number that reads back as the same finite `f64`.
pub(super) fn toml_number(number: f64) -> String {
    if number.fract() == 0.0 && number.abs() < PLAIN_WHOLE {
        format!("{number}")
    } else {
        format!("{number:?}")
    }
}

/// A basic TOML string. The rules of text values exclude control characters.
pub(super) fn toml_text(text: &str) -> String {
    let escaped = text.replace('\\', "\\\\").replace('"', "\\\"");
    format!("\"{escaped}\"")
}

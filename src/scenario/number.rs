//! Numbers and texts as written to a scenario file.

use crate::printable::is_obeyed;

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

/// A basic TOML string, with escapes for what a terminal would obey.
pub(super) fn toml_text(text: &str) -> String {
    let mut written = String::from("\"");
    for character in text.chars() {
        match character {
            '\\' | '"' => written.extend(['\\', character]),
            obeyed if is_obeyed(obeyed) => written += &format!("\\U{:08X}", u32::from(obeyed)),
            plain => written.push(plain),
        }
    }
    written + "\""
}

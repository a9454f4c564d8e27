//! Compact numbers: 16 bits each, scaled to their own range, as base64.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde::Serialize;

/// Code of a missing value; finite values use the codes below.
const MISSING: u16 = u16::MAX;

/// A row of numbers: value = lo + (hi - lo) code / 65534, code 65535 for a missing value; codes as
/// little-endian base64.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(super) struct Packed {
    lo: f64,
    hi: f64,
    codes: String,
}

impl Packed {
    pub(super) fn new(values: impl Iterator<Item = Option<f64>>) -> Self {
        let values: Vec<Option<f64>> = values.map(|x| x.filter(|x| x.is_finite())).collect();
        let present = || values.iter().flatten().copied();
        let lo = present().fold(f64::INFINITY, f64::min);
        let hi = present().fold(f64::NEG_INFINITY, f64::max);
        let (lo, hi) = if lo > hi { (0.0, 0.0) } else { (lo, hi) };
        let step = (hi - lo) / f64::from(MISSING - 1);
        let code = |value: &Option<f64>| match value {
            None => MISSING,
            Some(_) if step == 0.0 => 0,
            Some(value) => ((value - lo) / step).round() as u16,
        };
        let bytes: Vec<u8> = values.iter().flat_map(|v| code(v).to_le_bytes()).collect();
        Self {
            lo,
            hi,
            codes: STANDARD.encode(bytes),
        }
    }

    pub(super) fn of(values: impl Iterator<Item = f64>) -> Self {
        Self::new(values.map(Some))
    }
}

/// A number with six significant digits.
pub(super) fn short(value: f64) -> f64 {
    let text = format!("{value:.5e}");
    // Formatted just above, so it parses.
    text.parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(packed: &Packed) -> Vec<u16> {
        let bytes = STANDARD.decode(&packed.codes).unwrap();
        bytes
            .chunks(2)
            .map(|b| u16::from_le_bytes([b[0], b[1]]))
            .collect()
    }

    #[test]
    fn numbers_keep_their_range_and_their_gaps() {
        let packed = Packed::new([Some(1.0), None, Some(3.0), Some(2.0)].into_iter());
        assert_eq!((packed.lo, packed.hi), (1.0, 3.0));
        assert_eq!(codes(&packed), [0, 65535, 65534, 32767]);
        let constant = Packed::of([7.0, 7.0].into_iter());
        assert_eq!((constant.lo, codes(&constant)), (7.0, vec![0, 0]));
        let nothing = Packed::new([None, Some(f64::NAN)].into_iter());
        assert_eq!((nothing.lo, codes(&nothing)), (0.0, vec![65535, 65535]));
    }

    #[test]
    fn short_numbers_have_six_digits() {
        assert_eq!(short(1.234_567_89), 1.23457);
        assert_eq!(short(-123_456_789.0), -123_457_000.0);
        assert_eq!(short(0.0), 0.0);
    }
}

//! Numbers with a fixed count of decimals, for files of millions of them: integers instead of the general formatter of floats, which
//! takes twice as long for the same digits.

use std::fmt;

/// A number that is written with so many decimals, at most 12, like `{:.9}` of it: the exact value rounded half to even.
pub(crate) struct FixedDecimals<const DECIMALS: usize>(pub(crate) f64);

const FRACTION_BITS: u32 = f64::MANTISSA_DIGITS - 1;
/// Of `f64`: that of a subnormal as a whole number of units.
const LEAST_EXPONENT: i32 = f64::MIN_EXP - f64::MANTISSA_DIGITS as i32;

impl<const DECIMALS: usize> FixedDecimals<DECIMALS> {
    const ONE: u64 = 10_u64.pow(DECIMALS as u32);

    /// The magnitude in units of the last decimal; `None` if it is not finite or takes more than 64 bits.
    fn units(&self) -> Option<u64> {
        let bits = self.0.to_bits();
        let biased = (bits >> FRACTION_BITS & 0x7ff) as i32;
        let fraction = bits & ((1 << FRACTION_BITS) - 1);
        let (mantissa, exponent) = match biased {
            0x7ff => return None,
            0 => (fraction, LEAST_EXPONENT),
            _ => (fraction | 1 << FRACTION_BITS, LEAST_EXPONENT + biased - 1),
        };
        let Ok(shift) = u32::try_from(-exponent) else {
            return None;
        };
        if shift == 0 {
            return None;
        }
        // 53 bits times 40 of 10^12 at most.
        let scaled = u128::from(mantissa) * u128::from(Self::ONE);
        if shift > 100 {
            return Some(0);
        }
        let whole = scaled >> shift;
        let rest = scaled & ((1 << shift) - 1);
        let half = 1 << (shift - 1);
        let up = rest > half || (rest == half && whole & 1 == 1);
        u64::try_from(whole + u128::from(up)).ok()
    }
}

impl<const DECIMALS: usize> fmt::Display for FixedDecimals<DECIMALS> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(units) = self.units() else {
            return write!(f, "{:.DECIMALS$}", self.0);
        };
        let (mut whole, mut rest) = (units / Self::ONE, units % Self::ONE);
        // A sign, 20 digits of 64 bits, and a point.
        let mut buffer = [b'0'; 22];
        let mut place = buffer.len();
        let mut put = |byte: u8| {
            place -= 1;
            buffer[place] = byte;
        };
        for _ in 0..DECIMALS {
            put(b'0' + (rest % 10) as u8);
            rest /= 10;
        }
        put(b'.');
        loop {
            put(b'0' + (whole % 10) as u8);
            whole /= 10;
            if whole == 0 {
                break;
            }
        }
        if self.0.is_sign_negative() {
            put(b'-');
        }
        f.write_str(str::from_utf8(&buffer[place..]).map_err(|_| fmt::Error)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn same(x: f64) {
        assert_eq!(FixedDecimals::<9>(x).to_string(), format!("{x:.9}"));
        assert_eq!(FixedDecimals::<12>(x).to_string(), format!("{x:.12}"));
    }

    #[test]
    fn edges_are_written_like_floats() {
        for x in [
            0.0,
            1.0,
            f64::MIN_POSITIVE,
            f64::EPSILON,
            f64::MAX,
            f64::INFINITY,
            f64::NAN,
            5e-324,
            // Around 2^53 and where units leave 64 bits.
            9_007_199_254_740_991.0,
            9_007_199_254_740_992.0,
            18_446_744.073_709_55,
            18_446_744_073.709_55,
            999_999.999_999_999_9,
        ] {
            same(x);
            same(-x);
        }
    }

    proptest! {
        #[test]
        fn coordinates_are_written_like_floats(x in -1e5_f64..1e5) {
            same(x);
            same(x * 1e-9);
        }

        #[test]
        fn any_bits_are_written_like_floats(bits in any::<u64>()) {
            same(f64::from_bits(bits));
        }

        /// Multiples of powers of two lie half-way between two decimals now and then.
        #[test]
        fn halves_are_rounded_like_floats(n in -1_000_000_i32..1_000_000, power in 8_i32..16) {
            same(f64::from(n) / 2_f64.powi(power));
        }
    }
}

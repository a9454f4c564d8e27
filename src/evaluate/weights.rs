//! Weights of points as whole numbers.
//!
//! Sums of whole numbers do not depend on their order: every path counts the same weight to the bit, on
//! any number of threads.

use super::Setup;

/// Bits of the weight of all samples together.
const TOTAL_BITS: u32 = 62;

/// Most bits of the weight of a point; beyond that its f64 is not exact.
const POINT_BITS: u32 = 40;

/// The weight of each point, in units of a power of two; 1 where all weights are equal.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct WholeWeights {
    points: Vec<u64>,
    /// Of all samples.
    total: u64,
}

impl WholeWeights {
    pub(super) fn new(setup: &Setup) -> Self {
        let points = if setup.has_equal_weights() {
            vec![1; setup.sites.len()]
        } else {
            let largest = setup
                .sites
                .iter()
                .map(|site| site.weight)
                .fold(0.0, f64::max);
            let unit = Unit::new(largest, setup.sample_count());
            setup
                .sites
                .iter()
                .map(|site| unit.whole(site.weight))
                .collect()
        };
        let total = points.iter().sum::<u64>() * setup.grid.len() as u64;
        Self { points, total }
    }

    /// The weight of a point.
    pub(super) fn of(&self, site: usize) -> u64 {
        self.points[site]
    }

    /// The weight of all samples.
    pub(super) fn total(&self) -> u64 {
        self.total
    }
}

/// The unit in which weights are counted: 2^`exponent` / 2^`bits`.
struct Unit {
    exponent: i32,
    bits: u32,
}

impl Unit {
    /// The smallest unit in which the weight of all samples fits, if none weighs more than `largest`.
    fn new(largest: f64, samples: usize) -> Self {
        let sample_bits = usize::BITS - samples.leading_zeros();
        Self {
            exponent: exponent_above(largest),
            bits: TOTAL_BITS.saturating_sub(sample_bits).clamp(1, POINT_BITS),
        }
    }

    /// Rounded, and at least 1: a point counts, however little.
    fn whole(&self, weight: f64) -> u64 {
        let share = weight / power_of_two(self.exponent - 1) / 2.0;
        ((share * power_of_two(self.bits as i32)).round() as u64).max(1)
    }
}

/// The smallest n with `value` < 2^n, or a larger one for the smallest numbers of all.
fn exponent_above(value: f64) -> i32 {
    let biased = (value.to_bits() >> (f64::MANTISSA_DIGITS - 1)) as i32;
    biased.max(1) - (f64::MAX_EXP - 1) + 1
}

/// 2^n, for n from -1022 to 1023.
fn power_of_two(n: i32) -> f64 {
    let biased = (n + f64::MAX_EXP - 1) as u64;
    f64::from_bits(biased << (f64::MANTISSA_DIGITS - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whole weights keep their ratios to their rounding, half a unit of 2^-40 each, up to the largest and down to the
    /// smallest numbers.
    #[test]
    fn whole_weights_keep_their_ratios() {
        for scale in [1.0, 1e-300, 3e300, f64::MIN_POSITIVE / 1024.0] {
            let unit = Unit::new(5.0 * scale, 205_920);
            let one = unit.whole(scale);
            assert!(unit.whole(5.0 * scale).abs_diff(5 * one) <= 3, "{scale:e}");
            // The unit follows the largest weight, but for the smallest numbers of all.
            let least = if scale < f64::MIN_POSITIVE {
                1
            } else {
                1 << (unit.bits - 4)
            };
            assert!(one > least, "{scale:e}: {one}");
            assert!(unit.whole(5.0 * scale) <= 1 << unit.bits);
        }
        assert_eq!(power_of_two(-3), 0.125);
        assert_eq!((exponent_above(1.0), exponent_above(0.75)), (1, 0));
    }

    #[test]
    fn every_point_counts_and_the_total_fits() {
        let samples = 6_500_000 * 1440;
        let unit = Unit::new(1.0, samples);
        assert_eq!(unit.whole(1e-300), 1);
        assert!(
            unit.whole(1.0)
                .checked_mul(samples as u64)
                .is_some_and(|x| x < 1 << TOTAL_BITS)
        );
    }
}

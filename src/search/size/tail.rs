//! A lower bound of the mean of the worst samples, without storing them.

/// Bits of an f32 that the places ignore: they use 7 of the 23 bits of the fraction, so that a place is 0.8 % wide.
const TRAILING_BITS: u32 = 16;

/// The first place begins at 2^-7, which no PDOP of fewer than 147 000 satellites is below.
const FIRST: u32 = (127 - 7) << (23 - TRAILING_BITS);

/// The last place is that of 2^20 and beyond, above any `pdop-cap`.
const LAST: u32 = (127 + 20) << (23 - TRAILING_BITS);

/// Weight and weighted sum of the values in each place.
pub(super) struct TailCounts {
    places: Vec<(u64, f64)>,
}

impl TailCounts {
    pub(super) fn new() -> Self {
        Self {
            places: vec![(0, 0.0); (LAST - FIRST + 1) as usize],
        }
    }

    /// Adds a finite value that is not negative.
    pub(super) fn add(&mut self, value: f32, weight: u64) {
        let leading = (value.to_bits() >> TRAILING_BITS).clamp(FIRST, LAST);
        let place = &mut self.places[(leading - FIRST) as usize];
        place.0 += weight;
        place.1 += weight as f64 * f64::from(value);
    }

    /// At least this is the mean of the worst values of a weight, if all others are at least `least`.
    pub(super) fn mean_of_worst(&self, weight: f64, least: f64) -> f64 {
        let (mut rest, mut sum) = (weight, 0.0);
        for (place, &(here, of_place)) in self.places.iter().enumerate().rev() {
            if here == 0 {
                continue;
            }
            if here as f64 <= rest {
                rest -= here as f64;
                sum += of_place;
            } else {
                // Values below the first edge are in the first place too.
                let edge = match place {
                    0 => 0.0,
                    _ => f64::from(f32::from_bits((FIRST + place as u32) << TRAILING_BITS)),
                };
                return (sum + rest * edge.max(least)) / weight;
            }
        }
        (sum + rest * least) / weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stats::{Level, Weighted, weighted_cvar};
    use proptest::prelude::*;

    proptest! {
        /// Of any part of some values, the bound is at most the CVaR of all of them, and of all within a place of it.
        #[test]
        fn validate_bound_against_cvar(
            values in prop::collection::vec((0.9_f32..40.0, 1_u64..4), 1..200), part in 0.0..1.0_f64, level in 0.05..0.99_f64,
        ) {
            let total: u64 = values.iter().map(|(_, weight)| weight).sum();
            let mut sample: Vec<Weighted> = values
                .iter()
                .map(|&(value, weight)| Weighted { value: value.into(), weight: weight as f64 })
                .collect();
            let cvar = weighted_cvar(&mut sample, Level::new(level).unwrap()).unwrap();
            let of_first = |count: usize| {
                let mut tail = TailCounts::new();
                values[..count].iter().for_each(|&(value, weight)| tail.add(value, weight));
                tail.mean_of_worst((1.0 - level) * total as f64, 0.9)
            };
            let some = of_first((part * values.len() as f64) as usize);
            let all = of_first(values.len());
            let rounding = 1.0 + 1e-8;
            prop_assert!(some <= cvar * rounding && all <= cvar * rounding, "{some} {all} {cvar}");
            prop_assert!(all >= cvar / 1.008, "{all} {cvar}");
        }
    }
}

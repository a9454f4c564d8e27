//! The same statistics for a weighted sample.
//!
//! A value of weight k counts as k values of weight one. With equal weights every function is
//! bit-identical to its unweighted counterpart.

use super::{Level, Summary};

/// A value and its weight, a positive number.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// The value.
    pub value: f64,
    /// Its weight.
    pub weight: f64,
}

/// A sample in ascending order, with the sum of its weights.
struct Sorted<'a> {
    sample: &'a [Weighted],
    total: f64,
}

impl<'a> Sorted<'a> {
    fn new(sample: &'a mut [Weighted]) -> Self {
        // Equal values are ordered by weight, so that no sum depends on the order of the samples.
        sample.sort_unstable_by(|a, b| {
            let by_value = a.value.total_cmp(&b.value);
            by_value.then_with(|| a.weight.total_cmp(&b.weight))
        });
        let total = sample.iter().map(|x| x.weight).sum();
        Self { sample, total }
    }

    /// The smallest value at which the cumulative weight reaches the fraction `q` of the total minus
    /// 1e-9 of the mean weight ([M-28](crate::models#m-28) with weights), and the index after it.
    fn quantile(&self, q: f64) -> Option<(f64, usize)> {
        let slack = 1e-9 * self.total / self.sample.len() as f64;
        let wanted = q * self.total - slack;
        let mut reached = 0.0;
        for (n, x) in self.sample.iter().enumerate() {
            reached += x.weight;
            if reached >= wanted {
                return Some((x.value, n + 1));
            }
        }
        // Rounding may leave the sum short of a level close to 1.
        let last = self.sample.last()?;
        Some((last.value, self.sample.len()))
    }

    fn cvar(&self, level: Level) -> Option<f64> {
        let (value_at_risk, behind) = self.quantile(level.get())?;
        let excess: f64 = self.sample[behind..]
            .iter()
            .map(|x| x.weight * (x.value - value_at_risk))
            .sum();
        Some(value_at_risk + excess / ((1.0 - level.get()) * self.total))
    }
}

/// The values, if all weights are equal.
fn of_equal_weights(sample: &[Weighted]) -> Option<Vec<f64>> {
    let first = sample.first()?.weight;
    let equal = sample.iter().all(|x| x.weight == first);
    equal.then(|| sample.iter().map(|x| x.value).collect())
}

/// Σ w x / Σ w; `None` for an empty sample.
#[must_use]
pub fn weighted_mean(sample: &[Weighted]) -> Option<f64> {
    if let Some(values) = of_equal_weights(sample) {
        return Some(values.iter().sum::<f64>() / values.len() as f64);
    }
    let total: f64 = sample.iter().map(|x| x.weight).sum();
    let sum: f64 = sample.iter().map(|x| x.weight * x.value).sum();
    (!sample.is_empty()).then(|| sum / total)
}

/// The quantile of level `q`: the smallest value with at least the fraction `q` of the weight at
/// or below it ([M-28](crate::models#m-28)); `None` for an empty sample. Reorders `sample`.
#[must_use]
pub fn weighted_quantile(sample: &mut [Weighted], q: Level) -> Option<f64> {
    if let Some(mut values) = of_equal_weights(sample) {
        return super::quantile(&mut values, q);
    }
    Sorted::new(sample)
        .quantile(q.get())
        .map(|(value, _)| value)
}

/// Conditional value-at-risk: the mean of the worst 1 - α of the weight (Rockafellar and
/// Uryasev, *J. Banking & Finance* 26 (2002), proposition 8; [M-29](crate::models#m-29)). `None`
/// for an empty sample. Reorders `sample`.
#[must_use]
pub fn weighted_cvar(sample: &mut [Weighted], level: Level) -> Option<f64> {
    if let Some(mut values) = of_equal_weights(sample) {
        return super::cvar(&mut values, level);
    }
    Sorted::new(sample).cvar(level)
}

/// All statistics of one sample; `None` if it is empty. Reorders `sample`.
#[must_use]
pub fn summarize_weighted(sample: &mut [Weighted], level: Level) -> Option<Summary> {
    if let Some(mut values) = of_equal_weights(sample) {
        return super::summarize(&mut values, level);
    }
    let mean = weighted_mean(sample)?;
    let sorted = Sorted::new(sample);
    Some(Summary {
        mean,
        p50: sorted.quantile(0.50)?.0,
        p95: sorted.quantile(0.95)?.0,
        p99: sorted.quantile(0.99)?.0,
        max: sorted.sample.last()?.value,
        cvar: sorted.cvar(level)?,
    })
}

#[cfg(test)]
mod tests {
    use super::super::{cvar, quantile, summarize};
    use super::*;
    use proptest::prelude::*;

    fn level(q: f64) -> Level {
        Level::new(q).unwrap()
    }

    fn with_weight(values: &[f64], weight: f64) -> Vec<Weighted> {
        values
            .iter()
            .map(|&value| Weighted { value, weight })
            .collect()
    }

    /// Weights 1, 2, 3, 4 on 1, 2, 3, 4: mean 30/10; half of the weight is reached at 3; the
    /// worst 60 % is all of the 4 and two thirds of the 3, (4 · 4 + 2 · 3)/6.
    #[test]
    fn validate_a_small_weighted_sample() {
        let mut sample: Vec<_> = [4.0, 2.0, 1.0, 3.0]
            .map(|x| Weighted {
                value: x,
                weight: x,
            })
            .to_vec();
        assert!((weighted_mean(&sample).unwrap() - 3.0).abs() < 1e-15);
        assert_eq!(weighted_quantile(&mut sample, level(0.5)), Some(3.0));
        assert_eq!(weighted_quantile(&mut sample, level(0.6)), Some(3.0));
        assert_eq!(weighted_quantile(&mut sample, level(0.61)), Some(4.0));
        let tail = weighted_cvar(&mut sample, level(0.4)).unwrap();
        assert!((tail - 22.0 / 6.0).abs() < 1e-14, "{tail}");
        let summary = summarize_weighted(&mut sample, level(0.4)).unwrap();
        assert_eq!((summary.max, summary.p95, summary.cvar), (4.0, 4.0, tail));
    }

    /// A level is reached within 1e-9 of the mean weight, whatever the unit of the weights: with total 10 and mean 2.5, six
    /// tenths are exceeded by 1e-9 of the total and not by 1e-10.
    #[test]
    fn a_level_is_reached_within_the_slack() {
        for unit in [1e-9, 1.0, 1e9] {
            let weighted = |x: f64| Weighted {
                value: x,
                weight: x * unit,
            };
            let mut sample: Vec<_> = [4.0, 2.0, 1.0, 3.0].map(weighted).to_vec();
            for (q, expected) in [
                (0.5, 3.0),
                (0.6 + 1e-10, 3.0),
                (0.6 + 1e-9, 4.0),
                (0.3 - 1e-9, 2.0),
                (0.1 + 1e-9, 2.0),
            ] {
                let found = weighted_quantile(&mut sample, level(q));
                assert_eq!(found, Some(expected), "{q} of {unit}");
            }
        }
    }

    #[test]
    fn an_empty_sample_has_no_statistics() {
        assert_eq!(weighted_mean(&[]), None);
        assert_eq!(weighted_quantile(&mut [], level(0.5)), None);
        assert_eq!(weighted_cvar(&mut [], level(0.5)), None);
        assert_eq!(summarize_weighted(&mut [], level(0.5)), None);
    }

    proptest! {
        /// Equal weights of any size give the unweighted statistics to the bit.
        #[test]
        fn equal_weights_are_no_weights(
            values in prop::collection::vec(1.0..9.0_f64, 1..60),
            weight in 1e-3..1e3_f64,
            q in 0.01..0.99_f64,
        ) {
            let mut weighted = with_weight(&values, weight);
            let mut plain = values.clone();
            let expected = summarize(&mut plain.clone(), level(q));
            prop_assert_eq!(summarize_weighted(&mut weighted, level(q)), expected);
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            prop_assert_eq!(weighted_mean(&with_weight(&values, weight)), Some(mean));
            prop_assert_eq!(weighted_quantile(&mut weighted, level(q)), quantile(&mut plain, level(q)));
            prop_assert_eq!(weighted_cvar(&mut weighted, level(q)), cvar(&mut plain, level(q)));
        }

        /// A value of weight k equals k repeated values. The first two pairs differ in weight, so
        /// that the weighted path is taken.
        #[test]
        fn validate_whole_weights_are_repetitions(
            pairs in prop::collection::vec((1.0..9.0_f64, 1..5_u32), 1..40),
            q in 0.01..0.99_f64,
        ) {
            let pairs: Vec<_> = [(2.5, 1), (7.5, 3)].into_iter().chain(pairs).collect();
            let mut weighted: Vec<_> = pairs
                .iter()
                .map(|&(value, weight)| Weighted { value, weight: f64::from(weight) })
                .collect();
            let mut repeated: Vec<f64> = pairs
                .iter()
                .flat_map(|&(value, times)| std::iter::repeat_n(value, times as usize))
                .collect();
            let ours = summarize_weighted(&mut weighted, level(q)).unwrap();
            let theirs = summarize(&mut repeated, level(q)).unwrap();
            prop_assert_eq!((ours.p50, ours.p95, ours.p99, ours.max), (theirs.p50, theirs.p95, theirs.p99, theirs.max));
            // The sums are in a different order: a few ulp of 9.
            prop_assert!((ours.mean - theirs.mean).abs() < 1e-13);
            prop_assert!((ours.cvar - theirs.cvar).abs() < 1e-12);
            let single = weighted_quantile(&mut weighted, level(q));
            prop_assert_eq!(single, quantile(&mut repeated, level(q)));
        }
    }
}

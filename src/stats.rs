//! Quantiles and conditional value-at-risk of a finite sample.

pub mod gaussian;
mod weighted;

pub use weighted::{Weighted, summarize_weighted, weighted_cvar, weighted_mean, weighted_quantile};

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A level that is not a probability strictly between 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("level {0} is outside the open interval (0, 1)")]
pub struct LevelError(pub f64);

/// A probability level, 0 < level < 1.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Level(f64);

impl Default for Level {
    /// 0.95: the tail is the worst 5 %.
    fn default() -> Self {
        Self(0.95)
    }
}

impl Level {
    /// Accepts a level that is strictly between 0 and 1.
    ///
    /// # Errors
    /// If `level` is not strictly between 0 and 1.
    pub fn new(level: f64) -> Result<Self, LevelError> {
        if level > 0.0 && level < 1.0 {
            Ok(Self(level))
        } else {
            Err(LevelError(level))
        }
    }

    /// The level as a number.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// Mean, quantiles, tail and maximum of one sample, all in the sample's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Arithmetic mean.
    pub mean: f64,
    /// Median, an order statistic.
    pub p50: f64,
    /// 95 % quantile, an order statistic.
    pub p95: f64,
    /// 99 % quantile, an order statistic.
    pub p99: f64,
    /// Maximum.
    pub max: f64,
    /// Conditional value-at-risk: the mean of the worst 1 - level of the sample.
    pub cvar: f64,
}

/// The 1-based rank of the quantile of level `q` in a sample of `n`: ⌈q n - 1e-9⌉,
/// at least 1 ([M-28](crate::models#m-28)).
#[must_use]
pub fn quantile_rank(q: f64, n: usize) -> usize {
    let rank = (q * n as f64 - 1e-9).ceil();
    (rank.max(1.0) as usize).min(n.max(1))
}

/// The order statistic of rank `rank` (1-based). Reorders `sample`.
///
/// Afterwards, every element behind it is at least as large.
fn select(sample: &mut [f64], rank: usize) -> f64 {
    *sample.select_nth_unstable_by(rank - 1, f64::total_cmp).1
}

/// The quantile of level `q` by selection; `None` for an empty sample. Reorders `sample`.
#[must_use]
pub fn quantile(sample: &mut [f64], q: Level) -> Option<f64> {
    let rank = quantile_rank(q.get(), sample.len());
    (!sample.is_empty()).then(|| select(sample, rank))
}

/// Conditional value-at-risk: the mean of the worst 1 - α of the sample, with fractional
/// weight on the quantile sample (Rockafellar and Uryasev, *Journal of Risk* 2
/// (2000), equation 4, on the empirical distribution; [M-29](crate::models#m-29)).
///
/// `None` for an empty sample. Reorders `sample`.
#[must_use]
pub fn cvar(sample: &mut [f64], level: Level) -> Option<f64> {
    if sample.is_empty() {
        return None;
    }
    let rank = quantile_rank(level.get(), sample.len());
    let value_at_risk = select(sample, rank);
    // Sorted, so that the sum does not depend on the order of the samples.
    let tail = &mut sample[rank..];
    tail.sort_unstable_by(f64::total_cmp);
    let excess: f64 = tail.iter().map(|x| x - value_at_risk).sum();
    let share = (1.0 - level.get()) * (rank + tail.len()) as f64;
    Some(value_at_risk + excess / share)
}

/// All statistics of one sample; `None` if it is empty. Reorders `sample`.
#[must_use]
pub fn summarize(sample: &mut [f64], level: Level) -> Option<Summary> {
    if sample.is_empty() {
        return None;
    }
    let mean = sample.iter().sum::<f64>() / sample.len() as f64;
    let cvar = cvar(sample, level)?;
    let ranks = [0.50, 0.95, 0.99].map(|q| quantile_rank(q, sample.len()));
    let max = sample.iter().copied().max_by(f64::total_cmp)?;
    Some(Summary {
        mean,
        p50: select(sample, ranks[0]),
        p95: select(sample, ranks[1]),
        p99: select(sample, ranks[2]),
        max,
        cvar,
    })
}

/// Least-squares line through points: (intercept, slope).
///
/// `None` unless at least two abscissae differ.
#[must_use]
pub fn line_fit(x: &[f64], y: &[f64]) -> Option<(f64, f64)> {
    let n = x.len().min(y.len()) as f64;
    if n < 2.0 {
        return None;
    }
    let mean_x = x.iter().sum::<f64>() / n;
    let mean_y = y.iter().sum::<f64>() / n;
    let spread: f64 = x.iter().map(|x| (x - mean_x).powi(2)).sum();
    let shared: f64 = x
        .iter()
        .zip(y)
        .map(|(x, y)| (x - mean_x) * (y - mean_y))
        .sum();
    (spread > 0.0).then(|| {
        let slope = shared / spread;
        (mean_y - slope * mean_x, slope)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn level(q: f64) -> Level {
        Level::new(q).unwrap()
    }

    #[test]
    fn levels_are_probabilities() {
        assert_eq!(Level::new(1.0), Err(LevelError(1.0)));
        assert!(Level::new(f64::NAN).is_err());
        assert_eq!(
            Level::new(95.0).unwrap_err().to_string(),
            "level 95 is outside the open interval (0, 1)"
        );
    }

    #[test]
    fn ranks_do_not_jump_on_rounding() {
        // 0.95 * 20 is 19 in exact arithmetic and 19.000000000000004 or so in doubles.
        assert_eq!(quantile_rank(0.95, 20), 19);
        assert_eq!(quantile_rank(0.95, 21), 20);
        assert_eq!(quantile_rank(0.5, 1), 1);
    }

    /// 1..=100 at 95 %: the worst five are 96..=100, whose mean is 98.
    #[test]
    fn validate_cvar_of_a_whole_tail() {
        let mut sample: Vec<f64> = (1..=100).map(f64::from).rev().collect();
        assert!((cvar(&mut sample, level(0.95)).unwrap() - 98.0).abs() < 1e-12);
    }

    /// Ten values at 95 %: the tail is half a sample, all of it from the largest value.
    /// Thirty values: one and a half samples, (30 + 0.5 * 29) / 1.5.
    #[test]
    fn validate_cvar_of_a_fractional_tail() {
        let mut ten: Vec<f64> = (1..=10).map(f64::from).collect();
        assert!((cvar(&mut ten, level(0.95)).unwrap() - 10.0).abs() < 1e-12);
        let mut thirty: Vec<f64> = (1..=30).map(f64::from).collect();
        let expected = (30.0 + 0.5 * 29.0) / 1.5;
        assert!((cvar(&mut thirty, level(0.95)).unwrap() - expected).abs() < 1e-12);
    }

    #[test]
    fn summary_of_a_small_sample() {
        let mut sample: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        let summary = summarize(&mut sample, level(0.95)).unwrap();
        assert_eq!(summary.mean, 100.5);
        assert_eq!(
            (summary.p50, summary.p95, summary.p99, summary.max),
            (100.0, 190.0, 198.0, 200.0)
        );
        assert!((summary.cvar - 195.5).abs() < 1e-12);
        assert_eq!(summarize(&mut [], level(0.95)), None);
    }

    #[test]
    fn a_line_is_recovered() {
        let (intercept, slope) = line_fit(&[0.0, 1.0, 4.0], &[2.0, 2.5, 4.0]).unwrap();
        assert!((intercept - 2.0).abs() < 1e-14 && (slope - 0.5).abs() < 1e-14);
        assert_eq!(line_fit(&[1.0, 1.0], &[0.0, 1.0]), None);
    }
}

//! Distribution of residuals: three quantiles, the largest, and where it occurs.

use crate::stats::quantile_rank;
use serde::{Deserialize, Serialize};

/// Distribution of the magnitudes of residuals.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Distribution {
    /// What was compared, as in the names of checks.
    pub name: String,
    /// What was measured.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Number of residuals.
    pub n: usize,
    /// Median.
    pub median: f64,
    /// 95 % quantile.
    pub q95: f64,
    /// 99 % quantile.
    pub q99: f64,
    /// The largest.
    pub max: f64,
    /// The input that gives the largest.
    pub worst: String,
}

/// A residual and its input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual<I> {
    /// The residual.
    pub value: f64,
    /// Its input.
    pub input: I,
}

impl Distribution {
    /// The distribution of the magnitudes of `residuals`; `None` if there are none.
    #[must_use]
    pub fn of<I>(
        name: &str,
        [quantity, unit]: [&str; 2],
        residuals: &[Residual<I>],
        describe: impl Fn(&I) -> String,
    ) -> Option<Self> {
        let mut sizes: Vec<f64> = residuals.iter().map(|one| one.value.abs()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let worst = residuals
            .iter()
            .max_by(|a, b| a.value.abs().total_cmp(&b.value.abs()))?;
        let at = |q: f64| sizes[quantile_rank(q, sizes.len()) - 1];
        Some(Self {
            name: name.to_owned(),
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            n: sizes.len(),
            median: at(0.5),
            q95: at(0.95),
            q99: at(0.99),
            max: at(1.0),
            worst: describe(&worst.input),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_of_the_sizes() {
        let residuals: Vec<_> = (1..=200)
            .map(|n| Residual {
                value: if n % 2 == 0 {
                    f64::from(n)
                } else {
                    -f64::from(n)
                },
                input: n,
            })
            .collect();
        let found = Distribution::of("a", ["q", "km"], &residuals, i32::to_string).unwrap();
        assert_eq!((found.n, found.median, found.q95), (200, 100.0, 190.0));
        assert_eq!((found.q99, found.max), (198.0, 200.0));
        assert_eq!(found.worst, "200");
        assert_eq!(
            Distribution::of("a", ["q", "km"], &[], i32::to_string),
            None
        );
    }
}

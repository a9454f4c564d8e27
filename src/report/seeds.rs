//! The same search with several seeds.

use super::{Align, Table, seed_spread};
use crate::run::OptimizeResult;
use crate::run::columns::{cells, fields};
use crate::run::tables::text;
use ::csv::Writer;
use serde::{Deserialize, Serialize};
use std::io;

/// One of the searches.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SeedRun {
    /// Its seed.
    pub seed: u64,
    /// Hypervolume of its front.
    pub hypervolume: Option<f64>,
    /// Designs evaluated.
    pub evaluations: u64,
    /// Members of its front.
    pub front_size: usize,
    /// The fuzzy pick.
    pub pick: Option<String>,
}

impl From<&OptimizeResult> for SeedRun {
    fn from(result: &OptimizeResult) -> Self {
        Self {
            seed: result.search.seed,
            hypervolume: result.search.hypervolume.value,
            evaluations: result.search.evaluations,
            front_size: result.front.len(),
            pick: result.chosen().map(|member| member.design.notation.clone()),
        }
    }
}

/// The hypervolume over the seeds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Spread {
    /// Arithmetic mean.
    pub mean: f64,
    /// Minimum.
    pub min: f64,
    /// Maximum.
    pub max: f64,
    /// Sample standard deviation (n - 1); 0 for one seed.
    pub std_dev: f64,
}

impl Spread {
    fn of(values: &[f64]) -> Option<Self> {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        Some(Self {
            mean,
            min: values.iter().copied().min_by(f64::total_cmp)?,
            max: values.iter().copied().max_by(f64::total_cmp)?,
            std_dev: (squares / (count - 1.0).max(1.0)).sqrt(),
        })
    }
}

/// The output of `optimize --seeds`: the result of the first seed, which is not selected for being
/// the best, and the summary of all.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SeedsResult {
    /// The result of the first seed.
    #[serde(flatten)]
    pub first: OptimizeResult,
    /// Seed by seed.
    pub seeds: Vec<SeedRun>,
    /// The hypervolume over the seeds; `None` without a reference point.
    pub hypervolume_spread: Option<Spread>,
}

impl SeedsResult {
    /// The result of searches that differ only in their seed; `None` without any.
    #[must_use]
    pub fn new(results: Vec<OptimizeResult>) -> Option<Self> {
        let seeds: Vec<SeedRun> = results.iter().map(SeedRun::from).collect();
        let volumes: Option<Vec<f64>> = seeds.iter().map(|run| run.hypervolume).collect();
        let spread = volumes.and_then(|volumes| Spread::of(&volumes));
        let mut first = results.into_iter().next()?;
        let diagnostic = spread.and_then(|s| seed_spread(s.mean, s.std_dev, seeds.len()));
        first.search.diagnostics.extend(diagnostic);
        Some(Self {
            first,
            seeds,
            hypervolume_spread: spread,
        })
    }

    /// The seeds and their spread, for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let right = Align::Right;
        let mut table = Table::new(&[
            ("seed", right),
            ("hypervolume", right),
            ("evaluations", right),
            ("front", right),
            ("pick", Align::Left),
        ]);
        let volume =
            |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.5}"));
        for run in &self.seeds {
            table.row([
                run.seed.to_string(),
                volume(run.hypervolume),
                run.evaluations.to_string(),
                run.front_size.to_string(),
                run.pick.clone().unwrap_or_default(),
            ]);
        }
        let mut text = table.to_text();
        if let Some(spread) = self.hypervolume_spread {
            let Spread {
                mean,
                min,
                max,
                std_dev,
            } = spread;
            text += &format!(
                "hypervolume over {} seeds: mean {mean:.5}, minimum {min:.5}, maximum {max:.5}, \
                 standard deviation {std_dev:.5}\n",
                self.seeds.len()
            );
        }
        text
    }

    /// The seeds, one per row.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn to_csv(&self) -> io::Result<String> {
        let mut writer = Writer::from_writer(Vec::new());
        writer.write_record(fields::<SeedRun>())?;
        for run in &self.seeds {
            writer.write_record(cells(run, fields::<SeedRun>())?)?;
        }
        text(writer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validate_spread_by_hand() {
        let spread = Spread::of(&[1.0, 2.0, 3.0, 6.0]).unwrap();
        assert_eq!((spread.mean, spread.min, spread.max), (3.0, 1.0, 6.0));
        // Squares 4, 1, 0, 9 over 3.
        assert!((spread.std_dev - (14.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(Spread::of(&[2.0]).unwrap().std_dev, 0.0);
        assert_eq!(Spread::of(&[]), None);
    }
}

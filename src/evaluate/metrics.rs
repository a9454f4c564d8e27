//! The figures of merit of a constellation over points and times.

use super::plain::{Samples, WeightedSamples};
use crate::stats::{Level, Summary, summarize, summarize_weighted};
use serde::Serialize;

/// How samples are turned into metrics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MetricOptions {
    /// λ, the weight of the tail in `j_pos`.
    pub cvar_weight: f64,
    /// α, the level of the tail.
    pub cvar_level: Level,
    /// PDOP up to which a sample counts as available.
    pub availability_pdop: f64,
}

/// The metrics of a constellation. Every one is without unit.
///
/// `mean_visible` is over all samples; the statistics of PDOP and `j_pos` are over the solved
/// samples, and `None` when there is none. Every point counts with its weight in all of them:
/// means, shares, quantiles and the tail are those of samples weighted by their point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Metrics {
    /// N̄, mean number of visible LEO satellites (equation 10 of the paper).
    pub mean_visible: f64,
    /// Mean PDOP.
    pub mean_pdop: Option<f64>,
    /// Conditional value-at-risk of PDOP at `cvar_level`.
    pub cvar_pdop: Option<f64>,
    /// Level of the tail.
    pub cvar_level: f64,
    /// Median PDOP.
    pub p50_pdop: Option<f64>,
    /// 95 % quantile of PDOP.
    pub p95_pdop: Option<f64>,
    /// 99 % quantile of PDOP.
    pub p99_pdop: Option<f64>,
    /// Largest PDOP.
    pub max_pdop: Option<f64>,
    /// Share of samples that are solved.
    pub solved_fraction: f64,
    /// Share of samples that are solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Mean PDOP + λ CVaR (equation 8).
    pub j_pos: Option<f64>,
    /// Satellites per visible satellite (equation 9); `None` when none is ever visible.
    pub j_cost: Option<f64>,
}

impl Metrics {
    pub(super) fn from_samples(
        mut samples: Samples,
        options: MetricOptions,
        satellites: usize,
    ) -> Self {
        let count = samples.count as f64;
        let available = samples
            .pdop
            .iter()
            .filter(|&&pdop| pdop <= options.availability_pdop)
            .count();
        let solved = samples.pdop.len();
        let summary = summarize(&mut samples.pdop, options.cvar_level);
        Self::assembled(
            samples.visible as f64 / count,
            summary,
            [solved as f64 / count, available as f64 / count],
            options,
            satellites,
        )
    }

    pub(super) fn from_weighted(
        mut samples: WeightedSamples,
        options: MetricOptions,
        satellites: usize,
    ) -> Self {
        let share_up_to = |bound: f64| {
            let within = samples.pdop.iter().filter(|x| x.value <= bound);
            within.fold(0.0, |sum, x| sum + x.weight) / samples.weight
        };
        let shares = [f64::INFINITY, options.availability_pdop].map(share_up_to);
        let summary = summarize_weighted(&mut samples.pdop, options.cvar_level);
        let mean_visible = samples.visible / samples.weight;
        Self::assembled(mean_visible, summary, shares, options, satellites)
    }

    fn assembled(
        mean_visible: f64,
        pdop: Option<Summary>,
        [solved_fraction, availability]: [f64; 2],
        options: MetricOptions,
        satellites: usize,
    ) -> Self {
        Self {
            mean_visible,
            mean_pdop: pdop.map(|s| s.mean),
            cvar_pdop: pdop.map(|s| s.cvar),
            cvar_level: options.cvar_level.get(),
            p50_pdop: pdop.map(|s| s.p50),
            p95_pdop: pdop.map(|s| s.p95),
            p99_pdop: pdop.map(|s| s.p99),
            max_pdop: pdop.map(|s| s.max),
            solved_fraction,
            availability,
            j_pos: pdop.map(|s| s.mean + options.cvar_weight * s.cvar),
            j_cost: (mean_visible > 0.0).then(|| satellites as f64 / mean_visible),
        }
    }
}

//! The figures of merit of a constellation over points and times.

use super::DopStatistics;
use super::accuracy::{AccuracyMetrics, SigmaSpread};
use super::counts::{Coverage, LongestOutage, Views};
use super::failures::OneLost;
use super::gain::Gain;
use super::histograms::ViewBins;
use super::on_demand::{self, OnDemand};
use super::window::InformationPdop;
use crate::stats::{Level, Summary};
use serde::{Deserialize, Serialize};

/// Parameters of the metrics.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MetricOptions {
    /// λ, the weight of the tail in `j_pos`.
    pub cvar_weight: f64,
    /// α, the level of the tail.
    pub cvar_level: Level,
    /// PDOP up to which a sample counts as available.
    pub availability_pdop: f64,
    /// Whether the quantiles of HDOP and VDOP are computed too, which takes several times as long.
    pub asks_for_hdop: bool,
    /// Whether the loss of each satellite is evaluated too, which takes many times as long.
    pub asks_for_n1: bool,
    /// Whether the CVaR of each loss is evaluated with them, which takes more than twice as long.
    pub asks_for_n1_tail: bool,
    /// The probability that a satellite is up, if the expected availability is computed too.
    pub expects_up: Option<f64>,
}

impl Default for MetricOptions {
    /// λ = 0.5, α = 0.95, available up to a PDOP of 6.
    fn default() -> Self {
        Self {
            cvar_weight: 0.5,
            cvar_level: Level::default(),
            availability_pdop: 6.0,
            asks_for_hdop: false,
            asks_for_n1: false,
            asks_for_n1_tail: false,
            expects_up: None,
        }
    }
}

/// The metrics of a constellation. Those in metres say so; all others are without unit.
///
/// `mean_visible` is over all samples; the statistics of PDOP and `j_pos` are over the solved
/// samples, and `None` if there are none. Every point counts with its weight in all of them:
/// means, fractions, quantiles and the tail weight each sample by its point.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Metrics {
    /// N̄, mean visible LEO satellites (equation 10 of the paper).
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
    /// Maximum PDOP.
    pub max_pdop: Option<f64>,
    /// Fraction of samples that are solved.
    pub solved_fraction: f64,
    /// Fraction of samples that are solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Mean PDOP + λ CVaR (equation 8).
    pub j_pos: Option<f64>,
    /// Satellites / mean visible (equation 9); `None` if none is ever visible.
    pub j_cost: Option<f64>,
    /// Least number of visible LEO satellites in any sample, whatever the weight of its point.
    pub least_visible: u32,
    /// Fraction of samples with at least n visible LEO satellites.
    pub coverage: Coverage,
    /// Mean visible GNSS satellites.
    pub mean_gnss_visible: f64,
    /// Mean visible satellites, LEO and GNSS.
    pub mean_total_visible: f64,
    /// Fraction of samples with at least n visible satellites, LEO and GNSS.
    pub coverage_total: Coverage,
    /// Longest outage of any point, seconds: samples in a row that are unsolved or above the availability
    /// threshold, times the step. What is shorter than a step may be missed.
    pub longest_outage_s: f64,
    /// Whether the start or the end of the span cuts an outage of that length, which may be longer.
    pub longest_outage_cut: bool,
    /// 95 % quantile of HDOP, where it is asked for.
    pub p95_hdop: Option<f64>,
    /// 95 % quantile of VDOP, where it is asked for.
    pub p95_vdop: Option<f64>,
    /// The worst without any one of the satellites.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub n1: Option<OneLost>,
    /// Probability that a sample is available, as expected over failures of the satellites.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub expected_availability: Option<f64>,
    /// Gain over the GNSS alone, where it is asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gain: Option<Gain>,
    /// PDOP of all observations in a window.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub information_pdop: Option<InformationPdop>,
    /// Fraction of samples that have an accuracy in metres: solved, and not singular with the weights of the range errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accuracy_solved_fraction: Option<f64>,
    /// Standard deviation of the position, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub sigma_3d_m: OnDemand<SigmaSpread>,
    /// Standard deviation of the horizontal position (DRMS), metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub sigma_h_m: OnDemand<SigmaSpread>,
    /// Standard deviation of the height, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub sigma_v_m: OnDemand<SigmaSpread>,
    /// Length that 5 % of the position errors exceed, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub error95_3d_m: OnDemand<f64>,
    /// Length that 5 % of the horizontal errors exceed, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub error95_h_m: OnDemand<f64>,
    /// Length that 5 % of the height errors exceed, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub error95_v_m: OnDemand<f64>,
}

/// Summary of the samples of an evaluation, weighted by point.
pub(super) struct Evaluated {
    /// LEO satellites in view.
    pub(super) leo: Views,
    /// LEO and GNSS satellites in view.
    pub(super) all: Views,
    /// How often so many are in view, LEO and all, where asked for.
    pub(super) bins: Option<[ViewBins; 2]>,
    /// Fraction of samples that are solved.
    pub(super) solved: f64,
    /// Fraction of samples that are solved with PDOP at most the availability threshold.
    pub(super) available: f64,
    pub(super) longest_outage: LongestOutage,
    /// Statistics of the PDOP of the solved samples.
    pub(super) summary: Option<Summary>,
}

impl Metrics {
    /// The same with the quantiles of HDOP and VDOP.
    #[must_use]
    pub fn with_dops(self, dops: &DopStatistics) -> Self {
        Self {
            p95_hdop: dops.hdop.map(|hdop| hdop.p95),
            p95_vdop: dops.vdop.map(|vdop| vdop.p95),
            ..self
        }
    }

    /// The statistics of PDOP; `None` without solved samples.
    pub(crate) fn pdop_summary(&self) -> Option<Summary> {
        Some(Summary {
            mean: self.mean_pdop?,
            p50: self.p50_pdop?,
            p95: self.p95_pdop?,
            p99: self.p99_pdop?,
            max: self.max_pdop?,
            cvar: self.cvar_pdop?,
        })
    }

    pub(super) fn new(
        evaluated: &Evaluated,
        options: MetricOptions,
        satellites: usize,
        step_s: f64,
    ) -> Self {
        let (mean_visible, mean_total_visible) = (evaluated.leo.mean(), evaluated.all.mean());
        let longest_outage = evaluated.longest_outage;
        let summary = evaluated.summary;
        Self {
            mean_visible,
            mean_pdop: summary.map(|s| s.mean),
            cvar_pdop: summary.map(|s| s.cvar),
            cvar_level: options.cvar_level.get(),
            p50_pdop: summary.map(|s| s.p50),
            p95_pdop: summary.map(|s| s.p95),
            p99_pdop: summary.map(|s| s.p99),
            max_pdop: summary.map(|s| s.max),
            solved_fraction: evaluated.solved,
            availability: evaluated.available,
            j_pos: summary.map(|s| s.mean + options.cvar_weight * s.cvar),
            j_cost: (mean_visible > 0.0).then(|| satellites as f64 / mean_visible),
            least_visible: evaluated.leo.least(),
            coverage: evaluated.leo.coverage(),
            mean_gnss_visible: evaluated.all.mean_beyond(&evaluated.leo),
            mean_total_visible,
            coverage_total: evaluated.all.coverage(),
            longest_outage_s: f64::from(longest_outage.samples) * step_s,
            longest_outage_cut: longest_outage.is_cut,
            p95_hdop: None,
            p95_vdop: None,
            n1: None,
            expected_availability: None,
            gain: None,
            information_pdop: None,
            accuracy_solved_fraction: None,
            sigma_3d_m: None,
            sigma_h_m: None,
            sigma_v_m: None,
            error95_3d_m: None,
            error95_h_m: None,
            error95_v_m: None,
        }
    }

    /// The same with what is computed on demand.
    pub(super) fn with_on_demand(
        self,
        information_pdop: Option<InformationPdop>,
        accuracy: Option<AccuracyMetrics>,
    ) -> Self {
        Self {
            information_pdop,
            accuracy_solved_fraction: accuracy.map(|of| of.solved_fraction),
            sigma_3d_m: accuracy.map(|of| of.sigma_3d_m),
            sigma_h_m: accuracy.map(|of| of.sigma_h_m),
            sigma_v_m: accuracy.map(|of| of.sigma_v_m),
            error95_3d_m: accuracy.map(|of| of.error95_3d_m),
            error95_h_m: accuracy.map(|of| of.error95_h_m),
            error95_v_m: accuracy.map(|of| of.error95_v_m),
            ..self
        }
    }
}

//! How far the metrics depend on the phase of the GNSS.

use crate::evaluate::Metrics;
use crate::run::columns::{field, metric_columns};
use serde::Serialize;
use std::collections::BTreeMap;

/// The metrics over equally spaced phases of the GNSS.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PhaseSpread {
    /// Number of phases, the one of the scenario included.
    pub phases: usize,
    /// The range of each metric by its name; `None` if it has no value in some phase.
    pub metrics: BTreeMap<String, Option<PhaseRange>>,
}

/// The range of a metric.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct PhaseRange {
    /// Minimum over the phases.
    pub min: f64,
    /// Mean over the phases.
    pub mean: f64,
    /// Maximum over the phases.
    pub max: f64,
}

impl PhaseRange {
    /// The range of some values; `None` if one is missing, or there are none.
    fn of(values: &[Option<f64>]) -> Option<Self> {
        let values: Vec<f64> = values.iter().copied().collect::<Option<_>>()?;
        let first = *values.first()?;
        Some(Self {
            min: values.iter().copied().fold(first, f64::min),
            mean: values.iter().sum::<f64>() / values.len() as f64,
            max: values.iter().copied().fold(first, f64::max),
        })
    }
}

impl PhaseSpread {
    /// The spread over the metrics of each phase.
    #[must_use]
    pub fn of(phases: &[Metrics]) -> Self {
        let named: Vec<_> = phases.iter().map(named).collect();
        let names = named.first().into_iter().flatten().map(|(name, _)| name);
        let range = |(n, name): (usize, &String)| {
            let values: Vec<_> = named.iter().map(|phase| phase[n].1).collect();
            (name.clone(), PhaseRange::of(&values))
        };
        Self {
            phases: phases.len(),
            metrics: names.enumerate().map(range).collect(),
        }
    }

    /// Name, minimum, mean and maximum of each metric, in the order of the metrics.
    #[must_use]
    pub fn rows(&self) -> Vec<(&str, Option<PhaseRange>)> {
        in_order(&self.metrics)
    }
}

/// Name and range of each metric, in the order of the metrics.
#[must_use]
pub(crate) fn in_order(
    metrics: &BTreeMap<String, Option<PhaseRange>>,
) -> Vec<(&str, Option<PhaseRange>)> {
    let rows = metrics.iter().map(|(name, range)| (name.as_str(), *range));
    let mut rows: Vec<_> = rows.collect();
    let columns = metric_columns();
    let place = |name: &str| columns.iter().position(|one| *one == name);
    rows.sort_by_key(|(name, _)| place(name).unwrap_or(columns.len()));
    rows
}

/// The numbers of the metrics by name; the level of the tail and whether an outage is cut are none of them.
pub(super) fn named(metrics: &Metrics) -> Vec<(String, Option<f64>)> {
    let value = serde_json::to_value(metrics).unwrap_or_default();
    let is_number = |name: &&str| !["cvar_level", "longest_outage_cut"].contains(name);
    let always = metric_columns().into_iter().filter(is_number);
    let always = always.map(|name| (name.to_owned(), field(&value, name).as_f64()));
    always.chain(metrics.on_demand()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing;

    #[test]
    fn a_range_needs_a_value_in_every_phase() {
        let one = testing::member(1, "delta:45:225/15/1@1000").metrics;
        let with = |mean_visible, max_pdop| Metrics {
            mean_visible,
            max_pdop,
            ..one
        };
        let spread =
            PhaseSpread::of(&[with(8.0, Some(2.0)), with(6.0, None), with(10.0, Some(1.0))]);
        let expected = PhaseRange {
            min: 6.0,
            mean: 8.0,
            max: 10.0,
        };
        assert_eq!(spread.phases, 3);
        assert_eq!(spread.metrics["mean_visible"], Some(expected));
        assert_eq!(spread.metrics["max_pdop"], None);
        assert!(!spread.metrics.contains_key("cvar_level"));
        assert!(!spread.metrics.contains_key("longest_outage_cut"));
        assert!(spread.metrics["coverage_4"].is_some());
        assert_eq!(spread.rows()[0].0, "mean_visible");
    }
}

//! How the shells of a design turn against each other, and how far the metrics depend on it.

use super::phases::{PhaseRange, PhaseSpread};
use crate::constellation::relative_nodes::RelativeNode;
use crate::constellation::{Design, shell_letters};
use serde::Serialize;
use std::fmt::Write;

/// The relative nodes of the shells of a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RelativeNodes {
    /// Each two shells.
    pub pairs: Vec<RelativeNodeResult>,
    /// The spread of the metrics over relative nodes, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spread: Option<NodeSpread>,
}

/// The nodes of two shells with respect to each other.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RelativeNodeResult {
    /// Their letters.
    pub shells: [String; 2],
    /// How fast the nodes of the second move to the east of those of the first, degrees a day.
    pub rate_deg_per_day: f64,
    /// After how long they have turned by 360°, days; `None` if by less than a degree a year.
    pub period_days: Option<f64>,
    /// After how long planes stand to planes as before, days.
    pub planes_period_days: Option<f64>,
}

/// The metrics over relative nodes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct NodeSpread {
    /// After how long the shells have turned by 360°, days; the longest of several.
    pub period_days: f64,
    /// Number of relative nodes, equally spaced in this time, those of the design included.
    pub nodes: usize,
    /// The spread over them.
    #[serde(flatten)]
    pub spread: MetricRanges,
}

/// The range of each metric.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MetricRanges {
    /// By its name.
    pub metrics: std::collections::BTreeMap<String, Option<PhaseRange>>,
}

impl RelativeNodes {
    /// Those of a design; `None` for one shell.
    #[must_use]
    pub fn of(design: &Design) -> Option<Self> {
        let pairs = RelativeNode::all_of(design).into_iter();
        let pairs: Vec<_> = pairs.map(RelativeNodeResult::from).collect();
        (!pairs.is_empty()).then_some(Self {
            pairs,
            spread: None,
        })
    }

    /// A line for each two shells.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut text = String::from("\nnodes of the shells with respect to each other\n");
        for one in &self.pairs {
            let both = one.shells.join(" and ");
            let rate = one.rate_deg_per_day;
            let _ = match (one.period_days, one.planes_period_days) {
                (Some(period), Some(planes)) => writeln!(
                    text,
                    "{both}: {rate:+.3} deg/day, 360 deg in {period:.1} days, planes stand to planes as before after {planes:.2} days"
                ),
                _ => writeln!(
                    text,
                    "{both}: {rate:+.6} deg/day, less than a degree a year"
                ),
            };
        }
        text
    }
}

impl From<RelativeNode> for RelativeNodeResult {
    fn from(one: RelativeNode) -> Self {
        Self {
            shells: one.shells.map(shell_letters),
            rate_deg_per_day: one.rate_deg_per_day,
            period_days: one.period_days,
            planes_period_days: one.planes_period_days,
        }
    }
}

impl NodeSpread {
    /// The spread over the metrics at each of the relative nodes.
    #[must_use]
    pub fn of(period_days: f64, spread: PhaseSpread) -> Self {
        Self {
            period_days,
            nodes: spread.phases,
            spread: MetricRanges {
                metrics: spread.metrics,
            },
        }
    }
}

//! The values shown for the selected constellation, with the digits of the tables.

use crate::evaluate::Metrics;
use crate::keyword::Keyword;
use crate::report::page::words;
use crate::report::{on_demand_quantities, quantity_label, shown};
use crate::run::{FrontMember, Run};
use crate::search::Quantity;

/// A value shown for a selected constellation.
pub(super) enum Readout {
    /// An objective, or a constrained quantity that has no other tile.
    Quantity(String),
    /// A quantity on demand, which the metrics have.
    OnDemand(String),
    /// Label, and name of the quantity that gives its digits, of a metric.
    Metric(&'static str, &'static str, fn(&Metrics) -> Option<f64>),
}

impl Readout {
    fn label(&self) -> String {
        match self {
            Self::Quantity(name) => name.clone(),
            Self::OnDemand(name) => quantity_label(name),
            Self::Metric(label, ..) => (*label).to_owned(),
        }
    }

    pub(super) fn text(&self, quantity: &dyn Fn(&str) -> Option<f64>, metrics: &Metrics) -> String {
        match self {
            Self::Quantity(name) => shown::named(name, quantity(name)),
            Self::OnDemand(name) => {
                let known = Quantity::from_keyword(name).ok();
                shown::named(name, known.and_then(|one| one.of_metrics(metrics)))
            }
            Self::Metric(_, digits, value) => shown::named(digits, value(metrics)),
        }
    }
}

/// The values shown for each constellation: objectives, metrics, and constrained quantities that are
/// neither.
pub(super) fn all(run: &Run, names: &[String]) -> Vec<Readout> {
    let mut tiles: Vec<Readout> = names.iter().cloned().map(Readout::Quantity).collect();
    type Value = fn(&Metrics) -> Option<f64>;
    let metrics: [(&str, &str, Value); 7] = [
        ("mean visible", "mean-visible", |m| Some(m.mean_visible)),
        ("mean PDOP", "mean-pdop", |m| m.mean_pdop),
        ("CVaR of PDOP", "cvar-pdop", |m| m.cvar_pdop),
        ("maximum PDOP", "max-pdop", |m| m.max_pdop),
        ("availability", "availability", |m| Some(m.availability)),
        ("95 % quantile of PDOP", "p95-pdop", |m| m.p95_pdop),
        // A fraction has the digits of the availability.
        ("solved fraction", "availability", |m| {
            Some(m.solved_fraction)
        }),
    ];
    for (label, name, value) in metrics {
        if label == "solved fraction" || !names.iter().any(|objective| objective == name) {
            tiles.push(Readout::Metric(label, name, value));
        }
    }
    let on_demand = run.scenario.as_ref().map(on_demand_quantities);
    let on_demand: Vec<String> = on_demand
        .iter()
        .flatten()
        .map(ToString::to_string)
        .collect();
    let of_metrics = on_demand.iter().filter(|name| !names.contains(name));
    tiles.extend(of_metrics.cloned().map(Readout::OnDemand));
    let further = words::further(run).into_iter();
    let further = further.filter(|name| !on_demand.contains(name));
    tiles.extend(further.map(Readout::Quantity));
    tiles
}

/// The values shown for each member of the front, with their labels.
pub(super) fn of_members(run: &Run, names: &[String]) -> Vec<(String, Vec<String>)> {
    let of_member = |tile: &Readout, member: &FrontMember| {
        tile.text(&|name| member.quantity(name), &member.metrics)
    };
    let tiles = all(run, names).into_iter().map(|tile| {
        let texts = run.front.iter().map(|member| of_member(&tile, member));
        (tile.label(), texts.collect())
    });
    tiles.collect()
}

//! The values shown for the selected constellation, with the digits of the tables.

use crate::evaluate::Metrics;
use crate::keyword::Keyword;
use crate::report::page::words;
use crate::report::shown;
use crate::run::{FrontMember, Run};
use crate::search::Quantity;

/// A value shown for a selected constellation.
pub(super) enum Readout {
    /// An objective, or a constrained quantity that has no other tile.
    Quantity(String),
    /// Label, and name of the quantity that gives its digits, of a metric.
    Metric(&'static str, &'static str, fn(&Metrics) -> Option<f64>),
}

impl Readout {
    fn label(&self) -> String {
        match self {
            Self::Quantity(name) => name.clone(),
            Self::Metric(label, ..) => (*label).to_owned(),
        }
    }

    pub(super) fn text(&self, quantity: &dyn Fn(&str) -> Option<f64>, metrics: &Metrics) -> String {
        match self {
            Self::Quantity(name) => shown::named(name, quantity(name)),
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
    let in_metres: [(&str, &str, Value); 6] = [
        ("1-sigma position error (m)", "sigma-3d-m", |m| {
            Some(m.sigma_3d_m??.mean)
        }),
        ("1-sigma horizontal error (m)", "sigma-h-m", |m| {
            Some(m.sigma_h_m??.mean)
        }),
        ("1-sigma height error (m)", "sigma-v-m", |m| {
            Some(m.sigma_v_m??.mean)
        }),
        ("95 % position error (m)", "error95-3d-m", |m| {
            m.error95_3d_m?
        }),
        ("95 % horizontal error (m)", "error95-h-m", |m| {
            m.error95_h_m?
        }),
        ("95 % height error (m)", "error95-v-m", |m| m.error95_v_m?),
    ];
    let of_window: [(&str, &str, Value); 1] =
        [("mean PDOP of a window", "information-pdop", |m| {
            m.information_pdop?.mean
        })];
    let scenario = run.scenario.as_ref();
    let has_metres = scenario.is_some_and(|one| one.accuracy.leo_m.is_some());
    let has_window = scenario.is_some_and(|one| one.metrics.window_min.is_some());
    let metres = in_metres.into_iter().filter(|_| has_metres);
    for (label, name, value) in metres.chain(of_window.into_iter().filter(|_| has_window)) {
        if !names.iter().any(|objective| objective == name) {
            tiles.push(Readout::Metric(label, name, value));
        }
    }
    let is_shown = |name: &String| Quantity::from_keyword(name).is_ok_and(Quantity::is_on_demand);
    tiles.extend(
        words::further(run)
            .into_iter()
            .filter(|name| !is_shown(name))
            .map(Readout::Quantity),
    );
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

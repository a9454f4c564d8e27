//! The plain path: sample by sample in f64, by definition. It is the reference for tests of the kernel
//! and evaluates setups that the kernel does not support.

use super::metrics::Evaluated;
use super::{Evaluator, Setup};
use crate::dop::ClockGroup;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthFixed, Position};
use crate::stats::{Summary, Weighted, summarize, summarize_weighted};

/// One point at one instant.
pub(super) struct PlainSample {
    /// Index into the instants of the grid.
    pub(super) time: usize,
    /// Index into the points.
    pub(super) site: usize,
    /// Visible LEO satellites.
    pub(super) visible: u32,
    /// PDOP, if solved.
    pub(super) pdop: Option<f64>,
}

pub(super) fn evaluate(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
) -> Result<Evaluated, EphemerisError> {
    let setup = evaluator.setup();
    let mut visible = 0.0;
    let mut total = 0.0;
    let mut pdop = Vec::with_capacity(setup.sample_count());
    visit(evaluator, ephemeris, |sample| {
        let weight = setup.sites[sample.site].weight;
        visible += weight * f64::from(sample.visible);
        total += weight;
        pdop.extend(sample.pdop.map(|value| Weighted { value, weight }));
    })?;
    let share_up_to = |bound: f64| {
        let within = pdop.iter().filter(|sample| sample.value <= bound);
        within.fold(0.0, |sum, sample| sum + sample.weight) / total
    };
    Ok(Evaluated {
        mean_visible: visible / total,
        solved: share_up_to(f64::INFINITY),
        available: share_up_to(setup.metrics.availability_pdop),
        summary: summary(setup, pdop),
    })
}

/// Equal weights need no sorting.
fn summary(setup: &Setup, mut pdop: Vec<Weighted>) -> Option<Summary> {
    let level = setup.metrics.cvar_level;
    if setup.has_equal_weights() {
        let mut values: Vec<f64> = pdop.iter().map(|sample| sample.value).collect();
        summarize(&mut values, level)
    } else {
        summarize_weighted(&mut pdop, level)
    }
}

/// Calls `see` for every sample, instant by instant and point by point.
pub(super) fn visit(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    mut see: impl FnMut(PlainSample),
) -> Result<(), EphemerisError> {
    let setup = evaluator.setup();
    let fixed = evaluator.fixed()?;
    let mut positions = Vec::with_capacity(ephemeris.satellites().len());
    for time in 0..setup.grid.len() {
        earth_fixed(evaluator, ephemeris, time, &mut positions)?;
        for (site, fixed) in fixed.at(time).iter().enumerate() {
            let local = &setup.sites[site].local;
            let mut leo = ClockGroup::default();
            let mut visible = 0;
            for &position in &positions {
                if let Some(unit) = setup.line_of_sight(setup.mask, local, position) {
                    leo.add(unit, setup.observation_weight(local, unit));
                    visible += 1;
                }
            }
            leo += fixed.shared_clock;
            let mut geometry = fixed.own_clocks;
            geometry.add(&leo);
            see(PlainSample {
                time,
                site,
                visible,
                pdop: geometry.pdop(setup.pdop_cap),
            });
        }
    }
    Ok(())
}

/// Fills `positions` with the Earth-fixed positions of the satellites at instant `time`.
pub(super) fn earth_fixed(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    time: usize,
    positions: &mut Vec<Position<EarthFixed>>,
) -> Result<(), EphemerisError> {
    positions.clear();
    let elapsed_s = evaluator.setup().grid.elapsed_s(time);
    for satellite in ephemeris.satellites() {
        let state = ephemeris.state(satellite, elapsed_s)?;
        positions.push(evaluator.rotations[time].to_earth_fixed(state.position_km));
    }
    Ok(())
}

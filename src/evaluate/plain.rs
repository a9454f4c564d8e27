//! The plain path: one sample after the other, in f64, by the definitions.

use super::Evaluator;
use crate::dop::ClockGroup;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::stats::Weighted;
use nalgebra::Vector3;

/// What an evaluation leaves for the statistics.
pub(super) struct Samples {
    /// Visible LEO satellites, summed over all samples.
    pub(super) visible: u64,
    /// Points times times.
    pub(super) count: usize,
    /// PDOP of the solved samples, in no particular order.
    pub(super) pdop: Vec<f64>,
}

/// The same for points whose weights differ.
pub(super) struct WeightedSamples {
    /// Visible LEO satellites times weight, summed over all samples.
    pub(super) visible: f64,
    /// Weights, summed over all samples.
    pub(super) weight: f64,
    /// PDOP of the solved samples.
    pub(super) pdop: Vec<Weighted>,
}

/// One point at one time.
pub(super) struct Sample {
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
) -> Result<Samples, EphemerisError> {
    let count = evaluator.setup().sample_count();
    let mut samples = Samples {
        visible: 0,
        count,
        pdop: Vec::with_capacity(count),
    };
    visit(evaluator, ephemeris, |sample| {
        samples.visible += u64::from(sample.visible);
        samples.pdop.extend(sample.pdop);
    })?;
    Ok(samples)
}

pub(super) fn evaluate_weighted(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
) -> Result<WeightedSamples, EphemerisError> {
    let setup = evaluator.setup();
    let mut samples = WeightedSamples {
        visible: 0.0,
        weight: 0.0,
        pdop: Vec::with_capacity(setup.sample_count()),
    };
    visit(evaluator, ephemeris, |sample| {
        let weight = setup.sites[sample.site].weight;
        samples.visible += weight * f64::from(sample.visible);
        samples.weight += weight;
        let pdop = sample.pdop.map(|value| Weighted { value, weight });
        samples.pdop.extend(pdop);
    })?;
    Ok(samples)
}

/// Calls `see` for every sample, time by time and point by point.
pub(super) fn visit(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    mut see: impl FnMut(Sample),
) -> Result<(), EphemerisError> {
    let setup = evaluator.setup();
    let mut positions = Vec::with_capacity(ephemeris.satellites().len());
    for time in 0..setup.grid.len() {
        earth_fixed(evaluator, ephemeris, time, &mut positions)?;
        for (site, fixed) in evaluator.fixed.at(time).iter().enumerate() {
            let mut leo = ClockGroup::default();
            for &position in &positions {
                if let Some(unit) = setup.mask.line_of_sight(&setup.sites[site].local, position) {
                    leo.add(unit);
                }
            }
            let visible = leo.count();
            leo += fixed.shared_clock;
            let mut geometry = fixed.own_clocks;
            geometry.add(&leo);
            see(Sample {
                time,
                site,
                visible,
                pdop: geometry.pdop(setup.pdop_cap),
            });
        }
    }
    Ok(())
}

/// Fills `positions` with the Earth-fixed positions of the satellites at instant `time`, km.
pub(super) fn earth_fixed(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    time: usize,
    positions: &mut Vec<Vector3<f64>>,
) -> Result<(), EphemerisError> {
    positions.clear();
    let elapsed_s = evaluator.setup().grid.elapsed_s(time);
    for satellite in ephemeris.satellites() {
        let state = ephemeris.state(satellite, elapsed_s)?;
        positions.push(evaluator.rotations[time].to_earth_fixed(state.position_km));
    }
    Ok(())
}

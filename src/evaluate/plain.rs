//! The plain path: sample by sample in f64, by definition. It is the reference for tests of the kernel
//! and evaluates setups that the kernel does not support.

use super::fixed::PlainGnssSample;
use super::metrics::Evaluated;
use super::{Evaluator, Setup, leo};
use crate::dop::{ClockGroup, Geometry};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthFixed, EarthRotation, LocalFrame, Position};
use crate::stats::{Summary, Weighted, summarize, summarize_weighted};
use crate::visibility::Mask;

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
    let cap = evaluator.setup().pdop_cap;
    visit_geometries(evaluator, ephemeris, |time, site, (visible, geometry)| {
        see(PlainSample {
            time,
            site,
            visible,
            pdop: geometry.pdop(cap),
        });
    })
}

/// Calls `see` with the instant, the point, and the visible LEO satellites and geometry of every sample.
pub(super) fn visit_geometries(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    mut see: impl FnMut(usize, usize, (u32, Geometry)),
) -> Result<(), EphemerisError> {
    let setup = evaluator.setup();
    let fixed = evaluator.fixed()?;
    let mut positions = Vec::new();
    for time in 0..setup.grid.len() {
        let elapsed_s = setup.grid.elapsed_s(time);
        let rotation = evaluator.rotations[time];
        leo::positions(setup, ephemeris, elapsed_s, rotation, &mut positions)?;
        for (site, gnss) in fixed.at(time).iter().enumerate() {
            let local = &setup.sites[site].local;
            see(time, site, geometry(setup, local, &positions, gnss));
        }
    }
    Ok(())
}

/// Visible LEO satellites, given clock by clock, and the geometry of one sample. Every path that has to decide
/// whether a sample is solved where rounding could turn the decision makes these sums, in this order.
pub(super) fn geometry(
    setup: &Setup,
    site: &LocalFrame,
    clocks: &[impl AsRef<[Position<EarthFixed>]>],
    gnss: &PlainGnssSample,
) -> (u32, Geometry) {
    let mut visible = 0;
    let mut shared_clock = gnss.shared_clock;
    let mut geometry = gnss.own_clocks;
    for positions in clocks {
        let (seen, mut leo) = observe_counted(setup, setup.mask, site, positions.as_ref());
        // Where the GNSS shares a clock, there is only this one.
        leo += std::mem::take(&mut shared_clock);
        geometry.add(&leo);
        visible += seen;
    }
    (visible, geometry)
}

/// The observations of the satellites that are visible over a mask.
pub(super) fn observe(
    setup: &Setup,
    mask: Mask,
    site: &LocalFrame,
    positions: &[Position<EarthFixed>],
) -> ClockGroup {
    observe_counted(setup, mask, site, positions).1
}

/// The same with the number of visible satellites, those without weight included.
fn observe_counted(
    setup: &Setup,
    mask: Mask,
    site: &LocalFrame,
    positions: &[Position<EarthFixed>],
) -> (u32, ClockGroup) {
    let mut group = ClockGroup::default();
    let mut visible = 0;
    for &position in positions {
        if let Some(unit) = setup.line_of_sight(mask, site, position) {
            group.add(unit, setup.observation_weight(site, unit));
            visible += 1;
        }
    }
    (visible, group)
}

/// Fills `positions` with the Earth-fixed positions of the satellites that have one at an instant.
pub(super) fn earth_fixed(
    ephemeris: &Ephemeris,
    elapsed_s: f64,
    rotation: EarthRotation,
    positions: &mut Vec<Position<EarthFixed>>,
) -> Result<(), EphemerisError> {
    positions.clear();
    for satellite in ephemeris.satellites() {
        if let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? {
            positions.push(rotation.to_earth_fixed(state.position_km));
        }
    }
    Ok(())
}

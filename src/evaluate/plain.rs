//! The plain path: sample by sample in f64, by definition. It is the reference for tests of the kernel
//! and evaluates setups that the kernel does not support.

use super::counts::{LongestOutage, Outages};
use super::fixed::PlainGnssSample;
use super::histograms::ViewBins;
use super::metrics::Evaluated;
use super::{Evaluator, Setup, leo};
use crate::dop::{ClockGroup, Geometry};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthFixed, EarthRotation, Position};
use crate::ground::Site;
use crate::stats::{Summary, Weighted, summarize, summarize_weighted};
use crate::visibility::Mask;

/// One point at one instant.
pub(super) struct PlainSample {
    /// Index into the points.
    pub(super) site: usize,
    /// Visible LEO satellites.
    pub(super) visible: u32,
    /// Visible GNSS satellites.
    pub(super) gnss_visible: u32,
    /// PDOP, if solved.
    pub(super) pdop: Option<f64>,
}

pub(super) fn evaluate(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
) -> Result<Evaluated, EphemerisError> {
    let setup = evaluator.setup();
    let weights = &evaluator.weights;
    let (mut leo, mut all) = (ViewBins::default(), ViewBins::default());
    let mut pdop = Vec::with_capacity(setup.sample_count());
    let mut is_out = vec![Vec::with_capacity(setup.grid.len()); setup.sites.len()];
    let (mut solved, mut available) = (0, 0);
    visit(evaluator, ephemeris, |sample| {
        let weight = weights.of(sample.site);
        leo.add(sample.visible, weight);
        all.add(sample.visible + sample.gnss_visible, weight);
        let within = |bound: f64| sample.pdop.is_some_and(|pdop| pdop <= bound);
        let is_available = within(setup.metrics.availability_pdop);
        solved += if within(f64::INFINITY) { weight } else { 0 };
        available += if is_available { weight } else { 0 };
        is_out[sample.site].push(!is_available);
        let weight = weight as f64;
        pdop.extend(sample.pdop.map(|value| Weighted { value, weight }));
    })?;
    let share = |weight: u64| weight as f64 / weights.total() as f64;
    let outages = is_out
        .into_iter()
        .map(|point| Outages::of(point.into_iter()));
    Ok(Evaluated {
        leo: leo.views(),
        all: all.views(),
        bins: Some([leo, all]),
        solved: share(solved),
        available: share(available),
        longest_outage: LongestOutage::of(outages),
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
    visit_geometries(
        evaluator,
        ephemeris,
        |_| true,
        |_, site, (visible, gnss_visible), geometry| {
            see(PlainSample {
                site,
                visible,
                gnss_visible,
                pdop: geometry.pdop(cap),
            });
        },
    )
}

/// Calls `see` with the instant, the point, the visible LEO and GNSS satellites, and the geometry of every sample of the points
/// that are wanted.
pub(super) fn visit_geometries(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    is_wanted: impl Fn(usize) -> bool,
    mut see: impl FnMut(usize, usize, (u32, u32), Geometry),
) -> Result<(), EphemerisError> {
    let setup = evaluator.setup();
    let fixed = evaluator.fixed()?;
    let mut positions = Vec::new();
    for time in 0..setup.grid.len() {
        let elapsed_s = setup.grid.elapsed_s(time);
        let rotation = evaluator.rotations[time];
        leo::positions(setup, ephemeris, elapsed_s, rotation, &mut positions)?;
        let gnss = fixed.at(time).iter().enumerate();
        for (site, gnss) in gnss.filter(|(site, _)| is_wanted(*site)) {
            let (visible, geometry) = geometry(setup, &setup.sites[site], &positions, gnss);
            see(time, site, (visible, gnss.visible), geometry);
        }
    }
    Ok(())
}

/// Visible LEO satellites, given clock by clock, and the geometry of one sample. Every path that has to decide
/// whether a sample is solved where rounding could turn the decision makes these sums, in this order.
pub(super) fn geometry(
    setup: &Setup,
    site: &Site,
    clocks: &[impl AsRef<[Position<EarthFixed>]>],
    gnss: &PlainGnssSample,
) -> (u32, Geometry) {
    let mut visible = 0;
    let mut shared_clock = gnss.shared_clock;
    let mut geometry = gnss.own_clocks;
    for positions in clocks {
        let (seen, mut leo) = observe(setup, setup.mask, site, positions.as_ref());
        // Where the GNSS shares a clock, there is only this one.
        leo += std::mem::take(&mut shared_clock);
        geometry.add(&leo);
        visible += seen;
    }
    (visible, geometry)
}

/// The number of satellites that are visible over a mask, and the observations of those with weight.
pub(super) fn observe(
    setup: &Setup,
    mask: Mask,
    site: &Site,
    positions: &[Position<EarthFixed>],
) -> (u32, ClockGroup) {
    let mut group = ClockGroup::default();
    let mut visible = 0;
    for &position in positions {
        if let Some(unit) = site.line_of_sight(mask, position) {
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

//! Samples in which a satellite is too close to the mask for f32, recomputed by definition.

use super::super::Setup;
use super::fixed::FixedSample;
use super::lanes::FixedTile;
use super::sample::{Outcome, POSITION_STATES, SampleContext, UNSOLVED, Undecided};
use crate::dop::Symmetric3;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use nalgebra::Vector3;

/// All satellites, and the instant.
pub(super) struct Satellites<'a> {
    pub(super) ephemeris: &'a Ephemeris,
    pub(super) elapsed_s: f64,
    pub(super) rotation: EarthRotation,
}

/// Resolves all doubtful decisions of one sample.
pub(super) fn settle(
    setup: &Setup,
    scene: &SampleContext,
    satellites: &Satellites<'_>,
    fixed: FixedSample<'_>,
    outcome: &mut Outcome,
) -> Result<(), EphemerisError> {
    for doubt in std::mem::take(&mut outcome.doubts) {
        let site = scene.tiles.tiles[doubt.tile].members[doubt.lane];
        let fixed = fixed.tile(doubt.tile);
        let (visible, pdop) = sample(setup, site as usize, satellites, &fixed, &doubt)?;
        outcome.visible += visible;
        let pdop = pdop.filter(|&pdop| pdop <= setup.pdop_cap);
        let available = pdop.is_some_and(|pdop| pdop <= setup.metrics.availability_pdop);
        outcome.available += u64::from(available);
        outcome.pdop[doubt.tile].0[doubt.lane] = pdop.map_or(UNSOLVED, |pdop| pdop as f32);
    }
    Ok(())
}

/// Visible satellites and PDOP of one point, with the positions and the decisions of the plain
/// path.
fn sample(
    setup: &Setup,
    site: usize,
    satellites: &Satellites<'_>,
    fixed: &FixedTile<'_>,
    doubt: &Undecided,
) -> Result<(u64, Option<f64>), EphemerisError> {
    let local = &setup.sites[site].local;
    let [xx, yy, zz, xy, xz, yz] =
        std::array::from_fn(|element| fixed.normal::<f64>(element, doubt.lane));
    let mut normal = Symmetric3 {
        xx,
        yy,
        zz,
        xy,
        xz,
        yz,
    };
    let (mut sum, mut in_group) = (Vector3::zeros(), 0);
    if let Some(shared) = fixed.shared {
        in_group = shared.count.0[doubt.lane];
        let mean = Vector3::from_fn(|axis, _| shared.mean::<f64>(axis, doubt.lane));
        sum = mean * f64::from(in_group);
        // Undoes the elimination of the GNSS clock, which becomes that of the design.
        normal += Symmetric3::outer(mean, f64::from(in_group));
    }
    let mut visible = 0_u32;
    for &n in &doubt.satellites {
        let satellite = &satellites.ephemeris.satellites()[n as usize];
        let state = satellites
            .ephemeris
            .state(satellite, satellites.elapsed_s)?;
        let position = satellites.rotation.to_earth_fixed(state.position_km);
        if let Some(unit) = setup.mask.line_of_sight(local, position) {
            normal += Symmetric3::outer(unit, 1.0);
            sum += unit;
            visible += 1;
        }
    }
    in_group += visible;
    let mut surplus = u32::from(fixed.surplus[doubt.lane]);
    if in_group > 0 {
        normal += Symmetric3::outer(sum, -1.0 / f64::from(in_group));
        surplus += in_group - 1;
    }
    let pdop = (surplus >= POSITION_STATES)
        .then(|| normal.trace_of_inverse())
        .flatten()
        .map(f64::sqrt);
    Ok((u64::from(visible), pdop))
}

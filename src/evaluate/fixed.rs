//! The part of the geometry that is the same for all designs: the GNSS, once per setup.

use super::Setup;
use crate::dop::{ClockGroup, Clocks, Geometry};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;

/// The contribution of the GNSS at one point and instant.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlainGnssSample {
    /// Systems with their own clocks.
    pub(super) own_clocks: Geometry,
    /// Satellites that share their clock with the LEO design.
    pub(super) shared_clock: ClockGroup,
}

/// The GNSS geometry of every sample, instant by instant.
pub(super) struct FixedGeometry {
    samples: Vec<PlainGnssSample>,
    sites: usize,
}

impl FixedGeometry {
    pub(super) fn new(setup: &Setup, rotations: &[EarthRotation]) -> Result<Self, EphemerisError> {
        let mut samples = vec![PlainGnssSample::default(); setup.sample_count()];
        for system in &setup.gnss {
            let ephemeris = Ephemeris::of_gnss(system.satellites(setup.grid.epoch()), setup.grid);
            add_system(setup, rotations, &ephemeris, &mut samples)?;
        }
        Ok(Self {
            samples,
            sites: setup.sites.len(),
        })
    }

    /// The samples of all points at instant `k`.
    pub(super) fn at(&self, k: usize) -> &[PlainGnssSample] {
        &self.samples[k * self.sites..(k + 1) * self.sites]
    }
}

fn add_system(
    setup: &Setup,
    rotations: &[EarthRotation],
    system: &Ephemeris,
    samples: &mut [PlainGnssSample],
) -> Result<(), EphemerisError> {
    let rows = samples.chunks_exact_mut(setup.sites.len());
    for ((elapsed_s, rotation), row) in setup.grid.iter().zip(rotations).zip(rows) {
        let mut positions = Vec::with_capacity(system.satellites().len());
        for satellite in system.satellites() {
            let state = system.state(satellite, elapsed_s)?;
            positions.push(rotation.to_earth_fixed(state.position_km));
        }
        for (site, sample) in setup.sites.iter().zip(row) {
            let mut group = ClockGroup::default();
            for &position in &positions {
                if let Some(unit) = setup.line_of_sight(setup.gnss_mask, &site.local, position) {
                    group.add(unit, setup.observation_weight(&site.local, unit));
                }
            }
            match setup.clocks {
                Clocks::PerSystem => sample.own_clocks.add(&group),
                Clocks::Shared => sample.shared_clock += group,
            }
        }
    }
    Ok(())
}

//! The part of the geometry that is the same for all designs: the GNSS, once per setup.

use super::{Setup, plain};
use crate::constellation::gnss::System;
use crate::dop::{ClockGroup, Clocks, Geometry};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::{EarthFixed, EarthRotation, Position};
use crate::ground::Site;

/// The contribution of the GNSS at one point and instant.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct PlainGnssSample {
    /// Systems with their own clocks.
    pub(super) own_clocks: Geometry,
    /// Satellites that share their clock with the LEO design.
    pub(super) shared_clock: ClockGroup,
    /// Visible satellites of all systems.
    pub(super) visible: u32,
}

impl PlainGnssSample {
    /// From the positions of the satellites of each system.
    pub(super) fn new(setup: &Setup, site: &Site, systems: &[PlainPositions]) -> Self {
        let mut sample = Self::default();
        for positions in systems {
            let (visible, group) = plain::observe(setup, setup.gnss_mask, site, positions);
            sample.visible += visible;
            match setup.clocks {
                Clocks::PerSystem => sample.own_clocks.add(&group),
                Clocks::Shared => sample.shared_clock += group,
            }
        }
        sample
    }
}

/// Earth-fixed positions of the satellites of one system.
pub(super) type PlainPositions = Vec<Position<EarthFixed>>;

/// The systems of a setup, to be propagated on its grid.
pub(super) fn systems(setup: &Setup) -> Vec<Ephemeris> {
    let satellites =
        |system: &System| Ephemeris::of_gnss(system.satellites(setup.grid.epoch()), setup.grid);
    setup.gnss.iter().map(satellites).collect()
}

/// The positions of each system at one instant.
pub(super) fn positions(
    systems: &[Ephemeris],
    elapsed_s: f64,
    rotation: EarthRotation,
) -> Result<Vec<PlainPositions>, EphemerisError> {
    let of_system = |system: &Ephemeris| {
        let mut positions = Vec::with_capacity(system.satellites().len());
        plain::earth_fixed(system, elapsed_s, rotation, &mut positions)?;
        Ok(positions)
    };
    systems.iter().map(of_system).collect()
}

/// The GNSS geometry of every sample, instant by instant.
pub(super) struct FixedGeometry {
    samples: Vec<PlainGnssSample>,
    sites: usize,
}

impl FixedGeometry {
    pub(super) fn new(setup: &Setup, rotations: &[EarthRotation]) -> Result<Self, EphemerisError> {
        let systems = systems(setup);
        let mut samples = Vec::with_capacity(setup.sample_count());
        for (elapsed_s, rotation) in setup.grid.iter().zip(rotations) {
            let positions = positions(&systems, elapsed_s, *rotation)?;
            let sample = |site: &Site| PlainGnssSample::new(setup, site, &positions);
            samples.extend(setup.sites.iter().map(sample));
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

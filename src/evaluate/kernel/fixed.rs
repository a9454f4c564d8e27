//! The GNSS part of the geometry, which no design changes.

use super::super::Setup;
use super::flight::Positions;
use super::lanes::{FixedTile, LANES, Lanes, MaskTerms, Split, Sums};
use super::tiles::{Tile, Tiles};
use crate::dop::Clocks;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;

/// Bytes up to which the GNSS part is kept between designs; beyond, it is made again sample by
/// sample, so that memory does not grow with points times samples.
const KEPT_BYTES: usize = 256 << 20;

/// The GNSS part of all samples.
pub(super) struct Fixed {
    systems: Vec<Ephemeris>,
    clocks: Clocks,
    mask: MaskTerms<f64>,
    /// Sample by sample, tile by tile; empty when there is no GNSS or it does not fit.
    kept: Vec<FixedTile>,
}

impl Fixed {
    pub(super) fn new(
        setup: &Setup,
        tiles: &Tiles,
        rotations: &[EarthRotation],
    ) -> Result<Self, EphemerisError> {
        let epoch = setup.grid.epoch();
        let mut fixed = Self {
            systems: setup
                .gnss
                .iter()
                .map(|preset| Ephemeris::of_gnss(preset.satellites(epoch), setup.grid))
                .collect(),
            clocks: setup.clocks,
            mask: MaskTerms::new(setup.gnss_mask),
            kept: Vec::new(),
        };
        let count = tiles.tiles.len() * setup.grid.len();
        if !fixed.systems.is_empty() && count * size_of::<FixedTile>() <= KEPT_BYTES {
            let mut kept = Vec::with_capacity(count);
            for (elapsed_s, rotation) in setup.grid.iter().zip(rotations) {
                fixed.make(tiles, elapsed_s, *rotation, &mut kept)?;
            }
            fixed.kept = kept;
        }
        Ok(fixed)
    }

    /// The tiles of sample `k`: kept ones, or made in `room`.
    pub(super) fn at<'a>(
        &'a self,
        tiles: &Tiles,
        (k, elapsed_s, rotation): (usize, f64, EarthRotation),
        room: &'a mut Vec<FixedTile>,
    ) -> Result<&'a [FixedTile], EphemerisError> {
        let count = tiles.tiles.len();
        if self.systems.is_empty() {
            return Ok(&[]);
        }
        if !self.kept.is_empty() {
            return Ok(&self.kept[k * count..(k + 1) * count]);
        }
        room.clear();
        self.make(tiles, elapsed_s, rotation, room)?;
        Ok(room)
    }

    fn make(
        &self,
        tiles: &Tiles,
        elapsed_s: f64,
        rotation: EarthRotation,
        to: &mut Vec<FixedTile>,
    ) -> Result<(), EphemerisError> {
        let mut systems = Vec::with_capacity(self.systems.len());
        for system in &self.systems {
            let mut positions = Positions::new(system.satellites().len());
            positions.ask(system, elapsed_s, rotation)?;
            systems.push(positions);
        }
        to.extend(tiles.tiles.iter().map(|tile| self.tile(tile, &systems)));
        Ok(())
    }

    fn tile(&self, tile: &Tile, systems: &[Positions]) -> FixedTile {
        let zero = Lanes([0.0; LANES]);
        let (mut normal, mut sum) = ([zero; 6], [zero; 3]);
        let (mut count, mut surplus) = ([0.0; LANES], [0.0; LANES]);
        for positions in systems {
            let mut sums = Sums::<f64>::zero();
            for n in 0..positions.count {
                sums.add(&tile.double, positions.at(n), &self.mask);
            }
            for l in 0..LANES {
                let (x, y, z, seen) = (sums.x.0[l], sums.y.0[l], sums.z.0[l], sums.count.0[l]);
                let zz = seen - sums.xx.0[l] - sums.yy.0[l];
                // A clock of its own is eliminated here, a shared one with the design.
                let scale = match self.clocks {
                    Clocks::PerSystem => 1.0 / seen.max(1.0),
                    Clocks::Shared => 0.0,
                };
                normal[0].0[l] += sums.xx.0[l] - x * x * scale;
                normal[1].0[l] += sums.yy.0[l] - y * y * scale;
                normal[2].0[l] += zz - z * z * scale;
                normal[3].0[l] += sums.xy.0[l] - x * y * scale;
                normal[4].0[l] += sums.xz.0[l] - x * z * scale;
                normal[5].0[l] += sums.yz.0[l] - y * z * scale;
                match self.clocks {
                    Clocks::PerSystem => surplus[l] += (seen - 1.0).max(0.0) as f32,
                    Clocks::Shared => {
                        sum[0].0[l] += x;
                        sum[1].0[l] += y;
                        sum[2].0[l] += z;
                        count[l] += seen as f32;
                    }
                }
            }
        }
        FixedTile {
            normal: normal.each_ref().map(Split::of),
            sum: sum.each_ref().map(Split::of),
            count: Lanes(count),
            surplus: Lanes(surplus),
        }
    }
}

//! The GNSS part of the geometry, which no design changes.

use super::super::Setup;
use super::flight::Positions;
use super::lanes::{FixedTile, LANES, Lanes, MaskTerms, Normal, SharedClock, Sums, split};
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
    /// Empty when there is no GNSS or it does not fit.
    kept: FixedTiles,
}

/// The GNSS part of some samples, sample by sample and tile by tile.
#[derive(Debug, Clone, Default)]
pub(super) struct FixedTiles {
    normals: Vec<Normal>,
    remainders: Vec<Normal>,
    surpluses: Vec<[u8; LANES]>,
    /// Empty when all systems have clocks of their own.
    shared: Vec<SharedClock>,
}

impl FixedTiles {
    /// Bytes for each tile and sample.
    const BYTES: usize = 2 * size_of::<Normal>() + LANES;

    fn clear(&mut self) {
        self.normals.clear();
        self.remainders.clear();
        self.surpluses.clear();
        self.shared.clear();
    }

    fn reserve(&mut self, count: usize) {
        self.normals.reserve_exact(count);
        self.remainders.reserve_exact(count);
        self.surpluses.reserve_exact(count);
    }

    #[inline(always)]
    fn tile(&self, n: usize) -> FixedTile<'_> {
        self.normals
            .get(n)
            .map_or(FixedTile::NONE, |normal| FixedTile {
                normal,
                remainder: &self.remainders[n],
                surplus: &self.surpluses[n],
                shared: self.shared.get(n).unwrap_or(&SharedClock::NONE),
            })
    }
}

/// The GNSS part of one sample.
#[derive(Clone, Copy)]
pub(super) struct FixedSample<'a> {
    tiles: &'a FixedTiles,
    first: usize,
}

impl<'a> FixedSample<'a> {
    #[inline(always)]
    pub(super) fn tile(&self, n: usize) -> FixedTile<'a> {
        self.tiles.tile(self.first + n)
    }
}

impl Fixed {
    /// Bytes that are kept for so many lanes, over all samples.
    pub(super) fn bytes(lanes: usize) -> usize {
        (lanes / LANES * FixedTiles::BYTES).min(KEPT_BYTES)
    }

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
                .map(|system| Ephemeris::of_gnss(system.satellites(epoch), setup.grid))
                .collect(),
            clocks: setup.clocks,
            mask: MaskTerms::new(setup.gnss_mask),
            kept: FixedTiles::default(),
        };
        let count = tiles.tiles.len() * setup.grid.len();
        if !fixed.systems.is_empty() && count * FixedTiles::BYTES <= KEPT_BYTES {
            let mut kept = FixedTiles::default();
            kept.reserve(count);
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
        room: &'a mut FixedTiles,
    ) -> Result<FixedSample<'a>, EphemerisError> {
        if self.systems.is_empty() || !self.kept.normals.is_empty() {
            let (tiles, first) = (&self.kept, k * tiles.tiles.len());
            return Ok(FixedSample { tiles, first });
        }
        room.clear();
        self.make(tiles, elapsed_s, rotation, room)?;
        let (tiles, first) = (room, 0);
        Ok(FixedSample { tiles, first })
    }

    fn make(
        &self,
        tiles: &Tiles,
        elapsed_s: f64,
        rotation: EarthRotation,
        to: &mut FixedTiles,
    ) -> Result<(), EphemerisError> {
        let mut systems = Vec::with_capacity(self.systems.len());
        for system in &self.systems {
            let mut positions = Positions::new(system.satellites().len());
            positions.ask(system, elapsed_s, rotation)?;
            systems.push(positions);
        }
        for tile in &tiles.tiles {
            self.push_tile(tile, &systems, to);
        }
        Ok(())
    }

    fn push_tile(&self, tile: &Tile, systems: &[Positions], to: &mut FixedTiles) {
        let zero = Lanes([0.0; LANES]);
        let (mut normal, mut sum) = ([zero; 6], [zero; 3]);
        let (mut count, mut surplus) = ([0; LANES], [0_u8; LANES]);
        for positions in systems {
            let mut sums = Sums::<f64>::zero();
            for n in 0..positions.count {
                sums.add(&tile.double, positions.at(n), &self.mask);
            }
            for l in 0..LANES {
                let (x, y, z, seen) = (sums.x.0[l], sums.y.0[l], sums.z.0[l], sums.count.0[l]);
                let zz = f64::from(seen) - sums.xx.0[l] - sums.yy.0[l];
                // A clock of its own is eliminated here, a shared one with the design.
                let scale = match self.clocks {
                    Clocks::PerSystem => 1.0 / f64::from(seen.max(1)),
                    Clocks::Shared => 0.0,
                };
                normal[0].0[l] += sums.xx.0[l] - x * x * scale;
                normal[1].0[l] += sums.yy.0[l] - y * y * scale;
                normal[2].0[l] += zz - z * z * scale;
                normal[3].0[l] += sums.xy.0[l] - x * y * scale;
                normal[4].0[l] += sums.xz.0[l] - x * z * scale;
                normal[5].0[l] += sums.yz.0[l] - y * z * scale;
                match self.clocks {
                    Clocks::PerSystem => {
                        let spare = u8::try_from(seen.saturating_sub(1)).unwrap_or(u8::MAX);
                        surplus[l] = surplus[l].saturating_add(spare);
                    }
                    Clocks::Shared => {
                        sum[0].0[l] += x;
                        sum[1].0[l] += y;
                        sum[2].0[l] += z;
                        count[l] += seen;
                    }
                }
            }
        }
        let parts = normal.each_ref().map(split);
        to.normals.push(parts.map(|(nearest, _)| nearest));
        to.remainders.push(parts.map(|(_, remainder)| remainder));
        to.surpluses.push(surplus);
        if self.clocks == Clocks::Shared {
            let parts = sum.each_ref().map(split);
            to.shared.push(SharedClock {
                sum: parts.map(|(nearest, _)| nearest),
                remainder: parts.map(|(_, remainder)| remainder),
                count: Lanes(count),
            });
        }
    }
}

//! The GNSS part of the geometry, which is the same for all designs.

use super::super::Setup;
use super::super::fixed::systems;
use super::candidates::{Candidates, bits};
use super::instructions::{InstructionSet, Work};
use super::lanes::{LANES, Lanes, MaskTerms, SightLine, Sums};
use super::normal::{FixedTile, Normal, SharedClock, nearest, remainder};
use super::propagation::Positions;
use super::skylines::SightSlack;
use super::tiles::{Horizon, Tile, Tiles};
use super::weighting::{SineWeights, UnitWeights, Weighting};
use crate::dop::{Clocks, ObservationWeights};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::visibility::Mask;

/// The GNSS part of all samples.
pub(super) struct Fixed {
    pub(super) systems: Vec<Ephemeris>,
    clocks: Clocks,
    pub(super) mask: MaskTerms<f64>,
    elevation_mask: Mask,
    weights: ObservationWeights,
    pub(super) instructions: InstructionSet,
    /// Empty if there is no GNSS, or too much to store.
    kept: FixedTiles,
}

/// The GNSS part of some samples, sample by sample and tile by tile.
#[derive(Debug, Clone, Default)]
pub(super) struct FixedTiles {
    normals: Vec<Normal>,
    remainders: Vec<Normal>,
    surpluses: Vec<[u16; LANES]>,
    visible: Vec<[u16; LANES]>,
    /// Empty if all systems have their own clocks.
    shared: Vec<SharedClock>,
}

impl FixedTiles {
    /// Bytes for each tile and sample.
    pub(super) fn bytes(clocks: Clocks) -> usize {
        let shared = match clocks {
            Clocks::PerSystem => 0,
            Clocks::Shared => size_of::<SharedClock>(),
        };
        2 * size_of::<Normal>() + 2 * size_of::<[u16; LANES]>() + shared
    }

    fn clear(&mut self) {
        self.normals.clear();
        self.remainders.clear();
        self.surpluses.clear();
        self.visible.clear();
        self.shared.clear();
    }

    fn reserve(&mut self, count: usize) {
        self.normals.reserve_exact(count);
        self.remainders.reserve_exact(count);
        self.surpluses.reserve_exact(count);
        self.visible.reserve_exact(count);
    }

    #[inline(always)]
    fn tile(&self, n: usize) -> FixedTile<'_> {
        self.normals
            .get(n)
            .map_or(FixedTile::NONE, |normal| FixedTile {
                normal,
                remainder: &self.remainders[n],
                surplus: &self.surpluses[n],
                visible: &self.visible[n],
                shared: self.shared.get(n),
            })
    }
}

/// One instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct SampleInstant {
    /// Index into the grid.
    pub(super) number: usize,
    pub(super) elapsed_s: f64,
    pub(super) rotation: EarthRotation,
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
    /// Stores the samples if they take at most `kept_bytes`.
    pub(super) fn new(
        setup: &Setup,
        tiles: &Tiles,
        rotations: &[EarthRotation],
        instructions: InstructionSet,
        kept_bytes: usize,
    ) -> Result<Self, EphemerisError> {
        let mut fixed = Self {
            systems: systems(setup),
            clocks: setup.clocks,
            mask: MaskTerms::new(setup.gnss_mask),
            elevation_mask: setup.gnss_mask,
            weights: setup.observation_weights,
            instructions,
            kept: FixedTiles::default(),
        };
        let count = tiles.tiles.len() * setup.grid.len();
        if !fixed.systems.is_empty() && count * FixedTiles::bytes(setup.clocks) <= kept_bytes {
            let mut kept = FixedTiles::default();
            kept.reserve(count);
            for (number, (elapsed_s, &rotation)) in setup.grid.iter().zip(rotations).enumerate() {
                let instant = SampleInstant {
                    number,
                    elapsed_s,
                    rotation,
                };
                fixed.make(tiles, instant, &mut kept)?;
            }
            fixed.kept = kept;
        }
        Ok(fixed)
    }

    /// The tiles of a sample: stored ones, or computed in `scratch`.
    pub(super) fn at<'a>(
        &'a self,
        tiles: &Tiles,
        instant: SampleInstant,
        scratch: &'a mut FixedTiles,
    ) -> Result<FixedSample<'a>, EphemerisError> {
        if self.systems.is_empty() || !self.kept.normals.is_empty() {
            let (tiles, first) = (&self.kept, instant.number * tiles.tiles.len());
            return Ok(FixedSample { tiles, first });
        }
        scratch.clear();
        self.make(tiles, instant, scratch)?;
        let (tiles, first) = (scratch, 0);
        Ok(FixedSample { tiles, first })
    }

    fn make(
        &self,
        tiles: &Tiles,
        instant: SampleInstant,
        to: &mut FixedTiles,
    ) -> Result<(), EphemerisError> {
        let systems = self.systems_at(tiles, instant)?;
        self.instructions.run(Make {
            fixed: self,
            tiles: &tiles.tiles,
            systems: &systems,
            to,
        });
        Ok(())
    }

    /// Systems that have their own clocks.
    pub(super) fn clock_count(&self) -> usize {
        match self.clocks {
            Clocks::PerSystem => self.systems.len(),
            Clocks::Shared => 0,
        }
    }

    /// The clocks of the systems that have their own, tile by tile and system by system; none if the systems share one.
    pub(super) fn clocks_at(
        &self,
        tiles: &Tiles,
        instant: SampleInstant,
        to: &mut Vec<SharedClock>,
    ) -> Result<(), EphemerisError> {
        if self.clocks == Clocks::PerSystem {
            let systems = self.systems_at(tiles, instant)?;
            self.instructions.run(MakeClocks {
                fixed: self,
                tiles: &tiles.tiles,
                systems: &systems,
                to,
            });
        }
        Ok(())
    }

    /// The satellites of each system at an instant.
    pub(super) fn systems_at(
        &self,
        tiles: &Tiles,
        instant: SampleInstant,
    ) -> Result<Vec<FixedSystem>, EphemerisError> {
        let at_instant = |system: &Ephemeris| {
            let mut positions = Positions::new(system.satellites().len());
            positions.propagate(system, instant.elapsed_s, instant.rotation)?;
            Ok(FixedSystem::new(
                positions,
                &tiles.fixed_horizon,
                self.elevation_mask,
            ))
        };
        self.systems.iter().map(at_instant).collect()
    }

    #[inline(always)]
    fn push_tile<W: Weighting>(&self, tile: &Tile, systems: &[FixedSystem], to: &mut FixedTiles) {
        let mut normal = [Lanes([0.0; LANES]); 6];
        let (mut surplus, mut visible) = ([0_u16; LANES], [0_u16; LANES]);
        let together = match self.clocks {
            Clocks::PerSystem => 1,
            Clocks::Shared => systems.len(),
        };
        for group in systems.chunks(together) {
            let mut sums = Sums::<f64>::zero();
            for system in group {
                system.add_to::<W>(&mut sums, tile, &self.mask);
            }
            add_group::<W>(&sums, &mut normal);
            for (visible, &seen) in visible.iter_mut().zip(&sums.count.0) {
                *visible = visible.saturating_add(at_most_u16(seen));
            }
            match self.clocks {
                Clocks::PerSystem => {
                    for (l, surplus) in surplus.iter_mut().enumerate() {
                        let used = sums.used::<W>(l);
                        *surplus = surplus.saturating_add(at_most_u16(used.saturating_sub(1)));
                    }
                }
                Clocks::Shared => to.shared.push(shared_clock::<W>(&sums)),
            }
        }
        to.normals
            .push(std::array::from_fn(|n| nearest(&normal[n])));
        to.remainders
            .push(std::array::from_fn(|n| remainder(&normal[n])));
        to.surpluses.push(surplus);
        to.visible.push(visible);
    }
}

#[inline(always)]
pub(in crate::evaluate) fn at_most_u16(count: u32) -> u16 {
    u16::try_from(count).unwrap_or(u16::MAX)
}

/// One system at one sample.
pub(super) struct FixedSystem {
    positions: Positions,
    candidates: Candidates,
    slack_km: f32,
    sight: SightSlack,
    mask: Mask,
}

impl FixedSystem {
    fn new(positions: Positions, horizon: &Horizon, mask: Mask) -> Self {
        let mut candidates = Candidates::with_capacity(positions.count);
        candidates.fill(&positions, horizon);
        Self {
            slack_km: Horizon::cap_slack_km(&positions),
            sight: horizon.double_slack(&positions),
            mask,
            positions,
            candidates,
        }
    }

    /// Adds the satellites visible from the points of a tile.
    #[inline(always)]
    pub(super) fn add_to<W: Weighting>(
        &self,
        sums: &mut Sums<f64>,
        tile: &Tile,
        mask: &MaskTerms<f64>,
    ) {
        self.look(tile, mask, |l, line, seen| {
            sums.add_line::<W>(line, seen, seen, l);
        });
    }

    /// Passes the lines from the points of a tile to `add`, satellite by satellite and lane by lane, with whether it is
    /// visible.
    #[inline(always)]
    pub(super) fn look(
        &self,
        tile: &Tile,
        mask: &MaskTerms<f64>,
        mut add: impl FnMut(usize, &SightLine<f64>, bool),
    ) {
        let blocks = self.candidates.blocks().iter();
        let near = blocks.flat_map(|block| {
            bits(block.inside(&tile.fixed_cap, self.slack_km)).map(|n| block.index(n))
        });
        for n in near {
            let satellite = self.positions.at(n);
            tile.look(satellite, (mask, self.mask), self.sight, &mut add);
        }
    }
}

/// The GNSS part of one sample, to be computed from the positions of each system.
struct Make<'a> {
    fixed: &'a Fixed,
    tiles: &'a [Tile],
    systems: &'a [FixedSystem],
    to: &'a mut FixedTiles,
}

impl Work for Make<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match self.fixed.weights {
            ObservationWeights::Unit => self.make::<UnitWeights>(),
            ObservationWeights::SineElevation => self.make::<SineWeights>(),
        }
    }
}

impl Make<'_> {
    #[inline(always)]
    fn make<W: Weighting>(self) {
        for tile in self.tiles {
            self.fixed.push_tile::<W>(tile, self.systems, self.to);
        }
    }
}

/// The clocks of one sample, from the positions of each system.
struct MakeClocks<'a> {
    fixed: &'a Fixed,
    tiles: &'a [Tile],
    systems: &'a [FixedSystem],
    to: &'a mut Vec<SharedClock>,
}

impl Work for MakeClocks<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match self.fixed.weights {
            ObservationWeights::Unit => self.make::<UnitWeights>(),
            ObservationWeights::SineElevation => self.make::<SineWeights>(),
        }
    }
}

impl MakeClocks<'_> {
    #[inline(always)]
    fn make<W: Weighting>(self) {
        for tile in self.tiles {
            for system in self.systems {
                let mut sums = Sums::<f64>::zero();
                system.add_to::<W>(&mut sums, tile, &self.fixed.mask);
                self.to.push(shared_clock::<W>(&sums));
            }
        }
    }
}

/// Adds Σ w v vᵀ - (Σ w v)(Σ w v)ᵀ / Σ w.
#[inline(always)]
pub(super) fn add_group<W: Weighting>(sums: &Sums<f64>, normal: &mut [Lanes<f64>; 6]) {
    for l in 0..LANES {
        let (x, y, z) = (sums.x.0[l], sums.y.0[l], sums.z.0[l]);
        let scale = 1.0 / weight_or_one::<W>(sums, l);
        normal[0].0[l] += sums.xx.0[l] - x * x * scale;
        normal[1].0[l] += sums.yy.0[l] - y * y * scale;
        normal[2].0[l] += sums.zz::<W>(l) - z * z * scale;
        normal[3].0[l] += sums.xy.0[l] - x * y * scale;
        normal[4].0[l] += sums.xz.0[l] - x * z * scale;
        normal[5].0[l] += sums.yz.0[l] - y * z * scale;
    }
}

/// Σ w; 1 without satellites.
#[inline(always)]
pub(super) fn weight_or_one<W: Weighting>(sums: &Sums<f64>, lane: usize) -> f64 {
    if sums.used::<W>(lane) > 0 {
        sums.weight::<W>(lane)
    } else {
        1.0
    }
}

#[inline(always)]
pub(super) fn shared_clock<W: Weighting>(sums: &Sums<f64>) -> SharedClock {
    let means = [&sums.x, &sums.y, &sums.z].map(|sum| {
        let mean = |l: usize| sum.0[l] / weight_or_one::<W>(sums, l);
        Lanes(std::array::from_fn(mean))
    });
    let weight = Lanes(std::array::from_fn(|l| sums.weight::<W>(l)));
    SharedClock {
        mean: means.each_ref().map(nearest),
        remainder: means.each_ref().map(remainder),
        count: Lanes(std::array::from_fn(|l| sums.used::<W>(l))),
        weight: [nearest(&weight), remainder(&weight)],
    }
}

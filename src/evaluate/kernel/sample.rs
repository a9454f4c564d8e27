//! One instant at all points with all satellites: the code that is compiled for each instruction set.

use super::candidates::{Block, bits};
use super::coarse::Batches;
use super::fixed::FixedSample;
use super::instructions::Work;
use super::lanes::{LANES, Lanes, MaskTerms, SightLine, Sums};
use super::limits::Limits;
use super::normal::{FixedTile, NormalLanes, ZERO};
use super::propagation::{BLOCK, PatternPropagator, Positions};
use super::skylines::{Sight, SightSlack, Skyward};
use super::tiles::{Group, Tile, Tiles};
use super::verdict::{ClockSums, LaneVerdict, LeoLanes};
use super::weighting::{SeveralClocks, SineWeights, UnitWeights, Weighting};
use super::workspace::Workspace;
use crate::dop::ObservationWeights;
use crate::visibility::Mask;

/// Marks an unsolved sample among the values of PDOP.
pub(super) const UNSOLVED: f32 = f32::INFINITY;

/// Minimum of satellites minus clock states: one satellite for each component of position.
pub(super) const POSITION_STATES: u32 = 3;

/// Data shared by all instants.
pub(super) struct SampleContext {
    pub(super) tiles: Tiles,
    pub(super) single: MaskTerms<f32>,
    pub(super) double: MaskTerms<f64>,
    pub(super) mask: Mask,
    pub(super) weights: ObservationWeights,
    pub(super) limits: Limits,
}

/// Why the lanes cannot decide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Doubt {
    /// A satellite is too close to the mask.
    Mask,
    /// A pivot of the normal matrix is close to rounding, or PDOP to a threshold.
    Geometry,
}

/// A decision left to the plain path: the point in a lane of a tile, and the satellites that may
/// be visible from it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Undecided {
    pub(super) doubt: Doubt,
    pub(super) tile: usize,
    pub(super) lane: usize,
    pub(super) satellites: Vec<u32>,
}

/// The result of one instant.
#[derive(Debug, Clone)]
pub(super) struct SampleOutcome {
    /// PDOP of each slot, tile by tile; [`UNSOLVED`] if there is none.
    pub(super) pdop: Vec<Lanes<f32>>,
    /// Visible satellites of each slot.
    pub(super) visible: Vec<Lanes<u32>>,
    /// Points whose PDOP was recomputed in f64.
    pub(super) doubled: u64,
    /// Points to recompute, or recomputed.
    pub(super) doubts: Vec<Undecided>,
    /// The points of the last tile with skylines that see each of its candidates: 1 or 0.
    pub(super) seen: Vec<Lanes<u32>>,
    /// The satellites of the last block at the points of such a tile.
    sights: Vec<Sight<f32>>,
    /// The samples of the tiles of a group to be solved in f64.
    pub(super) coarse: Batches,
}

impl SampleOutcome {
    pub(super) fn new(tiles: usize) -> Self {
        Self {
            pdop: vec![Lanes([UNSOLVED; LANES]); tiles],
            visible: vec![Lanes([0; LANES]); tiles],
            doubled: 0,
            doubts: Vec::new(),
            seen: Vec::new(),
            sights: vec![Sight::nowhere(); BLOCK],
            coarse: Batches::default(),
        }
    }
}

/// One instant to be evaluated.
pub(super) struct Sample<'a> {
    pub(super) scene: &'a SampleContext,
    /// The limits of the scene, or narrower ones.
    pub(super) limits: Limits,
    /// The patterns to propagate, each by its turn in the workspace; the other positions are given.
    pub(super) patterns: &'a [PatternPropagator],
    /// The contribution of the GNSS.
    pub(super) fixed: FixedSample<'a>,
    pub(super) work: &'a mut Workspace,
    pub(super) outcome: &'a mut SampleOutcome,
}

impl Work for Sample<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        for (pattern, turn) in self.patterns.iter().zip(&self.work.turns) {
            pattern.place_at(turn, &mut self.work.positions);
        }
        let (scene, limits, fixed) = (self.scene, self.limits, &self.fixed);
        let (work, out) = (self.work, self.outcome);
        match (scene.weights, work.has_several_clocks()) {
            (ObservationWeights::Unit, false) => {
                evaluate::<UnitWeights>(scene, limits, fixed, work, out);
            }
            (ObservationWeights::SineElevation, false) => {
                evaluate::<SineWeights>(scene, limits, fixed, work, out);
            }
            (ObservationWeights::Unit, true) => {
                evaluate::<SeveralClocks<UnitWeights>>(scene, limits, fixed, work, out);
            }
            (ObservationWeights::SineElevation, true) => {
                evaluate::<SeveralClocks<SineWeights>>(scene, limits, fixed, work, out);
            }
        }
    }
}

#[inline(always)]
fn evaluate<W: Weighting>(
    scene: &SampleContext,
    limits: Limits,
    fixed: &FixedSample<'_>,
    work: &mut Workspace,
    out: &mut SampleOutcome,
) {
    let begun = Begun::new::<W>(scene, limits, work, out);
    for group in &scene.tiles.groups {
        work.select(scene, group);
        for number in group.tiles.clone() {
            begun.evaluate_tile::<W>((number, group), &fixed.tile(number), work, out);
        }
        begun.end_group::<W>(group, fixed, work, out);
    }
}

/// An instant at which the satellites have their places.
pub(super) struct Begun<'a> {
    pub(super) scene: &'a SampleContext,
    mask: MaskTerms<f32>,
    slack: SightSlack,
    limits: Limits,
}

impl<'a> Begun<'a> {
    #[inline(always)]
    pub(super) fn new<W: Weighting>(
        scene: &'a SampleContext,
        limits: Limits,
        work: &mut Workspace,
        out: &mut SampleOutcome,
    ) -> Self {
        let horizon = &scene.tiles.horizon;
        work.begin(horizon);
        out.doubled = 0;
        out.doubts.clear();
        Self {
            scene,
            mask: scene.single.with_slack(horizon.sine_slack(&work.positions)),
            slack: horizon.single_slack(&work.positions),
            limits: limits.capped(horizon.single_below(&work.positions)),
        }
    }

    /// A tile of the selected group.
    #[inline(always)]
    pub(super) fn evaluate_tile<W: Weighting>(
        &self,
        (number, group): (usize, &Group),
        fixed: &FixedTile<'_>,
        work: &Workspace,
        out: &mut SampleOutcome,
    ) {
        let scene = self.scene;
        let candidates = work.candidates(number, group);
        let tile = &scene.tiles.tiles[number];
        let judging = Judging {
            scene,
            limits: &self.limits,
            number,
            fixed,
            positions: &work.positions,
            candidates,
        };
        out.seen.clear();
        if W::SEVERAL_CLOCKS {
            let mut sums = ClockSums::of_fixed(fixed);
            for clock in candidates.by_clock() {
                let of_clock = match self.skyward(tile) {
                    None => clock.sums::<W>(tile, &self.mask),
                    Some(points) => clock.sums_skyward::<W>(&points, tile, &judging, out),
                };
                sums.add_clock::<W>(&of_clock);
            }
            judging.judge::<W>(&sums.system, &sums.leo(), out);
            return;
        }
        // Each arm goes to the end, so that tiles without a skyline keep their sums in registers.
        match self.skyward(tile) {
            None => {
                judging.judge_sums::<W>(&candidates.sums::<W>(tile, &self.mask), out);
            }
            Some(points) => {
                let sums = candidates.sums_skyward::<W>(&points, tile, &judging, out);
                judging.judge_sums::<W>(&sums, out);
            }
        }
    }

    /// The points of a tile under their skylines, if one has any.
    #[inline(always)]
    fn skyward<'t>(&'t self, tile: &'t Tile) -> Option<Skyward<'t, f32>> {
        tile.sky.as_ref().map(|sky| Skyward {
            sites: &tile.single,
            sky,
            mask: &self.mask,
            slack: self.slack,
        })
    }
}

/// A tile whose sums are known.
pub(super) struct Judging<'a> {
    pub(super) scene: &'a SampleContext,
    limits: &'a Limits,
    pub(super) number: usize,
    pub(super) fixed: &'a FixedTile<'a>,
    pub(super) positions: &'a Positions,
    pub(super) candidates: TileCandidates<'a>,
}

impl Judging<'_> {
    #[inline(always)]
    fn judge_sums<W: Weighting>(&self, sums: &Sums<f32>, out: &mut SampleOutcome) {
        let system = NormalLanes::new::<W>(sums, self.fixed);
        let mut rounded = ZERO;
        for l in 0..LANES {
            rounded.0[l] = sums.rounded::<W>(l);
        }
        let leo = LeoLanes {
            count: &sums.count,
            possible: &sums.possible,
            rounded: &rounded,
        };
        self.judge::<W>(&system, &leo, out);
    }

    #[inline(always)]
    fn judge<W: Weighting>(
        &self,
        system: &NormalLanes<f32>,
        leo: &LeoLanes<'_>,
        out: &mut SampleOutcome,
    ) {
        let (number, candidates) = (self.number, self.candidates);
        let verdict = LaneVerdict::new(system, leo, self.limits);
        out.pdop[number] = verdict.pdop;
        out.visible[number] = *leo.count;
        if any(&verdict.doubtful) {
            doubt(number, Doubt::Mask, &verdict.doubtful, candidates, out);
        }
        if any(&verdict.coarse) {
            self.sum_again::<W>(&verdict.coarse, out);
        }
    }
}

#[inline(always)]
fn any(lanes: &Lanes<u32>) -> bool {
    lanes.0.iter().fold(0, |all, lane| all | lane) != 0
}

/// The satellites that may be visible from a tile.
#[derive(Clone, Copy)]
pub(super) struct TileCandidates<'a> {
    pub(super) blocks: &'a [Block],
    /// A bit for each satellite of the block.
    pub(super) words: &'a [u64],
}

impl<'a> TileCandidates<'a> {
    #[inline(always)]
    fn sums<W: Weighting>(&self, tile: &Tile, mask: &MaskTerms<f32>) -> Sums<f32> {
        let mut all = Sums::about(tile.centre);
        for (block, &word) in self.blocks.iter().zip(self.words) {
            let mut sums = Sums::about(tile.centre);
            for n in bits(word) {
                sums.add::<W>(&tile.single, block.position_from(tile.middle, n), mask);
            }
            // Sums of sums: adding hundreds of visible satellites one by one would cost f32 a digit.
            all.merge::<W>(&sums);
        }
        all
    }

    /// The same under the skylines of the points; the outcome remembers who sees each of the satellites.
    #[inline(always)]
    fn sums_skyward<W: Weighting>(
        &self,
        points: &Skyward<'_, f32>,
        tile: &Tile,
        judging: &Judging<'_>,
        out: &mut SampleOutcome,
    ) -> Sums<f32> {
        let (mask, positions) = (judging.scene.mask, judging.positions);
        let mut all = Sums::about(tile.centre);
        for (block, &word) in self.blocks.iter().zip(self.words) {
            let sights = &mut out.sights[..word.count_ones() as usize];
            let places = bits(word).map(|n| block.position_from(tile.middle, n));
            points.look_at(places, sights);
            let mut sums = Sums::about(tile.centre);
            for (n, sight) in bits(word).zip(sights) {
                let satellite = || positions.at(block.index(n));
                let decide = |lane: usize| points.sky.surely_sees(lane, satellite(), mask);
                out.seen.push(sight.add::<W>(&mut sums, decide));
            }
            all.merge::<W>(&sums);
        }
        all
    }

    /// The sums in f64 where it is known who sees each of the satellites.
    #[inline(always)]
    pub(super) fn double_sums_of_seen<W: Weighting>(
        self,
        judging: &Judging<'_>,
        seen: &[Lanes<u32>],
    ) -> Sums<f64> {
        let mut sums = Sums::zero();
        let tile = &judging.scene.tiles.tiles[judging.number];
        for (n, seen) in self.satellites().zip(seen) {
            if any(seen) {
                let satellite = judging.positions.at(n);
                sums.add_seen::<W>(&tile.double, satellite, &judging.scene.double, seen);
            }
        }
        sums
    }

    #[inline(always)]
    pub(super) fn double_sums<W: Weighting>(
        self,
        scene: &SampleContext,
        number: usize,
        positions: &Positions,
    ) -> Sums<f64> {
        let mut sums = Sums::zero();
        self.look(scene, number, positions, &mut |l, line, seen| {
            sums.add_line::<W>(line, seen, seen, l);
        });
        sums
    }

    /// The normal matrix in f64 at the points of a tile, by its number and the positions.
    #[inline(always)]
    pub(super) fn double_normal<W: Weighting>(
        self,
        scene: &SampleContext,
        (number, positions): (usize, &Positions),
        fixed: &FixedTile<'_>,
    ) -> NormalLanes<f64> {
        if !W::SEVERAL_CLOCKS {
            let sums = self.double_sums::<W>(scene, number, positions);
            return NormalLanes::new::<W>(&sums, fixed);
        }
        let mut normal = NormalLanes::of_fixed(fixed);
        for clock in self.by_clock() {
            let sums = clock.double_sums::<W>(scene, number, positions);
            normal.add_clock::<W>(&sums);
        }
        normal
    }

    /// Passes the lines in f64 to the satellites to `add`, satellite by satellite and lane by lane, with whether it is visible.
    #[inline(always)]
    pub(super) fn look(
        self,
        scene: &SampleContext,
        number: usize,
        positions: &Positions,
        add: &mut impl FnMut(usize, &SightLine<f64>, bool),
    ) {
        let tile = &scene.tiles.tiles[number];
        let slack = scene.tiles.horizon.double_slack(positions);
        for n in self.satellites() {
            tile.look(positions.at(n), (&scene.double, scene.mask), slack, add);
        }
    }

    /// Those of each clock that has any.
    #[inline(always)]
    pub(super) fn by_clock(self) -> impl Iterator<Item = TileCandidates<'a>> {
        let (blocks, mut words) = (self.blocks, self.words);
        let of_clock = blocks.chunk_by(|a, b| a.clock() == b.clock());
        of_clock.map(move |blocks| {
            let (own, others) = words.split_at(blocks.len());
            words = others;
            TileCandidates { blocks, words: own }
        })
    }

    /// The number of their clock, if they have one in common.
    #[inline(always)]
    pub(super) fn clock(&self) -> usize {
        self.blocks
            .first()
            .map_or(0, |block| block.clock() as usize)
    }

    #[inline(always)]
    pub(super) fn count(&self) -> usize {
        let count = |word: &u64| word.count_ones() as usize;
        self.blocks
            .iter()
            .zip(self.words)
            .map(|(_, word)| count(word))
            .sum()
    }

    /// Their indices among all satellites.
    #[inline(always)]
    pub(super) fn satellites(self) -> impl Iterator<Item = usize> + use<'a> {
        let blocks = self.blocks.iter().zip(self.words);
        blocks.flat_map(|(block, &word)| bits(word).map(|n| block.index(n)))
    }
}

/// Records the doubtful points of a tile for the plain path.
#[inline(never)]
pub(super) fn doubt(
    number: usize,
    doubt: Doubt,
    lanes: &Lanes<u32>,
    candidates: TileCandidates<'_>,
    out: &mut SampleOutcome,
) {
    let satellites: Vec<u32> = candidates.satellites().map(|n| n as u32).collect();
    for lane in (0..LANES).filter(|&lane| lanes.0[lane] != 0) {
        out.pdop[number].0[lane] = UNSOLVED;
        out.doubts.push(Undecided {
            doubt,
            tile: number,
            lane,
            satellites: satellites.clone(),
        });
    }
}

//! The satellites at one instant, and those that a group of tiles and each of its tiles may see.

use super::candidates::Candidates;
use super::clocks::ClockBlock;
use super::propagation::{BLOCK, Positions, Propagation, Turn};
use super::sample::{SampleContext, TileCandidates};
use super::tiles::{Group, Horizon, TILES_IN_GROUP, Tile};

/// Memory of one evaluation, reused for each instant.
pub(super) struct Workspace {
    pub(super) positions: Positions,
    /// Of each pattern, at the sample.
    pub(super) turns: Vec<Turn>,
    /// The satellites by their clocks; empty if they share one.
    clocks: Vec<ClockBlock>,
    all: Candidates,
    near: Candidates,
    /// Number of words per tile.
    blocks: usize,
    /// The satellites that may be visible from the tiles of a group, one bit each, tile by tile.
    words: Vec<u64>,
}

impl Workspace {
    /// Takes the satellites where they are now.
    #[inline(always)]
    pub(super) fn begin(&mut self, horizon: &Horizon) {
        if self.clocks.is_empty() {
            self.all.fill(&self.positions, horizon);
        } else {
            self.all
                .fill_by_clock(&self.positions, horizon, &self.clocks);
        }
    }

    /// Whether the satellites have several clocks.
    #[inline(always)]
    pub(super) fn has_several_clocks(&self) -> bool {
        !self.clocks.is_empty()
    }

    /// How many clocks they have.
    pub(super) fn clock_count(&self) -> u32 {
        self.clocks.last().map_or(1, |last| last.clock + 1)
    }

    /// Selects the satellites that the tiles of a group may see.
    #[inline(always)]
    pub(super) fn select(&mut self, scene: &SampleContext, group: &Group) {
        let slack_km = self.select_near(group);
        let blocks = self.near.blocks();
        let tiles = &scene.tiles.tiles[group.tiles.clone()];
        for (tile, words) in tiles.iter().zip(self.words.chunks_exact_mut(self.blocks)) {
            for (block, word) in blocks.iter().zip(words) {
                *word = block.inside(&tile.cap, slack_km);
            }
        }
    }

    /// Selects the satellites that a group may see, and returns the error bound of a cap test, km.
    #[inline(always)]
    pub(super) fn select_near(&mut self, group: &Group) -> f32 {
        let slack_km = Horizon::cap_slack_km(&self.positions);
        self.near.select(&self.all, &group.cap, slack_km);
        slack_km
    }

    /// Selects those that one tile of the group may see.
    #[inline(always)]
    pub(super) fn select_tile(&mut self, tile: &Tile, place: usize, slack_km: f32) {
        let words = &mut self.words[place * self.blocks..(place + 1) * self.blocks];
        for (block, word) in self.near.blocks().iter().zip(words) {
            *word = block.inside(&tile.cap, slack_km);
        }
    }

    /// The satellites that a tile of the selected group may see.
    #[inline(always)]
    pub(super) fn candidates(&self, number: usize, group: &Group) -> TileCandidates<'_> {
        let place = number - group.tiles.start;
        TileCandidates {
            blocks: self.near.blocks(),
            words: &self.words[place * self.blocks..(place + 1) * self.blocks],
        }
    }

    pub(super) fn new(propagation: &Propagation<'_>) -> Self {
        let satellites = propagation.ephemeris.satellites().len();
        let clocks = propagation.clocks.clone();
        let blocks = satellites.div_ceil(BLOCK).max(clocks.len()).max(1);
        let all = Candidates::with_blocks(blocks);
        Self {
            positions: Positions::new(satellites),
            turns: Vec::new(),
            clocks,
            near: all.clone(),
            blocks,
            words: vec![0; blocks * TILES_IN_GROUP],
            all,
        }
    }
}

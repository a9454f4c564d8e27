//! LEO satellites with several clocks.
//!
//! A block of candidates has satellites of one clock, so that the sums of a clock are those of some blocks in a row. What a
//! clock leaves of the normal matrix is added before the sums of the next one begin.

use super::propagation::{BLOCK, PositionBlock, Positions};

/// Satellites that share a clock, up to a block of them.
#[derive(Debug, Clone)]
pub(super) struct ClockBlock {
    pub(super) clock: u32,
    pub(super) satellites: Vec<u32>,
}

impl ClockBlock {
    /// All satellites, clock by clock, from the clock of each.
    pub(super) fn of(clocks: &[usize]) -> Vec<Self> {
        let mut order: Vec<u32> = (0..clocks.len() as u32).collect();
        let clock = |satellite: u32| clocks[satellite as usize];
        order.sort_by_key(|&satellite| clock(satellite));
        let of_clock = order.chunk_by(|&a, &b| clock(a) == clock(b));
        let blocks = of_clock.flat_map(|satellites| satellites.chunks(BLOCK));
        let block = |satellites: &[u32]| Self {
            clock: clock(satellites[0]) as u32,
            satellites: satellites.to_vec(),
        };
        blocks.map(block).collect()
    }

    #[inline(always)]
    pub(super) fn positions(&self, all: &Positions) -> PositionBlock {
        let mut block = PositionBlock::NOWHERE;
        for (n, &satellite) in self.satellites.iter().enumerate() {
            [block.x[n], block.y[n], block.z[n]] = all.at(satellite as usize);
        }
        block
    }
}

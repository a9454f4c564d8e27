//! Satellites that a cap of ground points may see.

use super::clocks::ClockBlock;
use super::propagation::{BLOCK, PositionBlock, Positions};
use super::tiles::{Cap, Horizon};

/// Satellites in f32 that are tested together, one for each bit of a word.
///
/// A slot without a satellite is NaN, which passes no test.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Block {
    x: [f32; BLOCK],
    y: [f32; BLOCK],
    z: [f32; BLOCK],
    /// What the rounding to f32 took from x, y and z.
    rest: [[f32; BLOCK]; 3],
    /// sqrt(|r|² - k²), see [`super::tiles`].
    q: [f32; BLOCK],
    /// Number of each among all satellites.
    index: [u32; BLOCK],
    /// The clock that they share, by its number among those of the LEO satellites.
    clock: u32,
}

impl Block {
    const EMPTY: Self = Self {
        x: [f32::NAN; BLOCK],
        y: [f32::NAN; BLOCK],
        z: [f32::NAN; BLOCK],
        rest: [[0.0; BLOCK]; 3],
        q: [f32::NAN; BLOCK],
        index: [0; BLOCK],
        clock: 0,
    };

    /// The position seen from a place close to it, which is exact in f32: good to f32 of the distance, not of the radius.
    #[inline(always)]
    pub(super) fn position_from(&self, place: [f32; 3], n: usize) -> [f32; 3] {
        let [x, y, z] = place;
        [
            (self.x[n] - x) + self.rest[0][n],
            (self.y[n] - y) + self.rest[1][n],
            (self.z[n] - z) + self.rest[2][n],
        ]
    }

    #[inline(always)]
    pub(super) fn index(&self, n: usize) -> usize {
        self.index[n] as usize
    }

    #[inline(always)]
    pub(super) fn clock(&self) -> u32 {
        self.clock
    }

    /// A bit for each satellite that some part of the cap may see.
    #[inline(always)]
    pub(super) fn inside(&self, cap: &Cap, slack_km: f32) -> u64 {
        let bound = cap.bound - slack_km;
        let [x, y, z] = cap.centre;
        let bit = |n: usize, place: usize| {
            let reach = self.x[n] * x + self.y[n] * y + self.z[n] * z + self.q[n] * cap.sine;
            if reach >= bound { 1_u32 << place } else { 0 }
        };
        // Lanes of words with disjoint bits, because vector comparisons do not give a word directly.
        let (mut low, mut high) = ([0; QUARTER], [0; QUARTER]);
        for l in 0..QUARTER {
            low[l] = bit(l, l) | bit(QUARTER + l, QUARTER + l);
            high[l] = bit(2 * QUARTER + l, l) | bit(3 * QUARTER + l, QUARTER + l);
        }
        let joined =
            |lanes: [u32; QUARTER]| u64::from(lanes.iter().fold(0, |all, bits| all | bits));
        joined(low) | joined(high) << (2 * QUARTER)
    }

    #[inline(always)]
    fn fill(&mut self, from: &PositionBlock, reach2: f64, first: usize) {
        for n in 0..BLOCK {
            let (x, y, z) = (from.x[n], from.y[n], from.z[n]);
            let beyond = (x * x + y * y + z * z - reach2) as f32;
            (self.x[n], self.y[n], self.z[n]) = (x as f32, y as f32, z as f32);
            self.rest[0][n] = (x - f64::from(self.x[n])) as f32;
            self.rest[1][n] = (y - f64::from(self.y[n])) as f32;
            self.rest[2][n] = (z - f64::from(self.z[n])) as f32;
            self.q[n] = if beyond > 0.0 { beyond.sqrt() } else { 0.0 };
            self.index[n] = (first + n) as u32;
        }
    }
}

/// Maximum number of satellites of a block in one vector register.
const QUARTER: usize = BLOCK / 4;

/// The numbers of the bits that are set, in increasing order.
#[inline(always)]
pub(super) fn bits(mut word: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        (word != 0).then(|| {
            let n = word.trailing_zeros() as usize % BLOCK;
            word &= word - 1;
            n
        })
    })
}

/// A list of satellites.
#[derive(Debug, Clone)]
pub(super) struct Candidates {
    blocks: Vec<Block>,
    /// Places of the blocks that are in use.
    count: usize,
}

impl Candidates {
    /// An empty list with capacity for `count` of one clock.
    pub(super) fn with_capacity(count: usize) -> Self {
        Self::with_blocks(count.div_ceil(BLOCK))
    }

    pub(super) fn with_blocks(blocks: usize) -> Self {
        Self {
            blocks: vec![Block::EMPTY; blocks],
            count: 0,
        }
    }

    #[inline(always)]
    pub(super) fn blocks(&self) -> &[Block] {
        &self.blocks[..self.count.div_ceil(BLOCK)]
    }

    /// All satellites.
    #[inline(always)]
    pub(super) fn fill(&mut self, positions: &Positions, horizon: &Horizon) {
        for (number, (to, from)) in self.blocks.iter_mut().zip(&positions.blocks).enumerate() {
            to.fill(from, horizon.reach2, number * BLOCK);
        }
        self.count = positions.count;
    }

    /// All satellites of several clocks, each block with those of one.
    #[inline(always)]
    pub(super) fn fill_by_clock(
        &mut self,
        positions: &Positions,
        horizon: &Horizon,
        clocks: &[ClockBlock],
    ) {
        for (to, from) in self.blocks.iter_mut().zip(clocks) {
            to.fill(&from.positions(positions), horizon.reach2, 0);
            for (index, &satellite) in to.index.iter_mut().zip(&from.satellites) {
                *index = satellite;
            }
            to.clock = from.clock;
        }
        self.count = clocks.len() * BLOCK;
    }

    /// Those of `others` that some part of the cap may see; those of a clock begin a block.
    #[inline(always)]
    pub(super) fn select(&mut self, others: &Self, cap: &Cap, slack_km: f32) {
        self.count = 0;
        let mut clock = 0;
        for block in others.blocks() {
            if block.clock != clock {
                clock = block.clock;
                self.end_block();
            }
            for n in bits(block.inside(cap, slack_km)) {
                let to = &mut self.blocks[self.count / BLOCK];
                let place = self.count % BLOCK;
                to.x[place] = block.x[n];
                to.y[place] = block.y[n];
                to.z[place] = block.z[n];
                for (to, rest) in to.rest.iter_mut().zip(&block.rest) {
                    to[place] = rest[n];
                }
                to.q[place] = block.q[n];
                to.index[place] = block.index[n];
                to.clock = clock;
                self.count += 1;
            }
        }
        self.end_block();
    }

    /// Leaves the rest of the last block empty.
    #[inline(always)]
    fn end_block(&mut self) {
        if !self.count.is_multiple_of(BLOCK) {
            // One NaN in the sum of the test is enough.
            self.blocks[self.count / BLOCK].x[self.count % BLOCK..].fill(f32::NAN);
            self.count = self.count.next_multiple_of(BLOCK);
        }
    }
}

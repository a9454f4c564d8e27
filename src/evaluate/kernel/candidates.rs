//! Satellites that a cap of ground points may see.

use super::flight::{BLOCK, Positions};
use super::tiles::{Cap, Horizon};

/// Satellites in f32, which are tested together, one for each bit of a word.
///
/// A place without a satellite holds NaN, which passes no test.
#[derive(Debug, Clone)]
#[repr(align(64))]
pub(super) struct Block {
    x: [f32; BLOCK],
    y: [f32; BLOCK],
    z: [f32; BLOCK],
    /// sqrt(|r|² - k²), see [`super::tiles`].
    q: [f32; BLOCK],
    /// Number of each among all satellites.
    index: [u32; BLOCK],
}

impl Block {
    const EMPTY: Self = Self {
        x: [f32::NAN; BLOCK],
        y: [f32::NAN; BLOCK],
        z: [f32::NAN; BLOCK],
        q: [f32::NAN; BLOCK],
        index: [0; BLOCK],
    };

    #[inline(always)]
    pub(super) fn position(&self, n: usize) -> [f32; 3] {
        [self.x[n], self.y[n], self.z[n]]
    }

    #[inline(always)]
    pub(super) fn index(&self, n: usize) -> usize {
        self.index[n] as usize
    }

    /// A bit for each satellite that the cap may see something of.
    #[inline(always)]
    pub(super) fn inside(&self, cap: &Cap, slack_km: f32) -> u64 {
        let bound = cap.bound - slack_km;
        let [x, y, z] = cap.centre;
        let mut hits = [0_u8; BLOCK];
        for n in 0..BLOCK {
            let reach = self.x[n] * x + self.y[n] * y + self.z[n] * z + self.q[n] * cap.sine;
            hits[n] = u8::from(reach >= bound);
        }
        let mut word = 0;
        for (n, eight) in hits.as_chunks::<8>().0.iter().enumerate() {
            // The product gathers the lowest bits of eight bytes in its highest byte.
            let bits = u64::from_le_bytes(*eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
            word |= bits << (8 * n);
        }
        word
    }
}

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

/// What bounds the rounding of all satellites of one sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Extent {
    nearest_km: f64,
    farthest_km: f64,
}

impl Extent {
    /// By how much a test of a cap may be wrong in f32, km: eight roundings of the largest
    /// number in it, and as much again.
    pub(super) fn cap_slack_km(self) -> f32 {
        self.farthest_km as f32 * (16.0 * f32::EPSILON)
    }

    /// By how much the sine of an elevation at the mask may be wrong in f32: two positions that
    /// were rounded by half a unit in each of three components, over the shortest range; and
    /// eight roundings of the sine itself.
    pub(super) fn sine_slack(self, horizon: &Horizon) -> f32 {
        let rounding_km = self.farthest_km * f64::from(f32::EPSILON) * 3_f64.sqrt();
        let range_km = horizon.range_at_mask_km(self.nearest_km);
        let slack = rounding_km / range_km + 4.0 * f64::from(f32::EPSILON);
        // Satellites on the ground leave nothing to f32.
        slack.min(2.0) as f32
    }
}

/// A list of satellites.
#[derive(Debug, Clone)]
pub(super) struct Candidates {
    blocks: Vec<Block>,
    count: usize,
}

impl Candidates {
    /// An empty list with room for `count`.
    pub(super) fn with_capacity(count: usize) -> Self {
        Self {
            blocks: vec![Block::EMPTY; count.div_ceil(BLOCK)],
            count: 0,
        }
    }

    #[inline(always)]
    pub(super) fn blocks(&self) -> &[Block] {
        &self.blocks[..self.count.div_ceil(BLOCK)]
    }

    /// All satellites.
    #[inline(always)]
    pub(super) fn fill(&mut self, positions: &Positions, horizon: &Horizon) -> Extent {
        let reach2 = horizon.reach2();
        let (mut low2, mut high2) = (f64::INFINITY, 0.0_f64);
        for (number, (to, from)) in self.blocks.iter_mut().zip(&positions.blocks).enumerate() {
            for n in 0..BLOCK {
                let (x, y, z) = (from.x[n], from.y[n], from.z[n]);
                let radius2 = x * x + y * y + z * z;
                low2 = if radius2 < low2 { radius2 } else { low2 };
                high2 = if radius2 > high2 { radius2 } else { high2 };
                (to.x[n], to.y[n], to.z[n]) = (x as f32, y as f32, z as f32);
                let beyond = (radius2 - reach2) as f32;
                to.q[n] = if beyond > 0.0 { beyond.sqrt() } else { 0.0 };
                to.index[n] = (number * BLOCK + n) as u32;
            }
        }
        self.count = positions.count;
        Extent {
            nearest_km: low2.sqrt(),
            farthest_km: high2.sqrt(),
        }
    }

    /// Those of `others` that the cap may see something of.
    #[inline(always)]
    pub(super) fn select(&mut self, others: &Self, cap: &Cap, slack_km: f32) {
        self.count = 0;
        for block in others.blocks() {
            for n in bits(block.inside(cap, slack_km)) {
                let to = &mut self.blocks[self.count / BLOCK];
                let place = self.count % BLOCK;
                to.x[place] = block.x[n];
                to.y[place] = block.y[n];
                to.z[place] = block.z[n];
                to.q[place] = block.q[n];
                to.index[place] = block.index[n];
                self.count += 1;
            }
        }
        if !self.count.is_multiple_of(BLOCK) {
            // One NaN in the sum of the test is enough.
            self.blocks[self.count / BLOCK].x[self.count % BLOCK..].fill(f32::NAN);
        }
    }
}

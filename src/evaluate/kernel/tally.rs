//! Statistics of a stream of PDOP values in two passes, without keeping the values.
//!
//! The first pass counts values in narrow buckets and sums them. The counts say in which bucket
//! each order statistic lies; the second pass collects the values of those few buckets, and sums
//! what lies above the bucket of the value-at-risk. The result is exact, whatever the order of
//! the values: counts are integers, and sums are made in blocks of samples that do not depend on
//! who makes them.

use super::lanes::{LANES, Lanes};
use super::sample::UNSOLVED;
use crate::stats::{Level, Summary, quantile_rank};

/// Bits of an f32 that a bucket does not look at: it keeps 13 of the 23 of the fraction.
const IGNORED_BITS: u32 = 10;
/// Values below 2^-7 and from 2^17 on share the first and the last bucket.
const FIRST: u32 = (127 - 7) << (23 - IGNORED_BITS);
const BUCKETS: usize = 24 << (23 - IGNORED_BITS);

/// The bucket of a positive value; larger values have the same or a later one.
fn bucket(value: f32) -> usize {
    ((value.to_bits() >> IGNORED_BITS).saturating_sub(FIRST) as usize).min(BUCKETS - 1)
}

/// Least value of a bucket, and what its values are less than.
fn edges(bucket: usize) -> (f32, f32) {
    let edge = |number: usize| f32::from_bits((number as u32 + FIRST) << IGNORED_BITS);
    let start = if bucket == 0 { 0.0 } else { edge(bucket) };
    let end = if bucket == BUCKETS - 1 {
        UNSOLVED
    } else {
        edge(bucket + 1)
    };
    (start, end)
}

/// First pass: how many values there are in each bucket, and the largest.
pub(super) struct Counts {
    buckets: Vec<u64>,
    solved: u64,
    max: f32,
}

impl Counts {
    pub(super) fn new() -> Self {
        Self {
            buckets: vec![0; BUCKETS],
            solved: 0,
            max: 0.0,
        }
    }

    /// Counts the solved values of some tiles.
    pub(super) fn take(&mut self, tiles: &[Lanes<f32>]) {
        for &value in tiles.iter().flat_map(|tile| &tile.0) {
            if value < UNSOLVED {
                self.buckets[bucket(value)] += 1;
                self.solved += 1;
                self.max = self.max.max(value);
            }
        }
    }

    pub(super) fn merged(mut self, other: &Self) -> Self {
        for (mine, theirs) in self.buckets.iter_mut().zip(&other.buckets) {
            *mine += theirs;
        }
        self.solved += other.solved;
        self.max = self.max.max(other.max);
        self
    }

    /// Solved values.
    pub(super) fn solved(&self) -> u64 {
        self.solved
    }

    /// The bucket of the order statistic of a rank (from 1), and how many values of the bucket
    /// come before it.
    fn locate(&self, rank: usize) -> (usize, usize) {
        let mut before = rank - 1;
        for (number, &count) in self.buckets.iter().enumerate() {
            if before < count as usize {
                return (number, before);
            }
            before -= count as usize;
        }
        (BUCKETS - 1, 0)
    }
}

/// The sum of the solved values of some tiles.
pub(super) fn sum(tiles: &[Lanes<f32>]) -> f64 {
    let mut sums = [0.0; LANES];
    for tile in tiles {
        for (sum, &value) in sums.iter_mut().zip(&tile.0) {
            let solved = value < UNSOLVED;
            *sum += f64::from(if solved { value } else { 0.0 });
        }
    }
    sums.iter().sum()
}

/// Where an order statistic lies: in a bucket, at a place (from 0) of its sorted values.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    start: f32,
    end: f32,
    place: usize,
}

impl Wanted {
    fn new(counts: &Counts, level: f64, solved: usize) -> Self {
        let (bucket, place) = counts.locate(quantile_rank(level, solved));
        let (start, end) = edges(bucket);
        Self { start, end, place }
    }

    fn includes(&self, value: f32) -> bool {
        (value >= self.start) & (value < self.end)
    }
}

/// Second pass: what to look for.
#[derive(Debug, Clone, Copy)]
pub(super) struct Search {
    level: Level,
    solved: usize,
    max: f32,
    /// Median, 95 %, 99 %, value-at-risk.
    wanted: [Wanted; 4],
}

/// What a second pass over some tiles finds.
#[derive(Debug, Clone, Default)]
pub(super) struct Found {
    /// The values in the bucket of each order statistic.
    values: [Vec<f32>; 4],
    /// Sum and number of the values beyond the bucket of the value-at-risk.
    tail: f64,
    beyond: u64,
}

impl Search {
    /// `None` when no value is solved.
    pub(super) fn new(counts: &Counts, level: Level) -> Option<Self> {
        let solved = usize::try_from(counts.solved).ok().filter(|&n| n > 0)?;
        let levels = [0.50, 0.95, 0.99, level.get()];
        Some(Self {
            level,
            solved,
            max: counts.max,
            wanted: levels.map(|q| Wanted::new(counts, q, solved)),
        })
    }

    /// Looks through some tiles.
    pub(super) fn scan(&self, tiles: &[Lanes<f32>]) -> Found {
        let mut found = Found::default();
        let tail_start = self.wanted[3].end;
        let mut tail = [0.0; LANES];
        let mut beyond = [0_u32; LANES];
        for tile in tiles {
            let mut any = false;
            for l in 0..LANES {
                let value = tile.0[l];
                let in_tail = (value >= tail_start) & (value < UNSOLVED);
                tail[l] += f64::from(if in_tail { value } else { 0.0 });
                beyond[l] += u32::from(in_tail);
                any |= self.wanted.iter().any(|wanted| wanted.includes(value));
            }
            if any {
                for (values, wanted) in found.values.iter_mut().zip(&self.wanted) {
                    values.extend(tile.0.iter().filter(|&&value| wanted.includes(value)));
                }
            }
        }
        found.tail = tail.iter().sum();
        found.beyond = beyond.into_iter().map(u64::from).sum();
        found
    }

    /// The statistics, from the finds of all tiles and the sum of all values.
    pub(super) fn summary(&self, mut found: Found, sum: f64) -> Summary {
        let [p50, p95, p99, value_at_risk] = std::array::from_fn(|n| {
            let values = &mut found.values[n];
            values.sort_unstable_by(f32::total_cmp);
            // The first pass has counted the value, so that it is there.
            values
                .get(self.wanted[n].place)
                .map_or(f64::NAN, |&value| f64::from(value))
        });
        let nearby = found.values[3].iter().map(|&value| f64::from(value));
        let excess = found.tail - found.beyond as f64 * value_at_risk
            + nearby
                .map(|value| (value - value_at_risk).max(0.0))
                .sum::<f64>();
        let share = (1.0 - self.level.get()) * self.solved as f64;
        Summary {
            mean: sum / self.solved as f64,
            p50,
            p95,
            p99,
            max: f64::from(self.max),
            cvar: value_at_risk + excess / share,
        }
    }
}

impl Found {
    pub(super) fn add(&mut self, other: Self) {
        for (mine, theirs) in self.values.iter_mut().zip(other.values) {
            mine.extend(theirs);
        }
        self.tail += other.tail;
        self.beyond += other.beyond;
    }
}

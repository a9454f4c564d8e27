//! Statistics of a stream of PDOP values in two passes, without storing or sorting the values.
//!
//! The first pass counts values by their leading bits and sums them. The counts determine the leading
//! bits of each order statistic; the second pass counts the trailing bits of the values that begin
//! with them, and sums the values beyond the value-at-risk. This gives every order statistic and the
//! tail exactly, in memory that does not depend on the number of values.
//!
//! Each value counts with the weight of its point, a whole number ([`super::super::weights`]), so counts do not
//! depend on the order of the values; sums are computed in pieces that do not depend on the thread.

use super::instructions::Work;
use super::lanes::{LANES, Lanes};
use super::refine::Ranked;
use super::sample::UNSOLVED;
use super::tiles::Tile;
use crate::stats::{Level, Summary};

/// Bits of an f32 that the first pass ignores: it uses 11 of the 23 bits of the fraction.
const TRAILING_BITS: u32 = 12;

/// Places begin at 2^-7: n satellites give a PDOP of 3/√n or more, which is above that up to
/// 147 000 satellites.
const FIRST: u32 = (127 - 7) << (23 - TRAILING_BITS);

/// The places of the first pass, by leading bits.
#[derive(Debug, Clone, Copy)]
pub(super) struct Places {
    /// The place after that of the maximum PDOP, for unsolved samples.
    unsolved: u32,
}

impl Places {
    /// Places for PDOP up to `cap`; fewer places mean less memory to go through for each design.
    pub(super) fn new(cap: f64) -> Self {
        let largest = (cap as f32).min(f32::MAX);
        Self {
            unsolved: (largest.to_bits() >> TRAILING_BITS).max(FIRST) - FIRST + 1,
        }
    }

    /// Memory that the counts of all places take.
    pub(super) fn bytes(self) -> usize {
        self.count() * size_of::<u64>()
    }

    fn count(self) -> usize {
        self.unsolved as usize + 1
    }

    /// Whether it can be a value of a sample.
    pub(super) fn admits(self, value: f32) -> bool {
        value == UNSOLVED || value > 0.0 && self.of(value) < self.unsolved
    }

    /// The place of a value; larger values have the same or a later one.
    #[inline(always)]
    fn of(self, value: f32) -> u32 {
        let leading = value.to_bits() >> TRAILING_BITS;
        (leading.max(FIRST) - FIRST).min(self.unsolved)
    }
}

/// The value of a place with some trailing bits.
fn value(place: u32, trailing: usize) -> f64 {
    f64::from(f32::from_bits(
        (place + FIRST) << TRAILING_BITS | trailing as u32,
    ))
}

/// Merges the results of passes over pieces that follow each other.
pub(super) trait Merge {
    fn merged(self, other: &Self) -> Self;
}

impl<A: Merge> Merge for Vec<A> {
    fn merged(self, other: &Self) -> Self {
        let pairs = self.into_iter().zip(other);
        pairs.map(|(mine, theirs)| mine.merged(theirs)).collect()
    }
}

impl<A: Merge, B: Merge> Merge for (A, B) {
    fn merged(self, other: &Self) -> Self {
        (self.0.merged(&other.0), self.1.merged(&other.1))
    }
}

/// First pass: weight of the values in each place.
#[derive(Debug, Clone)]
pub(super) struct Counts {
    places: Places,
    counts: Vec<u64>,
    /// Number of solved values, whatever their weight.
    number: u64,
}

impl Counts {
    pub(super) fn new(places: Places) -> Self {
        Self {
            places,
            counts: vec![0; places.count()],
            number: 0,
        }
    }

    /// Weight of the solved values.
    pub(super) fn solved(&self) -> u64 {
        self.counts[..self.places.unsolved as usize].iter().sum()
    }

    /// The place of the order statistic of a rank (from 1). Strides of places are passed by their sums.
    fn locate(&self, rank: u64) -> Wanted {
        const STRIDE: usize = 128;
        let (mut before, mut first) = (rank - 1, 0);
        for stride in self.counts.chunks(STRIDE) {
            let here = stride.iter().sum();
            if before < here {
                break;
            }
            before -= here;
            first += STRIDE;
        }
        let mut counted = (first..).zip(self.counts.iter().skip(first));
        let place = counted.find_map(|(place, &count)| {
            let here = before < count;
            before -= if here { 0 } else { count };
            here.then_some(place as u32)
        });
        Wanted {
            place: place.unwrap_or(self.places.unsolved),
            rank,
            before,
        }
    }
}

impl Merge for Counts {
    fn merged(mut self, other: &Self) -> Self {
        add(&mut self.counts, &other.counts);
        self.number += other.number;
        self
    }
}

fn add(mine: &mut [u64], theirs: &[u64]) {
    for (mine, theirs) in mine.iter_mut().zip(theirs) {
        *mine += theirs;
    }
}

/// The first pass over the values of some instants; its output is the weighted sum of the solved ones.
pub(super) struct Count<'a> {
    pub(super) tiles: &'a [Tile],
    pub(super) values: &'a [Lanes<f32>],
    pub(super) counts: &'a mut Counts,
}

impl Work for Count<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let (mut sums, mut numbers) = ([0.0; LANES], [0_u64; LANES]);
        let numbering = self.counts.places;
        for values in self.values.chunks_exact(self.tiles.len()) {
            for (tile, values) in self.tiles.iter().zip(values) {
                let weights = &tile.weights;
                let mut places = [0; LANES];
                for l in 0..LANES {
                    let value = values.0[l];
                    places[l] = numbering.of(value);
                    numbers[l] += u64::from(value < UNSOLVED);
                    let solved = f64::from(if value < UNSOLVED { value } else { 0.0 });
                    sums[l] += weights.real.0[l] * solved;
                }
                for (place, weight) in places.into_iter().zip(weights.whole.0) {
                    self.counts.counts[place as usize] += weight;
                }
            }
        }
        self.counts.number += numbers.iter().sum::<u64>();
        sums.iter().sum()
    }
}

/// An order statistic: its place, its rank among all values, and its rank within the place; ranks count weight.
#[derive(Debug, Clone, Copy)]
struct Wanted {
    place: u32,
    rank: u64,
    before: u64,
}

/// Order statistics that are searched for: median, 95 %, 99 %, largest, value-at-risk.
const WANTED: usize = 5;
const VALUE_AT_RISK: usize = 4;

/// Targets of the second pass.
#[derive(Debug, Clone, Copy)]
pub(super) struct RankSearch {
    places: Places,
    level: Level,
    solved: u64,
    wanted: [Wanted; WANTED],
}

/// Second pass: weight of the values in the wanted places by their trailing bits.
#[derive(Debug, Clone)]
pub(super) struct Found([Vec<u64>; WANTED]);

impl Found {
    /// Memory that it takes.
    pub(super) const BYTES: usize = WANTED * (size_of::<u64>() << TRAILING_BITS);

    pub(super) fn new() -> Self {
        Self(std::array::from_fn(|_| vec![0; 1 << TRAILING_BITS]))
    }
}

impl Merge for Found {
    fn merged(mut self, other: &Self) -> Self {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            add(mine, theirs);
        }
        self
    }
}

/// The second pass over the values of some instants; its output is the weighted sum of the solved ones in
/// places beyond that of the value-at-risk.
pub(super) struct Find<'a> {
    pub(super) tiles: &'a [Tile],
    pub(super) values: &'a [Lanes<f32>],
    pub(super) search: &'a RankSearch,
    pub(super) found: &'a mut Found,
}

impl Work for Find<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let wanted = self.search.wanted.map(|wanted| wanted.place);
        let places = self.search.places;
        let mut tail = [0.0; LANES];
        for values in self.values.chunks_exact(self.tiles.len()) {
            for (tile, values) in self.tiles.iter().zip(values) {
                let mut hits = 0;
                let lanes = tail.iter_mut().zip(&values.0).zip(&tile.weights.real.0);
                for ((tail, &value), weight) in lanes {
                    let place = places.of(value);
                    let beyond = (place > wanted[VALUE_AT_RISK]) & (place < places.unsolved);
                    let value = f64::from(if beyond { value } else { 0.0 });
                    *tail += weight * value;
                    for wanted in wanted {
                        hits |= u32::from(place == wanted);
                    }
                }
                if hits != 0 {
                    note(tile, values, places, &wanted, self.found);
                }
            }
        }
        tail.iter().sum()
    }
}

/// Counts the values in wanted places by their trailing bits.
fn note(
    tile: &Tile,
    values: &Lanes<f32>,
    places: Places,
    wanted: &[u32; WANTED],
    found: &mut Found,
) {
    for (counts, &wanted) in found.0.iter_mut().zip(wanted) {
        for (value, weight) in values.0.iter().zip(tile.weights.whole.0) {
            if places.of(*value) == wanted {
                counts[(value.to_bits() % (1 << TRAILING_BITS)) as usize] += weight;
            }
        }
    }
}

/// The rank of the quantile of level `q` among values of this weight and number: the least cumulative weight
/// that reaches q of all, minus 1e-9 of the mean weight ([M-28](crate::models#m-28)).
pub(in crate::evaluate) fn quantile_rank(q: f64, weight: u64, number: u64) -> u64 {
    let slack = 1e-9 * (weight as f64 / number as f64);
    let rank = (q * weight as f64 - slack).ceil();
    (rank.max(1.0) as u64).min(weight)
}

/// The value of a place that has `before` of the weight of the place before it or with it, and what it has before it.
fn reached(place: u32, before: u64, counts: &[u64]) -> (f64, u64) {
    let mut passed = 0;
    for (trailing, &count) in counts.iter().enumerate() {
        if before < passed + count {
            return (value(place, trailing), passed);
        }
        passed += count;
    }
    (f64::NAN, passed)
}

impl RankSearch {
    /// `None` if no value is solved.
    pub(super) fn new(counts: &Counts, level: Level) -> Option<Self> {
        let solved = counts.solved();
        let ranked = |q: f64| counts.locate(quantile_rank(q, solved, counts.number));
        (counts.number > 0).then(|| Self {
            places: counts.places,
            level,
            solved,
            wanted: [
                ranked(0.50),
                ranked(0.95),
                ranked(0.99),
                counts.locate(solved),
                ranked(level.get()),
            ],
        })
    }

    /// An order statistic in f32: median, 95 %, 99 %, largest.
    pub(super) fn ranked(&self, found: &Found, number: usize) -> Ranked {
        let Wanted {
            place,
            rank,
            before,
        } = self.wanted[number];
        let (value, passed) = reached(place, before, &found.0[number]);
        Ranked {
            rank,
            value,
            below: rank - 1 - before + passed,
        }
    }

    /// The statistics, from the finds of all tiles, the sum of all values and that of those
    /// beyond the place of the value-at-risk.
    pub(super) fn summary(&self, found: &Found, sum: f64, tail: f64) -> Summary {
        let [p50, p95, p99, max, value_at_risk] = std::array::from_fn(|n| {
            let Wanted { place, before, .. } = self.wanted[n];
            reached(place, before, &found.0[n]).0
        });
        let Wanted {
            place,
            rank,
            before,
        } = self.wanted[VALUE_AT_RISK];
        let counts = &found.0[VALUE_AT_RISK];
        let in_place: u64 = counts.iter().sum();
        let beyond = self.solved - (rank - 1 - before) - in_place;
        let nearby = counts.iter().enumerate().map(|(trailing, &count)| {
            (value(place, trailing) - value_at_risk).max(0.0) * count as f64
        });
        let excess = tail - beyond as f64 * value_at_risk + nearby.sum::<f64>();
        let share = (1.0 - self.level.get()) * self.solved as f64;
        Summary {
            mean: sum / self.solved as f64,
            p50,
            p95,
            p99,
            max,
            cvar: value_at_risk + excess / share,
        }
    }
}

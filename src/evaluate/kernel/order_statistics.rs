//! Statistics of a stream of PDOP values in two passes, without storing or sorting the values.
//!
//! The first pass counts values by their leading bits and sums them. The counts determine the leading
//! bits of each order statistic; the second pass counts the trailing bits of the values that begin
//! with them, and sums the values beyond the value-at-risk. This gives every order statistic and the
//! tail exactly, in memory that does not depend on the number of values.
//!
//! Counts are integers and do not depend on the order of the values; sums are computed in pieces that
//! do not depend on the thread.

use super::instructions::Work;
use super::lanes::{LANES, Lanes};
use super::sample::UNSOLVED;
use crate::stats::{Level, Summary, quantile_rank};

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

/// Merges the results of passes over different pieces.
pub(super) trait Merge {
    fn merged(self, other: &Self) -> Self;
}

/// First pass: number of values in each place.
pub(super) struct Counts {
    places: Places,
    counts: Vec<u64>,
    values: u64,
}

impl Counts {
    pub(super) fn new(places: Places) -> Self {
        Self {
            places,
            counts: vec![0; places.count()],
            values: 0,
        }
    }

    /// Solved values.
    pub(super) fn solved(&self) -> u64 {
        self.values - self.counts[self.places.unsolved as usize]
    }

    /// The place of the order statistic of a rank (from 1).
    fn locate(&self, rank: u64) -> Wanted {
        let mut before = rank - 1;
        let mut counted = (0..).zip(&self.counts);
        let place = counted.find_map(|(place, &count)| {
            let here = before < count;
            before -= if here { 0 } else { count };
            here.then_some(place)
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
        self.values += other.values;
        self
    }
}

fn add(mine: &mut [u64], theirs: &[u64]) {
    for (mine, theirs) in mine.iter_mut().zip(theirs) {
        *mine += theirs;
    }
}

/// The first pass over some tiles; its output is the sum of the solved values.
pub(super) struct Count<'a> {
    pub(super) tiles: &'a [Lanes<f32>],
    pub(super) counts: &'a mut Counts,
}

impl Work for Count<'_> {
    type Output = f64;

    #[inline(always)]
    fn run(self) -> f64 {
        let mut sums = [0.0; LANES];
        let numbering = self.counts.places;
        for tile in self.tiles {
            let mut places = [0; LANES];
            for l in 0..LANES {
                let value = tile.0[l];
                places[l] = numbering.of(value);
                sums[l] += f64::from(if value < UNSOLVED { value } else { 0.0 });
            }
            for place in places {
                self.counts.counts[place as usize] += 1;
            }
        }
        self.counts.values += (self.tiles.len() * LANES) as u64;
        sums.iter().sum()
    }
}

/// An order statistic: its place, its rank among all values, and its rank within the place.
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

/// Second pass: trailing bits of the values in the wanted places.
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

/// The second pass over some tiles; its output is the sum of the solved values in places beyond
/// that of the value-at-risk.
pub(super) struct Find<'a> {
    pub(super) tiles: &'a [Lanes<f32>],
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
        for tile in self.tiles {
            let mut hits = 0;
            for (tail, &value) in tail.iter_mut().zip(&tile.0) {
                let place = places.of(value);
                let beyond = (place > wanted[VALUE_AT_RISK]) & (place < places.unsolved);
                *tail += f64::from(if beyond { value } else { 0.0 });
                for wanted in wanted {
                    hits |= u32::from(place == wanted);
                }
            }
            if hits != 0 {
                note(tile, places, &wanted, self.found);
            }
        }
        tail.iter().sum()
    }
}

/// Counts the trailing bits of the values in wanted places.
fn note(tile: &Lanes<f32>, places: Places, wanted: &[u32; WANTED], found: &mut Found) {
    for (counts, &wanted) in found.0.iter_mut().zip(wanted) {
        for value in tile.0.iter().filter(|&&value| places.of(value) == wanted) {
            counts[(value.to_bits() % (1 << TRAILING_BITS)) as usize] += 1;
        }
    }
}

impl RankSearch {
    /// `None` if no value is solved.
    pub(super) fn new(counts: &Counts, level: Level) -> Option<Self> {
        let solved = counts.solved();
        let ranked = |q: f64| counts.locate(quantile_rank(q, solved as usize) as u64);
        (solved > 0).then(|| Self {
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

    /// The rank of an order statistic: median, 95 %, 99 %, largest.
    pub(super) fn rank(&self, number: usize) -> u64 {
        self.wanted[number].rank
    }

    /// The statistics, from the finds of all tiles, the sum of all values and that of those
    /// beyond the place of the value-at-risk.
    pub(super) fn summary(&self, found: &Found, sum: f64, tail: f64) -> Summary {
        let [p50, p95, p99, max, value_at_risk] = std::array::from_fn(|n| {
            let Wanted { place, before, .. } = self.wanted[n];
            let mut passed = 0;
            let trailing = found.0[n].iter().position(|count| {
                passed += count;
                passed > before
            });
            trailing.map_or(f64::NAN, |trailing| value(place, trailing))
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

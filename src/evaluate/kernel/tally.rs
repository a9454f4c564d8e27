//! Counts over the samples in lanes: satellites in view, available samples and outages.
//!
//! All are whole numbers, so that they do not depend on how the samples are cut into pieces of time.

use super::super::counts::{LongestOutage, Outages, Views};
use super::fixed::FixedSample;
use super::instructions::Work;
use super::lanes::{LANES, Lanes};
use super::order_statistics::Merge;
use super::propagation::Propagation;
use super::sample::SampleOutcome;
use super::tiles::Tile;
use super::{Evaluating, Kernel, Rechecks};

/// Neighbouring lanes count apart, because most see the same number of satellites and would wait for
/// each other.
const APART: usize = 4;

/// The weight of the samples by number of satellites.
#[derive(Debug, Clone)]
struct ViewLanes(Vec<[u64; APART]>);

impl ViewLanes {
    fn new(most: usize) -> Self {
        Self(vec![[0; APART]; most + 1])
    }

    #[inline(always)]
    fn add(&mut self, visible: u32, weight: u64, lane: usize) {
        self.0[visible as usize][lane % APART] += weight;
    }

    fn merge(&mut self, other: &Self) {
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            for (mine, theirs) in mine.iter_mut().zip(theirs) {
                *mine += theirs;
            }
        }
    }

    fn views(&self) -> Views {
        Views::of(self.0.iter().map(|weights| weights.iter().sum()).collect())
    }
}

/// The outages at the points of a tile, in samples.
#[derive(Debug, Clone)]
struct OutageLanes {
    /// The first sample without outage; the greatest number if there is none yet.
    first_good: Lanes<u32>,
    /// Length of the outage at the last sample.
    now: Lanes<u32>,
    longest: Lanes<u32>,
    number: Lanes<u32>,
    total: Lanes<u32>,
}

impl OutageLanes {
    const NONE: Self = Self {
        first_good: Lanes([u32::MAX; LANES]),
        now: Lanes([0; LANES]),
        longest: Lanes([0; LANES]),
        number: Lanes([0; LANES]),
        total: Lanes([0; LANES]),
    };

    #[inline(always)]
    fn add(&mut self, is_out: &Lanes<u32>, instant: u32) {
        for l in 0..LANES {
            let out = is_out.0[l];
            let now = (self.now.0[l] + 1) * out;
            self.now.0[l] = now;
            self.longest.0[l] = self.longest.0[l].max(now);
            self.number.0[l] += u32::from(now == 1);
            self.total.0[l] += out;
            let good = if out == 0 { instant } else { u32::MAX };
            self.first_good.0[l] = self.first_good.0[l].min(good);
        }
    }

    /// The point in a lane, of `instants` samples.
    fn point(&self, lane: usize, instants: u32) -> Outages {
        Outages {
            number: self.number.0[lane],
            longest: self.longest.0[lane],
            total: self.total.0[lane],
            first: self.first_good.0[lane].min(instants),
            last: self.now.0[lane],
            samples: instants,
        }
    }

    fn set(&mut self, lane: usize, outages: Outages) {
        self.number.0[lane] = outages.number;
        self.longest.0[lane] = outages.longest;
        self.total.0[lane] = outages.total;
        self.first_good.0[lane] = match outages.first {
            all if all == outages.samples => u32::MAX,
            first => first,
        };
        self.now.0[lane] = outages.last;
    }
}

/// The outages of two spans, one after the other.
fn joined(before: Outages, after: Outages) -> Outages {
    let across = before.last + after.first;
    let is_across = before.last > 0 && after.first > 0;
    Outages {
        number: before.number + after.number - u32::from(is_across),
        longest: before.longest.max(after.longest).max(across),
        total: before.total + after.total,
        first: if before.first == before.samples {
            before.samples + after.first
        } else {
            before.first
        },
        last: if after.last == after.samples {
            before.last + after.samples
        } else {
            after.last
        },
        samples: before.samples + after.samples,
    }
}

/// Counts over some instants in a row.
#[derive(Debug, Clone)]
pub(super) struct ViewTally {
    leo: ViewLanes,
    all: ViewLanes,
    /// Weight of the available samples.
    available: Lanes<u64>,
    instants: u32,
    outages: Vec<OutageLanes>,
    pub(super) rechecks: Rechecks,
}

impl ViewTally {
    /// No sample yet, of so many tiles and satellites.
    pub(super) fn new(tiles: usize, leo: usize, gnss: usize) -> Self {
        Self {
            leo: ViewLanes::new(leo),
            all: ViewLanes::new(leo + gnss),
            available: Lanes([0; LANES]),
            instants: 0,
            outages: vec![OutageLanes::NONE; tiles],
            rechecks: Rechecks::default(),
        }
    }

    /// Memory for each tile.
    pub(super) const TILE_BYTES: usize = size_of::<OutageLanes>();

    /// LEO satellites in view, and all.
    pub(super) fn views(&self) -> [Views; 2] {
        [self.leo.views(), self.all.views()]
    }

    /// Weight of the available samples.
    pub(super) fn available(&self) -> u64 {
        self.available.0.iter().sum()
    }

    /// The outages of each point, with its number.
    pub(super) fn outages(&self, tiles: &[Tile]) -> impl Iterator<Item = (usize, Outages)> {
        let of_tile = |(tile, outages): (&Tile, &OutageLanes)| {
            let members = tile.members.iter().enumerate();
            let point = |(lane, &site)| (site as usize, outages.point(lane, self.instants));
            members.map(point).collect::<Vec<_>>()
        };
        tiles.iter().zip(&self.outages).flat_map(of_tile)
    }

    pub(super) fn longest_outage(&self, tiles: &[Tile]) -> LongestOutage {
        LongestOutage::of(self.outages(tiles).map(|(_, outages)| outages))
    }
}

impl Merge for ViewTally {
    /// `other` follows in time.
    fn merged(mut self, other: &Self) -> Self {
        self.leo.merge(&other.leo);
        self.all.merge(&other.all);
        let samples = [self.instants, other.instants];
        self.instants += other.instants;
        for l in 0..LANES {
            self.available.0[l] += other.available.0[l];
        }
        for (mine, theirs) in self.outages.iter_mut().zip(&other.outages) {
            for lane in 0..LANES {
                let point = |lanes: &OutageLanes, n: usize| lanes.point(lane, samples[n]);
                let both = joined(point(mine, 0), point(theirs, 1));
                mine.set(lane, both);
            }
        }
        self.rechecks = self.rechecks.merged(other.rechecks);
        self
    }
}

impl Kernel {
    /// An empty tally of some satellites.
    pub(super) fn tally(&self, propagation: &Propagation<'_>) -> ViewTally {
        let leo = propagation.ephemeris.satellites().len();
        let systems = self.fixed.systems.iter();
        let gnss = systems.map(|system| system.satellites().len()).sum();
        ViewTally::new(self.scene.tiles.tiles.len(), leo, gnss)
    }

    pub(super) fn tally_instant(&self, instant: &Evaluating<'_>, to: &mut ViewTally) {
        self.instructions.run(TallySample {
            tiles: &self.scene.tiles.tiles,
            outcome: instant.outcome,
            fixed: instant.fixed,
            available: self.scene.limits.available.single(),
            to,
        });
    }
}

/// Counts one instant.
struct TallySample<'a> {
    tiles: &'a [Tile],
    outcome: &'a SampleOutcome,
    fixed: FixedSample<'a>,
    /// PDOP up to which a sample is available.
    available: f32,
    to: &'a mut ViewTally,
}

impl Work for TallySample<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let to = self.to;
        let instant = to.instants;
        to.instants += 1;
        let mut available = to.available;
        for (number, tile) in self.tiles.iter().enumerate() {
            let (pdop, leo) = (&self.outcome.pdop[number], &self.outcome.visible[number]);
            let gnss = self.fixed.tile(number).visible;
            let weights = &tile.weights;
            let mut is_out = Lanes([0; LANES]);
            for l in 0..LANES {
                let good = pdop.0[l] <= self.available;
                available.0[l] += if good { weights.whole.0[l] } else { 0 };
                is_out.0[l] = if good { 0 } else { weights.member.0[l] };
            }
            to.outages[number].add(&is_out, instant);
            for l in 0..LANES {
                let (leo, gnss) = (leo.0[l], u32::from(gnss[l]));
                to.leo.add(leo, weights.whole.0[l], l);
                to.all.add(leo + gnss, weights.whole.0[l], l);
            }
        }
        to.available = available;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn outages(is_out: &[bool]) -> Outages {
        let mut lanes = OutageLanes::NONE;
        for (instant, &out) in (0..).zip(is_out) {
            lanes.add(&Lanes([u32::from(out); LANES]), instant);
        }
        lanes.point(3, is_out.len() as u32)
    }

    proptest! {
        /// In lanes, and in two spans, the outages are those of the definition.
        #[test]
        fn outages_of_spans_join(
            is_out in prop::collection::vec(prop::bool::weighted(0.7), 1..12), cut in 0..12_usize,
        ) {
            let expected = Outages::of(is_out.iter().copied());
            prop_assert_eq!(outages(&is_out), expected);
            let (before, after) = is_out.split_at(cut.min(is_out.len()));
            let both = joined(outages(before), outages(after));
            prop_assert_eq!(both, expected);
            let mut lanes = OutageLanes::NONE;
            lanes.set(2, both);
            prop_assert_eq!(lanes.point(2, is_out.len() as u32), expected);
        }
    }
}

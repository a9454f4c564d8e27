//! Counts over the samples in lanes: satellites in view, available samples and outages.
//!
//! All are whole numbers, so that they do not depend on how the samples are cut into pieces of time.

use super::super::counts::{COVERAGE_LEVELS, LongestOutage, Outages, PointViews, Views};
use super::super::histograms::ViewBins;
use super::fixed::FixedSample;
use super::instructions::Work;
use super::lanes::{LANES, Lanes};
use super::order_statistics::Merge;
use super::sample::SampleOutcome;
use super::tiles::Tile;
use super::{Evaluating, Kernel, Rechecks};

/// Instants whose satellites in view are kept one by one.
const RECENT: usize = 32;

/// Instants whose numbers fill one register of any processor, or a few.
const ABREAST: usize = 4;

/// The numbers of some instants one after the other.
#[derive(Debug, Clone, Copy)]
struct Abreast([u8; ABREAST * LANES]);

/// The satellites in view of the points of a tile.
#[derive(Debug, Clone)]
struct ViewLanes {
    counts: ViewCounts,
    /// Satellites of the recent instants together.
    sum: Lanes<u32>,
    least: Lanes<u32>,
    /// The numbers of the recent instants, as bytes that end at the greatest level.
    recent: [Abreast; RECENT / ABREAST],
}

/// The same, counted.
#[derive(Debug, Clone)]
struct ViewCounts {
    sum: Lanes<u64>,
    /// Instants with fewer than 1, 2, … 12 satellites.
    fewer: [Lanes<u32>; COVERAGE_LEVELS],
}

/// As many satellites or more count for every level.
const ENOUGH: u8 = COVERAGE_LEVELS as u8;

impl ViewLanes {
    const NONE: Self = Self {
        counts: ViewCounts {
            sum: Lanes([0; LANES]),
            fewer: [Lanes([0; LANES]); COVERAGE_LEVELS],
        },
        sum: Lanes([0; LANES]),
        least: Lanes([u32::MAX; LANES]),
        recent: [Abreast([ENOUGH; ABREAST * LANES]); RECENT / ABREAST],
    };

    /// Adds an instant after `recent` others that are not yet counted, fewer than [`RECENT`].
    #[inline(always)]
    fn add(&mut self, visible: &Lanes<u32>, recent: usize) {
        let abreast = &mut self.recent[recent / ABREAST % (RECENT / ABREAST)];
        let first = recent % ABREAST * LANES;
        for (l, few) in abreast.0[first..first + LANES].iter_mut().enumerate() {
            let visible = visible.0[l];
            self.sum.0[l] += visible;
            self.least.0[l] = self.least.0[l].min(visible);
            *few = visible.min(ENOUGH.into()) as u8;
        }
    }

    /// Counts the recent instants.
    #[inline(always)]
    fn settle(&mut self) {
        let mut fewest = Abreast([ENOUGH; ABREAST * LANES]);
        for abreast in &self.recent {
            for n in 0..ABREAST * LANES {
                fewest.0[n] = fewest.0[n].min(abreast.0[n]);
            }
        }
        let fewest = fewest.0.into_iter().fold(ENOUGH, u8::min);
        let counts = &mut self.counts;
        for (below, fewer) in (0..).zip(&mut counts.fewer).skip(fewest.into()) {
            let mut instants = Abreast([0; ABREAST * LANES]);
            for abreast in &self.recent {
                for n in 0..ABREAST * LANES {
                    instants.0[n] += u8::from(abreast.0[n] <= below);
                }
            }
            for (l, fewer) in fewer.0.iter_mut().enumerate() {
                for n in 0..ABREAST {
                    *fewer += u32::from(instants.0[n * LANES + l]);
                }
            }
        }
        for (l, sum) in counts.sum.0.iter_mut().enumerate() {
            *sum += u64::from(self.sum.0[l]);
        }
        self.sum = Self::NONE.sum;
        self.recent = Self::NONE.recent;
    }

    /// Adds counts of other instants.
    fn merge(&mut self, other: &Self) {
        let mut other = other.clone();
        self.settle();
        other.settle();
        for l in 0..LANES {
            self.counts.sum.0[l] += other.counts.sum.0[l];
            self.least.0[l] = self.least.0[l].min(other.least.0[l]);
        }
        for (mine, theirs) in self.counts.fewer.iter_mut().zip(&other.counts.fewer) {
            for (mine, theirs) in mine.0.iter_mut().zip(theirs.0) {
                *mine += theirs;
            }
        }
    }

    /// The point in a lane, of `samples` samples that are all counted.
    fn point(&self, lane: usize, samples: u32) -> PointViews {
        PointViews {
            samples,
            sum: self.counts.sum.0[lane],
            fewer: self.counts.fewer.map(|lanes| lanes.0[lane]),
            least: self.least.0[lane],
        }
    }
}

/// The outages at the points of a tile, in samples.
#[derive(Debug, Clone)]
struct OutageLanes {
    /// Length of the outage at the first sample.
    first: Lanes<u32>,
    /// Length of the outage at the last sample.
    now: Lanes<u32>,
    longest: Lanes<u32>,
    number: Lanes<u32>,
    total: Lanes<u32>,
    /// Whether there is an outage at the last sample in some lane.
    is_out: bool,
}

impl OutageLanes {
    const NONE: Self = Self {
        first: Lanes([0; LANES]),
        now: Lanes([0; LANES]),
        longest: Lanes([0; LANES]),
        number: Lanes([0; LANES]),
        total: Lanes([0; LANES]),
        is_out: false,
    };

    /// Adds a sample after `instants` others; 1 marks an outage.
    #[inline(always)]
    fn add(&mut self, out: &Lanes<u32>, instants: u32) {
        let is_out = out.0.iter().fold(0, |all, out| all | out) != 0;
        if is_out || self.is_out {
            self.go_on(out, instants);
        }
        self.is_out = is_out;
    }

    #[inline(always)]
    fn go_on(&mut self, out: &Lanes<u32>, instants: u32) {
        for l in 0..LANES {
            let out = out.0[l];
            let now = (self.now.0[l] + 1) * out;
            self.now.0[l] = now;
            self.longest.0[l] = self.longest.0[l].max(now);
            self.number.0[l] += u32::from(now == 1);
            self.first.0[l] += if self.total.0[l] == instants { out } else { 0 };
            self.total.0[l] += out;
        }
    }

    /// The point in a lane, of `instants` samples.
    fn point(&self, lane: usize, instants: u32) -> Outages {
        Outages {
            number: self.number.0[lane],
            longest: self.longest.0[lane],
            total: self.total.0[lane],
            first: self.first.0[lane],
            last: self.now.0[lane],
            samples: instants,
        }
    }

    fn set(&mut self, lane: usize, outages: Outages) {
        self.number.0[lane] = outages.number;
        self.longest.0[lane] = outages.longest;
        self.total.0[lane] = outages.total;
        self.first.0[lane] = outages.first;
        self.now.0[lane] = outages.last;
        self.is_out = self.now.0.iter().any(|&now| now > 0);
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

/// The counts at the points of a tile.
#[derive(Debug, Clone)]
pub(super) struct TileTally {
    leo: ViewLanes,
    all: ViewLanes,
    outages: OutageLanes,
}

impl TileTally {
    const NONE: Self = Self {
        leo: ViewLanes::NONE,
        all: ViewLanes::NONE,
        outages: OutageLanes::NONE,
    };
}

/// Counts over some instants in a row.
#[derive(Debug, Clone)]
pub(super) struct ViewTally<'a> {
    tiles: &'a [Tile],
    of_tiles: Vec<TileTally>,
    instants: u32,
    /// Of those, the last ones, whose satellites in view are not yet counted.
    recent: usize,
    /// How often so many are in view, where asked for.
    pub(super) bins: Option<[ViewBins; 2]>,
    pub(super) rechecks: Rechecks,
}

impl<'a> ViewTally<'a> {
    /// No sample yet.
    fn new(tiles: &'a [Tile], histograms: bool) -> Self {
        Self {
            tiles,
            of_tiles: vec![TileTally::NONE; tiles.len()],
            instants: 0,
            recent: 0,
            bins: histograms.then(Default::default),
            rechecks: Rechecks::default(),
        }
    }

    /// LEO satellites in view, and all.
    pub(super) fn views(&mut self) -> [Views; 2] {
        self.settle();
        let [mut leo, mut all] = [Views::default(), Views::default()];
        for (tile, tally) in self.tiles.iter().zip(&self.of_tiles) {
            for lane in 0..tile.members.len() {
                let weight = tile.weights.whole.0[lane];
                leo.add_point(&tally.leo.point(lane, self.instants), weight);
                all.add_point(&tally.all.point(lane, self.instants), weight);
            }
        }
        [leo, all]
    }

    /// Counts the satellites in view of the recent instants.
    #[inline(always)]
    fn settle(&mut self) {
        for tally in &mut self.of_tiles {
            tally.leo.settle();
            tally.all.settle();
        }
        self.recent = 0;
    }

    /// Weight of the available samples.
    pub(super) fn available(&self) -> u64 {
        let of_tile = |(tile, tally): (&Tile, &TileTally)| {
            let lanes = tile.weights.whole.0.iter().zip(&tally.outages.total.0);
            let good = lanes.map(|(weight, out)| weight * u64::from(self.instants - out));
            good.sum::<u64>()
        };
        self.tiles.iter().zip(&self.of_tiles).map(of_tile).sum()
    }

    /// The outages of each point.
    fn outages(&self) -> impl Iterator<Item = Outages> {
        let instants = self.instants;
        let of_tile = move |(tile, tally): (&Tile, &TileTally)| {
            let lanes = 0..tile.members.len();
            let point = |lane| tally.outages.point(lane, instants);
            lanes.map(point).collect::<Vec<_>>()
        };
        self.tiles.iter().zip(&self.of_tiles).flat_map(of_tile)
    }

    pub(super) fn longest_outage(&self) -> LongestOutage {
        LongestOutage::of(self.outages())
    }
}

impl Merge for ViewTally<'_> {
    /// `other` follows in time.
    fn merged(mut self, other: &Self) -> Self {
        for (mine, theirs) in self
            .bins
            .iter_mut()
            .flatten()
            .zip(other.bins.iter().flatten())
        {
            mine.merge(theirs);
        }
        let samples = [self.instants, other.instants];
        self.instants += other.instants;
        self.recent = 0;
        for (mine, theirs) in self.of_tiles.iter_mut().zip(&other.of_tiles) {
            mine.leo.merge(&theirs.leo);
            mine.all.merge(&theirs.all);
            for lane in 0..LANES {
                let point = |tally: &TileTally, n: usize| tally.outages.point(lane, samples[n]);
                let both = joined(point(mine, 0), point(theirs, 1));
                mine.outages.set(lane, both);
            }
        }
        self.rechecks = self.rechecks.merged(other.rechecks);
        self
    }
}

impl Kernel {
    /// An empty tally, perhaps with histograms.
    pub(super) fn tally(&self, histograms: bool) -> ViewTally<'_> {
        ViewTally::new(&self.scene.tiles.tiles, histograms)
    }

    /// Adds an instant of which only the values are known: outages, and no satellites in view.
    pub(super) fn tally_values(&self, values: &[Lanes<f32>], to: &mut ViewTally<'_>) {
        let available = self.scene.limits.available.single();
        let instants = to.instants;
        for ((tile, tally), pdop) in to.tiles.iter().zip(&mut to.of_tiles).zip(values) {
            let out = out_of_service(tile, pdop, available);
            tally.outages.add(&out, instants);
        }
        to.instants += 1;
    }

    pub(super) fn tally_instant(&self, instant: &Evaluating<'_>, to: &mut ViewTally<'_>) {
        self.instructions.run(TallySample {
            outcome: instant.outcome,
            fixed: instant.fixed,
            available: self.scene.limits.available.single(),
            to,
        });
    }
}

/// 1 for each point of a tile without service: unsolved, or above the threshold.
#[inline(always)]
fn out_of_service(tile: &Tile, pdop: &Lanes<f32>, available: f32) -> Lanes<u32> {
    let mut out = tile.weights.member;
    for l in 0..LANES {
        out.0[l] &= 1 - u32::from(pdop.0[l] <= available);
    }
    out
}

/// Counts one instant.
struct TallySample<'a, 'b> {
    outcome: &'a SampleOutcome,
    fixed: FixedSample<'a>,
    /// PDOP up to which a sample is available.
    available: f32,
    to: &'a mut ViewTally<'b>,
}

impl Work for TallySample<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let to = self.to;
        let tiles = to.tiles.iter().zip(&mut to.of_tiles).enumerate();
        for (number, (tile, tally)) in tiles {
            let (pdop, leo) = (&self.outcome.pdop[number], &self.outcome.visible[number]);
            let gnss = self.fixed.tile(number);
            let mut all = *leo;
            for l in 0..LANES {
                all.0[l] += u32::from(gnss.visible[l]);
            }
            let out = out_of_service(tile, pdop, self.available);
            tally.outages.add(&out, to.instants);
            tally.leo.add(leo, to.recent);
            tally.all.add(&all, to.recent);
            if let Some(bins) = &mut to.bins {
                for (of, visible) in bins.iter_mut().zip([leo, &all]) {
                    for lane in 0..tile.members.len() {
                        of.add(visible.0[lane], tile.weights.whole.0[lane]);
                    }
                }
            }
        }
        to.instants += 1;
        to.recent += 1;
        if to.recent == RECENT {
            to.settle();
        }
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

    fn view_lanes(visible: &[[u32; LANES]]) -> ViewLanes {
        let mut lanes = ViewLanes::NONE;
        for (instant, visible) in visible.iter().enumerate() {
            lanes.add(&Lanes(*visible), instant % RECENT);
            if instant % RECENT + 1 == RECENT {
                lanes.settle();
            }
        }
        lanes
    }

    proptest! {
        /// Point by point and in two spans, the views are those of the definition: below all levels, across them and above.
        #[test]
        fn views_of_points_are_those_of_samples(
            visible in prop::collection::vec(
                prop::array::uniform16(prop_oneof![3 => 0..20_u32, 1 => 12..400_u32]), 1..100,
            ),
            weights in prop::array::uniform16(1..1_000_000_u64),
            cut in 0..100_usize,
        ) {
            let mut expected = Views::default();
            for visible in &visible {
                let samples = visible.iter().zip(weights);
                samples.for_each(|(&visible, weight)| expected.add(visible, weight));
            }
            let (before, after) = visible.split_at(cut.min(visible.len()));
            let mut lanes = view_lanes(before);
            lanes.merge(&view_lanes(after));
            let mut views = Views::default();
            for (lane, &weight) in weights.iter().enumerate() {
                views.add_point(&lanes.point(lane, visible.len() as u32), weight);
            }
            prop_assert_eq!(views, expected);
        }

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

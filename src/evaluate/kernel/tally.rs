//! Counts over the samples in lanes: satellites in view, available samples and outages.
//!
//! All are whole numbers, so that they do not depend on how the samples are cut into pieces of time.

use super::super::counts::{COVERAGE_LEVELS, LongestOutage, Outages, PointViews, Views};
use super::fixed::FixedSample;
use super::instructions::Work;
use super::lanes::{LANES, Lanes};
use super::order_statistics::Merge;
use super::sample::SampleOutcome;
use super::tiles::Tile;
use super::{Evaluating, Kernel, Rechecks};

/// The most instants that [`ViewLanes`] counts.
const SPAN: u32 = u8::MAX as u32;

/// The satellites in view of the points of a tile over the last instants.
#[derive(Debug, Clone)]
struct ViewLanes {
    /// Satellites of all instants together.
    sum: Lanes<u32>,
    least: Lanes<u32>,
    /// Instants with fewer than 1, 2, … 12 satellites: bytes, all lanes of which fit in one register of any processor.
    fewer: [[u8; LANES]; COVERAGE_LEVELS],
}

impl ViewLanes {
    const NONE: Self = Self {
        sum: Lanes([0; LANES]),
        least: Lanes([u32::MAX; LANES]),
        fewer: [[0; LANES]; COVERAGE_LEVELS],
    };

    #[inline(always)]
    fn add(&mut self, visible: &Lanes<u32>) {
        const LEVELS: u8 = COVERAGE_LEVELS as u8;
        let (mut few, mut any_few) = ([0; LANES], 0);
        for (l, few) in few.iter_mut().enumerate() {
            let visible = visible.0[l];
            self.sum.0[l] += visible;
            self.least.0[l] = self.least.0[l].min(visible);
            *few = visible.min(LEVELS.into()) as u8;
            any_few |= u8::from(*few < LEVELS);
        }
        if any_few == 0 {
            return;
        }
        for (below, fewer) in self.fewer.iter_mut().enumerate() {
            for l in 0..LANES {
                fewer[l] += u8::from(few[l] <= below as u8);
            }
        }
    }

    fn point(&self, lane: usize, samples: u32) -> PointViews {
        PointViews {
            samples,
            sum: self.sum.0[lane],
            fewer: self.fewer.map(|lanes| lanes[lane]),
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
    /// Satellites in view, LEO and all, but for the last `pending` instants.
    views: [Views; 2],
    pending: u32,
    pub(super) rechecks: Rechecks,
}

impl<'a> ViewTally<'a> {
    /// No sample yet.
    fn new(tiles: &'a [Tile]) -> Self {
        Self {
            tiles,
            of_tiles: vec![TileTally::NONE; tiles.len()],
            instants: 0,
            views: [Views::default(), Views::default()],
            pending: 0,
            rechecks: Rechecks::default(),
        }
    }

    /// LEO satellites in view, and all.
    pub(super) fn views(&self) -> [Views; 2] {
        let [mut leo, mut all] = self.views.clone();
        if self.pending > 0 {
            for (tile, tally) in self.tiles.iter().zip(&self.of_tiles) {
                for lane in 0..tile.members.len() {
                    let weight = tile.weights.whole.0[lane];
                    leo.add_point(&tally.leo.point(lane, self.pending), weight);
                    all.add_point(&tally.all.point(lane, self.pending), weight);
                }
            }
        }
        [leo, all]
    }

    fn settle_pending(&mut self) {
        self.views = self.views();
        self.pending = 0;
        for tally in &mut self.of_tiles {
            (tally.leo, tally.all) = (ViewLanes::NONE, ViewLanes::NONE);
        }
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
        self.settle_pending();
        for (mine, theirs) in self.views.iter_mut().zip(other.views()) {
            mine.merge(&theirs);
        }
        let samples = [self.instants, other.instants];
        self.instants += other.instants;
        for (mine, theirs) in self.of_tiles.iter_mut().zip(&other.of_tiles) {
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
    /// An empty tally.
    pub(super) fn tally(&self) -> ViewTally<'_> {
        ViewTally::new(&self.scene.tiles.tiles)
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
        if to.pending == SPAN {
            to.settle_pending();
        }
        let tiles = to.tiles.iter().zip(&mut to.of_tiles).enumerate();
        for (number, (tile, tally)) in tiles {
            let (pdop, leo) = (&self.outcome.pdop[number], &self.outcome.visible[number]);
            let gnss = self.fixed.tile(number).visible;
            let (mut all, mut out) = (*leo, Lanes([0; LANES]));
            for (l, &gnss) in gnss.iter().enumerate() {
                all.0[l] += u32::from(gnss);
                let good = pdop.0[l] <= self.available;
                out.0[l] = if good { 0 } else { tile.weights.member.0[l] };
            }
            tally.outages.add(&out, to.instants);
            tally.leo.add(leo);
            tally.all.add(&all);
        }
        to.instants += 1;
        to.pending += 1;
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
        /// Point by point, the views are those of the definition: below all levels, across them and above.
        #[test]
        fn views_of_points_are_those_of_samples(
            visible in prop::collection::vec(
                prop::array::uniform16(prop_oneof![3 => 0..20_u32, 1 => 12..400_u32]), 1..256,
            ),
            weights in prop::array::uniform16(1..1_000_000_u64),
        ) {
            let (mut lanes, mut expected) = (ViewLanes::NONE, Views::default());
            for visible in &visible {
                lanes.add(&Lanes(*visible));
                let samples = visible.iter().zip(weights);
                samples.for_each(|(&visible, weight)| expected.add(visible, weight));
            }
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

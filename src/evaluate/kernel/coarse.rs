//! Samples for which f32 is too coarse, in f64: a tile as a whole where many of its points are among them, otherwise point by
//! point, so that one costs a sixteenth of a tile. Their sums are put side by side, and solved sixteen at a time.
//!
//! Either way gives the same bits: a satellite that a point does not see adds zeros to its sums.

use super::fixed::FixedSample;
use super::lanes::{LANES, Lanes, Sums};
use super::normal::{FixedTile, Normal, NormalLanes, SharedClock, ZERO};
use super::sample::{Begun, Doubt, Judging, SampleOutcome, TileCandidates, UNSOLVED, doubt};
use super::tiles::Group;
use super::weighting::Weighting;
use super::workspace::Workspace;

/// Points of a tile up to which they are computed one by one.
pub(super) const FEW: u32 = 5;

/// A sample of an instant: the point in a lane of a tile.
#[derive(Debug, Clone, Copy)]
struct CoarsePoint {
    tile: usize,
    lane: usize,
}

/// Up to sixteen samples side by side.
#[derive(Debug, Clone)]
struct Batch {
    slots: [Option<CoarsePoint>; LANES],
    sums: Sums<f64>,
    /// Where there are several LEO clocks, what they leave.
    clocks: NormalLanes<f64>,
    /// The number of the tile if all are of one, each in its lane.
    whole: Option<usize>,
    /// Otherwise the GNSS part of each.
    fixed: GatheredFixed,
    count: usize,
}

impl Batch {
    fn empty() -> Self {
        Self {
            slots: [None; LANES],
            sums: Sums::zero(),
            clocks: NormalLanes::nothing(),
            whole: None,
            fixed: GatheredFixed::NONE,
            count: 0,
        }
    }

    /// The GNSS part of the samples.
    #[inline(always)]
    fn fixed<'a>(&'a self, sample: &FixedSample<'a>) -> FixedTile<'a> {
        match self.whole {
            Some(tile) => sample.tile(tile),
            None => self.fixed.tile(),
        }
    }

    /// Makes room for a sample, and returns its place.
    #[inline(always)]
    fn push(&mut self, slot: CoarsePoint, fixed: &FixedTile<'_>) -> usize {
        let place = self.count % LANES;
        self.fixed.set(place, fixed, slot.lane);
        self.slots[place] = Some(slot);
        self.count += 1;
        place
    }
}

/// The samples of some tiles; memory is kept from one use to the next.
#[derive(Debug, Clone, Default)]
pub(super) struct Batches {
    batches: Vec<Batch>,
    used: usize,
    /// The number of the batch that has room, if one has.
    open: Option<usize>,
}

impl Batches {
    fn clear(&mut self) {
        (self.used, self.open) = (0, None);
    }

    fn all(&self) -> &[Batch] {
        &self.batches[..self.used]
    }

    fn begin(&mut self) -> usize {
        let number = self.used;
        self.used += 1;
        match self.batches.get_mut(number) {
            Some(batch) => {
                batch.slots = [None; LANES];
                batch.sums = Sums::zero();
                batch.clocks = NormalLanes::nothing();
                batch.whole = None;
                batch.count = 0;
            }
            None => self.batches.push(Batch::empty()),
        }
        number
    }

    /// One with room for a sample.
    fn with_room(&mut self) -> &mut Batch {
        let is_full = |number: &usize| self.batches[*number].count == LANES;
        let number = match self.open.filter(|number| !is_full(number)) {
            Some(number) => number,
            None => self.begin(),
        };
        self.open = Some(number);
        &mut self.batches[number]
    }

    /// One for some points of a tile, whose sums are put in their lanes.
    fn of_tile(&mut self, tile: usize, wanted: &Lanes<u32>) -> &mut Batch {
        let number = self.begin();
        let batch = &mut self.batches[number];
        batch.whole = Some(tile);
        for (lane, slot) in batch.slots.iter_mut().enumerate() {
            *slot = (wanted.0[lane] != 0).then_some(CoarsePoint { tile, lane });
        }
        batch
    }
}

impl Judging<'_> {
    /// Sums in f64 at the points for which f32 is too coarse. Where a decision in f32 is in doubt, another path computes the
    /// sample.
    #[inline(always)]
    pub(super) fn sum_again<W: Weighting>(&self, coarse: &Lanes<u32>, out: &mut SampleOutcome) {
        let (number, candidates) = (self.number, self.candidates);
        if coarse.0.iter().sum::<u32>() > FEW {
            let batch = out.coarse.of_tile(number, coarse);
            if W::SEVERAL_CLOCKS {
                let mut seen = out.seen.as_slice();
                for clock in candidates.by_clock() {
                    let own = self.double_sums::<W>(clock, seen);
                    batch.clocks.add_clock::<W>(&own);
                    seen = seen.get(clock.count()..).unwrap_or_default();
                }
            } else {
                batch.sums = self.double_sums::<W>(candidates, &out.seen);
            }
            return;
        }
        for lane in (0..LANES).filter(|&lane| coarse.0[lane] != 0) {
            self.sum_point::<W>(lane, out);
        }
    }

    /// The sums over satellites, with the points that see each of them where there is a skyline.
    #[inline(always)]
    fn double_sums<W: Weighting>(
        &self,
        satellites: TileCandidates<'_>,
        seen: &[Lanes<u32>],
    ) -> Sums<f64> {
        match &self.scene.tiles.tiles[self.number].sky {
            None => satellites.double_sums::<W>(self.scene, self.number, self.positions),
            Some(_) => satellites.double_sums_of_seen::<W>(self, seen),
        }
    }

    /// The same at one of them.
    #[inline(always)]
    fn sum_point<W: Weighting>(&self, lane: usize, out: &mut SampleOutcome) {
        let tile = self.number;
        let batch = out.coarse.with_room();
        let place = batch.push(CoarsePoint { tile, lane }, self.fixed);
        if !W::SEVERAL_CLOCKS {
            let to = (place, &mut batch.sums);
            self.add_point::<W>(self.candidates, &out.seen, lane, to);
            return;
        }
        let mut seen = out.seen.as_slice();
        for clock in self.candidates.by_clock() {
            self.add_point::<W>(clock, seen, lane, (place, &mut batch.sums));
            batch.clocks.add_clock_at::<W>(&batch.sums, place);
            batch.sums.clear_at(place);
            seen = seen.get(clock.count()..).unwrap_or_default();
        }
    }

    /// Adds satellites as the point in a lane sees them, in some place of the sums.
    #[inline(always)]
    fn add_point<W: Weighting>(
        &self,
        satellites: TileCandidates<'_>,
        seen: &[Lanes<u32>],
        lane: usize,
        (place, sums): (usize, &mut Sums<f64>),
    ) {
        let (scene, points) = (self.scene, &self.scene.tiles.tiles[self.number]);
        let satellites = satellites.satellites();
        if points.sky.is_none() {
            for n in satellites {
                let satellite = self.positions.at(n);
                let (line, seen, _) = points.double.line(satellite, &scene.double, lane);
                sums.add_line::<W>(&line, seen, seen, place);
            }
            return;
        }
        for (n, seen) in satellites.zip(seen) {
            if seen.0[lane] != 0 {
                let satellite = self.positions.at(n);
                let (line, ..) = points.double.line(satellite, &scene.double, lane);
                sums.add_line::<W>(&line, true, true, place);
            }
        }
    }
}

impl Begun<'_> {
    /// Solves in f64 what is left of the tiles of the selected group.
    #[inline(always)]
    pub(super) fn end_group<W: Weighting>(
        &self,
        group: &Group,
        fixed: &FixedSample<'_>,
        work: &Workspace,
        out: &mut SampleOutcome,
    ) {
        let limits = &self.scene.limits;
        let mut clocks = limits.clocks;
        if W::SEVERAL_CLOCKS {
            clocks += work.clock_count() - 1;
        }
        let mut coarse = std::mem::take(&mut out.coarse);
        for batch in coarse.all() {
            let mut system = NormalLanes::new::<W>(&batch.sums, &batch.fixed(fixed));
            if W::SEVERAL_CLOCKS {
                system += &batch.clocks;
            }
            let double = system.pdop(clocks);
            for (place, slot) in batch.slots.iter().enumerate() {
                let Some(CoarsePoint { tile, lane }) = *slot else {
                    continue;
                };
                let pdop = double.0[place];
                let satellites = system.surplus.0[place] + clocks;
                if pdop < f64::INFINITY && limits.decides(pdop, satellites) {
                    let solved = pdop <= limits.cap;
                    out.pdop[tile].0[lane] = if solved {
                        limits.available.stored(pdop)
                    } else {
                        UNSOLVED
                    };
                } else {
                    let mut undecided = Lanes([0; LANES]);
                    undecided.0[lane] = 1;
                    let candidates = work.candidates(tile, group);
                    doubt(tile, Doubt::Geometry, &undecided, candidates, out);
                }
                out.doubled += 1;
            }
        }
        coarse.clear();
        out.coarse = coarse;
    }
}

/// The GNSS part of samples of several tiles.
#[derive(Debug, Clone)]
struct GatheredFixed {
    normal: Normal,
    remainder: Normal,
    surplus: [u16; LANES],
    shared: SharedClock,
    /// Whether GNSS satellites share their clock with the design.
    is_shared: bool,
}

impl GatheredFixed {
    const NONE: Self = Self {
        normal: [ZERO; 6],
        remainder: [ZERO; 6],
        surplus: [0; LANES],
        shared: SharedClock::NONE,
        is_shared: false,
    };

    #[inline(always)]
    fn set(&mut self, place: usize, from: &FixedTile<'_>, lane: usize) {
        for element in 0..6 {
            self.normal[element].0[place] = from.normal[element].0[lane];
            self.remainder[element].0[place] = from.remainder[element].0[lane];
        }
        self.surplus[place] = from.surplus[lane];
        self.is_shared = from.shared.is_some();
        if let Some(shared) = from.shared {
            self.shared.set(place, shared, lane);
        }
    }

    #[inline(always)]
    fn tile(&self) -> FixedTile<'_> {
        FixedTile {
            normal: &self.normal,
            remainder: &self.remainder,
            surplus: &self.surplus,
            shared: self.is_shared.then_some(&self.shared),
            ..FixedTile::NONE
        }
    }
}

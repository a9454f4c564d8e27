//! All dilutions of precision, in f64 lanes.
//!
//! They need the mean line of sight of each clock, which the metrics do not, and are computed where they are asked for: those of
//! the GNSS once, if they fit in memory. The verdict of a sample and its PDOP are those of the metrics; the inverse of the
//! normal matrix is that by minors, which is accurate for PDOP up to [`LANES_BELOW`]. Beyond it, and where the lanes are in
//! doubt, [`DopFamily`] is computed from the sums of the plain path.

use super::super::dops::{CLOCKS_FROM, groups};
use super::super::{Setup, fixed, leo};
use super::fixed::{Fixed, FixedSample, SampleInstant};
use super::instructions::Work;
use super::lanes::{LANES, Lanes, Sums};
use super::normal::{NormalLanes, SharedClock, at};
use super::order_statistics::{Counts, Found, Places, RankSearch};
use super::propagation::Propagation;
use super::sample::{SampleContext, SampleOutcome, TileCandidates, UNSOLVED};
use super::tiles::Tile;
use super::weighting::{SeveralClocks, SineWeights, UnitWeights, Weighting};
use super::workspace::Workspace;
use super::{Evaluating, Kernel, summed};
use crate::dop::{DopFamily, ObservationWeights};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::stats::Summary;

/// PDOP up to which the inverse by minors has ten digits.
const LANES_BELOW: f32 = 50.0;

/// Places of the dilutions: the clocks follow, and PDOP is that of the metrics.
const GDOP: usize = 0;
const HDOP: usize = 1;
const VDOP: usize = 2;

/// The dilutions of one instant, tile by tile; [`UNSOLVED`] if there is none.
#[derive(Debug, Clone)]
struct DilutionRows(Vec<Vec<Lanes<f32>>>);

impl DilutionRows {
    fn new(clocks: usize, tiles: usize) -> Self {
        Self(vec![
            vec![Lanes([UNSOLVED; LANES]); tiles];
            CLOCKS_FROM + clocks
        ])
    }

    fn set(&mut self, tile: usize, lane: usize, family: Option<&DopFamily>) {
        for row in &mut self.0 {
            row[tile].0[lane] = UNSOLVED;
        }
        let Some(family) = family else { return };
        let position = [family.gdop, family.hdop, family.vdop];
        let clocks = family.tdop.iter().map(|tdop| tdop.unwrap_or(f64::INFINITY));
        for (row, value) in self.0.iter_mut().zip(position.into_iter().chain(clocks)) {
            row[tile].0[lane] = value as f32;
        }
    }
}

/// Computes the dilutions of an instant.
struct Dilution<'a> {
    setup: &'a Setup,
    scene: &'a SampleContext,
    fixed: &'a Fixed,
    /// The clocks of the GNSS at all instants, or none.
    kept: &'a [SharedClock],
    leo: &'a Ephemeris,
    /// How many clocks the LEO satellites have.
    leo_clocks: usize,
}

impl Dilution<'_> {
    /// The dilutions before the LEO clocks, which have the last place together.
    fn places(&self) -> usize {
        let clocks = self.scene.limits.clocks as usize;
        CLOCKS_FROM + clocks
    }

    /// Room for an instant.
    fn rows(&self) -> DilutionRows {
        let clocks = self.scene.limits.clocks as usize + self.leo_clocks - 1;
        DilutionRows::new(clocks, self.scene.tiles.tiles.len())
    }

    fn compute(
        &self,
        evaluating: &mut Evaluating<'_>,
        rows: &mut DilutionRows,
    ) -> Result<(), EphemerisError> {
        let (tiles, mut made) = (&self.scene.tiles, Vec::new());
        let count = self.fixed.clock_count() * tiles.tiles.len();
        let clocks = if self.kept.is_empty() {
            self.fixed.clocks_at(tiles, evaluating.instant, &mut made)?;
            &made
        } else {
            let first = evaluating.instant.number * count;
            &self.kept[first..first + count]
        };
        self.fixed.instructions.run(Dilute {
            scene: self.scene,
            fixed: evaluating.fixed,
            clocks,
            clock_count: self.fixed.clock_count(),
            leo_clocks: self.leo_clocks,
            work: evaluating.work,
            outcome: evaluating.outcome,
            rows,
        });
        let rest = self.left_by_lanes(evaluating.outcome);
        if rest.is_empty() {
            return Ok(());
        }
        let (elapsed_s, rotation) = (evaluating.instant.elapsed_s, evaluating.instant.rotation);
        let mut clocks = Vec::new();
        leo::positions(self.setup, self.leo, elapsed_s, rotation, &mut clocks)?;
        let gnss = fixed::positions(&self.fixed.systems, elapsed_s, rotation)?;
        for (tile, lane) in rest {
            let site = &self.setup.sites[self.scene.tiles.tiles[tile].members[lane] as usize];
            let groups = groups(self.setup, site, &clocks, &gnss);
            let family = DopFamily::of(&groups, &site.local, self.setup.pdop_cap);
            rows.set(tile, lane, family.as_ref());
        }
        Ok(())
    }

    /// The slots with a large PDOP or in doubt.
    fn left_by_lanes(&self, outcome: &SampleOutcome) -> Vec<(usize, usize)> {
        let mut rest: Vec<_> = outcome.doubts.iter().map(|x| (x.tile, x.lane)).collect();
        for (number, pdop) in outcome.pdop.iter().enumerate() {
            let is_large = |lane: &usize| (LANES_BELOW..UNSOLVED).contains(&pdop.0[*lane]);
            rest.extend((0..LANES).filter(is_large).map(|lane| (number, lane)));
        }
        rest
    }
}

impl Kernel {
    /// Statistics of all dilutions but PDOP: GDOP, HDOP, VDOP and the TDOP of each clock.
    pub(in super::super) fn dops(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<Vec<Option<Summary>>, EphemerisError> {
        let propagation = &self.propagation(ephemeris);
        let dilution = Dilution {
            setup: &self.setup,
            scene: &self.scene,
            fixed: &self.fixed,
            kept: self.kept_clocks()?,
            leo: ephemeris,
            leo_clocks: leo::clock_count(&self.setup, ephemeris),
        };
        if self.scene.tiles.slots() * self.setup.grid.len() <= self.kept_values {
            self.dops_keeping(propagation, &dilution)
        } else {
            self.dops_streaming(propagation, &dilution)
        }
    }

    /// The clocks of the GNSS at all instants; none if they do not fit in memory.
    fn kept_clocks(&self) -> Result<&[SharedClock], EphemerisError> {
        let make = || {
            let tiles = &self.scene.tiles;
            let count = self.fixed.clock_count() * tiles.tiles.len() * self.setup.grid.len();
            let mut clocks = Vec::new();
            if count * size_of::<SharedClock>() <= self.kept_bytes {
                clocks.reserve_exact(count);
                let samples = self.setup.grid.iter().zip(self.rotations.iter());
                for (number, (elapsed_s, &rotation)) in samples.enumerate() {
                    let instant = SampleInstant {
                        number,
                        elapsed_s,
                        rotation,
                    };
                    self.fixed.clocks_at(tiles, instant, &mut clocks)?;
                }
            }
            Ok(clocks)
        };
        let clocks = self.clocks.get_or_init(make).as_ref();
        clocks.map(Vec::as_slice).map_err(Clone::clone)
    }

    fn dilution_places(&self, leo_clocks: usize) -> Places {
        Places::new(largest_dilution(&self.setup, leo_clocks))
    }

    /// One pass over the samples and two over the stored values.
    fn dops_keeping(
        &self,
        propagation: &Propagation<'_>,
        dilution: &Dilution<'_>,
    ) -> Result<Vec<Option<Summary>>, EphemerisError> {
        let mut rows = dilution.rows();
        let mut kept = vec![Vec::new(); dilution.places()];
        let last = kept.len() - 1;
        let samples = 0..self.setup.grid.len();
        self.run(propagation, samples, self.scene.limits, |instant| {
            dilution.compute(instant, &mut rows)?;
            for (n, row) in rows.0.iter().enumerate() {
                kept[n.min(last)].extend_from_slice(row);
            }
            Ok(())
        })?;
        let places = self.dilution_places(dilution.leo_clocks);
        let summary = |values: &Vec<Lanes<f32>>| {
            let (mut counts, mut found) = (Counts::new(places), Found::new());
            let sum = self.count(values, &mut counts);
            let search = RankSearch::new(&counts, self.setup.metrics.cvar_level)?;
            let tail = self.find(values, &search, &mut found);
            Some(search.summary(&found, sum, tail))
        };
        Ok(kept.iter().map(summary).collect())
    }

    /// Two passes over the samples, each on all threads; only counts are stored.
    fn dops_streaming(
        &self,
        propagation: &Propagation<'_>,
        dilution: &Dilution<'_>,
    ) -> Result<Vec<Option<Summary>>, EphemerisError> {
        let chunks = self.chunks(self.setup.grid.len());
        let places = self.dilution_places(dilution.leo_clocks);
        let level = self.setup.metrics.cvar_level;
        let channels = dilution.places();
        let last = channels - 1;
        let (counts, sums) = self.pass(
            propagation,
            &chunks,
            || vec![Counts::new(places); channels],
            |instant, counts, sums| {
                let mut rows = dilution.rows();
                dilution.compute(instant, &mut rows)?;
                for (n, row) in rows.0.iter().enumerate() {
                    let n = n.min(last);
                    sums[n] += self.count(row, &mut counts[n]);
                }
                Ok(())
            },
            channels,
        )?;
        let search = |counts| RankSearch::new(counts, level);
        let searches: Vec<_> = counts.iter().map(search).collect();
        let (found, tails) = self.pass(
            propagation,
            &chunks,
            || vec![Found::new(); channels],
            |instant, found, tails| {
                let mut rows = dilution.rows();
                dilution.compute(instant, &mut rows)?;
                for (n, row) in rows.0.iter().enumerate() {
                    let n = n.min(last);
                    if let Some(search) = &searches[n] {
                        tails[n] += self.find(row, search, &mut found[n]);
                    }
                }
                Ok(())
            },
            channels,
        )?;
        let summary = |(n, search): (usize, &Option<RankSearch>)| {
            let search = search.as_ref()?;
            Some(search.summary(&found[n], summed(&sums, n), summed(&tails, n)))
        };
        Ok(searches.iter().enumerate().map(summary).collect())
    }
}

/// Upper limit on every dilution of a solved sample: the variance of a clock is at most 1 + PDOP² for unit weights.
/// For others there is none, because a satellite near the horizon has next to no weight.
pub(super) fn largest_dilution(setup: &Setup, leo_clocks: usize) -> f64 {
    let cap2 = setup.pdop_cap * setup.pdop_cap;
    let clocks = (setup.clock_states() + leo_clocks - 1) as f64;
    match setup.observation_weights {
        ObservationWeights::Unit => (cap2 + clocks * (1.0 + cap2)).sqrt() * 1.001,
        ObservationWeights::SineElevation => f64::from(f32::MAX),
    }
}

/// The dilutions at all points of one instant, after its evaluation.
struct Dilute<'a> {
    scene: &'a SampleContext,
    fixed: FixedSample<'a>,
    /// The clocks of the GNSS, tile by tile, and how many a tile has.
    clocks: &'a [SharedClock],
    clock_count: usize,
    leo_clocks: usize,
    work: &'a mut Workspace,
    outcome: &'a SampleOutcome,
    rows: &'a mut DilutionRows,
}

impl Work for Dilute<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        match (self.scene.weights, self.work.has_several_clocks()) {
            (ObservationWeights::Unit, false) => self.dilute::<UnitWeights>(),
            (ObservationWeights::SineElevation, false) => self.dilute::<SineWeights>(),
            (ObservationWeights::Unit, true) => self.dilute::<SeveralClocks<UnitWeights>>(),
            (ObservationWeights::SineElevation, true) => {
                self.dilute::<SeveralClocks<SineWeights>>();
            }
        }
    }
}

impl Dilute<'_> {
    #[inline(always)]
    fn dilute<W: Weighting>(self) {
        let tiles = &self.scene.tiles.tiles;
        let mut clocks = Vec::with_capacity(self.clock_count + self.leo_clocks);
        for group in &self.scene.tiles.groups {
            self.work.select(self.scene, group);
            for number in group.tiles.clone() {
                let candidates = self.work.candidates(number, group);
                let sums = |satellites: TileCandidates<'_>| {
                    satellites.double_sums::<W>(self.scene, number, &self.work.positions)
                };
                let fixed = self.fixed.tile(number);
                clocks.clear();
                let of_tile = number * self.clock_count..(number + 1) * self.clock_count;
                for clock in &self.clocks[of_tile] {
                    clocks.push(ClockLanes::of_system(clock));
                }
                let normal = if W::SEVERAL_CLOCKS {
                    let first = clocks.len();
                    clocks.resize_with(first + self.leo_clocks, ClockLanes::unseen);
                    let mut normal = NormalLanes::of_fixed(&fixed);
                    for clock in candidates.by_clock() {
                        let leo = sums(clock);
                        clocks[first + clock.clock()] = ClockLanes::of_design::<W>(&leo, None);
                        normal.add_clock::<W>(&leo);
                    }
                    normal
                } else {
                    let leo = sums(candidates);
                    clocks.push(ClockLanes::of_design::<W>(&leo, fixed.shared));
                    NormalLanes::new::<W>(&leo, &fixed)
                };
                let covariance = CofactorLanes::new(&normal.matrix);
                let pdop = &self.outcome.pdop[number];
                dilute(
                    &tiles[number],
                    &covariance,
                    &clocks,
                    (pdop, number),
                    self.rows,
                );
            }
        }
    }
}

/// A clock at the points of a tile.
struct ClockLanes {
    /// Mean line of sight of its satellites.
    mean: [Lanes<f64>; 3],
    /// Their weight; 0 without any.
    weight: Lanes<f64>,
}

impl ClockLanes {
    #[inline(always)]
    fn unseen() -> Self {
        Self {
            mean: [ZERO; 3],
            weight: ZERO,
        }
    }

    #[inline(always)]
    fn of_system(clock: &SharedClock) -> Self {
        let mut lanes = Self::unseen();
        for l in 0..LANES {
            for (axis, mean) in lanes.mean.iter_mut().enumerate() {
                mean.0[l] = clock.mean(axis, l);
            }
            lanes.weight.0[l] = clock.weight(l);
        }
        lanes
    }

    /// That of the design, perhaps shared with the GNSS.
    #[inline(always)]
    fn of_design<W: Weighting>(leo: &Sums<f64>, shared: Option<&SharedClock>) -> Self {
        let mut lanes = match shared {
            Some(shared) => Self::of_system(shared),
            None => Self::unseen(),
        };
        for l in 0..LANES {
            let theirs = lanes.weight.0[l];
            let all = theirs + leo.weight::<W>(l);
            let scale = 1.0 / if all > 0.0 { all } else { 1.0 };
            for (mean, sum) in lanes.mean.iter_mut().zip([&leo.x, &leo.y, &leo.z]) {
                mean.0[l] = (sum.0[l] + mean.0[l] * theirs) * scale;
            }
            lanes.weight.0[l] = all;
        }
        lanes
    }
}

/// The dilutions at the points of a tile from the inverse of the normal matrix and each clock.
#[inline(always)]
fn dilute(
    tile: &Tile,
    covariance: &CofactorLanes,
    clocks: &[ClockLanes],
    (pdop, number): (&Lanes<f32>, usize),
    rows: &mut DilutionRows,
) {
    let up = &tile.double.up;
    let (mut horizontal2, mut vertical2, mut all2) = (ZERO, ZERO, ZERO);
    for l in 0..LANES {
        let vertical = covariance.form([up[0].0[l], up[1].0[l], up[2].0[l]], l);
        let position = covariance.trace(l);
        vertical2.0[l] = vertical;
        horizontal2.0[l] = position - vertical;
        all2.0[l] = position;
    }
    for (place, clock) in clocks.iter().enumerate() {
        let mut clock2 = ZERO;
        let [x, y, z] = &clock.mean;
        for l in 0..LANES {
            let weight = clock.weight.0[l];
            let is_seen = weight > 0.0;
            let own = 1.0 / if is_seen { weight } else { 1.0 };
            let variance = own + covariance.form([x.0[l], y.0[l], z.0[l]], l);
            all2.0[l] += if is_seen { variance } else { 0.0 };
            clock2.0[l] = if is_seen { variance } else { f64::INFINITY };
        }
        rows.0[CLOCKS_FROM + place][number] = roots(&clock2, pdop);
    }
    rows.0[GDOP][number] = roots(&all2, pdop);
    rows.0[HDOP][number] = roots(&horizontal2, pdop);
    rows.0[VDOP][number] = roots(&vertical2, pdop);
}

const ZERO: Lanes<f64> = Lanes([0.0; LANES]);

/// The roots, where the sample is solved.
#[inline(always)]
fn roots(squares: &Lanes<f64>, pdop: &Lanes<f32>) -> Lanes<f32> {
    let mut roots = Lanes([UNSOLVED; LANES]);
    for l in 0..LANES {
        let root = squares.0[l].sqrt() as f32;
        roots.0[l] = if pdop.0[l] < UNSOLVED { root } else { UNSOLVED };
    }
    roots
}

/// The inverse of the normal matrix: (x, x), (y, y), (z, z), (x, y), (x, z), (y, z).
struct CofactorLanes([Lanes<f64>; 6]);

impl CofactorLanes {
    #[inline(always)]
    fn new(normal: &[Lanes<f64>; 6]) -> Self {
        let mut covariance = [ZERO; 6];
        for l in 0..LANES {
            let [xx, yy, zz, xy, xz, yz] = at(normal, l);
            let minor_xx = yy * zz - yz * yz;
            let minor_xy = yz * xz - xy * zz;
            let minor_xz = xy * yz - yy * xz;
            let scale = 1.0 / (xx * minor_xx + xy * minor_xy + xz * minor_xz);
            covariance[0].0[l] = minor_xx * scale;
            covariance[1].0[l] = (xx * zz - xz * xz) * scale;
            covariance[2].0[l] = (xx * yy - xy * xy) * scale;
            covariance[3].0[l] = minor_xy * scale;
            covariance[4].0[l] = minor_xz * scale;
            covariance[5].0[l] = (xy * xz - xx * yz) * scale;
        }
        Self(covariance)
    }

    #[inline(always)]
    fn trace(&self, l: usize) -> f64 {
        self.0[0].0[l] + self.0[1].0[l] + self.0[2].0[l]
    }

    /// vᵀ Q v.
    #[inline(always)]
    fn form(&self, [x, y, z]: [f64; 3], l: usize) -> f64 {
        let [xx, yy, zz, xy, xz, yz] = at(&self.0, l);
        xx * x * x + yy * y * y + zz * z * z + 2.0 * (xy * x * y + xz * x * z + yz * y * z)
    }
}

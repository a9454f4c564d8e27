//! The fast path of the evaluator. It gives the same results as [`super::plain`], as a property test
//! checks.
//!
//! # What is summed
//!
//! A group of n visible satellites that share a clock contributes Σ v vᵀ - (Σ v)(Σ v)ᵀ / n to the
//! normal matrix of the position ([M-24](crate::models#m-24)). So nine sums and a count over the
//! visible LEO satellites are all that a sample needs: Σ v vᵀ (five numbers: the sixth follows from
//! tr Σ v vᵀ = n, but f64 sums it too), Σ v and n. The GNSS sums do not change between designs and
//! are computed once ([`fixed`]). In f32, PDOP² is the sum of the principal minors over the
//! determinant; in f64, it comes from the factor of the plain path. Where the LEO satellites have several clocks, the sums are
//! made clock by clock ([`clocks`]).
//!
//! # Order of work
//!
//! Instant by instant: positions of all satellites ([`propagation`]); for each group of tiles of
//! ground points the satellites that it may see ([`tiles`], [`candidates`]); for each tile of sixteen
//! points ([`lanes`]) the loop over those that the tile may see, with the ten sums in registers. Work
//! is proportional to the number of visible pairs, of which it tests about twice as many, and not to
//! points times satellites.
//!
//! # Where f32 is not enough
//!
//! The lanes work in f32, which is accurate to about 1e-7 if the geometry is good. Two things are
//! recomputed ([`sample`]):
//!
//! - a decision so close to the mask that rounding might change it is repeated with the positions
//!   and the comparison of the plain path ([`settle`]), so visible satellites are counted
//!   exactly;
//! - PDOP above a limit or close to a threshold is recomputed in f64 lanes, and so are the few values
//!   around each order statistic ([`refine`]).
//!
//! Where rounding could turn even a decision of the f64 lanes, that the geometry is not singular or
//! that PDOP is within a threshold, the sums of the plain path decide, so that both paths call the
//! same samples solved. All three are counted in [`Rechecks`].
//!
//! # Statistics
//!
//! Values are never sorted, and beyond a certain number not even stored ([`order_statistics`]).

mod candidates;
mod clocks;
mod coarse;
mod dilutions;
mod fixed;
mod instructions;
mod lanes;
mod limits;
mod losses;
mod memory;
mod metres;
mod normal;
mod order_statistics;
mod probe;
mod propagation;
mod refine;
mod sample;
mod settle;
mod skylines;
mod tally;
mod tiled;
mod tiles;
mod verdict;
mod weighting;
mod windows;
mod workspace;

pub(super) use fixed::at_most_u16;
pub use instructions::InstructionSet;
pub(super) use losses::{
    ChangedSample, DoubtAbout, LossDoubt, LossDoubts, LossTally, SampleLosses, WholeSample,
};
pub(super) use memory::{dops_bytes, memory_bytes, memory_of_tile_bytes};
pub(super) use metres::RangeNormal;
pub(super) use order_statistics::quantile_rank;
pub use probe::{SampleTile, SampleTiles};
pub(super) use windows::WindowPdop;

use super::Setup;
use super::counts::Threshold;
use super::metrics::Evaluated;
use super::series::Instant;
use super::weights::WholeWeights;
use crate::dop::ObservationWeights;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::stats::Summary;
use clocks::ClockBlock;
use fixed::{Fixed, FixedSample, FixedTiles, SampleInstant};
use lanes::{Lanes, MaskTerms};
use limits::{Limits, SingleLimits};
use memory::Keep;
use normal::SharedClock;
use order_statistics::{Count, Counts, Find, Found, Merge, Places, RankSearch};
use propagation::Propagation;
use rayon::prelude::*;
use sample::{Doubt, Sample, SampleContext, SampleOutcome, UNSOLVED};
use settle::Settling;
use std::ops::Range;
use std::sync::{Arc, OnceLock};
use tally::ViewTally;
use tiles::Tiles;
use weighting::{SineWeights, UnitWeights};
use workspace::Workspace;

/// Values of PDOP computed in one piece of work.
const CHUNK_VALUES: usize = 1 << 18;

/// Samples recomputed in f64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Rechecks {
    /// A satellite was too close to the mask.
    pub near_mask: u64,
    /// PDOP was large or close to a threshold.
    pub large_pdop: u64,
    /// Of those, the ones that even the f64 of the lanes does not decide: PDOP within rounding of a
    /// threshold, or a geometry close to a singular one.
    pub near_limit: u64,
}

impl Rechecks {
    fn merged(self, other: Self) -> Self {
        Self {
            near_mask: self.near_mask + other.near_mask,
            large_pdop: self.large_pdop + other.large_pdop,
            near_limit: self.near_limit + other.near_limit,
        }
    }
}

/// The part of the kernel that is the same for all designs.
pub(super) struct Kernel {
    setup: Arc<Setup>,
    rotations: Arc<[EarthRotation]>,
    scene: SampleContext,
    fixed: Fixed,
    instructions: InstructionSet,
    places: Places,
    kept_values: usize,
    kept_bytes: usize,
    /// The clocks of the GNSS at all instants, once dilutions are asked for.
    clocks: OnceLock<Result<Vec<SharedClock>, EphemerisError>>,
    /// Weight of all samples.
    total: u64,
}

/// The sums of each chunk, in order.
type TilePartials = Vec<(Rechecks, Vec<f64>)>;

/// A sum over all chunks. They stay in order, so it does not depend on the number of threads.
fn summed(parts: &TilePartials, number: usize) -> f64 {
    parts.iter().map(|(_, sums)| sums[number]).sum()
}

/// One instant that is evaluated.
struct Evaluating<'a> {
    instant: SampleInstant,
    work: &'a mut Workspace,
    outcome: &'a SampleOutcome,
    fixed: FixedSample<'a>,
}

impl Kernel {
    pub(super) fn new(
        setup: Arc<Setup>,
        weights: &WholeWeights,
        rotations: Arc<[EarthRotation]>,
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        Self::keeping_at_most(Keep::default(), setup, weights, rotations, instructions)
    }

    fn keeping_at_most(
        keep: Keep,
        setup: Arc<Setup>,
        weights: &WholeWeights,
        rotations: Arc<[EarthRotation]>,
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        let tiles = Tiles::new(&setup.sites, weights, setup.mask, setup.gnss_mask);
        let fixed = Fixed::new(&setup, &tiles, &rotations, instructions, keep.fixed_bytes)?;
        let scene = SampleContext {
            tiles,
            single: MaskTerms::new(setup.mask),
            double: MaskTerms::new(setup.mask),
            mask: setup.mask,
            weights: setup.observation_weights,
            limits: Limits {
                single: match setup.observation_weights {
                    ObservationWeights::Unit => SingleLimits::new::<UnitWeights>(setup.pdop_cap),
                    ObservationWeights::SineElevation => {
                        SingleLimits::new::<SineWeights>(setup.pdop_cap)
                    }
                },
                cap: setup.pdop_cap,
                available: Threshold(setup.metrics.availability_pdop),
                clocks: setup.clock_states() as u32,
            },
        };
        Ok(Self {
            scene,
            fixed,
            instructions,
            places: Places::new(setup.pdop_cap),
            setup,
            rotations,
            kept_values: keep.values,
            kept_bytes: keep.fixed_bytes,
            clocks: OnceLock::new(),
            total: weights.total(),
        })
    }

    /// How satellites are propagated, and by which clocks they are observed.
    fn propagation<'a>(&self, ephemeris: &'a Ephemeris) -> Propagation<'a> {
        let propagation = Propagation::new(ephemeris);
        if self.setup.has_several_leo_clocks(ephemeris) {
            propagation.with_clocks(ClockBlock::of(ephemeris.parts()))
        } else {
            propagation
        }
    }

    /// Evaluates satellites, with histograms of those in view where asked for.
    pub(super) fn evaluate(
        &self,
        ephemeris: &Ephemeris,
        histograms: bool,
    ) -> Result<(Evaluated, Rechecks), EphemerisError> {
        let propagation = &self.propagation(ephemeris);
        if self.keeps_values() {
            self.keeping(propagation, histograms)
        } else {
            self.streaming(propagation, histograms)
        }
    }

    /// Whether the values of all samples are kept between the passes of the statistics.
    fn keeps_values(&self) -> bool {
        self.scene.tiles.slots() * self.setup.grid.len() <= self.kept_values
    }

    /// Passes all instants to `see`, one after the other.
    pub(super) fn visit(
        &self,
        ephemeris: &Ephemeris,
        mut see: impl FnMut(&Instant),
    ) -> Result<(), EphemerisError> {
        let propagation = &self.propagation(ephemeris);
        let mut instant = Instant::new(self.setup.sites.len());
        let samples = 0..self.setup.grid.len();
        self.run(propagation, samples, self.scene.limits, |evaluating| {
            instant.number = evaluating.instant.number;
            for (number, tile) in self.scene.tiles.tiles.iter().enumerate() {
                let gnss = evaluating.fixed.tile(number).visible;
                let (leo, pdop) = (
                    &evaluating.outcome.visible[number].0,
                    &evaluating.outcome.pdop[number].0,
                );
                for (lane, &site) in tile.members.iter().enumerate() {
                    let point = &mut instant.points[site as usize];
                    point.visible = leo[lane];
                    point.gnss_visible = u32::from(gnss[lane]);
                    point.pdop = (pdop[lane] < UNSOLVED).then_some(pdop[lane]);
                }
            }
            see(&instant);
            Ok(())
        })?;
        Ok(())
    }

    /// One pass over the samples and two over the stored values.
    fn keeping(
        &self,
        propagation: &Propagation<'_>,
        histograms: bool,
    ) -> Result<(Evaluated, Rechecks), EphemerisError> {
        let samples = self.setup.grid.len();
        let mut values = Vec::with_capacity(samples * self.scene.tiles.tiles.len());
        let mut counts = Counts::new(self.places);
        let mut sum = 0.0;
        let mut tally = self.tally(histograms);
        for chunk in self.chunks(samples) {
            let first = values.len();
            let rechecks = self.run(propagation, chunk, self.scene.limits, |instant| {
                values.extend_from_slice(&instant.outcome.pdop);
                self.tally_instant(instant, &mut tally);
                Ok(())
            })?;
            tally.rechecks = tally.rechecks.merged(rechecks);
            sum += self.count(&values[first..], &mut counts);
        }
        let summary = self.summary_of_kept(propagation, &values, (&counts, sum))?;
        Ok((self.evaluated(&mut tally, &counts, summary), tally.rechecks))
    }

    /// Two passes over the samples, each on all threads; only counts are stored.
    fn streaming(
        &self,
        propagation: &Propagation<'_>,
        histograms: bool,
    ) -> Result<(Evaluated, Rechecks), EphemerisError> {
        let chunks = self.chunks(self.setup.grid.len());
        let ((counts, mut tally), parts) = self.pass(
            propagation,
            &chunks,
            || (Counts::new(self.places), self.tally(histograms)),
            |instant, (counts, tally), sums| {
                self.tally_instant(instant, tally);
                sums[0] += self.count(&instant.outcome.pdop, counts);
                Ok(())
            },
            1,
        )?;
        for (rechecks, _) in &parts {
            tally.rechecks = tally.rechecks.merged(*rechecks);
        }
        let sum = summed(&parts, 0);
        let level = self.setup.metrics.cvar_level;
        let summary = match RankSearch::new(&counts, level) {
            Some(search) => {
                let note = |instant: &mut Evaluating<'_>, found: &mut _, tails: &mut [f64]| {
                    tails[0] += self.find(&instant.outcome.pdop, &search, found);
                    Ok(())
                };
                let (found, parts) = self.pass(propagation, &chunks, Found::new, note, 1)?;
                Some(search.summary(&found, sum, summed(&parts, 0)))
            }
            None => None,
        };
        Ok((self.evaluated(&mut tally, &counts, summary), tally.rechecks))
    }

    /// One pass over the samples on all threads. `note` adds an instant to an accumulator of integers, which
    /// are merged in the order of time, and to so many sums, which are stored for each chunk. A block of chunks shares an
    /// accumulator, since those of many points are large.
    fn pass<A: Merge + Send>(
        &self,
        propagation: &Propagation<'_>,
        chunks: &[Range<usize>],
        new: impl Fn() -> A + Sync,
        note: impl Fn(&mut Evaluating<'_>, &mut A, &mut [f64]) -> Result<(), EphemerisError> + Sync,
        sums: usize,
    ) -> Result<(A, TilePartials), EphemerisError> {
        let accumulators = memory::accumulators(rayon::current_num_threads(), &self.scene.tiles);
        let each = chunks.len().div_ceil(accumulators).max(1);
        let block = |chunks: &[Range<usize>]| {
            let (mut all, mut parts) = (new(), Vec::new());
            for chunk in chunks {
                let mut part = vec![0.0; sums];
                let limits = self.scene.limits;
                let rechecks = self.run(propagation, chunk.clone(), limits, |instant| {
                    note(instant, &mut all, &mut part)
                })?;
                parts.push((rechecks, part));
            }
            Ok((all, parts))
        };
        let blocks = chunks.par_chunks(each).map(block);
        let found = blocks.try_reduce_with(|(all, mut parts), (more, more_parts)| {
            parts.extend(more_parts);
            Ok((all.merged(&more), parts))
        });
        found.unwrap_or_else(|| Ok((new(), Vec::new())))
    }

    fn count(&self, values: &[Lanes<f32>], counts: &mut Counts) -> f64 {
        self.instructions.run(Count {
            tiles: &self.scene.tiles.tiles,
            values,
            counts,
        })
    }

    fn find(&self, values: &[Lanes<f32>], search: &RankSearch, found: &mut Found) -> f64 {
        self.instructions.run(Find {
            tiles: &self.scene.tiles.tiles,
            values,
            search,
            found,
        })
    }

    /// Pieces of the time grid, independent of the number of threads.
    fn chunks(&self, samples: usize) -> Vec<Range<usize>> {
        self.pieces(0..samples)
    }

    fn pieces(&self, instants: Range<usize>) -> Vec<Range<usize>> {
        let length = (CHUNK_VALUES / self.scene.tiles.slots()).max(1);
        let end = instants.end;
        instants
            .step_by(length)
            .map(|first| first..(first + length).min(end))
            .collect()
    }

    /// Evaluates some instants and passes each to `take`.
    fn run(
        &self,
        propagation: &Propagation<'_>,
        chunk: Range<usize>,
        limits: Limits,
        mut take: impl FnMut(&mut Evaluating<'_>) -> Result<(), EphemerisError>,
    ) -> Result<Rechecks, EphemerisError> {
        let mut work = Workspace::new(propagation);
        let mut outcome = SampleOutcome::new(self.scene.tiles.tiles.len());
        let mut scratch = FixedTiles::default();
        let mut rechecks = Rechecks::default();
        for k in chunk {
            let elapsed_s = self.setup.grid.elapsed_s(k);
            let rotation = self.rotations[k];
            let instant = SampleInstant {
                number: k,
                elapsed_s,
                rotation,
            };
            let fixed = self.fixed.at(&self.scene.tiles, instant, &mut scratch)?;
            let Workspace {
                positions, turns, ..
            } = &mut work;
            propagation.start(elapsed_s, rotation, positions, turns)?;
            self.instructions.run(Sample {
                scene: &self.scene,
                limits,
                patterns: &propagation.patterns,
                fixed,
                work: &mut work,
                outcome: &mut outcome,
            });
            for undecided in &outcome.doubts {
                match undecided.doubt {
                    Doubt::Mask => rechecks.near_mask += 1,
                    Doubt::Geometry => rechecks.near_limit += 1,
                }
            }
            rechecks.large_pdop += outcome.doubled;
            let settling = Settling::new(&self.setup, &self.scene, instant, fixed);
            settling.settle(propagation.ephemeris, &self.fixed.systems, &mut outcome)?;
            take(&mut Evaluating {
                instant,
                work: &mut work,
                outcome: &outcome,
                fixed,
            })?;
        }
        Ok(rechecks)
    }

    fn evaluated(
        &self,
        tally: &mut ViewTally<'_>,
        counts: &Counts,
        summary: Option<Summary>,
    ) -> Evaluated {
        let share = |weight: u64| weight as f64 / self.total as f64;
        let [leo, all] = tally.views();
        Evaluated {
            leo,
            all,
            bins: tally.bins.take(),
            solved: share(counts.solved()),
            available: share(tally.available()),
            longest_outage: tally.longest_outage(),
            summary,
        }
    }
}

#[cfg(test)]
mod tests;

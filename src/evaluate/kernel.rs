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
//! determinant; in f64, it comes from the factor of the plain path.
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
mod fixed;
mod instructions;
mod lanes;
mod order_statistics;
mod propagation;
mod refine;
mod sample;
mod settle;
mod tiles;

pub use instructions::InstructionSet;

use super::Setup;
use super::metrics::Evaluated;
use crate::dop::Clocks;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::stats::Summary;
use fixed::{Fixed, FixedTiles, SampleInstant};
use lanes::{LANES, Lanes, MaskTerms};
use order_statistics::{Count, Counts, Find, Found, Merge, Places, RankSearch};
use propagation::Propagation;
use rayon::prelude::*;
use refine::{Ranked, Surround};
use sample::{Doubt, Limits, Sample, SampleContext, SampleOutcome, Workspace};
use settle::Settling;
use std::ops::Range;
use std::sync::Arc;
use tiles::Tiles;

/// What may be stored in memory. Beyond this, values are recomputed when needed, so memory does not
/// grow with points times instants.
#[derive(Debug, Clone, Copy)]
struct Keep {
    /// Values of PDOP between the two passes of the statistics of one design.
    values: usize,
    /// Bytes of the GNSS sums between designs.
    fixed_bytes: usize,
}

impl Default for Keep {
    fn default() -> Self {
        Self {
            values: 4 << 20,
            fixed_bytes: 256 << 20,
        }
    }
}

/// Values of PDOP computed in one piece of work.
const CHUNK_VALUES: usize = 1 << 18;

/// Upper limit on the PDOP up to which f32 is trusted.
const SINGLE_BELOW: f32 = 2.0;

/// Memory of a kernel and of `threads` evaluations at a time, bytes.
pub(super) fn memory_bytes(setup: &Setup, threads: usize) -> usize {
    let keep = Keep::default();
    let tiles = setup.sites.len().div_ceil(LANES) * setup.grid.len();
    let values = (tiles * LANES).min(keep.values) * size_of::<f32>();
    let fixed = match tiles * FixedTiles::bytes(setup.clocks) {
        bytes if setup.gnss.is_empty() || bytes > keep.fixed_bytes => 0,
        bytes => bytes,
    };
    fixed + threads * (values + Places::new(setup.pdop_cap).bytes() + Found::BYTES)
}

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

/// The part of the kernel that is the same for all designs.
pub(super) struct Kernel {
    setup: Arc<Setup>,
    rotations: Arc<[EarthRotation]>,
    scene: SampleContext,
    fixed: Fixed,
    instructions: InstructionSet,
    places: Places,
    kept_values: usize,
}

/// Counts of one piece of work.
#[derive(Debug, Clone, Copy, Default)]
struct Tallies {
    visible: u64,
    available: u64,
    rechecks: Rechecks,
}

impl Tallies {
    fn merged(self, other: Self) -> Self {
        Self {
            visible: self.visible + other.visible,
            available: self.available + other.available,
            rechecks: Rechecks {
                near_mask: self.rechecks.near_mask + other.rechecks.near_mask,
                large_pdop: self.rechecks.large_pdop + other.rechecks.large_pdop,
                near_limit: self.rechecks.near_limit + other.rechecks.near_limit,
            },
        }
    }
}

impl Kernel {
    pub(super) fn new(
        setup: Arc<Setup>,
        rotations: Arc<[EarthRotation]>,
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        Self::keeping_at_most(Keep::default(), setup, rotations, instructions)
    }

    fn keeping_at_most(
        keep: Keep,
        setup: Arc<Setup>,
        rotations: Arc<[EarthRotation]>,
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        let tiles = Tiles::new(&setup.sites, setup.mask, setup.gnss_mask);
        let fixed = Fixed::new(&setup, &tiles, &rotations, instructions, keep.fixed_bytes)?;
        let scene = SampleContext {
            tiles,
            single: MaskTerms::new(setup.mask),
            double: MaskTerms::new(setup.mask),
            limits: Limits {
                single_below: SINGLE_BELOW.min(setup.pdop_cap as f32 * 0.999),
                cap: setup.pdop_cap,
                available: setup.metrics.availability_pdop,
                clocks: match setup.clocks {
                    Clocks::PerSystem => 1 + setup.gnss.len() as u32,
                    Clocks::Shared => 1,
                },
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
        })
    }

    /// Evaluates satellites.
    pub(super) fn evaluate(
        &self,
        ephemeris: &Ephemeris,
    ) -> Result<(Evaluated, Rechecks), EphemerisError> {
        let propagation = &Propagation::new(ephemeris);
        if self.scene.tiles.slots() * self.setup.grid.len() <= self.kept_values {
            self.keeping(propagation)
        } else {
            self.streaming(propagation)
        }
    }

    /// One pass over the samples and two over the stored values.
    fn keeping(
        &self,
        propagation: &Propagation<'_>,
    ) -> Result<(Evaluated, Rechecks), EphemerisError> {
        let samples = self.setup.grid.len();
        let mut values = Vec::with_capacity(samples * self.scene.tiles.tiles.len());
        let mut counts = Counts::new(self.places);
        let mut sum = 0.0;
        let mut tallies = Tallies::default();
        for chunk in self.chunks(samples) {
            let first = values.len();
            let part = self.run(propagation, chunk, self.scene.limits, |tiles| {
                values.extend_from_slice(tiles);
            })?;
            tallies = tallies.merged(part);
            sum += self.count(&values[first..], &mut counts);
        }
        let summary = match RankSearch::new(&counts, self.setup.metrics.cvar_level) {
            Some(search) => {
                let mut found = Found::new();
                let tail = self.find(&values, &search, &mut found);
                let mut summary = search.summary(&found, sum, tail);
                self.refine(propagation, &values, &search, &mut summary)?;
                Some(summary)
            }
            None => None,
        };
        let evaluated = evaluated(&self.setup, tallies, &counts, summary);
        Ok((evaluated, tallies.rechecks))
    }

    /// Recomputes the order statistics in f64.
    fn refine(
        &self,
        propagation: &Propagation<'_>,
        values: &[Lanes<f32>],
        search: &RankSearch,
        summary: &mut Summary,
    ) -> Result<(), EphemerisError> {
        let statistics = [
            &mut summary.p50,
            &mut summary.p95,
            &mut summary.p99,
            &mut summary.max,
        ];
        let ranked = std::array::from_fn(|number| Ranked {
            rank: search.rank(number),
            value: *statistics[number],
        });
        let windows: [_; 4] = self.instructions.run(Surround {
            tiles: values,
            ranked,
        });
        let exact = Limits {
            single_below: 0.0,
            ..self.scene.limits
        };
        let tiles = self.scene.tiles.tiles.len();
        for (statistic, window) in statistics.into_iter().zip(&windows) {
            let mut again = Vec::with_capacity(window.places.len());
            for together in window.places.chunk_by(|a, b| a.0 / tiles == b.0 / tiles) {
                let k = together[0].0 / tiles;
                self.run(propagation, k..k + 1, exact, |sample| {
                    again.extend(together.iter().map(|&(n, lane)| sample[n % tiles].0[lane]));
                })?;
            }
            if let Some(value) = window.pick(again) {
                *statistic = value;
            }
        }
        Ok(())
    }

    /// Two passes over the samples, each on all threads; only counts are stored.
    fn streaming(
        &self,
        propagation: &Propagation<'_>,
    ) -> Result<(Evaluated, Rechecks), EphemerisError> {
        let chunks = self.chunks(self.setup.grid.len());
        let (counts, parts) = self.pass(
            propagation,
            &chunks,
            || Counts::new(self.places),
            |tiles, counts| self.count(tiles, counts),
        )?;
        // The chunks stay in order, so the sum does not depend on the number of threads.
        let tallies = parts
            .iter()
            .fold(Tallies::default(), |all, part| all.merged(part.0));
        let sum = parts.iter().map(|part| part.1).sum();
        let summary = match RankSearch::new(&counts, self.setup.metrics.cvar_level) {
            Some(search) => {
                let (found, parts) =
                    self.pass(propagation, &chunks, Found::new, |tiles, found| {
                        self.find(tiles, &search, found)
                    })?;
                let tail = parts.iter().map(|part| part.1).sum();
                Some(search.summary(&found, sum, tail))
            }
            None => None,
        };
        let evaluated = evaluated(&self.setup, tallies, &counts, summary);
        Ok((evaluated, tallies.rechecks))
    }

    /// One pass over the samples on all threads. `note` adds the values of a sample to an accumulator of
    /// integers, in any order, and returns a sum, which is stored for each chunk.
    fn pass<A: Merge + Send>(
        &self,
        propagation: &Propagation<'_>,
        chunks: &[Range<usize>],
        new: impl Fn() -> A + Sync,
        note: impl Fn(&[Lanes<f32>], &mut A) -> f64 + Sync,
    ) -> Result<(A, Vec<(Tallies, f64)>), EphemerisError> {
        chunks
            .par_iter()
            .try_fold(
                || (new(), Vec::new()),
                |(mut all, mut parts), chunk| {
                    let mut sum = 0.0;
                    let tallies =
                        self.run(propagation, chunk.clone(), self.scene.limits, |tiles| {
                            sum += note(tiles, &mut all);
                        })?;
                    parts.push((tallies, sum));
                    Ok((all, parts))
                },
            )
            .try_reduce(
                || (new(), Vec::new()),
                |(all, mut parts), (more, more_parts)| {
                    parts.extend(more_parts);
                    Ok((all.merged(&more), parts))
                },
            )
    }

    fn count(&self, tiles: &[Lanes<f32>], counts: &mut Counts) -> f64 {
        self.instructions.run(Count { tiles, counts })
    }

    fn find(&self, tiles: &[Lanes<f32>], search: &RankSearch, found: &mut Found) -> f64 {
        self.instructions.run(Find {
            tiles,
            search,
            found,
        })
    }

    /// Pieces of the time grid, independent of the number of threads.
    fn chunks(&self, samples: usize) -> Vec<Range<usize>> {
        let length = (CHUNK_VALUES / self.scene.tiles.slots()).max(1);
        (0..samples)
            .step_by(length)
            .map(|first| first..(first + length).min(samples))
            .collect()
    }

    /// Evaluates some samples and passes the values of each to `take`.
    fn run(
        &self,
        propagation: &Propagation<'_>,
        chunk: Range<usize>,
        limits: Limits,
        mut take: impl FnMut(&[Lanes<f32>]),
    ) -> Result<Tallies, EphemerisError> {
        let mut work = Workspace::new(propagation.ephemeris.satellites().len());
        let mut outcome = SampleOutcome::new(self.scene.tiles.tiles.len());
        let mut scratch = FixedTiles::default();
        let mut tallies = Tallies::default();
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
                    Doubt::Mask => tallies.rechecks.near_mask += 1,
                    Doubt::Geometry => tallies.rechecks.near_limit += 1,
                }
            }
            tallies.rechecks.large_pdop += outcome.doubled;
            let settling = Settling::new(&self.setup, &self.scene, instant, fixed);
            settling.settle(propagation.ephemeris, &self.fixed.systems, &mut outcome)?;
            tallies.visible += outcome.visible;
            tallies.available += outcome.available;
            take(&outcome.pdop);
        }
        Ok(tallies)
    }
}

fn evaluated(
    setup: &Setup,
    tallies: Tallies,
    counts: &Counts,
    summary: Option<Summary>,
) -> Evaluated {
    let samples = setup.sample_count() as f64;
    Evaluated {
        mean_visible: tallies.visible as f64 / samples,
        solved: counts.solved() as f64 / samples,
        available: tallies.available as f64 / samples,
        summary,
    }
}

#[cfg(test)]
mod tests;

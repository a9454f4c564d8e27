//! The fast path of the evaluator. It gives what [`super::plain`] gives; a property test holds
//! the two together.
//!
//! # What is summed
//!
//! A group of n visible satellites that share a clock contributes Σ v vᵀ - (Σ v)(Σ v)ᵀ / n to the
//! normal matrix of the position (M-17). So nine sums and a count over the visible LEO satellites
//! are all that a sample needs: Σ v vᵀ (five numbers: the sixth follows from tr Σ v vᵀ = n), Σ v
//! and n. The part of the GNSS does not change between designs and is made once ([`fixed`]). PDOP²
//! is the sum of the principal minors over the determinant, so that no matrix is inverted.
//!
//! # In what order
//!
//! Sample by sample in time. At each: positions of all satellites ([`flight`]); for each group of
//! tiles of ground points the satellites that it may see ([`tiles`], [`candidates`]); for each tile
//! of sixteen points ([`lanes`]) the loop over those that the tile may see, with the ten sums in
//! registers. Work grows with the pairs that see each other, about twice their number, and not
//! with points times satellites.
//!
//! # What f32 cannot hold
//!
//! The lanes work in f32, which is good to about 1e-7 where geometry is good. Two things are not
//! left to it ([`sample`]):
//!
//! - a decision so close to the mask that rounding might turn it is taken again with the positions
//!   and the comparison of the plain path ([`retake`]), so that visible satellites are counted
//!   exactly;
//! - PDOP above a limit, or at a threshold, is computed again in f64 lanes.
//!
//! Both are counted in [`Retakes`].
//!
//! # Statistics
//!
//! Values are never sorted, and beyond [`KEPT_VALUES`] not even kept ([`tally`]).

mod candidates;
mod fixed;
mod flight;
mod lanes;
mod retake;
mod sample;
mod tally;
mod tiles;

pub use sample::InstructionSet;

use super::metrics::Evaluated;
use super::{Evaluator, Setup};
use crate::constellation::Design;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;
use crate::stats::Summary;
use fixed::Fixed;
use flight::PatternFlight;
use lanes::{Lanes, MaskTerms};
use rayon::prelude::*;
use sample::{Instant, Limits, Outcome, Scene, Workspace};
use std::ops::Range;
use tally::{Counts, Found, Search};
use tiles::Tiles;

/// Values of PDOP up to which they are kept between the two passes of the statistics; beyond, the
/// second pass computes them again.
const KEPT_VALUES: usize = 4 << 20;

/// Values of PDOP that are made in one piece of work.
const CHUNK_VALUES: usize = 1 << 18;

/// PDOP up to which f32 is trusted.
const SINGLE_BELOW: f32 = 2.0;

/// Samples that were taken again in f64.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Retakes {
    /// A satellite was too close to the mask.
    pub near_mask: u64,
    /// PDOP was large or close to a threshold.
    pub large_pdop: u64,
}

/// Everything of the kernel that no design changes.
pub(super) struct Kernel {
    scene: Scene,
    fixed: Fixed,
    instructions: InstructionSet,
}

/// Satellites, and the pattern behind them if there is a fast way to fly it.
#[derive(Clone, Copy)]
struct Flight<'a> {
    ephemeris: &'a Ephemeris,
    pattern: Option<&'a PatternFlight>,
}

/// Counts of one piece of work.
#[derive(Debug, Clone, Copy, Default)]
struct Tallies {
    visible: u64,
    available: u64,
    sum: f64,
    retakes: Retakes,
}

impl Tallies {
    fn merged(self, other: Self) -> Self {
        Self {
            visible: self.visible + other.visible,
            available: self.available + other.available,
            sum: self.sum + other.sum,
            retakes: Retakes {
                near_mask: self.retakes.near_mask + other.retakes.near_mask,
                large_pdop: self.retakes.large_pdop + other.retakes.large_pdop,
            },
        }
    }
}

impl Kernel {
    pub(super) fn new(
        setup: &Setup,
        rotations: &[EarthRotation],
        instructions: InstructionSet,
    ) -> Result<Self, EphemerisError> {
        let tiles = Tiles::new(&setup.sites, setup.mask);
        let fixed = Fixed::new(setup, &tiles, rotations)?;
        let scene = Scene {
            tiles,
            single: MaskTerms::new(setup.mask),
            double: MaskTerms::new(setup.mask),
            limits: Limits {
                single_below: SINGLE_BELOW.min(setup.pdop_cap as f32 * 0.999),
                cap: setup.pdop_cap,
                available: setup.metrics.availability_pdop,
            },
        };
        Ok(Self {
            scene,
            fixed,
            instructions,
        })
    }

    /// Evaluates satellites; `design` is what they are if they are the satellites of a design
    /// under the model of the setup.
    pub(super) fn evaluate(
        &self,
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
        design: Option<&Design>,
    ) -> Result<(Evaluated, Retakes), EphemerisError> {
        let pattern =
            design.and_then(|design| PatternFlight::new(design, evaluator.setup().model));
        let flight = Flight {
            ephemeris,
            pattern: pattern.as_ref(),
        };
        if self.scene.tiles.slots() * evaluator.setup().grid.len() <= KEPT_VALUES {
            self.keeping(evaluator, flight)
        } else {
            self.streaming(evaluator, flight)
        }
    }

    /// One pass over the samples; the statistics pass over the values twice.
    fn keeping(
        &self,
        evaluator: &Evaluator,
        flight: Flight<'_>,
    ) -> Result<(Evaluated, Retakes), EphemerisError> {
        let samples = evaluator.setup().grid.len();
        let mut values = Vec::with_capacity(samples * self.scene.tiles.tiles.len());
        let mut counts = Counts::new();
        let mut tallies = Tallies::default();
        for chunk in self.chunks(samples) {
            let part = self.run(evaluator, flight, chunk, |tiles| {
                counts.take(tiles);
                values.extend_from_slice(tiles);
            })?;
            tallies = tallies.merged(part);
        }
        let level = evaluator.setup().metrics.cvar_level;
        let search = Search::new(&counts, level);
        let summary = search.map(|search| search.summary(search.scan(&values), tallies.sum));
        Ok((
            evaluated(evaluator.setup(), tallies, &counts, summary),
            tallies.retakes,
        ))
    }

    /// Two passes over the samples, each on all threads; nothing is kept but counts.
    fn streaming(
        &self,
        evaluator: &Evaluator,
        flight: Flight<'_>,
    ) -> Result<(Evaluated, Retakes), EphemerisError> {
        let chunks = self.chunks(evaluator.setup().grid.len());
        let (counts, parts) = chunks
            .par_iter()
            .try_fold(
                || (Counts::new(), Vec::new()),
                |(mut counts, mut parts), chunk| {
                    let part = self.run(evaluator, flight, chunk.clone(), |t| counts.take(t))?;
                    parts.push(part);
                    Ok((counts, parts))
                },
            )
            .try_reduce(
                || (Counts::new(), Vec::new()),
                |(counts, mut parts), (more_counts, more_parts)| {
                    parts.extend(more_parts);
                    Ok((counts.merged(&more_counts), parts))
                },
            )?;
        // Rayon keeps the order of the chunks, so that the sum does not depend on the threads.
        let tallies = parts.into_iter().fold(Tallies::default(), Tallies::merged);
        let summary = match Search::new(&counts, evaluator.setup().metrics.cvar_level) {
            Some(search) => {
                let found = self.search(evaluator, flight, &chunks, &search)?;
                Some(search.summary(found, tallies.sum))
            }
            None => None,
        };
        Ok((
            evaluated(evaluator.setup(), tallies, &counts, summary),
            tallies.retakes,
        ))
    }

    /// The second pass over the samples.
    fn search(
        &self,
        evaluator: &Evaluator,
        flight: Flight<'_>,
        chunks: &[Range<usize>],
        search: &Search,
    ) -> Result<Found, EphemerisError> {
        let look_through = |chunk: &Range<usize>| {
            let mut found = Found::default();
            self.run(evaluator, flight, chunk.clone(), |tiles| {
                found.add(search.scan(tiles));
            })?;
            Ok(found)
        };
        let parts: Vec<Found> = chunks
            .par_iter()
            .map(look_through)
            .collect::<Result<_, EphemerisError>>()?;
        let mut found = Found::default();
        parts.into_iter().for_each(|part| found.add(part));
        Ok(found)
    }

    /// Pieces of the time grid that do not depend on the threads.
    fn chunks(&self, samples: usize) -> Vec<Range<usize>> {
        let length = (CHUNK_VALUES / self.scene.tiles.slots()).max(1);
        (0..samples)
            .step_by(length)
            .map(|first| first..(first + length).min(samples))
            .collect()
    }

    /// Evaluates some samples and hands the values of each to `take`.
    fn run(
        &self,
        evaluator: &Evaluator,
        flight: Flight<'_>,
        chunk: Range<usize>,
        mut take: impl FnMut(&[Lanes<f32>]),
    ) -> Result<Tallies, EphemerisError> {
        let mut work = Workspace::new(flight.ephemeris.satellites().len());
        let mut outcome = Outcome::new(self.scene.tiles.tiles.len());
        let mut room = Vec::new();
        let mut tallies = Tallies::default();
        for k in chunk {
            let elapsed_s = evaluator.setup().grid.elapsed_s(k);
            let rotation = evaluator.rotations[k];
            let instant = (k, elapsed_s, rotation);
            let fixed = self.fixed.at(&self.scene.tiles, instant, &mut room)?;
            if flight.pattern.is_none() {
                work.positions.ask(flight.ephemeris, elapsed_s, rotation)?;
            }
            let pattern = flight
                .pattern
                .map(|pattern| (pattern, pattern.turn(elapsed_s, rotation)));
            let input = Instant { pattern, fixed };
            sample::evaluate(self.instructions, &self.scene, input, &mut work, &mut outcome);
            tallies.retakes.near_mask += outcome.doubts.len() as u64;
            tallies.retakes.large_pdop += outcome.doubled;
            let sky = retake::Sky {
                ephemeris: flight.ephemeris,
                elapsed_s,
                rotation,
            };
            retake::settle(evaluator.setup(), &self.scene, &sky, fixed, &mut outcome)?;
            tallies.visible += outcome.visible;
            tallies.available += outcome.available;
            tallies.sum += tally::sum(&outcome.pdop);
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
    Evaluated {
        samples: setup.sample_count(),
        visible: tallies.visible,
        solved: counts.solved(),
        available: tallies.available,
        summary,
    }
}

#[cfg(test)]
mod tests;

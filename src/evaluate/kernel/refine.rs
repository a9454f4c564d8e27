//! Order statistics in f64.
//!
//! Rounding errors of f32 average out in means and tails, but an order statistic is a single value. The
//! values so close to it that rounding may have changed their order are therefore recomputed, and the
//! order statistic is taken among them.

use super::Kernel;
use super::instructions::Work;
use super::lanes::Lanes;
use super::limits::{Limits, SingleLimits};
use super::order_statistics::{Counts, Found, RankSearch};
use super::propagation::Propagation;
use super::tiles::Tile;
use crate::ephemeris::EphemerisError;
use crate::stats::Summary;
use std::ops::ControlFlow;

/// Relative distance within which the order of two f32 values is meaningless: more than twice the error
/// of one.
const WINDOW: f64 = 4e-6;

/// With more values than this in a window, they are so dense that their order does not matter.
const CROWD: usize = 256;

/// An order statistic by its rank (from 1, in units of weight), its value in f32, and the weight of smaller values.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ranked {
    pub(super) rank: u64,
    pub(super) value: f64,
    pub(super) below: u64,
}

/// The values around an order statistic.
#[derive(Debug, Clone)]
pub(super) struct Window {
    start: f32,
    value: f32,
    end: f32,
    rank: u64,
    /// Weight of the values below the order statistic, and of those among them that are inside.
    below: u64,
    inside: u64,
    /// Tile and lane of the values inside.
    pub(super) places: Vec<(usize, usize)>,
}

impl Window {
    fn new(ranked: Ranked) -> Self {
        Self {
            start: (ranked.value * (1.0 - WINDOW)) as f32,
            value: ranked.value as f32,
            end: (ranked.value * (1.0 + WINDOW)) as f32,
            rank: ranked.rank,
            below: ranked.below,
            inside: 0,
            places: Vec::new(),
        }
    }

    /// Records the slots of a tile that are inside, up to the limit.
    fn note(&mut self, number: usize, values: &Lanes<f32>, weights: &Lanes<u64>) {
        if self.places.len() > CROWD {
            return;
        }
        for (lane, (&value, weight)) in values.0.iter().zip(weights.0).enumerate() {
            if value >= self.start && value <= self.end {
                self.places.push((number, lane));
                self.inside += if value < self.value { weight } else { 0 };
            }
        }
    }

    /// The order statistic among the recomputed values, each with its weight.
    pub(super) fn pick(&self, mut values: Vec<(f32, u64)>) -> Option<f64> {
        values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let mut reached = self.below - self.inside;
        let found = values.into_iter().find(|(_, weight)| {
            reached += weight;
            reached >= self.rank
        });
        found.map(|(value, _)| f64::from(value))
    }
}

/// Finds the values around some order statistics; none for those where they are too dense.
pub(super) struct Surround<'a, const N: usize> {
    pub(super) tiles: &'a [Tile],
    /// Instant by instant and tile by tile.
    pub(super) values: &'a [Lanes<f32>],
    pub(super) ranked: [Ranked; N],
}

impl<const N: usize> Work for Surround<'_, N> {
    type Output = [Window; N];

    #[inline(always)]
    fn run(self) -> [Window; N] {
        let mut windows = self.ranked.map(Window::new);
        let starts = windows.each_ref().map(|window| window.start);
        let ends = windows.each_ref().map(|window| window.end);
        let tiles = self.tiles.iter().cycle();
        for ((number, values), tile) in self.values.iter().enumerate().zip(tiles) {
            let mut inside = 0;
            for &value in &values.0 {
                for w in 0..N {
                    inside |= u32::from((value >= starts[w]) & (value <= ends[w]));
                }
            }
            if inside != 0 {
                let weights = &tile.weights.whole;
                let note = |window: &mut Window| window.note(number, values, weights);
                windows.iter_mut().for_each(note);
            }
        }
        for window in &mut windows {
            if window.places.len() > CROWD {
                window.places.clear();
            }
        }
        windows
    }
}

impl Kernel {
    /// The statistics of stored values, from their counts and their sum; `None` if none is solved.
    pub(super) fn summary_of_kept(
        &self,
        propagation: &Propagation<'_>,
        values: &[Lanes<f32>],
        (counts, sum): (&Counts, f64),
    ) -> Result<Option<Summary>, EphemerisError> {
        let Some(search) = RankSearch::new(counts, self.setup.metrics.cvar_level) else {
            return Ok(None);
        };
        let mut found = Found::new();
        let tail = self.find(values, &search, &mut found);
        let mut summary = search.summary(&found, sum, tail);
        let ranked = std::array::from_fn(|number| search.ranked(&found, number));
        self.refine(propagation, values, ranked, &mut summary)?;
        Ok(Some(summary))
    }

    /// Recomputes the order statistics in f64.
    fn refine(
        &self,
        propagation: &Propagation<'_>,
        values: &[Lanes<f32>],
        ranked: [Ranked; 4],
        summary: &mut Summary,
    ) -> Result<(), EphemerisError> {
        let statistics = [
            &mut summary.p50,
            &mut summary.p95,
            &mut summary.p99,
            &mut summary.max,
        ];
        let windows: [_; 4] = self.instructions.run(Surround {
            tiles: &self.scene.tiles.tiles,
            values,
            ranked,
        });
        let exact = Limits {
            single: SingleLimits::NONE,
            ..self.scene.limits
        };
        for (statistic, window) in statistics.into_iter().zip(&windows) {
            let again = self.again(propagation, exact, &window.places)?;
            if let Some(value) = window.pick(again) {
                *statistic = value;
            }
        }
        Ok(())
    }

    /// Some values, each by the number of its tile among those of all instants and its lane, recomputed within other limits; with
    /// their weights.
    fn again(
        &self,
        propagation: &Propagation<'_>,
        limits: Limits,
        places: &[(usize, usize)],
    ) -> Result<Vec<(f32, u64)>, EphemerisError> {
        let tiles = self.scene.tiles.tiles.len();
        let mut wanted: Vec<(usize, Vec<u32>)> = Vec::new();
        for together in places.chunk_by(|a, b| a.0 / tiles == b.0 / tiles) {
            let mut here: Vec<u32> = together.iter().map(|(n, _)| (n % tiles) as u32).collect();
            here.dedup();
            wanted.push((together[0].0 / tiles, here));
        }
        let instants = wanted.iter().map(|(k, here)| (*k, here.as_slice()));
        let mut again = Vec::with_capacity(places.len());
        let mut places = places.iter().peekable();
        self.probe_within(propagation, limits, instants, |seen| {
            let number = seen.instant * tiles + seen.tile;
            while let Some((_, lane)) = places.next_if(|(n, _)| *n == number) {
                again.push((seen.pdop[*lane], seen.weights[*lane]));
            }
            ControlFlow::Continue(())
        })?;
        Ok(again)
    }
}

//! The worst without each set of satellites, where neither quantiles nor the tail are wanted: from tallies of the samples
//! that stay solved, and the few others one by one.

use super::pass::{self, Sets};
use super::sight::SightTree;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Evaluator;
use crate::evaluate::failures::OneLost;
use crate::evaluate::kernel::SampleLosses;
use rayon::prelude::*;
use std::sync::OnceLock;

impl Evaluator {
    /// The worst without each of some sets of satellites, given by their places; that of [`Evaluator::without_each`] but
    /// for the CVaR, in less than half of the time.
    pub(super) fn worst_without_each(
        &self,
        ephemeris: &Ephemeris,
        sets: &[Vec<usize>],
    ) -> Result<Vec<OneLost>, EphemerisError> {
        let tree = SightTree::new(self.setup());
        let mut found = Vec::with_capacity(sets.len());
        for batch in self.batches(ephemeris, sets)? {
            let of_batch = Sets::new(self, ephemeris, batch).tallied();
            let pieces = pass::pass(self, &tree, &of_batch)?;
            let whole = AllSamples::new(self, &pieces);
            let cases = (0..batch.len())
                .into_par_iter()
                .map(|set| whole.without(set));
            found.extend(cases.collect::<Vec<_>>());
        }
        Ok(found)
    }
}

/// The samples with all satellites.
struct AllSamples<'a> {
    evaluator: &'a Evaluator,
    pieces: &'a [SampleLosses],
    totals: SolvedTotals,
    /// The largest PDOP of the solved samples.
    largest: f64,
    /// The solved samples with their PDOP, the largest first, once they are wanted.
    falling: OnceLock<Vec<(f64, u32)>>,
}

#[derive(Clone, Copy, Default)]
struct SolvedTotals {
    /// Number of solved samples.
    number: u64,
    /// Weight of the solved samples.
    solved: u64,
    /// Weight of the available samples.
    available: u64,
}

impl SolvedTotals {
    fn add(&mut self, pdop: f64, weight: u64, available_up_to: f64) {
        if pdop.is_finite() {
            self.number += 1;
            self.solved += weight;
            self.available += if pdop <= available_up_to { weight } else { 0 };
        }
    }

    fn take_away(&mut self, pdop: f64, weight: u64, available_up_to: f64) {
        if pdop.is_finite() {
            self.number -= 1;
            self.solved -= weight;
            self.available -= if pdop <= available_up_to { weight } else { 0 };
        }
    }
}

impl<'a> AllSamples<'a> {
    fn new(evaluator: &'a Evaluator, pieces: &'a [SampleLosses]) -> Self {
        let available_up_to = evaluator.setup().metrics.availability_pdop;
        let (mut totals, mut largest) = (SolvedTotals::default(), 0.0_f64);
        for one in pieces.iter().flat_map(|piece| &piece.whole) {
            let weight = evaluator.weights.of(one.site as usize);
            totals.add(one.pdop, weight, available_up_to);
            largest = largest.max(if one.pdop.is_finite() { one.pdop } else { 0.0 });
        }
        Self {
            evaluator,
            pieces,
            totals,
            largest,
            falling: OnceLock::new(),
        }
    }

    fn without(&self, set: usize) -> OneLost {
        let available_up_to = self.evaluator.setup().metrics.availability_pdop;
        let mut totals = self.totals;
        let mut largest = 0.0_f64;
        // Those whose PDOP with all satellites is gone: what replaces it is unsolved, or by rounding smaller.
        let mut dropped = Vec::new();
        for piece in self.pieces {
            if let Some(tally) = piece.tallies.get(set) {
                totals.available -= tally.unavailable;
                largest = largest.max(tally.largest());
            }
            for one in &piece.changed[set] {
                let whole = &piece.whole[(one.sample - piece.first) as usize];
                let weight = self.evaluator.weights.of(whole.site as usize);
                totals.take_away(whole.pdop, weight, available_up_to);
                totals.add(one.pdop, weight, available_up_to);
                let is_solved = one.pdop.is_finite();
                largest = largest.max(if is_solved { one.pdop } else { 0.0 });
                if whole.pdop.is_finite() && !(is_solved && one.pdop >= whole.pdop) {
                    dropped.push((one.sample, whole.pdop));
                }
            }
        }
        let share = |weight: u64| weight as f64 / self.evaluator.weights.total() as f64;
        let max_pdop = largest.max(self.largest_but(&mut dropped));
        OneLost {
            max_pdop: (totals.number > 0).then_some(max_pdop),
            cvar_pdop: None,
            availability: share(totals.available),
            solved_fraction: share(totals.solved),
        }
    }

    /// The largest PDOP with all satellites, but for some samples; 0 if there is none.
    fn largest_but(&self, dropped: &mut [(u32, f64)]) -> f64 {
        if dropped.iter().all(|(_, pdop)| *pdop < self.largest) {
            return self.largest;
        }
        dropped.sort_unstable_by_key(|(sample, _)| *sample);
        let is_left = |(_, sample): &&(f64, u32)| {
            let found = dropped.binary_search_by_key(sample, |(sample, _)| *sample);
            found.is_err()
        };
        let falling = self.falling.get_or_init(|| self.falling());
        falling.iter().find(is_left).map_or(0.0, |(pdop, _)| *pdop)
    }

    fn falling(&self) -> Vec<(f64, u32)> {
        let of_piece = |piece: &'a SampleLosses| {
            let samples = (piece.first..).zip(&piece.whole);
            samples.map(|(sample, one)| (one.pdop, sample))
        };
        let samples = self.pieces.iter().flat_map(of_piece);
        let mut solved: Vec<_> = samples.filter(|(pdop, _)| pdop.is_finite()).collect();
        solved.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        solved
    }
}

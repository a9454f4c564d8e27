//! The walk through the grid, its own checkpoint.

use super::level::{KeptDesign, LevelSummary, RuleSaving};
use super::order::{Hardness, SampleOrder};
use super::parts::Cursor;
use super::problem::{SizeProblem, Tried, TriedVerdict};
use super::witness::Witness;
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::optimize::OptimizeError;
use crate::search::{Constraint, Quantity};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Designs between which nothing is learnt, at most.
pub(super) const BATCH: usize = 1024;

/// A batch of so many designs ends with their number of satellites; a smaller one goes on with the next number.
const SMALL_BATCH: usize = 128;

/// Tiles of all designs of a batch, at most: what is learnt takes memory.
const BATCH_TILES: usize = 1 << 26;

/// One design of so many is evaluated at all samples, so that something is learnt about each.
const SCOUT_EVERY: u64 = 1024;

/// A search for the fewest satellites, or a part of one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeSearch {
    pub(super) slack: usize,
    pub(super) objective: Option<String>,
    pub(super) cursor: Cursor,
    /// The part that it ends with, if it is only that.
    pub(super) only: Option<u64>,
    /// Designs of the part of the walk that it is in.
    pub(super) tried_in_part: u64,
    /// Learnt in the part of the walk that it is in.
    pub(super) hardness: Option<Hardness>,
    pub(super) levels: Vec<LevelSummary>,
    pub(super) is_done: bool,
}

/// A design of the next batch.
struct Candidate {
    satellites: usize,
    genome: Vec<f64>,
    is_scout: bool,
}

impl SizeSearch {
    /// A search before its first step. It goes on to `slack` satellites more than the fewest, at least to the next
    /// number that occurs, and follows a further objective.
    #[must_use]
    pub fn start(problem: &SizeProblem<'_>, slack: usize, objective: Option<Quantity>) -> Self {
        Self {
            slack,
            objective: objective.map(|quantity| quantity.to_string()),
            cursor: Cursor::default(),
            only: None,
            tried_in_part: 0,
            hardness: problem.sample_tiles().map(Hardness::new),
            levels: Vec::new(),
            is_done: false,
        }
    }

    /// Whether a search that was read fits a problem and what it is asked for.
    #[must_use]
    pub fn suits(
        &self,
        problem: &SizeProblem<'_>,
        slack: usize,
        objective: Option<Quantity>,
    ) -> bool {
        let of_samples = match (&self.hardness, problem.sample_tiles()) {
            (Some(hardness), Some(shape)) => hardness.suits(shape),
            (None, Some(_)) => self.is_done,
            (None, None) => true,
            (Some(_), None) => false,
        };
        let objective = objective.map(|quantity| quantity.to_string());
        of_samples && self.slack == slack && self.objective == objective
    }

    /// Whether the answer is complete.
    #[must_use]
    pub fn is_done(&self) -> bool {
        self.is_done
    }

    /// Tries the next designs, on all threads, and returns the witnesses of those that it rejects, with their number
    /// of satellites, in the order of the grid.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn step(
        &mut self,
        problem: &SizeProblem<'_>,
    ) -> Result<Vec<(usize, Witness)>, OptimizeError> {
        let totals = problem.totals();
        let (batch, next) = self.batch(problem, &totals)?;
        let order = self.order(problem);
        let tried: Vec<Tried> = batch
            .par_iter()
            .map(|one| problem.tried(&one.genome, order.as_ref(), one.is_scout))
            .collect();
        if let (Some(hardness), Some(order)) = (&mut self.hardness, &order) {
            let sampled = tried.iter().filter(|one| one.tiles > 0);
            let learnt = sampled.map(|one| (one.tiles, one.bad_tiles.as_slice()));
            hardness.learn(order, learnt);
        }
        let mut witnesses = Vec::new();
        for (one, tried) in batch.iter().zip(tried) {
            if self.is_beyond(one.satellites) {
                break;
            }
            if let Some(witness) = self.take(problem, one.satellites, tried) {
                witnesses.push((one.satellites, witness));
            }
        }
        self.tried_in_part += batch.len() as u64;
        self.go_on_at(problem, next, &totals);
        Ok(witnesses)
    }

    /// The next designs, and the cursor behind them.
    fn batch(
        &self,
        problem: &SizeProblem<'_>,
        totals: &[usize],
    ) -> Result<(Vec<Candidate>, Cursor), OptimizeError> {
        let tiles = problem
            .sample_tiles()
            .map_or(1, |shape| shape.tiles * shape.instants);
        let most = (BATCH_TILES / tiles.max(1)).clamp(1, BATCH);
        let mut batch = Vec::new();
        let mut at = self.cursor;
        let end = problem.end_of_part(at);
        while let Some(&satellites) = totals.get(at.level) {
            let all = problem.with_total(satellites);
            while let Some(counts) = all.get(at.counts) {
                let part = problem.part(counts);
                let points = part.count()?;
                while at.point < points {
                    if batch.len() == most || at.walked == end {
                        return Ok((batch, at));
                    }
                    if let Some(genome) = problem.genome(&part, at.point)? {
                        let number = self.tried_in_part + batch.len() as u64;
                        batch.push(Candidate {
                            satellites,
                            genome,
                            is_scout: number.is_multiple_of(SCOUT_EVERY),
                        });
                    }
                    at.point += 1;
                    at.walked += 1;
                }
                at = at.with_next_counts();
            }
            at = at.with_next_level();
            if batch.len() >= SMALL_BATCH.min(most) || at.walked == end {
                break;
            }
        }
        Ok((batch, at))
    }

    /// Whether the search ends before a number of satellites: it is beyond the slack, and not the next one after the
    /// fewest.
    pub(super) fn is_beyond(&self, satellites: usize) -> bool {
        let Some(fewest) = self.fewest() else {
            return false;
        };
        let is_next = self
            .levels
            .iter()
            .all(|level| level.satellites <= fewest || level.satellites >= satellites);
        satellites > fewest + self.slack && !is_next
    }

    /// Takes the outcome of a design, and returns its witness if it is rejected.
    fn take(
        &mut self,
        problem: &SizeProblem<'_>,
        satellites: usize,
        tried: Tried,
    ) -> Option<Witness> {
        let fewest = self.fewest();
        if self
            .levels
            .last()
            .is_none_or(|last| last.satellites != satellites)
        {
            self.levels.push(LevelSummary::new(satellites));
        }
        let all_tiles = problem
            .sample_tiles()
            .map_or(1, |shape| shape.tiles * shape.instants) as u64;
        let evaluated = tried.tiles as u64 + if tried.is_evaluated { all_tiles } else { 0 };
        let objective = self.objective();
        let level = self.levels.last_mut()?;
        level.designs += 1;
        level.begun += u64::from(tried.tiles > 0 || tried.is_evaluated);
        level.finished += u64::from(tried.is_evaluated);
        level.tiles += evaluated;
        match tried.outcome {
            TriedVerdict::Kept(design, metrics) => {
                let one = kept(problem, &design, *metrics, objective);
                let are_all_named = fewest.is_none_or(|fewest| fewest == satellites);
                level.keep(one, objective, are_all_named);
                None
            }
            TriedVerdict::Rejected(witness) => {
                level.reject(&witness);
                let saving = RuleSaving::of(&witness, all_tiles.saturating_sub(evaluated));
                saving.add_to(&mut level.savings);
                Some(*witness)
            }
        }
    }

    /// The fewest satellites that keep the constraints, once a design does.
    #[must_use]
    pub fn fewest(&self) -> Option<usize> {
        let kept = self.levels.iter().find(|level| level.kept > 0);
        kept.map(|level| level.satellites)
    }

    /// What was found for each number of satellites so far, ascending; the last may be incomplete.
    #[must_use]
    pub fn levels(&self) -> &[LevelSummary] {
        &self.levels
    }

    /// What each rule rejected.
    #[must_use]
    pub fn savings(&self) -> Vec<RuleSaving> {
        let mut all = Vec::new();
        let of_levels = self.levels.iter().flat_map(|level| &level.savings);
        for saving in of_levels {
            saving.clone().add_to(&mut all);
        }
        all
    }

    /// Designs of the grid so far.
    #[must_use]
    pub fn tried(&self) -> u64 {
        self.levels.iter().map(|level| level.designs).sum()
    }

    /// Designs of which at least one sample was evaluated.
    #[must_use]
    pub fn begun(&self) -> u64 {
        self.levels.iter().map(|level| level.begun).sum()
    }

    /// Designs that were evaluated in full.
    #[must_use]
    pub fn finished(&self) -> u64 {
        self.levels.iter().map(|level| level.finished).sum()
    }

    /// Samples that were evaluated, as a share of those of all designs so far.
    #[must_use]
    pub fn samples_share(&self, problem: &SizeProblem<'_>) -> f64 {
        let tiles: u64 = self.levels.iter().map(|level| level.tiles).sum();
        problem.samples_share(1) * tiles as f64 / self.tried().max(1) as f64
    }

    /// The number of satellites that the next step begins with, and how many points of the grid are left of it and
    /// were there, repeats included.
    #[must_use]
    pub fn next_level(&self, problem: &SizeProblem<'_>) -> Option<(usize, u64, u64)> {
        let satellites = *problem.totals().get(self.cursor.level)?;
        let counts = problem.with_total(satellites);
        let points = |part| problem.part(part).count().unwrap_or(u64::MAX);
        let all: Vec<u64> = counts.iter().map(points).collect();
        let total = all.iter().sum::<u64>();
        let before: u64 = all[..self.cursor.counts.min(all.len())].iter().sum();
        Some((satellites, total - before - self.cursor.point, total))
    }

    /// The order of the samples that was learnt so far; that of a search before its first step where it is not kept.
    pub(super) fn order(&self, problem: &SizeProblem<'_>) -> Option<SampleOrder> {
        let learnt = self.hardness.as_ref().map(Hardness::order);
        let unlearnt = || Some(Hardness::new(problem.sample_tiles()?).order());
        learnt.or_else(unlearnt)
    }

    /// The further objective.
    #[must_use]
    pub fn objective(&self) -> Option<Quantity> {
        use crate::keyword::Keyword;
        Quantity::from_keyword(self.objective.as_deref()?).ok()
    }
}

/// A design that keeps the constraints, with its margin.
fn kept(
    problem: &SizeProblem<'_>,
    design: &Design,
    metrics: Metrics,
    objective: Option<Quantity>,
) -> KeptDesign {
    let violations = problem.violations(design, &metrics);
    let margins = violations.filter_map(|(constraint, value, _)| Some(margin(constraint, value?)));
    KeptDesign {
        design: design.to_string(),
        planes: design.planes(),
        margin: margins.fold(f64::INFINITY, f64::min).min(f64::MAX),
        objective: objective.and_then(|one| problem.problem().value(one, Some(design), &metrics)),
        metrics,
    }
}

/// How far a value is inside a bound, relative to the bound (absolute for bounds below 1).
pub(super) fn margin(constraint: &Constraint, value: f64) -> f64 {
    constraint.inside(value) / constraint.bound.abs().max(1.0)
}

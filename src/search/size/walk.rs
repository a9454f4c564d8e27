//! The walk through the grid, its own checkpoint.

use super::order::{Hardness, SampleOrder};
use super::problem::{SizeProblem, Tried, TriedVerdict};
use super::witness::{RejectionBasis, Witness};
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

/// Rejected designs that are named for each number of satellites, and kept ones for a number above the fewest.
pub(super) const NAMED: usize = 3;

/// A design that keeps the constraints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptDesign {
    /// Its notation.
    pub design: String,
    /// Its planes.
    pub planes: usize,
    /// Its metrics.
    pub metrics: Metrics,
    /// The least margin of its constraints: the distance from the bound, relative to it (absolute for bounds below 1).
    pub margin: f64,
    /// The value of the further objective, if there is one.
    pub objective: Option<f64>,
}

/// The designs of one number of satellites.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelSummary {
    /// Satellites, with those that are fixed.
    pub satellites: usize,
    /// Designs of the grid.
    pub designs: u64,
    /// Of those, the ones that keep the constraints.
    pub kept: u64,
    /// Those that keep the constraints, the best first: with the fewest satellites all of them, otherwise some.
    pub best: Vec<KeptDesign>,
    /// The one of them with the best value of the further objective.
    pub best_by_objective: Option<KeptDesign>,
    /// The rejected designs that came closest, the closest first.
    pub witnesses: Vec<Witness>,
}

impl LevelSummary {
    fn new(satellites: usize) -> Self {
        Self {
            satellites,
            designs: 0,
            kept: 0,
            best: Vec::new(),
            best_by_objective: None,
            witnesses: Vec::new(),
        }
    }

    fn reject(&mut self, witness: &Witness) {
        let place = self
            .witnesses
            .iter()
            .position(|other| witness.is_closer_than(other));
        let place = place.unwrap_or(self.witnesses.len());
        if place < NAMED {
            self.witnesses.insert(place, witness.clone());
            self.witnesses.truncate(NAMED);
        }
    }

    fn keep(&mut self, one: KeptDesign, objective: Option<Quantity>, are_all_named: bool) {
        self.kept += 1;
        if let (Some(value), Some(quantity)) = (one.objective, objective) {
            let value = quantity.minimised(value);
            let best = self.best_by_objective.as_ref();
            let best = best.and_then(|best| best.objective);
            if best.is_none_or(|best| value < quantity.minimised(best)) {
                self.best_by_objective = Some(one.clone());
            }
        }
        let is_better = |other: &KeptDesign| {
            let by_margin = one.margin.total_cmp(&other.margin);
            by_margin.then(other.planes.cmp(&one.planes)).is_gt()
        };
        let place = self.best.partition_point(|other| !is_better(other));
        self.best.insert(place, one);
        if !are_all_named {
            self.best.truncate(NAMED);
        }
    }
}

/// What one rule rejected.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RuleSaving {
    /// The constraint.
    pub constraint: String,
    /// How it rejected.
    pub basis: RejectionBasis,
    /// Designs that it rejected.
    pub designs: u64,
    /// Samples of these designs that were not evaluated, in tiles.
    pub tiles_saved: u64,
}

/// Where the walk is: a number of satellites, the counts of the shells, and a point of that part of the grid.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
struct Cursor {
    level: usize,
    counts: usize,
    point: u64,
}

/// A search for the fewest satellites.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeSearch {
    slack: usize,
    objective: Option<String>,
    cursor: Cursor,
    tried: u64,
    begun: u64,
    finished: u64,
    tiles: u64,
    hardness: Option<Hardness>,
    savings: Vec<RuleSaving>,
    levels: Vec<LevelSummary>,
    is_done: bool,
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
            tried: 0,
            begun: 0,
            finished: 0,
            tiles: 0,
            hardness: problem.sample_tiles().map(Hardness::new),
            savings: Vec::new(),
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
            (None, None) => true,
            _ => false,
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
        let order = self.order();
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
        self.cursor = next;
        let next = totals.get(self.cursor.level);
        self.is_done = next.is_none_or(|satellites| self.is_beyond(*satellites));
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
        while let Some(&satellites) = totals.get(at.level) {
            let all = problem.with_total(satellites);
            while let Some(counts) = all.get(at.counts) {
                let part = problem.part(counts);
                let points = part.count()?;
                while at.point < points {
                    if batch.len() == most {
                        return Ok((batch, at));
                    }
                    if let Some(genome) = problem.genome(&part, at.point)? {
                        let number = self.tried + batch.len() as u64;
                        batch.push(Candidate {
                            satellites,
                            genome,
                            is_scout: number.is_multiple_of(SCOUT_EVERY),
                        });
                    }
                    at.point += 1;
                }
                at = Cursor {
                    counts: at.counts + 1,
                    point: 0,
                    ..at
                };
            }
            at = Cursor {
                level: at.level + 1,
                ..Cursor::default()
            };
            if batch.len() >= SMALL_BATCH.min(most) {
                break;
            }
        }
        Ok((batch, at))
    }

    /// Whether the search ends before a number of satellites: it is beyond the slack, and not the next one after the
    /// fewest.
    fn is_beyond(&self, satellites: usize) -> bool {
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
        self.tried += 1;
        self.begun += u64::from(tried.tiles > 0 || tried.is_evaluated);
        self.finished += u64::from(tried.is_evaluated);
        self.tiles += tried.tiles as u64 + if tried.is_evaluated { all_tiles } else { 0 };
        let objective = self.objective();
        let level = self.levels.last_mut()?;
        level.designs += 1;
        match tried.outcome {
            TriedVerdict::Kept(design, metrics) => {
                let one = kept(problem, &design, *metrics, objective);
                let are_all_named = fewest.is_none_or(|fewest| fewest == satellites);
                level.keep(one, objective, are_all_named);
                None
            }
            TriedVerdict::Rejected(witness) => {
                level.reject(&witness);
                let evaluated = tried.tiles as u64 + if tried.is_evaluated { all_tiles } else { 0 };
                self.save(&witness, all_tiles.saturating_sub(evaluated));
                Some(*witness)
            }
        }
    }

    fn save(&mut self, witness: &Witness, tiles_saved: u64) {
        let same = |one: &&mut RuleSaving| {
            one.basis == witness.basis && one.constraint == witness.constraint
        };
        if let Some(one) = self.savings.iter_mut().find(same) {
            one.designs += 1;
            one.tiles_saved += tiles_saved;
            return;
        }
        self.savings.push(RuleSaving {
            constraint: witness.constraint.clone(),
            basis: witness.basis,
            designs: 1,
            tiles_saved,
        });
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
    pub fn savings(&self) -> &[RuleSaving] {
        &self.savings
    }

    /// Designs of the grid so far.
    #[must_use]
    pub fn tried(&self) -> u64 {
        self.tried
    }

    /// Designs of which at least one sample was evaluated.
    #[must_use]
    pub fn begun(&self) -> u64 {
        self.begun
    }

    /// Designs that were evaluated in full.
    #[must_use]
    pub fn finished(&self) -> u64 {
        self.finished
    }

    /// Samples that were evaluated, as a share of those of all designs so far.
    #[must_use]
    pub fn samples_share(&self, problem: &SizeProblem<'_>) -> f64 {
        problem.samples_share(1) * self.tiles as f64 / self.tried.max(1) as f64
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

    /// The order of the samples that was learnt so far.
    pub(super) fn order(&self) -> Option<SampleOrder> {
        self.hardness.as_ref().map(Hardness::order)
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

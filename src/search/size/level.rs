//! What a search finds for each number of satellites.

use super::witness::{RejectionBasis, Witness};
use crate::evaluate::Metrics;
use crate::search::Quantity;
use serde::{Deserialize, Serialize};

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
    /// Designs of which at least one sample was evaluated.
    pub(super) begun: u64,
    /// Designs that were evaluated in full.
    pub(super) finished: u64,
    /// Tiles that were evaluated.
    pub(super) tiles: u64,
    /// What each rule rejected.
    pub(super) savings: Vec<RuleSaving>,
}

impl LevelSummary {
    pub(super) fn new(satellites: usize) -> Self {
        Self {
            satellites,
            designs: 0,
            kept: 0,
            best: Vec::new(),
            best_by_objective: None,
            witnesses: Vec::new(),
            begun: 0,
            finished: 0,
            tiles: 0,
            savings: Vec::new(),
        }
    }

    /// Names a rejected design, if it is among the closest.
    pub(super) fn reject(&mut self, witness: &Witness) {
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

    /// Counts a design that keeps the constraints, and names it if it is among the best.
    pub(super) fn keep(
        &mut self,
        one: KeptDesign,
        objective: Option<Quantity>,
        are_all_named: bool,
    ) {
        self.kept += 1;
        self.compare_by_objective(&one, objective);
        self.name(one, are_all_named);
    }

    fn compare_by_objective(&mut self, one: &KeptDesign, objective: Option<Quantity>) {
        let (Some(value), Some(quantity)) = (one.objective, objective) else {
            return;
        };
        let best = self.best_by_objective.as_ref();
        let best = best.and_then(|best| best.objective);
        if best.is_none_or(|best| quantity.minimised(value) < quantity.minimised(best)) {
            self.best_by_objective = Some(one.clone());
        }
    }

    fn name(&mut self, one: KeptDesign, are_all_named: bool) {
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

    /// Adds what was found in a later part of the walk, as if its designs had been tried here.
    pub(super) fn absorb(&mut self, later: Self, objective: Option<Quantity>, are_all_named: bool) {
        self.designs += later.designs;
        self.kept += later.kept;
        self.begun += later.begun;
        self.finished += later.finished;
        self.tiles += later.tiles;
        later.witnesses.iter().for_each(|one| self.reject(one));
        if let Some(one) = &later.best_by_objective {
            self.compare_by_objective(one, objective);
        }
        for one in later.best {
            self.name(one, are_all_named);
        }
        for saving in later.savings {
            saving.add_to(&mut self.savings);
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

impl RuleSaving {
    /// Of one design.
    pub(super) fn of(witness: &Witness, tiles_saved: u64) -> Self {
        Self {
            constraint: witness.constraint.clone(),
            basis: witness.basis,
            designs: 1,
            tiles_saved,
        }
    }

    /// Adds it to those of all rules, in the order in which they first rejected a design.
    pub(super) fn add_to(self, all: &mut Vec<Self>) {
        let same = |one: &&mut Self| one.basis == self.basis && one.constraint == self.constraint;
        match all.iter_mut().find(same) {
            Some(one) => {
                one.designs += self.designs;
                one.tiles_saved += self.tiles_saved;
            }
            None => all.push(self),
        }
    }
}

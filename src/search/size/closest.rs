//! The designs of a number of satellites that violate the constraints least, found as exactly as the fewest satellites
//! are: a design is left at the first moment when its samples prove that it violates a constraint by more than the best
//! so far violate all of them.

use super::level::{LevelSummary, NAMED};
use super::order::SampleOrder;
use super::problem::SizeProblem;
use super::rules::RuleSet;
use super::trial::Trial;
use super::walk::{BATCH, SizeSearch};
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::optimize::OptimizeError;
use rayon::prelude::*;

/// One of the designs of a number of satellites that come closest to keeping the constraints.
#[derive(Debug, Clone, PartialEq)]
pub struct ClosestDesign {
    /// Satellites, with those that are fixed.
    pub satellites: usize,
    /// The design.
    pub design: Design,
    /// Its metrics.
    pub metrics: Metrics,
    /// Sum of the violations of the constraints.
    pub violation: f64,
    pub(super) genome: Vec<f64>,
}

impl SizeProblem<'_> {
    /// The designs of a finished level that violate the constraints least, the best first, of equals those that come
    /// first in the grid; `None` if `is_stopped` says so before the end. All of the level must have been rejected.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn closest(
        &self,
        search: &SizeSearch,
        level: &LevelSummary,
        is_stopped: &dyn Fn() -> bool,
    ) -> Result<Option<Vec<ClosestDesign>>, OptimizeError> {
        let order = search.order(self);
        let mut bar = self.violation_of_named(level);
        let mut closest: Vec<ClosestDesign> = Vec::new();
        let mut genomes = self.genomes(level.satellites);
        loop {
            let batch: Vec<Vec<f64>> = genomes.by_ref().take(BATCH).collect::<Result<_, _>>()?;
            if batch.is_empty() {
                return Ok(Some(closest));
            }
            if is_stopped() {
                return Ok(None);
            }
            let rules = self.rules_beyond(bar);
            let attempts: Vec<Option<ClosestDesign>> = batch
                .par_iter()
                .map(|genome| self.attempted(genome, bar, rules.as_ref(), order.as_ref()))
                .collect();
            for one in attempts.into_iter().flatten() {
                let place = closest.partition_point(|other| other.violation <= one.violation);
                closest.insert(place, one);
                closest.truncate(NAMED);
            }
            if let Some(last) = closest.get(NAMED - 1) {
                bar = bar.min(last.violation);
            }
        }
    }

    /// The largest violation of the designs that a level names, if there are as many as are looked for: the last of the
    /// closest is at most that far.
    fn violation_of_named(&self, level: &LevelSummary) -> f64 {
        let violation = |notation: &str| {
            let design: Design = notation.parse().ok()?;
            let metrics = self.assessed(&design)?;
            Some(self.violation(&design, &metrics))
        };
        let named = level.witnesses.iter();
        let all: Option<Vec<f64>> = named.map(|one| violation(&one.design)).collect();
        match all {
            Some(all) if all.len() == NAMED => all.into_iter().fold(0.0, f64::max),
            _ => f64::INFINITY,
        }
    }

    fn violation(&self, design: &Design, metrics: &Metrics) -> f64 {
        let all = self.violations(design, metrics);
        all.map(|(.., violation)| violation).sum()
    }

    /// A design, unless it is proved to violate the constraints by more than `bar`.
    fn attempted(
        &self,
        genome: &[f64],
        bar: f64,
        rules: Option<&RuleSet>,
        order: Option<&SampleOrder>,
    ) -> Option<ClosestDesign> {
        let problem = self.problem();
        let design = problem.designs().design(genome).ok().flatten()?;
        if self.violation_by_shells(&design) > bar {
            return None;
        }
        let ephemeris = problem.with_fixed(Some(&design))?;
        if let (Some(rules), Some(order)) = (rules, order) {
            let mut trial = Trial::new(rules, ephemeris.satellites().len());
            if trial.rejection().is_none() {
                self.probe(&ephemeris, order, false, &mut trial);
            }
            if trial.rejection().is_some() {
                return None;
            }
        }
        let metrics = problem.metrics_of(&ephemeris)?;
        Some(ClosestDesign {
            satellites: design.satellite_count() + self.satellites_beside(),
            violation: self.violation(&design, &metrics),
            design,
            metrics,
            genome: genome.to_vec(),
        })
    }
}

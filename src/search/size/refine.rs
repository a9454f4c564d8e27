//! What lies between the steps of the grid: the best design around one of its points.
//!
//! A pattern search (R. Hooke, T. A. Jeeves, "Direct search solution of numerical and statistical problems", Journal of
//! the ACM 8(2), 1961, its exploratory moves): one variable at a time is moved up and down by half a step of the grid, the
//! best move is taken, and where none is better the move is halved. The quantities are shares of samples and order
//! statistics, so they have no useful derivative. What it finds is evidence: another design between the steps may be better.

use super::closest::ClosestDesign;
use super::problem::SizeProblem;
use super::walk::margin;
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::optimize::{OptimizeError, Problem, VariableKind};
use rayon::prelude::*;

/// How often the first move, half a step of the grid, is halved.
const HALVINGS: i32 = 4;

/// Designs that are evaluated around a point, at most.
const MOST: u64 = 200;

/// The best design around a point of the grid.
#[derive(Debug, Clone, PartialEq)]
pub struct RefinedDesign {
    /// Satellites, with those that are fixed.
    pub satellites: usize,
    /// Notation of the point of the grid.
    pub from: String,
    /// The best design.
    pub design: Design,
    /// Its metrics.
    pub metrics: Metrics,
    /// Sum of its violations of the constraints.
    pub violation: f64,
    /// Designs that were evaluated.
    pub evaluations: u64,
}

/// A point on the way.
struct RefinedPoint {
    genome: Vec<f64>,
    design: Design,
    metrics: Metrics,
    violation: f64,
    /// Minus the violation, or the least margin of what keeps the constraints.
    score: f64,
}

impl SizeProblem<'_> {
    /// The best designs around rejected ones.
    #[must_use]
    pub fn refined_closest(&self, closest: &[ClosestDesign]) -> Vec<RefinedDesign> {
        let refined = closest.iter().filter_map(|one| self.refined(&one.genome));
        refined.collect()
    }

    /// The best designs around some of the grid with so many satellites.
    ///
    /// # Errors
    /// If a part of the grid has more than 2^53 points.
    pub fn refined_designs(
        &self,
        satellites: usize,
        designs: &[Design],
    ) -> Result<Vec<RefinedDesign>, OptimizeError> {
        let mut refined = vec![None; designs.len()];
        for genome in self.genomes(satellites) {
            let genome = genome?;
            let design = self.problem().designs().design(&genome).ok().flatten();
            let place = designs.iter().position(|one| Some(one) == design.as_ref());
            if let Some(place) = place.filter(|place| refined[*place].is_none()) {
                refined[place] = self.refined(&genome);
            }
        }
        Ok(refined.into_iter().flatten().collect())
    }

    fn refined(&self, start: &[f64]) -> Option<RefinedDesign> {
        let mut at = self.point(start.to_vec())?;
        let from = at.design.to_string();
        let steps = self.problem().designs().steps();
        let mut evaluations = 1;
        let mut halvings = 1;
        while halvings <= HALVINGS && evaluations < MOST {
            let moves = self.moves(&at.genome, &steps, 0.5_f64.powi(halvings));
            evaluations += moves.len() as u64;
            let reached: Vec<Option<RefinedPoint>> = moves
                .into_par_iter()
                .map(|genome| self.point(genome))
                .collect();
            let better = reached
                .into_iter()
                .flatten()
                .filter(|one| one.score > at.score);
            // The first of equals, whatever the threads.
            match better.reduce(|best, one| if one.score > best.score { one } else { best }) {
                Some(best) => at = best,
                None => halvings += 1,
            }
        }
        Some(RefinedDesign {
            satellites: at.design.satellite_count() + self.satellites_beside(),
            from,
            design: at.design,
            metrics: at.metrics,
            violation: at.violation,
            evaluations,
        })
    }

    /// Each real variable a part of its step up and down, inside the space.
    fn moves(&self, genome: &[f64], steps: &[f64], part: f64) -> Vec<Vec<f64>> {
        let problem = self.problem();
        let variables = problem.space().variables().iter().enumerate();
        let is_free = |(n, kind): &(usize, VariableKind)| {
            matches!(kind, VariableKind::Real { lo, hi } if lo < hi)
                && !problem.designs().is_idle(genome, *n)
        };
        let free = variables
            .map(|(n, variable)| (n, variable.kind))
            .filter(is_free);
        let moved = |(n, _): (usize, VariableKind)| {
            [1.0, -1.0].map(|sign| {
                let mut moved = genome.to_vec();
                moved[n] += sign * part * steps[n];
                problem.space().clamp(&mut moved);
                problem.repair(&mut moved);
                moved
            })
        };
        free.flat_map(moved)
            .filter(|moved| moved != genome)
            .collect()
    }

    fn point(&self, genome: Vec<f64>) -> Option<RefinedPoint> {
        let (design, metrics) = self.problem().evaluated(&genome)?;
        let design = design?;
        let (mut violation, mut least) = (0.0, f64::INFINITY);
        for (constraint, value, of_one) in self.violations(&design, &metrics) {
            violation += of_one;
            if let Some(value) = value {
                least = least.min(margin(constraint, value));
            }
        }
        Some(RefinedPoint {
            genome,
            score: if violation > 0.0 { -violation } else { least },
            design,
            metrics,
            violation,
        })
    }
}

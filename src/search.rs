//! The adapter between the optimisers, which work on vectors, and the evaluator, which works on
//! designs.

mod constraint;
mod fixed;
mod quantity;
mod shell_space;
pub mod size;
mod space;

pub use constraint::{Constraint, ConstraintError, Relation};
pub use quantity::{LaunchCost, Quantity};
pub use shell_space::{ShellSpace, SweepSteps};
pub use space::DesignSpace;

use crate::constellation::{Design, Shell};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Metrics};
use crate::optimize::{Evaluation, OptimizeError, Problem, Space};
use fixed::FixedSatellites;
use rayon::prelude::*;

/// The goals of a search.
#[derive(Debug, Clone, PartialEq)]
pub struct Goals {
    /// Quantities to optimise, each in its own direction.
    pub objectives: Vec<Quantity>,
    /// Bounds that a feasible design must meet.
    pub constraints: Vec<Constraint>,
    /// Parameters of the launch cost.
    pub launch_cost: LaunchCost,
    /// Shells that are there already, so that they are not new and cost no launch.
    pub fixed: Option<Design>,
}

impl Goals {
    /// The constrained quantities that are not objectives, each once.
    #[must_use]
    pub fn constrained(&self) -> Vec<Quantity> {
        let mut found: Vec<Quantity> = Vec::new();
        for Constraint { quantity, .. } in &self.constraints {
            if !self.objectives.contains(quantity) && !found.contains(quantity) {
                found.push(*quantity);
            }
        }
        found
    }

    /// The value of a quantity for some satellites, which are those of a design if there is one; `None` if there
    /// is none.
    #[must_use]
    pub fn value(
        &self,
        quantity: Quantity,
        (satellites, design): (usize, Option<&Design>),
        metrics: &Metrics,
    ) -> Option<f64> {
        let new = design.map(|design| self.new_shells(design));
        quantity.value(
            satellites,
            design,
            new.as_deref(),
            metrics,
            &self.launch_cost,
        )
    }

    /// The shells of a design that are not fixed; all of them if it lacks one that is.
    fn new_shells<'d>(&self, design: &'d Design) -> Vec<&'d Shell> {
        let mut fixed: Vec<&Shell> = self.fixed.iter().flat_map(Design::shells).collect();
        let is_new = |shell: &&Shell| match fixed.iter().position(|one| one == shell) {
            Some(place) => {
                fixed.swap_remove(place);
                false
            }
            None => true,
        };
        let new = design.shells().iter().filter(is_new).collect();
        if fixed.is_empty() {
            new
        } else {
            design.shells().iter().collect()
        }
    }
}

/// A design problem as the optimisers see it.
pub struct DesignProblem<'a> {
    evaluator: &'a Evaluator,
    designs: DesignSpace,
    fixed: FixedSatellites,
    space: Space,
    goals: Goals,
    names: Vec<String>,
}

impl<'a> DesignProblem<'a> {
    /// The search for `goals` among `designs`.
    ///
    /// # Errors
    /// If an interval of the space is reversed.
    pub fn new(
        evaluator: &'a Evaluator,
        designs: DesignSpace,
        goals: Goals,
    ) -> Result<Self, OptimizeError> {
        let space = designs.vectors()?;
        let names = goals.objectives.iter().map(ToString::to_string).collect();
        Ok(Self {
            evaluator,
            designs,
            fixed: FixedSatellites::default(),
            space,
            goals,
            names,
        })
    }

    /// The same search with satellites that every design has beside its own; their states at the samples are
    /// computed once.
    ///
    /// # Errors
    /// If one of them cannot be propagated.
    pub fn with_satellites(self, fixed: &Ephemeris) -> Result<Self, EphemerisError> {
        let fixed = FixedSatellites::new(fixed)?;
        Ok(Self { fixed, ..self })
    }

    /// What evaluates the designs.
    #[must_use]
    pub fn evaluator(&self) -> &'a Evaluator {
        self.evaluator
    }

    /// The goals of the search.
    #[must_use]
    pub fn goals(&self) -> &Goals {
        &self.goals
    }

    /// The search space.
    #[must_use]
    pub fn designs(&self) -> &DesignSpace {
        &self.designs
    }

    /// Number of satellites that every design has beside its own, without those of its fixed shells.
    #[must_use]
    pub fn satellites_beside(&self) -> usize {
        self.fixed.len()
    }

    /// A design and its metrics, for a vector of the space; `None` if it cannot be propagated.
    #[must_use]
    pub fn evaluated(&self, genome: &[f64]) -> Option<(Design, Metrics)> {
        let design = self.designs.design(genome).ok()?;
        let ephemeris = self.ephemeris(&design)?;
        let metrics = self.evaluator.evaluate_ephemeris(&ephemeris).ok()?;
        Some((design, metrics))
    }

    /// A design with the satellites that are beside it; `None` if it cannot be propagated.
    fn ephemeris(&self, design: &Design) -> Option<Ephemeris> {
        let setup = self.evaluator.setup();
        let own = Ephemeris::of_design(design, setup.model, setup.grid).ok()?;
        Some(if self.fixed.is_empty() {
            own
        } else {
            self.fixed.join_to(own)
        })
    }

    /// The value of a quantity of the shells for a design with what is fixed; `None` for any other quantity.
    fn value_of_shells(&self, quantity: Quantity, design: &Design) -> Option<f64> {
        let satellites = design.satellite_count() + self.fixed.len();
        let new = self.goals.new_shells(design);
        quantity.of_shells(
            satellites,
            Some(design),
            Some(&new),
            &self.goals.launch_cost,
        )
    }

    /// The value of a quantity for a design that was evaluated with what is fixed.
    #[must_use]
    pub fn value(&self, quantity: Quantity, design: &Design, metrics: &Metrics) -> Option<f64> {
        let satellites = design.satellite_count() + self.fixed.len();
        self.goals
            .value(quantity, (satellites, Some(design)), metrics)
    }

    fn answer(&self, genome: &[f64]) -> Evaluation {
        let Some((design, metrics)) = self.evaluated(genome) else {
            let objectives = vec![f64::INFINITY; self.goals.objectives.len()];
            return Evaluation {
                objectives,
                violation: 2.0,
            };
        };
        self.judge(
            &|quantity| self.value(quantity, &design, &metrics),
            &metrics,
        )
    }

    /// The metrics of a design, which need not be in the space, and their evaluation for an
    /// optimiser; `None` if it cannot be propagated.
    #[must_use]
    pub fn judged(&self, design: &Design) -> Option<(Metrics, Evaluation)> {
        let metrics = self.evaluator.evaluate(design).ok()?;
        let satellites = (design.satellite_count(), Some(design));
        let evaluation = self.judge(&|one| self.goals.value(one, satellites, &metrics), &metrics);
        Some((metrics, evaluation))
    }

    /// The metrics of any satellites, which are those of a design if there is one, and their evaluation as for
    /// an optimiser.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn judged_ephemeris(
        &self,
        ephemeris: &Ephemeris,
        design: Option<&Design>,
    ) -> Result<(Metrics, Evaluation), EphemerisError> {
        let metrics = self.evaluator.evaluate_ephemeris(ephemeris)?;
        let satellites = (ephemeris.satellites().len(), design);
        let evaluation = self.judge(&|one| self.goals.value(one, satellites, &metrics), &metrics);
        Ok((metrics, evaluation))
    }

    fn judge(&self, value: &dyn Fn(Quantity) -> Option<f64>, metrics: &Metrics) -> Evaluation {
        let mut violation: f64 = self
            .goals
            .constraints
            .iter()
            .map(|c| c.violation(value(c.quantity), c.quantity.solved_fraction(metrics)))
            .sum();
        // A design is infeasible if unsolved samples make an objective infinite.
        let unsolved = |quantity: &Quantity| {
            let solved = quantity.solved_fraction(metrics);
            quantity.unsolved_share(solved)
        };
        violation += self
            .goals
            .objectives
            .iter()
            .map(unsolved)
            .fold(0.0, f64::max);
        let minimised = |objective: &Quantity| match value(*objective) {
            Some(value) => objective.minimised(value),
            None => f64::INFINITY,
        };
        let objectives: Vec<f64> = self.goals.objectives.iter().map(minimised).collect();
        if objectives.iter().any(|objective| objective.is_infinite()) {
            violation = violation.max(1.0);
        }
        Evaluation {
            objectives,
            violation,
        }
    }
}

impl Problem for DesignProblem<'_> {
    fn space(&self) -> &Space {
        &self.space
    }

    fn objective_names(&self) -> &[String] {
        &self.names
    }

    fn repair(&self, genome: &mut [f64]) {
        self.designs.repair(genome);
    }

    fn unify(&self, genome: &mut [f64]) {
        self.designs.unify(genome);
    }

    /// Parallel over the designs; results are in the order of the batch.
    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        batch.par_iter().map(|genome| self.answer(genome)).collect()
    }
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

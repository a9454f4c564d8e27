//! The adapter between the optimisers, which work on vectors, and the evaluator, which works on
//! designs.

mod constraint;
mod counted;
pub mod failures;
mod fixed;
mod quantity;
mod recording;
mod shell_space;
pub mod size;
mod space;
mod spares;

pub use constraint::{Constraint, ConstraintError, Relation};
pub use counted::CountedSatellites;
pub use quantity::{LaunchCost, Quantity};
pub use recording::{RecordedEvaluation, RecordingProblem};
pub use shell_space::{IntervalOr, ShellSpace, SweepSteps};
pub use space::DesignSpace;
pub use spares::SparedPlanes;

use crate::constellation::Design;
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
    /// Number of satellites from files that are there already.
    pub fixed_from_files: usize,
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

    /// The value of a quantity for the satellites of a constellation; `None` if there is none.
    #[must_use]
    pub fn value(
        &self,
        quantity: Quantity,
        satellites: CountedSatellites<'_>,
        metrics: &Metrics,
    ) -> Option<f64> {
        let new = satellites.without_fixed(self);
        quantity.value(satellites, &new, metrics, &self.launch_cost)
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
    pub fn with_satellites(mut self, fixed: &Ephemeris) -> Result<Self, EphemerisError> {
        self.fixed = FixedSatellites::new(fixed)?;
        self.goals.fixed_from_files = self.fixed.len();
        Ok(self)
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

    /// A design and its metrics, for a vector of the space; `None` if it cannot be propagated or has no satellite.
    ///
    /// The design is `None` for a vector whose shells are all empty beside satellites that are fixed.
    #[must_use]
    pub fn evaluated(&self, genome: &[f64]) -> Option<(Option<Design>, Metrics)> {
        let design = self.designs.design(genome).ok()?;
        let metrics = self.metrics(design.as_ref())?;
        Some((design, metrics))
    }

    /// The metrics of a design of the space, its fixed shells included, with the satellites that are fixed beside it; `None`
    /// if it cannot be propagated or there is no satellite.
    #[must_use]
    pub fn metrics(&self, design: Option<&Design>) -> Option<Metrics> {
        let metrics = match design {
            Some(design) if self.fixed.is_empty() => self.evaluator.evaluate(design),
            _ => {
                let all = self.with_fixed(design)?;
                self.evaluator.evaluate_ephemeris(&all)
            }
        };
        self.with_gain(metrics.ok()?).ok()
    }

    /// The satellites of a design and those that are fixed beside it; `None` if there are none.
    fn with_fixed(&self, design: Option<&Design>) -> Option<Ephemeris> {
        let setup = self.evaluator.setup();
        let Some(design) = design else {
            return self.fixed.ephemeris();
        };
        let own = Ephemeris::of_design(design, setup.model, setup.grid).ok()?;
        Some(match self.fixed.ephemeris() {
            Some(fixed) => own.joined(fixed),
            None => own,
        })
    }

    /// The value of a quantity for a design that was evaluated with what is fixed.
    #[must_use]
    pub fn value(
        &self,
        quantity: Quantity,
        design: Option<&Design>,
        metrics: &Metrics,
    ) -> Option<f64> {
        self.goals.value(quantity, self.counted(design), metrics)
    }

    /// The value of a quantity of the shells for a design with what is fixed; `None` for any other quantity.
    fn value_of_shells(&self, quantity: Quantity, design: &Design) -> Option<f64> {
        let satellites = self.counted(Some(design));
        let new = satellites.without_fixed(&self.goals);
        quantity.of_shells(satellites, &new, &self.goals.launch_cost)
    }

    /// The satellites of a design and those that are fixed beside it.
    fn counted<'d>(&self, design: Option<&'d Design>) -> CountedSatellites<'d> {
        CountedSatellites {
            shells: design,
            from_files: self.fixed.len(),
            has_fixed_files: true,
        }
    }

    fn answer(&self, genome: &[f64]) -> Evaluation {
        self.evaluation(self.evaluated(genome).as_ref())
    }

    /// The evaluation for an optimiser of what [`Self::evaluated`] gives.
    #[must_use]
    pub fn evaluation(&self, evaluated: Option<&(Option<Design>, Metrics)>) -> Evaluation {
        let Some((design, metrics)) = evaluated else {
            let objectives = vec![f64::INFINITY; self.goals.objectives.len()];
            return Evaluation {
                objectives,
                violation: 2.0,
            };
        };
        self.judge(
            &|quantity| self.value(quantity, design.as_ref(), metrics),
            metrics,
        )
    }

    /// Metrics with the gain over the GNSS alone, which is the same in the whole search.
    fn with_gain(&self, metrics: Metrics) -> Result<Metrics, EphemerisError> {
        self.evaluator.with_gain(metrics)
    }

    /// The metrics of some satellites with their gain; `None` if they cannot be propagated.
    fn metrics_of(&self, ephemeris: &Ephemeris) -> Option<Metrics> {
        let metrics = self.evaluator.evaluate_ephemeris(ephemeris).ok()?;
        self.with_gain(metrics).ok()
    }

    /// The metrics of a design, which need not be in the space, and their evaluation for an
    /// optimiser; `None` if it cannot be propagated.
    #[must_use]
    pub fn judged(&self, design: &Design) -> Option<(Metrics, Evaluation)> {
        let metrics = self.with_gain(self.evaluator.evaluate(design).ok()?).ok()?;
        let satellites = CountedSatellites::of_design(design);
        let evaluation = self.judge(&|one| self.goals.value(one, satellites, &metrics), &metrics);
        Some((metrics, evaluation))
    }

    /// The metrics of the satellites of any constellation, and their evaluation as for an optimiser.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn judged_ephemeris(
        &self,
        ephemeris: &Ephemeris,
        satellites: CountedSatellites<'_>,
    ) -> Result<(Metrics, Evaluation), EphemerisError> {
        let metrics = self.with_gain(self.evaluator.evaluate_ephemeris(ephemeris)?)?;
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

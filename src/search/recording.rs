//! A search that keeps what it evaluates.

use super::DesignProblem;
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::optimize::{Evaluation, Problem, Space};
use rayon::prelude::*;
use std::cell::RefCell;

/// A vector that a search evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedEvaluation {
    /// One value per variable.
    pub genome: Vec<f64>,
    /// Its design, `None` for one whose shells are all empty, and the metrics; `None` if it cannot be propagated.
    pub evaluated: Option<(Option<Design>, Metrics)>,
    /// How far the constraints are from being kept.
    pub violation: f64,
}

/// A design problem that keeps every evaluation until it is taken.
pub struct RecordingProblem<'a> {
    problem: &'a DesignProblem<'a>,
    records: RefCell<Vec<RecordedEvaluation>>,
}

impl<'a> RecordingProblem<'a> {
    /// The same problem, with nothing evaluated yet.
    #[must_use]
    pub fn new(problem: &'a DesignProblem<'a>) -> Self {
        Self {
            problem,
            records: RefCell::default(),
        }
    }

    /// The evaluations since the last call, in their order.
    pub fn take(&self) -> Vec<RecordedEvaluation> {
        self.records.take()
    }
}

impl Problem for RecordingProblem<'_> {
    fn space(&self) -> &Space {
        self.problem.space()
    }

    fn objective_names(&self) -> &[String] {
        self.problem.objective_names()
    }

    fn repair(&self, genome: &mut [f64]) {
        self.problem.repair(genome);
    }

    fn unify(&self, genome: &mut [f64]) {
        self.problem.unify(genome);
    }

    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        let one = |genome: &Vec<f64>| {
            let evaluated = self.problem.evaluated(genome);
            let evaluation = self.problem.evaluation(evaluated.as_ref());
            let record = RecordedEvaluation {
                genome: genome.clone(),
                evaluated,
                violation: evaluation.violation,
            };
            (evaluation, record)
        };
        let both: Vec<_> = batch.par_iter().map(one).collect();
        let (answers, records): (Vec<_>, Vec<_>) = both.into_iter().unzip();
        self.records.borrow_mut().extend(records);
        answers
    }
}

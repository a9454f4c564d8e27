//! The front of what a search evaluated, for goals that may be others than its own.

use super::diagnostics::diagnose_front;
use super::results::{fixed, front_members};
use super::shown;
use crate::keyword::Keyword;
use crate::optimize::{Individual, Problem, front_of};
use crate::run::{Diagnostic, Hypervolume, OptimizeResult, ScenarioStamp, SearchSummary, VERSION};
use crate::scenario::Scenario;
use crate::search::{DesignProblem, Quantity, RecordedEvaluation};
use crate::units::counted;
use thiserror::Error;

/// A quantity of which the evaluations of a search have no value.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "objectives: {quantity} has no value in any of the {evaluations}: a search computes it where its scenario asks for it; \
     those with values are {}",
    .has.join(", ")
)]
pub struct NotEvaluated {
    /// The quantity.
    pub quantity: Quantity,
    /// How many there are, in words.
    pub evaluations: String,
    /// The quantities that have values.
    pub has: Vec<String>,
}

impl OptimizeResult {
    /// The front of all evaluations of a search for the goals of `problem`. Nothing is evaluated.
    ///
    /// # Errors
    /// If no evaluation has a value of a quantity that is optimised or bounded.
    pub fn of_evaluations(
        problem: &DesignProblem<'_>,
        evaluations: &[RecordedEvaluation],
        scenario: &Scenario,
        stamp: ScenarioStamp,
    ) -> Result<Self, NotEvaluated> {
        let mut front = EvaluatedFront::new(EvaluationSource::Search);
        front.offer(problem, evaluations)?;
        Ok(front.result(problem, scenario, stamp))
    }
}

/// Where evaluations come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EvaluationSource {
    /// A search for goals of its own.
    Search,
    /// A sweep of the search space.
    Space,
    /// A sweep of a list, whose designs have numbers in place of vectors of the search space.
    List,
}

/// The front of evaluations that come in parts.
#[derive(Debug, Clone)]
pub struct EvaluatedFront {
    source: EvaluationSource,
    evaluations: usize,
    candidates: Vec<(Individual, RecordedEvaluation)>,
}

impl EvaluatedFront {
    /// The front of no evaluations yet.
    #[must_use]
    pub fn new(source: EvaluationSource) -> Self {
        Self {
            source,
            evaluations: 0,
            candidates: Vec::new(),
        }
    }

    /// Takes the next evaluations, of which those that are not dominated are kept.
    ///
    /// # Errors
    /// If no evaluation of the first part has a value of a quantity that is optimised or bounded.
    pub fn offer(
        &mut self,
        problem: &DesignProblem<'_>,
        evaluations: &[RecordedEvaluation],
    ) -> Result<(), NotEvaluated> {
        if self.evaluations == 0 {
            check_values(problem, evaluations)?;
        }
        self.evaluations += evaluations.len();
        let judged = |one: &RecordedEvaluation| {
            let mut individual = judged(problem, one);
            if self.source != EvaluationSource::List {
                // The vector that stands for the design.
                problem.unify(&mut individual.genome);
            }
            (individual, one.clone())
        };
        let further: Vec<_> = evaluations.iter().map(judged).collect();
        let mut all = std::mem::take(&mut self.candidates);
        all.extend(further);
        let members = front_of(all.iter().map(|(individual, _)| individual.clone()));
        let of_member = |member: Individual| {
            let found = all.iter().find(|(one, _)| one.genome == member.genome)?;
            Some((member, found.1.clone()))
        };
        self.candidates = members.into_iter().filter_map(of_member).collect();
        Ok(())
    }

    /// The result, for the goals of `problem`.
    #[must_use]
    pub fn result(
        self,
        problem: &DesignProblem<'_>,
        scenario: &Scenario,
        stamp: ScenarioStamp,
    ) -> OptimizeResult {
        let (source, evaluations) = (self.source, self.evaluations);
        let (individuals, records): (Vec<Individual>, Vec<RecordedEvaluation>) =
            self.candidates.into_iter().unzip();
        let evaluated = records.into_iter().map(|one| one.evaluated).collect();
        let points: Vec<&[f64]> = individuals
            .iter()
            .map(|a| a.objectives.as_slice())
            .collect();
        let written = scenario.minimised_reference();
        let objectives = &scenario.objectives.minimize;
        let hypervolume = Hypervolume::of(&points, written.as_deref(), None, objectives);
        let front = front_members(problem, &individuals, &points, evaluated);
        let mut diagnostics = vec![told_source(source, evaluations)];
        diagnostics.extend(diagnose_front(problem, &front, &individuals, source));
        diagnostics.extend(shown::unused_reference(&hypervolume));
        OptimizeResult {
            search: SearchSummary {
                evaluations: evaluations as u64,
                hypervolume,
                seed: scenario.optimizer.seed,
                algorithm: scenario.optimizer.algorithm.to_string(),
                generations: [0, 0],
                fixed: fixed(problem, scenario),
                diagnostics,
                certificate: None,
                scenario: stamp,
                version: VERSION.to_owned(),
            },
            front,
            history: Vec::new(),
            chosen_reference: None,
        }
    }
}

/// An evaluation as the optimisers see it.
fn judged(problem: &DesignProblem<'_>, one: &RecordedEvaluation) -> Individual {
    let evaluation = problem.evaluation(one.evaluated.as_ref());
    Individual {
        genome: one.genome.clone(),
        objectives: evaluation.objectives,
        violation: evaluation.violation,
    }
}

fn check_values(
    problem: &DesignProblem<'_>,
    evaluations: &[RecordedEvaluation],
) -> Result<(), NotEvaluated> {
    let has_value = |quantity: Quantity| {
        let mut all = evaluations.iter().filter_map(|one| one.evaluated.as_ref());
        all.any(|(design, metrics)| problem.value(quantity, design.as_ref(), metrics).is_some())
    };
    let goals = problem.goals();
    let mut asked = goals.objectives.iter().copied().chain(goals.constrained());
    match asked.find(|quantity| !has_value(*quantity)) {
        None => Ok(()),
        Some(quantity) => Err(NotEvaluated {
            quantity,
            evaluations: counted(evaluations.len(), "evaluation"),
            has: Quantity::ALL
                .iter()
                .filter(|one| has_value(**one))
                .map(ToString::to_string)
                .collect(),
        }),
    }
}

fn told_source(source: EvaluationSource, evaluations: usize) -> Diagnostic {
    let text = match source {
        EvaluationSource::Search => format!(
            "the front of {} that a search made for the goals of its own scenario; a search for these may find better designs",
            counted(evaluations, "evaluation")
        ),
        EvaluationSource::Space => format!(
            "the front of all {} of a sweep: exact for its grid",
            counted(evaluations, "design")
        ),
        EvaluationSource::List => format!(
            "the front of the {} of a list",
            counted(evaluations, "design")
        ),
    };
    Diagnostic::new("from-evaluations", text)
}

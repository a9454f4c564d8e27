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
        check_values(problem, evaluations)?;
        let candidates: Vec<Individual> =
            evaluations.iter().map(|one| judged(problem, one)).collect();
        let individuals = front_of(candidates.iter().cloned());
        let of_member = |member: &Individual| {
            let place = candidates
                .iter()
                .position(|one| one.genome == member.genome)?;
            evaluations[place].evaluated.clone()
        };
        let evaluated = individuals.iter().map(of_member).collect();
        let points: Vec<&[f64]> = individuals
            .iter()
            .map(|a| a.objectives.as_slice())
            .collect();
        let written = scenario.minimised_reference();
        let objectives = &scenario.objectives.minimize;
        let hypervolume = Hypervolume::of(&points, written.as_deref(), None, objectives);
        let front = front_members(problem, &individuals, &points, evaluated);
        let mut diagnostics = vec![of_other_goals(evaluations.len())];
        diagnostics.extend(diagnose_front(problem, &front, &individuals));
        diagnostics.extend(shown::unused_reference(&hypervolume));
        Ok(Self {
            search: SearchSummary {
                evaluations: evaluations.len() as u64,
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
        })
    }
}

/// An evaluation as the optimisers see it, its vector the one that stands for its design.
fn judged(problem: &DesignProblem<'_>, one: &RecordedEvaluation) -> Individual {
    let evaluation = problem.evaluation(one.evaluated.as_ref());
    let mut genome = one.genome.clone();
    problem.unify(&mut genome);
    Individual {
        genome,
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

fn of_other_goals(evaluations: usize) -> Diagnostic {
    Diagnostic::new(
        "from-evaluations",
        format!(
            "the front of {} that a search made for the goals of its own scenario; a search for these may find better designs",
            counted(evaluations, "evaluation")
        ),
    )
}

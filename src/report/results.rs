//! The objects that `--format json` prints, made from what was computed.

use super::{diagnose, dominated_by};
use crate::constellation::Design;
use crate::evaluate::{DopStatistics, Metrics};
use crate::optimize::{Individual, Search, Strategy, best, fuzzy, hypervolume};
use crate::run::{
    Certificate, DesignSummary, FrontMember, Hypervolume, OptimizeResult, ScenarioStamp,
    SearchSummary, VERSION,
};
use crate::scenario::Scenario;
use crate::search::{DesignProblem, Quantity};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The output of `evaluate`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluateResult {
    /// The design.
    pub design: DesignSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// All dilutions of precision, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dops: Option<DopStatistics>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

impl EvaluateResult {
    /// The result of one design.
    #[must_use]
    pub fn new(
        design: &Design,
        metrics: Metrics,
        dops: Option<DopStatistics>,
        scenario: ScenarioStamp,
    ) -> Self {
        Self {
            design: design.into(),
            metrics,
            dops,
            scenario,
            version: VERSION,
        }
    }
}

/// A constellation read from files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConstellationSummary {
    /// Name of its file or directory, without the path.
    pub name: String,
    /// The format of its files.
    pub format: String,
    /// Their content.
    pub content: String,
    /// Number of satellites.
    pub satellites: usize,
}

/// The output of `evaluate --constellation`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstellationResult {
    /// The constellation.
    pub constellation: ConstellationSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// All dilutions of precision, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dops: Option<DopStatistics>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

impl OptimizeResult {
    /// The current result of a search, with the members of its front evaluated again.
    #[must_use]
    pub fn new(
        problem: &DesignProblem<'_>,
        search: &Search,
        scenario: &Scenario,
        stamp: ScenarioStamp,
    ) -> Self {
        let individuals = search.front();
        let points: Vec<&[f64]> = individuals
            .iter()
            .map(|i| i.objectives.as_slice())
            .collect();
        let front = front_members(problem, &individuals, &points);
        let progress = search.progress();
        let reference = scenario.minimised_reference();
        let summary = SearchSummary {
            evaluations: progress.evaluations,
            hypervolume: Hypervolume {
                value: reference.map(|reference| hypervolume(&points, &reference)),
                reference: scenario.objectives.hypervolume_reference.clone(),
            },
            seed: scenario.optimizer.seed,
            algorithm: scenario.optimizer.algorithm.to_string(),
            generations: [progress.step, progress.steps],
            diagnostics: diagnose(problem, search, &front, &individuals),
            certificate: None,
            scenario: stamp,
            version: VERSION.to_owned(),
        };
        Self {
            front,
            search: summary,
            history: search.history().to_vec(),
        }
    }

    /// Compares the front with a sweep of the same problem.
    pub fn certify(&mut self, sweep: &Self, objectives: &[Quantity]) {
        let points = |result: &Self| -> Vec<Vec<f64>> {
            let point = |member: &FrontMember| {
                let values = objectives.iter().zip(&member.objectives);
                values.map(|(q, (_, value))| q.minimised(*value)).collect()
            };
            result.front.iter().map(point).collect()
        };
        self.search
            .diagnostics
            .extend(dominated_by(&points(self), &points(sweep)));
        self.search.certificate = Some(Certificate::new(self, sweep, objectives));
    }
}

fn front_members(
    problem: &DesignProblem<'_>,
    individuals: &[Individual],
    points: &[&[f64]],
) -> Vec<FrontMember> {
    // Every front but an empty one has memberships.
    let Ok(memberships) = fuzzy(points) else {
        return Vec::new();
    };
    let chosen = best(&memberships.minimum);
    let evaluated: Vec<_> = individuals
        .par_iter()
        .map(|individual| problem.evaluated(&individual.genome))
        .collect();
    let objectives = |individual: &Individual| {
        let quantities = problem.goals().objectives.iter();
        quantities
            .zip(&individual.objectives)
            .map(|(q, &v)| (q.to_string(), q.minimised(v)))
            .collect()
    };
    evaluated
        .into_iter()
        .enumerate()
        .filter_map(|(n, evaluated)| {
            let (design, metrics) = evaluated?;
            Some(FrontMember {
                index: n + 1,
                design: (&design).into(),
                metrics,
                objectives: objectives(&individuals[n]),
                membership: memberships.minimum[n],
                membership_sum: memberships.share[n],
                chosen: chosen == Some(n),
            })
        })
        .collect()
}

//! The objects that `--format json` prints, made from what was computed.

use super::{Baseline, compared_designs, diagnose, dominated_by, shown};
use crate::constellation::Design;
use crate::evaluate::{DopStatistics, Metrics};
use crate::optimize::{Individual, Search, Strategy, best, fuzzy, hypervolume};
use crate::run::{
    Certificate, DesignSummary, FrontMember, Hypervolume, OptimizeResult, ScenarioStamp,
    SearchSummary, VERSION, VolumeAt,
};
use crate::scenario::Scenario;
use crate::search::{Constraint, DesignProblem, Goals, Quantity};
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
    /// The constraints of the scenario, and whether the design meets them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<ConstraintCheck>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

/// A constraint of the scenario, checked for a design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstraintCheck {
    /// The constraint as it is written: `max-pdop <= 2.5`.
    pub constraint: String,
    /// The quantity under it.
    pub quantity: String,
    /// Its value; `None` if it has none.
    pub value: Option<f64>,
    /// Whether the design keeps it.
    pub met: bool,
}

impl ConstraintCheck {
    /// The constraints of `goals`, checked for a design.
    #[must_use]
    pub fn of(design: &Design, metrics: &Metrics, goals: &Goals) -> Vec<Self> {
        let check = |constraint: &Constraint| {
            let value = constraint
                .quantity
                .value(design, metrics, &goals.launch_cost);
            Self {
                constraint: constraint.to_string(),
                quantity: constraint.quantity.to_string(),
                value,
                met: constraint.violation(value, metrics.solved_fraction) == 0.0,
            }
        };
        goals.constraints.iter().map(check).collect()
    }
}

impl EvaluateResult {
    /// The result of one design.
    #[must_use]
    pub fn new(
        design: &Design,
        metrics: Metrics,
        dops: Option<DopStatistics>,
        goals: &Goals,
        scenario: ScenarioStamp,
    ) -> Self {
        Self {
            constraints: ConstraintCheck::of(design, &metrics, goals),
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
        let objectives = &scenario.objectives.minimize;
        let written = scenario.minimised_reference();
        let volume = Hypervolume::of(
            &points,
            written.as_deref(),
            search.chosen_reference(),
            objectives,
        );
        let mut diagnostics = diagnose(problem, search, &front, &individuals);
        diagnostics.extend(shown::unused_reference(&volume));
        if let Some(pick) = front.iter().find(|member| member.chosen) {
            let compared = compared_designs(scenario).into_iter();
            let compared =
                compared.filter_map(|(name, design)| Baseline::evaluate(&name, &design, problem));
            diagnostics.extend(compared.filter_map(|one| one.diagnose(pick)));
        }
        let summary = SearchSummary {
            evaluations: progress.evaluations,
            hypervolume: volume,
            seed: scenario.optimizer.seed,
            algorithm: scenario.optimizer.algorithm.to_string(),
            generations: [progress.step, progress.steps],
            diagnostics,
            certificate: None,
            scenario: stamp,
            version: VERSION.to_owned(),
        };
        Self {
            front,
            search: summary,
            history: search.history().to_vec(),
            chosen_reference: search.chosen_reference().map(<[f64]>::to_vec),
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

impl Hypervolume {
    /// The volume of a front, points and references as they are minimised: at the written reference
    /// or, if there is none or it is of no use, at the chosen one.
    pub(super) fn of<P: AsRef<[f64]>>(
        points: &[P],
        written: Option<&[f64]>,
        chosen: Option<&[f64]>,
        objectives: &[Quantity],
    ) -> Self {
        let own = |reference: &[f64]| -> Vec<f64> {
            let pairs = objectives.iter().zip(reference);
            pairs.map(|(q, x)| q.minimised(*x)).collect()
        };
        let volume =
            |reference: &[f64]| Some(hypervolume(points, reference)).filter(|volume| *volume > 0.0);
        let Some(written) = written else {
            return Self {
                value: chosen.and_then(volume),
                reference: chosen.map(own),
                chosen: chosen.is_some(),
                at_chosen: None,
            };
        };
        let value = volume(written);
        let at_chosen = || {
            Some(VolumeAt {
                value: volume(chosen?)?,
                reference: own(chosen?),
            })
        };
        Self {
            value,
            reference: Some(own(written)),
            chosen: false,
            at_chosen: if value.is_none() { at_chosen() } else { None },
        }
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
    let member = |(n, evaluated): (usize, Option<(Design, Metrics)>)| {
        let (design, metrics) = evaluated?;
        Some(FrontMember {
            index: n + 1,
            design: (&design).into(),
            objectives: objectives(&individuals[n]),
            constraints: constrained(&design, &metrics, problem.goals()),
            membership: memberships.minimum[n],
            membership_sum: memberships.share[n],
            chosen: chosen == Some(n),
            metrics,
        })
    };
    evaluated
        .into_iter()
        .enumerate()
        .filter_map(member)
        .collect()
}

/// The constrained quantities that are not objectives, by name.
fn constrained(design: &Design, metrics: &Metrics, goals: &Goals) -> Vec<(String, Option<f64>)> {
    let value = |q: Quantity| (q.to_string(), q.value(design, metrics, &goals.launch_cost));
    goals.constrained().into_iter().map(value).collect()
}

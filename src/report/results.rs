//! The result of a search, made from what was computed.

use super::{Baseline, ConstellationEntry, compared_designs, diagnose, dominated_by, shown};
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::optimize::{Individual, Search, Strategy, best, fuzzy, hypervolume};
use crate::run::{
    Certificate, DesignSummary, FixedSummary, FrontMember, Hypervolume, MemberFiles,
    OptimizeResult, ScenarioStamp, SearchSummary, VERSION, VolumeAt,
};
use crate::scenario::Scenario;
use crate::search::{DesignProblem, DesignSpace, Quantity};
use rayon::prelude::*;
use thiserror::Error;

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
        let evaluated = individuals.par_iter();
        let evaluated = evaluated.map(|individual| problem.evaluated(&individual.genome));
        let front = front_members(problem, &individuals, &points, evaluated.collect());
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
            fixed: fixed(problem, scenario),
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

    /// The result of constellations that were given, each a member in its order; the memberships are over this
    /// set. `in_scenario` has the name in the scenario of the run of each with satellites from files.
    ///
    /// # Errors
    /// If there is no constellation, or one without a value of an objective.
    pub fn of_given(
        given: &[ConstellationEntry],
        in_scenario: &[Option<String>],
        scenario: &Scenario,
        stamp: ScenarioStamp,
    ) -> Result<Self, NoMember> {
        let objectives = &scenario.objectives.minimize;
        let values = given.iter().map(|entry| values_of(entry, objectives));
        let values: Vec<Vec<f64>> = values.collect::<Result<_, _>>()?;
        let minimised = |values: &Vec<f64>| -> Vec<f64> {
            let pairs = objectives.iter().zip(values);
            pairs.map(|(one, value)| one.minimised(*value)).collect()
        };
        let points: Vec<Vec<f64>> = values.iter().map(minimised).collect();
        let hypervolume = Hypervolume::of(
            &points,
            scenario.minimised_reference().as_deref(),
            None,
            objectives,
        );
        let memberships = fuzzy(&points).map_err(|_| NoMember::NoConstellation)?;
        let chosen = best(&memberships.minimum);
        let goals = scenario.goals();
        let mut front = Vec::new();
        for (n, (entry, values)) in given.iter().zip(values).enumerate() {
            let of_files = |constellation: &String| MemberFiles {
                constellation: constellation.clone(),
                names: entry.files.clone(),
                satellites: entry.satellites,
            };
            let of_scenario = in_scenario.get(n).and_then(Option::as_ref);
            let constrained = goals.constrained().into_iter();
            let constrained = constrained.map(|one| (one.to_string(), entry.evaluated.value(one)));
            front.push(FrontMember {
                index: n + 1,
                name: Some(entry.name.clone()),
                design: entry.design.clone(),
                files: of_scenario.map(of_files),
                shells: Vec::new(),
                metrics: entry.evaluated.metrics,
                objectives: objectives
                    .iter()
                    .map(ToString::to_string)
                    .zip(values)
                    .collect(),
                constraints: constrained.collect(),
                membership: memberships.minimum[n],
                membership_sum: memberships.share[n],
                chosen: chosen == Some(n),
            });
        }
        Ok(Self {
            search: SearchSummary {
                evaluations: front.len() as u64,
                hypervolume,
                seed: scenario.optimizer.seed,
                algorithm: SearchSummary::GIVEN.to_owned(),
                generations: [0, 0],
                fixed: None,
                diagnostics: Vec::new(),
                certificate: None,
                scenario: stamp,
                version: VERSION.to_owned(),
            },
            front,
            history: Vec::new(),
            chosen_reference: None,
        })
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

/// Why a constellation cannot be a member of a run.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoMember {
    /// There is none.
    #[error("a run needs a constellation")]
    NoConstellation,
    /// An objective without a value, as for PDOP without solved samples.
    #[error(
        "{name} has no value of the objective {objective}; choose another with objectives.minimize"
    )]
    NoValue {
        /// Its name.
        name: String,
        /// The objective.
        objective: Quantity,
    },
}

/// The objectives of a constellation, in their own sense.
fn values_of(entry: &ConstellationEntry, objectives: &[Quantity]) -> Result<Vec<f64>, NoMember> {
    let value = |objective: &Quantity| {
        let missing = || NoMember::NoValue {
            name: entry.name.clone(),
            objective: *objective,
        };
        entry.evaluated.value(*objective).ok_or_else(missing)
    };
    objectives.iter().map(value).collect()
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

pub(super) fn front_members(
    problem: &DesignProblem<'_>,
    individuals: &[Individual],
    points: &[&[f64]],
    evaluated: Vec<Option<(Option<Design>, Metrics)>>,
) -> Vec<FrontMember> {
    // Every front but an empty one has memberships.
    let Ok(memberships) = fuzzy(points) else {
        return Vec::new();
    };
    let chosen = best(&memberships.minimum);
    let objectives = |individual: &Individual| {
        let quantities = problem.goals().objectives.iter();
        quantities
            .zip(&individual.objectives)
            .map(|(q, &v)| (q.to_string(), q.minimised(v)))
            .collect()
    };
    let member = |(n, evaluated): (usize, Option<(Option<Design>, Metrics)>)| {
        let (design, metrics) = evaluated?;
        Some(FrontMember {
            index: n + 1,
            name: None,
            design: design.as_ref().map(Into::into),
            files: None,
            shells: shells(problem.designs(), &individuals[n].genome),
            objectives: objectives(&individuals[n]),
            constraints: constrained(design.as_ref(), &metrics, problem),
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

/// The shells of a vector in the order of the search; none where one shell is the whole design.
fn shells(space: &DesignSpace, genome: &[f64]) -> Vec<Option<DesignSummary>> {
    // The designs of a list have numbers in place of vectors.
    if space.is_of_one_shell() || space.variable_count() != genome.len() {
        return Vec::new();
    }
    let shells = space.shells_of(genome).unwrap_or_default().into_iter();
    shells
        .map(|shell| shell.as_ref().map(DesignSummary::from))
        .collect()
}

/// What is fixed in a search.
pub(super) fn fixed(problem: &DesignProblem<'_>, scenario: &Scenario) -> Option<FixedSummary> {
    let name = scenario.search.fixed.clone()?;
    let shells = problem.designs().fixed.as_ref();
    Some(FixedSummary {
        name,
        in_design: shells.map_or(0, Design::satellite_count),
        from_files: problem.satellites_beside(),
    })
}

/// The constrained quantities that are not objectives, by name.
fn constrained(
    design: Option<&Design>,
    metrics: &Metrics,
    problem: &DesignProblem<'_>,
) -> Vec<(String, Option<f64>)> {
    let value = |q: Quantity| (q.to_string(), problem.value(q, design, metrics));
    problem
        .goals()
        .constrained()
        .into_iter()
        .map(value)
        .collect()
}

//! The objects that `--format json` prints and that run directories hold.

use super::{Certificate, Diagnostic, VERSION, diagnose, dominated_by};
use crate::constellation::Design;
use crate::earth;
use crate::evaluate::{DopStatistics, Metrics};
use crate::optimize::{Individual, Record, Search, Strategy, best, fuzzy, hypervolume};
use crate::scenario::Scenario;
use crate::search::{DesignProblem, Quantity};
use crate::validate::{Findings, JUDGES, Judge};
use rayon::prelude::*;
use serde::ser::SerializeMap;
use serde::{Serialize, Serializer};

/// A design, spelled out.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignSummary {
    /// Walker notation that reads back to the design.
    pub notation: String,
    /// `delta`, `star` or `lattice`.
    pub pattern: String,
    /// Planes P.
    pub planes: usize,
    /// Satellites per plane S.
    pub satellites_per_plane: usize,
    /// Satellites T.
    pub satellites: usize,
    /// Phasing F, or `N_c` of a lattice.
    pub phasing: usize,
    /// Inclination, degrees.
    pub inclination_deg: f64,
    /// Altitude over the equatorial radius, km.
    pub altitude_km: f64,
    /// Eccentricity.
    pub eccentricity: f64,
    /// Argument of perigee, degrees.
    pub arg_perigee_deg: f64,
}

impl From<&Design> for DesignSummary {
    fn from(design: &Design) -> Self {
        Self {
            notation: design.to_string(),
            pattern: design.pattern().to_string(),
            planes: design.planes(),
            satellites_per_plane: design.satellites_per_plane(),
            satellites: design.satellite_count(),
            phasing: design.phasing(),
            inclination_deg: design.inclination_deg(),
            altitude_km: design.altitude_km(),
            eccentricity: design.eccentricity(),
            arg_perigee_deg: design.arg_perigee_deg(),
        }
    }
}

/// Which study a result belongs to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScenarioStamp {
    /// Its name.
    pub name: String,
    /// What [`Scenario::hash`] gives.
    pub hash: String,
}

/// What `evaluate` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluateResult {
    /// The design.
    pub design: DesignSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// All dilutions of precision, when they were asked for.
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

/// A constellation that comes from files.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstellationSummary {
    /// Name of its file or directory, without the way to it.
    pub name: String,
    /// The format of its files.
    pub format: String,
    /// What they hold.
    pub content: String,
    /// Number of satellites.
    pub satellites: usize,
}

/// What `evaluate --constellation` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstellationResult {
    /// The constellation.
    pub constellation: ConstellationSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// All dilutions of precision, when they were asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dops: Option<DopStatistics>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

/// A non-dominated design of the last population.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FrontMember {
    /// Place in the front from 1, by the first objective; what `--pick N` takes.
    pub index: usize,
    /// The design.
    pub design: DesignSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// Value of each objective by name, in its own direction.
    #[serde(serialize_with = "as_map")]
    pub objectives: Vec<(String, f64)>,
    /// Fuzzy membership: the least over the objectives.
    pub membership: f64,
    /// Fuzzy membership: the normalised sum over the objectives.
    pub membership_sum: f64,
    /// Whether this is the pick of the fuzzy decision.
    pub chosen: bool,
}

fn as_map<S: Serializer>(pairs: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    let mut map = serializer.serialize_map(Some(pairs.len()))?;
    for (name, value) in pairs {
        map.serialize_entry(name, value)?;
    }
    map.end()
}

/// The volume that a front dominates.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Hypervolume {
    /// The volume, in the product of the objectives' units; `None` without a reference point.
    pub value: Option<f64>,
    /// The reference point, one coordinate per objective.
    pub reference: Option<Vec<f64>>,
}

/// What `optimize` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct OptimizeResult {
    /// The front, by the first objective.
    pub front: Vec<FrontMember>,
    /// Designs evaluated.
    pub evaluations: u64,
    /// Volume that the front dominates.
    pub hypervolume: Hypervolume,
    /// Seed of the search.
    pub seed: u64,
    /// Name of the algorithm.
    pub algorithm: String,
    /// Generations done, and asked for.
    pub generations: [u64; 2],
    /// What the program notices.
    pub diagnostics: Vec<Diagnostic>,
    /// What a sweep of the same problem says of the front, when it was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
    /// One record per generation; goes to the history files.
    #[serde(skip)]
    pub history: Vec<Record>,
}

impl OptimizeResult {
    /// The result of a search as it stands, the members of its front evaluated once more.
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
        Self {
            diagnostics: diagnose(problem, search, &front, &individuals),
            front,
            evaluations: progress.evaluations,
            hypervolume: Hypervolume {
                value: reference.map(|reference| hypervolume(&points, &reference)),
                reference: scenario.objectives.hypervolume_reference.clone(),
            },
            seed: scenario.optimizer.seed,
            algorithm: scenario.optimizer.algorithm.to_string(),
            generations: [progress.step, progress.steps],
            certificate: None,
            scenario: stamp,
            version: VERSION,
            history: search.history().to_vec(),
        }
    }

    /// Holds the front against a sweep of the same problem.
    pub fn certify(&mut self, sweep: &Self, objectives: &[Quantity]) {
        let points = |result: &Self| -> Vec<Vec<f64>> {
            let point = |member: &FrontMember| {
                let values = objectives.iter().zip(&member.objectives);
                values.map(|(q, (_, value))| q.minimised(*value)).collect()
            };
            result.front.iter().map(point).collect()
        };
        self.diagnostics
            .extend(dominated_by(&points(self), &points(sweep)));
        self.certificate = Some(Certificate::new(self, sweep, objectives));
    }

    /// The pick of the fuzzy decision.
    #[must_use]
    pub fn chosen(&self) -> Option<&FrontMember> {
        self.front.iter().find(|member| member.chosen)
    }
}

fn front_members(
    problem: &DesignProblem<'_>,
    individuals: &[Individual],
    points: &[&[f64]],
) -> Vec<FrontMember> {
    // An empty front has no memberships; every other one does.
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

/// What `validate` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ValidateResult {
    /// The design.
    pub design: DesignSummary,
    /// The checks, and the budget of sgp4.
    #[serde(flatten)]
    pub findings: Findings,
    /// Whether every gate is kept.
    pub passed: bool,
    /// The study.
    pub scenario: ScenarioStamp,
    /// The targets, in the order in which they were asked for.
    pub against: Vec<String>,
    /// What every number rests on.
    pub basis: Basis,
    /// Version of the program.
    pub version: &'static str,
}

/// Constants and crates behind a validation. There is no random number in it, and no seed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Basis {
    /// Gravitational parameter, km³/s².
    pub mu_km3_s2: f64,
    /// Equatorial radius, km.
    pub radius_km: f64,
    /// Second zonal harmonic.
    pub j2: f64,
    /// Flattening of the ellipsoid.
    pub flattening: f64,
    /// The crates whose word counts.
    pub judges: [Judge; 4],
}

impl Default for Basis {
    fn default() -> Self {
        Self {
            mu_km3_s2: earth::MU_KM3_S2,
            radius_km: earth::RADIUS_KM,
            j2: earth::J2,
            flattening: earth::FLATTENING,
            judges: JUDGES,
        }
    }
}

impl ValidateResult {
    /// The result of validating one design.
    #[must_use]
    pub fn new(
        design: &Design,
        against: Vec<String>,
        findings: Findings,
        scenario: ScenarioStamp,
    ) -> Self {
        Self {
            design: design.into(),
            passed: findings.passed(),
            findings,
            scenario,
            against,
            basis: Basis::default(),
            version: VERSION,
        }
    }
}

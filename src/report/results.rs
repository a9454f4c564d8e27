//! The objects that `--format json` prints and that run directories hold.

use super::{Diagnostic, VERSION};
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::optimize::Record;
use crate::scenario::Scenario;
use crate::validate::Findings;
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
    /// SHA-256 of its canonical form.
    pub hash: String,
}

impl From<&Scenario> for ScenarioStamp {
    fn from(scenario: &Scenario) -> Self {
        Self {
            name: scenario.name.clone(),
            hash: scenario.hash(),
        }
    }
}

/// What `evaluate` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluateResult {
    /// The design.
    pub design: DesignSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

impl EvaluateResult {
    /// The result of one design.
    #[must_use]
    pub fn new(design: &Design, metrics: Metrics, scenario: &Scenario) -> Self {
        Self {
            design: design.into(),
            metrics,
            scenario: scenario.into(),
            version: VERSION,
        }
    }
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
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
    /// One record per generation; goes to the history files.
    #[serde(skip)]
    pub history: Vec<Record>,
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
    /// Version of the program.
    pub version: &'static str,
}

impl ValidateResult {
    /// The result of validating one design.
    #[must_use]
    pub fn new(design: &Design, findings: Findings, scenario: &Scenario) -> Self {
        Self {
            design: design.into(),
            passed: findings.passed(),
            findings,
            scenario: scenario.into(),
            version: VERSION,
        }
    }
}

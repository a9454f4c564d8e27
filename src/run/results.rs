//! The results in the files of a run, as printed by `--format json`.

use super::columns::fields;
use crate::constellation::{Design, Shell};
use crate::evaluate::Metrics;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::keyword::Keyword;
use crate::optimize::Record;
use crate::search::Quantity;
use serde::{Deserialize, Serialize};

/// A design, field by field; a field is `None` where its shells differ.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DesignSummary {
    /// Walker notation of the design.
    pub notation: String,
    /// `delta`, `star` or `lattice`.
    pub pattern: Option<String>,
    /// Planes P of all shells.
    pub planes: usize,
    /// Satellites per plane S.
    pub satellites_per_plane: Option<usize>,
    /// Satellites T of all shells.
    pub satellites: usize,
    /// Phasing F, or `N_c` of a lattice.
    pub phasing: Option<usize>,
    /// Inclination, degrees.
    pub inclination_deg: Option<f64>,
    /// Altitude over the equatorial radius, km.
    pub altitude_km: Option<f64>,
    /// Eccentricity.
    pub eccentricity: Option<f64>,
    /// Argument of perigee, degrees.
    pub arg_perigee_deg: Option<f64>,
    /// Right ascension of the first node at the epoch, TEME, degrees.
    pub raan_deg: Option<f64>,
    /// Mean argument of latitude of the first satellite at the epoch, degrees.
    pub arg_latitude_deg: Option<f64>,
    /// From the node of one plane to that of the next, degrees.
    pub node_step_deg: Option<f64>,
    /// The shells of a design of several.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shells: Vec<DesignSummary>,
}

impl From<&Design> for DesignSummary {
    fn from(design: &Design) -> Self {
        let shells = match design.only_shell() {
            Some(_) => Vec::new(),
            None => design.shells().iter().map(Self::from).collect(),
        };
        Self {
            notation: design.to_string(),
            pattern: design.common(Shell::pattern).map(|one| one.to_string()),
            planes: design.planes(),
            satellites_per_plane: design.common(Shell::satellites_per_plane),
            satellites: design.satellite_count(),
            phasing: design.common(Shell::phasing),
            inclination_deg: design.common(Shell::inclination_deg),
            altitude_km: design.common(Shell::altitude_km),
            eccentricity: design.common(Shell::eccentricity),
            arg_perigee_deg: design.common(Shell::arg_perigee_deg),
            raan_deg: design.common(|shell| shell.orientation().raan_deg),
            arg_latitude_deg: design.common(Shell::arg_latitude_deg),
            node_step_deg: design.common(Shell::node_step_deg),
            shells,
        }
    }
}

impl From<&Shell> for DesignSummary {
    fn from(shell: &Shell) -> Self {
        Self::from(&Design::from(*shell))
    }
}

impl DesignSummary {
    /// The columns of a design in a table: every field but the shells.
    #[must_use]
    pub fn columns() -> &'static [&'static str] {
        let all = fields::<Self>();
        &all[..all.len() - 1]
    }

    /// A value as text, of each shell in turn where they differ: `53+90`.
    #[must_use]
    pub fn by_shell(&self, text: impl Fn(&Self) -> Option<String>) -> String {
        match text(self) {
            Some(text) => text,
            None => {
                let texts = self.shells.iter().filter_map(text);
                texts.collect::<Vec<_>>().join("+")
            }
        }
    }

    /// The design of the notation; `None` if the notation is invalid.
    #[must_use]
    pub fn design(&self) -> Option<Design> {
        self.notation.parse().ok()
    }
}

/// The study of a result.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ScenarioStamp {
    /// Its name.
    pub name: String,
    /// Its [`Scenario::hash`](crate::scenario::Scenario::hash).
    pub hash: String,
}

/// A non-dominated design of the last population.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FrontMember {
    /// Place in the front from 1, by the first objective; what `--pick N` takes.
    pub index: usize,
    /// Its name, in a run of given constellations; `--pick` takes it too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The shells; `None` if all its satellites are from files, as where a search adds nothing to what is fixed.
    pub design: Option<DesignSummary>,
    /// Its satellites from files, in a run of given constellations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub files: Option<MemberFiles>,
    /// The shells of a search among several, or beside something fixed, in their order; `None` for an empty one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shells: Vec<Option<DesignSummary>>,
    /// Its metrics.
    pub metrics: Metrics,
    /// Value of each objective by name, in its original sense.
    #[serde(with = "by_name")]
    pub objectives: Vec<(String, f64)>,
    /// Value of each constrained quantity that is not an objective, by name; `None` if it has no
    /// value.
    #[serde(default, with = "by_name", skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<(String, Option<f64>)>,
    /// Fuzzy membership: the worst case over the objectives.
    pub membership: f64,
    /// Fuzzy membership: the normalised sum over the objectives.
    pub membership_sum: f64,
    /// Whether this is the fuzzy pick.
    pub chosen: bool,
}

/// The satellites of a member that are from files, of which the run has copies.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct MemberFiles {
    /// The constellation in the scenario of the run, which names the copies.
    pub constellation: String,
    /// The files or directories as they were given, without their paths.
    pub names: Vec<String>,
    /// Number of satellites of the member, with those of its shells.
    pub satellites: usize,
}

impl FrontMember {
    /// What a member of a search is made of that adds no satellite to those that are fixed.
    pub const NOTHING_ADDED: &'static str = "nothing added";

    /// What its satellites are: the notation, the files, or both.
    #[must_use]
    pub fn made_of(&self) -> String {
        if self.design.is_none() && self.files.is_none() {
            return Self::NOTHING_ADDED.to_owned();
        }
        let notation = self.design.iter().map(|design| &design.notation);
        let files = self.files.iter().flat_map(|files| &files.names);
        let parts: Vec<&str> = notation.chain(files).map(String::as_str).collect();
        parts.join("+")
    }

    /// The design, if the member has no other satellites and its notation is valid.
    #[must_use]
    pub fn only_design(&self) -> Option<Design> {
        let summary = self.design.as_ref().filter(|_| self.files.is_none());
        summary?.design()
    }

    /// Number of satellites, but for those from files that a search has fixed.
    #[must_use]
    pub fn satellites(&self) -> usize {
        match (&self.files, &self.design) {
            (Some(files), _) => files.satellites,
            (None, design) => design.as_ref().map_or(0, |design| design.satellites),
        }
    }

    /// The constellation of a member of a search, with the satellites from files that are fixed; `None` if its
    /// notation is invalid.
    #[must_use]
    pub fn constellation(&self, fixed: Option<&FileSatellites>) -> Option<Constellation> {
        let design = match &self.design {
            Some(summary) => Some(summary.design()?),
            None => None,
        };
        Constellation::of_parts(design, fixed.cloned())
    }

    /// A shell of the search by its place; `None` if it is empty.
    #[must_use]
    pub fn shell(&self, place: usize) -> Option<&DesignSummary> {
        match self.shells.get(place) {
            Some(shell) => shell.as_ref(),
            None if place == 0 && self.shells.is_empty() => self.design.as_ref(),
            None => None,
        }
    }

    /// An objective by its name.
    #[must_use]
    pub fn objective(&self, name: &str) -> Option<f64> {
        let found = self.objectives.iter().find(|(n, _)| n == name);
        found.map(|(_, value)| *value)
    }

    /// The quantity of an objective or a constraint, by its name.
    #[must_use]
    pub fn quantity(&self, name: &str) -> Option<f64> {
        let constrained = || self.constraints.iter().find(|(n, _)| n == name)?.1;
        self.objective(name).or_else(constrained)
    }

    /// The objectives as the optimiser minimises them; one of another name is taken as it is.
    #[must_use]
    pub fn minimised(&self) -> Vec<f64> {
        let value = |(name, value): &(String, f64)| {
            Quantity::from_keyword(name).map_or(*value, |quantity| quantity.minimised(*value))
        };
        self.objectives.iter().map(value).collect()
    }
}

/// Quantities as a map from name to value.
mod by_name {
    use serde::de::{Deserialize, Deserializer};
    use serde::ser::{Serialize, Serializer};
    use std::collections::BTreeMap;

    pub(super) fn serialize<V: Serialize, S: Serializer>(
        pairs: &[(String, V)],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
    }

    pub(super) fn deserialize<'de, V: Deserialize<'de>, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<(String, V)>, D::Error> {
        let map = BTreeMap::<String, V>::deserialize(deserializer)?;
        Ok(map.into_iter().collect())
    }
}

/// The volume that a front dominates.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Hypervolume {
    /// The volume, in the product of the objectives' units; `None` where no member dominates the
    /// reference point, and without one.
    pub value: Option<f64>,
    /// The reference point, one coordinate per objective, each in its own direction: that of the
    /// scenario or, where it has none, the one that the search chose.
    pub reference: Option<Vec<f64>>,
    /// Whether the search chose the reference point.
    #[serde(default)]
    pub chosen: bool,
    /// The volume at the reference point that the search chose, where no member dominates that of
    /// the scenario.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_chosen: Option<VolumeAt>,
}

/// A volume and its reference point.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VolumeAt {
    /// The volume, in the product of the objectives' units.
    pub value: f64,
    /// The reference point, one coordinate per objective, each in its own direction.
    pub reference: Vec<f64>,
}

impl Hypervolume {
    /// What measures the front: the volume at the reference point of the scenario, or else at the
    /// chosen one.
    #[must_use]
    pub fn measured(&self) -> Option<VolumeAt> {
        let here = || {
            Some(VolumeAt {
                value: self.value?,
                reference: self.reference.clone()?,
            })
        };
        self.at_chosen.clone().or_else(here)
    }
}

/// The record of a search that accompanies its front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SearchSummary {
    /// Designs evaluated.
    pub evaluations: u64,
    /// Volume that the front dominates.
    pub hypervolume: Hypervolume,
    /// Seed of the search.
    pub seed: u64,
    /// Name of the algorithm.
    pub algorithm: String,
    /// Generations done, and in total.
    pub generations: [u64; 2],
    /// What every design has beside its own shells, if anything.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fixed: Option<FixedSummary>,
    /// Diagnostics.
    #[serde(default)]
    pub diagnostics: Vec<Diagnostic>,
    /// Comparison with a sweep of the same problem, if requested.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<Certificate>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: String,
}

/// What is fixed in a search.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct FixedSummary {
    /// Its notation, or its name in the scenario.
    pub name: String,
    /// Satellites of its shells, which are in the notation of each design.
    pub in_design: usize,
    /// Satellites from files, which are in no notation and, as each design has them, in every metric.
    pub from_files: usize,
}

impl SearchSummary {
    /// The algorithm of a run of constellations that were given, without a search.
    pub const GIVEN: &str = "given";

    /// Whether the constellations were given, and not found by a search: then there is no history.
    #[must_use]
    pub fn is_of_given(&self) -> bool {
        self.algorithm == Self::GIVEN
    }
}

/// The output of `optimize` and the content of `front.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OptimizeResult {
    /// The front, by the first objective.
    pub front: Vec<FrontMember>,
    /// The record of the search.
    #[serde(flatten)]
    pub search: SearchSummary,
    /// One record per generation; goes to the history files.
    #[serde(skip)]
    pub history: Vec<Record>,
    /// The hypervolume reference that the search chose, objectives as they are minimised; is kept
    /// in the checkpoint.
    #[serde(skip)]
    pub chosen_reference: Option<Vec<f64>>,
}

impl OptimizeResult {
    /// The fuzzy pick.
    #[must_use]
    pub fn chosen(&self) -> Option<&FrontMember> {
        self.front.iter().find(|member| member.chosen)
    }
}

/// Comparison of a front with that of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Certificate {
    /// Designs that the sweep evaluated.
    pub evaluations: u64,
    /// Members of the sweep's front, which is exact on its grid.
    pub grid_members: usize,
    /// Hypervolume of the sweep's front, at the reference point of the certified front.
    pub grid_hypervolume: Option<f64>,
    /// Hypervolume of the certified front.
    pub found_hypervolume: Option<f64>,
    /// Members of the sweep's front that the certified front dominates, with designs between the
    /// points of the grid.
    pub grid_members_dominated: usize,
    /// Distance of each front member to the sweep's front, in the order of the front.
    pub distances: Vec<f64>,
    /// The members of the sweep's front with no front member close to them, if any.
    pub missed: Option<Missed>,
}

/// A part of the sweep's front that a search did not find, given by the ranges of its designs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Missed {
    /// Members that were not found.
    pub members: usize,
    /// The shells of the search, in their order.
    pub shells: Vec<MissedShell>,
}

/// The ranges of one shell of a search among the designs that were not found; `None` where none of them has it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MissedShell {
    /// Its letter in the search; `None` if that is of one shell alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shell: Option<String>,
    /// Members that were not found and have it.
    pub members: usize,
    /// Planes, lowest and highest.
    pub planes: Option<[usize; 2]>,
    /// Satellites per plane, lowest and highest.
    pub satellites_per_plane: Option<[usize; 2]>,
    /// Inclination, lowest and highest, degrees.
    pub inclination_deg: Option<[f64; 2]>,
    /// Altitude, lowest and highest, km.
    pub altitude_km: Option<[f64; 2]>,
}

/// A diagnostic message about a result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Diagnostic {
    /// Stable name, for programs.
    pub code: String,
    /// The sentence, for people.
    pub message: String,
}

impl Diagnostic {
    pub(crate) fn new(code: &str, message: String) -> Self {
        Self {
            code: code.to_owned(),
            message,
        }
    }
}

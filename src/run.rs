//! A run: the files of its directory and their contents, written and read by the same types.
//!
//! Reading is lenient: damaged or missing parts are reported, and the rest is used.

pub mod checkpoint;
pub(crate) mod columns;
pub mod evaluations;
pub(crate) mod hashed;
pub mod inputs;
mod provenance;
mod results;
pub mod size;
#[cfg(feature = "sweep")]
pub mod sweep;
pub(crate) mod tables;
pub mod tile;
pub mod typed_columns;
#[cfg(feature = "validate")]
mod validation;

pub use columns::{metric_columns, metric_values};
pub use provenance::{PROVENANCE, ResultProvenance};
pub use results::{
    Certificate, DesignSummary, Diagnostic, FixedSummary, FrontMember, Hypervolume, MemberFiles,
    Missed, MissedShell, OptimizeResult, ScenarioStamp, SearchSummary, VolumeAt,
};
pub use tables::{front_csv, history_csv};
#[cfg(feature = "validate")]
pub use validation::{Basis, ValidateResult};

use crate::optimize::Record;
use crate::scenario::Scenario;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// The version of this program, included in every result.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// The scenario, including overrides.
pub const SCENARIO: &str = "scenario.toml";
/// The front and the record of the search.
pub const FRONT_JSON: &str = "front.json";
/// The front as a table.
pub const FRONT_CSV: &str = "front.csv";
/// One record per generation.
pub const HISTORY_JSON: &str = "history.json";
/// The generations as a table.
pub const HISTORY_CSV: &str = "history.csv";
/// The state of the search.
pub const CHECKPOINT: &str = "checkpoint";
/// The state of the search one generation earlier.
pub const PREVIOUS_CHECKPOINT: &str = "checkpoint.previous";
/// The record of each generation of the checkpoints, one per line.
pub const CHECKPOINT_LOG: &str = "checkpoint.log";
/// The page of a result: the answer, figures and tables in one HTML file.
pub const REPORT_PAGE: &str = "report.html";
/// What a run is a run of, and its inputs with their checksums.
pub const MANIFEST: &str = "run.json";
/// The directory for copies of the files that the scenario names.
pub const INPUTS: &str = "inputs";
/// The directory for a validation of one of the designs.
pub const VALIDATION: &str = "validation";
/// The result of a validation, in its directory.
pub const VALIDATION_REPORT: &str = "report.json";

/// The files and directories that a run writes; anything else in its directory was added later.
pub const FILES: [&str; 10] = [
    MANIFEST,
    INPUTS,
    CHECKPOINT,
    PREVIOUS_CHECKPOINT,
    CHECKPOINT_LOG,
    SCENARIO,
    FRONT_JSON,
    FRONT_CSV,
    HISTORY_JSON,
    HISTORY_CSV,
];

/// The results of a run: names and contents of their files; without a search there is no history. A run begins
/// with [`inputs::first_files`].
///
/// # Errors
/// Never for results in memory.
pub fn result_files(
    scenario: &Scenario,
    result: &OptimizeResult,
) -> std::io::Result<Vec<(&'static str, String)>> {
    let objectives = scenario.objectives.minimize.iter();
    let objectives: Vec<String> = objectives.map(ToString::to_string).collect();
    let mut files = vec![
        (FRONT_JSON, crate::printable::json(result)? + "\n"),
        (FRONT_CSV, front_csv(&result.front)?),
    ];
    if !result.search.is_of_given() {
        let history = crate::printable::json(&result.history)? + "\n";
        files.push((HISTORY_JSON, history));
        let table = history_csv(&result.history, &objectives)?;
        files.push((HISTORY_CSV, table));
    }
    Ok(files)
}

/// The readable parts of a run.
#[derive(Debug, Clone, Default)]
pub struct Run {
    /// The study; `None` if it is missing or not a scenario.
    pub scenario: Option<Scenario>,
    /// Members of the front that could be read.
    pub front: Vec<FrontMember>,
    /// The record of the search; `None` if it is missing or damaged.
    pub search: Option<SearchSummary>,
    /// One record per generation.
    pub history: Vec<Record>,
    /// A validation of one of its designs.
    #[cfg(feature = "validate")]
    pub validation: Option<ValidateResult>,
    /// What is missing or damaged, in words.
    pub gaps: Vec<String>,
}

/// The bytes of a run's files, or why there are none.
#[derive(Debug, Clone)]
pub struct RunFiles {
    /// [`SCENARIO`].
    pub scenario: Result<Vec<u8>, String>,
    /// [`FRONT_JSON`].
    pub front: Result<Vec<u8>, String>,
    /// [`HISTORY_JSON`].
    pub history: Result<Vec<u8>, String>,
    /// The `report.json` of a validation, if there is one.
    pub validation: Option<Vec<u8>>,
}

impl Run {
    /// Reads everything that is readable.
    #[must_use]
    pub fn read(files: &RunFiles) -> Self {
        let mut run = Self::default();
        run.read_scenario(&files.scenario);
        match json(FRONT_JSON, &files.front) {
            Ok(value) => run.read_front(value),
            Err(gap) => run.gaps.push(gap),
        }
        match json(HISTORY_JSON, &files.history) {
            Ok(history) => run.history = history,
            Err(_) if run.is_of_given() => {}
            Err(gap) => run.gaps.push(gap),
        }
        #[cfg(feature = "validate")]
        if let Some(bytes) = &files.validation {
            match json("the validation", &Ok(bytes.clone())) {
                Ok(validation) => run.validation = Some(validation),
                Err(gap) => run.gaps.push(gap),
            }
        }
        run.sort_objectives();
        run.compare_versions();
        run
    }

    /// Whether its constellations were given, and not found by a search.
    #[must_use]
    pub fn is_of_given(&self) -> bool {
        let search = self.search.as_ref();
        search.is_some_and(SearchSummary::is_of_given)
    }

    /// The fuzzy pick, by position in the members.
    #[must_use]
    pub fn chosen(&self) -> Option<usize> {
        self.front.iter().position(|member| member.chosen)
    }

    /// The reference point at which the history measures the hypervolume.
    #[must_use]
    pub fn reference(&self) -> Option<Vec<f64>> {
        let hypervolume = &self.search.as_ref()?.hypervolume;
        let measured = hypervolume.measured().map(|measured| measured.reference);
        measured.or_else(|| hypervolume.reference.clone())
    }

    /// The names of the constrained quantities that are not objectives, in the order of the
    /// scenario.
    #[must_use]
    pub fn constraint_names(&self) -> Vec<String> {
        let Some(scenario) = &self.scenario else {
            return Vec::new();
        };
        let constrained = scenario.goals().constrained();
        constrained.iter().map(ToString::to_string).collect()
    }

    /// The objectives' names, in the order of the scenario.
    #[must_use]
    pub fn objective_names(&self) -> Vec<String> {
        match (&self.scenario, self.front.first()) {
            (Some(scenario), _) => {
                let names = scenario.objectives.minimize.iter();
                names.map(ToString::to_string).collect()
            }
            (None, Some(member)) => member
                .objectives
                .iter()
                .map(|(name, _)| name.clone())
                .collect(),
            (None, None) => Vec::new(),
        }
    }

    fn read_scenario(&mut self, bytes: &Result<Vec<u8>, String>) {
        match bytes {
            Ok(bytes) => match Scenario::parse::<&str>(SCENARIO, bytes, &[]) {
                Ok(scenario) => self.scenario = Some(scenario),
                Err(problems) => self.gaps.push(format!(
                    "{SCENARIO} is not a scenario of this version, so nothing can be recomputed: {}",
                    first_line(&problems.to_string())
                )),
            },
            Err(reason) => self.gaps.push(format!(
                "{SCENARIO} is missing, so nothing can be recomputed: {reason}"
            )),
        }
    }

    /// Puts every member's objectives into the scenario's order; drops members that lack one.
    fn sort_objectives(&mut self) {
        let names = self.objective_names();
        let before = self.front.len();
        self.front.retain_mut(|member| {
            let value = |name: &String| {
                let found = member.objectives.iter().find(|(n, _)| n == name)?;
                Some((name.clone(), found.1))
            };
            let sorted: Option<Vec<_>> = names.iter().map(value).collect();
            let complete = sorted.is_some();
            member.objectives = sorted.unwrap_or_default();
            complete
        });
        let lost = before - self.front.len();
        if lost > 0 {
            self.gaps.push(format!(
                "{lost} designs of the front lack an objective of the scenario and are left out"
            ));
        }
    }

    /// Reads the members one by one, and then the record of the search.
    fn read_front(&mut self, mut value: Value) {
        let written = match value.get_mut("front").map(Value::take) {
            Some(Value::Array(members)) => members,
            _ => Vec::new(),
        };
        let count = written.len();
        let members = written.into_iter().map(serde_json::from_value);
        self.front = members.filter_map(Result::ok).collect();
        if self.front.len() < count {
            let lost = count - self.front.len();
            self.gaps.push(format!(
                "{lost} of {count} designs of the front cannot be read"
            ));
        }
        if self.front.is_empty() {
            self.gaps
                .push("the front has no design that can be shown".to_owned());
        }
        match serde_json::from_value(value) {
            Ok(search) => self.search = Some(search),
            Err(error) => self
                .gaps
                .push(format!("{FRONT_JSON} has no record of the search: {error}")),
        }
    }

    fn compare_versions(&mut self) {
        if let Some(search) = &self.search
            && search.version != VERSION
        {
            self.gaps.push(format!(
                "the run was made by version {}; this page by version {VERSION}, which recomputed \
                 maps and series",
                search.version
            ));
        }
    }
}

impl OptimizeResult {
    /// Reads `front.json` strictly: every member and the record of the search.
    ///
    /// # Errors
    /// If the bytes are not the front of a run.
    pub fn read(front_json: &[u8]) -> serde_json::Result<Self> {
        serde_json::from_slice(front_json)
    }
}

/// Reads one file; the error names it and the problem.
fn json<T: DeserializeOwned>(name: &str, bytes: &Result<Vec<u8>, String>) -> Result<T, String> {
    let bytes = bytes
        .as_ref()
        .map_err(|reason| format!("{name} is missing: {reason}"))?;
    serde_json::from_slice(bytes).map_err(|error| format!("{name} is damaged: {error}"))
}

/// The first line of a message, which may be long.
fn first_line(text: &str) -> String {
    text.lines().next().unwrap_or_default().to_owned()
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;

//! A run as its directory holds it, read back leniently: what is damaged or missing is named, and
//! the rest is kept.

use crate::constellation::Design;
use crate::optimize::Record;
use crate::scenario::Scenario;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use std::collections::BTreeMap;

/// What could be read of a run.
#[derive(Debug, Clone, Default)]
pub struct StoredRun {
    /// The study; `None` when it is missing or not a scenario.
    pub scenario: Option<Scenario>,
    /// The front and what came with it.
    pub front: StoredFront,
    /// One record per generation.
    pub history: Vec<Record>,
    /// A validation of one of its designs.
    pub validation: Option<StoredValidation>,
    /// What is missing or damaged, in words.
    pub gaps: Vec<String>,
}

/// The text of a run's files; `Err` says why there is none.
#[derive(Debug, Clone)]
pub struct RunFiles {
    /// `scenario.toml`.
    pub scenario: Result<Vec<u8>, String>,
    /// `front.json`.
    pub front: Result<Vec<u8>, String>,
    /// `history.json`.
    pub history: Result<Vec<u8>, String>,
    /// The `report.json` of a validation, where there is one.
    pub validation: Option<Vec<u8>>,
}

/// A front as written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StoredFront {
    /// Members whose numbers could be read.
    pub members: Vec<StoredMember>,
    /// Designs evaluated.
    pub evaluations: Option<u64>,
    /// Hypervolume.
    pub hypervolume: Option<f64>,
    /// Its reference point.
    pub reference: Option<Vec<f64>>,
    /// Seed of the search.
    pub seed: Option<u64>,
    /// Name of the algorithm.
    pub algorithm: Option<String>,
    /// Generations done, and asked for.
    pub generations: Option<[u64; 2]>,
    /// What the program noticed: (code, message).
    pub diagnostics: Vec<(String, String)>,
    /// Hash of the scenario.
    pub scenario_hash: Option<String>,
    /// Version of the program that wrote it.
    pub version: Option<String>,
}

/// A member of a front as written.
#[derive(Debug, Clone, PartialEq)]
pub struct StoredMember {
    /// What `--pick N` takes.
    pub index: usize,
    /// Walker notation as written.
    pub notation: String,
    /// The design; `None` when the notation is not one.
    pub design: Option<Design>,
    /// Metrics by name.
    pub metrics: StoredMetrics,
    /// Objectives by name, each in its own direction.
    pub objectives: Vec<(String, f64)>,
    /// Fuzzy membership: the least over the objectives.
    pub membership: Option<f64>,
    /// Fuzzy membership: the normalised sum.
    pub membership_sum: Option<f64>,
    /// Whether it is the pick of the fuzzy decision.
    pub chosen: bool,
}

impl StoredMember {
    /// An objective by its name.
    #[must_use]
    pub fn objective(&self, name: &str) -> Option<f64> {
        let found = self.objectives.iter().find(|(n, _)| n == name);
        found.map(|(_, value)| *value)
    }
}

/// The metrics of a stored member; every one may be missing.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct StoredMetrics {
    /// N̄.
    pub mean_visible: Option<f64>,
    /// Mean PDOP.
    pub mean_pdop: Option<f64>,
    /// CVaR of PDOP.
    pub cvar_pdop: Option<f64>,
    /// 95 % quantile of PDOP.
    pub p95_pdop: Option<f64>,
    /// Largest PDOP.
    pub max_pdop: Option<f64>,
    /// Share of samples solved.
    pub solved_fraction: Option<f64>,
    /// Share of samples available.
    pub availability: Option<f64>,
    /// Mean PDOP + λ CVaR.
    pub j_pos: Option<f64>,
    /// Satellites per visible satellite.
    pub j_cost: Option<f64>,
}

/// A validation as written.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredValidation {
    /// The design that was validated.
    pub design: StoredDesign,
    /// The checks.
    #[serde(default)]
    pub checks: Vec<StoredCheck>,
    /// The error budget, where there is one.
    #[serde(default)]
    pub budget: Vec<StoredBudgetLine>,
    /// Whether every gate is kept.
    pub passed: bool,
}

/// The part of a design that identifies it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredDesign {
    /// Walker notation as written.
    pub notation: String,
}

/// A check as written.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredCheck {
    /// Unique name.
    pub name: String,
    /// Unit.
    #[serde(default)]
    pub unit: String,
    /// The value; `None` when it was no finite number.
    pub value: Option<f64>,
    /// The bound on its size.
    pub gate: Option<f64>,
    /// Whether it is kept.
    pub passed: bool,
    /// Why the bound is where it is.
    #[serde(default)]
    pub reason: String,
}

/// A line of an error budget as written.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct StoredBudgetLine {
    /// What is compared.
    pub case: String,
    /// What the difference consists of.
    #[serde(default)]
    pub cause: String,
    /// Root mean square, km.
    pub rms_km: StoredRic,
    /// Largest size, km.
    pub max_km: StoredRic,
    /// Slope of the mean, km/day.
    pub growth_km_per_day: StoredRic,
}

/// A number for each axis.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
pub struct StoredRic {
    /// Radial.
    pub radial: f64,
    /// In-track.
    pub in_track: f64,
    /// Cross-track.
    pub cross_track: f64,
}

impl StoredRic {
    /// Radial, in-track, cross-track.
    #[must_use]
    pub fn axes(&self) -> [f64; 3] {
        [self.radial, self.in_track, self.cross_track]
    }
}

impl StoredRun {
    /// Reads what can be read.
    #[must_use]
    pub fn read(files: &RunFiles) -> Self {
        let mut run = Self::default();
        run.read_scenario(&files.scenario);
        match json::<Value>("front.json", &files.front) {
            Ok(value) => {
                run.front = front(&value, &mut run.gaps);
                if run.front.members.is_empty() {
                    run.gaps
                        .push("the front has no member that can be shown".to_owned());
                }
            }
            Err(gap) => run.gaps.push(gap),
        }
        match json("history.json", &files.history) {
            Ok(history) => run.history = history,
            Err(gap) => run.gaps.push(gap),
        }
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

    /// The pick of the fuzzy decision, by place in the members.
    #[must_use]
    pub fn chosen(&self) -> Option<usize> {
        self.front.members.iter().position(|member| member.chosen)
    }

    /// The objectives' names, in the order of the scenario.
    #[must_use]
    pub fn objective_names(&self) -> Vec<String> {
        match (&self.scenario, self.front.members.first()) {
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
            Ok(bytes) => match Scenario::parse::<&str>("scenario.toml", bytes, &[]) {
                Ok(scenario) => self.scenario = Some(scenario),
                Err(problems) => self.gaps.push(format!(
                    "scenario.toml is no scenario of this version, so that nothing can be computed \
                     anew: {}",
                    first_line(&problems.to_string())
                )),
            },
            Err(reason) => self.gaps.push(format!(
                "scenario.toml is missing, so that nothing can be computed anew: {reason}"
            )),
        }
    }

    /// Brings every member's objectives into the scenario's order; a member that lacks one goes.
    fn sort_objectives(&mut self) {
        let names = self.objective_names();
        let before = self.front.members.len();
        self.front.members.retain_mut(|member| {
            let value = |name: &String| {
                let found = member.objectives.iter().find(|(n, _)| n == name)?;
                Some((name.clone(), found.1))
            };
            let sorted: Option<Vec<_>> = names.iter().map(value).collect();
            let complete = sorted.is_some();
            member.objectives = sorted.unwrap_or_default();
            complete
        });
        let lost = before - self.front.members.len();
        if lost > 0 {
            self.gaps.push(format!(
                "{lost} front members lack an objective of the scenario and are left out"
            ));
        }
    }

    fn compare_versions(&mut self) {
        if let Some(version) = &self.front.version
            && version != super::VERSION
        {
            self.gaps.push(format!(
                "the run was made by version {version}; this page by version {}, which computed \
                 maps and series anew",
                super::VERSION
            ));
        }
    }
}

/// Reads the front of another run.
///
/// # Errors
/// Says in words why the bytes are no front.
pub fn stored_front(bytes: &[u8]) -> Result<StoredFront, String> {
    let value = json::<Value>("front.json", &Ok(bytes.to_vec()))?;
    Ok(front(&value, &mut Vec::new()))
}

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

fn front(value: &Value, gaps: &mut Vec<String>) -> StoredFront {
    let text = |key: &str| value[key].as_str().map(str::to_owned);
    let written = value["front"].as_array().map_or(&[][..], Vec::as_slice);
    let members: Vec<_> = written.iter().filter_map(member).collect();
    if members.len() < written.len() {
        gaps.push(format!(
            "{} of {} front members cannot be read",
            written.len() - members.len(),
            written.len()
        ));
    }
    let diagnostics = value["diagnostics"]
        .as_array()
        .map_or(&[][..], Vec::as_slice);
    let pair = |d: &Value| {
        Some((
            d["code"].as_str()?.to_owned(),
            d["message"].as_str()?.to_owned(),
        ))
    };
    StoredFront {
        members,
        evaluations: value["evaluations"].as_u64(),
        hypervolume: value["hypervolume"]["value"].as_f64(),
        reference: serde_json::from_value(value["hypervolume"]["reference"].clone()).ok(),
        seed: value["seed"].as_u64(),
        algorithm: text("algorithm"),
        generations: serde_json::from_value(value["generations"].clone()).ok(),
        diagnostics: diagnostics.iter().filter_map(pair).collect(),
        scenario_hash: value["scenario"]["hash"].as_str().map(str::to_owned),
        version: text("version"),
    }
}

fn member(value: &Value) -> Option<StoredMember> {
    let notation = value["design"]["notation"].as_str()?.to_owned();
    let objectives: BTreeMap<String, f64> =
        serde_json::from_value(value["objectives"].clone()).ok()?;
    Some(StoredMember {
        index: value["index"].as_u64()?.try_into().ok()?,
        design: notation.parse().ok(),
        notation,
        metrics: serde_json::from_value(value["metrics"].clone()).unwrap_or_default(),
        objectives: objectives.into_iter().collect(),
        membership: value["membership"].as_f64(),
        membership_sum: value["membership_sum"].as_f64(),
        chosen: value["chosen"].as_bool().unwrap_or(false),
    })
}

#[cfg(test)]
mod tests;

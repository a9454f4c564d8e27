//! What `evaluate` prints of one constellation, and of several side by side.

use super::PhaseSpread;
use super::deployment::DeploymentSummary;
use super::expected::ExpectedService;
use super::failures::FailureSummary;
use super::relative_nodes::RelativeNodes;
use super::separations::SeparationResult;
use crate::evaluate::{DopStatistics, Metrics, ViewHistograms};
use crate::exchange::constellation::{Constellation, FileSatellites, GNSS_ONLY};
use crate::run::{DesignSummary, ScenarioStamp, VERSION};
use crate::search::{Constraint, CountedSatellites, Goals, Quantity};
use serde::{Deserialize, Serialize};

/// What is computed of some satellites.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Assessment {
    /// The metrics.
    pub metrics: Metrics,
    /// The satellites in view over all samples.
    #[serde(rename = "visible_histogram")]
    pub histograms: ViewHistograms,
    /// All dilutions of precision, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dops: Option<DopStatistics>,
    /// The spread over phases of the GNSS, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub gnss_phases: Option<PhaseSpread>,
    /// What failures of satellites do, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failures: Option<FailureSummary>,
    /// The phases of a build-up or a drawdown, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub phases: Option<DeploymentSummary>,
    /// The metrics as expected over failures, if the scenario says how reliable the satellites are.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expected: Option<ExpectedService>,
    /// How close the satellites of its shells come to each other.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub separation: Vec<SeparationResult>,
    /// How the nodes of its shells turn against each other, for several shells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative_nodes: Option<RelativeNodes>,
    /// The constraints of the scenario, and whether they are met.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub constraints: Vec<ConstraintCheck>,
    /// The objectives and the constrained quantities, with their values.
    #[serde(skip)]
    pub quantities: Vec<(Quantity, Option<f64>)>,
}

/// A constraint of the scenario, checked for a constellation.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstraintCheck {
    /// The constraint as it is written: `max-pdop <= 2.5`.
    pub constraint: String,
    /// The quantity under it.
    pub quantity: String,
    /// Its value; `None` if it has none.
    pub value: Option<f64>,
    /// Whether it is met; `None` for a quantity of planes where they are not known.
    pub met: Option<bool>,
}

impl ConstraintCheck {
    /// The verdict in a word.
    #[must_use]
    pub fn verdict(&self) -> &'static str {
        match self.met {
            Some(true) => "met",
            Some(false) => "violated",
            None => "not defined",
        }
    }
}

impl Assessment {
    /// What was computed of the satellites of a constellation, under the goals of a scenario.
    #[must_use]
    pub fn new(
        satellites: CountedSatellites<'_>,
        (metrics, histograms): (Metrics, ViewHistograms),
        dops: Option<DopStatistics>,
        goals: &Goals,
    ) -> Self {
        let value = |quantity: Quantity| goals.value(quantity, satellites, &metrics);
        let check = |constraint: &Constraint| {
            let quantity = constraint.quantity;
            let solved = quantity.solved_fraction(&metrics);
            let is_met = || constraint.violation(value(quantity), solved) == 0.0;
            let is_defined = value(quantity).is_some() || !quantity.needs_planes();
            ConstraintCheck {
                constraint: constraint.to_string(),
                quantity: quantity.to_string(),
                value: value(quantity),
                met: is_defined.then(is_met),
            }
        };
        let constraints = goals.constraints.iter().map(check).collect();
        let quantities = goals.objectives.iter().copied();
        let quantities = quantities.chain(goals.constrained());
        let quantities = quantities.map(|one| (one, value(one))).collect();
        Self {
            metrics,
            histograms,
            dops,
            gnss_phases: None,
            failures: None,
            phases: None,
            expected: None,
            separation: satellites
                .shells
                .map_or_else(Vec::new, SeparationResult::of_design),
            relative_nodes: satellites.shells.and_then(RelativeNodes::of),
            constraints,
            quantities,
        }
    }

    /// The value of an objective or of a constrained quantity.
    #[must_use]
    pub fn value(&self, quantity: Quantity) -> Option<f64> {
        let known = self.quantities.iter().find(|(one, _)| *one == quantity);
        known?.1
    }
}

/// The output of `evaluate` for one design.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EvaluateResult {
    /// Its name, if it has one besides its notation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The design.
    pub design: DesignSummary,
    /// What is computed of it.
    #[serde(flatten)]
    pub evaluated: Assessment,
    /// The GNSS alone; `None` without GNSS.
    pub gnss_only: Option<Assessment>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

/// A constellation read from files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ConstellationSummary {
    /// Its name.
    pub name: String,
    /// The format of its files.
    pub format: String,
    /// Their content.
    pub content: String,
    /// Number of satellites.
    pub satellites: usize,
}

/// The output of `evaluate` for the satellites of files.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstellationResult {
    /// The constellation.
    pub constellation: ConstellationSummary,
    /// What is computed of it.
    #[serde(flatten)]
    pub evaluated: Assessment,
    /// The GNSS alone; `None` without GNSS.
    pub gnss_only: Option<Assessment>,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: &'static str,
}

/// One of several constellations.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ConstellationEntry {
    /// Its name.
    pub name: String,
    /// The notation of its shells.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub notation: Option<String>,
    /// The names of its files.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// The format of its files, and their content.
    #[serde(skip)]
    pub format_and_content: Option<(String, String)>,
    /// Number of satellites.
    pub satellites: usize,
    /// Its shells, field by field.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub design: Option<DesignSummary>,
    /// What is computed of it.
    #[serde(flatten)]
    pub evaluated: Assessment,
}

impl ConstellationEntry {
    /// The entry of a constellation, under the goals of a search that has these satellites from files fixed.
    #[must_use]
    pub fn new(
        constellation: &Constellation,
        metrics: (Metrics, ViewHistograms),
        dops: Option<DopStatistics>,
        (goals, fixed): (&Goals, Option<&FileSatellites>),
    ) -> Self {
        let satellites = constellation.satellite_count();
        let counted = constellation.counted(fixed);
        let design: Option<DesignSummary> = constellation.design.as_ref().map(Into::into);
        let files = constellation.files.as_ref();
        Self {
            name: constellation.name.clone(),
            notation: design.as_ref().map(|design| design.notation.clone()),
            files: files.map_or_else(Vec::new, |files| files.names.clone()),
            format_and_content: files.map(|files| (files.format(), files.fleet.content())),
            satellites,
            design,
            evaluated: Assessment::new(counted, metrics, dops, goals),
        }
    }

    /// The GNSS alone as a row of a table: no LEO satellite.
    #[must_use]
    pub fn of_gnss(evaluated: &Assessment) -> Self {
        Self {
            name: GNSS_ONLY.to_owned(),
            notation: None,
            files: Vec::new(),
            format_and_content: None,
            satellites: 0,
            design: None,
            evaluated: evaluated.clone(),
        }
    }

    /// The result of a constellation that was evaluated alone: of a design if it has no other satellites,
    /// of files if it has no shells.
    #[must_use]
    pub fn alone(self, gnss_only: Option<Assessment>, scenario: ScenarioStamp) -> Option<Alone> {
        match (self.design, self.format_and_content) {
            (Some(design), None) => Some(Alone::Design(Box::new(EvaluateResult {
                name: Some(self.name).filter(|name| *name != design.notation),
                design,
                evaluated: self.evaluated,
                gnss_only,
                scenario,
                version: VERSION,
            }))),
            (None, Some((format, content))) => Some(Alone::Files(Box::new(ConstellationResult {
                constellation: ConstellationSummary {
                    name: self.name,
                    format,
                    content,
                    satellites: self.satellites,
                },
                evaluated: self.evaluated,
                gnss_only,
                scenario,
                version: VERSION,
            }))),
            _ => None,
        }
    }

    /// What its satellites are: the notation, the files, or both.
    #[must_use]
    pub fn made_of(&self) -> String {
        let parts = self.notation.iter().chain(&self.files);
        parts.map(String::as_str).collect::<Vec<_>>().join("+")
    }
}

/// A constellation that was evaluated alone.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Alone {
    /// The shells of a design.
    Design(Box<EvaluateResult>),
    /// The satellites of files.
    Files(Box<ConstellationResult>),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::run::testing;
    use crate::search::LaunchCost;

    fn goals() -> Goals {
        Goals {
            objectives: vec![Quantity::JCost],
            constraints: ["satellites <= 30", "planes <= 4"]
                .map(|text| text.parse().unwrap())
                .to_vec(),
            launch_cost: LaunchCost {
                per_satellite: 1.0,
                per_plane: 5.0,
                per_1000_km: 0.2,
            },
            fixed: None,
            fixed_from_files: 0,
        }
    }

    /// Files have a number of satellites and no planes.
    #[test]
    fn a_constraint_that_only_designs_have_is_not_violated_by_files() {
        let design: Design = "delta:55:30/5/1@925".parse().unwrap();
        let metrics = testing::member(1, "delta:55:30/5/1@925").metrics;
        let verdicts = |satellites: CountedSatellites<'_>| {
            let metrics = (metrics, ViewHistograms::default());
            let evaluated = Assessment::new(satellites, metrics, None, &goals());
            let checks = evaluated.constraints.iter();
            checks.map(ConstraintCheck::verdict).collect::<Vec<_>>()
        };
        let of_files = CountedSatellites {
            from_files: 30,
            ..CountedSatellites::default()
        };
        assert_eq!(
            verdicts(CountedSatellites::of_design(&design)),
            ["met", "violated"]
        );
        assert_eq!(verdicts(of_files), ["met", "not defined"]);
    }
}

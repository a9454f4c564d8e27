//! The result of a validation, which a run directory may contain as well.

use super::{DesignSummary, ScenarioStamp, VERSION};
use crate::constellation::Design;
use crate::earth;
use crate::exchange::constellation::Constellation;
use crate::orbit::Model;
use crate::validate::{Findings, JUDGES, Judge};
use serde::{Deserialize, Serialize};

/// The output of `validate`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValidateResult {
    /// The design, if one design was validated.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub design: Option<DesignSummary>,
    /// The constellations, if they were several or held satellites from files.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub constellations: Vec<ValidatedConstellation>,
    /// The propagation model of the study, as a scenario spells it.
    pub model: String,
    /// The checks, and the budget of sgp4.
    #[serde(flatten)]
    pub findings: Findings,
    /// Whether every gate passed.
    pub passed: bool,
    /// The study.
    pub scenario: ScenarioStamp,
    /// The targets, in the order given.
    pub against: Vec<String>,
    /// The conventions behind every number.
    pub basis: Basis,
    /// Version of the program.
    pub version: String,
}

/// A constellation that was validated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValidatedConstellation {
    /// Its name, with which the names of its checks begin if there are others.
    pub name: String,
    /// The notation of its shells.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub notation: Option<String>,
    /// Its files, without their paths.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub files: Vec<String>,
    /// Number of satellites.
    pub satellites: usize,
}

impl From<&Constellation> for ValidatedConstellation {
    fn from(constellation: &Constellation) -> Self {
        let files = constellation.files.as_ref();
        Self {
            name: constellation.name.clone(),
            notation: constellation.design.as_ref().map(Design::to_string),
            files: files.map_or_else(Vec::new, |files| files.names.clone()),
            satellites: constellation.satellite_count(),
        }
    }
}

/// Constants and crates behind a validation. It uses no random numbers and no seed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Basis {
    /// Gravitational parameter, km³/s².
    pub mu_km3_s2: f64,
    /// Equatorial radius, km.
    pub radius_km: f64,
    /// Second zonal harmonic.
    pub j2: f64,
    /// Flattening of the ellipsoid.
    pub flattening: f64,
    /// The crates that act as references.
    pub judges: Vec<Judge>,
}

impl Default for Basis {
    fn default() -> Self {
        Self {
            mu_km3_s2: earth::MU_KM3_S2,
            radius_km: earth::RADIUS_KM,
            j2: earth::J2,
            flattening: earth::FLATTENING,
            judges: JUDGES.to_vec(),
        }
    }
}

impl ValidateResult {
    /// The result of validating constellations whose shells `model` propagates.
    #[must_use]
    pub fn new(
        constellations: &[Constellation],
        model: Model,
        against: Vec<String>,
        findings: Findings,
        scenario: ScenarioStamp,
    ) -> Self {
        let only = match constellations {
            [one] => one.only_design(),
            _ => None,
        };
        Self {
            design: only.map(DesignSummary::from),
            constellations: match only {
                Some(_) => Vec::new(),
                None => constellations.iter().map(Into::into).collect(),
            },
            model: model.to_string(),
            passed: findings.passed(),
            findings,
            scenario,
            against,
            basis: Basis::default(),
            version: VERSION.to_owned(),
        }
    }

    /// What was validated: the notation of the design, or the names of the constellations.
    #[must_use]
    pub fn subject(&self) -> String {
        match &self.design {
            Some(design) => design.notation.clone(),
            None => {
                let names = self.constellations.iter().map(|one| one.name.as_str());
                names.collect::<Vec<_>>().join(", ")
            }
        }
    }
}

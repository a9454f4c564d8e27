//! The result of a validation, which a run directory may contain as well.

use super::{DesignSummary, ScenarioStamp, VERSION};
use crate::constellation::Design;
use crate::earth;
use crate::orbit::Model;
use crate::validate::{Findings, JUDGES, Judge};
use serde::{Deserialize, Serialize};

/// The output of `validate`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ValidateResult {
    /// The design.
    pub design: DesignSummary,
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
    /// The result of validating one design that `model` propagates.
    #[must_use]
    pub fn new(
        design: &Design,
        model: Model,
        against: Vec<String>,
        findings: Findings,
        scenario: ScenarioStamp,
    ) -> Self {
        Self {
            design: design.into(),
            model: model.to_string(),
            passed: findings.passed(),
            findings,
            scenario,
            against,
            basis: Basis::default(),
            version: VERSION.to_owned(),
        }
    }
}

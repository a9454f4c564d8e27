//! Metrics that are computed where a setup asks for them, and how they are named in tables.

use super::Metrics;
use super::accuracy::SigmaSpread;
use serde::{Deserialize, Deserializer};

/// A metric that is computed on demand: `None` if it was not asked for, `Some(None)` if it has no value.
pub type OnDemand<T> = Option<Option<T>>;

/// A value that is there, which may be null.
pub(super) fn given<'de, T: Deserialize<'de>, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<OnDemand<T>, D::Error> {
    Option::deserialize(deserializer).map(Some)
}

/// The fields of [`Metrics`] that are computed on demand.
const FIELDS: [&str; 9] = [
    "information_pdop",
    "sigma_3d_m",
    "sigma_h_m",
    "sigma_v_m",
    "error95_3d_m",
    "error95_h_m",
    "error95_v_m",
    "n1",
    "expected_availability",
];

impl Metrics {
    /// Whether a field of the metrics is computed on demand.
    #[must_use]
    pub fn is_on_demand(field: &str) -> bool {
        FIELDS.contains(&field)
    }

    /// What was computed on demand, number by number, named as the columns of tables.
    #[must_use]
    pub fn on_demand(&self) -> Vec<(String, Option<f64>)> {
        let mut columns = Vec::new();
        let mut add =
            |field: &str, part: &str, value| columns.push((format!("{field}{part}"), value));
        if let Some(of) = &self.information_pdop {
            for (part, value) in [("_mean", of.mean), ("_p95", of.p95), ("_cvar", of.cvar)] {
                add(FIELDS[0], part, value);
            }
            add(FIELDS[0], "_solved_fraction", Some(of.solved_fraction));
        }
        let sigmas = [self.sigma_3d_m, self.sigma_h_m, self.sigma_v_m];
        for (field, sigma) in FIELDS[1..4].iter().zip(sigmas) {
            let Some(spread) = sigma else { continue };
            let part = |of: fn(SigmaSpread) -> f64| spread.map(of);
            add(field, "_mean", part(|of| of.mean));
            add(field, "_p95", part(|of| of.p95));
            add(field, "_cvar", part(|of| of.cvar));
        }
        let errors = [self.error95_3d_m, self.error95_h_m, self.error95_v_m];
        for (field, error) in FIELDS[4..7].iter().zip(errors) {
            if let Some(error) = error {
                add(field, "", error);
            }
        }
        if let Some(of) = &self.n1 {
            add(FIELDS[7], "_max_pdop", of.max_pdop);
            add(FIELDS[7], "_cvar_pdop", of.cvar_pdop);
            add(FIELDS[7], "_availability", Some(of.availability));
            add(FIELDS[7], "_solved_fraction", Some(of.solved_fraction));
        }
        if self.expected_availability.is_some() {
            add(FIELDS[8], "", self.expected_availability);
        }
        columns
    }
}

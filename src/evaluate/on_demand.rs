//! Metrics that are computed where a setup asks for them, and how they are named in tables.

use super::accuracy::SigmaSpread;
use super::{Gain, Metrics};
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
const FIELDS: [&str; 11] = [
    "gain",
    "information_pdop",
    "accuracy_solved_fraction",
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
        let mut add = |name: String, value| columns.push((name, value));
        if let Some(of) = &self.information_pdop {
            let parts = [("mean", of.mean), ("p95", of.p95), ("cvar", of.cvar)];
            for (part, value) in parts {
                add(format!("information_pdop_{part}"), value);
            }
            let solved = Some(of.solved_fraction);
            add("information_pdop_solved_fraction".to_owned(), solved);
        }
        if let Some(solved) = self.accuracy_solved_fraction {
            add("accuracy_solved_fraction".to_owned(), Some(solved));
        }
        let sigmas = [
            ("sigma_3d_m", self.sigma_3d_m),
            ("sigma_h_m", self.sigma_h_m),
            ("sigma_v_m", self.sigma_v_m),
        ];
        for (field, sigma) in sigmas {
            let Some(spread) = sigma else { continue };
            let part = |of: fn(SigmaSpread) -> f64| spread.map(of);
            add(format!("{field}_mean"), part(|of| of.mean));
            add(format!("{field}_p95"), part(|of| of.p95));
            add(format!("{field}_cvar"), part(|of| of.cvar));
        }
        let errors = [
            ("error95_3d_m", self.error95_3d_m),
            ("error95_h_m", self.error95_h_m),
            ("error95_v_m", self.error95_v_m),
        ];
        for (field, error) in errors {
            if let Some(error) = error {
                add(field.to_owned(), error);
            }
        }
        if let Some(of) = &self.n1 {
            add("n1_max_pdop".to_owned(), of.max_pdop);
            if let Some(tail) = of.cvar_pdop {
                add("n1_cvar_pdop".to_owned(), tail);
            }
            add("n1_availability".to_owned(), Some(of.availability));
            add("n1_solved_fraction".to_owned(), Some(of.solved_fraction));
        }
        if self.expected_availability.is_some() {
            add(
                "expected_availability".to_owned(),
                self.expected_availability,
            );
        }
        for (name, value) in self.gain.iter().flat_map(Gain::named) {
            add(format!("gain_{name}"), value);
        }
        columns
    }
}

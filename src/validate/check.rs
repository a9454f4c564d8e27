//! A check: a number, its gate and its outcome.

use crate::keyword::keywords;
use serde::{Deserialize, Deserializer, Serialize};
use std::fmt;

/// One number of a validation, with the bound that it must meet.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Check {
    /// Unique name, `target/case/quantity`.
    pub name: String,
    /// What was measured.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Which statistic of it.
    pub statistic: String,
    /// The value; JSON has `null` for one that is not finite.
    #[serde(deserialize_with = "null_is_nan")]
    pub value: f64,
    /// The bound on its size; `None` when it is reported only.
    pub gate: Option<f64>,
    /// Whether the value meets its gate; `None` when there is no gate.
    pub passed: Option<bool>,
    /// The physical reason of the bound, or what the number shows.
    pub reason: String,
}

keywords! {
    /// What a report says of a [`Check`].
    Outcome {
        /// The value meets its gate.
        Pass = "pass",
        /// The value misses its gate.
        Fail = "FAIL",
        /// There is no gate: the value is for information.
        Info = "info",
    }
}

/// What the number of a [`Check`] is.
#[derive(Debug, Clone, Copy)]
pub struct CheckedQuantity<'a> {
    /// What was measured.
    pub quantity: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Which statistic of it.
    pub statistic: &'a str,
}

impl Check {
    /// A check whose gate bounds |value|; a value that is not a number never passes a gate.
    #[must_use]
    pub fn new(
        name: &str,
        measure: CheckedQuantity<'_>,
        value: f64,
        gate: Option<f64>,
        reason: &str,
    ) -> Self {
        Self {
            name: name.to_owned(),
            quantity: measure.quantity.to_owned(),
            unit: measure.unit.to_owned(),
            statistic: measure.statistic.to_owned(),
            value,
            gate,
            passed: gate.map(|gate| value.abs() <= gate),
            reason: reason.to_owned(),
        }
    }

    /// What a report says of it.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        match (self.gate, self.passed) {
            (None, _) => Outcome::Info,
            (Some(_), Some(true)) => Outcome::Pass,
            // A gate without a verdict is not met.
            (Some(_), _) => Outcome::Fail,
        }
    }
}

/// How many checks have each outcome.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// Gates that are met.
    pub passed: usize,
    /// Gates that are missed.
    pub failed: usize,
    /// Checks without a gate.
    pub info: usize,
}

impl Tally {
    /// The outcomes of `checks`.
    #[must_use]
    pub fn of(checks: &[Check]) -> Self {
        let mut tally = Self::default();
        for check in checks {
            match check.outcome() {
                Outcome::Pass => tally.passed += 1,
                Outcome::Fail => tally.failed += 1,
                Outcome::Info => tally.info += 1,
            }
        }
        tally
    }

    /// Checks with a gate.
    #[must_use]
    pub fn gates(self) -> usize {
        self.passed + self.failed
    }
}

impl fmt::Display for Tally {
    /// The verdict of a report in one line.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.failed, self.gates()) {
            (_, 0) => write!(formatter, "no gates")?,
            (0, gates) => write!(formatter, "passed: all {gates} gates")?,
            (failed, gates) => write!(formatter, "FAILED: {failed} of {gates} gates")?,
        }
        match self.info {
            0 => Ok(()),
            1 => write!(formatter, "; 1 check has no gate (info)"),
            info => write!(formatter, "; {info} checks have no gate (info)"),
        }
    }
}

fn null_is_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_bound_the_size() {
        let outcome = |value, gate| {
            Check::new(
                "a/b",
                CheckedQuantity {
                    quantity: "q",
                    unit: "km",
                    statistic: "max",
                },
                value,
                gate,
                "",
            )
            .outcome()
        };
        assert_eq!(outcome(-1.0, Some(1.0)), Outcome::Pass);
        assert_eq!(outcome(-1.1, Some(1.0)), Outcome::Fail);
        assert_eq!(outcome(1e9, None), Outcome::Info);
        assert_eq!(outcome(f64::NAN, Some(1.0)), Outcome::Fail);
    }
}

//! Checks against standards that this library did not write: residuals, budgets and gates.

pub mod paper;
pub mod residuals;
pub mod sgp4;

use residuals::BudgetLine;
use serde::Serialize;

/// One number of a validation, with the bound that it must keep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Check {
    /// Unique name, `target/case/quantity`.
    pub name: String,
    /// What was measured.
    pub quantity: String,
    /// Its unit.
    pub unit: String,
    /// Which statistic of it.
    pub statistic: String,
    /// The value.
    pub value: f64,
    /// The bound on its size; `None` when it is reported only.
    pub gate: Option<f64>,
    /// Whether the value keeps its bound (true when there is none).
    pub passed: bool,
    /// The physical reason of the bound, or what the number shows.
    pub reason: String,
}

impl Check {
    /// A check whose gate bounds |value|; a value that is not a number never passes a gate.
    #[must_use]
    pub fn new(
        name: &str,
        [quantity, unit, statistic]: [&str; 3],
        value: f64,
        gate: Option<f64>,
        reason: &str,
    ) -> Self {
        Self {
            name: name.to_owned(),
            quantity: quantity.to_owned(),
            unit: unit.to_owned(),
            statistic: statistic.to_owned(),
            value,
            gate,
            passed: gate.is_none_or(|gate| value.abs() <= gate),
            reason: reason.to_owned(),
        }
    }
}

/// What a validation found.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct Findings {
    /// The checks, in the order in which they are read.
    pub checks: Vec<Check>,
    /// The error budget by cause, for comparisons of trajectories.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub budget: Vec<BudgetLine>,
}

impl Findings {
    /// Whether every gate is kept.
    #[must_use]
    pub fn passed(&self) -> bool {
        self.checks.iter().all(|check| check.passed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gates_bound_the_size() {
        let check = |value, gate| Check::new("a/b", ["q", "km", "max"], value, gate, "").passed;
        assert!(check(-1.0, Some(1.0)) && !check(-1.1, Some(1.0)));
        assert!(check(1e9, None));
        assert!(!check(f64::NAN, Some(1.0)));
    }
}

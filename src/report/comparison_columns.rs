//! The columns of a table of constellations for reading, in a terminal and on a page.

use super::shown;
use crate::evaluate::Metrics;
use crate::scenario::Scenario;
use crate::search::Quantity;
use crate::units::round_decimal;

/// A number that constellations are compared by.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ComparisonColumn {
    /// A quantity that can be optimised or bound.
    Quantity(Quantity),
    /// The fraction of solved samples.
    SolvedFraction,
}

/// The columns that every table has.
const ALWAYS: [ComparisonColumn; 11] = [
    ComparisonColumn::Quantity(Quantity::Satellites),
    ComparisonColumn::Quantity(Quantity::MeanVisible),
    ComparisonColumn::Quantity(Quantity::MeanPdop),
    ComparisonColumn::Quantity(Quantity::CvarPdop),
    ComparisonColumn::Quantity(Quantity::MaxPdop),
    ComparisonColumn::SolvedFraction,
    ComparisonColumn::Quantity(Quantity::Availability),
    ComparisonColumn::Quantity(Quantity::LeastVisible),
    ComparisonColumn::Quantity(Quantity::LongestOutageS),
    ComparisonColumn::Quantity(Quantity::JPos),
    ComparisonColumn::Quantity(Quantity::JCost),
];

/// The columns of a table in a scenario: those of every table, then its other objectives and constrained quantities.
#[must_use]
pub fn comparison_columns(scenario: &Scenario) -> Vec<ComparisonColumn> {
    let goals = scenario.goals();
    let wanted = goals.objectives.iter().copied().chain(goals.constrained());
    let mut columns = ALWAYS.to_vec();
    for column in wanted.map(ComparisonColumn::Quantity) {
        if !columns.contains(&column) {
            columns.push(column);
        }
    }
    columns
}

impl ComparisonColumn {
    /// The heading, in one or two lines.
    #[must_use]
    pub fn heading(self, scenario: &Scenario) -> String {
        let objectives = &scenario.objectives;
        let quantity = match self {
            Self::SolvedFraction => return "solved\nfraction".to_owned(),
            Self::Quantity(quantity) => quantity,
        };
        match quantity {
            Quantity::MeanVisible => "mean\nvisible".to_owned(),
            Quantity::MeanPdop => "mean\nPDOP".to_owned(),
            Quantity::CvarPdop => {
                let tail = round_decimal(100.0 * (1.0 - objectives.cvar_level), 4);
                format!("CVaR of PDOP\n(worst {tail} %)")
            }
            Quantity::MaxPdop => "maximum\nPDOP".to_owned(),
            Quantity::Availability => {
                format!("availability\n(PDOP <= {})", objectives.availability_pdop)
            }
            Quantity::LeastVisible => "least\nvisible".to_owned(),
            Quantity::LongestOutageS => "longest\noutage (s)".to_owned(),
            Quantity::JPos => "J_pos".to_owned(),
            Quantity::JCost => "J_cost".to_owned(),
            other => other.to_string(),
        }
    }

    /// Whether it is computed only where the scenario asks for it.
    #[must_use]
    pub fn is_on_demand(self) -> bool {
        matches!(self, Self::Quantity(quantity) if quantity.is_on_demand())
    }

    /// The value of a constellation with these metrics, of which `quantity` has the quantities.
    pub fn value(
        self,
        metrics: &Metrics,
        quantity: impl FnOnce(Quantity) -> Option<f64>,
    ) -> Option<f64> {
        match self {
            Self::SolvedFraction => Some(metrics.solved_fraction),
            Self::Quantity(one) => quantity(one),
        }
    }

    /// A value with the digits that it is good for.
    #[must_use]
    pub fn text(self, value: Option<f64>) -> String {
        match self {
            Self::SolvedFraction => shown::share(value),
            Self::Quantity(quantity) => shown::quantity(quantity, value),
        }
    }

    /// The value such that less is better.
    #[cfg(feature = "figures")]
    pub(crate) fn minimised(self, value: f64) -> f64 {
        match self {
            Self::SolvedFraction => -value,
            Self::Quantity(quantity) => quantity.minimised(value),
        }
    }
}

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
    /// The fraction of samples that have an accuracy in metres.
    AccuracySolvedFraction,
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

/// The accuracy in metres.
const METRES: [Quantity; 6] = [
    Quantity::Sigma3dM,
    Quantity::SigmaHM,
    Quantity::SigmaVM,
    Quantity::Error953dM,
    Quantity::Error95HM,
    Quantity::Error95VM,
];

/// What is shown of the gain over the GNSS alone.
const GAINS: [Quantity; 3] = [
    Quantity::GainMeanPdop,
    Quantity::GainCvarPdop,
    Quantity::GainMaxPdop,
];

/// The quantities on demand that are shown in a scenario, because it has what they need.
#[must_use]
pub fn on_demand_quantities(scenario: &Scenario) -> Vec<Quantity> {
    let gnss = &scenario.gnss;
    let has_gnss = !gnss.constellations.is_empty() || !gnss.files.is_empty();
    let has_window = scenario.metrics.window_min.is_some();
    let has_metres = scenario.accuracy.leo_m.is_some();
    let groups: [(bool, &[Quantity]); 3] = [
        (has_gnss, &GAINS),
        (has_window, &[Quantity::InformationPdop]),
        (has_metres, &METRES),
    ];
    let asked = groups.into_iter().filter(|(is_asked, _)| *is_asked);
    asked.flat_map(|(_, group)| group).copied().collect()
}

/// The columns of a table in a scenario: those of every table, then its other objectives and constrained quantities,
/// then what is computed on demand.
#[must_use]
pub fn comparison_columns(scenario: &Scenario) -> Vec<ComparisonColumn> {
    let goals = scenario.goals();
    let on_demand = on_demand_quantities(scenario);
    let wanted = goals.objectives.iter().copied().chain(goals.constrained());
    let wanted = wanted.filter(|one| !on_demand.contains(one));
    let mut columns = ALWAYS.to_vec();
    for column in wanted.map(ComparisonColumn::Quantity) {
        if !columns.contains(&column) {
            columns.push(column);
        }
    }
    for quantity in &on_demand {
        if *quantity == METRES[0] {
            columns.push(ComparisonColumn::AccuracySolvedFraction);
        }
        columns.push(ComparisonColumn::Quantity(*quantity));
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
            Self::AccuracySolvedFraction => return "solved\nin metres".to_owned(),
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
            Quantity::InformationPdop => "mean PDOP\nof a window".to_owned(),
            Quantity::Sigma3dM => "position\n1 sigma (m)".to_owned(),
            Quantity::SigmaHM => "horizontal\n1 sigma (m)".to_owned(),
            Quantity::SigmaVM => "height\n1 sigma (m)".to_owned(),
            Quantity::Error953dM => "position\n95 % (m)".to_owned(),
            Quantity::Error95HM => "horizontal\n95 % (m)".to_owned(),
            Quantity::Error95VM => "height\n95 % (m)".to_owned(),
            Quantity::GainMeanPdop => "gain in\nmean PDOP".to_owned(),
            Quantity::GainCvarPdop => "gain in CVaR\nof PDOP".to_owned(),
            Quantity::GainMaxPdop => "gain in\nmaximum PDOP".to_owned(),
            other => other.to_string(),
        }
    }

    /// The value of a constellation with these metrics, of which `quantity` has the quantities.
    pub fn value(
        self,
        metrics: &Metrics,
        quantity: impl FnOnce(Quantity) -> Option<f64>,
    ) -> Option<f64> {
        match self {
            Self::SolvedFraction => Some(metrics.solved_fraction),
            Self::AccuracySolvedFraction => metrics.accuracy_solved_fraction,
            Self::Quantity(one) => quantity(one),
        }
    }

    /// A value with the digits that it is good for.
    #[must_use]
    pub fn text(self, value: Option<f64>) -> String {
        match self {
            Self::SolvedFraction | Self::AccuracySolvedFraction => shown::share(value),
            Self::Quantity(quantity) => shown::quantity(quantity, value),
        }
    }

    /// The value such that less is better.
    #[cfg(feature = "figures")]
    pub(crate) fn minimised(self, value: f64) -> f64 {
        match self {
            Self::SolvedFraction | Self::AccuracySolvedFraction => -value,
            Self::Quantity(quantity) => quantity.minimised(value),
        }
    }
}

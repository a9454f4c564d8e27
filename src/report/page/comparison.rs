//! The table of the compared constellations, and what it says.

use super::Page;
use crate::ephemeris::Ephemeris;
use crate::evaluate::Metrics;
use crate::keyword::Keyword;
use crate::report::dominance::dominance;
use crate::report::{Baseline, shown};
use crate::scenario::Quantity;
use crate::search::Goals;

/// The compared constellations, one row each, and the GNSS alone.
pub(super) struct Comparison {
    /// Headings of the columns of numbers.
    pub(super) columns: Vec<String>,
    pub(super) rows: Vec<Row>,
    /// Who dominates whom.
    pub(super) dominance: Option<String>,
    /// Whether the best of a column is marked.
    pub(super) has_best: bool,
}

/// A row of the table.
pub(super) struct Row {
    /// Its place among all that can be selected; `None` for the GNSS alone.
    pub(super) place: Option<usize>,
    pub(super) name: String,
    /// Notation or files; empty if that is the name.
    pub(super) made_of: String,
    pub(super) cells: Vec<Cell>,
}

/// A number of the table.
pub(super) struct Cell {
    pub(super) text: String,
    pub(super) is_best: bool,
}

/// Quantities that have a column in every table.
const ALWAYS: [Quantity; 7] = [
    Quantity::MeanVisible,
    Quantity::MeanPdop,
    Quantity::CvarPdop,
    Quantity::MaxPdop,
    Quantity::Availability,
    Quantity::JPos,
    Quantity::JCost,
];

impl Comparison {
    /// `None` if nothing is compared.
    pub(super) fn new(page: &Page<'_>) -> Option<Self> {
        let scenario = page.run.scenario.as_ref()?;
        if page.compared.is_empty() {
            return None;
        }
        let goals = scenario.goals();
        let mut quantities = vec![Quantity::Satellites];
        let wanted = goals.objectives.iter().copied().chain(ALWAYS);
        for quantity in wanted.chain(goals.constrained()) {
            if !quantities.contains(&quantity) {
                quantities.push(quantity);
            }
        }
        let compared: Vec<&Baseline> = page.compared.iter().map(|one| &one.baseline).collect();
        let values: Vec<Vec<Option<f64>>> = page
            .compared
            .iter()
            .map(|one| {
                let (design, metrics) = (one.constellation.only_design(), &one.baseline.metrics);
                let satellites = (one.baseline.satellites, design);
                let value = |q: &Quantity| goals.value(*q, satellites, metrics);
                quantities.iter().map(value).collect()
            })
            .collect();
        let is_judged = |quantity: &Quantity| {
            *quantity != Quantity::Satellites || goals.objectives.contains(quantity)
        };
        let best: Vec<Option<String>> = quantities
            .iter()
            .enumerate()
            .map(|(n, quantity)| {
                let column = values.iter().map(|row| row[n]);
                is_judged(quantity).then(|| best(*quantity, column))?
            })
            .collect();
        let first = page.run.front.len();
        let mut rows: Vec<Row> = compared
            .iter()
            .zip(&values)
            .enumerate()
            .map(|(n, (one, values))| Row {
                place: Some(first + n),
                name: one.name.clone(),
                made_of: if one.notation == one.name {
                    String::new()
                } else {
                    one.notation.clone()
                },
                cells: cells(&quantities, values, &best),
            })
            .collect();
        if let Some(metrics) = gnss_alone(page) {
            rows.push(without_leo(&quantities, &metrics, &goals));
        }
        let names = page.run.objective_names();
        Some(Self {
            columns: quantities.iter().map(|q| heading(*q).to_owned()).collect(),
            rows,
            dominance: dominance(&compared, &names),
            has_best: best.iter().any(Option::is_some),
        })
    }
}

fn cells(quantities: &[Quantity], values: &[Option<f64>], best: &[Option<String>]) -> Vec<Cell> {
    let cells = quantities.iter().zip(values).zip(best);
    let cell = |((quantity, value), best): ((&Quantity, &Option<f64>), &Option<String>)| {
        let text = shown::quantity(*quantity, *value);
        Cell {
            is_best: best.as_ref() == Some(&text),
            text,
        }
    };
    cells.map(cell).collect()
}

/// The text of the best value of a column; `None` if there are not two that differ as shown.
fn best(quantity: Quantity, column: impl Iterator<Item = Option<f64>>) -> Option<String> {
    let mut values: Vec<f64> = column.flatten().collect();
    values.sort_by(|a, b| quantity.minimised(*a).total_cmp(&quantity.minimised(*b)));
    let text = |value: Option<&f64>| shown::quantity(quantity, value.copied());
    let first = text(values.first());
    (values.len() > 1 && first != text(values.last())).then_some(first)
}

/// The metrics without LEO satellites; none without GNSS.
fn gnss_alone(page: &Page<'_>) -> Option<Metrics> {
    let evaluator = page.evaluator.filter(|one| !one.setup().gnss.is_empty())?;
    let nothing = Ephemeris::new(evaluator.setup().grid, Vec::new());
    evaluator.evaluate_ephemeris(&nothing).ok()
}

fn without_leo(quantities: &[Quantity], metrics: &Metrics, goals: &Goals) -> Row {
    let value = |quantity: &Quantity| goals.value(*quantity, (0, None), metrics);
    let values: Vec<Option<f64>> = quantities.iter().map(value).collect();
    Row {
        place: None,
        name: "GNSS alone".to_owned(),
        made_of: String::new(),
        cells: cells(quantities, &values, &vec![None; quantities.len()]),
    }
}

/// The heading of a column.
fn heading(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::MeanVisible => "mean visible",
        Quantity::MeanPdop => "mean PDOP",
        Quantity::CvarPdop => "CVaR of PDOP",
        Quantity::MaxPdop => "maximum PDOP",
        other => other.keyword(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_of_a_column_has_the_direction_of_its_quantity() {
        let of = |quantity, values: &[Option<f64>]| best(quantity, values.iter().copied());
        let values = [Some(1.5), None, Some(0.5)];
        assert_eq!(of(Quantity::MeanPdop, &values).unwrap(), "0.5000");
        assert_eq!(of(Quantity::MeanVisible, &values).unwrap(), "1.5000");
        // The same as shown, and one alone.
        assert_eq!(
            of(Quantity::Availability, &[Some(0.999_999), Some(1.0)]),
            None
        );
        assert_eq!(of(Quantity::JPos, &[Some(1.0), None]), None);
    }
}

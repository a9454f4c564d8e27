//! The table of the compared constellations, and what it says.

use super::Page;
use crate::ephemeris::Ephemeris;
use crate::evaluate::Metrics;
use crate::report::dominance::dominance;
use crate::report::{Baseline, ComparisonColumn, comparison_columns};
use crate::scenario::Quantity;
use crate::search::{CountedSatellites, Goals};

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

impl Comparison {
    /// `None` if nothing is compared.
    pub(super) fn new(page: &Page<'_>) -> Option<Self> {
        let scenario = page.run.scenario.as_ref()?;
        if page.compared.is_empty() {
            return None;
        }
        let goals = scenario.goals();
        let columns = comparison_columns(scenario);
        let values: Vec<Vec<Option<f64>>> = page
            .compared
            .iter()
            .map(|one| {
                let metrics = &one.baseline.metrics;
                let satellites = one.constellation.counted(None);
                let value = |q: Quantity| match one.baseline.sought(q, &goals) {
                    Some(value) => value,
                    None => goals.value(q, satellites, metrics),
                };
                let columns = columns.iter();
                columns.map(|column| column.value(metrics, value)).collect()
            })
            .collect();
        let is_judged = |column: ComparisonColumn| {
            column != ComparisonColumn::Quantity(Quantity::Satellites)
                || goals.objectives.contains(&Quantity::Satellites)
        };
        let best: Vec<Option<String>> = columns
            .iter()
            .enumerate()
            .map(|(n, &column)| {
                let values = values.iter().map(|row| row[n]);
                is_judged(column).then(|| best(column, values))?
            })
            .collect();
        let first = page.run.front.len();
        let compared: Vec<&Baseline> = page.compared.iter().map(|one| &one.baseline).collect();
        let mut rows: Vec<Row> = compared
            .iter()
            .zip(&values)
            .enumerate()
            .map(|(n, (one, values))| Row {
                place: Some(first + n),
                name: one.name.clone(),
                made_of: if one.made_of == one.name {
                    String::new()
                } else {
                    one.made_of.clone()
                },
                cells: cells(&columns, values, &best),
            })
            .collect();
        if let Some(metrics) = gnss_alone(page) {
            rows.push(without_leo(&columns, &metrics, &goals));
        }
        let names = page.run.objective_names();
        let heading = |column: &ComparisonColumn| column.heading(scenario).replace('\n', " ");
        Some(Self {
            columns: columns.iter().map(heading).collect(),
            rows,
            dominance: dominance(&compared, &names),
            has_best: best.iter().any(Option::is_some),
        })
    }
}

fn cells(
    columns: &[ComparisonColumn],
    values: &[Option<f64>],
    best: &[Option<String>],
) -> Vec<Cell> {
    let cells = columns.iter().zip(values).zip(best);
    let cell = |((column, value), best): ((&ComparisonColumn, &Option<f64>), &Option<String>)| {
        let text = column.text(*value);
        Cell {
            is_best: best.as_ref() == Some(&text),
            text,
        }
    };
    cells.map(cell).collect()
}

/// The text of the best value of a column; `None` if there are not two that differ as shown.
fn best(column: ComparisonColumn, values: impl Iterator<Item = Option<f64>>) -> Option<String> {
    let mut values: Vec<f64> = values.flatten().collect();
    values.sort_by(|a, b| column.minimised(*a).total_cmp(&column.minimised(*b)));
    let text = |value: Option<&f64>| column.text(value.copied());
    let first = text(values.first());
    (values.len() > 1 && first != text(values.last())).then_some(first)
}

/// The metrics without LEO satellites; none without GNSS.
fn gnss_alone(page: &Page<'_>) -> Option<Metrics> {
    let evaluator = page.evaluator.filter(|one| !one.setup().gnss.is_empty())?;
    let nothing = Ephemeris::new(evaluator.setup().grid, Vec::new());
    evaluator.evaluate_ephemeris(&nothing).ok()
}

fn without_leo(columns: &[ComparisonColumn], metrics: &Metrics, goals: &Goals) -> Row {
    let value = |quantity: Quantity| goals.value(quantity, CountedSatellites::default(), metrics);
    let values = columns.iter().map(|column| column.value(metrics, value));
    Row {
        place: None,
        name: "GNSS alone".to_owned(),
        made_of: String::new(),
        cells: cells(
            columns,
            &values.collect::<Vec<_>>(),
            &vec![None; columns.len()],
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_of_a_column_has_the_direction_of_its_quantity() {
        let of = |quantity, values: &[Option<f64>]| {
            best(ComparisonColumn::Quantity(quantity), values.iter().copied())
        };
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

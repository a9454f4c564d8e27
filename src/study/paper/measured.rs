//! Table II measured: as printed, at the inclinations that fit, and with one assumption changed.

use super::{PaperError, TableRow, assumptions, fit, lines, table2};
use crate::constellation::Design;
use crate::evaluate::{Evaluator, Metrics, Setup};
use rayon::prelude::*;
use serde::Serialize;

/// One design under one set of assumptions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct RowValue {
    /// N̄.
    pub mean_visible: f64,
    /// Mean PDOP.
    pub mean_pdop: Option<f64>,
    /// Equation (8).
    pub j_pos: Option<f64>,
    /// Equation (9).
    pub j_cost: Option<f64>,
}

impl From<Metrics> for RowValue {
    fn from(metrics: Metrics) -> Self {
        Self {
            mean_visible: metrics.mean_visible,
            mean_pdop: metrics.mean_pdop,
            j_pos: metrics.j_pos,
            j_cost: metrics.j_cost,
        }
    }
}

/// All rows of Table II under one set of assumptions, in its order.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// What is assumed, in words.
    pub assumption: String,
    /// Row by row.
    pub values: Vec<RowValue>,
}

/// Table II under a setup, and under each setup that differs in one assumption.
pub(super) struct Measurements {
    /// The table.
    pub(super) rows: Vec<TableRow>,
    /// As printed.
    pub(super) printed: Measured,
    /// Inclination that fits each row if the printed one does not, degrees.
    pub(super) fitted: Vec<Option<f64>>,
    /// The designs at these inclinations, or as printed.
    pub(super) moved: Vec<Design>,
    /// These designs under the setup.
    pub(super) at_fitting: Measured,
    /// The designs as printed, with one assumption changed each.
    pub(super) alternatives: Vec<Measured>,
}

impl Measurements {
    /// The table under the setup of an evaluator.
    pub(super) fn new(evaluator: &Evaluator) -> Result<Self, PaperError> {
        let setup = evaluator.setup();
        let rows = table2()?;
        let designs: Vec<Design> = rows.iter().map(|row| row.design.clone()).collect();
        let printed = measure(evaluator, "as in the scenario", &designs)?;
        let fitted = fitted_rows(setup, &rows)?;
        let moved: Vec<Design> = (rows.iter().zip(&fitted))
            .map(|(row, fit)| fit.map_or(Ok(row.design.clone()), |i| fit::inclined(&row.design, i)))
            .collect::<Result<_, _>>()?;
        let at_fitting = measure(evaluator, "the inclination that fits N̄", &moved)?;
        let alternatives = assumptions::alternatives(setup)?
            .into_iter()
            .map(|other| measure(&Evaluator::new(other.setup)?, &other.name, &designs))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            rows,
            printed,
            fitted,
            moved,
            at_fitting,
            alternatives,
        })
    }
}

fn measure(
    evaluator: &Evaluator,
    assumption: &str,
    designs: &[Design],
) -> Result<Measured, PaperError> {
    let value = |design: &Design| Ok::<RowValue, PaperError>(evaluator.evaluate(design)?.into());
    Ok(Measured {
        assumption: assumption.to_owned(),
        values: designs.par_iter().map(value).collect::<Result<_, _>>()?,
    })
}

/// The inclination that fits each row, where the printed one does not give its N̄.
fn fitted_rows(setup: &Setup, rows: &[TableRow]) -> Result<Vec<Option<f64>>, PaperError> {
    let sky = Evaluator::new(fit::sky(setup))?;
    let fit = |row: &TableRow| {
        let printed = sky.evaluate(&row.design)?.mean_visible;
        if (printed - row.mean_visible).abs() <= lines::VISIBLE_TOLERANCE {
            return Ok(None);
        }
        fit::fitting_inclination(&sky, row)
    };
    rows.par_iter().map(fit).collect()
}

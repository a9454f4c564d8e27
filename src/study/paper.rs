//! The paper's study: its tables, figures and percentages next to ours.
//!
//! C. Zhang, J. Zhao, Z. Liu et al., "LEO-NA Walker Constellation Design with Bi-objective
//! Optimisation Approaches". What the paper does not state (mask, surface, clocks, slots, epoch) is
//! taken from the setup, and every statement is also tested with one assumption changed at a time.

mod assumptions;
mod figures;
mod fit;
mod lines;
mod measured;
mod searches;
mod table;

use super::judge::{Expected, Statement};
pub use figures::{Curve, Figures, PlacedDesign};
pub use fit::{MaskFit, RowMask};
pub use lines::{JudgedRow, PDOP_TOLERANCE_PERCENT, VISIBLE_TOLERANCE};
pub use measured::{Measured, RowValue};
pub use searches::{FoundMember, FoundSet};
pub use table::{PERCENTAGES, Percentage, Printable, Scheme, TABLE1, TableRow, table2};

use crate::constellation::{Design, DesignError, NotationError, Shell, ShellParameters};
use crate::ephemeris::EphemerisError;
use crate::evaluate::{Evaluator, Setup};
use crate::ground::GroundError;
use crate::keyword::UnknownKeyword;
use crate::optimize::{DecisionError, Nsga2Config, OptimizeError};
use crate::search::ShellSpace;
use crate::time::TimeError;
use crate::visibility::MaskError;
use measured::Measurements;
use serde::Serialize;
use thiserror::Error;

/// Why the study cannot be reproduced.
#[derive(Debug, Error)]
pub enum PaperError {
    /// The built-in data cannot be read.
    #[error("the paper's Table II: {0}")]
    Table(#[from] csv::Error),
    /// A scheme of Table II has no name.
    #[error("the paper's Table II: {0}")]
    Scheme(#[from] UnknownKeyword),
    /// A design of Table II is invalid.
    #[error("the paper's Table II: {0}")]
    Notation(#[from] NotationError),
    /// A statement names a row that does not exist.
    #[error("the paper's Table II has no row {0}")]
    NoRow(String),
    /// A fitted design is invalid.
    #[error(transparent)]
    Design(#[from] DesignError),
    /// A satellite cannot be propagated.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// A search cannot run.
    #[error(transparent)]
    Optimize(#[from] OptimizeError),
    /// No design of a set can be picked.
    #[error(transparent)]
    Decision(#[from] DecisionError),
    /// A mask is out of range.
    #[error(transparent)]
    Mask(#[from] MaskError),
    /// A point has coordinates out of range.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// A span has no samples.
    #[error(transparent)]
    Time(#[from] TimeError),
}

/// Inputs of the reproduction.
#[derive(Debug, Clone)]
pub struct PaperStudy {
    /// The setup of all evaluations.
    pub setup: Setup,
    /// The designs among which the paper searches.
    pub designs: ShellSpace,
    /// Settings of its search; the swarm gets the same budget.
    pub nsga2: Nsga2Config,
    /// Seed of all searches.
    pub seed: u64,
}

/// A row of Table II with the paper's values and ours.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowResult {
    /// Its name.
    pub name: String,
    /// The design as printed.
    pub design: String,
    /// Satellites T.
    pub satellites: usize,
    /// N̄ of the paper.
    pub paper_mean_visible: f64,
    /// E(PDOP) of the paper.
    pub paper_mean_pdop: f64,
    /// Ours as printed.
    pub as_printed: RowValue,
    /// The inclination nearest to the printed one that gives the paper's N̄, degrees; only if the
    /// printed one does not and there is one.
    pub fitting_inclination_deg: Option<f64>,
    /// Ours at that inclination, or at the printed one if there is none.
    pub at_fitting: RowValue,
}

/// How the paper's second objective depends on the number of satellites.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CostOfSize {
    /// Satellites of the smallest and largest design of the search space.
    pub satellites: [usize; 2],
    /// `J_cost` of both at the reference inclination and altitude.
    pub j_cost: [Option<f64>; 2],
}

/// The reproduced study.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Reproduction {
    /// Mask of the scenario, degrees.
    pub mask_deg: f64,
    /// The mask that Table II implies.
    pub mask_fit: MaskFit,
    /// Table II.
    pub rows: Vec<RowResult>,
    /// Table II as printed, under the scenario and then with one assumption changed at a time.
    pub sensitivity: Vec<Measured>,
    /// The searches of the paper and of its baselines.
    pub searches: Vec<FoundSet>,
    /// The data of Figures 2 to 4, written to separate files.
    #[serde(skip)]
    pub figures: Figures,
    /// Cost against size.
    pub cost_of_size: CostOfSize,
    /// Every statement of the paper that has a number or a direction, with its verdict.
    #[serde(skip)]
    pub lines: Vec<Statement>,
}

/// Reproduces the study.
///
/// # Errors
/// If a design cannot be propagated or a search cannot run under the given setup.
pub fn reproduce(study: &PaperStudy) -> Result<Reproduction, PaperError> {
    let setup = &study.setup;
    let evaluator = Evaluator::new(setup.clone())?;
    let table = Measurements::new(&evaluator)?;
    let mask_fit = fit::fit_mask(setup, &table.rows)?;
    let searches = searches::all(&evaluator, study)?;
    let figures = figures::figures(&evaluator, &table.rows, &table.printed, &searches)?;
    let alternative_figures = figures::compared(&evaluator, &table.rows, &table.moved)?;
    let lines = lines::lines(&lines::Evidence {
        setup,
        table: &table,
        mask_fit: &mask_fit,
        searches: &searches,
        curves: [&figures.constellations, &alternative_figures],
    })?;
    Ok(Reproduction {
        mask_deg: setup.mask.degrees(),
        mask_fit,
        rows: row_results(&table),
        sensitivity: std::iter::once(table.printed)
            .chain(table.alternatives)
            .collect(),
        cost_of_size: cost_of_size(&evaluator, study)?,
        searches,
        figures,
        lines,
    })
}

/// Table II alone, judged under `setup`, with the same verdicts that the whole study gives its rows.
///
/// # Errors
/// If a design cannot be propagated under the given setup.
pub fn judged_table2(setup: &Setup) -> Result<Vec<JudgedRow>, PaperError> {
    let evaluator = Evaluator::new(setup.clone())?;
    Ok(lines::judged_rows(&Measurements::new(&evaluator)?))
}

fn row_results(table: &Measurements) -> Vec<RowResult> {
    let ours = table.printed.values.iter().zip(&table.at_fitting.values);
    let row = |((row, fit), (as_printed, at_fitting)): (
        (&TableRow, &Option<f64>),
        (&RowValue, &RowValue),
    )| {
        RowResult {
            name: row.name(),
            design: row.design.to_string(),
            satellites: row.design.satellite_count(),
            paper_mean_visible: row.mean_visible,
            paper_mean_pdop: row.mean_pdop,
            as_printed: *as_printed,
            fitting_inclination_deg: *fit,
            at_fitting: *at_fitting,
        }
    };
    table
        .rows
        .iter()
        .zip(&table.fitted)
        .zip(ours)
        .map(row)
        .collect()
}

fn cost_of_size(evaluator: &Evaluator, study: &PaperStudy) -> Result<CostOfSize, PaperError> {
    let space = &study.designs;
    let reference = table2()?
        .into_iter()
        .find(|row| row.name() == lines::REFERENCE)
        .ok_or_else(|| PaperError::NoRow(lines::REFERENCE.to_owned()))?
        .design;
    let reference = reference.shells()[0];
    let mut satellites = [0; 2];
    let mut j_cost = [None; 2];
    for end in [0, 1] {
        let planes = space.planes[end] as usize;
        let shell = Shell::new(ShellParameters {
            planes,
            satellites_per_plane: space.satellites_per_plane[end] as usize,
            phasing: reference.phasing().min(planes - 1),
            ..reference.parameters()
        })?;
        satellites[end] = shell.satellite_count();
        j_cost[end] = evaluator.evaluate(&Design::from(shell))?.j_cost;
    }
    Ok(CostOfSize { satellites, j_cost })
}

#[cfg(test)]
mod tests;

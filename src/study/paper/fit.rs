//! One-dimensional fits to the visibility column of Table II.

use super::{PaperError, TableRow};
use crate::constellation::{Design, Shell, ShellParameters};
use crate::evaluate::{Evaluator, Setup};
use crate::visibility::Mask;
use rayon::prelude::*;
use serde::Serialize;

/// Agreement with a printed N̄ at which a fit stops: a twentieth of its last digit.
const CLOSE: f64 = 5e-4;

/// Maximum evaluations of a fit: bisection alone narrows 90° to 1e-4°.
const MOST_STEPS: usize = 20;

/// Step and range of the search around a printed inclination, degrees.
const WALK_STEP_DEG: f64 = 2.5;
const WALK_STEPS: u32 = 4;

/// Masks between which a row's mask is sought, degrees.
const MASKS_DEG: [f64; 2] = [0.0, 30.0];

/// Deviation from the median within which a row counts as agreeing, degrees.
const AGREEMENT_DEG: f64 = 0.1;

/// The zero of a function between two arguments of opposite sign, by regula falsi (Illinois
/// variant); `None` if the signs are equal.
fn crossing(
    mut function: impl FnMut(f64) -> Result<f64, PaperError>,
    [mut a, mut b]: [f64; 2],
) -> Result<Option<f64>, PaperError> {
    let (mut at_a, mut at_b) = (function(a)?, function(b)?);
    if at_a * at_b > 0.0 {
        return Ok(None);
    }
    let mut x = if at_a.abs() < at_b.abs() { a } else { b };
    let mut side = 0;
    for _ in 0..MOST_STEPS {
        if at_a == at_b {
            break;
        }
        x = b - at_b * (b - a) / (at_b - at_a);
        let at_x = function(x)?;
        if at_x.abs() < CLOSE {
            break;
        }
        if at_x * at_b > 0.0 {
            (b, at_b) = (x, at_x);
            at_a *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            (a, at_a) = (x, at_x);
            at_b *= if side == -1 { 0.5 } else { 1.0 };
            side = -1;
        }
    }
    Ok(Some(x))
}

/// The setup without GNSS, which mean visible does not need.
pub(super) fn sky(setup: &Setup) -> Setup {
    Setup {
        gnss: Vec::new(),
        ..setup.clone()
    }
}

/// The design with another inclination.
pub(super) fn inclined(design: &Design, inclination_deg: f64) -> Result<Design, PaperError> {
    let incline = |shell: &Shell| {
        Shell::new(ShellParameters {
            inclination_deg,
            ..shell.parameters()
        })
    };
    let shells = design.shells().iter().map(incline);
    Ok(Design::new(shells.collect::<Result<_, _>>()?)?)
}

/// The inclination nearest to the printed one that gives the row's N̄, in steps of a tenth of a
/// degree as the paper prints them; `None` if there is none within 10°.
pub(super) fn fitting_inclination(
    evaluator: &Evaluator,
    row: &TableRow,
) -> Result<Option<f64>, PaperError> {
    let excess = |inclination_deg: f64| {
        let design = inclined(&row.design, inclination_deg)?;
        Ok::<f64, PaperError>(evaluator.evaluate(&design)?.mean_visible - row.mean_visible)
    };
    let printed = row.design.shells()[0].inclination_deg();
    let here = excess(printed)?;
    let mut sides = [(-1.0, printed, here), (1.0, printed, here)];
    for step in 1..=WALK_STEPS {
        for (sign, from, at_from) in &mut sides {
            let to = printed + *sign * WALK_STEP_DEG * f64::from(step);
            if !(0.0..=90.0).contains(&to) {
                continue;
            }
            let at_to = excess(to)?;
            if *at_from * at_to <= 0.0 {
                let found = crossing(excess, [*from, to])?;
                return Ok(found.map(|x| (10.0 * x).round() / 10.0));
            }
            (*from, *at_from) = (to, at_to);
        }
    }
    Ok(None)
}

/// The mask implied by a row's visibility.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RowMask {
    /// Name of the row.
    pub row: String,
    /// Mask that gives its printed N̄ at its printed inclination, degrees.
    pub mask_deg: Option<f64>,
}

/// The mask that the paper does not state.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MaskFit {
    /// Row by row.
    pub rows: Vec<RowMask>,
    /// Their median, degrees, which rows with a misprinted inclination do not affect.
    pub median_deg: Option<f64>,
    /// Rows within a tenth of a degree of the median.
    pub agreeing: usize,
}

/// Fits the mask to each row of Table II as printed.
pub(super) fn fit_mask(setup: &Setup, rows: &[TableRow]) -> Result<MaskFit, PaperError> {
    let masks: Vec<Option<f64>> = rows
        .par_iter()
        .map(|row| row_mask(setup, row))
        .collect::<Result<_, _>>()?;
    let mut known: Vec<f64> = masks.iter().copied().flatten().collect();
    known.sort_by(f64::total_cmp);
    let median_deg = (!known.is_empty()).then(|| known[(known.len() - 1) / 2]);
    let near = |mask: &&f64| median_deg.is_some_and(|m| (**mask - m).abs() <= AGREEMENT_DEG);
    let agreeing = known.iter().filter(near).count();
    let named = rows.iter().zip(masks);
    let rows = named.map(|(row, mask_deg)| RowMask {
        row: row.name(),
        mask_deg,
    });
    Ok(MaskFit {
        rows: rows.collect(),
        median_deg,
        agreeing,
    })
}

fn row_mask(setup: &Setup, row: &TableRow) -> Result<Option<f64>, PaperError> {
    let excess = |mask_deg: f64| {
        let mask = Mask::from_degrees(mask_deg)?;
        let setup = Setup { mask, ..sky(setup) };
        let metrics = Evaluator::new(setup)?.evaluate(&row.design)?;
        Ok(metrics.mean_visible - row.mean_visible)
    };
    crossing(excess, MASKS_DEG)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn validate_crossing_of_a_cube() {
        let root = crossing(|x| Ok(x * x * x - 2.0), [0.0, 5.0])
            .unwrap()
            .unwrap();
        // The slope there is 3 * 2^(2/3) = 4.8.
        assert!((root - 2.0_f64.cbrt()).abs() < CLOSE / 4.7, "{root}");
        assert_eq!(crossing(|x| Ok(x + 1.0), [0.0, 5.0]).unwrap(), None);
    }
}

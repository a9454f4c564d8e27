//! Closed forms and symmetries that need no other program.
//!
//! What is held against them is the design as the model of the study propagates it.
//!
//! - The rates of J2, by averaging the potential over the orbit instead of by their formulas.
//! - The mean number of visible satellites, by quadrature over the orbit instead of over time.
//! - PDOP of the study by inverting full matrices.
//! - Symmetries of the pattern, the order of satellites, and a raised mask.

mod averaging;
mod geometry;
mod quadrature;
mod symmetry;

use super::{Findings, Subject, ValidateError};
use crate::orbit::Model;

/// All checks of a design by closed forms and symmetries.
///
/// # Errors
/// If the design cannot be propagated.
pub fn against_closed_forms(subject: &Subject<'_>) -> Result<Findings, ValidateError> {
    let mut findings = Findings::default();
    findings.checks.extend(averaging::checks(subject));
    if subject.model() == Model::Sgp4 {
        findings.notes.push("analytic: the averaged potential of J2 does not judge the rates of sgp4, which has terms of second order and J4; --against sgp4 does".to_owned());
    }
    findings.checks.extend(quadrature::checks(subject)?);
    findings.checks.extend(geometry::checks(subject)?);
    findings.checks.extend(symmetry::checks(subject)?);
    Ok(findings)
}

#[cfg(test)]
mod tests;

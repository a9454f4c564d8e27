//! Closed forms and symmetries that need no other program.
//!
//! What is held against them is the design as the model of the study propagates it.
//!
//! - The rates of J2, by averaging the potential over the orbit instead of by their formulas.
//! - The mean number of visible satellites, by quadrature over the orbit instead of over time.
//! - PDOP of the study by inverting whole matrices.
//! - The symmetries of the pattern, order of satellites, and the mask.

mod averaging;
mod geometry;
mod quadrature;
mod symmetry;

use super::{Findings, Subject, ValidateError};
use crate::orbit::Model;

/// Everything that closed forms and symmetries say about a design.
///
/// # Errors
/// When the design cannot be propagated.
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

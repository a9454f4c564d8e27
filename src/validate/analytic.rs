//! Closed forms and symmetries that need no other program.
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

/// All checks of a design by closed forms and symmetries.
///
/// # Errors
/// If the design cannot be propagated.
pub fn against_closed_forms(subject: &Subject<'_>) -> Result<Findings, ValidateError> {
    let mut findings = Findings::default();
    findings.checks.extend(averaging::checks(subject));
    findings.checks.extend(quadrature::checks(subject)?);
    findings.checks.extend(geometry::checks(subject)?);
    findings.checks.extend(symmetry::checks(subject)?);
    Ok(findings)
}

#[cfg(test)]
mod tests;

//! The page of a validation: what a reviewer reads.

use super::evidence_page::{EvidencePageError, write_evidence};
use super::figures::residual_figures;
use super::validation::{headline, sections};
use crate::run::ValidateResult;
use std::io::Write;

/// Writes the page of a validation.
///
/// # Errors
/// If a figure cannot be drawn, or writing fails.
pub fn write_validation_page(
    result: &ValidateResult,
    to: impl Write,
) -> Result<(), EvidencePageError> {
    let figures = residual_figures(result).into_iter();
    let figures = figures.map(|(caption, chart)| (caption.to_owned(), chart));
    write_evidence(headline(result), figures.collect(), sections(result), to)
}

//! The page of a search for the fewest satellites.

use super::evidence_page::{EvidencePageError, write_evidence};
use super::figures::size_figures;
use super::section::Headline;
use super::size::{answer, constraints, scope, sections};
use crate::run::size::SizeResult;
use std::io::Write;

/// Writes the page of a search for the fewest satellites.
///
/// # Errors
/// If a figure cannot be drawn, or writing fails.
pub fn write_size_page(result: &SizeResult, to: impl Write) -> Result<(), EvidencePageError> {
    let scenario = &result.scenario;
    let certificate = &result.certificate;
    let headline = Headline {
        title: format!("Fewest satellites of {}", scenario.name),
        lines: vec![
            format!(
                "Scenario {} ({}), navwalker {}.",
                scenario.name, scenario.hash, result.version
            ),
            format!("Constraints: {}.", constraints(result).join("; ")),
        ],
        verdict: format!("{}; {}.", answer(result), scope(result)),
        notes: vec![format!(
            "{} has the proofs for {} rejected designs, SHA-256 {}; navwalker size --verify checks them",
            certificate.path, certificate.designs, certificate.sha256
        )],
    };
    write_evidence(headline, size_figures(result), sections(result), to)
}

//! `navwalker size --verify`: a certificate against the grid and against full evaluations.

use super::directory::read_certificate;
use crate::cli::args::{OutputFormat, SizeArgs};
use crate::cli::study::Study;
use crate::cli::{Status, files, output};
use crate::constellation::Design;
use crate::evaluate::Evaluator;
use crate::run::size::{SIZE_JSON, SizeResult};
use crate::search::size::SizeProblem;
use crate::units::counted;
use anyhow::{Context, Result, bail};
use serde::Serialize;
use std::path::Path;

/// A finding, or that there is none.
#[derive(Debug, Serialize)]
struct SizeVerification {
    /// Rejected designs in the certificate.
    designs: u64,
    /// Of those, evaluated in full.
    drawn: usize,
    /// Designs of the result that were evaluated.
    kept: usize,
    /// What is wrong.
    findings: Vec<String>,
    /// Whether nothing is.
    passed: bool,
}

pub(super) fn run(args: &SizeArgs, directory: &Path) -> Result<Status> {
    let study = Study::of_run(directory, &[])?;
    let path = directory.join(SIZE_JSON);
    let bytes = files::read_run(&path).with_context(|| {
        format!(
            "{} has no result; is it a finished search for the fewest satellites?",
            directory.display()
        )
    })?;
    let result = SizeResult::read(&bytes)
        .with_context(|| format!("{} is not a result of `size`", path.display()))?;
    if study.stamp()? != result.scenario {
        bail!(
            "{} is the result of another scenario than the one beside it",
            path.display()
        );
    }
    let evaluator = Evaluator::new(study.setup()?)?;
    let problem = study.problem(&evaluator)?;
    let problem = SizeProblem::new(&problem);
    let verification = verified(args, directory, &study, &result, &problem)?;
    output::result(&match args.format {
        OutputFormat::Text => text(&verification),
        OutputFormat::Json => crate::printable::json(&verification)?,
        OutputFormat::Csv => csv(&verification),
    })?;
    Ok(if verification.passed {
        Status::Done
    } else {
        Status::Failed
    })
}

fn verified(
    args: &SizeArgs,
    directory: &Path,
    study: &Study,
    result: &SizeResult,
    problem: &SizeProblem<'_>,
) -> Result<SizeVerification> {
    let mut findings = Vec::new();
    let below = |satellites: usize| result.fewest.is_none_or(|fewest| satellites < fewest);
    // The designs of the grid with fewer satellites, in the order of the certificate.
    let mut expected = problem.designs_in_order();
    let mut rejected: Vec<Design> = Vec::new();
    let certificate = read_certificate(directory, |line| {
        let Some((satellites, notation)) = certified(line) else {
            findings.push(format!("not a row of a certificate: {line}"));
            return Ok(());
        };
        let design = notation.parse::<Design>();
        // Points that are not designs have rows, but no turn.
        if !below(satellites) || design.is_err() {
            return Ok(());
        }
        let next = expected.next().transpose()?;
        let is_next = next
            .as_ref()
            .is_some_and(|(_, design)| design.to_string() == notation);
        if !is_next {
            let next = next.map_or_else(|| "the end".to_owned(), |(_, design)| design.to_string());
            findings.push(format!(
                "found {notation}, but the next design of the grid is {next}"
            ));
        }
        rejected.extend(design);
        Ok(())
    })?;
    let missing = expected.next().transpose()?;
    if let Some((satellites, design)) = missing.filter(|(satellites, _)| below(*satellites)) {
        findings.push(format!(
            "{design} with {satellites} satellites has no proof"
        ));
    }
    if certificate != result.certificate {
        findings.push(
            "the checksum or the length of the certificate is not that of the result".to_owned(),
        );
    }
    let seed = study.scenario.optimizer.seed;
    let drawn = crate::optimize::drawn(rejected.len(), args.draw, seed);
    for &n in &drawn {
        if problem.keeps(&rejected[n]) == Some(true) {
            findings.push(format!(
                "{} is rejected, but keeps the constraints",
                rejected[n]
            ));
        }
    }
    for one in &result.designs {
        let design = one
            .design
            .design()
            .filter(|design| problem.keeps(design) == Some(true));
        let is_of_fewest =
            Some(one.design.satellites + problem.satellites_beside()) == result.fewest;
        if design.is_none() || !is_of_fewest {
            findings.push(format!(
                "{} does not keep the constraints",
                one.design.notation
            ));
        }
    }
    findings.truncate(100);
    Ok(SizeVerification {
        designs: certificate.designs,
        drawn: drawn.len(),
        kept: result.designs.len(),
        passed: findings.is_empty(),
        findings,
    })
}

/// Satellites and notation of a row.
fn certified(line: &str) -> Option<(usize, String)> {
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .from_reader(line.as_bytes());
    let record = reader.records().next()?.ok()?;
    Some((record.get(0)?.parse().ok()?, record.get(1)?.to_owned()))
}

fn text(of: &SizeVerification) -> String {
    let mut text = format!(
        "certificate of {}: {} evaluated in full and rejected again, {} of the result kept again\n",
        counted(
            usize::try_from(of.designs).unwrap_or(usize::MAX),
            "rejected design"
        ),
        of.drawn,
        of.kept
    );
    for finding in &of.findings {
        text += &format!("wrong: {finding}\n");
    }
    text + if of.passed {
        "every design of the grid with fewer satellites is in it; nothing is wrong\n"
    } else {
        "the certificate does not prove the result\n"
    }
}

fn csv(of: &SizeVerification) -> String {
    let mut text = "finding\n".to_owned();
    for finding in &of.findings {
        text += &format!("\"{}\"\n", finding.replace('"', "\"\""));
    }
    text
}

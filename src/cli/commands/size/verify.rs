//! `navwalker size --verify`: a certificate against the grid and against full evaluations.

use super::directory::read_certificate;
use crate::cli::args::{OutputFormat, SizeArgs};
use crate::cli::study::Study;
use crate::cli::{Status, files, output};
use crate::evaluate::Evaluator;
use crate::run::size::{SIZE_CSV, SIZE_JSON, SizeResult, size_csv};
use crate::search::size::SizeProblem;
use crate::units::counted;
use anyhow::{Context, Result, bail};
use levels::CertificateLevels;
use serde::Serialize;
use std::path::Path;

mod levels;

/// Findings that are printed.
const MOST_FINDINGS: usize = 100;

/// A finding, or that there is none.
#[derive(Debug, Serialize)]
struct SizeVerification {
    /// Rejected designs in the certificate.
    designs: u64,
    /// Of those, evaluated in full.
    drawn: usize,
    /// Designs that keep the constraints by the result, evaluated in full.
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
    let seed = study.scenario.optimizer.seed;
    let rows = usize::try_from(result.certificate.designs).unwrap_or(usize::MAX);
    let drawn = crate::optimize::drawn(rows, args.draw, seed);
    let mut levels = CertificateLevels::new(problem, result, drawn);
    let certificate = read_certificate(directory, |line| levels.see(line))?;
    let checked = levels.finish()?;
    let mut findings = checked.findings;
    if certificate != result.certificate {
        findings.push(
            "the checksum or the length of the certificate is not that of the result".to_owned(),
        );
    }
    let table = files::read_run(&directory.join(SIZE_CSV)).unwrap_or_default();
    if table != size_csv(result)?.as_bytes() {
        findings.push(format!(
            "{SIZE_CSV} does not have the designs of {SIZE_JSON}"
        ));
    }
    for design in &checked.drawn {
        if problem.keeps(design) == Some(true) {
            findings.push(format!("{design} is rejected, but keeps the constraints"));
        }
    }
    let unlisted = crate::optimize::drawn(checked.unlisted.len(), args.draw, seed);
    for design in unlisted.iter().map(|n| &checked.unlisted[*n]) {
        if problem.keeps(design) != Some(true) {
            findings.push(format!(
                "{design} has no proof, and does not keep the constraints"
            ));
        }
    }
    findings.extend(wrong_designs(result, problem));
    findings.truncate(MOST_FINDINGS);
    Ok(SizeVerification {
        designs: certificate.designs,
        drawn: checked.drawn.len(),
        kept: result.designs.len() + unlisted.len(),
        passed: findings.is_empty(),
        findings,
    })
}

/// The designs of the result that are not what it says.
fn wrong_designs(result: &SizeResult, problem: &SizeProblem<'_>) -> Vec<String> {
    let mut findings = Vec::new();
    for one in &result.designs {
        let notation = &one.design.notation;
        let metrics = one
            .design
            .design()
            .and_then(|design| problem.assessed(&design));
        let is_of_fewest =
            Some(one.design.satellites + problem.satellites_beside()) == result.fewest;
        let keeps = one
            .design
            .design()
            .and_then(|design| problem.keeps(&design));
        if keeps != Some(true) || !is_of_fewest {
            findings.push(format!("{notation} does not keep the constraints"));
        } else if metrics.as_ref() != Some(&one.metrics) {
            findings.push(format!("{notation} has other metrics than the result says"));
        }
    }
    findings
}

fn text(of: &SizeVerification) -> String {
    let mut text = format!(
        "certificate of {}: {} evaluated in full and rejected again, {} that the result keeps kept again\n",
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

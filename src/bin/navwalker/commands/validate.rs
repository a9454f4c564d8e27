//! `navwalker validate`.

use crate::args::{ReportFormat, ValidateArgs};
use crate::study::study_and_design;
use crate::{Status, files, output};
use anyhow::{Result, bail};
use navwalker::report::{
    ValidateResult, checks_csv, checks_junit, validation_markdown, validation_text,
};
use navwalker::validate::{Findings, Subject, sgp4::against_sgp4};

/// The targets that can be named.
const TARGETS: [&str; 1] = ["sgp4"];

pub(crate) fn run(args: &ValidateArgs) -> Result<Status> {
    if let Some(unknown) = args
        .against
        .iter()
        .find(|target| !TARGETS.contains(&target.as_str()))
    {
        bail!(
            "unknown target '{unknown}' for --against; the targets are: {}",
            TARGETS.join(", ")
        );
    }
    if let Some(directory) = &args.out {
        files::require_vacant(directory, false)?;
    }
    let (study, design) = study_and_design(&args.study, &args.design)?;
    let evaluator = study.evaluator()?;
    let findings: Findings = against_sgp4(&Subject::new(design, &evaluator))?;
    let result = ValidateResult::new(&design, findings, &study.scenario);
    if let Some(directory) = &args.out {
        let staged = files::StagedDirectory::new(directory)?;
        for (name, format) in [
            ("report.txt", ReportFormat::Text),
            ("report.json", ReportFormat::Json),
            ("report.csv", ReportFormat::Csv),
            ("report.md", ReportFormat::Markdown),
            ("report.junit.xml", ReportFormat::Junit),
        ] {
            files::write_atomically(
                &staged.path().join(name),
                render(&result, format)?.as_bytes(),
            )?;
        }
        staged.commit()?;
    }
    output::result(&render(&result, args.format)?)?;
    Ok(if result.passed {
        Status::Done
    } else {
        Status::Failed
    })
}

fn render(result: &ValidateResult, format: ReportFormat) -> Result<String> {
    Ok(match format {
        ReportFormat::Text => validation_text(result),
        ReportFormat::Json => serde_json::to_string_pretty(result)? + "\n",
        ReportFormat::Csv => checks_csv(&result.findings.checks)?,
        ReportFormat::Markdown => validation_markdown(result),
        ReportFormat::Junit => checks_junit(&result.findings.checks),
    })
}

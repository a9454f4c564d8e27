//! `navwalker report`.

use super::plot;
use crate::cli::args::{ReportArgs, ViewArgs};
use crate::cli::progress::Stages;
use crate::cli::run_view::View;
use crate::cli::{Status, files, output};
use crate::report::page::{self, FailureSection, Page};
use crate::run::size::CERTIFICATE_CSV;
use crate::run::sweep::SWEEP_JSON;
use crate::run::{REPORT_PAGE, VALIDATION_REPORT};
use anyhow::{Result, bail};
use std::path::{Path, PathBuf};

/// Files that only the results of other commands have beside their page.
const OTHERS: [(&str, &str); 3] = [
    (CERTIFICATE_CSV, "size"),
    (SWEEP_JSON, "sweep"),
    (VALIDATION_REPORT, "validate or reproduce"),
];

pub(crate) fn run(args: &ReportArgs) -> Result<Status> {
    let out = match &args.out {
        Some(out) => out.clone(),
        None => {
            let directory = args.view.run().unwrap_or_default();
            refuse_other_page(&directory)?;
            directory.join(REPORT_PAGE)
        }
    };
    write(&args.view, &out, args.failures.map(|k| (k, args.draws)))?;
    output::result(&out.display().to_string())?;
    Ok(Status::Done)
}

/// Refuses to replace the page that another command wrote with its results.
fn refuse_other_page(directory: &Path) -> Result<()> {
    let other = OTHERS
        .iter()
        .find(|(file, _)| directory.join(file).exists() && directory.join(REPORT_PAGE).exists());
    match other {
        Some((_, command)) => bail!(
            "{} holds the results and the page of {command}; report is of a run, and --out writes its page elsewhere",
            output::shown_path(directory)
        ),
        None => Ok(()),
    }
}

/// Writes the page of a run to its directory, with the validation given by `validation` or the one
/// in the run.
pub(crate) fn of_run(directory: &Path, validation: Option<&Path>) -> Result<PathBuf> {
    let args = ViewArgs {
        subject: Some(directory.to_string_lossy().into_owned()),
        validation: validation.map(Path::to_owned),
        ..ViewArgs::default()
    };
    let out = directory.join(REPORT_PAGE);
    write(&args, &out, None)?;
    Ok(out)
}

/// Writes the page, with failures of so many satellites if asked for.
fn write(args: &ViewArgs, out: &Path, failing: Option<(u8, Option<u32>)>) -> Result<()> {
    let view = View::new(args)?;
    let stages = Stages::new();
    files::refuse_inputs(out, view.inputs.iter().map(PathBuf::as_path))?;
    let staged = files::StagedFile::with_directories(out)?;
    let mut html = Vec::new();
    if failing.is_some() {
        stages.begin("evaluating what failures do");
    }
    let failures = failing.map(|failing| failure_section(&view, failing));
    let failures = failures.transpose()?;
    let page = Page {
        run: &view.run,
        stamp: view.stamp.as_ref(),
        scenario_toml: view.scenario_toml.as_deref(),
        evaluator: view.evaluator.as_ref(),
        compared: &view.compared,
        fronts: &view.fronts,
        fixed: view.fixed.as_ref(),
        failures: failures.as_ref(),
    };
    stages.begin("drawing the page");
    page::write(&page, &mut html)?;
    staged.commit(&html)
}

/// What failures do: of the pick of a search and of the compared constellations.
fn failure_section(view: &View, failing: (u8, Option<u32>)) -> Result<FailureSection> {
    let losses = plot::losses(None, failing, view)?;
    let map = losses
        .first()
        .map(|first| plot::map_of_losses(first, failing.1, view));
    Ok(FailureSection::new(&losses, map.transpose()?.as_ref())?)
}

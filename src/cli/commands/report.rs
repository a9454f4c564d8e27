//! `navwalker report`.

use crate::cli::args::{ReportArgs, RunArgs};
use crate::cli::run_view::RunView;
use crate::cli::{Status, files, output};
use crate::report::page::{self, Page};
use anyhow::Result;
use std::path::{Path, PathBuf};

pub(crate) fn run(args: &ReportArgs) -> Result<Status> {
    let usual = || args.run.directory.join("report.html");
    let out = args.out.clone().unwrap_or_else(usual);
    write(&args.run, &out)?;
    output::result(&out.display().to_string())?;
    Ok(Status::Done)
}

/// Writes the page of a run to its directory, with the validation given by `validation` or the one
/// in the run.
pub(crate) fn of_run(directory: &Path, validation: Option<&Path>) -> Result<PathBuf> {
    let args = RunArgs {
        directory: directory.to_owned(),
        compare: Vec::new(),
        front: Vec::new(),
        validation: validation.map(Path::to_owned),
    };
    let out = directory.join("report.html");
    write(&args, &out)?;
    Ok(out)
}

fn write(args: &RunArgs, out: &Path) -> Result<()> {
    let view = RunView::at(args)?;
    files::refuse_inputs(out, args.inputs())?;
    let staged = files::StagedFile::new(out)?;
    let mut html = Vec::new();
    let page = Page {
        run: &view.run,
        scenario_toml: view.scenario_toml.as_deref(),
        evaluator: view.evaluator.as_ref(),
        baselines: &view.baselines(),
        beside: &view.beside,
        fronts: &view.fronts,
    };
    page::write(&page, &mut html)?;
    staged.commit(&html)
}

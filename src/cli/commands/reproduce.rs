//! `navwalker reproduce`: the paper's tables and figures next to ours.

use crate::cli::args::{ReproduceArgs, StudyFormat};
use crate::cli::study::Study;
use crate::cli::{Status, files, output};
use crate::report::{
    REPRODUCTION_FILES, ReproduceResult, reproduction_csv, reproduction_files,
    reproduction_markdown, reproduction_text,
};
use crate::run::{SCENARIO, ScenarioStamp, VERSION};
use crate::scenario::Scenario;
use crate::search::ShellSpace;
use crate::study::paper::{PaperStudy, reproduce};
use anyhow::{Result, bail};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::Path;

/// The report that identifies the study in a directory.
const REPORT: &str = "report.json";
/// The files beside the tables.
const OTHERS: [&str; 3] = [SCENARIO, REPORT, "report.md"];

/// The one shell of the search, since that of the paper is one.
fn only_shell(scenario: &Scenario) -> Result<ShellSpace> {
    match scenario.search.shells.as_slice() {
        [shell] if scenario.search.fixed.is_none() => Ok(shell.clone()),
        _ => bail!(
            "reproduce repeats the paper's search among designs of one shell; leave out search.shells and search.fixed"
        ),
    }
}

pub(crate) fn run(args: &ReproduceArgs) -> Result<Status> {
    let seed = args.seed.map(|seed| format!("optimizer.seed={seed}"));
    let study = Study::load(&args.study, seed.as_slice())?;
    let scenario = &study.scenario;
    let designs = only_shell(scenario)?;
    let stamp = study.stamp()?;
    if !holds(&args.out, &stamp.hash) {
        if !args.force && !files::is_vacant(&args.out)? {
            bail!(
                "{} holds something other than this study by this version; choose another --out, or \
                 replace it with --force",
                args.out.display()
            );
        }
        files::refuse_inputs(&args.out, study.inputs())?;
        files::require_replaceable(&args.out, args.force, &own())?;
    }
    let staged = files::StagedDirectory::new(&args.out)?;
    output::hint("reproducing the paper; this takes seconds to minutes");
    let repeated = reproduce(&PaperStudy {
        setup: study.setup()?,
        designs,
        nsga2: scenario.nsga2(),
        seed: scenario.optimizer.seed,
    })?;
    let result = ReproduceResult::new(repeated, scenario, stamp);
    let mut written = reproduction_files(&result)?;
    let others = [
        scenario.to_toml(),
        render(&result, StudyFormat::Json)?,
        render(&result, StudyFormat::Markdown)?,
    ];
    written.extend(OTHERS.into_iter().zip(others));
    for (name, text) in &written {
        files::write_atomically(&staged.path().join(name), text.as_bytes())?;
    }
    staged.commit_keeping(&files::others(&args.out, &own())?)?;
    output::result(&render(&result, args.format)?)?;
    output::hint(&format!(
        "\nreport and figure data written to {}",
        args.out.display()
    ));
    Ok(Status::Done)
}

fn render(result: &ReproduceResult, format: StudyFormat) -> Result<String> {
    Ok(match format {
        StudyFormat::Text => reproduction_text(result),
        StudyFormat::Json => crate::printable::json(result)? + "\n",
        StudyFormat::Csv => reproduction_csv(&result.study.lines)?,
        StudyFormat::Markdown => reproduction_markdown(result),
    })
}

/// The part of a report that identifies its study.
#[derive(Deserialize)]
struct Stored {
    scenario: ScenarioStamp,
    version: String,
}

/// What a reproduction writes in its directory.
fn own() -> BTreeSet<String> {
    let own = REPRODUCTION_FILES.into_iter().chain(OTHERS);
    own.map(str::to_owned).collect()
}

/// Whether a directory contains this study by this version.
fn holds(directory: &Path, hash: &str) -> bool {
    let stored = files::read_run(&directory.join(REPORT)).ok();
    let stored: Option<Stored> = stored.and_then(|bytes| serde_json::from_slice(&bytes).ok());
    stored.is_some_and(|stored| stored.scenario.hash == hash && stored.version == VERSION)
}

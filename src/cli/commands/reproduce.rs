//! `navwalker reproduce`: the paper's tables and figures next to ours.

use crate::cli::args::{ReproduceArgs, StudyFormat};
use crate::cli::study::Study;
use crate::cli::{Status, files, output};
use crate::report::{
    ReproduceResult, reproduction_csv, reproduction_files, reproduction_markdown, reproduction_text,
};
use crate::run::{ScenarioStamp, VERSION};
use crate::study::paper::{PaperStudy, reproduce};
use anyhow::{Result, bail};
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// The report that identifies the study in a directory.
const REPORT: &str = "report.json";

pub(crate) fn run(args: &ReproduceArgs) -> Result<Status> {
    let seed = args.seed.map(|seed| format!("optimizer.seed={seed}"));
    let study = Study::load(&args.study, seed.as_slice())?;
    let scenario = &study.scenario;
    let stamp = study.stamp()?;
    if !args.force && !may_replace(&args.out, &stamp.hash)? {
        bail!(
            "{} holds something other than this study by this version; choose another --out, or \
             replace it with --force",
            args.out.display()
        );
    }
    let staged = files::StagedDirectory::new(&args.out)?;
    output::hint("reproducing the paper; this takes seconds to minutes");
    let repeated = reproduce(&PaperStudy {
        setup: study.setup()?,
        designs: scenario.search.designs,
        nsga2: scenario.nsga2(),
        seed: scenario.optimizer.seed,
    })?;
    let result = ReproduceResult::new(repeated, scenario, stamp);
    let mut written = reproduction_files(&result)?;
    written.push(("scenario.toml", scenario.to_toml()));
    written.push((REPORT, render(&result, StudyFormat::Json)?));
    written.push(("report.md", render(&result, StudyFormat::Markdown)?));
    for (name, text) in &written {
        files::write_atomically(&staged.path().join(name), text.as_bytes())?;
    }
    staged.commit()?;
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

/// Whether a directory is empty or contains this study by this version.
fn may_replace(directory: &Path, hash: &str) -> Result<bool> {
    if files::is_vacant(directory)? {
        return Ok(true);
    }
    let stored = fs::read_to_string(directory.join(REPORT)).ok();
    let stored: Option<Stored> = stored.and_then(|text| serde_json::from_str(&text).ok());
    Ok(stored.is_some_and(|stored| stored.scenario.hash == hash && stored.version == VERSION))
}

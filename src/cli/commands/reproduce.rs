//! `navwalker reproduce`: published numbers next to ours, those of the paper with its tables and figures.

use crate::cli::args::{ReproduceArgs, StudyArgs, StudyFormat};
use crate::cli::study::Study;
use crate::cli::{Status, files, output};
use crate::keyword::nearest;
use crate::printable::printable;
use crate::report::{
    Align, PublishedResult, REPRODUCTION_FILES, ReproduceResult, StudiesResult, StudyResult, Table,
    reproduction_files, reproduction_markdown, reproduction_text, statements_csv, studies_markdown,
    studies_text,
};
use crate::run::checkpoint::hex_sha256;
use crate::run::{SCENARIO, ScenarioStamp, VERSION};
use crate::scenario::Scenario;
use crate::search::ShellSpace;
use crate::study::paper::{PaperStudy, reproduce};
use crate::study::published::{JudgedStudy, PublishedStudy, builtin_studies, builtin_study};
use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The report that identifies the studies in a directory.
const REPORT: &str = "report.json";
/// The files beside the tables.
const OTHERS: [&str; 3] = [SCENARIO, REPORT, "report.md"];

/// A study that was asked for.
enum Chosen {
    /// The paper's, under a scenario.
    Paper(Box<Study>),
    /// One of published numbers.
    Published(Box<ChosenStudy>),
}

/// A study of published numbers, from a file or built in.
struct ChosenStudy {
    study: PublishedStudy,
    /// SHA-256 of its text and the overrides.
    sha256: String,
    /// The file; `None` if it is built in.
    file: Option<PathBuf>,
}

pub(crate) fn run(args: &ReproduceArgs) -> Result<Status> {
    if args.list {
        return list(args.format);
    }
    let names = names(args);
    if let ([_, _, ..], Some(key)) = (names.as_slice(), args.overrides.first()) {
        bail!("--set {key}: several studies have several scenarios; give one study");
    }
    if let (Some(seed), false) = (args.seed, names == [ReproduceResult::NAME]) {
        bail!("--seed {seed} is of the searches of the paper's study; give no other");
    }
    let chosen = names.iter().map(|name| choose(name, args));
    let chosen: Vec<Chosen> = chosen.collect::<Result<_>>()?;
    let identities = chosen.iter().map(Chosen::identity);
    let identities: Vec<String> = identities.collect::<Result<_>>()?;
    require_place(args, &chosen, &identities)?;
    let staged = files::StagedDirectory::new(&args.out)?;
    let mut written = Vec::new();
    let mut studies = Vec::new();
    let mut status = Status::Done;
    for one in chosen {
        match one {
            Chosen::Paper(study) => {
                let result = paper(&study)?;
                written.extend(reproduction_files(&result)?);
                written.push((SCENARIO, study.scenario.to_toml()));
                studies.push(StudyResult::Paper(Box::new(result)));
            }
            Chosen::Published(one) => {
                let judged = one.run(&args.overrides)?;
                if judged.statements.iter().any(|one| one.is_unexpected()) {
                    status = Status::Failed;
                }
                let result = PublishedResult::new(&judged, one.sha256);
                studies.push(StudyResult::Published(result));
            }
        }
    }
    let result = StudiesResult::new(studies);
    written.push((REPORT, render(&result, StudyFormat::Json)?));
    written.push(("report.md", render(&result, StudyFormat::Markdown)?));
    for (name, text) in &written {
        files::write_atomically(&staged.path().join(name), text.as_bytes())?;
    }
    staged.commit_keeping(&files::others(&args.out, &own())?)?;
    output::result(&render(&result, args.format)?)?;
    output::hint(&format!("\nreport written to {}", args.out.display()));
    Ok(status)
}

/// The names of the studies that are asked for.
fn names(args: &ReproduceArgs) -> Vec<String> {
    if args.all {
        let published = builtin_studies().into_iter();
        let all = std::iter::once(ReproduceResult::NAME).chain(published);
        return all.map(str::to_owned).collect();
    }
    if args.studies.is_empty() {
        return vec![ReproduceResult::NAME.to_owned()];
    }
    args.studies.clone()
}

fn choose(name: &str, args: &ReproduceArgs) -> Result<Chosen> {
    if name == ReproduceResult::NAME {
        let seed = args.seed.map(|seed| format!("optimizer.seed={seed}"));
        let study = StudyArgs {
            scenario: None,
            overrides: args.overrides.clone(),
        };
        return Ok(Chosen::Paper(Box::new(Study::load(
            &study,
            seed.as_slice(),
        )?)));
    }
    let is_file = name.contains(['/', '\\']) || Path::new(name).extension().is_some();
    let (label, text, file) = if is_file {
        let path = PathBuf::from(name);
        let bytes = files::read_whole(&path).with_context(|| format!("cannot read {name}"))?;
        let text = String::from_utf8(bytes).with_context(|| format!("{name} is not UTF-8"))?;
        (name, text, Some(path))
    } else {
        let text = builtin_study(name).map_err(|_| no_such(name))?;
        (name, text.to_owned(), None)
    };
    let study = PublishedStudy::parse(label, &text)?;
    let identified = [&[text], args.overrides.as_slice()].concat().join("\n");
    Ok(Chosen::Published(Box::new(ChosenStudy {
        study,
        sha256: hex_sha256(identified.as_bytes()),
        file,
    })))
}

/// The error for a name that no built-in study has.
fn no_such(name: &str) -> anyhow::Error {
    let mut known = vec![ReproduceResult::NAME];
    known.extend(builtin_studies());
    let meant = nearest(name, &known);
    let meant = meant.map_or_else(String::new, |name| format!(", did you mean '{name}'?"));
    anyhow::anyhow!(
        "no built-in study '{}'{meant} (choices: {}); a file name needs an extension, as in study.toml",
        printable(name),
        known.join(", ")
    )
}

impl Chosen {
    /// What identifies its results.
    fn identity(&self) -> Result<String> {
        match self {
            Self::Paper(study) => study.hash(),
            Self::Published(study) => Ok(study.sha256.clone()),
        }
    }

    /// The files that it reads.
    fn inputs(&self) -> Vec<PathBuf> {
        match self {
            Self::Paper(study) => study.inputs(),
            Self::Published(study) => study.file.iter().cloned().collect(),
        }
    }
}

impl ChosenStudy {
    fn run(&self, overrides: &[String]) -> Result<JudgedStudy> {
        let directory = self.file.as_deref().and_then(Path::parent);
        let directory = directory.map_or_else(PathBuf::new, Path::to_owned);
        let read = |file: &str| files::read_whole(&directory.join(file));
        Ok(self.study.run(overrides, &read)?)
    }
}

/// Fails if the results may not be written to the directory.
fn require_place(args: &ReproduceArgs, chosen: &[Chosen], identities: &[String]) -> Result<()> {
    if holds(&args.out, identities) {
        return Ok(());
    }
    if !args.force && !files::is_vacant(&args.out)? {
        bail!(
            "{} holds something other than this study by this version; choose another --out, or replace it with --force",
            args.out.display()
        );
    }
    let inputs: Vec<PathBuf> = chosen.iter().flat_map(Chosen::inputs).collect();
    files::refuse_inputs(&args.out, inputs)?;
    files::require_replaceable(&args.out, args.force, &own())
}

/// The paper's study under its scenario.
fn paper(study: &Study) -> Result<ReproduceResult> {
    let scenario = &study.scenario;
    let designs = only_shell(scenario)?;
    output::hint("reproducing the paper; this takes seconds to minutes");
    let repeated = reproduce(&PaperStudy {
        setup: study.setup()?,
        designs,
        nsga2: scenario.nsga2(),
        seed: scenario.optimizer.seed,
    })?;
    Ok(ReproduceResult::new(repeated, scenario, study.stamp()?))
}

/// The one shell of the search, since that of the paper is one.
fn only_shell(scenario: &Scenario) -> Result<ShellSpace> {
    match scenario.search.shells.as_slice() {
        [shell] if scenario.search.fixed.is_none() => Ok(shell.clone()),
        _ => bail!(
            "reproduce repeats the paper's search among designs of one shell; leave out search.shells and search.fixed"
        ),
    }
}

/// Prints the built-in studies.
fn list(format: StudyFormat) -> Result<Status> {
    let mut studies = vec![(
        ReproduceResult::NAME.to_owned(),
        "The paper that this program implements: tables, searches and figures".to_owned(),
    )];
    for name in builtin_studies() {
        let study = PublishedStudy::parse(name, builtin_study(name)?)?;
        studies.push((study.name, study.title));
    }
    output::result(&match format {
        StudyFormat::Json => {
            let entry = |(name, title): &(String, String)| serde_json::json!({ "name": name, "title": title });
            let studies: Vec<_> = studies.iter().map(entry).collect();
            crate::printable::json(&serde_json::json!({ "studies": studies }))? + "\n"
        }
        _ => {
            let mut table = Table::new(&[("study", Align::Left), ("title", Align::Left)]);
            for (name, title) in studies {
                table.row([name, title]);
            }
            match format {
                StudyFormat::Markdown => table.to_markdown(),
                _ => table.to_text(),
            }
        }
    })?;
    Ok(Status::Done)
}

fn render(result: &StudiesResult, format: StudyFormat) -> Result<String> {
    Ok(match (format, result.studies.as_slice()) {
        (StudyFormat::Json, _) => crate::printable::json(result)? + "\n",
        (StudyFormat::Csv, studies) => statements_csv(studies)?,
        (StudyFormat::Text, [StudyResult::Paper(paper)]) => reproduction_text(paper),
        (StudyFormat::Markdown, [StudyResult::Paper(paper)]) => reproduction_markdown(paper),
        (StudyFormat::Text, _) => studies_text(result),
        (StudyFormat::Markdown, _) => studies_markdown(result),
    })
}

/// The part of a report that identifies its studies.
#[derive(Deserialize)]
struct Stored {
    studies: Vec<StoredStudy>,
    version: String,
}

#[derive(Deserialize)]
struct StoredStudy {
    scenario: Option<ScenarioStamp>,
    sha256: Option<String>,
}

/// What a reproduction writes in its directory.
fn own() -> BTreeSet<String> {
    let own = REPRODUCTION_FILES.into_iter().chain(OTHERS);
    own.map(str::to_owned).collect()
}

/// Whether a directory contains these studies by this version.
fn holds(directory: &Path, identities: &[String]) -> bool {
    let stored = files::read_run(&directory.join(REPORT)).ok();
    let stored: Option<Stored> = stored.and_then(|bytes| serde_json::from_slice(&bytes).ok());
    stored.is_some_and(|stored| {
        let of = |one: StoredStudy| one.sha256.or(one.scenario.map(|stamp| stamp.hash));
        let held: Option<Vec<String>> = stored.studies.into_iter().map(of).collect();
        held.is_some_and(|held| held == identities) && stored.version == VERSION
    })
}

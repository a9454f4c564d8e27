//! `navwalker reproduce`: published numbers next to ours, those of the paper with its tables and figures.

use crate::cli::args::{ReproduceArgs, StudyArgs, StudyFormat};
use crate::cli::study::Study;
use crate::cli::{Status, files, output};
use crate::keyword::nearest;
use crate::printable::printable;
use crate::report::figures::draw::{png, svg};
use crate::report::figures::{PAPER_FIGURES, deviations_name, study_figures};
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
/// The files beside the tables and figures.
const OTHERS: [&str; 4] = [SCENARIO, REPORT, "report.md", "report.html"];
/// The forms of a figure.
const FORMS: [&str; 2] = ["svg", "png"];
/// Below it a study, or several, have their directory unless another is given.
const DEFAULT_PLACE: &str = "runs/reproduce";

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
    require_different(&chosen)?;
    let place = StudyPlace::new(args, &chosen)?;
    let staged = files::StagedDirectory::new(&place.directory)?;
    let mut written: Vec<(String, Vec<u8>)> = Vec::new();
    let mut studies = Vec::new();
    let mut status = Status::Done;
    for one in chosen {
        match one {
            Chosen::Paper(study) => {
                let result = paper(&study)?;
                let tables = reproduction_files(&result)?.into_iter();
                written.extend(tables.map(|(name, text)| (name.to_owned(), text.into_bytes())));
                written.push((SCENARIO.to_owned(), study.scenario.to_toml().into_bytes()));
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
    written.extend(reports(&result)?);
    written.extend(drawn(&result)?);
    for (name, bytes) in &written {
        files::write_atomically(&staged.path().join(name), bytes)?;
    }
    staged.commit_keeping(&files::others(&place.directory, &place.own)?)?;
    output::result(&render(&result, args.format)?)?;
    output::hint(&format!(
        "\nreport written to {}",
        place.directory.display()
    ));
    Ok(status)
}

/// The reports of some studies: as JSON, Markdown and a page.
fn reports(result: &StudiesResult) -> Result<[(String, Vec<u8>); 3]> {
    let mut page = Vec::new();
    result.write_page(&mut page)?;
    let [_, json, markdown, html] = OTHERS.map(str::to_owned);
    Ok([
        (json, render(result, StudyFormat::Json)?.into_bytes()),
        (
            markdown,
            render(result, StudyFormat::Markdown)?.into_bytes(),
        ),
        (html, page),
    ])
}

/// The figures of some studies, each in every form.
fn drawn(result: &StudiesResult) -> Result<Vec<(String, Vec<u8>)>> {
    let mut files = Vec::new();
    for (name, chart) in result.studies.iter().flat_map(study_figures) {
        let [mut vector, mut dots] = [Vec::new(), Vec::new()];
        svg(&chart, &mut vector)?;
        png(&chart, &mut dots)?;
        files.push((format!("{name}.{}", FORMS[0]), vector));
        files.push((format!("{name}.{}", FORMS[1]), dots));
    }
    Ok(files)
}

/// Fails if two studies have the same name: so have their figures.
fn require_different(chosen: &[Chosen]) -> Result<()> {
    let mut known = BTreeSet::new();
    for one in chosen {
        if !known.insert(one.name()) {
            bail!("study {} is given twice", one.name());
        }
    }
    Ok(())
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
            overrides: args.overrides.clone(),
            ..StudyArgs::default()
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
    /// Its name.
    fn name(&self) -> &str {
        match self {
            Self::Paper(_) => ReproduceResult::NAME,
            Self::Published(study) => &study.study.name,
        }
    }

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

/// Where the results go.
struct StudyPlace {
    directory: PathBuf,
    /// The files there that this command writes, or wrote for other studies.
    own: BTreeSet<String>,
}

impl StudyPlace {
    /// The place of some studies.
    ///
    /// # Errors
    /// If the results may not be written there.
    fn new(args: &ReproduceArgs, chosen: &[Chosen]) -> Result<Self> {
        let directory = args.out.clone().unwrap_or_else(|| {
            let names: Vec<&str> = chosen.iter().map(Chosen::name).collect();
            let name = if args.all {
                "all".to_owned()
            } else {
                names.join("+")
            };
            Path::new(DEFAULT_PLACE).join(name)
        });
        let stored = stored(&directory);
        let before = stored.iter().flat_map(|stored| &stored.studies);
        let before = before.map(|study| study.name.as_str());
        let own = own(chosen.iter().map(Chosen::name).chain(before));
        let identities = chosen.iter().map(Chosen::identity);
        let identities: Vec<String> = identities.collect::<Result<_>>()?;
        if !stored.is_some_and(|stored| stored.holds(&identities)) {
            if !args.force && !files::is_vacant(&directory)? {
                bail!(
                    "{} holds something other than this study by this version; choose another --out, or replace it with --force",
                    directory.display()
                );
            }
            let inputs: Vec<PathBuf> = chosen.iter().flat_map(Chosen::inputs).collect();
            files::refuse_inputs(&directory, inputs)?;
            files::require_replaceable(&directory, args.force, &own)?;
        }
        Ok(Self { directory, own })
    }
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
    name: String,
    scenario: Option<ScenarioStamp>,
    sha256: Option<String>,
}

impl Stored {
    /// Whether these are its studies, by this version.
    fn holds(self, identities: &[String]) -> bool {
        let of = |one: StoredStudy| one.sha256.or(one.scenario.map(|stamp| stamp.hash));
        let held: Option<Vec<String>> = self.studies.into_iter().map(of).collect();
        held.is_some_and(|held| held == identities) && self.version == VERSION
    }
}

/// The report in a directory, if there is one.
fn stored(directory: &Path) -> Option<Stored> {
    let bytes = files::read_run(&directory.join(REPORT)).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// What the reproduction of these studies writes in its directory.
fn own<'n>(studies: impl Iterator<Item = &'n str>) -> BTreeSet<String> {
    let tables = REPRODUCTION_FILES.into_iter().chain(OTHERS);
    let tables = tables.map(str::to_owned);
    let figures = PAPER_FIGURES.into_iter().map(str::to_owned);
    let figures = figures.chain(studies.map(deviations_name));
    let figures = figures.flat_map(|name| FORMS.map(|form| format!("{name}.{form}")));
    tables.chain(figures).collect()
}

//! `navwalker reproduce`: published numbers next to ours, with the tables and figures of their studies.

use crate::cli::args::{ReproduceArgs, StudyFormat};
use crate::cli::progress::Stages;
use crate::cli::provenance::provenance;
use crate::cli::{Status, files, limits, output};
use crate::keyword::nearest;
use crate::printable::printable;
use crate::report::figures::draw::{Sheet, pdf, png, svg};
use crate::report::figures::{deviations_name, study_figures};
use crate::report::{
    Align, StudiesResult, StudyResult, StudyStamp, Table, statements_csv, studies_markdown,
    studies_text, study_tables,
};
use crate::run::checkpoint::hex_sha256;
use crate::run::{REPORT_PAGE, SCENARIO, ScenarioStamp, VERSION};
use crate::scenario::Scenario;
use crate::study::published::{JudgedStudy, PublishedStudy, builtin_studies, builtin_study};
use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

/// The report that identifies the studies in a directory.
const REPORT: &str = "report.json";
/// The files beside the tables and figures.
const OTHERS: [&str; 5] = [SCENARIO, REPORT, "report.md", REPORT_PAGE, STATEMENTS];
/// All statements.
const STATEMENTS: &str = "statements.csv";
/// The forms of a figure.
const FORMS: [&str; 3] = ["svg", "pdf", "png"];
/// The study that is run if none is named.
const DEFAULT: &str = "paper";
/// Below it a study, or several, have their directory unless another is given.
const DEFAULT_PLACE: &str = "runs/reproduce";

/// A study of published numbers, from a file or built in.
struct ChosenStudy {
    study: PublishedStudy,
    /// Keys of its scenario by `--set` and `--seed`.
    overrides: Vec<String>,
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
    if let (Some(seed), [_, _, ..]) = (args.seed, names.as_slice()) {
        bail!("--seed {seed} is of the searches of one study; give one study");
    }
    let chosen = names.iter().map(|name| choose(name, args));
    let chosen: Vec<ChosenStudy> = chosen.collect::<Result<_>>()?;
    require_different(&chosen)?;
    let place = StudyPlace::new(args, &chosen)?;
    let staged = files::StagedDirectory::new(&place.directory)?;
    let mut studies = Vec::new();
    let mut status = Status::Done;
    let mut scenarios = Vec::new();
    let stages = Stages::new();
    let count = chosen.len();
    for (n, one) in chosen.into_iter().enumerate() {
        stages.begin(&format!("study {} of {count}: {}", n + 1, one.study.name));
        let judged = one.run()?;
        if judged.statements.iter().any(|one| one.is_unexpected()) {
            status = Status::Failed;
        }
        scenarios.push(judged.scenario.to_toml());
        let stamp = one.stamp(&judged.scenario)?;
        studies.push(StudyResult::new(judged, stamp));
    }
    stages.begin("drawing the figures");
    let result = StudiesResult::new(studies);
    let mut written = tables(&result)?;
    if let [scenario] = scenarios.as_slice() {
        written.push((SCENARIO.to_owned(), scenario.clone().into_bytes()));
    }
    written.extend(reports(&result)?);
    written.extend(drawn(&result)?);
    require_apart(&written)?;
    for (name, bytes) in &written {
        files::write_atomically(&staged.path().join(name), bytes)?;
    }
    let stamps = result
        .studies
        .iter()
        .map(|study| study.stamp.scenario.clone());
    let provenance = provenance(stamps.collect());
    staged.commit_keeping(&files::others(&place.directory, &place.own)?, &provenance)?;
    drop(stages);
    output::result(&render(&result, args.format)?)?;
    output::hint(&format!(
        "\nreport written to {}",
        place.directory.display()
    ));
    Ok(status)
}

/// The tables of some studies, with that of all statements.
fn tables(result: &StudiesResult) -> Result<Vec<(String, Vec<u8>)>> {
    let statements = statements_csv(&result.studies)?;
    let mut files = vec![(STATEMENTS.to_owned(), statements.into_bytes())];
    for study in &result.studies {
        let tables = study_tables(study)?.into_iter();
        files.extend(tables.map(|(name, text)| (name, text.into_bytes())));
    }
    Ok(files)
}

/// Fails if two studies write the same file.
fn require_apart(written: &[(String, Vec<u8>)]) -> Result<()> {
    let mut known = BTreeSet::new();
    for (name, _) in written {
        if !known.insert(name) {
            bail!("two of the studies write {name}; run them one at a time");
        }
    }
    Ok(())
}

/// The reports of some studies: as JSON, Markdown and a page.
fn reports(result: &StudiesResult) -> Result<[(String, Vec<u8>); 3]> {
    let mut page = Vec::new();
    result.write_page(&mut page)?;
    let [_, json, markdown, html, _] = OTHERS.map(str::to_owned);
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
        let sheet = Sheet::default();
        let [mut vector, mut page, mut dots] = [Vec::new(), Vec::new(), Vec::new()];
        svg(&chart, sheet, &mut vector)?;
        pdf(&chart, sheet, &mut page)?;
        png(&chart, sheet, &mut dots)?;
        for (form, bytes) in FORMS.iter().zip([vector, page, dots]) {
            files.push((format!("{name}.{form}"), bytes));
        }
    }
    Ok(files)
}

/// Fails if two studies have the same name: so have their figures.
fn require_different(chosen: &[ChosenStudy]) -> Result<()> {
    let mut known = BTreeSet::new();
    for one in chosen {
        if !known.insert(&one.study.name) {
            bail!("study {} is given twice", one.study.name);
        }
    }
    Ok(())
}

/// The names of the studies that are asked for.
fn names(args: &ReproduceArgs) -> Vec<String> {
    if args.all {
        return builtin_studies().into_iter().map(str::to_owned).collect();
    }
    if args.studies.is_empty() {
        return vec![DEFAULT.to_owned()];
    }
    args.studies.clone()
}

fn choose(name: &str, args: &ReproduceArgs) -> Result<ChosenStudy> {
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
    let mut overrides = args.overrides.clone();
    if let Some(seed) = args.seed {
        if !study.has_searches() {
            bail!(
                "--seed {seed} is of searches, and study {} has none",
                study.name
            );
        }
        overrides.push(format!("optimizer.seed={seed}"));
    }
    let identified = [&[text], overrides.as_slice()].concat().join("\n");
    Ok(ChosenStudy {
        study,
        overrides,
        sha256: hex_sha256(identified.as_bytes()),
        file,
    })
}

/// The error for a name that no built-in study has.
fn no_such(name: &str) -> anyhow::Error {
    let known = builtin_studies();
    let meant = nearest(name, &known);
    let meant = meant.map_or_else(String::new, |name| format!(", did you mean '{name}'?"));
    anyhow::anyhow!(
        "no built-in study '{}'{meant} (choices: {}); a file name needs an extension, as in study.toml",
        printable(name),
        known.join(", ")
    )
}

impl ChosenStudy {
    /// The bytes of a file that it names, relative to its own.
    fn read(&self, file: &str) -> io::Result<Vec<u8>> {
        let directory = self.file.as_deref().and_then(Path::parent);
        let directory = directory.map_or_else(PathBuf::new, Path::to_owned);
        files::read_whole(&directory.join(file))
    }

    fn run(&self) -> Result<JudgedStudy> {
        let read = |file: &str| self.read(file);
        // Also what is wrong in the scenario is told before a search begins.
        if let Ok(setup) = self.study.scenario(&self.overrides)?.setup(&read) {
            limits::check_whole(&setup)?;
        }
        if self.study.has_searches() {
            output::hint("running the searches of the study; this takes seconds to minutes");
        }
        Ok(self.study.run(&self.overrides, &read)?)
    }

    /// What identifies its results.
    fn stamp(&self, scenario: &Scenario) -> Result<StudyStamp> {
        let contents = scenario.files().into_iter().map(|file| self.read(file));
        let contents: Vec<Vec<u8>> = contents.collect::<io::Result<_>>()?;
        let contents: Vec<&[u8]> = contents.iter().map(Vec::as_slice).collect();
        Ok(StudyStamp {
            scenario: ScenarioStamp {
                name: scenario.name.clone(),
                hash: scenario.hash(&contents),
            },
            seed: self.study.has_searches().then_some(scenario.optimizer.seed),
            sha256: self.sha256.clone(),
        })
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
    fn new(args: &ReproduceArgs, chosen: &[ChosenStudy]) -> Result<Self> {
        let directory = args.out.clone().unwrap_or_else(|| {
            let names: Vec<&str> = chosen.iter().map(|one| one.study.name.as_str()).collect();
            let name = if args.all {
                "all".to_owned()
            } else {
                names.join("+")
            };
            Path::new(DEFAULT_PLACE).join(name)
        });
        let stored = stored(&directory);
        let mut own = own(chosen.iter().map(|one| &one.study));
        own.extend(stored.iter().flat_map(StoredReport::files));
        let identities: Vec<&str> = chosen.iter().map(|one| one.sha256.as_str()).collect();
        if !stored.is_some_and(|stored| stored.holds(&identities)) {
            if !args.force && !files::is_vacant(&directory)? {
                bail!(
                    "{} holds something other than this study by this version; choose another --out, or replace it with --force",
                    directory.display()
                );
            }
            let inputs = chosen.iter().filter_map(|one| one.file.clone());
            let inputs: Vec<PathBuf> = inputs.collect();
            files::refuse_inputs(&directory, inputs)?;
            files::require_replaceable(&directory, args.force, &own)?;
        }
        Ok(Self { directory, own })
    }
}

/// Prints the built-in studies.
fn list(format: StudyFormat) -> Result<Status> {
    let mut studies = Vec::new();
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
    Ok(match format {
        StudyFormat::Json => crate::printable::json(result)? + "\n",
        StudyFormat::Csv => statements_csv(&result.studies)?,
        StudyFormat::Text => studies_text(result),
        StudyFormat::Markdown => studies_markdown(result),
    })
}

/// The part of a report that identifies its studies.
#[derive(Deserialize)]
struct StoredReport {
    studies: Vec<StoredStudy>,
    version: String,
}

#[derive(Deserialize)]
struct StoredStudy {
    name: String,
    sha256: String,
    #[serde(default)]
    files: Vec<String>,
}

impl StoredReport {
    /// Whether these are its studies, by this version.
    fn holds(self, identities: &[&str]) -> bool {
        let held = self.studies.iter().map(|one| one.sha256.as_str());
        held.eq(identities.iter().copied()) && self.version == VERSION
    }

    /// The files that it says are beside it.
    fn files(&self) -> Vec<String> {
        let figures = self.studies.iter().map(|one| deviations_name(&one.name));
        let stems = self.studies.iter().flat_map(|one| &one.files);
        // Stems of studies, not whatever a file may say.
        let is_stem = |stem: &&String| {
            let mut characters = stem.chars();
            characters.all(|c| c.is_ascii_alphanumeric() || c == '-')
        };
        let stems = stems.filter(is_stem).cloned();
        stems.chain(figures).flat_map(in_forms).collect()
    }
}

/// The report in a directory, if there is one.
fn stored(directory: &Path) -> Option<StoredReport> {
    let bytes = files::read_run(&directory.join(REPORT)).ok()?;
    serde_json::from_slice(&bytes).ok()
}

/// A table or figure with each of its endings.
fn in_forms(stem: String) -> Vec<String> {
    let forms = FORMS.into_iter().chain(["csv"]);
    forms.map(|form| format!("{stem}.{form}")).collect()
}

/// What the reproduction of these studies writes in its directory.
fn own<'s>(studies: impl Iterator<Item = &'s PublishedStudy>) -> BTreeSet<String> {
    let stems = studies.flat_map(|study| {
        let stems = study.stems();
        stems.into_iter().chain([deviations_name(&study.name)])
    });
    let others = OTHERS.map(str::to_owned).into_iter();
    others.chain(stems.flat_map(in_forms)).collect()
}

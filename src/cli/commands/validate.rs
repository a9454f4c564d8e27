//! `navwalker validate`.

use crate::cli::args::{ReportFormat, ValidateArgs};
use crate::cli::constellations::{
    no_file_to_select_from, propagate, refuse_without, study_and_constellations,
};
use crate::cli::progress::Stages;
use crate::cli::provenance::provenance;
use crate::cli::study::Study;
use crate::cli::{Status, files, output, read_constellation};
use crate::constellation::Design;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::Constellation;
use crate::exchange::import::Fleet;
use crate::exchange::lint::Format;
use crate::exchange::manifest::{FILE_NAME, Manifest};
use crate::printable::printable;
use crate::report::{
    checks_csv, checks_junit, validation_markdown, validation_text, write_validation_page,
};
use crate::run::{REPORT_PAGE, ValidateResult};
use crate::scenario::{Scenario, builtin};
use crate::validate::file::{Comparand, ReferenceConstellation, against_file, comparands};
use crate::validate::{Findings, Subject, Target, against_paper};
use anyhow::{Context, Result, bail, ensure};
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// A standard, or files of another program.
enum Against {
    Standard(Target),
    Files(PathBuf),
}

impl Against {
    /// The files, if it is files.
    fn path(&self) -> Option<&Path> {
        match self {
            Self::Standard(_) => None,
            Self::Files(path) => Some(path),
        }
    }
}

/// The reports of a validation.
const REPORTS: [(&str, ReportFormat); 5] = [
    ("report.txt", ReportFormat::Text),
    ("report.json", ReportFormat::Json),
    ("report.csv", ReportFormat::Csv),
    ("report.md", ReportFormat::Markdown),
    ("report.junit.xml", ReportFormat::Junit),
];

/// The command that compares a design with integrations under all forces.
const FULL_FORCE: &str = "`python validation/external/full_force.py --design NOTATION --out DIR` of the source repository";

/// The targets on the command line; one with a dot or a slash is a file or a directory.
fn targets(typed: &[String]) -> Result<Vec<Against>> {
    let one = |name: &String| {
        if name.contains(['.', '/', '\\']) {
            return Ok(Against::Files(PathBuf::from(name)));
        }
        ensure!(
            name != "full-force",
            "--against full-force: this program has no full force model; {FULL_FORCE} integrates a design by brahe, \
             force by force, and writes ephemerides that `--against FOLDER` reads"
        );
        let target = name.parse().with_context(|| {
            format!("--against {name}: neither a target nor a path (a path contains a '.' or '/')")
        })?;
        Ok(Against::Standard(target))
    };
    typed.iter().map(one).collect()
}

pub(crate) fn run(args: &ValidateArgs) -> Result<Status> {
    refuse_without(&args.without)?;
    let targets = targets(&args.against)?;
    let run = args.chosen.run.as_deref().filter(|_| args.report);
    let out = args.out.clone().or(run.map(|run| run.join("validation")));
    if let Some(directory) = &out {
        let names = REPORTS.iter().map(|(name, _)| *name).chain([REPORT_PAGE]);
        let own = names.map(str::to_owned).collect();
        files::require_replaceable(directory, args.force, &own)?;
    }
    let (study, constellations) = study_and_constellations(&args.study, &args.chosen)?;
    if let Some(directory) = &out {
        let compared = targets.iter().filter_map(Against::path);
        let inputs = study.inputs();
        let inputs = inputs.iter().map(PathBuf::as_path).chain(compared);
        files::refuse_inputs(directory, inputs)?;
    }
    let staged = out
        .as_deref()
        .map(files::StagedDirectory::new)
        .transpose()?;
    let evaluator = study.evaluator()?;
    let subjects = Subjects {
        evaluator: &evaluator,
        targets: &targets,
        sources: sources(&targets, args)?,
        study: &study,
        stages: Stages::new(),
    };
    let mut findings = Findings::default();
    for one in &constellations {
        let found = subjects.of_constellation(one)?;
        findings.append(match constellations.len() {
            1 => found,
            _ => found.prefixed(&one.name),
        });
    }
    findings.append(subjects.of_study()?);
    drop(subjects);
    let model = evaluator.setup().model;
    let against = args
        .against
        .iter()
        .map(|target| printable(target).into_owned());
    let against = against.collect();
    let result = ValidateResult::new(&constellations, model, against, findings, study.stamp()?);
    output::result(&render(&result, args.format)?)?;
    if let Some(staged) = staged {
        write_reports(staged, &result)?;
    }
    if let Some(run) = run {
        let page = super::report::of_run(run, out.as_deref())?;
        output::hint(&format!("report written to {}", page.display()));
    }
    Ok(if result.passed {
        Status::Done
    } else {
        Status::Failed
    })
}

/// What constellations are compared with.
struct Subjects<'a> {
    evaluator: &'a Evaluator,
    targets: &'a [Against],
    /// The files of each target that is files.
    sources: Vec<Vec<ComparedFiles>>,
    study: &'a Study,
    stages: Stages,
}

impl Subjects<'_> {
    /// The standards to compare with.
    fn standards(&self) -> Result<Vec<Target>> {
        let mut standards = Vec::new();
        for target in self.targets {
            if let Against::Standard(target) = target {
                standards.extend(standards_for(*target, self.study)?);
            }
        }
        Ok(standards)
    }

    /// Whether all standards are asked for, those that check designs only where there is one, and files too.
    fn is_all_with_files(&self) -> bool {
        let is_all = |target: &Against| matches!(target, Against::Standard(Target::All));
        self.targets.iter().any(is_all) && !self.sources.iter().all(Vec::is_empty)
    }

    /// What is found about the study, whatever is propagated in it.
    fn of_study(&self) -> Result<Findings> {
        let mut findings = Findings::default();
        for target in self.standards()? {
            if target == Target::Paper {
                let read = |file: &str| self.study.named_file(file);
                findings.append(against_paper(&self.study.scenario, &read)?);
            }
        }
        Ok(findings)
    }

    fn of_constellation(&self, one: &Constellation) -> Result<Findings> {
        let ephemeris = propagate(one, self.evaluator.setup())?;
        let mut findings = Findings::default();
        for target in self.standards()? {
            if target == Target::Paper {
                continue;
            }
            match &one.design {
                Some(design) => {
                    self.stages
                        .begin(&format!("{}: comparing with {target}", one.name));
                    findings.append(self.of_shells(target, design)?);
                }
                None if self.is_all_with_files() => {}
                None => bail!(
                    "{}: {target} checks the propagation of a design; satellites from files have a theory of their \
                     own and are compared with other files only, as in --against other.oem",
                    one.name
                ),
            }
        }
        if one.design.is_some() && one.files.is_some() && !findings.checks.is_empty() {
            findings.notes.push(format!(
                "{}: the standards check its shells; its satellites from files have a theory of their own",
                one.name
            ));
        }
        if self.sources.iter().all(Vec::is_empty) {
            return Ok(findings);
        }
        let expected = match one.only_design() {
            Some(design) => ReferenceConstellation::of_design(design, self.evaluator)?,
            None => ReferenceConstellation::of_satellites(ephemeris, self.evaluator)?,
        };
        for source in self.sources.iter().flatten() {
            self.stages
                .begin(&format!("{}: comparing with {}", one.name, source.name));
            findings.append(against_file(
                &expected,
                &source.name,
                &source.comparands()?,
            )?);
        }
        Ok(findings)
    }

    fn of_shells(&self, target: Target, design: &Design) -> Result<Findings> {
        let subjects = Subject::of_shells(design, self.evaluator);
        let found = subjects.iter().map(|subject| target.findings(subject));
        Ok(Findings::of_design(
            design,
            found.collect::<Result<_, _>>()?,
        ))
    }
}

/// The standards a target covers; `all` includes the paper's tables only for the paper's own study,
/// since no other has its mask.
fn standards_for(target: Target, study: &Study) -> Result<Vec<Target>> {
    let ours = &study.scenario;
    let paper = Scenario::parse("paper", builtin("paper")?.as_bytes(), &[] as &[&str])?;
    let sees_the_same = ours.time == paper.time
        && ours.earth == paper.earth
        && ours.region == paper.region
        && ours.visibility == paper.visibility
        && ours.gnss == paper.gnss;
    let applies = |each: &Target| target != Target::All || *each != Target::Paper || sees_the_same;
    Ok(target.each().filter(applies).collect())
}

/// Files that are compared together, and their satellites.
struct ComparedFiles {
    name: String,
    files: Vec<(PathBuf, Fleet)>,
}

impl ComparedFiles {
    fn read(name: String, path: &Path, format: Option<Format>) -> Result<Self> {
        let read = read_constellation::read_each(path, format)?.into_iter();
        let files: Vec<_> = read
            .map(|(file, imported)| (file, imported.fleet))
            .collect();
        if files.iter().all(|(_, fleet)| fleet.is_empty()) {
            bail!("{} has no objects", output::shown_path(path));
        }
        Ok(Self { name, files })
    }

    fn comparands(&self) -> Result<Vec<Comparand>> {
        let mut all = Vec::new();
        for (file, fleet) in &self.files {
            all.extend(comparands(&output::shown_path(file), fleet.clone())?);
        }
        Ok(all)
    }
}

/// The sources of each target that is files, with the satellites that are selected.
fn sources(targets: &[Against], args: &ValidateArgs) -> Result<Vec<Vec<ComparedFiles>>> {
    let paths = targets.iter().filter_map(Against::path);
    let mut found = paths
        .map(|path| comparisons(path, args.chosen.given.input_format))
        .collect::<Result<Vec<_>>>()?;
    let filter = args.chosen.given.satellites.filter();
    if filter.is_empty() {
        return Ok(found);
    }
    if found.is_empty() {
        if args.chosen.given.constellation.is_empty() {
            return Err(no_file_to_select_from());
        }
        return Ok(found);
    }
    let files = found
        .iter_mut()
        .flatten()
        .flat_map(|source| &mut source.files);
    let mut fleets: Vec<&mut Fleet> = files.map(|(_, fleet)| fleet).collect();
    filter.keep(&mut fleets)?;
    for sources in &mut found {
        sources.retain(|source| {
            let is_left = source.files.iter().any(|(_, fleet)| !fleet.is_empty());
            if !is_left {
                output::warning(&format!(
                    "{}: none of its satellites is selected",
                    source.name
                ));
            }
            is_left
        });
    }
    Ok(found)
}

/// The comparisons for a path: a file, the formats of an export, or all files in a directory.
fn comparisons(path: &Path, format: Option<Format>) -> Result<Vec<ComparedFiles>> {
    let name = path.file_name().unwrap_or(path.as_os_str());
    let name = output::shown_path(Path::new(name));
    let manifest = path.join(FILE_NAME);
    if !path.is_dir() || !manifest.exists() {
        return Ok(vec![ComparedFiles::read(name, path, format)?]);
    }
    let bytes = files::read_run(&manifest)
        .with_context(|| format!("cannot read {}", manifest.display()))?;
    let manifest = Manifest::read(bytes.as_slice())
        .with_context(|| format!("{} is not an export manifest", manifest.display()))?;
    let mut by_format: BTreeMap<String, Vec<(PathBuf, Fleet)>> = BTreeMap::new();
    for file in manifest.files {
        if file.is_of_design() && COMPARED.contains(&file.format.as_str()) {
            if !is_inside(&file.path) {
                bail!(
                    "{}: the manifest names {}, which is outside the directory",
                    path.display(),
                    file.path
                );
            }
            let found = ComparedFiles::read(file.format, &path.join(&file.path), format)?;
            by_format.entry(found.name).or_default().extend(found.files);
        }
    }
    if by_format.is_empty() {
        bail!(
            "{} has no files in a format that can be compared: {}",
            path.display(),
            COMPARED.join(", ")
        );
    }
    let source = |(name, files)| ComparedFiles { name, files };
    Ok(by_format.into_iter().map(source).collect())
}

/// Whether a path of a manifest stays in its directory.
fn is_inside(path: &str) -> bool {
    let is_plain = |part| matches!(part, Component::Normal(_));
    Path::new(path).components().all(is_plain) && !path.contains('\\')
}

/// Formats of an export that can be read back.
const COMPARED: [&str; 8] = [
    "tle", "omm", "omm-xml", "omm-json", "omm-csv", "oem", "sp3", "stk",
];

fn write_reports(staged: files::StagedDirectory, result: &ValidateResult) -> Result<()> {
    for (name, format) in REPORTS {
        let text = render(result, format)?;
        files::write_atomically(&staged.path().join(name), text.as_bytes())?;
    }
    let mut page = Vec::new();
    write_validation_page(result, &mut page)?;
    files::write_atomically(&staged.path().join(REPORT_PAGE), &page)?;
    staged.commit(&provenance(vec![result.scenario.clone()]))
}

fn render(result: &ValidateResult, format: ReportFormat) -> Result<String> {
    Ok(match format {
        ReportFormat::Text => validation_text(result),
        ReportFormat::Json => crate::printable::json(result)? + "\n",
        ReportFormat::Csv => checks_csv(&result.findings.checks)?,
        ReportFormat::Markdown => validation_markdown(result),
        ReportFormat::Junit => checks_junit(&result.findings.checks),
    })
}

//! A run as `report` and `plot` show it: the contents of its directory and what follows from them.

use crate::cli::args::{MemberPick, RunArgs};
use crate::cli::study::Study;
use crate::cli::{files, output};
use crate::constellation::Design;
use crate::evaluate::Evaluator;
use crate::report::figures::{Baseline, NamedFront};
use crate::report::shown;
use crate::run::inputs::InputError;
use crate::run::{
    FRONT_JSON, FrontMember, HISTORY_JSON, OptimizeResult, Run, RunFiles, SCENARIO, VALIDATION,
    VALIDATION_REPORT,
};
use crate::search::DesignProblem;
use anyhow::{Context, Result, bail};
use std::fs;
use std::io;
use std::path::Path;

/// A run, with the designs and fronts shown for comparison.
pub(crate) struct RunView {
    pub(crate) run: Run,
    /// Text of the scenario, for the provenance.
    pub(crate) scenario_toml: Option<String>,
    /// `None` if the scenario can no longer be set up.
    pub(crate) evaluator: Option<Evaluator>,
    /// The reference design and those of `--compare`, with their names.
    pub(crate) beside: Vec<(String, Design)>,
    pub(crate) fronts: Vec<NamedFront>,
}

impl RunView {
    /// Reads the files that exist; an error only if there is no run at all.
    pub(crate) fn at(args: &RunArgs) -> Result<Self> {
        let files = read(args)?;
        let mut run = Run::read(&files);
        let evaluator = match evaluator(&args.directory, &run) {
            Ok(evaluator) => evaluator,
            // Nothing computed from other inputs is shown with the results of the run.
            Err(error) if error.is::<InputError>() => return Err(error),
            Err(error) => {
                run.gaps.push(format!("no maps and series: {error:#}"));
                None
            }
        };
        for gap in &run.gaps {
            output::warning(gap);
        }
        let beside = beside(args, &run);
        let fronts = fronts(args)?;
        let scenario_toml = files.scenario.ok();
        Ok(Self {
            run,
            scenario_toml: scenario_toml.map(|text| String::from_utf8_lossy(&text).into_owned()),
            evaluator,
            beside,
            fronts,
        })
    }

    /// The designs shown for comparison, with their objectives.
    pub(crate) fn baselines(&self) -> Vec<Baseline> {
        let (Some(evaluator), Some(scenario)) = (&self.evaluator, &self.run.scenario) else {
            return Vec::new();
        };
        let designs = scenario.search.designs;
        let Ok(problem) = DesignProblem::new(evaluator, designs, scenario.goals()) else {
            return Vec::new();
        };
        let evaluated =
            |(name, design): &(String, Design)| Baseline::evaluate(name, design, &problem);
        self.beside.iter().filter_map(evaluated).collect()
    }

    /// The picked member.
    pub(crate) fn pick(&self, pick: &MemberPick) -> Result<&FrontMember> {
        let members = &self.run.front;
        let picked = pick.apply(members)?;
        Ok(&members[picked.place])
    }
}

fn read(args: &RunArgs) -> Result<RunFiles> {
    let directory = &args.directory;
    files::recovered(directory)?;
    let read = |name: &str| fs::read(directory.join(name)).map_err(reason);
    let files = RunFiles {
        scenario: read(SCENARIO),
        front: read(FRONT_JSON),
        history: read(HISTORY_JSON),
        validation: validation(args)?,
    };
    if files.scenario.is_err() && files.front.is_err() && files.history.is_err() {
        bail!(
            "{} is not a run directory: it has no scenario, front or history",
            directory.display()
        );
    }
    Ok(files)
}

/// Why a file cannot be read, without its path, which is not part of a result.
fn reason(error: io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "the file does not exist".to_owned(),
        _ => error.to_string(),
    }
}

/// The validation given by the user, or the one in the run directory.
fn validation(args: &RunArgs) -> Result<Option<Vec<u8>>> {
    match &args.validation {
        Some(path) => {
            let file = if path.is_dir() {
                path.join(VALIDATION_REPORT)
            } else {
                path.clone()
            };
            let bytes =
                fs::read(&file).with_context(|| format!("cannot read {}", file.display()))?;
            Ok(Some(bytes))
        }
        None => Ok(fs::read(args.directory.join(VALIDATION).join(VALIDATION_REPORT)).ok()),
    }
}

/// The evaluator of the run's scenario, if it has one.
fn evaluator(directory: &Path, run: &Run) -> Result<Option<Evaluator>> {
    if run.scenario.is_none() {
        return Ok(None);
    }
    Ok(Some(Study::of_run(directory, &[])?.evaluator()?))
}

fn beside(args: &RunArgs, run: &Run) -> Vec<(String, Design)> {
    let reference = run
        .scenario
        .as_ref()
        .and_then(|s| s.reference_design().ok());
    let reference = reference.map(|design| ("reference design".to_owned(), design));
    let compared = args
        .compare
        .iter()
        .map(|design| (design.to_string(), design.clone()));
    reference.into_iter().chain(compared).collect()
}

/// The fronts given by the user, and that of the sweep that certified the run, if any.
fn fronts(args: &RunArgs) -> Result<Vec<NamedFront>> {
    let mut name = args.directory.file_name().unwrap_or_default().to_owned();
    name.push("-sweep");
    let sweep = args.directory.with_file_name(name);
    let found = sweep.join(FRONT_JSON).exists().then_some(&sweep);
    let wanted = found.into_iter().chain(&args.front);
    wanted.map(|path| front(path)).collect()
}

fn front(directory: &Path) -> Result<NamedFront> {
    let path = directory.join(FRONT_JSON);
    let bytes = fs::read(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let found = OptimizeResult::read(&bytes)
        .with_context(|| format!("{} is not a front written by this program", path.display()))?;
    Ok(NamedFront {
        name: format!("front of {}", shown::algorithm(&found.search.algorithm)),
        front: found.front,
    })
}

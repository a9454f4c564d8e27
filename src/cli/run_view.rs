//! What `report` and `plot` show: a run, or a scenario, with the constellations that are compared.

use crate::cli::args::{ConstellationArgs, MemberPick, ViewArgs};
use crate::cli::study::Study;
use crate::cli::{constellations, files, output, run};
use crate::evaluate::Evaluator;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::report::figures::{Baseline, NamedFront};
use crate::report::{Compared, shown};
use crate::run::inputs::InputError;
use crate::run::{
    FRONT_JSON, FrontMember, HISTORY_JSON, OptimizeResult, Run, RunFiles, SCENARIO, ScenarioStamp,
    VALIDATION, VALIDATION_REPORT,
};
use crate::search::DesignProblem;
use anyhow::{Context, Result, bail};
use std::io;
use std::path::{Path, PathBuf};

/// A run or a scenario, with the constellations and fronts shown for comparison.
pub(crate) struct View {
    /// The run; with the scenario alone if it is not one.
    pub(crate) run: Run,
    /// The study, if there was no search.
    pub(crate) stamp: Option<ScenarioStamp>,
    /// The members of a run of given constellations, which are shown as constellations: the first of those compared.
    pub(crate) given: Vec<FrontMember>,
    /// Text of the scenario, for the provenance.
    pub(crate) scenario_toml: Option<String>,
    /// `None` if the scenario of a run can no longer be set up.
    pub(crate) evaluator: Option<Evaluator>,
    /// The constellations that are compared.
    pub(crate) compared: Vec<Compared>,
    pub(crate) fronts: Vec<NamedFront>,
    /// Satellites from files that every member of the front has beside its design.
    pub(crate) fixed: Option<FileSatellites>,
    /// The files and directories that were read.
    pub(crate) inputs: Vec<PathBuf>,
}

impl View {
    pub(crate) fn new(args: &ViewArgs) -> Result<Self> {
        let mut view = match args.run() {
            Some(directory) => Self::of_run(&directory, args)?,
            None => Self::of_scenario(args)?,
        };
        let further = args.front.iter().chain(&args.validation).cloned();
        view.inputs.extend(further);
        view.inputs.extend(args.run().map(|run| sweep(&run)));
        let constellations = args.constellations.inputs().map(Path::to_owned);
        view.inputs.extend(constellations);
        Ok(view)
    }

    /// Reads the files that exist; an error only if there is no run at all.
    fn of_run(directory: &Path, args: &ViewArgs) -> Result<Self> {
        if let Some(key) = args.overrides.first() {
            bail!(
                "--set {key}: a run keeps the scenario that it was made with; give a scenario in its place"
            );
        }
        if let Some(name) = args.without.first() {
            bail!(
                "--without {name}: a run keeps the scenario that it was made with; give a scenario in its place"
            );
        }
        let files = read(directory, args)?;
        let mut run = Run::read(&files);
        let study = match study(directory, &run) {
            Ok(study) => study,
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
        let mut given = Vec::new();
        let mut fixed = None;
        let (evaluator, compared) = match study {
            Some((study, evaluator)) => {
                let shown = if run.is_of_given() {
                    given = std::mem::take(&mut run.front);
                    beside_given(&given, &args.constellations, &study)?
                } else {
                    fixed = study.fixed()?.and_then(|fixed| fixed.files);
                    let beside = beside_front(&args.constellations, &study)?;
                    warn_of_fixed(fixed.as_ref(), &beside);
                    beside
                };
                let compared = compared(shown, given.len(), &study, &evaluator)?;
                (Some(evaluator), compared)
            }
            None if !args.constellations.is_empty() => {
                bail!("nothing can be compared with a run whose scenario cannot be set up");
            }
            None => (None, Vec::new()),
        };
        let scenario_toml = files.scenario.ok();
        let of_given = run.search.as_ref().filter(|_| !given.is_empty());
        Ok(Self {
            stamp: of_given.map(|search| search.scenario.clone()),
            given,
            run,
            scenario_toml: scenario_toml.map(|text| String::from_utf8_lossy(&text).into_owned()),
            evaluator,
            compared,
            fronts: fronts(directory, args)?,
            fixed,
            inputs: vec![directory.to_owned()],
        })
    }

    /// The constellations given on the command line, or else those that the scenario names.
    fn of_scenario(args: &ViewArgs) -> Result<Self> {
        for (option, is_given) in [
            ("--front", !args.front.is_empty()),
            ("--validation", args.validation.is_some()),
        ] {
            if is_given {
                bail!("{option} is of a run: give its directory in place of the scenario");
            }
        }
        let study = Study::load(&args.study(), &[]).map_err(|error| neither(args, error))?;
        let study = study.without(&args.study(), &args.without)?;
        let given = match args.constellations.is_empty() {
            true => constellations::of_scenario(&study)?,
            false => constellations::resolve(&args.constellations, &study)?,
        };
        if given.is_empty() {
            bail!(
                "scenario {} names no constellations: give --design or --constellation, or a run directory in place \
                 of the scenario",
                study.scenario.name
            );
        }
        let evaluator = study.evaluator()?;
        let compared = compared(given, 0, &study, &evaluator)?;
        Ok(Self {
            stamp: Some(study.stamp()?),
            given: Vec::new(),
            scenario_toml: Some(study.scenario.to_toml()),
            inputs: study.inputs(),
            run: Run {
                scenario: Some(study.scenario),
                ..Run::default()
            },
            evaluator: Some(evaluator),
            compared,
            fronts: Vec::new(),
            fixed: None,
        })
    }

    /// Whether it is the run of a search that is shown.
    pub(crate) fn is_of_search(&self) -> bool {
        self.stamp.is_none()
    }

    /// The places of the compared constellations among the objectives; none beside a front that is empty.
    pub(crate) fn baselines(&self) -> Vec<Baseline> {
        if self.is_of_search() && self.run.front.is_empty() {
            return Vec::new();
        }
        let each = self.compared.iter();
        each.map(|one| one.baseline.clone()).collect()
    }

    /// The picked member.
    pub(crate) fn pick(&self, pick: &MemberPick) -> Result<&FrontMember> {
        let members = &self.run.front;
        let picked = pick.apply(members)?;
        Ok(&members[picked.place])
    }
}

/// The error for an argument that is neither a run nor a scenario.
fn neither(args: &ViewArgs, error: anyhow::Error) -> anyhow::Error {
    match &args.subject {
        Some(name) if !Path::new(name).exists() => {
            error.context(format!("{name} is neither a run directory nor a scenario"))
        }
        _ => error,
    }
}

/// What is shown beside a front: the reference design, the constellations of the scenario, and those given on the
/// command line; the reference design not if one of the others is the same, nor one of the scenario that is given.
fn beside_front(args: &ConstellationArgs, study: &Study) -> Result<Vec<Constellation>> {
    let given = constellations::resolve(args, study)?;
    let mut all = constellations::of_scenario(study)?;
    all.retain(|one| !given.contains(one));
    all.extend(given);
    constellations::require_different_names(&all)?;
    if let Ok(design) = study.scenario.reference_design()
        && !all.iter().any(|one| one.only_design() == Some(&design))
    {
        let reference = Constellation::of_design(design);
        all.insert(0, reference.named(Baseline::REFERENCE.to_owned()));
    }
    Ok(all)
}

/// Warns that what is compared with a front is taken as it is, without what the search adds to each design from files:
/// by its name it has the numbers that `evaluate` prints of it, and a constellation with both can be named.
fn warn_of_fixed(fixed: Option<&FileSatellites>, beside: &[Constellation]) {
    let Some(fixed) = fixed else { return };
    let has_fixed = |one: &Constellation| one.counted(Some(fixed)).has_fixed_files;
    let without = beside.iter().filter(|one| !has_fixed(one));
    let names: Vec<&str> = without.map(|one| one.name.as_str()).collect();
    if !names.is_empty() {
        output::warning(&format!(
            "compared as given, without the satellites of {} that every design of the search has: {}; to compare \
             with them, give `design` and `files` to one constellation in [constellations]",
            fixed.names.join(", "),
            names.join(", ")
        ));
    }
}

/// What is shown of a run of given constellations: these, and the constellations given on the command line.
fn beside_given(
    members: &[FrontMember],
    args: &ConstellationArgs,
    study: &Study,
) -> Result<Vec<Constellation>> {
    let of_member = |member: &FrontMember| -> Result<Constellation> {
        let one = run::constellation_of(member, study)?;
        Ok(match &member.name {
            Some(name) => one.named(name.clone()),
            None => one,
        })
    };
    let mut all: Vec<Constellation> = members.iter().map(of_member).collect::<Result<_>>()?;
    all.extend(constellations::resolve(args, study)?);
    constellations::require_different_names(&all)?;
    Ok(all)
}

/// The constellations, propagated and evaluated; the first `members` are of the run that is shown.
fn compared(
    all: impl IntoIterator<Item = Constellation>,
    members: usize,
    study: &Study,
    evaluator: &Evaluator,
) -> Result<Vec<Compared>> {
    let fixed = study.fixed()?;
    let designs = study.scenario.design_space();
    let problem = DesignProblem::new(evaluator, designs, study.goals(fixed.as_ref()))?;
    let files = fixed.as_ref().and_then(|fixed| fixed.files.as_ref());
    let one = |(place, one): (usize, Constellation)| {
        let setup = evaluator.setup();
        let ephemeris = match place < members {
            true => constellations::propagate_member(&one, setup)?,
            false => constellations::propagate(&one, setup)?,
        };
        let name = one.name.clone();
        Compared::new(one, ephemeris, &problem, files)
            .with_context(|| format!("cannot evaluate {name}"))
    };
    all.into_iter().enumerate().map(one).collect()
}

fn read(directory: &Path, args: &ViewArgs) -> Result<RunFiles> {
    files::recovered(directory)?;
    let read = |name: &str| files::read_run(&directory.join(name)).map_err(reason);
    let files = RunFiles {
        scenario: read(SCENARIO),
        front: read(FRONT_JSON),
        history: read(HISTORY_JSON),
        validation: validation(directory, args)?,
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
fn validation(directory: &Path, args: &ViewArgs) -> Result<Option<Vec<u8>>> {
    match &args.validation {
        Some(path) => {
            let file = if path.is_dir() {
                path.join(VALIDATION_REPORT)
            } else {
                path.clone()
            };
            let bytes = files::read_run(&file)
                .with_context(|| format!("cannot read {}", file.display()))?;
            Ok(Some(bytes))
        }
        None => Ok(files::read_run(&directory.join(VALIDATION).join(VALIDATION_REPORT)).ok()),
    }
}

/// The study of the run's scenario and its evaluator, if it has one.
fn study(directory: &Path, run: &Run) -> Result<Option<(Study, Evaluator)>> {
    if run.scenario.is_none() {
        return Ok(None);
    }
    let study = Study::of_run(directory, &[])?;
    let evaluator = study.evaluator()?;
    Ok(Some((study, evaluator)))
}

/// The sweep that certified a run, which may not exist.
fn sweep(directory: &Path) -> PathBuf {
    let mut name = directory.file_name().unwrap_or_default().to_owned();
    name.push("-sweep");
    directory.with_file_name(name)
}

/// The fronts given by the user, and that of the sweep that certified the run, if any.
fn fronts(directory: &Path, args: &ViewArgs) -> Result<Vec<NamedFront>> {
    let sweep = sweep(directory);
    let found = sweep.join(FRONT_JSON).exists().then_some(&sweep);
    let wanted = found.into_iter().chain(&args.front);
    wanted.map(|path| front(path)).collect()
}

fn front(directory: &Path) -> Result<NamedFront> {
    let path = directory.join(FRONT_JSON);
    let bytes =
        files::read_run(&path).with_context(|| format!("cannot read {}", path.display()))?;
    let found = OptimizeResult::read(&bytes)
        .with_context(|| format!("{} is not a front written by this program", path.display()))?;
    Ok(NamedFront {
        name: format!("front of {}", shown::algorithm(&found.search.algorithm)),
        front: found.front,
    })
}

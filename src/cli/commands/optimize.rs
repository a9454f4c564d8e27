//! `navwalker optimize`.

mod seeds;

use crate::cli::args::{OptimizeArgs, OutputFormat, quoted};
use crate::cli::evaluations::EvaluationsFile;
use crate::cli::interrupt::Stoppable;
use crate::cli::limits::shown_time;
use crate::cli::progress::SearchBar;
use crate::cli::run::{Placed, RunDirectory};
use crate::cli::study::{Study, read_manifest, say_of_setup};
use crate::cli::{Status, chart, coincidence, constellations, evaluations, output};
use crate::evaluate::{Evaluator, Setup};
use crate::optimize::{Exhaustive, Pick, Problem, Search, Strategy};
use crate::printable::printable;
use crate::report::front_table::front_table;
use crate::report::shown;
use crate::run::inputs::InputError;
use crate::run::{FixedSummary, FrontMember, OptimizeResult, front_csv};
use crate::scenario::{Algorithm, Scenario};
use crate::search::{DesignProblem, Quantity};
use crate::units::counted;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::time::Instant;

pub(crate) fn run(args: &OptimizeArgs) -> Result<Status> {
    match (&args.from, args.seeds) {
        (Some(directory), _) => evaluations::front(args, directory),
        (None, Some(count)) => seeds::run(args, count),
        (None, None) => one(args),
    }
}

/// The scenario that was asked for.
pub(super) fn load(args: &OptimizeArgs) -> Result<Study> {
    Study::load(&args.study, &overrides_of_seed(args))
}

fn overrides_of_seed(args: &OptimizeArgs) -> Vec<String> {
    let seed = args.seed.map(|seed| format!("optimizer.seed={seed}"));
    seed.into_iter().collect()
}

/// With --resume, the study of the run in `directory`: with its copies of the files and, if no
/// scenario is named and the default differs, its scenario.
pub(super) fn resumed(args: &OptimizeArgs, mut study: Study, directory: &Path) -> Result<Study> {
    let manifest = read_manifest(directory).ok().flatten();
    let Some(manifest) = manifest.filter(|_| args.resume) else {
        return Ok(study);
    };
    study.take_files_of(directory)?;
    let is_named = args.study.scenario.is_some();
    if is_named || study.identity().is_ok_and(|ours| ours == manifest.identity) {
        return Ok(study);
    }
    let overrides = args.study.overrides.iter().cloned();
    let overrides: Vec<String> = overrides.chain(overrides_of_seed(args)).collect();
    let own = Study::of_run(directory, &overrides)?;
    match own.identity() {
        Err(error) if error.is::<InputError>() => Err(error),
        // A file that --set names is not in the directory of the run.
        Err(_) => Ok(study),
        Ok(_) => Ok(own),
    }
}

/// The search with the seed of the scenario.
fn one(args: &OptimizeArgs) -> Result<Status> {
    let study = load(args)?;
    let (name, seed) = (&study.scenario.name, study.scenario.optimizer.seed);
    let default_out = || PathBuf::from(format!("runs/{name}-{seed}"));
    let out = args.out.clone().unwrap_or_else(default_out);
    let study = resumed(args, study, &out)?;
    let (study, scenario) = (&study, &study.scenario);
    check_sweep(args, scenario)?;
    let setup = study.setup()?;
    coincidence::warn(&setup.gnss, setup.grid, None);
    warn_of_space(study, &setup)?;
    let evaluator = Evaluator::new(setup)?;
    let mut directory = open(args, study, &out)?;
    let sweep = match sweep(args, study, &evaluator, &out)? {
        Sweep::NotWanted => None,
        Sweep::Done(result) => Some(result),
        Sweep::Interrupted => return Ok(Status::Interrupted),
    };
    let ended = search(args, study, &evaluator, &mut directory, sweep.as_deref())?;
    let result = &ended.result;
    output::result(&match args.format {
        OutputFormat::Text => text(result, &scenario.name),
        OutputFormat::Json => crate::printable::json(result)?,
        OutputFormat::Csv => front_csv(&result.front)?,
    })?;
    let placed = ended.placed?;
    if args.report {
        let page = super::report::of_run(&out, None)?;
        output::hint(&format!("\nreport written to {}", page.display()));
    }
    if ended.is_interrupted {
        hint_interrupted(result, placed, &out, false);
        return Ok(Status::Interrupted);
    }
    hint_what_next(result, &out.display().to_string());
    hint_size(args, scenario);
    Ok(status(result))
}

/// Warns of what makes the search space larger than it need be, and of what is fixed in it.
pub(super) fn warn_of_space(study: &Study, setup: &Setup) -> Result<()> {
    for repetition in study.scenario.design_space().repetitions() {
        output::warning(&repetition);
    }
    say_of_setup(setup);
    if let Some(outage) = setup.outage_of_constellation() {
        bail!(
            "{}: '{}' is no GNSS satellite; the designs of a search have no satellites that can be named",
            outage.origin,
            printable(&outage.satellite)
        );
    }
    if let Some(fixed) = study.fixed()? {
        constellations::propagate(&fixed, setup)?;
    }
    Ok(())
}

/// Refuses `--certify` for a search space that an exhaustive search refuses.
pub(super) fn check_sweep(args: &OptimizeArgs, scenario: &Scenario) -> Result<()> {
    let excess = scenario.excess_of_sweep().filter(|_| args.certify);
    if let Some((designs, limit)) = excess {
        bail!(
            "--certify would evaluate {designs:.0} designs, expected at most {limit}; use a larger \
             search.inclination-step-deg or search.altitude-step-km"
        );
    }
    Ok(())
}

/// Outcome of the sweep for `--certify`.
pub(super) enum Sweep {
    /// Not requested.
    NotWanted,
    /// Its result.
    Done(Box<OptimizeResult>),
    /// Stopped by Ctrl-C.
    Interrupted,
}

/// The sweep for `--certify`, if requested.
pub(super) fn sweep(
    args: &OptimizeArgs,
    study: &Study,
    evaluator: &Evaluator,
    out: &Path,
) -> Result<Sweep> {
    if !args.certify {
        return Ok(Sweep::NotWanted);
    }
    let mut name = out.file_name().unwrap_or_default().to_owned();
    name.push("-sweep");
    let place = out.with_file_name(name);
    let study = study.with_algorithm(Algorithm::Exhaustive);
    let args = OptimizeArgs {
        resume: true,
        ..args.clone()
    };
    let mut directory = open(&args, &study, &place)?;
    let ended = search(&args, &study, evaluator, &mut directory, None)?;
    let placed = ended.placed?;
    if ended.is_interrupted {
        hint_interrupted(&ended.result, placed, &place, true);
        return Ok(Sweep::Interrupted);
    }
    Ok(Sweep::Done(Box::new(ended.result)))
}

/// The run directory of a study.
pub(super) fn open(args: &OptimizeArgs, study: &Study, out: &Path) -> Result<RunDirectory> {
    RunDirectory::open(out.to_owned(), study, args.force)
}

/// How a search ended.
pub(super) struct Ended {
    pub(super) result: OptimizeResult,
    /// What became of the results.
    pub(super) placed: Result<Placed>,
    /// Whether Ctrl-C was pressed before the results were placed, be they complete or not.
    pub(super) is_interrupted: bool,
}

/// Runs, or resumes, one search and writes its results.
pub(super) fn search(
    args: &OptimizeArgs,
    study: &Study,
    evaluator: &Evaluator,
    directory: &mut RunDirectory,
    sweep: Option<&OptimizeResult>,
) -> Result<Ended> {
    let scenario = &study.scenario;
    let problem = study.problem(evaluator)?;
    let mut search = start(args, directory, study, &problem)?;
    if let Search::Exhaustive(sweep) = &search {
        tell_time(sweep, &problem)?;
    }
    let mut table = EvaluationsFile::open(args.evaluations, directory.path(), &problem, &search)?;
    let progress = SearchBar::new(&search);
    let stoppable = Stoppable::begin();
    while !search.is_done() && !stoppable.is_asked_to_stop() {
        match &mut table {
            Some(table) => table.step(&mut search)?,
            None => search.step(&problem)?,
        }
        directory.save(&mut search)?;
        progress.show(&search);
    }
    drop(progress);
    let mut result = OptimizeResult::new(&problem, &search, scenario, study.stamp()?);
    if let Some(sweep) = sweep {
        result.certify(sweep, &scenario.objectives.minimize);
    }
    let placed = directory.finish(scenario, &mut search, &result);
    if let (Some(table), Ok(Placed::Written)) = (table, &placed) {
        table.finish(study)?;
    }
    Ok(Ended {
        result,
        placed,
        is_interrupted: stoppable.end(),
    })
}

/// Says how many designs a sweep has before it, and how long they take by the time of a few of them.
fn tell_time(sweep: &Exhaustive, problem: &DesignProblem<'_>) -> Result<()> {
    let remaining = sweep.remaining();
    if remaining == 0 {
        return Ok(());
    }
    let some = sweep.sample(problem, SAMPLE_FOR_TIME)?;
    let begin = Instant::now();
    problem.evaluate(&some);
    let each_s = begin.elapsed().as_secs_f64() / some.len() as f64;
    let expected = shown_time((each_s * remaining as f64).round() as u64);
    let designs = counted(usize::try_from(remaining).unwrap_or(usize::MAX), "design");
    output::hint(&format!("sweep of {designs}, expected time {expected}"));
    Ok(())
}

/// Designs by whose time that of a sweep is estimated: enough for the threads of a desktop, and a fraction of a
/// second even over a large region.
const SAMPLE_FOR_TIME: u64 = 16;

/// The exit status of a search that used its full budget.
pub(crate) fn status(result: &OptimizeResult) -> Status {
    if result.front.is_empty() {
        Status::Failed
    } else {
        Status::Done
    }
}

/// Says how far an interrupted search got, where its results are, and how to resume: if it is complete,
/// only when the command has `more` to do.
pub(super) fn hint_interrupted(result: &OptimizeResult, placed: Placed, place: &Path, more: bool) {
    let [done, of] = result.search.generations;
    let place = place.display();
    let (results, is_complete) = match placed {
        Placed::Written if done >= of => (format!("complete results: {place}"), true),
        Placed::Written => (format!("results so far: {place}"), false),
        Placed::Nothing => ("no results yet".to_owned(), false),
        Placed::Kept { generations } => (
            format!("{place} keeps the results after generation {generations} that it had"),
            generations >= of,
        ),
    };
    let further = if is_complete && !more {
        ""
    } else {
        "\ncontinue with the same command and --resume"
    };
    output::hint(&format!(
        "\ninterrupted after generation {done} of {of}; {results}{further}"
    ));
}

/// The search resumed from its checkpoint, or a new one.
fn start(
    args: &OptimizeArgs,
    directory: &mut RunDirectory,
    study: &Study,
    problem: &DesignProblem<'_>,
) -> Result<Search> {
    let resumed = if args.resume {
        directory.resume()?
    } else {
        None
    };
    if let Some(mut search) = resumed {
        search.check(problem).with_context(|| {
            format!(
                "{} contains a checkpoint of another search",
                directory.display()
            )
        })?;
        search.set_budget(&study.scenario.method());
        let progress = search.progress();
        if progress.step > progress.steps {
            bail!(
                "the run has {0} generations already, more than the {1} of the scenario; resume with \
                 --set optimizer.generations={0} or more",
                progress.step,
                progress.steps
            );
        }
        output::hint(&format!(
            "resuming after generation {} of {}",
            progress.step, progress.steps
        ));
        return Ok(search);
    }
    if args.resume && !args.certify {
        output::hint("no checkpoint to resume from; starting over");
    }
    Ok(study
        .scenario
        .method()
        .start(problem, study.scenario.optimizer.seed)?)
}

pub(super) fn text(result: &OptimizeResult, scenario: &str) -> String {
    let [done, of] = result.search.generations;
    let head = format!(
        "Pareto set of scenario {scenario}: {}, {} evaluations, {} {done}/{of} generations, seed {}",
        counted(result.front.len(), "design"),
        result.search.evaluations,
        shown::algorithm(&result.search.algorithm),
        result.search.seed,
    );
    text_below(&head, result)
}

/// The same of the evaluations of a search for other goals.
pub(crate) fn text_from_evaluations(result: &OptimizeResult, scenario: &str) -> String {
    let head = format!(
        "Pareto set of scenario {scenario}: {}, of {} evaluations of a search by {}, seed {}",
        counted(result.front.len(), "design"),
        result.search.evaluations,
        shown::algorithm(&result.search.algorithm),
        result.search.seed,
    );
    text_below(&head, result)
}

fn text_below(head: &str, result: &OptimizeResult) -> String {
    let members = result.front.iter();
    let table = front_table("#", members.map(|m| (m.index.to_string(), m)));
    let mut text = format!("{head}\n\n{}", table.to_text());
    if let Some(fixed) = &result.search.fixed {
        text += &fixed_text(fixed);
    }
    if let Some(chart) = chart::front(result) {
        text += &format!("\n{chart}");
    }
    if let Some(volume) = shown::hypervolume(&result.search.hypervolume) {
        text += &format!("\n{volume}\n");
    }
    if let Some(chosen) = result.chosen() {
        text += &format!(
            "* fuzzy pick: {} {}, the best worst-case membership over the objectives ({})\n",
            chosen.index,
            chosen.made_of(),
            shown::membership(chosen.membership)
        );
    }
    text += &other_picks(result);
    if let Some(certificate) = &result.search.certificate {
        text += &certificate.to_text();
    }
    for diagnostic in &result.search.diagnostics {
        text += &format!("note: {} [{}]\n", diagnostic.message, diagnostic.code);
    }
    text
}

/// What every design has beside its own shells.
fn fixed_text(fixed: &FixedSummary) -> String {
    let FixedSummary {
        name,
        in_design,
        from_files,
    } = fixed;
    let name = printable(name);
    let mut parts = Vec::new();
    if *in_design > 0 {
        parts.push(format!("{in_design} in the last shells of each notation"));
    }
    if *from_files > 0 {
        parts.push(format!(
            "{from_files} from files, in no notation and not in the column T, but in `satellites` and every metric"
        ));
    }
    format!(
        "fixed beside each design: {name}, satellites: {}\n",
        parts.join("; ")
    )
}

/// The picks of the other methods, and why.
fn other_picks(result: &OptimizeResult) -> String {
    let points: Vec<Vec<f64>> = result.front.iter().map(FrontMember::minimised).collect();
    let mut text = String::new();
    for pick in Pick::METHODS
        .into_iter()
        .filter(|pick| *pick != Pick::Fuzzy)
    {
        if let Some(picked) = pick.apply(&points) {
            let member = &result.front[picked.place];
            text += &format!(
                "  --pick {}: {} {}, {}\n",
                pick.keyword(),
                member.index,
                member.made_of(),
                picked.reason
            );
        }
    }
    text
}

/// Where satellites are minimised under constraints, a search by chance is not the last word.
fn hint_size(args: &OptimizeArgs, scenario: &Scenario) {
    let objectives = &scenario.objectives;
    if objectives.minimize.contains(&Quantity::Satellites) && !objectives.constraints.is_empty() {
        output::hint(&format!(
            "exactly, on the steps of the search: navwalker size {}",
            args.study.words()
        ));
    }
}

fn hint_what_next(result: &OptimizeResult, out: &str) {
    output::hint(&format!("\nrun written to {out}"));
    let out = quoted(out);
    if result.front.is_empty() {
        return;
    }
    output::hint(&format!(
        "next: navwalker report {out}\n      navwalker export --run {out} --pick fuzzy --as tle,oem --out exports\n      \
         navwalker validate --run {out} --against sgp4"
    ));
}

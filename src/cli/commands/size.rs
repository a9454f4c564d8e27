//! `navwalker size`.

mod directory;
mod robust;
mod text;
mod verify;

use crate::cli::args::{OutputFormat, SizeArgs, quoted};
use crate::cli::interrupt::Stoppable;
use crate::cli::progress::SizeBar;
use crate::cli::study::Study;
use crate::cli::{Status, coincidence, limits, output};
use crate::evaluate::Evaluator;
use crate::run::size::{SizeResult, size_csv};
use crate::scenario::Scenario;
use crate::search::size::{SizeProblem, SizeSearch};
use crate::search::{DesignProblem, Quantity};
use anyhow::{Result, bail};
use directory::SizeDirectory;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two checkpoints.
const CHECKPOINT_EVERY: Duration = Duration::from_secs(5);

pub(crate) fn run(args: &SizeArgs) -> Result<Status> {
    if let Some(directory) = &args.verify {
        return verify::run(args, directory);
    }
    let study = Study::load(&args.study, &[])?;
    let objective = further_objective(args, &study.scenario)?;
    let default_out = || PathBuf::from(format!("runs/{}-size", study.scenario.name));
    let out = args.out.clone().unwrap_or_else(default_out);
    let study = resumed(args, study, &out)?;
    check_constraints(&study.scenario)?;
    let setup = study.setup()?;
    coincidence::warn(&setup.gnss, setup.grid, None);
    super::optimize::warn_of_space(&study, &setup)?;
    let evaluator = Evaluator::new(setup)?;
    let problem = study.problem(&evaluator)?;
    check_shells(&problem)?;
    let problem = SizeProblem::new(&problem);
    check_size(&problem)?;
    warn_of_rules(&problem);
    let mut directory = SizeDirectory::open(out.clone(), &study, args.force, args.resume)?;
    let search =
        directory.resume(|search| search.suits(&problem, args.slack.unwrap_or(0), objective))?;
    if args.resume && search.is_none() {
        output::hint("no checkpoint to resume from; starting over");
    }
    let start = || SizeSearch::start(&problem, args.slack.unwrap_or(0), objective);
    let mut search = search.unwrap_or_else(start);
    let is_interrupted = searched(&problem, &mut search, &mut directory)?;
    if is_interrupted {
        output::hint(&format!(
            "\ninterrupted after {} designs; {} has what is done; continue with the same command and --resume",
            search.tried(),
            out.display()
        ));
        return Ok(Status::Interrupted);
    }
    let mut result = SizeResult::new(&problem, &search, directory.certificate()?, study.stamp()?);
    let designs = result.worth_a_look();
    result.robustness = robust::rows(&study, problem.problem().evaluator().setup(), &designs)?;
    directory.finish(&result)?;
    output::result(&match args.format {
        OutputFormat::Text => text::of(&result),
        OutputFormat::Json => crate::printable::json(&result)?,
        OutputFormat::Csv => size_csv(&result)?,
    })?;
    hint_what_next(&result, &study.scenario, &out);
    Ok(match result.fewest {
        Some(_) => Status::Done,
        None => Status::Failed,
    })
}

/// With --resume and no scenario named, the study of the run in the directory.
fn resumed(args: &SizeArgs, mut study: Study, directory: &Path) -> Result<Study> {
    if !args.resume || !directory.join(crate::run::MANIFEST).exists() {
        return Ok(study);
    }
    study.take_files_of(directory)?;
    if args.study.scenario.is_some() || !args.study.overrides.is_empty() {
        return Ok(study);
    }
    Study::of_run(directory, &[])
}

/// Walks until the answer is complete; returns whether Ctrl-C was pressed before.
fn searched(
    problem: &SizeProblem<'_>,
    search: &mut SizeSearch,
    directory: &mut SizeDirectory,
) -> Result<bool> {
    let progress = SizeBar::new();
    let stoppable = Stoppable::begin();
    let mut saved = Instant::now();
    while !search.is_done() && !stoppable.is_asked_to_stop() {
        let witnesses = search.step(problem)?;
        directory.append(&witnesses)?;
        if saved.elapsed() > CHECKPOINT_EVERY {
            directory.save(search)?;
            saved = Instant::now();
        }
        progress.show(problem, search);
    }
    progress.finish();
    directory.save(search)?;
    let is_asked = stoppable.end();
    Ok(is_asked && !search.is_done())
}

/// With --slack, the first objective that is not the number of satellites.
fn further_objective(args: &SizeArgs, scenario: &Scenario) -> Result<Option<Quantity>> {
    if args.slack.is_none() {
        return Ok(None);
    }
    let mut all = scenario.objectives.minimize.iter();
    let found = all.find(|one| **one != Quantity::Satellites);
    match found {
        Some(one) => Ok(Some(*one)),
        None => bail!(
            "--slack: objectives.minimize has nothing beside satellites, expected one further objective, as in \
             --set objectives.minimize=[\"satellites\",\"mean-pdop\"]"
        ),
    }
}

fn check_constraints(scenario: &Scenario) -> Result<()> {
    if scenario.objectives.constraints.is_empty() {
        bail!(
            "objectives.constraints is empty, so that the fewest satellites of the search space would do; expected at \
             least one constraint, as in --set 'objectives.constraints=[\"availability >= 0.999\"]'"
        );
    }
    Ok(())
}

/// Refuses a space in which satellites from files alone could be the answer: they have no notation.
fn check_shells(problem: &DesignProblem<'_>) -> Result<()> {
    if problem.designs().fixed.is_none() && problem.designs().may_be_empty() {
        bail!(
            "every shell of the search may be empty, and what is fixed has no shells: let `satellites-per-plane` of one \
             shell begin above 0"
        );
    }
    Ok(())
}

/// Says how much there is to do, and refuses what is very large.
fn check_size(problem: &SizeProblem<'_>) -> Result<()> {
    let designs = problem.design_count();
    let setup = problem.problem().evaluator().setup();
    let samples = designs * setup.sample_count() as f64;
    limits::check_designs(designs, samples)
}

fn warn_of_rules(problem: &SizeProblem<'_>) {
    let without = problem.without_rule();
    if without.is_empty() {
        return;
    }
    let all: Vec<String> = without.iter().map(ToString::to_string).collect();
    let others = problem.constraints().len() > without.len();
    output::hint(&format!(
        "no rule rejects early by {}: {} is evaluated in full",
        all.join(" and "),
        if others {
            "every design that keeps the other constraints"
        } else {
            "every design"
        }
    ));
}

fn hint_what_next(result: &SizeResult, scenario: &Scenario, out: &Path) {
    output::hint(&format!(
        "\nresult and certificate written to {}",
        out.display()
    ));
    let out = quoted(&out.display().to_string());
    let mut next = format!("next: navwalker size --verify {out}");
    if let Some(best) = result.designs.first() {
        let name = quoted(&scenario.name);
        next += &format!(
            "\n      navwalker evaluate {name} --design {}",
            best.design.notation
        );
    }
    output::hint(&next);
}

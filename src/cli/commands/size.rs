//! `navwalker size`.

mod directory;
mod parts;
mod robust;
mod shard;
mod verify;

use crate::cli::args::{OutputFormat, SizeArgs, quoted};
use crate::cli::interrupt::Stoppable;
use crate::cli::progress::SizeBar;
use crate::cli::study::Study;
use crate::cli::{Status, coincidence, limits, output};
use crate::evaluate::Evaluator;
use crate::report::size_text;
use crate::run::size::{Refinement, SizeResult, refinements, size_csv};
use crate::scenario::Scenario;
use crate::search::size::{ClosestDesign, SizeProblem, SizeSearch};
use crate::search::{DesignProblem, Quantity};
use crate::units::counted;
use anyhow::{Result, bail};
use directory::SizeDirectory;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time between two checkpoints.
const CHECKPOINT_EVERY: Duration = Duration::from_secs(5);

/// Numbers of satellites below the fewest in which the closest designs are found.
const LEVELS_BELOW: usize = 2;

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
    let slack = args.slack.unwrap_or(0);
    if let Some(shard) = args.shard {
        let further = shard::Further { slack, objective };
        return shard::run(&problem, &study, &out, shard, &further);
    }
    let mut directory = SizeDirectory::open(out.clone(), &study, args.force, args.resume)?;
    let search = directory.resume(|search| search.suits(&problem, slack, objective))?;
    if args.resume && search.is_none() {
        output::hint(&match directory.parts().paths().len() {
            0 => "no checkpoint to resume from; starting over".to_owned(),
            parts => format!("{} of shards to take up", counted(parts, "part")),
        });
    }
    let start = || SizeSearch::start(&problem, slack, objective);
    let mut search = search.unwrap_or_else(start);
    let mut closest = None;
    if !searched(&problem, &mut search, &mut directory)? {
        closest = closest_below(&problem, &search)?;
    }
    let Some(closest) = closest else {
        output::hint(&format!(
            "\ninterrupted after {} designs; {} has what is done; continue with the same command and --resume",
            search.tried(),
            out.display()
        ));
        return Ok(Status::Interrupted);
    };
    let (certificate, stamp) = (directory.certificate()?, study.stamp()?);
    let mut result = SizeResult::new(&problem, &search, &closest, certificate, stamp);
    result.refinement = refined(&problem, &result, &closest)?;
    let mut designs = result.best();
    let next = closest.iter().map(|one| one.satellites).max();
    let next = closest.iter().filter(|one| Some(one.satellites) == next);
    designs.extend(next.map(|one| one.design.clone()));
    result.robustness = robust::rows(&study, problem.problem().evaluator().setup(), &designs)?;
    directory.finish(&result)?;
    output::result(&match args.format {
        OutputFormat::Text => size_text(&result),
        OutputFormat::Json => crate::printable::json(&result)?,
        OutputFormat::Csv => size_csv(&result)?,
    })?;
    hint_what_next(&result, &out);
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
        if !taken_up(problem, search, directory)? {
            let witnesses = search.step(problem)?;
            directory.append(&witnesses)?;
        }
        if saved.elapsed() > CHECKPOINT_EVERY {
            directory.save(search)?;
            saved = Instant::now();
        }
        progress.show(problem, search);
    }
    drop(progress);
    directory.save(search)?;
    let is_asked = stoppable.end();
    Ok(is_asked && !search.is_done())
}

/// Takes up the part that a shard has left for the next step; returns whether there is one.
fn taken_up(
    problem: &SizeProblem<'_>,
    search: &mut SizeSearch,
    directory: &mut SizeDirectory,
) -> Result<bool> {
    let Some(number) = search.next_part(problem) else {
        return Ok(false);
    };
    let parts = directory.parts();
    let Some((part, rows)) = parts.get(number) else {
        return Ok(false);
    };
    if !search.absorb(problem, part)? {
        parts.warn(number, "it is of another --slack or further objective");
        return Ok(false);
    }
    // What the part has beyond the end of the search is left out.
    let last = search.levels().last().map_or(0, |level| level.satellites);
    let satellites = |line: &str| line.split(',').next().and_then(|text| text.parse().ok());
    let is_within = |line: &&str| satellites(line).is_some_and(|n: usize| n <= last);
    let rows = rows.split_inclusive('\n').filter(is_within);
    directory.append_rows(&rows.collect::<String>())?;
    Ok(true)
}

/// The closest rejected designs: of each number of satellites if nothing keeps the constraints, otherwise of the next
/// below the fewest; `None` if Ctrl-C was pressed.
fn closest_below(
    problem: &SizeProblem<'_>,
    search: &SizeSearch,
) -> Result<Option<Vec<ClosestDesign>>> {
    let levels = search.levels();
    let fewest = search.fewest();
    let below = levels.partition_point(|level| fewest.is_none_or(|n| level.satellites < n));
    let first = match fewest {
        Some(_) => below.saturating_sub(LEVELS_BELOW),
        None => 0,
    };
    if fewest.is_none() {
        output::hint(
            "no design keeps the constraints; looking for the best with each number of satellites",
        );
    }
    let stoppable = Stoppable::begin();
    let mut found = Vec::new();
    for level in &levels[first..below] {
        match problem.closest(search, level, &|| stoppable.is_asked_to_stop())? {
            Some(closest) => found.extend(closest),
            None => {
                stoppable.end();
                return Ok(None);
            }
        }
    }
    Ok((!stoppable.end()).then_some(found))
}

/// What lies between the steps around the best designs and around the closest with fewer satellites.
fn refined(
    problem: &SizeProblem<'_>,
    result: &SizeResult,
    closest: &[ClosestDesign],
) -> Result<Vec<Refinement>> {
    let levels: Vec<&[ClosestDesign]> = closest
        .chunk_by(|a, b| a.satellites == b.satellites)
        .collect();
    let last = &levels[levels.len().saturating_sub(LEVELS_BELOW)..];
    let mut refined = Vec::new();
    for level in last {
        refined.extend(problem.refined_closest(level));
    }
    if let Some(fewest) = result.fewest {
        refined.extend(problem.refined_designs(fewest, &result.best())?);
    }
    Ok(refinements(problem, &refined))
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

fn hint_what_next(result: &SizeResult, out: &Path) {
    output::hint(&format!(
        "\nresult and certificate written to {}",
        out.display()
    ));
    let out = quoted(&out.display().to_string());
    let mut next = format!("next: navwalker size --verify {out}");
    if let Some(best) = result.designs.first() {
        next += &format!(
            "\n      navwalker evaluate {out}/{} --design {}",
            crate::run::SCENARIO,
            best.design.notation
        );
    }
    output::hint(&next);
}

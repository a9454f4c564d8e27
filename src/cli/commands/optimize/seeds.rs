//! `navwalker optimize --seeds N`: the same search with several seeds.

use super::{
    Ended, Sweep, check_sweep, hint_interrupted, load, open, resumed, search, status, sweep, text,
    warn_of_space,
};
use crate::cli::args::{OptimizeArgs, OutputFormat};
use crate::cli::provenance::provenance;
use crate::cli::{Status, coincidence, files, output};
use crate::evaluate::Evaluator;
use crate::report::SeedsResult;
use crate::run::PROVENANCE;
use crate::units::counted;
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};

/// Tables of all seeds.
const TABLE: [&str; 3] = ["seeds.csv", "seeds.json", "joint-front.csv"];

/// Prefix of the run directories of the seeds.
const RUN: &str = "seed-";

pub(super) fn run(args: &OptimizeArgs, count: u64) -> Result<Status> {
    let mut study = load(args)?;
    let first = study.scenario.optimizer.seed;
    let last = first.checked_add(count - 1);
    let last =
        last.with_context(|| format!("{count} seeds starting at {first} exceed {}", u64::MAX))?;
    let name = &study.scenario.name;
    let default_out = || PathBuf::from(format!("runs/{name}-{first}-to-{last}"));
    let out = args.out.clone().unwrap_or_else(default_out);
    if let Some(run) = first_run(&out) {
        study = resumed(args, study, &run)?;
    }
    check_sweep(args, &study.scenario)?;
    let setup = study.setup()?;
    coincidence::warn(&setup.gnss, setup.grid, None);
    warn_of_space(&study, &setup)?;
    if !args.force {
        require_seeds(&out)?;
    }
    let inputs = study.inputs();
    for name in TABLE {
        files::refuse_inputs(&out.join(name), inputs.iter().map(PathBuf::as_path))?;
    }
    let evaluator = Evaluator::new(setup)?;
    let sweep = match sweep(args, &study, &evaluator, &out)? {
        Sweep::NotWanted => None,
        Sweep::Done(result) => Some(result),
        Sweep::Interrupted => return Ok(Status::Interrupted),
    };
    let mut results = Vec::new();
    let own = |number: usize| args.shard.is_none_or(|shard| shard.holds(number));
    let seeds = (0..).zip(first..=last).filter(|(number, _)| own(*number));
    for (_, seed) in seeds {
        study.scenario.optimizer.seed = seed;
        let place = out.join(format!("{RUN}{seed}"));
        let mut directory = open(args, &study, &place)?;
        let Ended {
            result,
            placed,
            is_interrupted,
        } = search(args, &study, &evaluator, &mut directory, sweep.as_deref())?;
        let placed = placed?;
        if is_interrupted {
            // At least the tables are still to be written.
            hint_interrupted(&result, placed, &place, true);
            return Ok(Status::Interrupted);
        }
        results.push(result);
    }
    if let Some(shard) = args.shard {
        output::hint(&format!(
            "\n{} of shard {shard} done\nwhen all are: the same command with --resume in place of --shard",
            counted(results.len(), "seed")
        ));
        return Ok(Status::Done);
    }
    let objectives = &study.scenario.objectives.minimize;
    let result =
        SeedsResult::new(results, sweep.as_deref(), objectives).context("no seed was run")?;
    let json = crate::printable::json(&result)? + "\n";
    let contents = [result.to_csv()?, json.clone(), result.joint_csv()?];
    for (name, text) in TABLE.iter().zip(&contents) {
        files::write_atomically(&out.join(name), text.as_bytes())?;
    }
    files::write_provenance(&out, &provenance(vec![study.stamp()?]))?;
    output::result(&match args.format {
        OutputFormat::Text => format!(
            "{}\n{}",
            text(&result.first, &study.scenario.name),
            result.to_text()
        ),
        OutputFormat::Json => json,
        OutputFormat::Csv => result.to_csv()?,
    })?;
    output::hint(&format!(
        "\nruns written to {}/{RUN}{first} to {RUN}{last}",
        out.display()
    ));
    Ok(status(&result.first))
}

/// The run of the first seed in a directory, if there is one.
fn first_run(directory: &Path) -> Option<PathBuf> {
    let entries = fs::read_dir(directory).ok()?.filter_map(|entry| {
        let name = entry.ok()?.file_name().to_string_lossy().into_owned();
        name.strip_prefix(RUN)?.parse::<u64>().ok()
    });
    let first = entries.min()?;
    Some(directory.join(format!("{RUN}{first}")))
}

/// Rejects a directory with anything but runs of seeds and their tables.
fn require_seeds(directory: &Path) -> Result<()> {
    if files::is_vacant(directory)? {
        return Ok(());
    }
    let entries =
        fs::read_dir(directory).with_context(|| format!("cannot use {}", directory.display()))?;
    for entry in entries {
        let name = entry?.file_name();
        if files::is_staged(&name) {
            continue;
        }
        let name = name.to_string_lossy().into_owned();
        if !name.starts_with(RUN) && !TABLE.contains(&name.as_str()) && name != PROVENANCE {
            bail!(
                "{} holds {name}, which is not the run of a seed; choose another --out, or replace what \
                 is in the way with --force",
                directory.display()
            );
        }
    }
    Ok(())
}

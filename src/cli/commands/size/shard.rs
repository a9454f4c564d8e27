//! `navwalker size --shard`: some parts of the walk, for a search over one directory.

use super::directory::SizeDirectory;
use super::parts::PartFiles;
use crate::cli::Status;
use crate::cli::args::{Shard, quoted};
use crate::cli::interrupt::Stoppable;
use crate::cli::output;
use crate::cli::progress::SizeBar;
use crate::cli::study::Study;
use crate::run::size::certificate_rows;
use crate::search::Quantity;
use crate::search::size::{SizeProblem, SizeSearch};
use crate::units::counted;
use anyhow::Result;
use std::path::Path;

/// What a search is asked for beside the fewest satellites.
pub(super) struct Further {
    pub(super) slack: usize,
    pub(super) objective: Option<Quantity>,
}

/// Tries the parts of a shard, by rising number of satellites, until one of any shard shows that the search ends before.
pub(super) fn run(
    problem: &SizeProblem<'_>,
    study: &Study,
    out: &Path,
    shard: Shard,
    further: &Further,
) -> Result<Status> {
    let Some((files, _lock)) = SizeDirectory::join(out, study)? else {
        output::hint(&format!("{} has the result already", out.display()));
        return Ok(Status::Done);
    };
    let all = problem.parts()?;
    let bar = SizeBar::new();
    let stoppable = Stoppable::begin();
    let is_stopped = || stoppable.is_asked_to_stop();
    let mut done = 0;
    let mut tried = Ok(true);
    for part in (0..all).filter(|part| shard.holds(*part as usize)) {
        if is_beyond(problem, &files, part, further.slack)? || is_stopped() {
            break;
        }
        tried = match files.has(part) {
            true => Ok(true),
            false => one(problem, &files, part, further, (&bar, &is_stopped)),
        };
        if !matches!(tried, Ok(true)) {
            break;
        }
        done += 1;
    }
    drop(bar);
    let is_interrupted = stoppable.end();
    if !tried? || is_interrupted {
        output::hint("\ninterrupted; continue with the same command");
        return Ok(Status::Interrupted);
    }
    output::hint(&format!(
        "\n{} of {all} done, those of shard {shard}\nwhen all shards are: the same command with --resume in place of \
         --shard, over {}",
        counted(done, "part"),
        quoted(&out.display().to_string())
    ));
    Ok(Status::Done)
}

/// Whether the search ends before a part, by what was found in any.
fn is_beyond(
    problem: &SizeProblem<'_>,
    files: &PartFiles,
    part: u64,
    slack: usize,
) -> Result<bool> {
    let first = problem.satellites_of_part(part)?;
    let last = files.fewest().map(|n| problem.last_reached(n, slack));
    Ok(first.zip(last).is_some_and(|(first, last)| first > last))
}

/// Tries one part and writes its file; returns whether it was not stopped.
fn one(
    problem: &SizeProblem<'_>,
    files: &PartFiles,
    part: u64,
    further: &Further,
    (bar, is_stopped): (&SizeBar, &dyn Fn() -> bool),
) -> Result<bool> {
    let search = SizeSearch::of_part(problem, further.slack, further.objective, part)?;
    let Some(mut search) = search else {
        return Ok(true);
    };
    let mut rows = String::new();
    while !search.is_done() {
        if is_stopped() {
            return Ok(false);
        }
        rows += &certificate_rows(&search.step(problem)?)?;
        bar.show(problem, &search);
    }
    files.put(part, &search, &rows)?;
    Ok(true)
}

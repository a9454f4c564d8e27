//! `navwalker sweep`.

mod text;

use crate::cli::args::{SweepArgs, quoted};
use crate::cli::commands::evaluate::designs::DesignList;
use crate::cli::interrupt::Stoppable;
use crate::cli::progress::DesignBar;
use crate::cli::study::{Study, say_of_setup};
use crate::cli::sweep_store::{ChunkState, SweepStore, warn_of_damage};
use crate::cli::{Status, coincidence, limits, output};
use crate::evaluate::Evaluator;
use crate::run::sweep::{
    SampleShape, SweepDesigns, SweepEvaluator, SweepPlan, SweepSource, SweptDesign, TableFormat,
    sweep_time_s, write_chunk,
};
use anyhow::{Result, bail};
use rayon::prelude::*;
use text::SweepStatus;

pub(crate) fn run(args: &SweepArgs) -> Result<Status> {
    if args.merge {
        return merge(args, &SweepStore::read(&args.out)?);
    }
    if args.status {
        let store = SweepStore::read(&args.out)?;
        let states = store.states();
        let status = SweepStatus::of(&store, &states);
        output::result(&status.shown(args.format)?)?;
        return Ok(Status::Done);
    }
    sweep(args)
}

/// Evaluates what is not done yet, and merges it unless it is a part.
fn sweep(args: &SweepArgs) -> Result<Status> {
    let (study, list) = study_and_list(args)?;
    let setup = study.setup()?;
    coincidence::warn(&setup.gnss, setup.grid, None);
    if list.is_none() {
        super::optimize::warn_of_space(&study, &setup)?;
    } else {
        say_of_setup(&setup);
    }
    let evaluator = Evaluator::new(setup)?;
    let problem = study.problem(&evaluator)?;
    let designs = match list {
        Some(list) => SweepDesigns::List(list),
        None => SweepDesigns::of_space(&problem),
    };
    let samples = SampleShape::from(evaluator.setup());
    let points = designs.points()? as f64;
    let time_s = sweep_time_s(points, samples, designs.mean_satellites()?);
    limits::check_sweep(points, time_s)?;
    let begun = SweepStore::read(&args.out).ok();
    let held = begun.as_ref().map(|store| store.plan());
    let joins = args.resume || args.shard.is_some();
    let format = args
        .table_format
        .or(held.filter(|_| joins).map(|plan| plan.format));
    let chunk = args.chunk.or(held.filter(|_| joins).map(|plan| plan.chunk));
    let format = format.unwrap_or(TableFormat::Parquet);
    let plan = SweepPlan::new(study.stamp()?, &designs, format, (chunk, samples))?;
    drop(begun);
    let store = SweepStore::open(&args.out, &study, plan, &designs, (joins, args.force))?;
    let open = open_chunks(args, &store);
    let evaluate = SweepEvaluator::new(&problem);
    if !evaluated(&store, &evaluate, &designs, &open)? {
        output::hint(&format!(
            "\ninterrupted; {} has what is done; continue with the same command and --resume",
            args.out.display()
        ));
        return Ok(Status::Interrupted);
    }
    if let Some(shard) = args.shard {
        let states = store.states();
        let status = SweepStatus::of(&store, &states);
        output::result(&status.shown(args.format)?)?;
        let out = quoted(&args.out.display().to_string());
        output::hint(&format!(
            "shard {shard} is done\nwhen all are: navwalker sweep --merge --out {out}"
        ));
        return Ok(Status::Done);
    }
    merge(args, &store)
}

/// The study and its list: those of the directory if it is resumed or joined and no others are given.
fn study_and_list(args: &SweepArgs) -> Result<(Study, Option<Vec<SweptDesign>>)> {
    let names_none =
        args.study.scenario.is_none() && args.study.overrides.is_empty() && args.designs.is_none();
    if args.resume && names_none {
        let store = SweepStore::read(&args.out)?;
        let list = store.list()?;
        let study = Study::of_run(&args.out, &[])?.for_sweep()?;
        let is_list = store.plan().source == SweepSource::List;
        return Ok((study, is_list.then_some(list)));
    }
    let study = Study::load(&args.study, &[])?.for_sweep()?;
    let list = args.designs.as_deref().map(DesignList::open).transpose()?;
    let list = list.map(|list| list.swept(&study)).transpose()?;
    Ok((study, list))
}

/// The chunks of this process that are not done, by number from 0.
fn open_chunks(args: &SweepArgs, store: &SweepStore) -> Vec<usize> {
    let own = |number: &usize| args.shard.is_none_or(|shard| shard.holds(*number));
    let numbers: Vec<usize> = (0..store.chunks().len()).filter(own).collect();
    let state = |number: &usize| (*number, store.state(*number));
    let states: Vec<_> = numbers.par_iter().map(state).collect();
    let mut open = Vec::new();
    for (number, state) in states {
        if let ChunkState::Damaged(reason) = &state {
            warn_of_damage(store, number, reason);
        }
        if state != ChunkState::Done {
            open.push(number);
        }
    }
    if open.len() < numbers.len() {
        output::hint(&format!(
            "{} of {} chunks are done already",
            numbers.len() - open.len(),
            numbers.len()
        ));
    }
    open
}

/// Evaluates chunks, as many at a time as there are threads; returns whether all are done, not interrupted.
fn evaluated(
    store: &SweepStore,
    evaluate: &SweepEvaluator<'_>,
    designs: &SweepDesigns<'_>,
    open: &[usize],
) -> Result<bool> {
    let of_all = open.iter().map(|number| store.chunks()[*number].designs);
    let bar = DesignBar::new(of_all.sum());
    let stoppable = Stoppable::begin();
    let is_stopped = || stoppable.is_asked_to_stop();
    let one = |number: &usize| -> Result<()> {
        let chunk = store.chunk(*number, designs)?;
        if let Some(table) = evaluate.evaluate(&chunk, &is_stopped) {
            let bytes = write_chunk(store.plan().format, &chunk.name, table)?;
            store.put(*number, &bytes)?;
            bar.add(chunk.designs.len() as u64);
        }
        Ok(())
    };
    let mut done = Ok(());
    for some in open.chunks(rayon::current_num_threads()) {
        done = some.par_iter().try_for_each(one);
        if done.is_err() || is_stopped() {
            break;
        }
    }
    drop(bar);
    let is_interrupted = stoppable.end();
    done.map(|()| !is_interrupted)
}

/// Merges the results, or says what is missing.
fn merge(args: &SweepArgs, store: &SweepStore) -> Result<Status> {
    match store.merge()? {
        Ok(index) => {
            output::result(&text::merged(store, &index, args.format)?)?;
            hint_what_next(args, store);
            Ok(Status::Done)
        }
        Err(open) => {
            let (number, state) = &open[0];
            if let (1, ChunkState::Damaged(reason)) = (open.len(), state) {
                bail!(
                    "chunk {}: {reason}; sweep --resume computes it again",
                    number + 1
                );
            }
            let states = store.states();
            let status = SweepStatus::of(store, &states);
            output::result(&status.shown(args.format)?)?;
            let out = quoted(&args.out.display().to_string());
            output::hint(&format!(
                "not merged; what is missing: navwalker sweep --resume --out {out}"
            ));
            Ok(Status::Failed)
        }
    }
}

fn hint_what_next(args: &SweepArgs, store: &SweepStore) {
    let out = quoted(&args.out.display().to_string());
    output::hint(&format!(
        "\nsweep written to {out}\nnext: navwalker optimize --from {out}\n      python: pandas.read_{}(\"{out}/{}\")",
        store.plan().format,
        store.plan().table()
    ));
}

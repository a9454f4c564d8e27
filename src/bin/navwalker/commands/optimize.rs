//! `navwalker optimize`: the main job.

use crate::args::{Format, OptimizeArgs};
use crate::progress::Progress;
use crate::run::{Identity, RunDirectory};
use crate::study::Study;
use crate::{Status, chart, output};
use anyhow::{Context, Result};
use navwalker::optimize::{Search, Strategy};
use navwalker::report::{Align, FrontMember, OptimizeResult, Table, front_csv};
use navwalker::search::DesignProblem;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

pub(crate) fn run(args: &OptimizeArgs) -> Result<Status> {
    let seed = args.seed.map(|seed| format!("optimizer.seed={seed}"));
    let study = Study::load(&args.study, seed.as_slice())?;
    let scenario = &study.scenario;
    let default_out = || {
        PathBuf::from(format!(
            "runs/{}-{}",
            scenario.name, scenario.optimizer.seed
        ))
    };
    let out = args.out.clone().unwrap_or_else(default_out);
    let setup = study.setup()?;
    let directory = RunDirectory::open(
        out.clone(),
        Identity::of(scenario, study.hash()?),
        args.force,
    )?;
    let evaluator = navwalker::evaluate::Evaluator::new(setup)?;
    let problem = DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals())?;
    let mut search = start(args, &directory, &study, &problem)?;

    let interrupted = interrupt_flag()?;
    let progress = Progress::new(&search);
    while !search.is_done() && !interrupted.load(Ordering::Relaxed) {
        search.step(&problem)?;
        directory.save(&search)?;
        progress.show(&search);
    }
    progress.finish();

    let result = OptimizeResult::new(&problem, &search, scenario);
    directory.finish(scenario, &search, &result)?;
    output::result(&match args.format {
        Format::Text => text(&result, &scenario.name),
        Format::Json => serde_json::to_string_pretty(&result)?,
        Format::Csv => front_csv(&result)?,
    })?;
    let shown = out.display().to_string();
    if args.report {
        let page = super::report::of_run(&out)?;
        output::hint(&format!("\nreport written to {}", page.display()));
    }
    if search.is_done() {
        hint_what_next(&result, &shown);
        Ok(if result.front.is_empty() {
            Status::Failed
        } else {
            Status::Done
        })
    } else {
        let [done, of] = result.generations;
        output::hint(&format!(
            "\ninterrupted after generation {done} of {of}; the results so far are in {shown}\n\
             go on with the same command and --resume"
        ));
        Ok(Status::Interrupted)
    }
}

/// The search where its checkpoint left it, or a new one.
fn start(
    args: &OptimizeArgs,
    directory: &RunDirectory,
    study: &Study,
    problem: &DesignProblem<'_>,
) -> Result<Search> {
    let resumed = if args.resume {
        directory.resume()?
    } else {
        None
    };
    if let Some(search) = resumed {
        let progress = search.progress();
        output::hint(&format!(
            "resuming after generation {} of {}",
            progress.step, progress.steps
        ));
        return Ok(search);
    }
    if args.resume {
        output::hint("no checkpoint to resume from; starting anew");
    }
    Ok(study
        .scenario
        .method()
        .start(problem, study.scenario.optimizer.seed)?)
}

/// A flag that Ctrl-C sets; a second Ctrl-C ends the program at once.
fn interrupt_flag() -> Result<Arc<AtomicBool>> {
    let flag = Arc::new(AtomicBool::new(false));
    let seen = Arc::clone(&flag);
    ctrlc::set_handler(move || {
        if seen.swap(true, Ordering::Relaxed) {
            std::process::exit(Status::Interrupted as i32);
        }
        output::hint("stopping after this generation; Ctrl-C again stops at once");
    })
    .context("cannot handle Ctrl-C")?;
    Ok(flag)
}

fn text(result: &OptimizeResult, scenario: &str) -> String {
    let right = Align::Right;
    let mut table = Table::new(&[
        ("", Align::Left),
        ("#", right),
        ("design", Align::Left),
        ("T", right),
        ("i (deg)", right),
        ("h (km)", right),
        ("N visible", right),
        ("E[PDOP]", right),
        ("CVaR", right),
        ("max PDOP", right),
        ("J_pos", right),
        ("J_cost", right),
        ("membership", right),
    ]);
    for member in &result.front {
        table.row(row(member));
    }
    let [done, of] = result.generations;
    let mut text = format!(
        "Pareto set of scenario {scenario}: {} designs, {} evaluations, {} {done}/{of} generations, seed {}\n\n{}",
        result.front.len(),
        result.evaluations,
        result.algorithm,
        result.seed,
        table.to_text()
    );
    if let Some(chart) = chart::front(result) {
        text += &format!("\n{chart}");
    }
    if let (Some(value), Some(reference)) =
        (result.hypervolume.value, &result.hypervolume.reference)
    {
        let at: Vec<String> = reference.iter().map(ToString::to_string).collect();
        text += &format!("\nhypervolume {value:.4} at ({})\n", at.join(", "));
    }
    if let Some(chosen) = result.chosen() {
        text += &format!(
            "* chosen by fuzzy decision: {}, the largest least membership ({:.3}) over the objectives\n",
            chosen.design.notation, chosen.membership
        );
    }
    for diagnostic in &result.diagnostics {
        text += &format!("note: {} [{}]\n", diagnostic.message, diagnostic.code);
    }
    text
}

fn row(member: &FrontMember) -> Vec<String> {
    let metrics = &member.metrics;
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |v| format!("{v:.4}"));
    vec![
        if member.chosen { "*" } else { "" }.to_owned(),
        member.index.to_string(),
        member.design.notation.clone(),
        member.design.satellites.to_string(),
        format!("{:.2}", member.design.inclination_deg),
        format!("{:.1}", member.design.altitude_km),
        format!("{:.3}", metrics.mean_visible),
        number(metrics.mean_pdop),
        number(metrics.cvar_pdop),
        number(metrics.max_pdop),
        number(metrics.j_pos),
        number(metrics.j_cost),
        format!("{:.3}", member.membership),
    ]
}

fn hint_what_next(result: &OptimizeResult, out: &str) {
    output::hint(&format!("\nrun written to {out}"));
    if result.front.is_empty() {
        return;
    }
    output::hint(&format!(
        "next: navwalker report {out}\n      navwalker export --run {out} --pick fuzzy --as tle,oem --out exports\n      \
         navwalker validate --run {out} --against sgp4"
    ));
}

//! `navwalker evaluate`.

mod designs;
mod given_run;
mod print;
mod series;
mod single;
mod table;

use crate::cli::args::EvaluateArgs;
use crate::cli::study::Study;
use crate::cli::{Status, constellations, output};
use crate::ephemeris::Ephemeris;
use crate::evaluate::{DopStatistics, Evaluator, Metrics};
use crate::exchange::constellation::Constellation;
use crate::report::{Assessment, ConstellationEntry};
use crate::run::ScenarioStamp;
use crate::scenario::Scenario;
use crate::search::Goals;
use anyhow::{Result, bail};
use designs::DesignList;
use given_run::GivenRun;
use print::Printer;
use series::SeriesDirectory;

pub(crate) fn run(args: &EvaluateArgs) -> Result<Status> {
    let study = Study::load(&args.study, &[])?;
    let given = given(args, &study)?;
    let list = args.designs.as_deref().map(DesignList::open).transpose()?;
    if args.out.is_some() {
        given_run::require_designs(&given)?;
    }
    let series = SeriesDirectory::new(args, &study, &given)?;
    let evaluator = study.evaluator()?;
    let work = EvaluationContext {
        args,
        scenario: &study.scenario,
        stamp: study.stamp()?,
        goals: study.scenario.goals(),
        gnss_only: gnss_only(args, &study.scenario.goals(), &evaluator)?,
        evaluator: &evaluator,
    };
    let mut entries = Vec::new();
    for (n, one) in given.iter().enumerate() {
        let ephemeris = constellations::propagate(one, evaluator.setup())?;
        entries.push(work.entry(one, &ephemeris)?);
        if let Some(series) = &series {
            series.write(n, &evaluator, &ephemeris)?;
        }
    }
    let run = args
        .out
        .as_deref()
        .map(|out| GivenRun::new(out, &work, &study, &entries));
    let run = run.transpose()?;
    let mut printer = Printer::new(&work, &given, list.as_ref());
    for entry in entries {
        printer.entry(entry)?;
    }
    let status = match list {
        Some(list) => designs::evaluate(list, &work, &mut printer)?,
        None => Status::Done,
    };
    printer.end()?;
    if let Some(series) = series {
        let told = series.told();
        series.commit()?;
        output::hint(&told);
    }
    if let Some(run) = run {
        return run.finish(&study.scenario).map(|()| status);
    }
    if let [one] = given.as_slice()
        && let (Some(design), None) = (one.only_design(), &args.designs)
    {
        output::hint(&format!(
            "\nnext: navwalker validate {} --design {design} --against sgp4",
            args.study.name()
        ));
    }
    Ok(status)
}

/// The constellations given one by one, or else those of the scenario.
fn given(args: &EvaluateArgs, study: &Study) -> Result<Vec<Constellation>> {
    constellations::require_files(&args.constellations)?;
    if !args.constellations.is_empty() || args.designs.is_some() {
        return constellations::resolve(&args.constellations, study);
    }
    let named = constellations::of_scenario(study)?;
    if named.is_empty() {
        bail!(
            "no constellation: give --design NOTATION, --constellation FILE or --designs FILE, or name some in \
             [constellations] of the scenario"
        );
    }
    Ok(named)
}

/// What every constellation is evaluated with.
struct EvaluationContext<'a> {
    args: &'a EvaluateArgs,
    scenario: &'a Scenario,
    stamp: ScenarioStamp,
    evaluator: &'a Evaluator,
    goals: Goals,
    /// The GNSS without LEO satellites; `None` without GNSS.
    gnss_only: Option<Assessment>,
}

impl EvaluationContext<'_> {
    /// A constellation with what is asked for.
    fn entry(&self, one: &Constellation, ephemeris: &Ephemeris) -> Result<ConstellationEntry> {
        let (metrics, dops) = evaluated(self.args, self.evaluator, ephemeris)?;
        Ok(ConstellationEntry::new(one, metrics, dops, &self.goals))
    }
}

/// The metrics, and with `--dops` all dilutions of precision.
fn evaluated(
    args: &EvaluateArgs,
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
) -> Result<(Metrics, Option<DopStatistics>)> {
    let metrics = evaluator.evaluate_ephemeris(ephemeris)?;
    if !args.dops {
        return Ok((metrics, None));
    }
    let dops = evaluator.dops(ephemeris)?;
    Ok((metrics.with_dops(&dops), Some(dops)))
}

/// The GNSS of the scenario without LEO satellites.
fn gnss_only(
    args: &EvaluateArgs,
    goals: &Goals,
    evaluator: &Evaluator,
) -> Result<Option<Assessment>> {
    let setup = evaluator.setup();
    if setup.gnss.is_empty() {
        return Ok(None);
    }
    let none = Ephemeris::new(setup.grid, Vec::new());
    let (metrics, dops) = evaluated(args, evaluator, &none)?;
    Ok(Some(Assessment::new((0, None), metrics, dops, goals)))
}

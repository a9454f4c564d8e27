//! `navwalker evaluate`.

pub(super) mod deployment;
pub(super) mod designs;
pub(super) mod failures;
mod given_run;
mod phases;
mod print;
mod relative_nodes;
mod series;
mod single;
mod spares;
mod table;
pub(in crate::cli) mod tiles;

use crate::cli::args::EvaluateArgs;
use crate::cli::constellations::GivenConstellation;
use crate::cli::study::Study;
use crate::cli::{Status, constellations, limits, output};
use crate::ephemeris::Ephemeris;
use crate::evaluate::{DopStatistics, Evaluator, Metrics, ViewHistograms};
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::report::{Assessment, ConstellationEntry};
use crate::run::ScenarioStamp;
use crate::scenario::Scenario;
use crate::search::{CountedSatellites, Goals};
use anyhow::{Result, bail};
use deployment::DeploymentTable;
use designs::DesignList;
use given_run::GivenRun;
use phases::GnssPhases;
use print::Printer;
use relative_nodes::RelativeNodeStudy;
use series::SeriesDirectory;
use tiles::MergedTiles;

pub(crate) fn run(args: &EvaluateArgs) -> Result<Status> {
    let study = Study::load(&args.study, &[])?.without(&args.study, &args.without)?;
    spares::require_use_of_draws(args, &study.scenario)?;
    let sourced = given(args, &study)?;
    if let Some(tile) = args.tile {
        return tiles::evaluate(args, &study, &sourced, tile);
    }
    let list = args.designs.as_deref().map(DesignList::open).transpose()?;
    let run = GivenRun::open(args, &study, &sourced)?;
    let tiles = MergedTiles::paths(args, &sourced)?;
    let given = sourced.into_iter().map(|one| one.constellation);
    let given: Vec<Constellation> = given.collect();
    let series = SeriesDirectory::new(args, &study, &given)?;
    let evaluator = match &tiles {
        Some(_) => study.evaluator_in_tiles()?,
        None => study.evaluator()?,
    };
    let tiles = tiles
        .map(|tiles| tiles.open(&study, &evaluator))
        .transpose()?;
    if tiles.is_none() {
        limits::check_memory_of_tables(evaluator.setup(), args.dops, series.is_some())?;
    }
    let phases = GnssPhases::new(args.gnss_phases, evaluator.setup())?;
    let nodes = RelativeNodeStudy::new(args.relative_nodes, &given)?;
    let deployment = DeploymentTable::read(args.phases.as_deref())?;
    let fixed = study.fixed()?;
    let goals = study.goals(fixed.as_ref());
    let gnss_only = gnss_only(args, &goals, (&evaluator, tiles.as_ref()))?;
    let mut work = EvaluationContext {
        args,
        scenario: &study.scenario,
        stamp: study.stamp()?,
        goals,
        gnss_only,
        fixed: fixed.and_then(|fixed| fixed.files),
        evaluator: &evaluator,
        tiles,
    };
    let mut entries = Vec::new();
    let mut ephemerides = Vec::new();
    for (n, one) in given.iter().enumerate() {
        let ephemeris = constellations::propagate(one, evaluator.setup())?;
        let mut entry = work.entry(one, &ephemeris)?;
        entry.evaluated.expected = spares::expected(&work, one, &ephemeris)?;
        if let Some(k) = args.failures {
            let found =
                failures::summary(&work, one, &ephemeris, k.into(), &entry.evaluated.metrics)?;
            entry.evaluated.failures = Some(found);
        }
        if let Some(table) = &deployment {
            entry.evaluated.phases = Some(deployment::summary(&work, one, &ephemeris, table)?);
        }
        entries.push(entry);
        if let Some(series) = &series {
            series.write(n, &evaluator, &ephemeris)?;
        }
        if phases.is_some() {
            ephemerides.push(ephemeris);
        }
    }
    if let Some(phases) = &phases {
        phases.add(&mut work, &mut entries, &ephemerides)?;
    }
    if let Some(nodes) = &nodes {
        nodes.add(&work, &mut entries)?;
    }
    let run = match run {
        Some(run) => Some((run.result(&work, &entries)?, run)),
        None => None,
    };
    let mut printer = Printer::new(&work, &given, list.as_ref());
    for entry in entries {
        printer.entry(entry)?;
    }
    let status = match list {
        Some(list) => designs::evaluate(list, &study, &work, &mut printer)?,
        None => Status::Done,
    };
    printer.end()?;
    if let Some(series) = series {
        let told = series.told();
        series.commit()?;
        output::hint(&told);
    }
    if let Some((result, run)) = run {
        return run.finish(&result).map(|()| status);
    }
    if let [one] = given.as_slice()
        && let (Some(design), None) = (one.only_design(), &args.designs)
    {
        output::hint(&format!(
            "\nnext: navwalker validate {} --design {design} --against sgp4",
            args.study.words()
        ));
    }
    Ok(status)
}

/// The constellations given one by one, or else those of the scenario.
fn given(args: &EvaluateArgs, study: &Study) -> Result<Vec<GivenConstellation>> {
    constellations::require_files(&args.constellations)?;
    if !args.constellations.is_empty() || args.designs.is_some() {
        let with_contents = args.out.is_some() || !args.merge.is_empty();
        return constellations::resolve_given(&args.constellations, study, with_contents);
    }
    let named = constellations::given_by_scenario(study)?;
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
    /// What was evaluated in tiles.
    tiles: Option<MergedTiles>,
    goals: Goals,
    /// Satellites from files that are fixed in the search of the scenario, so that they are not new.
    fixed: Option<FileSatellites>,
    /// The GNSS without LEO satellites; `None` without GNSS.
    gnss_only: Option<Assessment>,
}

impl EvaluationContext<'_> {
    /// A constellation with what is asked for.
    fn entry(&self, one: &Constellation, ephemeris: &Ephemeris) -> Result<ConstellationEntry> {
        let alone = self.gnss_only.as_ref().map(|of| of.metrics);
        let (metrics, views, dops) =
            evaluated(self.args, (self.evaluator, self.tiles.as_ref()), ephemeris)?;
        let metrics = alone.map_or(metrics, |alone| metrics.with_gain_over(&alone));
        let goals = (&self.goals, self.fixed.as_ref());
        Ok(ConstellationEntry::new(one, (metrics, views), dops, goals))
    }
}

/// The metrics with the satellites in view, and with `--dops` all dilutions of precision.
fn evaluated(
    args: &EvaluateArgs,
    (evaluator, tiles): (&Evaluator, Option<&MergedTiles>),
    ephemeris: &Ephemeris,
) -> Result<(Metrics, ViewHistograms, Option<DopStatistics>)> {
    if let Some(tiles) = tiles {
        let (metrics, views) = tiles.merge(evaluator, ephemeris)?;
        return Ok((metrics, views, None));
    }
    let (metrics, views) = evaluator.evaluate_views(ephemeris)?;
    if !args.dops {
        return Ok((metrics, views, None));
    }
    let dops = evaluator.dops_beside(&metrics, ephemeris)?;
    Ok((metrics.with_dops(&dops), views, Some(dops)))
}

/// The GNSS of the scenario without LEO satellites.
fn gnss_only(
    args: &EvaluateArgs,
    goals: &Goals,
    (evaluator, tiles): (&Evaluator, Option<&MergedTiles>),
) -> Result<Option<Assessment>> {
    let setup = evaluator.setup();
    if setup.gnss.is_empty() {
        return Ok(None);
    }
    let none = Ephemeris::new(setup.grid, Vec::new());
    let (metrics, views, dops) = evaluated(args, (evaluator, tiles), &none)?;
    let metrics = metrics.with_gain_over(&metrics);
    Ok(Some(Assessment::new(
        CountedSatellites::default(),
        (metrics, views),
        dops,
        goals,
    )))
}

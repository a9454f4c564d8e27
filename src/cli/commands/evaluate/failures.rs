//! What failures of satellites do to a constellation.

use super::EvaluationContext;
use super::spares::DRAWS;
use crate::cli::output;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Metrics, Setup};
use crate::exchange::constellation::Constellation;
use crate::report::failures::{FailureCase, FailureCases, FailureSummary};
use crate::search::Quantity;
use crate::search::failures::{ALL_UP_TO, FailureSearch, Harm, all_sets, drawn_sets, set_count};
use crate::units::counted;
use anyhow::{Result, bail};

/// The quantities for which the worst set is searched.
const SEARCHED: [Quantity; 4] = [
    Quantity::MeanPdop,
    Quantity::CvarPdop,
    Quantity::MaxPdop,
    Quantity::Availability,
];

/// The metrics over failures of `k` satellites of a constellation in service.
pub(super) fn summary(
    work: &EvaluationContext<'_>,
    one: &Constellation,
    ephemeris: &Ephemeris,
    k: usize,
    whole: &Metrics,
) -> Result<FailureSummary> {
    let satellites = ephemeris.satellites().len();
    require_one_left(&one.name, satellites, k)?;
    tell_of_evaluations_anew(work.evaluator.setup());
    let mut search = FailureSearch::new(satellites, |sets: &[Vec<usize>]| {
        without_each(work, one, ephemeris, sets)
    });
    let FailureSets { sets, drawn } = FailureSets::new(
        satellites,
        k,
        (work.args.draws, work.scenario.optimizer.seed),
    );
    let found = search.without(&sets)?;
    let mut cases = FailureCases {
        k,
        cases: named(ephemeris, sets.iter().zip(&found)),
        searched: Vec::new(),
        drawn,
        planes: Vec::new(),
    };
    if drawn.is_some() {
        for quantity in SEARCHED {
            search.search(k, |metrics| harm(quantity, metrics))?;
        }
        cases.searched = named(ephemeris, search.evaluated(k));
    }
    if k == 1 {
        let planes = planes(ephemeris);
        let sets: Vec<Vec<usize>> = planes.iter().map(|(_, places)| places.clone()).collect();
        let found = search.without(&sets)?;
        let named = named(ephemeris, sets.iter().zip(&found)).into_iter();
        let names = planes.into_iter().map(|(name, _)| name);
        cases.planes = names.zip(named).collect();
    }
    Ok(FailureSummary::new(&cases, whole))
}

/// Refuses failures of all satellites.
pub(crate) fn require_one_left(name: &str, satellites: usize, k: usize) -> Result<()> {
    if k >= satellites {
        let has = counted(satellites, "satellite");
        bail!("--failures {k}: {name} has {has}, and one must be left");
    }
    Ok(())
}

/// Says what is not downdated, and so takes an evaluation for each case.
fn tell_of_evaluations_anew(setup: &Setup) {
    let mut anew = Vec::new();
    if setup.accuracy.is_some() {
        anew.push("the accuracy in metres");
    }
    if setup.window_s.is_some() {
        anew.push("the PDOP of windows");
    }
    if setup.metrics.asks_for_hdop {
        anew.push("the quantiles of HDOP and VDOP");
    }
    if !anew.is_empty() {
        output::hint(&format!(
            "--failures: each case takes an evaluation of its own for {}, which slows it many times",
            anew.join(", ")
        ));
    }
}

/// The sets of satellites that fail together.
pub(crate) struct FailureSets {
    pub(crate) sets: Vec<Vec<usize>>,
    /// Number of draws and their seed; `None` if these are all sets.
    pub(crate) drawn: Option<(usize, u64)>,
}

impl FailureSets {
    /// All sets of `k` satellites if there are few, or if it is one that fails; otherwise draws, as many as given.
    pub(crate) fn new(satellites: usize, k: usize, (draws, seed): (Option<u32>, u64)) -> Self {
        let most = ALL_UP_TO.max(if k == 1 { satellites } else { 0 });
        if set_count(satellites, k).is_some_and(|count| count <= most) {
            return Self {
                sets: all_sets(satellites, k),
                drawn: None,
            };
        }
        let draws = draws.unwrap_or(DRAWS) as usize;
        Self {
            sets: drawn_sets(satellites, k, draws, seed),
            drawn: Some((draws, seed)),
        }
    }
}

fn harm(quantity: Quantity, metrics: &Metrics) -> Harm {
    let value = match quantity {
        Quantity::MeanPdop => metrics.mean_pdop,
        Quantity::CvarPdop => metrics.cvar_pdop,
        Quantity::MaxPdop => metrics.max_pdop,
        _ => Some(metrics.availability),
    };
    Harm::of(quantity, value, metrics.solved_fraction)
}

/// The metrics without each set, with what is computed on demand.
fn without_each(
    work: &EvaluationContext<'_>,
    one: &Constellation,
    ephemeris: &Ephemeris,
    sets: &[Vec<usize>],
) -> Result<Vec<Metrics>> {
    let evaluator = work.evaluator;
    let mut found = evaluator.without_each(ephemeris, sets)?;
    if evaluator.has_further() {
        for (metrics, set) in found.iter_mut().zip(sets) {
            let left = one.in_service(evaluator.setup())?.without(set);
            *metrics = evaluator.with_further(*metrics, &left)?;
        }
    }
    Ok(found)
}

fn named<'a>(
    ephemeris: &Ephemeris,
    found: impl Iterator<Item = (&'a Vec<usize>, &'a Metrics)>,
) -> Vec<FailureCase> {
    let name = |place: &usize| ephemeris.satellites()[*place].name.clone();
    let case = |(set, metrics): (&Vec<usize>, &Metrics)| FailureCase {
        without: set.iter().map(name).collect(),
        metrics: *metrics,
    };
    found.map(case).collect()
}

/// The planes that do not hold all satellites, each with the places of its satellites.
fn planes(ephemeris: &Ephemeris) -> Vec<(String, Vec<usize>)> {
    let mut planes = ephemeris.planes();
    planes.retain(|(_, places)| places.len() < ephemeris.satellites().len());
    planes
}

//! What failures of satellites do to a constellation.

use super::EvaluationContext;
use crate::ephemeris::Ephemeris;
use crate::ephemeris::outages::plane_name;
use crate::evaluate::Metrics;
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
    if k >= satellites {
        bail!(
            "--failures {k}: {} has {}, and one must be left",
            one.name,
            counted(satellites, "satellite")
        );
    }
    let mut search = FailureSearch::new(satellites, |sets: &[Vec<usize>]| {
        without_each(work, one, ephemeris, sets)
    });
    let (draws, seed) = (work.args.draws as usize, work.scenario.optimizer.seed);
    let most = ALL_UP_TO.max(if k == 1 { satellites } else { 0 });
    let all = set_count(satellites, k).is_some_and(|count| count <= most);
    let sets = match all {
        true => all_sets(satellites, k),
        false => drawn_sets(satellites, k, draws, seed),
    };
    let found = search.without(&sets)?;
    let mut cases = FailureCases {
        k,
        cases: named(ephemeris, sets.iter().zip(&found)),
        searched: Vec::new(),
        drawn: (!all).then_some((draws, seed)),
        planes: Vec::new(),
    };
    if !all {
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
    let mut planes: Vec<(String, Vec<usize>)> = Vec::new();
    for (place, satellite) in ephemeris.satellites().iter().enumerate() {
        let Some(name) = plane_name(satellite) else {
            continue;
        };
        match planes.last_mut().filter(|(last, _)| last == name) {
            Some((_, places)) => places.push(place),
            None => planes.push((name.to_owned(), vec![place])),
        }
    }
    planes.retain(|(_, places)| places.len() < ephemeris.satellites().len());
    planes
}

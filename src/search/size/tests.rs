//! Against a sweep of the same grid that evaluates everything.

mod closest;
mod rules;

use super::*;
use crate::constellation::gnss::Preset;
use crate::earth::Surface;
use crate::evaluate::{Evaluator, Setup};
use crate::ground::Site;
use crate::optimize::{Problem, SweepGrid};
use crate::search::testing::shell;
use crate::search::{DesignProblem, DesignSpace, Goals, LaunchCost, Quantity};
use crate::time::{Epoch, TimeGrid};
use proptest::prelude::*;
use std::collections::BTreeMap;

fn setup(sites: usize, samples: usize, with_gnss: bool, available: f64) -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 300.0 * samples as f64, 300.0).unwrap();
    let site = |n: usize| {
        // Uneven weights, so that shares are not those of numbers of samples.
        let n = n as f64;
        let (latitude_deg, longitude_deg) = (-50.0 + (n * 37.0) % 105.0, (n * 61.0) % 360.0);
        Site::new(Surface::Wgs84, latitude_deg, longitude_deg, 1.0 + n % 3.0).unwrap()
    };
    let gnss = if with_gnss {
        vec![Preset::Beidou3.into()]
    } else {
        Vec::new()
    };
    let setup = Setup::new(grid, (0..sites).map(site).collect()).with_gnss(gnss);
    let mut metrics = setup.metrics;
    metrics.availability_pdop = available;
    setup.with_metrics(metrics)
}

fn goals(constraints: &[&str]) -> Goals {
    Goals {
        objectives: vec![Quantity::Satellites],
        constraints: constraints.iter().map(|c| c.parse().unwrap()).collect(),
        launch_cost: LaunchCost {
            per_satellite: 1.0,
            per_plane: 5.0,
            per_1000_km: 0.2,
        },
        fixed: None,
        fixed_from_files: 0,
    }
}

/// Two to four planes of two to six, at two inclinations and altitudes, and perhaps a second shell.
fn space(has_second: bool) -> DesignSpace {
    let mut one = shell();
    one.planes = [2, 4];
    one.satellites_per_plane = [2, 6];
    one.phasing = [0, 2];
    one.inclination_deg = [50.0, 70.0].into();
    one.altitude_km = [900.0, 1500.0].into();
    one.steps.inclination_step_deg = 20.0;
    one.steps.altitude_step_km = 600.0;
    let mut space: DesignSpace = one.clone().into();
    if has_second {
        space.shells[0].phasing = [1, 1];
        one.planes = [3, 3];
        one.satellites_per_plane = [0, 2];
        one.phasing = [1, 1];
        one.inclination_deg = [90.0, 90.0].into();
        one.altitude_km = [1200.0, 1200.0].into();
        space.shells.push(one);
    }
    space
}

/// By number of satellites: designs, and the notations of those that keep the constraints.
type Levels = BTreeMap<usize, (u64, Vec<String>)>;

/// Everything evaluated, in the order of the grid.
fn swept(problem: &DesignProblem<'_>) -> Levels {
    let grid = SweepGrid::new(problem.space(), &problem.designs().steps());
    let mut levels = Levels::new();
    for index in 0..grid.count().unwrap() {
        let Some(genome) = grid.admitted(problem, grid.genome(index)).unwrap() else {
            continue;
        };
        let (design, metrics) = problem.evaluated(&genome).unwrap();
        let design = design.unwrap();
        let level = levels.entry(design.satellite_count()).or_default();
        level.0 += 1;
        let is_kept = problem.goals().constraints.iter().all(|constraint| {
            let value = problem.value(constraint.quantity, Some(&design), &metrics);
            let solved = constraint.quantity.solved_fraction(&metrics);
            constraint.violation(value, solved) == 0.0
        });
        if is_kept {
            level.1.push(design.to_string());
        }
    }
    levels
}

/// A finished search, and all its witnesses.
fn found(problem: &SizeProblem<'_>, slack: usize) -> (SizeSearch, Vec<(usize, Witness)>) {
    let mut search = SizeSearch::start(problem, slack, Some(Quantity::MaxPdop));
    let mut witnesses = Vec::new();
    while !search.is_done() {
        witnesses.extend(search.step(problem).unwrap());
    }
    (search, witnesses)
}

/// The search against the sweep: the fewest, all designs of that number, and the number of designs of each below.
fn compare(problem: &DesignProblem<'_>) -> SizeSearch {
    let levels = swept(problem);
    let size = SizeProblem::new(problem);
    let (search, witnesses) = found(&size, 0);
    let fewest = levels.iter().find(|(_, (_, kept))| !kept.is_empty());
    assert_eq!(search.fewest(), fewest.map(|(satellites, _)| *satellites));
    for level in search.levels() {
        let (designs, kept) = &levels[&level.satellites];
        assert_eq!((level.designs, level.kept), (*designs, kept.len() as u64));
        let rejected = witnesses.iter().filter(|(of, _)| *of == level.satellites);
        assert_eq!(rejected.count() as u64, designs - kept.len() as u64);
        if Some(level.satellites) == search.fewest() {
            let mut named: Vec<&String> = level.best.iter().map(|one| &one.design).collect();
            let mut kept: Vec<&String> = kept.iter().collect();
            named.sort();
            kept.sort();
            assert_eq!(named, kept);
            assert!(level.best.is_sorted_by(|a, b| a.margin >= b.margin));
        }
    }
    let kept: Vec<&String> = levels.values().flat_map(|(_, kept)| kept).collect();
    assert!(
        witnesses
            .iter()
            .all(|(_, one)| !kept.contains(&&one.design))
    );
    search
}

/// One constraint of each rule, with a bound in the middle of what the designs of [`space`] reach.
fn constraint() -> impl Strategy<Value = String> {
    let about = |text: &'static str, low: f64, high: f64| {
        (low..high).prop_map(move |bound| format!("{text} {bound}"))
    };
    prop_oneof![
        about("availability >=", 0.05, 1.0),
        about("coverage-1 >=", 0.2, 1.0),
        about("coverage-total-8 >=", 0.5, 1.0),
        about("least-visible >=", 0.0, 2.0),
        about("mean-pdop <=", 1.0, 3.0),
        about("cvar-pdop <=", 1.3, 6.0),
        about("max-pdop <=", 1.3, 9.0),
        about("p95-pdop <=", 1.2, 4.0),
        about("p99-pdop <=", 1.2, 5.0),
        about("j-pos <=", 2.0, 6.0),
        about("longest-outage-s <=", 0.0, 9000.0),
        about("mean-visible >=", 0.2, 2.0),
        about("planes <=", 2.0, 4.0),
        about("satellites >=", 4.0, 20.0),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// The answer is that of the sweep, for every kind of constraint.
    #[test]
    fn the_answer_is_that_of_the_sweep(
        first in constraint(), second in constraint(), has_second in prop::bool::ANY,
        with_gnss in prop::bool::weighted(0.8), sites in 1..40_usize, available in 1.2..4.0_f64,
    ) {
        let evaluator = Evaluator::new(setup(sites, 24, with_gnss, available)).unwrap();
        let goals = goals(&[first.as_str(), second.as_str()]);
        let problem = DesignProblem::new(&evaluator, space(has_second), goals).unwrap();
        compare(&problem);
    }
}

/// The value of a quantity that a share of the designs of [`space`] reach; of the maximum, which the GNSS alone may
/// decide, and of J_pos one that none reaches.
fn reached(evaluator: &Evaluator, quantity: &str, share: f64) -> f64 {
    let quantity: Quantity = quantity.parse().unwrap();
    let problem = DesignProblem::new(evaluator, space(false), goals(&[])).unwrap();
    let grid = SweepGrid::new(problem.space(), &problem.designs().steps());
    let mut values: Vec<f64> = (0..grid.count().unwrap())
        .filter_map(|index| grid.admitted(&problem, grid.genome(index)).unwrap())
        .map(|genome| {
            let (design, metrics) = problem.evaluated(&genome).unwrap();
            quantity.minimised(problem.value(quantity, design.as_ref(), &metrics).unwrap())
        })
        .collect();
    values.sort_by(f64::total_cmp);
    match quantity {
        Quantity::MaxPdop => 0.99 * values[0],
        // The samples that are left count with the least PDOP of any geometry, so that this rule acts far from the bound.
        Quantity::JPos => 0.6 * values[0],
        _ => quantity.minimised(values[(share * values.len() as f64) as usize]),
    }
}

/// Each rule rejects designs before their evaluation ends, and the answer is that of the sweep.
#[test]
fn every_rule_saves_samples() {
    let evaluator = Evaluator::new(setup(30, 48, true, 1.6)).unwrap();
    for (quantity, relation) in [
        ("availability", ">="),
        ("coverage-1", ">="),
        ("coverage-total-9", ">="),
        ("mean-pdop", "<="),
        ("cvar-pdop", "<="),
        ("max-pdop", "<="),
        ("p95-pdop", "<="),
        ("p99-pdop", "<="),
        ("j-pos", "<="),
        ("longest-outage-s", "<="),
    ] {
        let bound = reached(&evaluator, quantity, 0.1);
        let constraint = format!("{quantity} {relation} {bound}");
        let goals = goals(&[constraint.as_str()]);
        let problem = DesignProblem::new(&evaluator, space(false), goals).unwrap();
        let search = compare(&problem);
        let size = SizeProblem::new(&problem);
        assert_eq!(
            search.fewest().is_some(),
            !["max-pdop", "j-pos"].contains(&quantity),
            "{constraint}"
        );
        assert!(size.without_rule().is_empty(), "{constraint}");
        let by_samples = search
            .savings()
            .into_iter()
            .filter(|one| one.basis == RejectionBasis::Samples && one.tiles_saved > 0);
        assert_eq!(
            by_samples.count(),
            1,
            "{constraint}: {:?}",
            search.savings()
        );
    }
    let problem = DesignProblem::new(&evaluator, space(false), goals(&["least-visible >= 1"]));
    let search = compare(&problem.unwrap());
    assert!(search.savings()[0].tiles_saved > 0 && search.fewest().is_none());
}

/// A gain is that over the GNSS alone, here as in a sweep.
#[test]
fn a_gain_over_the_gnss_is_counted() {
    let evaluator = Evaluator::new(setup(30, 48, true, 1.6)).unwrap();
    let bound = reached(&evaluator, "gain-mean-pdop", 0.1);
    let constraint = format!("gain-mean-pdop >= {bound}");
    let goals = goals(&[constraint.as_str()]);
    let problem = DesignProblem::new(&evaluator, space(false), goals).unwrap();
    assert!(compare(&problem).fewest().is_some(), "{constraint}");
}

/// A step at a time, written and read in between, on one thread or several: the same witnesses.
#[test]
fn a_resumed_search_equals_an_unbroken_one_on_any_threads() {
    let evaluator = Evaluator::new(setup(20, 48, true, 2.0)).unwrap();
    let goals = goals(&["availability >= 0.9", "max-pdop <= 9"]);
    let problem = DesignProblem::new(&evaluator, space(true), goals).unwrap();
    let size = SizeProblem::new(&problem);
    let (unbroken, expected) = found(&size, 3);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let mut search = SizeSearch::start(&size, 3, Some(Quantity::MaxPdop));
        let mut witnesses = Vec::new();
        while !search.is_done() {
            let text = serde_json::to_string(&search).unwrap();
            search = serde_json::from_str(&text).unwrap();
            assert!(search.suits(&size, 3, Some(Quantity::MaxPdop)));
            assert!(!search.suits(&size, 2, Some(Quantity::MaxPdop)));
            witnesses.extend(pool.install(|| search.step(&size)).unwrap());
        }
        assert_eq!(search, unbroken);
        assert_eq!(witnesses, expected);
    }
}

/// Parts of any size tried alone, in any order, and written and read, make up the search that tries everything; with
/// whatever it finds beyond its end left out, and the same on any number of threads.
#[test]
fn parts_make_up_the_search() {
    let evaluator = Evaluator::new(setup(20, 48, true, 2.0)).unwrap();
    for (constraint, slack) in [
        ("availability >= 0.9", 0),
        ("availability >= 0.9", 3),
        ("max-pdop <= 0.1", 0),
    ] {
        let goals = goals(&[constraint, "max-pdop <= 9"]);
        let problem = DesignProblem::new(&evaluator, space(true), goals).unwrap();
        for points in [1, 7, 40, 8192] {
            let size = SizeProblem::new(&problem).in_parts_of(points);
            let (whole, expected) = found(&size, slack);
            let parts = size.parts().unwrap();
            let tried = |number: u64| {
                let objective = Some(Quantity::MaxPdop);
                let search = SizeSearch::of_part(&size, slack, objective, number).unwrap();
                let mut search = search.unwrap();
                let mut witnesses = Vec::new();
                while !search.is_done() {
                    witnesses.extend(search.step(&size).unwrap());
                }
                (serde_json::to_string(&search.kept()).unwrap(), witnesses)
            };
            let mut backwards: Vec<_> = (0..parts).rev().map(tried).collect();
            let mut search = SizeSearch::start(&size, slack, Some(Quantity::MaxPdop));
            let mut witnesses = Vec::new();
            while !search.is_done() {
                let number = search.next_part(&size).unwrap();
                assert_eq!(number, parts - backwards.len() as u64);
                let (text, found) = backwards.pop().unwrap();
                let first = size.satellites_of_part(number).unwrap().unwrap();
                let last = search.fewest().map(|n| size.last_reached(n, slack));
                assert!(last.is_none_or(|last| first <= last));
                let part = serde_json::from_str(&text).unwrap();
                assert!(search.absorb(&size, part).unwrap());
                let last = search.levels().last().map_or(0, |level| level.satellites);
                witnesses.extend(found.into_iter().filter(|(of, _)| *of <= last));
            }
            assert_eq!(search.kept(), whole.kept(), "{constraint} {points}");
            assert_eq!(witnesses, expected, "{constraint} {points}");
        }
    }
}

/// A part is taken up only where it belongs, and only into the search that it is a part of.
#[test]
fn a_part_of_another_search_is_not_taken_up() {
    let evaluator = Evaluator::new(setup(5, 12, true, 2.0)).unwrap();
    let problem =
        DesignProblem::new(&evaluator, space(false), goals(&["availability >= 0.9"])).unwrap();
    let size = SizeProblem::new(&problem).in_parts_of(10);
    let part = |number: u64, slack: usize| {
        let search = SizeSearch::of_part(&size, slack, None, number).unwrap();
        let mut search = search.unwrap();
        while !search.is_done() {
            search.step(&size).unwrap();
        }
        search
    };
    let mut search = SizeSearch::start(&size, 0, None);
    for other in [part(1, 0), part(0, 2), SizeSearch::start(&size, 0, None)] {
        assert!(!search.absorb(&size, other).unwrap());
    }
    let begun = SizeSearch::of_part(&size, 0, None, 0).unwrap().unwrap();
    assert!(!search.absorb(&size, begun).unwrap());
    assert!(search.absorb(&size, part(0, 0)).unwrap());
    assert!(!search.absorb(&size, part(0, 0)).unwrap());
    let behind = size.parts().unwrap();
    assert!(
        SizeSearch::of_part(&size, 0, None, behind)
            .unwrap()
            .is_none()
    );
}

/// The number of designs is known before the search.
#[test]
fn designs_are_counted_beforehand() {
    let evaluator = Evaluator::new(setup(1, 2, true, 2.0)).unwrap();
    for has_second in [false, true] {
        let goals = goals(&["mean-visible >= 1000"]);
        let problem = DesignProblem::new(&evaluator, space(has_second), goals).unwrap();
        let size = SizeProblem::new(&problem);
        let (search, witnesses) = found(&size, 0);
        assert_eq!(search.fewest(), None);
        assert_eq!(size.design_count(), search.tried() as f64);
        assert_eq!(witnesses.len() as u64, search.tried());
    }
}

/// No satellites are enough for a PDOP that no geometry has, and none is evaluated.
#[test]
fn what_no_geometry_has_is_rejected_without_evaluation() {
    let evaluator = Evaluator::new(setup(5, 10, true, 0.4)).unwrap();
    for constraint in ["availability >= 0.5", "max-pdop <= 0.4", "mean-pdop <= 0.4"] {
        let problem = DesignProblem::new(&evaluator, space(false), goals(&[constraint])).unwrap();
        let search = compare(&problem);
        assert_eq!((search.begun(), search.fewest()), (0, None), "{constraint}");
        assert_eq!(search.savings()[0].basis, RejectionBasis::Geometry);
    }
}

/// A witness names what it says: the share is beyond what the bound leaves by less than a tile, and the point has a
/// sample of the value.
#[test]
fn witnesses_can_be_checked() {
    let evaluator = Evaluator::new(setup(30, 48, true, 1.6)).unwrap();
    let witnesses = |quantity: &str, relation: &str| {
        let bound = reached(&evaluator, quantity, 0.1);
        let constraint = format!("{quantity} {relation} {bound}");
        let goals = goals(&[constraint.as_str()]);
        let problem = DesignProblem::new(&evaluator, space(false), goals).unwrap();
        let (_, witnesses) = found(&SizeProblem::new(&problem), 0);
        let by_samples = witnesses.into_iter().map(|(_, witness)| witness);
        let of: Vec<Witness> = by_samples
            .filter(|witness| witness.basis == RejectionBasis::Samples)
            .collect();
        assert!(of.len() > 10, "{constraint}: {}", of.len());
        (bound, of)
    };
    let (bound, by_share) = witnesses("availability", ">=");
    for witness in by_share {
        let share = witness.share_at_rejection.unwrap();
        // A tile has at most 16 points of the 30, with up to three times the weight of another.
        let tile = 16.0 * 3.0 / 30.0 / 48.0;
        assert!(
            share > 1.0 - bound && share < 1.0 - bound + tile,
            "{witness:?}"
        );
    }
    let (bound, by_sample) = witnesses("max-pdop", "<=");
    for witness in by_sample {
        let setup = evaluator.setup();
        let site = setup.sites[witness.point.unwrap().number - 1].clone();
        let one = Setup::new(setup.grid, vec![site]).with_gnss(setup.gnss.clone());
        let of_point = Evaluator::new(one).unwrap();
        let metrics = of_point.evaluate(&witness.design.parse().unwrap()).unwrap();
        let value = witness.value_at_rejection.unwrap();
        // The sample is one of the point, which may have worse ones; in f32 it is off by up to 1e-6.
        let worst = metrics.max_pdop.unwrap();
        assert!(
            value > bound && value <= worst * (1.0 + 1e-6),
            "{witness:?} {worst}"
        );
    }
}

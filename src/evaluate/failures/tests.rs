use super::*;
use crate::constellation::Design;
use crate::constellation::gnss::Preset;
use crate::dop::{Clocks, LeoClocks, ObservationWeights};
use crate::earth::Surface;
use crate::evaluate::kernel::WholeSample;
use crate::evaluate::{Setup, plain, testing};
use crate::ground::Site;
use crate::stats::Level;
use crate::time::{Epoch, TimeGrid};
use crate::visibility::MaskTable;
use serde_json::Value;

/// Relative difference between sums made in two ways: a hundred satellites of 2⁻⁵³ each, times what a PDOP of 5 amplifies.
const ROUNDING: f64 = 1e-12;

fn study(surface: Surface) -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7200.0, 240.0).unwrap();
    let places = [-62.0, -30.0, 2.0, 21.0, 40.0, 53.0, 70.0, 88.0];
    let site = |(n, latitude): (usize, f64)| {
        Site::new(
            surface,
            latitude,
            71.0 * n as f64 - 180.0,
            1.0 + 0.5 * (n % 3) as f64,
        )
        .unwrap()
    };
    let sites = places.into_iter().enumerate().map(site).collect();
    testing::setup(grid, sites, 7.0)
}

fn propagated(setup: &Setup, design: &str) -> Ephemeris {
    let design: Design = design.parse().unwrap();
    Ephemeris::of_design(&design, setup.model, setup.grid).unwrap()
}

/// Everything that the metrics say, number by number.
fn assert_same(ours: &Metrics, anew: &Metrics, what: &str) {
    fn compare(ours: &Value, anew: &Value, what: &str) {
        match (ours, anew) {
            (Value::Object(ours), Value::Object(anew)) => {
                assert_eq!(ours.len(), anew.len());
                for (name, value) in ours {
                    compare(value, &anew[name], &format!("{what}: {name}"));
                }
            }
            (Value::Number(ours), Value::Number(anew)) => {
                let (ours, anew) = (ours.as_f64().unwrap(), anew.as_f64().unwrap());
                let difference = (ours - anew).abs();
                assert!(
                    difference <= ROUNDING * anew.abs().max(1.0),
                    "{what}: {ours} {anew}"
                );
            }
            _ => assert_eq!(ours, anew, "{what}"),
        }
    }
    let value = |metrics: &Metrics| serde_json::to_value(metrics).unwrap();
    compare(&value(ours), &value(anew), what);
}

fn assert_as_evaluated_anew(setup: Setup, design: &str, sets: &[Vec<usize>]) {
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let found = evaluator
        .without_each(&propagated(&setup, design), sets)
        .unwrap();
    assert_eq!(found.len(), sets.len());
    for (ours, set) in found.iter().zip(sets) {
        let left = propagated(&setup, design).without(set);
        let anew = evaluator.evaluate_plain(&left).unwrap();
        assert_same(ours, &anew, &format!("{design} without {set:?}"));
    }
}

fn each(count: usize) -> Vec<Vec<usize>> {
    (0..count).map(|place| vec![place]).collect()
}

/// Constellations that solve all samples and few, with one clock and several, and weights.
fn studies() -> Vec<(Setup, &'static str, usize)> {
    let base = || study(Surface::Wgs84);
    let equal = |setup: Setup| {
        let one = |site: Site| Site {
            weight: 1.0,
            ..site
        };
        Setup {
            sites: setup.sites.into_iter().map(one).collect(),
            ..setup
        }
    };
    let alone = |setup: Setup| setup.with_gnss(Vec::new());
    let hybrid = "delta:53:60/6/1@1000+star:87:30/5/1@1100";
    let skyline = MaskTable::new(vec![(0.0, 30.0), (90.0, 5.0), (360.0, 30.0)]).unwrap();
    let mut metrics = base().metrics;
    metrics.cvar_level = Level::new(0.9).unwrap();
    metrics.availability_pdop = 2.0;
    vec![
        (base(), "delta:55:60/6/1@925", 60),
        (equal(study(Surface::Sphere)), "delta:55:60/6/1@925", 60),
        (
            base().with_clocks(Clocks::Shared),
            "delta:55:24/4/1@925,e=0.02",
            24,
        ),
        (base().with_leo_clocks(LeoClocks::PerPart), hybrid, 90),
        (alone(base()), "star:87:66/6/2@780", 66),
        (equal(alone(base())), hybrid, 90),
        (
            alone(base()).with_pdop_cap(4.0),
            "delta:40:12/3/1@20000",
            12,
        ),
        (alone(base()), "delta:55:2/2/1@925", 2),
        (
            base().with_observation_weights(ObservationWeights::SineElevation),
            "delta:55:30/5/1@925",
            30,
        ),
        (base().with_skyline(skyline), "delta:55:30/5/1@925", 30),
        (
            equal(base()).with_metrics(metrics),
            "delta:55:30/5/1@925",
            30,
        ),
        (
            base().with_gnss(vec![Preset::Gps.into(), Preset::Galileo.into()]),
            "delta:65:20/5/1@1200",
            20,
        ),
    ]
}

#[test]
fn each_satellite_is_lost_as_if_evaluated_anew() {
    for (setup, design, satellites) in studies() {
        assert_as_evaluated_anew(setup, design, &each(satellites));
    }
}

/// The maximum, the availability and what is solved, to the last bit as from the list of all samples that change: also where
/// samples are left unsolved, and where weighted ones are no longer available.
#[test]
fn the_worst_is_that_of_all_samples() {
    let (mut unsolved, mut unavailable) = (0, 0);
    for (setup, design, satellites) in studies() {
        let mut strict = setup.clone();
        strict.metrics.availability_pdop = 2.0;
        for setup in [setup, strict] {
            let evaluator = Evaluator::new(setup.clone()).unwrap();
            let whole = propagated(&setup, design);
            let mut sets = each(satellites);
            sets.push((0..satellites).collect());
            sets.push((0..satellites / 2).collect());
            sets.push(Vec::new());
            let ours = evaluator.worst_without_each(&whole, &sets).unwrap();
            let all = evaluator.without_each(&whole, &sets).unwrap();
            let with_all = all[all.len() - 1];
            for ((ours, all), set) in ours.iter().zip(&all).zip(&sets) {
                let what = format!("{design} without {set:?}");
                assert_eq!(ours.max_pdop, all.max_pdop, "{what}");
                assert_eq!(ours.availability, all.availability, "{what}");
                assert_eq!(ours.solved_fraction, all.solved_fraction, "{what}");
                let is_solved = ours.solved_fraction == with_all.solved_fraction;
                unsolved += usize::from(!is_solved);
                unavailable += usize::from(is_solved && ours.availability < with_all.availability);
            }
        }
    }
    assert!(
        unsolved > 100 && unavailable > 100,
        "{unsolved} {unavailable}"
    );
}

/// Planes, pairs, sets that overlap, all satellites and none.
#[test]
fn sets_are_lost_as_if_evaluated_anew() {
    for (setup, design, satellites) in studies() {
        let sets = [
            (0..satellites / 2).collect(),
            vec![satellites - 1, 0],
            vec![0, 1],
            (0..satellites).collect(),
            Vec::new(),
        ];
        assert_as_evaluated_anew(setup, design, &sets);
    }
}

/// All 780 pairs of 40 satellites, pair by pair, against brute force.
#[test]
fn all_pairs_are_as_if_evaluated_anew() {
    let base = study(Surface::Wgs84);
    let setup = Setup {
        sites: base.sites.iter().step_by(3).cloned().collect(),
        grid: TimeGrid::new(base.grid.epoch(), 3600.0, 900.0).unwrap(),
        ..base
    };
    let pairs: Vec<Vec<usize>> = (0..40)
        .flat_map(|first| (first + 1..40).map(move |second| vec![first, second]))
        .collect();
    assert_eq!(pairs.len(), 780);
    assert_as_evaluated_anew(setup, "delta:55:40/5/1@1200", &pairs);
}

/// Sample by sample, to 1e-12 and with the same verdicts.
#[test]
fn each_sample_is_as_if_evaluated_anew() {
    for (setup, design, satellites) in studies() {
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        let whole = propagated(&setup, design);
        let lost = each(satellites);
        let sets = Sets::new(&evaluator, &whole, &lost);
        let pieces = pass::pass(&evaluator, &SightTree::new(&setup), &sets).unwrap();
        let instants = setup.grid.len();
        let samples = pieces.iter().flat_map(|piece| &piece.whole);
        let samples: Vec<WholeSample> = samples.copied().collect();
        assert_eq!(samples.len(), setup.sites.len() * instants);
        for place in (0..satellites).step_by(7) {
            let mut ours: Vec<f64> = samples.iter().map(|one| one.pdop).collect();
            for one in pieces.iter().flat_map(|piece| &piece.changed[place]) {
                ours[one.sample as usize] = one.pdop;
            }
            // From the order of the pass to that of the points.
            let mut by_site = vec![f64::NAN; ours.len()];
            for (n, one) in samples.iter().enumerate() {
                let first = n / setup.sites.len() * setup.sites.len();
                by_site[first + one.site as usize] = ours[n];
            }
            let left = propagated(&setup, design).without(&[place]);
            let mut ours = by_site.into_iter();
            plain::visit(&evaluator, &left, |sample| {
                let (ours, anew) = (ours.next().unwrap(), sample.pdop);
                assert_eq!(ours.is_finite(), anew.is_some(), "{design} {place}");
                let anew = anew.unwrap_or(ours);
                let is_same = ours == anew || (ours / anew - 1.0).abs() < ROUNDING;
                assert!(is_same, "{design} {place}: {ours} {anew}");
            })
            .unwrap();
        }
    }
}

/// Point by point against the series of the constellations that are left.
#[test]
fn the_worst_of_each_point_is_that_of_all_losses() {
    for (setup, design, satellites) in studies() {
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        let ours = evaluator
            .one_lost_by_point(&propagated(&setup, design))
            .unwrap();
        let mut worst = vec![(0.0_f64, 1.0_f64); setup.sites.len()];
        for place in 0..satellites {
            let left = propagated(&setup, design).without(&[place]);
            let series = evaluator.series(&left).unwrap();
            for (worst, point) in worst.iter_mut().zip(&series.points) {
                let solved = point.max_pdop.filter(|_| point.solved_fraction == 1.0);
                worst.0 = worst.0.max(solved.unwrap_or(f64::INFINITY));
                worst.1 = worst.1.min(point.availability);
            }
        }
        for (ours, worst) in ours.iter().zip(worst) {
            let max_pdop = ours.max_pdop.unwrap_or(f64::INFINITY);
            // The series is in f32.
            let is_same = max_pdop == worst.0 || (max_pdop / worst.0 - 1.0).abs() < 1e-6;
            assert!(is_same, "{design}: {max_pdop} {}", worst.0);
            assert!((ours.availability - worst.1).abs() < 1e-12, "{design}");
        }
    }
}

/// The bound on memory divides the sets into passes, and each is in one of them.
#[test]
fn sets_are_divided_into_passes() {
    let setup = Setup {
        sites: (0..40).flat_map(|_| study(Surface::Wgs84).sites).collect(),
        grid: TimeGrid::new(study(Surface::Wgs84).grid.epoch(), 864_000.0, 10.0).unwrap(),
        gnss: Vec::new(),
        ..study(Surface::Wgs84)
    };
    let small = study(Surface::Wgs84);
    let whole = propagated(&small, "delta:55:60/6/1@925");
    let lost = each(60);
    let of = |setup: &Setup| {
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        let batches = evaluator.batches(&whole, &lost).unwrap();
        let sizes: Vec<usize> = batches.iter().map(|batch| batch.len()).collect();
        assert_eq!(batches.concat(), lost);
        sizes
    };
    assert_eq!(of(&small), [60]);
    let sizes = of(&setup);
    assert!(
        sizes.len() > 3 && sizes.iter().all(|size| *size >= 1),
        "{sizes:?}"
    );
}

//! Weights, series and dilutions of precision.

use super::*;
use crate::dop::ObservationWeights;
use crate::visibility::MaskTable;

/// A point of weight 2 is that point twice. The gain over the equal weights of the same three
/// points shows that weights count.
#[test]
fn a_weight_is_a_repetition() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let metrics = |points: &[(f64, f64)]| {
        let sites = points
            .iter()
            .map(|&(latitude, weight)| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap())
            .collect();
        let setup = Setup {
            sites,
            grid: TimeGrid::new(base.grid.epoch(), 86_400.0, 300.0).unwrap(),
            pdop_cap: 2.2,
            metrics: MetricOptions {
                availability_pdop: 1.6,
                ..base.metrics
            },
            ..base.clone()
        };
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        Evaluator::new(setup)
            .unwrap()
            .evaluate_plain(&ephemeris)
            .unwrap()
    };
    let weighted = metrics(&[(5.0, 2.0), (40.0, 1.0), (75.0, 3.0)]);
    let repeated = metrics(&[5.0, 5.0, 40.0, 75.0, 75.0, 75.0].map(|latitude| (latitude, 1.0)));
    let equal = metrics(&[5.0, 40.0, 75.0].map(|latitude| (latitude, 1.0)));
    let numbers = |m: &Metrics| {
        let pdop = [m.mean_pdop, m.cvar_pdop, m.p50_pdop, m.p95_pdop, m.p99_pdop];
        let mut all: Vec<f64> = pdop.into_iter().map(Option::unwrap).collect();
        all.extend([m.mean_visible, m.solved_fraction, m.availability]);
        all.extend([m.j_pos.unwrap(), m.j_cost.unwrap(), m.max_pdop.unwrap()]);
        all
    };
    for (ours, theirs) in numbers(&weighted).iter().zip(numbers(&repeated)) {
        // Sums in another order, of 1700 samples.
        assert!(
            (ours / theirs - 1.0).abs() < 1e-12,
            "{weighted:?} {repeated:?}"
        );
    }
    assert!((weighted.mean_visible / equal.mean_visible - 1.0).abs() > 0.01);
    let shares = [weighted.availability, weighted.solved_fraction, 1.0];
    assert!(
        shares[0] > 0.0 && shares.is_sorted_by(|a, b| a < b),
        "{shares:?}"
    );
}

/// A few points in some hours, with unsolved samples and an availability below one.
fn small(weights: [f64; 3]) -> Setup {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let site = |(latitude, weight)| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap();
    Setup {
        sites: [5.0, 40.0, 75.0]
            .into_iter()
            .zip(weights)
            .map(site)
            .collect(),
        grid: TimeGrid::new(base.grid.epoch(), 36_000.0, 300.0).unwrap(),
        gnss: vec![Preset::Gps.into()],
        pdop_cap: 2.2,
        metrics: MetricOptions {
            availability_pdop: 1.6,
            ..base.metrics
        },
        ..base
    }
}

/// The cuts of the series add up to the metrics of the whole.
#[test]
fn series_add_up_to_the_metrics() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let setup = small([1.0, 2.0, 0.5]);
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let ephemeris = Ephemeris::of_design(&design, Model::J2, setup.grid).unwrap();
    let metrics = evaluator.evaluate_plain(&ephemeris).unwrap();
    let series = evaluator.series(&ephemeris).unwrap();
    let rising = series.rising_pdop();
    let Series { epochs, points, .. } = series;
    assert_eq!((epochs.len(), points.len()), (120, 3));
    assert_eq!(
        (epochs[7].elapsed_s, points[1].latitude_deg),
        (2100.0, 40.0)
    );

    let instants = epochs.len() as f64;
    let visible = epochs.iter().map(|e| e.mean_visible).sum::<f64>() / instants;
    let solved = epochs.iter().map(|e| e.solved_fraction).sum::<f64>() / instants;
    let pdop = epochs
        .iter()
        .filter_map(|e| Some(e.mean_pdop? * e.solved_fraction));
    let mean_pdop = pdop.sum::<f64>() / instants / solved;
    // Sums in another order; values are f32.
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    let single = |a: f64, b: Option<f64>| assert!((a / b.unwrap() - 1.0).abs() < 1e-6, "{a} {b:?}");
    close(visible, metrics.mean_visible);
    close(solved, metrics.solved_fraction);
    single(mean_pdop, metrics.mean_pdop);
    let max = epochs.iter().filter_map(|e| e.max_pdop).fold(0.0, f64::max);
    single(max, metrics.max_pdop);
    let available = epochs.iter().map(|e| e.availability).sum::<f64>() / instants;
    close(available, metrics.availability);
    let least = epochs.iter().map(|e| e.least_visible).min();
    assert_eq!(least, Some(metrics.least_visible));
    let gnss = epochs.iter().map(|e| e.mean_gnss_visible).sum::<f64>() / instants;
    close(gnss, metrics.mean_gnss_visible);

    // Every solved sample is in the rising list, with the weight of its point.
    assert!(rising.windows(2).all(|pair| pair[0].value <= pair[1].value));
    single(rising.last().unwrap().value, metrics.max_pdop);
    let weight: f64 = rising.iter().map(|x| x.weight).sum();
    close(
        weight / evaluator.weights.total() as f64,
        metrics.solved_fraction,
    );
    let sum: f64 = rising.iter().map(|x| x.weight * x.value).sum();
    single(sum / weight, metrics.mean_pdop);

    let weights = [1.0, 2.0, 0.5];
    let over_points = |value: fn(&PointMetrics) -> f64| {
        let sum: f64 = points.iter().zip(weights).map(|(p, w)| w * value(p)).sum();
        sum / 3.5
    };
    close(over_points(|p| p.mean_visible), metrics.mean_visible);
    close(over_points(|p| p.solved_fraction), metrics.solved_fraction);
    close(over_points(|p| p.availability), metrics.availability);
    let pdop = over_points(|p| p.mean_pdop.unwrap() * p.solved_fraction);
    single(pdop / metrics.solved_fraction, metrics.mean_pdop);
    let max = points.iter().filter_map(|p| p.max_pdop).fold(0.0, f64::max);
    single(max, metrics.max_pdop);
    let least = points.iter().map(|p| p.least_visible).min();
    assert_eq!(least, Some(metrics.least_visible));
    close(
        over_points(|p| p.mean_total_visible),
        metrics.mean_total_visible,
    );
    let longest = points
        .iter()
        .map(|p| p.longest_outage_s)
        .fold(0.0, f64::max);
    assert_eq!(longest, metrics.longest_outage_s);
    assert!(
        points
            .iter()
            .any(|p| p.outages > 1 && p.total_outage_s > p.longest_outage_s)
    );
    close(
        over_points(|p| p.total_outage_s / 36_000.0),
        1.0 - metrics.availability,
    );
}

/// A point alone has its own metrics.
#[test]
fn a_point_of_the_series_is_an_evaluation_of_that_point() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let all = small([1.0; 3]);
    let ephemeris = Ephemeris::of_design(&design, Model::J2, all.grid).unwrap();
    let alone = Setup {
        sites: vec![all.sites[1].clone()],
        ..all.clone()
    };
    let series = Evaluator::new(all).unwrap().series(&ephemeris).unwrap();
    let evaluator = Evaluator::new(alone).unwrap();
    let metrics = evaluator.evaluate_plain(&ephemeris).unwrap();
    let point = &series.points[1];
    // Values of a series are f32.
    let apart = |a: Option<f64>, b: Option<f64>| (a.unwrap() / b.unwrap() - 1.0).abs();
    assert!(apart(point.p95_pdop, metrics.p95_pdop) < 1e-6);
    assert_eq!(point.mean_visible, metrics.mean_visible);
    assert!(apart(point.mean_pdop, metrics.mean_pdop) < 1e-7);
    assert_eq!(point.availability, metrics.availability);
    // An instant of a single point is that sample.
    let single = evaluator.series(&ephemeris).unwrap();
    assert!(single.epochs.iter().all(|e| e.mean_pdop == e.max_pdop));
    assert!(single.epochs.iter().any(|e| e.max_pdop.is_none()));
}

/// The family has the PDOP of the metrics, whoever keeps the clocks.
#[test]
fn dops_have_the_pdop_of_the_metrics() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    for (clocks, names) in [
        (Clocks::PerSystem, vec!["leo", "gps"]),
        (Clocks::Shared, vec!["shared"]),
    ] {
        let setup = Setup {
            clocks,
            ..small([1.0, 2.0, 0.5])
        };
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, setup.grid).unwrap();
        let metrics = evaluator.evaluate_plain(&ephemeris).unwrap();
        let dops = evaluator.dops_plain(&ephemeris).unwrap();
        let pdop = dops.pdop.unwrap();
        // Inverse and trace of the inverse round differently.
        assert!((pdop.mean / metrics.mean_pdop.unwrap() - 1.0).abs() < 1e-12);
        assert!((pdop.cvar / metrics.cvar_pdop.unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(dops.solved_fraction, metrics.solved_fraction);
        let systems: Vec<_> = dops
            .tdop
            .iter()
            .map(|clock| clock.system.as_str())
            .collect();
        assert_eq!(systems, names);
        assert!(dops.gdop.unwrap().mean > pdop.mean && pdop.mean > dops.hdop.unwrap().mean);
    }
}

/// A wall of 30° around the whole horizon is a mask of 30°.
#[test]
fn a_level_skyline_is_a_mask() {
    let design: Design = "delta:55:400/20/1@925".parse().unwrap();
    let open = small([1.0; 3]);
    let mask = Mask::from_degrees(30.0).unwrap();
    let masked = Setup {
        mask,
        gnss_mask: mask,
        pdop_cap: 100.0,
        ..open.clone()
    };
    let open = Setup {
        pdop_cap: 100.0,
        ..open
    };
    let ephemeris = Ephemeris::of_design(&design, Model::J2, open.grid).unwrap();
    let wall = MaskTable::new(vec![(0.0, 30.0), (360.0, 30.0)]).unwrap();
    let walled = open.clone().with_skyline(wall);
    let dops = |setup: &Setup| {
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        let metrics = evaluator.evaluate_plain(&ephemeris).unwrap();
        let dops = evaluator.dops_plain(&ephemeris).unwrap();
        (dops, metrics.mean_visible)
    };
    let (in_open, visible_in_open) = dops(&open);
    let (behind_wall, visible_behind_wall) = dops(&walled);
    assert_eq!((behind_wall.clone(), visible_behind_wall), dops(&masked));
    assert!(visible_behind_wall < visible_in_open);
    assert!(behind_wall.gdop.unwrap().mean > in_open.gdop.unwrap().mean);
}

/// Each point is seen under its own skyline, and the others under that of the setup: in every product, points together
/// give what each gives alone.
#[test]
fn each_point_has_its_own_skyline() {
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let wall = |to_deg: f64| {
        let vertices = vec![(0.0, 9.0), (90.0, to_deg), (180.0, 9.0), (360.0, 9.0)];
        MaskTable::new(vertices).unwrap()
    };
    let base = small([1.0; 3]);
    let mut together = Setup {
        pdop_cap: 100.0,
        accuracy: Some(Accuracy {
            leo: RangeError::constant(1.0),
            gnss: vec![RangeError::constant(2.0)],
        }),
        window_s: Some(600.0),
        ..base
    };
    together.sites[1].skyline = Some(Arc::new(wall(60.0)));
    let together = together.with_skyline(wall(30.0));
    let highest = |point| together.skyline_at(point).unwrap().degrees_at(90.0);
    assert_eq!([0, 1, 2].map(highest), [30.0, 60.0, 30.0]);
    assert!(together.skyline_at(3).is_none());

    let ephemeris = Ephemeris::of_design(&design, Model::J2, together.grid).unwrap();
    let of = |setup: Setup| {
        let evaluator = Evaluator::new(setup).unwrap();
        let metrics = evaluator.evaluate_plain(&ephemeris).unwrap();
        let sigma = evaluator.accuracy(&ephemeris).unwrap();
        let hdop = evaluator.dops_plain(&ephemeris).unwrap().hdop.unwrap();
        let means = [
            metrics.mean_visible,
            metrics.mean_gnss_visible,
            metrics.mean_pdop.unwrap(),
            hdop.mean,
            sigma.unwrap().sigma_3d_m.unwrap().mean,
            metrics.information_pdop.unwrap().mean.unwrap(),
        ];
        assert_eq!(metrics.solved_fraction, 1.0);
        (means, evaluator.series_plain(&ephemeris).unwrap().points)
    };
    let (means, points) = of(together.clone());
    let mut sums = [0.0; 6];
    for (site, point) in together.sites.iter().zip(points) {
        let sites = vec![site.clone()];
        let (alone, mut series) = of(Setup {
            sites,
            ..together.clone()
        });
        assert_eq!(series.pop(), Some(point));
        for (sum, mean) in sums.iter_mut().zip(alone) {
            *sum += mean / 3.0;
        }
    }
    for (mean, sum) in means.into_iter().zip(sums) {
        // Sums of 360 values in another order.
        assert!((mean / sum - 1.0).abs() < 1e-13, "{means:?} {sums:?}");
    }
}

/// Down-weighting low satellites can only lose information: every weight is at most one.
#[test]
fn sine_weights_dilute() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let setup = Setup {
        pdop_cap: 100.0,
        ..small([1.0; 3])
    };
    let ephemeris = Ephemeris::of_design(&design, Model::J2, setup.grid).unwrap();
    let dops = |observation_weights| {
        let setup = Setup {
            observation_weights,
            ..setup.clone()
        };
        let evaluator = Evaluator::new(setup).unwrap();
        let metrics = evaluator.evaluate_plain(&ephemeris).unwrap();
        let dops = evaluator.dops(&ephemeris).unwrap();
        // The kernel sums values in f32.
        let apart = dops.pdop.unwrap().mean / metrics.mean_pdop.unwrap() - 1.0;
        assert!(apart.abs() < 1e-6, "{apart:e}");
        dops
    };
    let unit = dops(ObservationWeights::Unit);
    let sine = dops(ObservationWeights::SineElevation);
    for (more, less) in [
        (sine.hdop, unit.hdop),
        (sine.vdop, unit.vdop),
        (sine.gdop, unit.gdop),
    ] {
        assert!(more.unwrap().mean > less.unwrap().mean);
    }
}

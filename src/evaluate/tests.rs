use super::*;
use crate::constellation::Pattern;
use crate::constellation::gnss::Preset;
use crate::earth::{RADIUS_KM, Surface};
use crate::ground::{Grid, Weighting};
use crate::stats::Level;
use crate::time::Epoch;

fn setup(latitude_deg: [f64; 2], surface: Surface) -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = Grid {
        latitude_deg,
        longitude_deg: [73.0, 136.0],
        step_deg: [5.0, 5.0],
        weighting: Weighting::Equal,
    };
    Setup {
        grid: TimeGrid::new(epoch, 86_400.0, 60.0).unwrap(),
        sites: grid.sites(surface).unwrap(),
        mask: Mask::from_degrees(7.0).unwrap(),
        gnss_mask: Mask::from_degrees(7.0).unwrap(),
        gnss: vec![Preset::BeiDou3.into()],
        clocks: Clocks::PerSystem,
        pdop_cap: 100.0,
        model: Model::J2,
        metrics: MetricOptions {
            cvar_weight: 0.5,
            cvar_level: Level::new(0.95).unwrap(),
            availability_pdop: 6.0,
        },
    }
}

/// Time-mean visible count of a circular constellation from one latitude of a sphere, by a
/// one-dimensional integral over the argument of latitude, without any time step: a satellite
/// at latitude δ is over the cap of half-angle ψ around a point at latitude φ for the share
/// H/π of all longitudes, with cos H = (cos ψ - sin φ sin δ) / (cos φ cos δ).
fn visible_by_quadrature(design: &Design, latitude_rad: f64, mask_rad: f64) -> f64 {
    let radius = RADIUS_KM + design.altitude_km();
    let cap = (RADIUS_KM / radius * mask_rad.cos()).acos() - mask_rad;
    let sin_i = design.inclination_deg().to_radians().sin();
    let steps = 20_000;
    let mut share = 0.0;
    for n in 0..steps {
        let u = (n as f64 + 0.5) / f64::from(steps) * std::f64::consts::TAU;
        let declination = (sin_i * u.sin()).asin();
        let cos_h = (cap.cos() - latitude_rad.sin() * declination.sin())
            / (latitude_rad.cos() * declination.cos());
        share += cos_h.clamp(-1.0, 1.0).acos() / std::f64::consts::PI;
    }
    design.satellite_count() as f64 * share / f64::from(steps)
}

/// A day does not cover all longitudes evenly, which leaves up to 0.02 of 8 satellites.
#[test]
fn validate_visible_count_by_quadrature() {
    for (text, pattern) in [
        ("delta:55:182/13/1@925", Pattern::Delta),
        ("star:90:182/13/1@925", Pattern::Star),
    ] {
        let design: Design = text.parse().unwrap();
        assert_eq!(design.pattern(), pattern);
        let setup = Setup {
            gnss: vec![],
            ..setup([3.0, 54.0], Surface::Sphere)
        };
        let mask_rad = 7_f64.to_radians();
        let expected = setup
            .sites
            .iter()
            .map(|site| visible_by_quadrature(&design, site.latitude_deg.to_radians(), mask_rad))
            .sum::<f64>()
            / setup.sites.len() as f64;
        let metrics = Evaluator::new(setup).unwrap().design(&design).unwrap();
        let apart = metrics.mean_visible - expected;
        assert!(
            apart.abs() < 0.02,
            "{text}: {} against {expected}",
            metrics.mean_visible
        );
    }
}

#[test]
fn what_is_never_seen_has_no_cost() {
    let design: Design = "delta:0:1/1/0@200".parse().unwrap();
    let evaluator = Evaluator::new(Setup {
        gnss: vec![],
        ..setup([80.0, 85.0], Surface::Wgs84)
    })
    .unwrap();
    let metrics = evaluator.design(&design).unwrap();
    assert_eq!(metrics.mean_visible, 0.0);
    assert_eq!(
        (metrics.j_cost, metrics.j_pos, metrics.max_pdop),
        (None, None, None)
    );
    assert_eq!((metrics.solved_fraction, metrics.availability), (0.0, 0.0));
}

#[test]
fn a_higher_mask_sees_less() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let at = |mask_deg: f64| {
        let mask = Mask::from_degrees(mask_deg).unwrap();
        let evaluator = Evaluator::new(Setup {
            mask,
            ..setup([3.0, 54.0], Surface::Wgs84)
        })
        .unwrap();
        evaluator.design(&design).unwrap().mean_visible
    };
    assert!(at(5.0) > at(10.0) && at(10.0) > at(40.0));
}

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
        Evaluator::new(setup).unwrap().design(&design).unwrap()
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
    let metrics = evaluator.ephemeris(&ephemeris).unwrap();
    let Series { epochs, points } = evaluator.series(&ephemeris).unwrap();
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
    // Sums in another order.
    let close = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    close(visible, metrics.mean_visible);
    close(solved, metrics.solved_fraction);
    close(mean_pdop, metrics.mean_pdop.unwrap());
    let max = epochs.iter().filter_map(|e| e.max_pdop).fold(0.0, f64::max);
    assert_eq!(Some(max), metrics.max_pdop);

    let weights = [1.0, 2.0, 0.5];
    let over_points = |value: fn(&PointMetrics) -> f64| {
        let sum: f64 = points.iter().zip(weights).map(|(p, w)| w * value(p)).sum();
        sum / 3.5
    };
    close(over_points(|p| p.mean_visible), metrics.mean_visible);
    close(over_points(|p| p.solved_fraction), metrics.solved_fraction);
    close(over_points(|p| p.availability), metrics.availability);
    let pdop = over_points(|p| p.mean_pdop.unwrap() * p.solved_fraction);
    close(pdop, metrics.mean_pdop.unwrap() * metrics.solved_fraction);
    let max = points.iter().filter_map(|p| p.max_pdop).fold(0.0, f64::max);
    assert_eq!(Some(max), metrics.max_pdop);
}

/// A point alone has its own metrics.
#[test]
fn a_point_of_the_series_is_an_evaluation_of_that_point() {
    let design: Design = "delta:55:24/6/1@925".parse().unwrap();
    let all = small([1.0; 3]);
    let ephemeris = Ephemeris::of_design(&design, Model::J2, all.grid).unwrap();
    let alone = Setup {
        sites: vec![all.sites[1]],
        ..all.clone()
    };
    let series = Evaluator::new(all).unwrap().series(&ephemeris).unwrap();
    let evaluator = Evaluator::new(alone).unwrap();
    let metrics = evaluator.ephemeris(&ephemeris).unwrap();
    let point = series.points[1];
    assert_eq!(point.p95_pdop, metrics.p95_pdop);
    assert_eq!(point.mean_visible, metrics.mean_visible);
    assert_eq!(point.mean_pdop, metrics.mean_pdop);
    assert_eq!(point.availability, metrics.availability);
    // An instant of a single point is that sample.
    let single = evaluator.series(&ephemeris).unwrap();
    assert!(single.epochs.iter().all(|e| e.mean_pdop == e.max_pdop));
    assert!(single.epochs.iter().any(|e| e.max_pdop.is_none()));
}

//! Decisions exactly at a limit: it belongs to the solved, or available, side.

use super::*;

/// Four points and an hour, with PDOP from below 2 to above 10.
fn study() -> (Setup, Design) {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let site = |latitude| Site::new(Surface::Wgs84, latitude, 100.0, 1.0).unwrap();
    let setup = Setup {
        sites: [-10.0, 5.0, 40.0, 75.0].into_iter().map(site).collect(),
        grid: TimeGrid::new(base.grid.epoch(), 3600.0, 60.0).unwrap(),
        gnss: vec![],
        clocks: Clocks::Shared,
        ..base
    };
    (setup, "delta:55:132/11/3@925".parse().unwrap())
}

/// Share of solved and of available samples by each path.
fn shares(setup: &Setup, design: &Design) -> [(f64, f64); 4] {
    let ephemeris = Ephemeris::of_design(design, setup.model, setup.grid).unwrap();
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let of_metrics = |metrics: Metrics| (metrics.solved_fraction, metrics.availability);
    let series = evaluator.series(&ephemeris).unwrap();
    let points = series.points.len() as f64;
    let mean =
        |share: fn(&PointMetrics) -> f64| series.points.iter().map(share).sum::<f64>() / points;
    let plain = of_metrics(evaluator.evaluate_plain(&ephemeris).unwrap());
    [
        plain,
        of_metrics(evaluator.evaluate(design).unwrap()),
        (
            mean(|point| point.solved_fraction),
            mean(|point| point.availability),
        ),
        (evaluator.dops(&ephemeris).unwrap().solved_fraction, plain.1),
    ]
}

/// Every solved PDOP, rising.
fn rising(setup: &Setup, design: &Design) -> Vec<f64> {
    let ephemeris = Ephemeris::of_design(design, setup.model, setup.grid).unwrap();
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let mut rising = Vec::new();
    plain::visit(&evaluator, &ephemeris, |sample| rising.extend(sample.pdop)).unwrap();
    rising.sort_unstable_by(f64::total_cmp);
    rising
}

#[test]
fn a_pdop_at_the_cap_is_solved_and_at_the_threshold_available() {
    let (setup, design) = study();
    let rising = rising(&setup, &design);
    let count = setup.sample_count() as f64;
    assert!(rising.len() > 100 && rising[0] < 2.0 && rising[rising.len() - 1] > 5.0);
    for n in [rising.len() / 10, rising.len() / 2, rising.len() - 1] {
        for (limit, within) in [(rising[n], n + 1), (rising[n].next_down(), n)] {
            let expected = within as f64 / count;
            let capped = Setup {
                pdop_cap: limit,
                ..setup.clone()
            };
            for (solved, _) in shares(&capped, &design) {
                // Sums of shares of points, of 60 instants each.
                assert!(
                    (solved - expected).abs() < 1e-12,
                    "{limit} {solved} {expected}"
                );
            }
            let mut bounded = setup.clone();
            bounded.metrics.availability_pdop = limit;
            for (_, available) in shares(&bounded, &design) {
                assert!((available - expected).abs() < 1e-12, "{limit} {available}");
            }
        }
    }
}

use super::*;
use crate::constellation::Design;
use crate::earth::Surface;
use crate::evaluate::{Metrics, Setup, testing};
use crate::ground::Site;
use crate::optimize::generator::Generator;
use crate::time::{Epoch, TimeGrid};

const DESIGN: &str = "delta:55:8/2/1@8000";

fn study() -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7200.0, 120.0).unwrap();
    let site = |latitude, weight| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap();
    let mut setup = testing::setup(
        grid,
        vec![site(-40.0, 1.0), site(10.0, 2.0), site(50.0, 1.0)],
        7.0,
    );
    // So that losses matter to it.
    let whole = Evaluator::new(setup.clone()).unwrap();
    let whole = whole.evaluate_plain(&propagated(&setup)).unwrap();
    setup.metrics.availability_pdop = whole.p95_pdop.unwrap();
    setup
}

fn propagated(setup: &Setup) -> Ephemeris {
    let design: Design = DESIGN.parse().unwrap();
    Ephemeris::of_design(&design, setup.model, setup.grid).unwrap()
}

/// The metrics in each of the 256 states of eight satellites: bit n says that satellite n is down.
fn states(evaluator: &Evaluator, ephemeris: &Ephemeris) -> Vec<Metrics> {
    let down = |state: usize| (0..8).filter(|n| state >> n & 1 == 1).collect();
    let sets: Vec<Vec<usize>> = (0..256).map(down).collect();
    evaluator.without_each(ephemeris, &sets).unwrap()
}

/// The sum over the states of the whole constellation, which is short enough here, is that over the satellites in view.
#[test]
fn validate_expectation_over_all_states() {
    let setup = study();
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let ephemeris = propagated(&setup);
    let all = states(&evaluator, &ephemeris);
    for up in [0.999, 0.95, 0.7] {
        let ours = evaluator.expected(&ephemeris, up).unwrap();
        let expectation = |of: fn(&Metrics) -> f64| -> f64 {
            let weighted = all.iter().enumerate().map(|(state, metrics)| {
                let down = state.count_ones() as i32;
                up.powi(8 - down) * (1.0 - up).powi(down) * of(metrics)
            });
            weighted.sum()
        };
        assert!(ours.neglected <= NEGLECTED);
        for (ours, expected, bound) in [
            (ours.mean_visible, expectation(|of| of.mean_visible), 1e-12),
            (
                ours.coverage.of(1).unwrap(),
                expectation(|of| of.coverage.of(1).unwrap()),
                1e-12,
            ),
            (
                ours.coverage.of(2).unwrap(),
                expectation(|of| of.coverage.of(2).unwrap()),
                1e-12,
            ),
            (
                ours.solved_fraction,
                expectation(|of| of.solved_fraction),
                NEGLECTED,
            ),
            (
                ours.availability,
                expectation(|of| of.availability),
                NEGLECTED,
            ),
            // All samples are solved, so that the mean is that of the states.
            (
                ours.mean_pdop.unwrap(),
                expectation(|of| of.mean_pdop.unwrap()),
                2.0 * NEGLECTED,
            ),
        ] {
            assert!((ours - expected).abs() <= bound, "{up}: {ours} {expected}");
        }
        assert!(ours.availability < all[0].availability);
        let (cvar, whole) = (ours.cvar_pdop.unwrap(), all[0].cvar_pdop.unwrap());
        assert!(cvar > whole * (1.0 - 3e-4), "{cvar} {whole}");
    }
    // Always up: the metrics themselves, quantiles to the width of their bucket.
    let ours = evaluator.expected(&ephemeris, 1.0).unwrap();
    assert!((ours.availability - all[0].availability).abs() < 1e-12);
    for (ours, whole) in [
        (ours.p95_pdop, all[0].p95_pdop),
        (ours.cvar_pdop, all[0].cvar_pdop),
    ] {
        assert!((ours.unwrap() / whole.unwrap() - 1.0).abs() < 1.0 / 4096.0);
    }
}

/// Satellites that fail and are repaired after exponential times are up with MTBF/(MTBF + MTTR): the share of the time that
/// the service is available agrees within five standard errors of independent spans.
#[test]
fn validate_expectation_by_simulated_failures() {
    let setup = study();
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let ephemeris = propagated(&setup);
    let all = states(&evaluator, &ephemeris);
    let (mtbf_h, mttr_h) = (900.0, 100.0);
    let ours = evaluator
        .expected(&ephemeris, mtbf_h / (mtbf_h + mttr_h))
        .unwrap();
    let mut generator = Generator::new(5, 0);
    let mut means = Vec::new();
    for _ in 0..200 {
        // Each satellite changes state at its own times over a span of two hundred repairs.
        let span_h = 20_000.0;
        let mut changes: Vec<(f64, usize)> = Vec::new();
        for satellite in 0..8 {
            let (mut at_h, mut is_up) = (0.0, true);
            while at_h < span_h {
                let mean_h = if is_up { mtbf_h } else { mttr_h };
                at_h -= mean_h * (1.0 - generator.unit()).ln();
                changes.push((at_h.min(span_h), satellite));
                is_up = !is_up;
            }
        }
        changes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut state, mut last_h, mut sum) = (0_usize, 0.0, 0.0);
        for (at_h, satellite) in changes {
            sum += (at_h - last_h) * all[state].availability;
            last_h = at_h;
            state ^= 1 << satellite;
        }
        means.push(sum / span_h);
    }
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let variance = means.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let error = (variance / count).sqrt();
    // All are up at first, which is forgotten after a repair: 0.5 % of the span.
    let bias = 0.005 * (all[0].availability - ours.availability);
    let difference = (mean - ours.availability).abs();
    assert!(
        difference < 5.0 * error + bias,
        "{mean} {} {error}",
        ours.availability
    );
}

#[test]
fn the_rest_of_the_binomial_is_told() {
    let (known, rest) = down_probabilities(8, 0.98);
    assert_eq!(known.len(), 4);
    let beyond: f64 = [4, 5, 6, 7, 8]
        .map(|n: i32| {
            let ways = [70.0, 56.0, 28.0, 8.0, 1.0][n as usize - 4];
            ways * 0.98_f64.powi(8 - n) * 0.02_f64.powi(n)
        })
        .iter()
        .sum();
    assert!((rest - beyond).abs() < 1e-15, "{rest} {beyond}");
    assert_eq!(down_probabilities(0, 0.5).0, [1.0]);
    assert_eq!(down_probabilities(3, 1.0).0, [1.0]);
}

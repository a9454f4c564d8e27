use super::*;
use crate::constellation::Design;
use crate::earth::Surface;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Evaluator, Metrics, testing};
use crate::ground::Site;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};

/// Ten slots and two spares, each up with 0.9: the binomial of twelve by hand.
#[test]
fn validate_vacancies_are_a_binomial_beyond_the_spares() {
    let planes = SparedPlanes { up: 0.9, spares: 2 };
    let ours = planes.vacancy_probabilities(10);
    assert_eq!(ours.len(), 11);
    let of = |down: i32, ways: f64| ways * 0.9_f64.powi(12 - down) * 0.1_f64.powi(down);
    let expected = [
        of(0, 1.0) + of(1, 12.0) + of(2, 66.0),
        of(3, 220.0),
        of(4, 495.0),
    ];
    for (ours, expected) in ours.iter().zip(expected) {
        // The logarithms of factorials of 12 keep 14 digits.
        assert!((ours - expected).abs() < 1e-14, "{ours} {expected}");
    }
    assert!((ours.iter().sum::<f64>() - 1.0).abs() < 1e-13);
    // Without spares the mean is that of the binomial.
    let bare = SparedPlanes {
        up: 0.97,
        spares: 0,
    };
    assert!((bare.mean_vacancies(14) - 14.0 * 0.03).abs() < 1e-13);
    let always = SparedPlanes { up: 1.0, spares: 0 };
    assert_eq!(always.vacancy_probabilities(3), [1.0, 0.0, 0.0, 0.0]);
    assert!(
        always
            .draws(&[vec![0, 1, 2]], 5, 1)
            .iter()
            .all(Vec::is_empty)
    );
}

/// The numbers of vacancies are those of the distribution to one draw, and all slots are as likely: within five standard
/// deviations of a binomial.
#[test]
fn validate_draws_are_stratified_and_uniform() {
    let planes = SparedPlanes { up: 0.8, spares: 1 };
    let slots = [vec![0, 1, 2, 3], vec![4, 5, 6, 7]];
    let draws = planes.draws(&slots, 4000, 3);
    assert_eq!(draws, planes.draws(&slots, 4000, 3));
    assert_ne!(draws, planes.draws(&slots, 4000, 4));
    for own in &slots {
        let vacant = |draw: &Vec<usize>| draw.iter().filter(|place| own.contains(place)).count();
        for (number, probability) in planes.vacancy_probabilities(4).into_iter().enumerate() {
            let found = draws.iter().filter(|draw| vacant(draw) == number).count();
            // Each of the two bounds of a number may fall within a part.
            assert!(
                (found as f64 - 4000.0 * probability).abs() < 2.0,
                "{number}: {found}"
            );
        }
        let all: usize = draws.iter().map(vacant).sum();
        let share = 0.25 * all as f64;
        for place in own {
            let found = draws.iter().filter(|draw| draw.contains(place)).count() as f64;
            assert!(
                (found - share).abs() < 5.0 * (0.75 * share).sqrt(),
                "{place}: {found} {share}"
            );
        }
    }
}

fn study() -> (Evaluator, Ephemeris) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7200.0, 240.0).unwrap();
    let site = |latitude| Site::new(Surface::Wgs84, latitude, 100.0, 1.0).unwrap();
    let mut setup = testing::setup(grid, vec![site(-40.0), site(10.0), site(50.0)], 7.0);
    let design: Design = "delta:55:8/2/1@8000".parse().unwrap();
    let ephemeris = || Ephemeris::of_design(&design, Model::J2, grid).unwrap();
    // So that losses matter to it.
    let whole = Evaluator::new(setup.clone()).unwrap();
    setup.metrics.availability_pdop = whole
        .evaluate_plain(&ephemeris())
        .unwrap()
        .p50_pdop
        .unwrap();
    (Evaluator::new(setup).unwrap(), ephemeris())
}

/// The metrics in each of the 256 states of eight slots: bit n says that slot n is vacant.
fn states(evaluator: &Evaluator, ephemeris: &Ephemeris) -> Vec<Metrics> {
    let vacant = |state: usize| (0..8).filter(|n| state >> n & 1 == 1).collect();
    let sets: Vec<Vec<usize>> = (0..256).map(vacant).collect();
    evaluator.without_each(ephemeris, &sets).unwrap()
}

const PLANES: [[usize; 4]; 2] = [[0, 1, 2, 3], [4, 5, 6, 7]];

/// The draws against the sum over all states of the vacancies' closed distribution, in which all slots are as likely.
#[test]
fn validate_draws_against_all_states() {
    let (evaluator, ephemeris) = study();
    let all = states(&evaluator, &ephemeris);
    let planes = SparedPlanes {
        up: 0.85,
        spares: 1,
    };
    let probabilities = planes.vacancy_probabilities(4);
    let ways = [1.0, 4.0, 6.0, 4.0, 1.0];
    let exact = |of: fn(&Metrics) -> f64| -> f64 {
        let weighted = all.iter().enumerate().map(|(state, metrics)| {
            let vacant = [state & 15, state >> 4].map(|bits| bits.count_ones() as usize);
            let each = vacant.map(|n| probabilities[n] / ways[n]);
            each[0] * each[1] * of(metrics)
        });
        weighted.sum()
    };
    let slots = PLANES.map(|plane| plane.to_vec());
    let draws = planes.draws(&slots, 2000, 1);
    let ours = evaluator
        .expected_over(&ephemeris, planes.up, &draws)
        .unwrap();
    // In closed form: each slot is vacant with the same probability.
    let visible = all[0].mean_visible * (1.0 - planes.mean_vacancies(4) / 4.0);
    assert!((exact(|of| of.mean_visible) / visible - 1.0).abs() < 1e-12);
    let error = ours.draws.unwrap().availability_standard_error;
    assert!(error > 0.0 && error < 0.01, "{error}");
    let difference = (ours.availability - exact(|of| of.availability)).abs();
    assert!(difference < 5.0 * error, "{difference} {error}");
    // The spread of the mean visible is that of single draws, at most 8 of them, over the root of their number.
    assert!((ours.mean_visible - visible).abs() < 5.0 * all[0].mean_visible / 2000_f64.sqrt());
    assert!(
        (ours.coverage.of(1).unwrap() - exact(|of| of.coverage.of(1).unwrap())).abs()
            < 5.0 * error.max(1e-3)
    );
}

/// The pooled distribution of two states is that of their samples together.
#[test]
fn quantiles_are_of_the_mixture() {
    let (evaluator, ephemeris) = study();
    let all = states(&evaluator, &ephemeris);
    let ours = evaluator
        .expected_over(&ephemeris, 1.0, &[vec![], vec![]])
        .unwrap();
    for (ours, whole) in [
        (ours.p95_pdop, all[0].p95_pdop),
        (ours.cvar_pdop, all[0].cvar_pdop),
    ] {
        // Buckets are 1/4096 wide.
        assert!((ours.unwrap() / whole.unwrap() - 1.0).abs() < 1.0 / 4096.0);
    }
    let mixed = evaluator
        .expected_over(&ephemeris, 1.0, &[vec![], (0..8).collect()])
        .unwrap();
    let both = [all[0], all[255]].map(|one| one.p95_pdop.unwrap());
    let (low, high) = (both[0].min(both[1]), both[0].max(both[1]));
    let p95 = mixed.p95_pdop.unwrap();
    let width = 1.0 / 4096.0;
    assert!(low < high, "the loss does not matter");
    assert!(p95 > low * (1.0 - width) && p95 < high * (1.0 + width));
    let mean = (all[0].mean_pdop.unwrap() * all[0].solved_fraction
        + all[255].mean_pdop.unwrap() * all[255].solved_fraction)
        / (all[0].solved_fraction + all[255].solved_fraction);
    assert!((mixed.mean_pdop.unwrap() / mean - 1.0).abs() < 1e-12);
}

/// Satellites fail and are repaired after exponential times; a spare that is up takes a vacant slot at once. The share of the
/// time that the service is available agrees with the draws within five standard errors of both.
#[test]
fn validate_spares_by_simulated_failures() {
    let (evaluator, ephemeris) = study();
    let all = states(&evaluator, &ephemeris);
    let (mtbf_h, mttr_h, spares) = (850.0, 150.0, 1);
    let planes = SparedPlanes { up: 0.85, spares };
    let slots = PLANES.map(|plane| plane.to_vec());
    let draws = planes.draws(&slots, 2000, 1);
    let ours = evaluator
        .expected_over(&ephemeris, planes.up, &draws)
        .unwrap();
    let mut generator = Generator::new(11, 0);
    let means: Vec<f64> = (0..200)
        .map(|_| simulated(&all, (mtbf_h, mttr_h), spares as usize, &mut generator))
        .collect();
    let count = means.len() as f64;
    let mean = means.iter().sum::<f64>() / count;
    let variance = means.iter().map(|one| (one - mean).powi(2)).sum::<f64>() / (count - 1.0);
    let of_draws = ours.draws.unwrap().availability_standard_error;
    let error = (variance / count + of_draws * of_draws).sqrt();
    // All are up at first, which is forgotten after a repair: 0.75 % of the span.
    let bias = 0.0075 * (all[0].availability - ours.availability);
    let difference = (mean - ours.availability).abs();
    assert!(
        difference < 5.0 * error + bias,
        "{mean} {} {error}",
        ours.availability
    );
    // Spares matter: without them the availability is lower by many of these errors.
    let bare = SparedPlanes {
        up: 0.85,
        spares: 0,
    };
    let bare = evaluator
        .expected_over(&ephemeris, 0.85, &bare.draws(&slots, 2000, 1))
        .unwrap();
    assert!(ours.availability - bare.availability > 10.0 * error);
}

/// The mean availability over a span of 20 000 h.
fn simulated(
    all: &[Metrics],
    (mtbf_h, mttr_h): (f64, f64),
    spares: usize,
    generator: &mut Generator,
) -> f64 {
    const SPAN_H: f64 = 20_000.0;
    let mut changes: Vec<(f64, usize)> = Vec::new();
    for satellite in 0..2 * (4 + spares) {
        let (mut at_h, mut is_up) = (0.0, true);
        while at_h < SPAN_H {
            at_h -= if is_up { mtbf_h } else { mttr_h } * (1.0 - generator.unit()).ln();
            changes.push((at_h.min(SPAN_H), satellite));
            is_up = !is_up;
        }
    }
    changes.sort_by(|a, b| a.0.total_cmp(&b.0));
    // The satellite in each slot, and the spares that are up, plane by plane.
    let mut in_slot: [Option<usize>; 8] =
        std::array::from_fn(|slot| Some(slot / 4 * (4 + spares) + slot % 4));
    let idle_at_first =
        |plane: usize| (plane * (4 + spares) + 4..(plane + 1) * (4 + spares)).collect();
    let mut idle: [Vec<usize>; 2] = std::array::from_fn(idle_at_first);
    let mut is_up = vec![true; 2 * (4 + spares)];
    let (mut last_h, mut sum) = (0.0, 0.0);
    for (at_h, satellite) in changes {
        let vacant = |slot: usize| usize::from(in_slot[slot].is_none()) << slot;
        let state: usize = (0..8).map(vacant).sum();
        sum += (at_h - last_h) * all[state].availability;
        last_h = at_h;
        let plane = satellite / (4 + spares);
        is_up[satellite] = !is_up[satellite];
        if is_up[satellite] {
            let slots = 4 * plane..4 * plane + 4;
            let vacant: Vec<usize> = slots.filter(|slot| in_slot[*slot].is_none()).collect();
            match vacant.as_slice() {
                [] => idle[plane].push(satellite),
                slots => in_slot[slots[generator.below(slots.len())]] = Some(satellite),
            }
        } else if let Some(slot) = in_slot.iter().position(|one| *one == Some(satellite)) {
            in_slot[slot] = idle[plane].pop();
        } else {
            idle[plane].retain(|one| *one != satellite);
        }
    }
    sum / SPAN_H
}

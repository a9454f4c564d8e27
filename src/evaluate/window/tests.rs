use super::*;
use crate::constellation::Design;
use crate::constellation::gnss::Preset;
use crate::earth::Surface;
use crate::evaluate::{Setup, testing};
use crate::ground::Site;
use crate::time::{Epoch, TimeGrid};
use proptest::prelude::*;
use testing::{design_matrix, observed};

fn study() -> (Setup, Ephemeris) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 2400.0, 120.0).unwrap();
    let site = |latitude, weight| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap();
    let setup = testing::setup(grid, vec![site(-30.0, 1.0), site(45.0, 2.0)], 10.0)
        .with_gnss(vec![Preset::Gps.into()]);
    let design: Design = "delta:55:72/8/3@925".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, setup.model, grid).unwrap();
    (setup, ephemeris)
}

fn information(setup: Setup, ephemeris: &Ephemeris) -> InformationPdop {
    let evaluator = Evaluator::new(setup).unwrap();
    evaluator.information_pdop(ephemeris).unwrap().unwrap()
}

/// Least squares of all observations of each window at once: one position, and a clock of each system at each instant.
#[test]
fn validate_against_stacked_least_squares() {
    let (setup, ephemeris) = study();
    let (per_window, steps) = (4, setup.grid.len());
    let (mut sum, mut total) = (0.0, 0.0);
    for site in &setup.sites {
        for first in 0..=steps - per_window {
            let mut all = Vec::new();
            let mut clocks = Vec::new();
            for k in first..first + per_window {
                let found = observed(&setup, &ephemeris, site, setup.grid.elapsed_s(k));
                clocks.extend(found.iter().map(|one| 10 * k + one.system));
                all.extend(found);
            }
            let rows = design_matrix(&all.iter().collect::<Vec<_>>(), &clocks);
            let cofactors = (rows.transpose() * rows).try_inverse().unwrap();
            let trace: f64 = (0..3).map(|axis| cofactors[(axis, axis)]).sum();
            sum += site.weight * trace.sqrt();
            total += site.weight;
        }
    }
    let found = information(setup.with_window_s(480.0), &ephemeris);
    assert_eq!(found.solved_fraction, 1.0);
    let mean = found.mean.unwrap();
    // Ten digits are left by the inversion of a matrix of eleven clocks.
    assert!(
        (mean * total / sum - 1.0).abs() < 1e-10,
        "{mean} {}",
        sum / total
    );
}

/// A window of one instant has the PDOP of that instant, and one of the whole span is one for each point.
#[test]
fn the_shortest_and_the_longest_window() {
    let (setup, ephemeris) = study();
    let metrics = Evaluator::new(setup.clone()).unwrap();
    let metrics = metrics.evaluate_plain(&ephemeris).unwrap();
    for window_s in [1.0, 120.0] {
        let setup = setup.clone().with_window_s(window_s);
        let one = Evaluator::new(setup.clone()).unwrap();
        let one = one.information_pdop_plain(&ephemeris).unwrap();
        assert_eq!((one.mean, one.p95), (metrics.mean_pdop, metrics.p95_pdop));
        assert_eq!(
            (one.cvar, one.solved_fraction),
            (metrics.cvar_pdop, metrics.solved_fraction)
        );
        let by_lanes = information(setup, &ephemeris);
        assert_eq!(by_lanes.solved_fraction, one.solved_fraction);
        for (ours, theirs) in [(by_lanes.mean, one.mean), (by_lanes.cvar, one.cvar)] {
            // Lines of sight are good to 2e-14.
            assert!((ours.unwrap() / theirs.unwrap() - 1.0).abs() < 1e-12);
        }
    }
    let whole = information(setup.clone().with_window_s(2400.0), &ephemeris);
    // The mean of two values with weights 1 and 2 is below the larger one, which is the 95 % quantile.
    assert!(
        whole.mean < whole.p95 && whole.p95 == whole.cvar,
        "{whole:?}"
    );
    let beyond = information(setup.with_window_s(2401.0), &ephemeris);
    assert_eq!((beyond.mean, beyond.solved_fraction), (None, 0.0));
}

#[test]
fn a_window_ends_before_its_last_instant() {
    for (window_s, count) in [(600.0, 10), (601.0, 11), (59.0, 1), (60.0, 1), (60.001, 2)] {
        assert_eq!(instants(window_s, 60.0), count, "{window_s}");
    }
    assert_eq!(instants(6.0 * 0.1, 0.1), 6);
}

proptest! {
    /// Clocks are counts, so that sums show which instants are in them.
    #[test]
    fn sums_slide(count in 1..12_usize, length in 0..60_usize) {
        let mut sums = SlidingSum::default();
        let one = |k: usize| {
            let mut geometry = Geometry::default();
            for _ in 0..k {
                let mut group = crate::dop::ClockGroup::default();
                group.add(nalgebra::Vector3::z(), 1.0);
                geometry.add(&group);
            }
            geometry
        };
        for k in 0..length {
            let expected = (k + 1 >= count).then(|| one((k + 1 - count..=k).sum()));
            prop_assert_eq!(sums.push(one(k), count), expected);
        }
    }
}

//! One evaluation in tiles of time.

use super::*;
use crate::evaluate::{TileCounts, TileError, ViewHistograms, testing};
use std::io;

/// Seventeen points of unequal weight, six hours by ten minutes, in which PDOP is now and then unsolved.
fn study() -> (Setup, Ephemeris) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 6.0 * 3600.0, 600.0).unwrap();
    let site = |n: u32| {
        let latitude_deg = -70.0 + 9.0 * f64::from(n);
        let weight = 1.0 + f64::from(n * n % 7);
        Site::new(Surface::Wgs84, latitude_deg, 11.0 * f64::from(n), weight).unwrap()
    };
    let mut setup = testing::setup(grid, (0..17).map(site).collect(), 25.0);
    setup.metrics.availability_pdop = 3.0;
    let design: Design = "delta:55:60/6/1@925".parse().unwrap();
    let leo = Ephemeris::of_design(&design, setup.model, grid).unwrap();
    (setup, leo)
}

/// Memory for all values, or for none, as in an evaluation too large to keep them.
fn evaluator(setup: &Setup, keeps: bool) -> Evaluator {
    let mut made = Evaluator::new(setup.clone()).unwrap();
    if !keeps {
        let keep = Keep {
            values: 0,
            fixed_bytes: 0,
        };
        let (setup, rotations) = (Arc::clone(&made.setup), Arc::clone(&made.rotations));
        let instructions = InstructionSet::detect();
        made.kernel =
            Kernel::keeping_at_most(keep, setup, &made.weights, rotations, instructions).unwrap();
    }
    made
}

/// Evaluates the instants between cuts each on its own, and merges.
fn in_tiles(
    (setup, keeps): (&Setup, bool),
    ephemeris: &Ephemeris,
    cuts: &[usize],
) -> Result<(TileCounts, Vec<u8>), TileError> {
    let mut values = Vec::new();
    let mut counts = TileCounts::default();
    for ends in cuts.windows(2) {
        // A machine of its own.
        let worker = evaluator(setup, keeps);
        counts.merge(&worker.evaluate_tile(ephemeris, ends[0]..ends[1], &mut values)?);
    }
    Ok((counts, values))
}

fn merged(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
    (counts, values): &(TileCounts, Vec<u8>),
) -> Result<(Metrics, ViewHistograms), TileError> {
    let each = evaluator.bytes_of_instant();
    evaluator.merge_tiles(ephemeris, counts.clone(), &mut |instant, to| {
        let from = values.get(instant * each..instant * each + to.len());
        to.copy_from_slice(from.ok_or(io::ErrorKind::UnexpectedEof)?);
        Ok(())
    })
}

/// Whatever the cuts, and whether the values of the whole are kept or not: every metric and histogram, of the constellation and
/// of the GNSS alone, has the bits of the whole.
#[test]
fn tiles_have_the_bits_of_the_whole() {
    let (setup, leo) = study();
    let setup = setup.with_leo_clocks(LeoClocks::PerPart);
    let parts = (0..60).map(|n| n / 40).collect();
    let clocks = Ephemeris::new(setup.grid, study().1.into_satellites()).with_parts(parts);
    let none = Ephemeris::new(setup.grid, Vec::new());
    for (keeps, leo) in [(true, &leo), (false, &leo), (true, &clocks)] {
        let whole = evaluator(&setup, keeps);
        let expected = [&none, leo].map(|one| whole.evaluate_views(one).unwrap());
        let metrics = expected[1].0;
        assert!(metrics.solved_fraction < 1.0 && metrics.availability > 0.1);
        assert!(metrics.longest_outage_s > 1200.0);
        for cuts in [vec![0, 36], vec![0, 1, 2, 20, 36], (0..=36).collect()] {
            let joined = evaluator(&setup, keeps);
            let found = [&none, leo].map(|one| {
                let tiles = in_tiles((&setup, keeps), one, &cuts).unwrap();
                merged(&joined, one, &tiles).unwrap()
            });
            assert_eq!(found, expected, "{keeps} {cuts:?}");
        }
    }
}

/// What is not computed from the values is refused, as are counts and values of other samples.
#[test]
fn what_is_not_of_these_samples_is_refused() {
    let (setup, leo) = study();
    let own = in_tiles((&setup, true), &leo, &[0, 36]).unwrap();
    let whole = evaluator(&setup, true);
    let refused = |tiles: &(TileCounts, Vec<u8>)| merged(&whole, &leo, tiles).unwrap_err();
    let few = in_tiles((&setup, true), &leo, &[0, 35]).unwrap();
    assert!(matches!(refused(&few), TileError::Counts));
    let short = (own.0.clone(), few.1);
    assert!(matches!(refused(&short), TileError::Io(_)));
    for wrong in [f32::NAN, -1.0, 0.0, 1e30] {
        let mut values = own.1.clone();
        values[..4].copy_from_slice(&wrong.to_le_bytes());
        let error = refused(&(own.0.clone(), values)).to_string();
        assert!(error.contains("not that of a sample"), "{error}");
    }
    let windowed = setup.with_window_s(1200.0);
    let error = in_tiles((&windowed, true), &leo, &[0, 36]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "an evaluation with the PDOP of windows cannot be cut into tiles"
    );
}

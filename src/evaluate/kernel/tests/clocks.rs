//! LEO satellites with several clocks.

use super::super::clocks::ClockBlock;
use super::decisions::HYBRID;
use super::*;

fn blocks(clocks: &[usize]) -> Vec<(u32, Vec<u32>)> {
    let blocks = ClockBlock::of(clocks).into_iter();
    blocks
        .map(|block| (block.clock, block.satellites))
        .collect()
}

/// A block has satellites of one clock, in the order of the ephemeris, and each satellite is in one block.
#[test]
fn blocks_have_one_clock() {
    assert_eq!(blocks(&[]), []);
    let expected = [(0, vec![0, 2]), (2, vec![3]), (3, vec![1, 4])];
    assert_eq!(blocks(&[0, 3, 0, 2, 3]), expected);
    let many: Vec<usize> = (0..200).map(|n| n % 2).collect();
    let sizes: Vec<_> = blocks(&many)
        .iter()
        .map(|(c, all)| (*c, all.len()))
        .collect();
    assert_eq!(sizes, [(0, 64), (0, 36), (1, 64), (1, 36)]);
}

/// A day with a clock for each shell, and with one for every second satellite of them, in which satellites of a clock are
/// not neighbours; metrics, series and dilutions.
#[test]
fn a_day_with_several_clocks_equals_the_plain_path() {
    let design: Design = HYBRID.parse().unwrap();
    let setup = setup([3.0, 54.0], Surface::Wgs84).with_leo_clocks(LeoClocks::PerPart);
    let shells = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let satellites = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let apart = Ephemeris::new(setup.grid, satellites.into_satellites())
        .with_parts((0..182).map(|n| n % 3).collect());
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    let mut means = Vec::new();
    for ephemeris in [shells, apart] {
        let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
        let fast = evaluator.evaluate_ephemeris(&ephemeris).unwrap();
        compare(&fast, &plain).unwrap();
        means.push(fast.mean_pdop.unwrap());
        let dops = evaluator.dops(&ephemeris).unwrap();
        compare_dops(&dops, &evaluator.dops_plain(&ephemeris).unwrap(), 1e-6).unwrap();
    }
    let shared = setup.with_leo_clocks(LeoClocks::Shared);
    let shared = Evaluator::new(shared).unwrap().evaluate(&design).unwrap();
    means.push(shared.mean_pdop.unwrap());
    assert!(
        means[0] > means[2] + 0.01 && means[1] > means[0],
        "{means:?}"
    );
}

/// Satellites at the mask and values beyond f32: what the lanes leave open is decided with the clocks of the plain path.
#[test]
fn what_is_left_open_has_several_clocks() {
    let mut setup = setup([3.0, 54.0], Surface::Wgs84).with_leo_clocks(LeoClocks::PerPart);
    setup.gnss = Vec::new();
    setup.pdop_cap = 30.0;
    let design: Design = "delta:50:44/11/3@420+star:87:66/6/1@780".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let evaluator = Evaluator::new(setup).unwrap();
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    let (fast, rechecks) = evaluator.evaluate_counted(&design).unwrap();
    compare(&fast, &plain).unwrap();
    assert!(
        rechecks.near_mask > 0 && rechecks.large_pdop > 0,
        "{rechecks:?}"
    );
    assert!((0.01..0.99).contains(&fast.solved_fraction));
}

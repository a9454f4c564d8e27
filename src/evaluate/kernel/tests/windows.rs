//! The PDOP of windows.

use super::*;
use crate::evaluate::InformationPdop;
use crate::evaluate::kernel::WindowPdop;

/// Verdicts are the same, and PDOP to what the condition of a solved window, 40 PDOP² at PDOP 100, makes of lines of sight
/// that are good to 2e-14.
fn compare_windows(fast: &InformationPdop, plain: &InformationPdop) -> Result<(), TestCaseError> {
    prop_assert_eq!(fast.solved_fraction, plain.solved_fraction);
    for (ours, theirs) in [
        (fast.mean, plain.mean),
        (fast.p95, plain.p95),
        (fast.cvar, plain.cvar),
    ] {
        let apart = relative(ours, theirs);
        prop_assert!(apart < 1e-8, "{ours:?} {theirs:?}");
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    /// The lanes equal the plain path, and are identical to the bit on all instruction sets.
    #[test]
    fn windows_equal_the_plain_path(
        design in designs(),
        setup in setups(),
        window_s in prop_oneof![1.0..97.0_f64, 97.0..1500.0, 3000.0..4000.0],
    ) {
        let setup = setup.with_window_s(window_s);
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let [first, others @ ..] = InstructionSet::ALL
            .map(|set| Evaluator::with_instructions(setup.clone(), set).unwrap());
        let fast = first.information_pdop(&ephemeris).unwrap();
        compare_windows(&fast.unwrap(), &first.information_pdop_plain(&ephemeris).unwrap())?;
        for other in others {
            prop_assert_eq!(other.information_pdop(&ephemeris).unwrap(), fast);
        }
    }
}

/// Of two satellites at rest no window has three dimensions, however long: the lanes leave it open, and the plain path
/// decides. Of moving ones hardly a window is left open.
#[test]
fn only_singular_windows_are_left_open() {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let setup = Setup {
        grid: TimeGrid::new(base.grid.epoch(), 3600.0, 60.0).unwrap(),
        gnss: Vec::new(),
        ..base
    };
    let open = |setup: &Setup, ephemeris: &Ephemeris| {
        let evaluator = Evaluator::new(setup.clone()).unwrap();
        let (mut open, mut all) = (0, 0);
        let count = |points: &[WindowPdop]| {
            open += points
                .iter()
                .filter(|one| **one == WindowPdop::Open)
                .count();
            all += points.len();
        };
        evaluator.kernel.windows(ephemeris, 10, count).unwrap();
        (open, all)
    };
    let pair = decisions::planted_pair(&setup);
    let (left, all) = open(&setup, &pair);
    assert!(left > 100 && all == 143 * 51, "{left}");
    let evaluator = Evaluator::new(setup.clone().with_window_s(600.0)).unwrap();
    let fast = evaluator.information_pdop(&pair).unwrap().unwrap();
    compare_windows(&fast, &evaluator.information_pdop_plain(&pair).unwrap()).unwrap();
    assert_eq!(fast.solved_fraction, 0.0);
    let design: Design = "delta:55:40/5/1@925".parse().unwrap();
    let moving = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    assert_eq!(open(&setup, &moving).0, 0);
}

/// Satellites within some units in the last place of the mask, whose decisions turn with the order of a sum, and which change
/// PDOP by far more than its tolerance.
#[test]
fn windows_at_the_mask_are_those_of_the_plain_path() {
    let setup = decisions::short_setup().with_window_s(180.0);
    let elevation_deg = |n: usize| 7.0 + (n % 7) as f64 * 1e-14 - 3e-14;
    let ephemeris = decisions::planted(&setup, |n| (57.0 * n as f64, elevation_deg(n)));
    let evaluator = Evaluator::new(setup).unwrap();
    let fast = evaluator.information_pdop(&ephemeris).unwrap().unwrap();
    compare_windows(
        &fast,
        &evaluator.information_pdop_plain(&ephemeris).unwrap(),
    )
    .unwrap();
}

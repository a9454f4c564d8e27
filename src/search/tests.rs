mod hybrids;

use super::testing::shell;
use super::*;
use crate::evaluate::testing::no_metrics;

fn goals(fixed: Option<&str>) -> Goals {
    Goals {
        objectives: Vec::new(),
        constraints: Vec::new(),
        launch_cost: LaunchCost {
            per_satellite: 2.0,
            per_plane: 7.0,
            per_1000_km: 0.3,
        },
        fixed: fixed.map(|notation| notation.parse().unwrap()),
        fixed_from_files: 0,
    }
}

/// The sum over the shells, each at its own altitude.
#[test]
fn validate_launch_cost_by_hand() {
    let cost = |notation: &str| {
        let design: Design = notation.parse().unwrap();
        let satellites = CountedSatellites::of_design(&design);
        goals(None).value(Quantity::LaunchCost, satellites, &no_metrics())
    };
    // 2 * 100 * (1 + 0.3 * 0.5) + 7 * 5.
    let one = cost("delta:50:100/5/1@500").unwrap();
    assert!((one - 265.0).abs() < 1e-12);
    // And 2 * 30 * (1 + 0.3 * 1.2) + 7 * 3.
    let two = cost("delta:50:100/5/1@500+star:90:30/3/1@1200").unwrap();
    assert!((two - 265.0 - 102.6).abs() < 1e-12);
}

/// What is fixed is not new, if the whole of it is there.
#[test]
fn new_is_what_is_not_fixed() {
    const FIXED: &str = "star:86.4:66/6/3@780,node-step=31.6+delta:50:4/2/1@600";
    let values = |goals: &Goals, notation: &str| {
        let design: Design = notation.parse().unwrap();
        let satellites = CountedSatellites::of_design(&design);
        let value = |quantity| goals.value(quantity, satellites, &no_metrics());
        [
            Quantity::Satellites,
            Quantity::Planes,
            Quantity::NewSatellites,
            Quantity::NewPlanes,
            Quantity::LaunchCost,
        ]
        .map(|quantity| value(quantity).unwrap())
    };
    let new = "delta:50:100/5/1@500";
    let with_fixed = format!("{new}+{FIXED}");
    let cost = 2.0 * 100.0 * 1.15 + 35.0;
    let fixed = goals(Some(FIXED));
    assert_eq!(values(&fixed, &with_fixed), [170.0, 13.0, 100.0, 5.0, cost]);
    assert_eq!(values(&fixed, FIXED), [70.0, 8.0, 0.0, 0.0, 0.0]);
    assert_eq!(values(&fixed, new), [100.0, 5.0, 100.0, 5.0, cost]);
    let all_new = values(&goals(None), &with_fixed);
    assert_eq!(all_new[..4], [170.0, 13.0, 170.0, 13.0]);
    assert!(all_new[4] > cost);
    // Satellites of files are new and in no planes.
    let of_file = CountedSatellites {
        from_files: 12,
        ..CountedSatellites::default()
    };
    let of_file = |quantity| fixed.value(quantity, of_file, &no_metrics());
    assert_eq!(of_file(Quantity::NewSatellites), Some(12.0));
    assert_eq!(of_file(Quantity::NewPlanes), None);
    assert_eq!(of_file(Quantity::LaunchCost), None);
}

/// Satellites of files that are fixed are not new, where all that is fixed is there; others are, and have no planes.
#[test]
fn new_is_what_is_in_no_fixed_file() {
    const FIXED: &str = "delta:50:4/2/1@600";
    let goals = Goals {
        fixed_from_files: 12,
        ..goals(Some(FIXED))
    };
    let both: Design = format!("delta:50:100/5/1@500+{FIXED}").parse().unwrap();
    let shell: Design = FIXED.parse().unwrap();
    let values = |shells, from_files, has_fixed_files| {
        let satellites = CountedSatellites {
            shells,
            from_files,
            has_fixed_files,
        };
        [
            Quantity::Satellites,
            Quantity::Planes,
            Quantity::NewSatellites,
            Quantity::NewPlanes,
        ]
        .map(|quantity| goals.value(quantity, satellites, &no_metrics()))
    };
    let some = |values: [f64; 4]| values.map(Some);
    // What is fixed, by itself.
    assert_eq!(values(Some(&shell), 12, true), some([16.0, 2.0, 0.0, 0.0]));
    assert_eq!(
        values(Some(&both), 12, true),
        some([116.0, 7.0, 100.0, 5.0])
    );
    // Without its files, without its shells, and with further satellites from files.
    assert_eq!(values(Some(&shell), 0, false), some([4.0, 2.0, 4.0, 2.0]));
    assert_eq!(values(None, 12, true), [Some(12.0), None, Some(12.0), None]);
    assert_eq!(
        values(Some(&shell), 15, true),
        [Some(19.0), None, Some(3.0), None]
    );
    let none = values(None, 0, false);
    assert_eq!(none, [Some(0.0), None, Some(0.0), None]);
}

#[test]
fn constraints_measure_how_far() {
    let at_most = Constraint {
        quantity: Quantity::MaxPdop,
        relation: Relation::AtMost,
        bound: 2.0,
    };
    assert_eq!(at_most.violation(Some(1.0), 1.0), 0.0);
    assert_eq!(at_most.violation(Some(2.0), 1.0), 0.0);
    assert!(at_most.violation(Some(2.0_f64.next_up()), 1.0) > 0.0);
    assert_eq!(at_most.violation(Some(3.0), 1.0), 0.5);
    assert_eq!(at_most.violation(None, 0.0), 1.0);
    let at_least = Constraint {
        quantity: Quantity::Availability,
        relation: Relation::AtLeast,
        bound: 0.75,
    };
    assert_eq!(at_least.violation(Some(0.75), 1.0), 0.0);
    assert!(at_least.violation(Some(0.75_f64.next_down()), 1.0) > 0.0);
    // A fraction of all samples, which already includes the unsolved ones.
    assert_eq!(at_least.violation(Some(0.5), 0.5), 0.25);
    let cost: Constraint = "j-cost <= 10".parse().unwrap();
    assert_eq!(cost.violation(None, 1.0), 1.0);
}

/// PDOP counts as infinite in an unsolved sample: one is too many for a mean, a tail or a maximum, and
/// a fraction above 1 - q for a quantile of level q.
#[test]
fn unsolved_samples_violate_what_they_would_make_infinite() {
    let violation = |text: &str, value, solved| {
        let constraint: Constraint = text.parse().unwrap();
        constraint.violation(Some(value), solved)
    };
    let one_of_a_million = 1.0 - 1e-6;
    for quantity in ["mean-pdop", "cvar-pdop", "max-pdop", "j-pos"] {
        let text = format!("{quantity} <= 20");
        assert_eq!(violation(&text, 2.0, 1.0), 0.0);
        assert_eq!(
            violation(&text, 2.0, one_of_a_million),
            1.0 - one_of_a_million
        );
        // The excess of the solved samples is added.
        assert_eq!(violation(&text, 30.0, 0.75), 0.5 + 0.25);
    }
    for (quantity, level) in [("p95-pdop", 0.95), ("p99-pdop", 0.99), ("p95-hdop", 0.95)] {
        let text = format!("{quantity} <= 20");
        assert_eq!(violation(&text, 2.0, level), 0.0);
        assert_eq!(violation(&text, 30.0, level), 0.5);
        let fewer = level - 1e-6;
        assert_eq!(violation(&text, 2.0, fewer), 1.0 - fewer);
    }
    for quantity in [
        "satellites",
        "mean-visible",
        "availability",
        "j-cost",
        "least-visible",
        "coverage-4",
        "longest-outage-s",
    ] {
        assert_eq!(violation(&format!("{quantity} <= 1"), 0.5, 0.1), 0.0);
    }
}

/// With LEO alone many samples are unsolved, so no bound on PDOP is met, whatever the
/// objectives.
#[test]
fn what_is_not_solved_is_not_feasible() {
    use crate::constellation::gnss::Preset;
    use crate::earth::Surface;
    use crate::evaluate::Setup;
    use crate::ground::Site;
    use crate::time::{Epoch, TimeGrid};
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 14_400.0, 300.0).unwrap();
    let site = |latitude| Site::new(Surface::Sphere, latitude, 100.0, 1.0).unwrap();
    let answer = |gnss, constraint: &str| {
        let setup = Setup::new(grid, vec![site(10.0), site(30.0), site(50.0)]).with_gnss(gnss);
        let evaluator = Evaluator::new(setup).unwrap();
        let goals = Goals {
            objectives: vec![Quantity::Satellites],
            constraints: vec![constraint.parse().unwrap()],
            launch_cost: LaunchCost {
                per_satellite: 1.0,
                per_plane: 5.0,
                per_1000_km: 0.2,
            },
            fixed: None,
            fixed_from_files: 0,
        };
        let problem = DesignProblem::new(&evaluator, shell().into(), goals).unwrap();
        let genome = vec![5.0, 16.0, 42.8, 933.0, 1.0];
        let (_, metrics) = problem.evaluated(&genome).unwrap();
        (problem.answer(&genome).violation, metrics)
    };
    for constraint in ["mean-pdop <= 20", "p95-pdop <= 20"] {
        let (violation, metrics) = answer(vec![], constraint);
        assert!(metrics.mean_pdop.unwrap() < 20.0, "{metrics:?}");
        assert!(metrics.solved_fraction < 0.9, "{metrics:?}");
        assert!(violation >= 1.0 - metrics.solved_fraction, "{violation}");
    }
    let (violation, metrics) = answer(vec![Preset::Beidou3.into()], "mean-pdop <= 20");
    assert_eq!((violation, metrics.solved_fraction), (0.0, 1.0));
}

use super::*;
use crate::constellation::Design;
use crate::constellation::gnss::Preset;
use crate::dop::LeoClocks;
use crate::earth::Surface;
use crate::evaluate::InstructionSet;
use crate::evaluate::testing::{self, design_matrix, observed};
use crate::ground::Site;
use crate::time::{Epoch, TimeGrid};
use crate::visibility::MaskTable;
use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

const LEO: RangeError = RangeError {
    sigma_m: 0.5,
    constant: 1.0,
    by_elevation: 0.0,
};
const BEIDOU: RangeError = RangeError {
    sigma_m: 1.5,
    constant: 0.5,
    by_elevation: 0.4,
};
const GPS: RangeError = RangeError {
    sigma_m: 2.5,
    constant: 0.0,
    by_elevation: 0.6,
};

/// Three points of unequal weights and seven instants.
fn study() -> (Setup, Ephemeris) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7200.0, 1100.0).unwrap();
    let site = |latitude, weight| Site::new(Surface::Wgs84, latitude, 100.0, weight).unwrap();
    let sites = vec![site(-30.0, 1.0), site(20.0, 3.0), site(55.0, 2.0)];
    let setup = testing::setup(grid, sites, 5.0)
        .with_gnss(vec![Preset::Beidou3.into(), Preset::Gps.into()])
        .with_accuracy(Accuracy {
            leo: LEO,
            gnss: vec![BEIDOU, GPS],
        });
    let design: Design = "delta:55:72/8/3@925".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, setup.model, grid).unwrap();
    (setup, ephemeris)
}

fn accuracy(setup: &Setup, ephemeris: &Ephemeris) -> AccuracyMetrics {
    let evaluator = Evaluator::new(setup.clone()).unwrap();
    evaluator.accuracy(ephemeris).unwrap().unwrap()
}

/// A standard normal number, by Box and Muller.
fn normal(random: &mut impl Rng) -> f64 {
    let mut unit = || (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let (u, v) = (unit(), unit());
    (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos()
}

/// Fixes of simulated ranges: the geometry matrix in full, weighted least squares, 1e5 draws in proportion to
/// the weights of the points. The 95 % error of so many draws is good to 0.3 % (1 sigma).
#[test]
fn validate_metres_by_monte_carlo() {
    const DRAWS: usize = 100_000;
    let (setup, ephemeris) = study();
    let ours = accuracy(&setup, &ephemeris);
    let total: f64 = setup.sites.iter().map(|site| site.weight).sum();
    let total = total * setup.grid.len() as f64;
    let mut random = ChaCha8Rng::seed_from_u64(20);
    let mut errors: [Vec<f64>; 3] = Default::default();
    let mut sigmas = [0.0; 3];
    for elapsed_s in setup.grid.iter() {
        for site in &setup.sites {
            let found = observed(&setup, &ephemeris, site, elapsed_s);
            let found: Vec<_> = found.iter().collect();
            let sigma = |sin: f64, system: usize| {
                let error = [LEO, BEIDOU, GPS][system];
                let [a, b] = [error.constant, error.by_elevation / sin];
                error.sigma_m * a.hypot(b)
            };
            let sigma = found.iter().map(|one| sigma(one.unit[2], one.system));
            let sigma = DVector::from_iterator(found.len(), sigma);
            let clocks: Vec<usize> = found.iter().map(|one| one.system).collect();
            let rows = design_matrix(&found, &clocks);
            let weights = DMatrix::from_diagonal(&sigma.map(|sigma| 1.0 / (sigma * sigma)));
            let weighted = rows.transpose() * weights;
            let gain = (&weighted * rows).try_inverse().unwrap() * weighted;
            let share = site.weight / total;
            let draws = (share * DRAWS as f64).round() as usize;
            let mut squares = [0.0; 3];
            for _ in 0..draws {
                let noise = sigma.map(|sigma| sigma * normal(&mut random));
                let fix = &gain * noise;
                let lengths = [
                    fix.fixed_rows::<3>(0).norm(),
                    fix[0].hypot(fix[1]),
                    fix[2].abs(),
                ];
                for (n, length) in lengths.into_iter().enumerate() {
                    errors[n].push(length);
                    squares[n] += length * length;
                }
            }
            for n in 0..3 {
                sigmas[n] += share * (squares[n] / draws as f64).sqrt();
            }
        }
    }
    let level = Level::new(0.95).unwrap();
    let quantiles = errors.map(|mut all| crate::stats::quantile(&mut all, level).unwrap());
    for (ours, drawn) in [
        (ours.error95_3d_m.unwrap(), quantiles[0]),
        (ours.error95_h_m.unwrap(), quantiles[1]),
        (ours.error95_v_m.unwrap(), quantiles[2]),
        (ours.sigma_3d_m.unwrap().mean, sigmas[0]),
        (ours.sigma_h_m.unwrap().mean, sigmas[1]),
        (ours.sigma_v_m.unwrap().mean, sigmas[2]),
    ] {
        assert!(
            (ours / drawn - 1.0).abs() < 0.02,
            "{ours} m, drawn {drawn} m"
        );
    }
    // The errors of these samples differ enough that a quantile of a sigma is none of an error.
    assert!(ours.error95_v_m.unwrap() < 1.8 * ours.sigma_v_m.unwrap().p95);
}

/// With 1 m for every range, the standard deviations are the DOPs in metres.
#[test]
fn validate_one_metre_against_the_dops() {
    let (setup, ephemeris) = study();
    for clocks in [Clocks::PerSystem, Clocks::Shared] {
        let metre = RangeError::constant(1.0);
        let setup = setup.clone().with_clocks(clocks).with_accuracy(Accuracy {
            leo: metre,
            gnss: vec![metre; 2],
        });
        let ours = accuracy(&setup, &ephemeris);
        let evaluator = Evaluator::new(setup).unwrap();
        // The dilutions of the lanes are kept with six digits.
        let dops = evaluator.dops_plain(&ephemeris).unwrap();
        for (sigma, dop) in [
            (ours.sigma_3d_m, dops.pdop),
            (ours.sigma_h_m, dops.hdop),
            (ours.sigma_v_m, dops.vdop),
        ] {
            let (sigma, dop) = (sigma.unwrap(), dop.unwrap());
            for (sigma, dop) in [
                (sigma.mean, dop.mean),
                (sigma.p95, dop.p95),
                (sigma.cvar, dop.cvar),
            ] {
                // The variances are those of other sums: a few ulp times the condition.
                assert!((sigma / dop - 1.0).abs() < 1e-12, "{sigma} {dop}");
            }
        }
    }
}

/// Of samples far from every limit none is left to the plain path, whose sums would hide an error of the lanes.
#[test]
fn the_lanes_decide_what_is_far_from_a_limit() {
    let (setup, ephemeris) = study();
    let ranges = setup.accuracy.clone().unwrap();
    for clocks in [Clocks::PerSystem, Clocks::Shared] {
        let evaluator = Evaluator::new(setup.clone().with_clocks(clocks)).unwrap();
        let (mut solved, mut open) = (0, 0);
        evaluator
            .kernel
            .range_normals(&ephemeris, &ranges, |instant| {
                for point in &instant.points {
                    solved += usize::from(matches!(point, RangeNormal::Solved(_)));
                    open += usize::from(matches!(point, RangeNormal::Open));
                }
                Ok(())
            })
            .unwrap();
        assert_eq!((solved, open), (21, 0), "{clocks:?}");
    }
}

/// The lanes give what the sums of the plain path give, and the same bits on every instruction set.
#[test]
fn lanes_equal_the_plain_path() {
    let (base, _) = study();
    let street = [
        (0.0, 5.0),
        (90.0, 35.0),
        (180.0, 5.0),
        (270.0, 35.0),
        (360.0, 5.0),
    ];
    let street = MaskTable::new(street.to_vec()).unwrap();
    let site = |n: u32| {
        let (latitude_deg, longitude_deg) = (f64::from(n % 7) * 9.0, f64::from(n) * 4.0);
        let weight = f64::from(1 + n % 3);
        Site::new(Surface::Wgs84, latitude_deg, longitude_deg, weight).unwrap()
    };
    let open = Setup {
        sites: (0..40).map(site).collect(),
        ..base
    };
    let under_skyline = open.clone().with_skyline(street);
    for setup in [open, under_skyline] {
        for (clocks, notation) in [
            (Clocks::PerSystem, "delta:55:72/8/3@925"),
            (Clocks::Shared, "delta:40:40/5/1@400"),
            // A clock for each shell.
            (
                Clocks::PerSystem,
                "delta:53:60/6/1@1000+star:87:30/5/1@1100",
            ),
        ] {
            let setup = setup
                .clone()
                .with_clocks(clocks)
                .with_leo_clocks(LeoClocks::PerPart);
            let design: Design = notation.parse().unwrap();
            let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
            let evaluators = InstructionSet::ALL
                .map(|set| Evaluator::with_instructions(setup.clone(), set).unwrap());
            let errors = setup.accuracy.as_ref().unwrap();
            let plain = evaluators[0]
                .position_errors_plain(&ephemeris, errors)
                .unwrap();
            let plain = plain.metrics(evaluators[0].setup().metrics.cvar_level);
            let [fast, others @ ..] = evaluators
                .each_ref()
                .map(|evaluator| evaluator.accuracy(&ephemeris).unwrap().unwrap());
            assert_eq!(others, [fast; 2]);
            assert_eq!(fast.solved_fraction, plain.solved_fraction);
            assert!(fast.solved_fraction > 0.5);
            let sigmas = |of: &AccuracyMetrics| [of.sigma_3d_m, of.sigma_h_m, of.sigma_v_m];
            for (fast, plain) in sigmas(&fast).into_iter().zip(sigmas(&plain)) {
                let (fast, plain) = (fast.unwrap(), plain.unwrap());
                for (ours, theirs) in [
                    (fast.mean, plain.mean),
                    (fast.p95, plain.p95),
                    (fast.cvar, plain.cvar),
                ] {
                    // Lines of sight are good to 2e-14, which the condition of a solved sample magnifies.
                    assert!((ours / theirs - 1.0).abs() < 1e-10, "{ours} {theirs}");
                }
            }
            let errors = |of: &AccuracyMetrics| [of.error95_3d_m, of.error95_h_m, of.error95_v_m];
            for (ours, theirs) in errors(&fast).into_iter().zip(errors(&plain)) {
                // The search for a length ends at 1e-9 of it.
                let apart = ours
                    .zip(theirs)
                    .map(|(ours, theirs)| (ours / theirs - 1.0).abs());
                assert!(ours == theirs || apart.is_some_and(|apart| apart < 3e-9));
            }
        }
    }
}

/// σ² = sigma² (a² + b²/sin² E): at 30° the second part counts four times, on the horizon without end.
#[test]
fn validate_weights_of_range_errors() {
    let error = RangeError {
        sigma_m: 2.0,
        constant: 0.5,
        by_elevation: 0.25,
    };
    for (sin, variance) in [(1.0, 4.0 * (0.25 + 0.0625)), (0.5, 4.0 * (0.25 + 0.25))] {
        assert!((error.weight(sin) * variance - 1.0).abs() < 1e-15);
    }
    assert_eq!(error.weight(0.0), 0.0);
    assert_eq!(RangeError::constant(2.0).weight(0.0), 0.25);
}

/// Only where the PDOP is solved, and without a sample there is no value.
#[test]
fn what_is_not_solved_has_no_accuracy() {
    let (setup, ephemeris) = study();
    let least = Evaluator::new(setup.clone())
        .unwrap()
        .series(&ephemeris)
        .unwrap()
        .rising_pdop()[0]
        .value;
    let capped = accuracy(&setup.with_pdop_cap(least.next_down()), &ephemeris);
    assert_eq!(capped, AccuracyMetrics::default());
}

/// The weights of the DOPs do not move metres, and range errors do not move DOPs.
#[test]
fn metres_and_dops_have_their_own_weights() {
    use crate::dop::ObservationWeights;
    let (setup, ephemeris) = study();
    let sine = setup
        .clone()
        .with_observation_weights(ObservationWeights::SineElevation);
    assert_eq!(accuracy(&sine, &ephemeris), accuracy(&setup, &ephemeris));
    let metrics = |setup: Setup| {
        let metrics = Evaluator::new(setup)
            .unwrap()
            .evaluate_ephemeris(&ephemeris);
        metrics.unwrap().mean_pdop
    };
    let without = Setup {
        accuracy: None,
        ..setup.clone()
    };
    assert_eq!(metrics(setup), metrics(without));
}

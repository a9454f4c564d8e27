//! Decisions that f32 cannot make.

use super::super::coarse::FEW;
use super::super::lanes::LANES;
use super::*;

/// A satellite at rest over the rotating Earth.
struct Hovering {
    position_km: Position<EarthFixed>,
    epoch: Epoch,
}

impl Propagator for Hovering {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let rotation = EarthRotation::from_gmst(self.epoch.gmst_rad(elapsed_s));
        Ok(State {
            position_km: rotation.to_teme(self.position_km),
            velocity_km_s: Vector3::zeros(),
        })
    }
}

/// Satellites at rest in the sight of one point each, at 1500 km, in these directions: azimuth and elevation, degrees.
pub(super) fn planted(setup: &Setup, direction: impl Fn(usize) -> (f64, f64)) -> Ephemeris {
    let satellite = |(n, site): (usize, &Site)| {
        let (azimuth_deg, elevation_deg) = direction(n);
        let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
        let (sin_e, cos_e) = elevation_deg.to_radians().sin_cos();
        let level = site.local.east * sin_a + site.local.north * cos_a;
        let line = site.local.up * sin_e + level * cos_e;
        EphemerisSatellite {
            name: n.to_string(),
            slot: None,
            propagator: Box::new(Hovering {
                position_km: site.local.origin_km + line * 1500.0,
                epoch: setup.grid.epoch(),
            }),
        }
    };
    Ephemeris::new(
        setup.grid,
        setup.sites.iter().enumerate().map(satellite).collect(),
    )
}

/// Two shells, with a clock each where asked for.
pub(super) const HYBRID: &str = "delta:53:104/8/1@1000+star:87:78/6/1@1100";

/// Two satellites at rest in the sight of the points around the middle of the region.
pub(super) fn planted_pair(setup: &Setup) -> Ephemeris {
    let all = planted(setup, |n| (90.0 * n as f64, 60.0)).into_satellites();
    let middle = setup.sites.len() / 2;
    let pair = all.into_iter().skip(middle).take(2).collect();
    Ephemeris::new(setup.grid, pair)
}

/// Ten instants of the region.
pub(super) fn short_setup() -> Setup {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    Setup {
        grid: TimeGrid::new(base.grid.epoch(), 600.0, 60.0).unwrap(),
        ..base
    }
}

/// A nanodegree to either side, a tenth of a millimetre at 1500 km, which f32 cannot distinguish.
fn either_side(n: usize) -> f64 {
    if n.is_multiple_of(2) { 1e-9 } else { -1e-9 }
}

/// Satellites a nanodegree to either side of the mask.
#[test]
fn decisions_at_the_mask_are_those_of_the_plain_path() {
    let setup = short_setup();
    let ephemeris = planted(&setup, |n| (57.0 * n as f64, 7.0 + either_side(n)));
    let evaluator = Evaluator::new(setup).unwrap();
    let (_, rechecks) = evaluator.kernel.evaluate(&ephemeris, false).unwrap();
    assert!(rechecks.near_mask >= 143 * 10, "{rechecks:?}");
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    compare(&evaluator.evaluate_ephemeris(&ephemeris).unwrap(), &plain).unwrap();
}

/// A street between houses, and a wall on one side.
pub(super) fn street() -> MaskTable {
    let vertices = [
        (0.0, 12.0),
        (80.0, 55.0),
        (100.0, 50.0),
        (100.000_001, 11.0),
        (200.0, 40.0),
        (360.0, 12.0),
    ];
    MaskTable::new(vertices.to_vec()).unwrap()
}

/// Satellites a nanodegree to either side of a skyline, at all azimuths.
#[test]
fn decisions_at_a_skyline_are_those_of_the_plain_path() {
    let setup = short_setup().with_skyline(street());
    let direction = |n: usize| {
        let azimuth_deg = (n as f64 * 2.517) % 360.0;
        (
            azimuth_deg,
            street().degrees_at(azimuth_deg) + either_side(n),
        )
    };
    let ephemeris = planted(&setup, direction);
    let evaluator = Evaluator::new(setup).unwrap();
    let (_, rechecks) = evaluator.kernel.evaluate(&ephemeris, false).unwrap();
    assert!(rechecks.near_mask >= 143 * 10, "{rechecks:?}");
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    compare(&evaluator.evaluate_ephemeris(&ephemeris).unwrap(), &plain).unwrap();
}

/// A day under a skyline: at most one sample in ten thousand is left to the plain path.
#[test]
fn a_day_under_a_skyline_equals_the_plain_path() {
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let setup = setup([3.0, 54.0], Surface::Sphere).with_skyline(street());
    let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let evaluator = Evaluator::new(setup).unwrap();
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    let (fast, rechecks) = evaluator.evaluate_counted(&design).unwrap();
    compare(&fast, &plain).unwrap();
    assert!(rechecks.near_mask < 21, "{rechecks:?}");
}

/// A satellite exactly at the mask is visible in the lanes too, and one a rounding below is not; what f32 cannot tell is
/// possible, so that it is decided again.
#[test]
fn at_the_mask_is_visible_in_the_lanes() {
    for mask_deg in [0.0_f64, 7.0, 10.0, 60.0] {
        let mask = Mask::from_degrees(mask_deg).unwrap();
        let sine = mask_deg.to_radians().sin();
        let double = |height: f64| f64::above(&MaskTerms::new(mask), height, 1.0, height);
        assert_eq!(double(sine), (true, true), "{mask_deg}");
        let below = sine - f64::from(f32::EPSILON).powi(2);
        assert_eq!(double(below), (false, false), "{mask_deg}");
        let single = MaskTerms::new(mask).with_slack(1e-6);
        for below in [0.0, 5e-7] {
            let seen = f32::above(&single, 0.0, 1.0, sine as f32 - below);
            assert_eq!(seen, (false, true), "{mask_deg}");
        }
    }
}

/// A decision of f32 within rounding of a threshold is not trusted: thresholds a billionth on either
/// side of actual values, which f32 cannot distinguish.
#[test]
fn decisions_at_a_threshold_are_those_of_the_plain_path() {
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let setup = setup([3.0, 54.0], Surface::Sphere);
    let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let plain = Evaluator::new(setup.clone())
        .unwrap()
        .evaluate_plain(&ephemeris)
        .unwrap();
    for value in [
        plain.p50_pdop,
        plain.p95_pdop,
        plain.p99_pdop,
        plain.max_pdop,
    ] {
        for side in [-1e-9, 1e-9] {
            let mut setup = setup.clone();
            setup.metrics.availability_pdop = value.unwrap() * (1.0 + side);
            let evaluator = Evaluator::new(setup).unwrap();
            let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
            let fast = evaluator.evaluate(&design).unwrap();
            assert_eq!(fast.availability, plain.availability, "{value:?} {side}");
        }
    }
}

/// Satellites so low that f32 cannot decide much, over points that do not fill their tiles: many decisions are in doubt, but
/// none of a lane without a point.
#[test]
fn satellites_just_above_the_ground_are_decided_in_f64() {
    for model in [Model::J2, Model::J2Osculating] {
        let setup = Setup {
            model,
            mask: Mask::from_degrees(0.0).unwrap(),
            sites: region([30.0, 40.0], [100.0, 140.0], 10.0)
                .sites(Surface::Sphere)
                .unwrap(),
            ..setup([3.0, 54.0], Surface::Sphere)
        };
        let design: Design = "delta:40:900/30/1@0.05".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
        compare(&evaluator.evaluate_ephemeris(&ephemeris).unwrap(), &plain).unwrap();
    }
}

/// PDOP of 200 instants, tile by tile, with f32 trusted so far, and how many values are made in f64.
pub(super) fn values(
    kernel: &Kernel,
    ephemeris: &Ephemeris,
    single: SingleLimits,
) -> (Vec<[f32; LANES]>, f64) {
    let limits = Limits {
        single,
        ..kernel.scene.limits
    };
    let mut all = Vec::new();
    let take = |instant: &mut Evaluating<'_>| {
        all.extend(instant.outcome.pdop.iter().map(|tile| tile.0));
        Ok(())
    };
    let propagation = &kernel.propagation(ephemeris);
    let rechecks = kernel.run(propagation, 0..200, limits, take).unwrap();
    (all, rechecks.large_pdop as f64)
}

/// A point of a tile that is computed alone in f64 has the bits that it has among all the points of the tile.
#[test]
fn points_alone_in_f64_equal_whole_tiles() {
    let (unit, sine) = (ObservationWeights::Unit, ObservationWeights::SineElevation);
    let skyline = Some(street());
    let (mut alone, mut together) = (0, 0);
    let single = "delta:55:182/13/1@925";
    for (text, clocks, weights, skyline, below) in [
        (single, Clocks::PerSystem, unit, None, 1.3),
        (single, Clocks::PerSystem, unit, skyline.clone(), 2.0),
        (single, Clocks::Shared, unit, skyline.clone(), 2.0),
        (single, Clocks::Shared, sine, skyline.clone(), 4.0),
        (HYBRID, Clocks::PerSystem, unit, None, 1.4),
        (HYBRID, Clocks::PerSystem, sine, skyline, 5.0),
    ] {
        let setup = Setup {
            clocks,
            leo_clocks: LeoClocks::PerPart,
            observation_weights: weights,
            ..setup([3.0, 54.0], Surface::Wgs84)
        };
        let setup = match skyline {
            Some(skyline) => setup.with_skyline(skyline),
            None => setup,
        };
        let design: Design = text.parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let kernel = &evaluator.kernel;
        let limit = SingleLimits {
            below,
            condition: 0.0,
            ..kernel.scene.limits.single
        };
        let (some, _) = values(kernel, &ephemeris, limit);
        let (every, _) = values(kernel, &ephemeris, SingleLimits::NONE);
        // Beyond what f32 may be off by.
        let is_coarse = |pdop: &f32| *pdop > below * 1.000_01;
        for (some, every) in some.iter().zip(&every) {
            for (one, again) in some.iter().zip(every).filter(|(_, d)| is_coarse(d)) {
                assert_eq!(one.to_bits(), again.to_bits());
            }
            let coarse = every.iter().filter(|pdop| is_coarse(pdop)).count() as u32;
            alone += u32::from((1..=FEW).contains(&coarse));
            together += u32::from(coarse > FEW);
        }
    }
    assert!(alone > 0 && together > 0, "{alone} {together}");
}

/// Single values in f32 compared with f64, both computed for every sample: 1e-6, for few and for many
/// satellites in view, with one clock or several, and with weights by elevation, where all but a few are trusted. Order
/// statistics rely on this.
#[test]
fn single_values_hold_six_digits() {
    let (unit, sine) = (ObservationWeights::Unit, ObservationWeights::SineElevation);
    for (text, clocks, weights) in [
        ("delta:55:182/13/1@925", Clocks::PerSystem, unit),
        ("delta:45:165/15/1@400", Clocks::PerSystem, unit),
        ("star:123.4:60/6/2@1333", Clocks::Shared, unit),
        ("delta:50:3000/50/1@1400", Clocks::PerSystem, unit),
        ("delta:55:182/13/1@925", Clocks::PerSystem, sine),
        ("delta:45:600/15/1@400", Clocks::Shared, sine),
        ("delta:50:3000/50/1@1400", Clocks::PerSystem, sine),
        (HYBRID, Clocks::PerSystem, unit),
        (HYBRID, Clocks::PerSystem, sine),
    ] {
        let design: Design = text.parse().unwrap();
        let setup = Setup {
            mask: Mask::from_degrees(0.0).unwrap(),
            clocks,
            leo_clocks: LeoClocks::PerPart,
            observation_weights: weights,
            ..setup([3.0, 54.0], Surface::Wgs84)
        };
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let kernel = &evaluator.kernel;
        let (single, again) = values(kernel, &ephemeris, kernel.scene.limits.single);
        let (double, every) = values(kernel, &ephemeris, SingleLimits::NONE);
        assert!(again < 0.15 * every, "{text}: {again} of {every} in f64");
        let apart = |(s, d): (&f32, &f32)| (f64::from(*s) / f64::from(*d) - 1.0).abs();
        let pairs = single.iter().flatten().zip(double.iter().flatten());
        let solved = pairs.filter(|(_, d)| d.is_finite());
        let worst = solved.map(apart).fold(0.0, f64::max);
        // Measured: 5e-7 for unit weights. A maximum of 0 would mean that f64 was not used.
        let bound = if weights == sine { 2e-6 } else { 1e-6 };
        assert!((1e-8..bound).contains(&worst), "{text}: {worst:e}");
    }
}

/// Where all lanes of a tile have one value, it is every order statistic.
#[test]
fn one_value_in_all_lanes_is_every_statistic() {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let setup = Setup {
        grid: TimeGrid::new(base.grid.epoch(), 60.0, 60.0).unwrap(),
        sites: vec![base.sites[50].clone(); 16],
        ..base
    };
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let evaluator = Evaluator::new(setup).unwrap();
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    let fast = evaluator.evaluate(&design).unwrap();
    assert_eq!(plain.p50_pdop, plain.max_pdop);
    compare(&fast, &plain).unwrap();
}

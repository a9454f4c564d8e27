use super::candidates::Candidates;
use super::lanes::{MaskTerms, Real};
use super::propagation::{PatternPropagator, Positions};
use super::tiles::{Horizon, Tiles};
use super::*;
use crate::constellation::gnss::Preset;
use crate::constellation::{Design, Orientation, Pattern, Shell, ShellParameters};
use crate::dop::Clocks;
use crate::earth::{RADIUS_KM, Surface};
use crate::ephemeris::EphemerisSatellite;
use crate::evaluate::tests::setup;
use crate::evaluate::{Evaluator, MetricOptions, Metrics};
use crate::frames::{EarthFixed, Position, State, Teme};
use crate::ground::{Grid, PointWeights, Site};
use crate::orbit::{Model, PropagationError, Propagator};
use crate::stats::Level;
use crate::time::{Epoch, TimeGrid};
use crate::visibility::Mask;
use nalgebra::Vector3;
use proptest::prelude::*;

mod limits;
mod propagated;

fn relative(ours: Option<f64>, theirs: Option<f64>) -> f64 {
    match (ours, theirs) {
        (Some(ours), Some(theirs)) => (ours / theirs - 1.0).abs(),
        (None, None) => 0.0,
        _ => f64::INFINITY,
    }
}

/// Counts are exact; statistics agree to 1e-6, of which f32 uses about a third at PDOP 2.
fn compare(fast: &Metrics, plain: &Metrics) -> Result<(), TestCaseError> {
    prop_assert_eq!(fast.mean_visible, plain.mean_visible);
    prop_assert_eq!(fast.solved_fraction, plain.solved_fraction);
    prop_assert_eq!(fast.availability, plain.availability);
    prop_assert_eq!(fast.j_cost, plain.j_cost);
    for (name, ours, theirs) in [
        ("mean", fast.mean_pdop, plain.mean_pdop),
        ("cvar", fast.cvar_pdop, plain.cvar_pdop),
        ("p50", fast.p50_pdop, plain.p50_pdop),
        ("p95", fast.p95_pdop, plain.p95_pdop),
        ("p99", fast.p99_pdop, plain.p99_pdop),
        ("max", fast.max_pdop, plain.max_pdop),
        ("j_pos", fast.j_pos, plain.j_pos),
    ] {
        let apart = relative(ours, theirs);
        prop_assert!(apart < 1e-6, "{name}: {ours:?} {theirs:?} {apart:e}");
    }
    Ok(())
}

/// One shell, and often two or three.
fn designs() -> impl Strategy<Value = Design> {
    let designs = prop::collection::vec(shells(), 1..4);
    designs.prop_map(|shells| Design::new(shells).unwrap())
}

fn orientations() -> impl Strategy<Value = Orientation> {
    let angle = || prop::option::of(0.0..360.0_f64);
    (angle(), angle(), angle()).prop_map(|(raan_deg, arg_latitude_deg, node_step_deg)| {
        Orientation {
            raan_deg: raan_deg.unwrap_or(0.0),
            arg_latitude_deg,
            node_step_deg,
        }
    })
}

fn shells() -> impl Strategy<Value = Shell> {
    let pattern = prop::sample::select(<Pattern as crate::keyword::Keyword>::ALL.to_vec());
    let shape = (1..9_usize, 1..12_usize, 0..9_usize);
    // As a fraction of the eccentricity that brings the perigee to the ground.
    let ellipse = prop_oneof![
        2 => Just((0.0, 0.0)),
        1 => (0.0..0.95_f64, 0.0..360.0_f64)
    ];
    let orbit = (0.0..180.0_f64, 300.0..3000.0_f64, ellipse);
    (pattern, shape, orbit, orientations()).prop_map(
        |(pattern, (planes, per_plane, phasing), (inclination_deg, altitude_km, (e, w)), at)| {
            let e = e * altitude_km / (RADIUS_KM + altitude_km);
            let orientation = Orientation {
                node_step_deg: at.node_step_deg.filter(|_| pattern != Pattern::Lattice),
                ..at
            };
            Shell::new(ShellParameters {
                pattern,
                planes,
                satellites_per_plane: per_plane,
                phasing: phasing % planes,
                inclination_deg,
                altitude_km,
            })
            .and_then(|shell| shell.with_ellipse(e, w)?.with_orientation(orientation))
            .unwrap()
        },
    )
}

fn region(latitude_deg: [f64; 2], longitude_deg: [f64; 2], step_deg: f64) -> Grid {
    Grid {
        latitude_deg,
        longitude_deg,
        step_deg: [step_deg, step_deg],
        weights: PointWeights::Equal,
    }
}

fn sites() -> impl Strategy<Value = Vec<Site>> {
    let surface = prop::sample::select(vec![Surface::Sphere, Surface::Wgs84]);
    let grids = prop::sample::select(vec![
        region([3.0, 54.0], [73.0, 136.0], 10.0),
        region([-60.0, -20.0], [160.0, -155.0], 8.0), // antimeridian, south
        region([70.0, 90.0], [-180.0, 180.0], 20.0),  // pole
        region([-90.0, 90.0], [-180.0, 180.0], 30.0), // globe
        region([40.0, 40.0], [10.0, 10.0], 1.0),      // one point
    ]);
    let scattered = prop::collection::vec((-90.0..90.0_f64, -180.0..180.0_f64), 1..40);
    prop_oneof![
        3 => (surface.clone(), grids).prop_map(|(surface, grid)| grid.sites(surface).unwrap()),
        1 => (surface, scattered).prop_map(|(surface, points)| {
            let site = |&(latitude, longitude): &(f64, f64)| {
                Site::new(surface, latitude, longitude, 1.0).unwrap()
            };
            points.iter().map(site).collect()
        })
    ]
}

fn setups() -> impl Strategy<Value = Setup> {
    let mask = prop_oneof![Just(0.0), Just(7.0), 0.0..60.0_f64];
    let clocks = prop::sample::select(vec![Clocks::PerSystem, Clocks::Shared]);
    let gnss = prop::sample::select(vec![
        vec![],
        vec![Preset::Beidou3.into()],
        vec![Preset::Beidou3.into(), Preset::Beidou3.into()],
    ]);
    let caps = prop::sample::select(vec![(100.0, 6.0), (1.9, 1.2), (8.0, 2.0)]);
    (
        sites(),
        mask,
        0.0..30.0_f64,
        clocks,
        gnss,
        caps,
        0..40_000_u32,
    )
        .prop_map(
            |(sites, mask, gnss_mask, clocks, gnss, (pdop_cap, availability_pdop), hours)| {
                let first = Epoch::from_utc("2023-06-01T00:00:00Z".parse().unwrap());
                let epoch = first.plus_seconds(f64::from(hours) * 3600.0);
                let metrics = MetricOptions {
                    cvar_level: Level::new(0.9).unwrap(),
                    availability_pdop,
                    ..MetricOptions::default()
                };
                Setup::new(TimeGrid::new(epoch, 3600.0, 97.0).unwrap(), sites)
                    .with_mask(Mask::from_degrees(mask).unwrap())
                    .with_gnss_mask(Mask::from_degrees(gnss_mask).unwrap())
                    .with_gnss(gnss)
                    .with_clocks(clocks)
                    .with_pdop_cap(pdop_cap)
                    .with_metrics(metrics)
            },
        )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(192))]

    /// The kernel equals the plain path, and is identical to the bit on all instruction sets.
    #[test]
    fn kernel_equals_the_plain_path(design in designs(), setup in setups()) {
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluators = InstructionSet::ALL
            .map(|set| Evaluator::with_instructions(setup.clone(), set).unwrap());
        let plain = evaluators[0].evaluate_plain(&ephemeris).unwrap();
        let fast = evaluators.each_ref().map(|evaluator| evaluator.evaluate(&design).unwrap());
        compare(&fast[0], &plain)?;
        prop_assert_eq!(fast[0], fast[1]);
        prop_assert_eq!(fast[0], fast[2]);
        // Without their pattern, satellites are propagated one by one.
        compare(&evaluators[0].evaluate_ephemeris(&ephemeris).unwrap(), &plain)?;
    }
}

/// The paper's scenario, a dense and a sparse constellation, and designs that are hard for f32.
#[test]
fn whole_days_equal_the_plain_path() {
    for (text, gnss) in [
        ("delta:55:182/13/1@925", vec![Preset::Beidou3.into()]),
        ("delta:50:44/11/3@420", vec![Preset::Beidou3.into()]),
        ("star:88:132/11/1@900", vec![]),
        (
            "delta:53:70/7/1@1000,raan=20+star:90:33/3/1@1100,u=12,node-step=31.6",
            vec![Preset::Beidou3.into()],
        ),
    ] {
        let design: Design = text.parse().unwrap();
        let setup = Setup {
            gnss,
            ..setup([3.0, 54.0], Surface::Wgs84)
        };
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
        let (fast, rechecks) = evaluator.evaluate_counted(&design).unwrap();
        compare(&fast, &plain).unwrap();
        // Means are more accurate than single values because rounding errors average out.
        assert!(relative(fast.mean_pdop, plain.mean_pdop) < 5e-8, "{text}");
        assert!(rechecks.near_mask > 0, "{text}");
        assert!(rechecks.large_pdop > 0, "{text}");
    }
}

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

/// Satellites at the mask itself and a nanodegree to either side, a tenth of a millimetre at 1500 km,
/// which f32 cannot distinguish.
#[test]
fn decisions_at_the_mask_are_those_of_the_plain_path() {
    let base = setup([3.0, 54.0], Surface::Wgs84);
    let setup = Setup {
        grid: TimeGrid::new(base.grid.epoch(), 600.0, 60.0).unwrap(),
        ..base
    };
    let mut satellites = Vec::new();
    for (n, site) in setup.sites.iter().enumerate() {
        let azimuth = n as f64;
        let elevation = (7.0 + if n % 2 == 0 { 1e-9 } else { -1e-9_f64 }).to_radians();
        let level = site.local.east * azimuth.sin() + site.local.north * azimuth.cos();
        let line = site.local.up * elevation.sin() + level * elevation.cos();
        satellites.push(EphemerisSatellite {
            name: n.to_string(),
            slot: None,
            propagator: Box::new(Hovering {
                position_km: site.local.origin_km + line * 1500.0,
                epoch: setup.grid.epoch(),
            }),
        });
    }
    let ephemeris = Ephemeris::new(setup.grid, satellites);
    let evaluator = Evaluator::new(setup).unwrap();
    let kernel = evaluator.kernel.as_ref().unwrap();
    let (_, rechecks) = kernel.evaluate(&ephemeris).unwrap();
    assert!(rechecks.near_mask >= 143 * 10, "{rechecks:?}");
    let plain = evaluator.evaluate_plain(&ephemeris).unwrap();
    compare(&evaluator.evaluate_ephemeris(&ephemeris).unwrap(), &plain).unwrap();
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

/// No satellite at all, and satellites that never rise.
#[test]
fn nothing_in_view_is_no_failure() {
    let setup = Setup {
        gnss: vec![],
        ..setup([80.0, 85.0], Surface::Wgs84)
    };
    let nobody = Ephemeris::new(setup.grid, vec![]);
    let evaluator = Evaluator::new(setup).unwrap();
    let metrics = evaluator.evaluate_ephemeris(&nobody).unwrap();
    assert_eq!(metrics, evaluator.evaluate_plain(&nobody).unwrap());
    assert_eq!((metrics.solved_fraction, metrics.max_pdop), (0.0, None));
}

/// Values that are not stored are computed twice with the same result, identical to the bit on any
/// number of threads.
#[test]
fn streaming_equals_keeping() {
    for clocks in [Clocks::PerSystem, Clocks::Shared] {
        let base = setup([-50.0, 54.0], Surface::Wgs84);
        let setup = Setup {
            grid: TimeGrid::new(base.grid.epoch(), 86_400.0, 71.0).unwrap(),
            clocks,
            ..base
        };
        let design: Design = "delta:55:60/6/1@925".parse().unwrap();
        let kept = Evaluator::new(setup.clone()).unwrap();
        let mut streamed = Evaluator::new(setup.clone()).unwrap();
        let nothing = Keep {
            values: 0,
            fixed_bytes: 0,
        };
        let (setup, rotations) = (Arc::clone(&kept.setup), Arc::clone(&kept.rotations));
        streamed.kernel =
            Kernel::keeping_at_most(nothing, setup, rotations, InstructionSet::detect()).ok();
        let expected = kept.evaluate(&design).unwrap();
        let on_threads = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new()
                .num_threads(threads)
                .build()
                .unwrap();
            pool.install(|| streamed.evaluate(&design).unwrap())
        };
        let one = on_threads(1);
        assert_eq!(one, on_threads(2));
        assert_eq!(one, on_threads(5));
        // A stream does not recompute its order statistics in f64.
        assert!(relative(one.max_pdop, expected.max_pdop) < 1e-6);
        assert!(relative(one.p95_pdop, expected.p95_pdop) < 1e-6);
        assert_eq!(one.mean_visible, expected.mean_visible);
        // The sums are computed in pieces of other sizes: a few ulp.
        assert!(relative(one.mean_pdop, expected.mean_pdop) < 1e-14);
        assert!(relative(one.cvar_pdop, expected.cvar_pdop) < 1e-13);
    }
}

/// Number of satellites tested for a point, and number visible, in the paper's scenario.
#[test]
fn regress_culling_looks_at_twice_what_is_seen() {
    let setup = setup([3.0, 54.0], Surface::Sphere);
    let design: Design = "delta:55:182/13/1@925".parse().unwrap();
    let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
    let propagation = PatternPropagator::new(&ephemeris.shells()[0]).unwrap();
    let tiles = Tiles::new(&setup.sites, setup.mask, setup.gnss_mask);
    assert_eq!((tiles.tiles.len(), tiles.groups.len()), (9, 1));
    let count = design.satellite_count();
    let mut positions = Positions::new(count);
    let mut all = Candidates::with_capacity(count);
    let mut looked_at = 0;
    for elapsed_s in setup.grid.iter() {
        let rotation = EarthRotation::from_gmst(setup.grid.epoch().gmst_rad(elapsed_s));
        propagation.place_at(&propagation.turn(elapsed_s, rotation), &mut positions);
        all.fill(&positions, &tiles.horizon);
        let slack_km = Horizon::cap_slack_km(&positions);
        for (tile, block) in tiles
            .tiles
            .iter()
            .flat_map(|tile| all.blocks().iter().map(move |block| (tile, block)))
        {
            looked_at += u64::from(block.inside(&tile.cap, slack_km).count_ones());
        }
    }
    let per_sample = looked_at as f64 / setup.grid.len() as f64 / tiles.tiles.len() as f64;
    let evaluator = Evaluator::new(setup).unwrap();
    let seen = evaluator.evaluate(&design).unwrap().mean_visible;
    // 16.6 for 7.84; a worse partition into tiles shows here before it shows in the run time.
    assert!((2.0..2.2).contains(&(per_sample / seen)), "{per_sample}");
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

/// Satellites so low that f32 cannot decide anything, over points that do not fill their tiles: every
/// decision is in doubt, but none of a lane without a point.
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

/// Single values in f32 compared with f64, both computed for every sample: 1e-6, for few and for many
/// satellites in view, with one clock or several. Order statistics rely on this.
#[test]
fn single_values_hold_six_digits() {
    for (text, clocks) in [
        ("delta:55:182/13/1@925", Clocks::PerSystem),
        ("star:123.4:60/6/2@1333", Clocks::Shared),
        ("delta:50:3000/50/1@1400", Clocks::PerSystem),
    ] {
        let design: Design = text.parse().unwrap();
        let setup = Setup {
            mask: Mask::from_degrees(0.0).unwrap(),
            clocks,
            ..setup([3.0, 54.0], Surface::Wgs84)
        };
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let kernel = evaluator.kernel.as_ref().unwrap();
        let values = |single_below: f32| {
            let limits = Limits {
                single_below,
                ..kernel.scene.limits
            };
            let propagation = &Propagation::new(&ephemeris);
            let mut all = Vec::new();
            let take = |tiles: &[Lanes<f32>]| all.extend(tiles.iter().flat_map(|tile| tile.0));
            kernel.run(propagation, 0..200, limits, take).unwrap();
            all
        };
        let (single, double) = (values(SINGLE_BELOW), values(0.0));
        let apart = |(s, d): (&f32, &f32)| (f64::from(*s) / f64::from(*d) - 1.0).abs();
        let solved = single.iter().zip(&double).filter(|(_, d)| d.is_finite());
        let worst = solved.map(apart).fold(0.0, f64::max);
        // Measured: 7e-7 over a full day. A maximum of 0 would mean that f64 was not used.
        assert!((1e-8..1e-6).contains(&worst), "{text}: {worst:e}");
    }
}

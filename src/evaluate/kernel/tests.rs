use super::candidates::Candidates;
use super::lanes::{MaskTerms, Real};
use super::propagation::{PatternPropagator, Positions};
use super::tiles::{Horizon, Tiles};
use super::*;
use crate::constellation::gnss::Preset;
use crate::constellation::{Design, Orientation, Pattern, Shell, ShellParameters};
use crate::dop::{Clocks, LeoClocks, ObservationWeights};
use crate::earth::{RADIUS_KM, Surface};
use crate::ephemeris::EphemerisSatellite;
use crate::evaluate::tests::setup;
use crate::evaluate::{
    DopStatistics, EpochMetrics, Evaluator, MetricOptions, Metrics, PointMetrics, Series,
};
use crate::frames::{EarthFixed, Position, State, Teme};
use crate::ground::{Grid, PointWeights, Site};
use crate::keyword::Keyword;
use crate::orbit::{Model, PropagationError, Propagator};
use crate::stats::Level;
use crate::time::{Epoch, TimeGrid};
use crate::visibility::{Mask, MaskTable};
use nalgebra::Vector3;
use proptest::prelude::*;

mod clocks;
mod culling;
mod decisions;
mod limits;
mod propagated;
mod tiled;
mod windows;

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
    prop_assert_eq!(fast.least_visible, plain.least_visible);
    prop_assert_eq!(fast.coverage, plain.coverage);
    prop_assert_eq!(fast.mean_gnss_visible, plain.mean_gnss_visible);
    prop_assert_eq!(fast.coverage_total, plain.coverage_total);
    prop_assert_eq!(fast.longest_outage_s, plain.longest_outage_s);
    prop_assert_eq!(fast.longest_outage_cut, plain.longest_outage_cut);
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

/// Weights, and heights up to 9 km: of none of the points, or of all.
fn weighted_sites() -> impl Strategy<Value = Vec<Site>> {
    let weights = prop_oneof![
        Just(None),
        Just(Some(0.3..0.3000001_f64)),
        Just(Some(1e-3..1.0)),
        Just(Some(1.0..1e6)),
    ];
    let drawn = |weights: Option<std::ops::Range<f64>>| match weights {
        None => prop::collection::vec(Just(1.0), 16).boxed(),
        Some(weights) => prop::collection::vec(weights, 16).boxed(),
    };
    let heights = prop_oneof![Just(0.0), Just(9.0)];
    (sites(), weights.prop_flat_map(drawn), heights).prop_map(|(mut sites, weights, height_km)| {
        for (n, site) in sites.iter_mut().enumerate() {
            site.weight = weights[n % weights.len()];
            let origin_km = site.local.origin_km.km();
            let height_km = height_km * (n as f64 * 0.618).fract();
            site.local.origin_km = Position::new(origin_km + site.local.up * height_km);
        }
        sites
    })
}

/// A skyline with up to eight vertices, some of them walls.
fn skylines() -> impl Strategy<Value = Arc<MaskTable>> {
    let step_deg = prop_oneof![1 => 1e-7..1e-3_f64, 3 => 1.0..120.0_f64];
    let vertices = prop::collection::vec((step_deg, 0.0..80.0_f64), 0..8);
    (0.0..40.0_f64, vertices).prop_map(|(north, steps)| {
        let (mut vertices, mut azimuth_deg) = (vec![(0.0, north)], 0.0);
        for (step_deg, mask) in steps {
            azimuth_deg += step_deg;
            if azimuth_deg < 360.0 {
                vertices.push((azimuth_deg, mask));
            }
        }
        vertices.push((360.0, north));
        Arc::new(MaskTable::new(vertices).unwrap())
    })
}

/// Under an open sky, one skyline, or skylines of some of the points.
fn points() -> impl Strategy<Value = Vec<Site>> {
    let skylines = prop_oneof![
        2 => Just(vec![None]),
        1 => skylines().prop_map(|skyline| vec![Some(skyline)]),
        2 => prop::collection::vec(prop::option::weighted(0.7, skylines()), 5),
    ];
    (weighted_sites(), skylines).prop_map(|(mut sites, skylines)| {
        for (n, site) in sites.iter_mut().enumerate() {
            site.skyline = skylines[n % skylines.len()].clone();
        }
        sites
    })
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
    let weights = prop::sample::select(ObservationWeights::ALL.to_vec());
    let leo_clocks = prop::sample::select(LeoClocks::ALL.to_vec());
    (
        points(),
        mask,
        0.0..30.0_f64,
        (clocks, leo_clocks),
        gnss,
        (caps, weights),
        0..40_000_u32,
    )
        .prop_map(
            |(sites, mask, gnss_mask, clocks, gnss, (caps, weights), hours)| {
                let (pdop_cap, availability_pdop) = caps;
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
                    .with_clocks(clocks.0)
                    .with_leo_clocks(clocks.1)
                    .with_observation_weights(weights)
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

/// What f32 may be off by in one sample of N satellites: a rounding of the sums times their condition, which is at most
/// N PDOP², of which PDOP has half. From PDOP 2 on, and with weights by elevation anywhere, the condition itself is bounded, at
/// 64, and a quarter of a rounding of it is left.
fn single_sample(satellites: f64, weights: ObservationWeights) -> f64 {
    let epsilon = f64::from(f32::EPSILON);
    let bounded = 0.25 * epsilon * 64.0;
    match weights {
        ObservationWeights::Unit => (0.5 * epsilon * satellites * 4.0).max(bounded),
        ObservationWeights::SineElevation => bounded,
    }
}

/// Series: counts are exact, and PDOP is the same to the rounding of f32.
fn compare_series(
    fast: &Series,
    plain: &Series,
    weights: ObservationWeights,
) -> Result<(), TestCaseError> {
    for (fast, plain) in fast.epochs.iter().zip(&plain.epochs) {
        let bound = single_sample(plain.mean_total_visible, weights);
        prop_assert!(relative(fast.mean_pdop, plain.mean_pdop) < bound);
        prop_assert!(relative(fast.max_pdop, plain.max_pdop) < bound);
        let counts = EpochMetrics {
            mean_pdop: plain.mean_pdop,
            max_pdop: plain.max_pdop,
            gain_mean_pdop: plain.gain_mean_pdop,
            ..*fast
        };
        prop_assert_eq!(&counts, plain);
    }
    for (fast, plain) in fast.points.iter().zip(&plain.points) {
        let bound = single_sample(plain.mean_total_visible, weights);
        prop_assert!(relative(fast.mean_pdop, plain.mean_pdop) < bound);
        prop_assert!(relative(fast.p95_pdop, plain.p95_pdop) < bound);
        prop_assert!(relative(fast.max_pdop, plain.max_pdop) < bound);
        let counts = PointMetrics {
            mean_pdop: plain.mean_pdop,
            p95_pdop: plain.p95_pdop,
            max_pdop: plain.max_pdop,
            gain_mean_pdop: plain.gain_mean_pdop,
            ..fast.clone()
        };
        prop_assert_eq!(&counts, plain);
    }
    Ok(())
}

/// All statistics of all dilutions, of which PDOP is that of the metrics.
fn compare_dops(
    fast: &DopStatistics,
    plain: &DopStatistics,
    bound: f64,
) -> Result<(), TestCaseError> {
    prop_assert_eq!(fast.solved_fraction, plain.solved_fraction);
    for ((name, fast), (_, plain)) in fast.named().into_iter().zip(plain.named()) {
        prop_assert_eq!(fast.is_some(), plain.is_some(), "{}", name);
        let (Some(fast), Some(plain)) = (fast, plain) else {
            continue;
        };
        for (ours, theirs) in [
            (fast.mean, plain.mean),
            (fast.p50, plain.p50),
            (fast.p95, plain.p95),
            (fast.p99, plain.p99),
            (fast.max, plain.max),
            (fast.cvar, plain.cvar),
        ] {
            let apart = (ours / theirs - 1.0).abs();
            prop_assert!(apart < bound, "{name}: {ours} {theirs}");
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// So do series and dilutions, to the bit on all instruction sets.
    #[test]
    fn series_and_dops_equal_the_plain_path(design in designs(), setup in setups()) {
        let ephemeris = Ephemeris::of_design(&design, setup.model, setup.grid).unwrap();
        let [first, second, third] = InstructionSet::ALL
            .map(|set| Evaluator::with_instructions(setup.clone(), set).unwrap());
        let series = first.series(&ephemeris).unwrap();
        let weights = setup.observation_weights;
        compare_series(&series, &first.series_plain(&ephemeris).unwrap(), weights)?;
        let dops = first.dops(&ephemeris).unwrap();
        let visible = series.epochs.iter().map(|epoch| epoch.mean_total_visible);
        let bound = single_sample(visible.fold(0.0, f64::max), weights);
        compare_dops(&dops, &first.dops_plain(&ephemeris).unwrap(), bound)?;
        for other in [second, third] {
            prop_assert_eq!(&other.series(&ephemeris).unwrap(), &series);
            prop_assert_eq!(&other.dops(&ephemeris).unwrap(), &dops);
        }
    }
}

/// The paper's scenario, a dense and a sparse constellation, and designs that are hard for f32.
#[test]
fn whole_days_equal_the_plain_path() {
    let mut large_pdop = 0;
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
        large_pdop += rechecks.large_pdop;
    }
    assert!(large_pdop > 0, "f32 is not enough for some");
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

fn weighted(mut sites: Vec<Site>) -> Vec<Site> {
    for (n, site) in sites.iter_mut().enumerate() {
        site.weight = 1.0 + (n as f64 * 0.618).fract();
    }
    sites
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
            sites: weighted(base.sites),
            ..base
        };
        let mut setup = setup;
        setup.metrics.availability_pdop = 1.6;
        let design: Design = "delta:55:60/6/1@925".parse().unwrap();
        let kept = Evaluator::new(setup.clone()).unwrap();
        let mut streamed = Evaluator::new(setup.clone()).unwrap();
        let nothing = Keep {
            values: 0,
            fixed_bytes: 0,
        };
        let (setup, rotations) = (Arc::clone(&kept.setup), Arc::clone(&kept.rotations));
        streamed.kernel = Kernel::keeping_at_most(
            nothing,
            setup,
            &kept.weights,
            rotations,
            InstructionSet::detect(),
        )
        .unwrap();
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
        // Counts are whole numbers, and outages continue from one chunk to the next.
        assert_eq!(one.coverage, expected.coverage);
        assert_eq!(one.availability, expected.availability);
        assert!(one.longest_outage_s > 71.0);
        assert_eq!(one.longest_outage_s, expected.longest_outage_s);
        assert_eq!(one.longest_outage_cut, expected.longest_outage_cut);
        let ephemeris = Ephemeris::of_design(&design, Model::J2, streamed.setup.grid).unwrap();
        let kept_dops = kept.dops(&ephemeris).unwrap();
        compare_dops(&streamed.dops(&ephemeris).unwrap(), &kept_dops, 1e-6).unwrap();
    }
}

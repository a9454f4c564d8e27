//! What an evaluation costs, step by step and whole, on the paper's scenario: 143 points,
//! 1440 samples, 182 LEO and 30 BeiDou satellites, one clock per system.
//!
//! `cargo bench` prints the fastest, slowest, median and mean time of each case.
//! `docs/performance.md` holds the figures and says how they were taken.

use divan::{Bencher, black_box};
use navwalker::constellation::Design;
use navwalker::constellation::gnss::Preset;
use navwalker::dop::{ClockGroup, Geometry, LeoClocks, ObservationWeights};
use navwalker::earth::Surface;
use navwalker::ephemeris::Ephemeris;
use navwalker::evaluate::{Evaluator, InstructionSet, Setup};
use navwalker::frames::{EarthRotation, Position};
use navwalker::ground::{Grid, PointWeights};
use navwalker::orbit::Model;
use navwalker::stats::{Level, summarize};
use navwalker::time::{Epoch, TimeGrid};
use navwalker::visibility::MaskTable;

fn main() {
    divan::main();
}

const SOUND: &str = "the paper's scenario can be evaluated";

const NOTATION: &str = "delta:55:182/13/1@925";

fn paper() -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().expect("a date"));
    let region = Grid {
        latitude_deg: [3.0, 54.0],
        longitude_deg: [73.0, 136.0],
        step_deg: [5.0, 5.0],
        weights: PointWeights::Equal,
    };
    Setup::new(
        TimeGrid::new(epoch, 86_400.0, 60.0).expect(SOUND),
        region.sites(Surface::Sphere).expect(SOUND),
    )
    .with_gnss(vec![Preset::Beidou3.into()])
}

fn design() -> Design {
    NOTATION.parse().expect(SOUND)
}

/// Everything that no design changes, GNSS included.
#[divan::bench(sample_count = 5)]
fn setting_up() -> Evaluator {
    Evaluator::new(paper()).expect(SOUND)
}

/// 182 satellites at 1440 samples by the propagators, turned into the Earth-fixed frame.
#[divan::bench(sample_count = 10)]
fn propagation(bencher: Bencher) {
    let grid = paper().grid;
    let ephemeris = Ephemeris::of_design(&design(), Model::J2, grid).expect(SOUND);
    bencher.bench_local(|| {
        for elapsed_s in grid.iter() {
            let rotation = EarthRotation::from_gmst(grid.epoch().gmst_rad(elapsed_s));
            for satellite in ephemeris.satellites() {
                let state = ephemeris.state(satellite, elapsed_s).expect(SOUND);
                black_box(rotation.to_earth_fixed(state.position_km));
            }
        }
    });
}

/// The definition of visibility, 182 satellites from 143 points at one instant.
#[divan::bench(sample_count = 100)]
fn visibility(bencher: Bencher) {
    let setup = paper();
    let ephemeris = Ephemeris::of_design(&design(), Model::J2, setup.grid).expect(SOUND);
    let rotation = EarthRotation::from_gmst(setup.grid.epoch().gmst_rad(0.0));
    let positions: Vec<_> = ephemeris
        .satellites()
        .iter()
        .map(|s| rotation.to_earth_fixed(ephemeris.state(s, 0.0).expect(SOUND).position_km))
        .collect();
    bencher.bench_local(|| {
        for site in &setup.sites {
            for &position in &positions {
                black_box(setup.mask.line_of_sight(&site.local, position));
            }
        }
    });
}

/// The definition of PDOP: two clock groups of 8 and 12 satellites.
#[divan::bench]
fn pdop(bencher: Bencher) {
    let directions: Vec<_> = (0..20)
        .map(|n| {
            let (sin_a, cos_a) = (f64::from(n) * 2.4).sin_cos();
            let (sin_e, cos_e) = (0.2 + 0.06 * f64::from(n)).sin_cos();
            nalgebra::Vector3::new(cos_e * sin_a, cos_e * cos_a, sin_e)
        })
        .collect();
    bencher.bench_local(|| {
        let mut geometry = Geometry::default();
        for system in [&directions[..8], &directions[8..]] {
            let mut group = ClockGroup::default();
            black_box(system).iter().for_each(|&v| group.add(v, 1.0));
            geometry.add(&group);
        }
        geometry.pdop(100.0)
    });
}

/// All the statistics of 205 920 values by selection.
#[divan::bench(sample_count = 20)]
fn statistics(bencher: Bencher) {
    // A low-discrepancy sequence shaped like PDOP: between 1 and 2, the large ones rare.
    let sample: Vec<f64> = (0..205_920)
        .map(|n| 1.0 + (f64::from(n) * 0.618_033_988_749_895).fract().powi(4))
        .collect();
    let level = Level::new(0.95).expect(SOUND);
    bencher
        .with_inputs(|| sample.clone())
        .bench_local_values(|mut values| summarize(&mut values, level));
}

/// A whole design by the definitions, one sample after the other, GNSS included.
#[divan::bench(sample_count = 5)]
fn design_plain(bencher: Bencher) {
    let setup = paper();
    let ephemeris = Ephemeris::of_design(&design(), Model::J2, setup.grid).expect(SOUND);
    let evaluator = Evaluator::new(setup).expect(SOUND);
    bencher.bench_local(|| evaluator.evaluate_plain(&ephemeris).expect(SOUND));
}

/// A whole design by the kernel.
#[divan::bench(sample_count = 200, args = InstructionSet::ALL)]
fn design_kernel(bencher: Bencher, instructions: InstructionSet) {
    let evaluator = Evaluator::with_instructions(paper(), instructions).expect(SOUND);
    let design = design();
    bencher.bench_local(|| evaluator.evaluate(&design).expect(SOUND));
}

/// What users add to a study.
const ADDITIONS: [&str; 12] = [
    "equal",
    "cos-latitude",
    "column",
    "heights",
    "hills",
    "street",
    "sine-elevation",
    "dops",
    "series",
    "two-shells",
    "leo-clocks",
    "windows",
];

/// The constellation that is evaluated with an addition.
fn notation_with(what: &str) -> &'static str {
    match what {
        "two-shells" | "leo-clocks" => SHELLS[3],
        _ => NOTATION,
    }
}

/// A skyline of hills: 2° to 13°.
fn hills() -> MaskTable {
    let hill = |n: u32| {
        // The last is the first again, to the bit.
        let turn_rad = (f64::from(n % 36) * 10.0).to_radians();
        let height_deg = 7.5 + 3.5 * (3.0 * turn_rad).sin() + 2.0 * (5.0 * turn_rad).cos();
        (f64::from(n) * 10.0, height_deg)
    };
    MaskTable::new((0..=36).map(hill).collect()).expect(SOUND)
}

/// A skyline of a street from north to south: up to 50°.
fn street() -> MaskTable {
    let street = [
        (0.0, 10.0),
        (90.0, 50.0),
        (180.0, 10.0),
        (270.0, 50.0),
        (360.0, 10.0),
    ];
    MaskTable::new(street.to_vec()).expect(SOUND)
}

fn study(what: &str, is_globe: bool) -> Setup {
    let mut setup = paper();
    if is_globe {
        let globe = Grid {
            latitude_deg: [-90.0, 90.0],
            longitude_deg: [-180.0, 180.0],
            step_deg: [5.0, 5.0],
            weights: PointWeights::Equal,
        };
        setup.sites = globe.sites(Surface::Sphere).expect(SOUND);
    }
    for (n, site) in setup.sites.iter_mut().enumerate() {
        match what {
            "cos-latitude" => site.weight = site.latitude_deg.to_radians().cos().max(0.02),
            "column" => site.weight = 1.0 + (n % 7) as f64,
            "heights" => {
                let origin_km = site.local.origin_km.km() + site.local.up * 9.0;
                site.local.origin_km = Position::new(origin_km);
            }
            _ => {}
        }
    }
    match what {
        "hills" => setup.with_skyline(hills()),
        "street" => setup.with_skyline(street()),
        "sine-elevation" => setup.with_observation_weights(ObservationWeights::SineElevation),
        "leo-clocks" => setup.with_leo_clocks(LeoClocks::PerPart),
        "windows" => setup.with_window_s(600.0),
        _ => setup,
    }
}

fn add(bencher: Bencher, what: &str, is_globe: bool) {
    let setup = study(what, is_globe);
    let design = notation_with(what).parse().expect(SOUND);
    let ephemeris = Ephemeris::of_design(&design, Model::J2, setup.grid).expect(SOUND);
    let evaluator = Evaluator::new(setup).expect(SOUND);
    bencher.bench_local(|| match what {
        "series" => drop(black_box(evaluator.series(&ephemeris).expect(SOUND))),
        "dops" => drop(black_box(evaluator.dops(&ephemeris).expect(SOUND))),
        _ => drop(black_box(
            evaluator.evaluate_ephemeris(&ephemeris).expect(SOUND),
        )),
    });
}

/// A design in the region of the paper with what users add.
#[divan::bench(sample_count = 30, args = ADDITIONS)]
fn paper_with(bencher: Bencher, what: &str) {
    add(bencher, what, false);
}

/// The same on the globe in steps of 5°.
#[divan::bench(sample_count = 10, args = ADDITIONS)]
fn globe_with(bencher: Bencher, what: &str) {
    add(bencher, what, true);
}

/// A hybrid of 182 satellites, its two shells, and no satellites at all: what the hybrid costs beyond the last is
/// what its shells cost beyond the last.
const SHELLS: [&str; 4] = [
    "",
    "delta:53:104/8/1@1000",
    "star:87:78/6/1@1100",
    "delta:53:104/8/1@1000+star:87:78/6/1@1100",
];

#[divan::bench(sample_count = 200, args = SHELLS)]
fn shells(bencher: Bencher, notation: &str) {
    let setup = paper();
    let ephemeris = match notation.parse::<Design>() {
        Ok(design) => Ephemeris::of_design(&design, Model::J2, setup.grid).expect(SOUND),
        Err(_) => Ephemeris::new(setup.grid, Vec::new()),
    };
    let evaluator = Evaluator::new(setup).expect(SOUND);
    bencher.bench_local(|| evaluator.evaluate_ephemeris(&ephemeris).expect(SOUND));
}

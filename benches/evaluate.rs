//! What an evaluation costs, step by step and whole, on the paper's scenario: 143 points,
//! 1440 samples, 182 LEO and 30 BeiDou satellites, one clock per system.
//!
//! `cargo bench` prints the fastest, slowest, median and mean time of each case.
//! `docs/performance.md` holds the figures and says how they were taken.

use divan::{Bencher, black_box};
use navwalker::constellation::Design;
use navwalker::constellation::gnss::Preset;
use navwalker::dop::{ClockGroup, Geometry, ObservationWeights};
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

/// The same with what users add to it: equal weights, weights by area, points 9 km high.
#[divan::bench(sample_count = 100, args = ["equal", "cos-latitude", "heights"])]
fn points(bencher: Bencher, what: &str) {
    let mut setup = paper();
    for site in &mut setup.sites {
        match what {
            "cos-latitude" => site.weight = site.latitude_deg.to_radians().cos(),
            "heights" => {
                let origin_km = site.local.origin_km.km() + site.local.up * 9.0;
                site.local.origin_km = Position::new(origin_km);
            }
            _ => {}
        }
    }
    let evaluator = Evaluator::new(setup).expect(SOUND);
    let design = design();
    bencher.bench_local(|| evaluator.evaluate(&design).expect(SOUND));
}

/// Skylines and the weighting of observations by elevation, by the plain path.
#[divan::bench(sample_count = 5, args = ["skyline", "sine-elevation"])]
fn observations(bencher: Bencher, what: &str) {
    let setup = match what {
        "skyline" => {
            let street = [
                (0.0, 10.0),
                (90.0, 50.0),
                (180.0, 10.0),
                (270.0, 50.0),
                (360.0, 10.0),
            ];
            paper().with_skyline(MaskTable::new(street.to_vec()).expect(SOUND))
        }
        _ => paper().with_observation_weights(ObservationWeights::SineElevation),
    };
    let evaluator = Evaluator::new(setup).expect(SOUND);
    let design = design();
    bencher.bench_local(|| evaluator.evaluate(&design).expect(SOUND));
}

/// The cuts of `--series`, and all dilutions of `--dops`.
#[divan::bench(sample_count = 20, args = ["series", "dops"])]
fn tables(bencher: Bencher, what: &str) {
    let setup = paper();
    let ephemeris = Ephemeris::of_design(&design(), Model::J2, setup.grid).expect(SOUND);
    let evaluator = Evaluator::new(setup).expect(SOUND);
    bencher.bench_local(|| match what {
        "series" => drop(black_box(evaluator.series(&ephemeris).expect(SOUND))),
        _ => drop(black_box(evaluator.dops(&ephemeris).expect(SOUND))),
    });
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

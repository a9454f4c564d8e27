//! How the cost of one design grows: with the grid, with the satellites, with time, with threads.
//!
//! `cargo bench --bench scaling`; `DIVAN_SAMPLE_COUNT` sets the samples of each case.

use divan::Bencher;
use navwalker::constellation::Design;
use navwalker::constellation::gnss::Preset;
use navwalker::earth::Surface;
use navwalker::evaluate::{Evaluator, Setup};
use navwalker::ground::{Grid, PointWeights};
use navwalker::time::{Epoch, TimeGrid};

fn main() {
    divan::main();
}

const SOUND: &str = "the scenario can be evaluated";
const PAPER: &str = "delta:55:182/13/1@925";
const REGION: ([f64; 2], [f64; 2]) = ([3.0, 54.0], [73.0, 136.0]);
const GLOBE: ([f64; 2], [f64; 2]) = ([-90.0, 90.0], [-180.0, 180.0]);

fn setup((latitude_deg, longitude_deg): ([f64; 2], [f64; 2]), step_deg: f64, hours: f64) -> Setup {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().expect("a date"));
    let region = Grid {
        latitude_deg,
        longitude_deg,
        step_deg: [step_deg, step_deg],
        weights: PointWeights::Equal,
    };
    Setup::new(
        TimeGrid::new(epoch, hours * 3600.0, 60.0).expect(SOUND),
        region.sites(Surface::Sphere).expect(SOUND),
    )
    .with_gnss(vec![Preset::Beidou3.into()])
}

fn time(bencher: Bencher, setup: Setup, notation: &str, threads: usize) {
    let evaluator = Evaluator::new(setup).expect(SOUND);
    let design: Design = notation.parse().expect(SOUND);
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .expect(SOUND);
    bencher.bench_local(|| pool.install(|| evaluator.evaluate(&design).expect(SOUND)));
}

#[divan::bench(args = [5.0, 2.0, 1.0, 0.5], sample_count = 3)]
fn region_step_deg(bencher: Bencher, step_deg: f64) {
    time(bencher, setup(REGION, step_deg, 24.0), PAPER, 1);
}

#[divan::bench(args = [10.0, 5.0, 2.0], sample_count = 3)]
fn globe_step_deg(bencher: Bencher, step_deg: f64) {
    time(bencher, setup(GLOBE, step_deg, 24.0), PAPER, 1);
}

#[divan::bench(args = [PAPER, "delta:53:1584/72/1@550", "delta:53:10000/100/1@550"], sample_count = 3)]
fn satellites(bencher: Bencher, notation: &str) {
    time(bencher, setup(REGION, 5.0, 24.0), notation, 1);
}

#[divan::bench(args = [24.0, 168.0], sample_count = 3)]
fn hours(bencher: Bencher, hours: f64) {
    time(bencher, setup(REGION, 5.0, hours), PAPER, 1);
}

#[divan::bench(args = [1, 2], sample_count = 3)]
fn threads_at_1_deg(bencher: Bencher, threads: usize) {
    time(bencher, setup(REGION, 1.0, 24.0), PAPER, threads);
}

/// Not circular: every satellite is asked of its propagator.
#[divan::bench(sample_count = 3)]
fn eccentric(bencher: Bencher) {
    let lattice = "lattice:63.4:182/13/5@950,e=0.01,w=270";
    time(bencher, setup(REGION, 5.0, 24.0), lattice, 1);
}

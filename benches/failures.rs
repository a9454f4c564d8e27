//! What the loss of each satellite costs beside one evaluation, on the paper's scenario: 143 points, 1440 samples, 182 LEO and 30
//! BeiDou satellites, one clock per system.

use divan::{Bencher, black_box};
use navwalker::constellation::gnss::Preset;
use navwalker::earth::Surface;
use navwalker::ephemeris::Ephemeris;
use navwalker::evaluate::{Evaluator, Setup};
use navwalker::ground::{Grid, PointWeights};
use navwalker::orbit::Model;
use navwalker::time::{Epoch, TimeGrid};

fn main() {
    divan::main();
}

const SOUND: &str = "the paper's scenario can be evaluated";

const SATELLITES: usize = 182;

fn study() -> (Evaluator, Ephemeris) {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().expect("a date"));
    let region = Grid {
        latitude_deg: [3.0, 54.0],
        longitude_deg: [73.0, 136.0],
        step_deg: [5.0, 5.0],
        weights: PointWeights::Equal,
    };
    let grid = TimeGrid::new(epoch, 86_400.0, 60.0).expect(SOUND);
    let sites = region.sites(Surface::Sphere).expect(SOUND);
    let setup = Setup::new(grid, sites).with_gnss(vec![Preset::Beidou3.into()]);
    let design = "delta:55:182/13/1@925".parse().expect(SOUND);
    let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).expect(SOUND);
    (Evaluator::new(setup).expect(SOUND), ephemeris)
}

/// One evaluation on one thread.
#[divan::bench(sample_count = 50)]
fn whole(bencher: Bencher) {
    let (evaluator, ephemeris) = study();
    bencher.bench_local(|| {
        evaluator
            .evaluate_ephemeris(black_box(&ephemeris))
            .expect(SOUND)
    });
}

/// All metrics without each of the 182 satellites.
#[divan::bench(sample_count = 20, args = [1, 2])]
fn without_each(bencher: Bencher, threads: usize) {
    let (evaluator, ephemeris) = study();
    let sets: Vec<Vec<usize>> = (0..SATELLITES).map(|place| vec![place]).collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().expect("threads");
    let run = || {
        evaluator
            .without_each(black_box(&ephemeris), &sets)
            .expect(SOUND)
    };
    pool.install(run);
    bencher.bench_local(|| pool.install(run));
}

/// What a search asks for that bounds or minimises the maximum or the availability without any one satellite: the whole
/// evaluation included.
#[divan::bench(sample_count = 20, args = [1, 2])]
fn worst_without_one(bencher: Bencher, threads: usize) {
    let (evaluator, ephemeris) = study();
    let mut setup = evaluator.setup().clone();
    setup.metrics.asks_for_n1 = true;
    let evaluator = Evaluator::new(setup).expect(SOUND);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = pool.build().expect("threads");
    let run = || {
        evaluator
            .evaluate_ephemeris(black_box(&ephemeris))
            .expect(SOUND)
    };
    pool.install(run);
    bencher.bench_local(|| pool.install(run));
}

/// All metrics without each of the 13 planes.
#[divan::bench(sample_count = 20)]
fn without_each_plane(bencher: Bencher) {
    let (evaluator, ephemeris) = study();
    let planes: Vec<Vec<usize>> = (0..13)
        .map(|plane| (14 * plane..14 * plane + 14).collect())
        .collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1);
    let pool = pool.build().expect("threads");
    let run = || {
        evaluator
            .without_each(black_box(&ephemeris), &planes)
            .expect(SOUND)
    };
    pool.install(run);
    bencher.bench_local(|| pool.install(run));
}

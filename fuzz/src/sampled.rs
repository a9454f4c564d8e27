//! Formats whose writers take satellites on a grid: what is read is propagated, written and read back.

use navwalker::ephemeris::sampled::Sampled;
use navwalker::ephemeris::{Ephemeris, EphemerisSatellite};
use navwalker::exchange::import::Fleet;
use navwalker::exchange::lint::Format;
use navwalker::formats::csv;
use navwalker::formats::metadata::{Metadata, Object, Theory};
use navwalker::formats::sp3::{self as format, Sp3Version};
use navwalker::formats::text::timestamp::TimeSystem;
use navwalker::formats::trajectory::Trajectory;
use navwalker::frames::{EarthFixed, Frame, State};
use navwalker::orbit::Model;
use navwalker::time::{Epoch, TimeGrid};

/// The grid that the samples of the first satellite show, if the others have no more.
fn propagated(trajectories: &[Trajectory]) -> Option<Ephemeris> {
    let states = trajectories.first()?.samples();
    let (first, last) = (states.first()?.0, states.last()?.0);
    let step_s = match states.get(1) {
        Some((second, ..)) => second.seconds_since(first),
        None => 1.0,
    };
    let span_s = last.seconds_since(first) + 0.5 * step_s;
    // Beyond thirty years a double of seconds does not hold the microsecond of a sample.
    if span_s > 1e9 || span_s / step_s > 1_000.0 {
        return None;
    }
    let grid = TimeGrid::new(first, span_s, step_s).ok()?;
    // Samples between the instants of the grid would not be written.
    let is_on_grid = |one: &Trajectory| {
        let samples = one.samples();
        let near = |(n, (at, ..)): (usize, &(Epoch, Frame, State<Frame>))| {
            at.seconds_since(first.plus_seconds(grid.elapsed_s(n)))
                .abs()
                <= 1e-6
        };
        samples.len() == grid.len() && samples.iter().enumerate().all(near)
    };
    if !trajectories.iter().all(is_on_grid) {
        return None;
    }
    Fleet::Sampled(trajectories.to_vec())
        .propagate(grid, Model::J2)
        .ok()
}

fn same(one: &[Trajectory], other: &[Trajectory], (km, km_s): (f64, f64)) {
    assert_eq!(one.len(), other.len());
    for (one, other) in one.iter().zip(other) {
        for ((at, _, one), (expected, _, other)) in one.samples().iter().zip(&other.samples()) {
            // The microsecond within which a sample is that of an instant.
            let late_s = at.seconds_since(*expected).abs();
            assert!(late_s <= 1.1e-6);
            let km = km + late_s * other.velocity_km_s.norm();
            // Turned to TEME and back: a few roundings of the numbers' own size.
            let size = 1e-14 * (1.0 + other.position_km.norm());
            assert!((one.position_km - other.position_km).norm() <= km + size);
            let size = 1e-14 * (1.0 + other.velocity_km_s.norm() + other.position_km.norm());
            assert!((one.velocity_km_s - other.velocity_km_s).norm() <= km_s + size);
        }
    }
}

/// Whether all states are in one frame.
fn is_in(trajectory: &Trajectory, frame: Frame) -> bool {
    trajectory.arcs.iter().all(|arc| arc.frame == frame)
}

/// A table of states.
pub(crate) fn states(trajectories: &[Trajectory]) {
    let Some(ephemeris) = propagated(trajectories) else {
        return;
    };
    let mut out = Vec::new();
    csv::write_states(&mut out, &ephemeris).expect("what is read can be written");
    let again = csv::read_states(out.as_slice()).expect("our own file is read");
    let names = |of: &[Trajectory]| of.iter().map(|one| one.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&again), names(trajectories));
    if trajectories.iter().all(|one| is_in(one, Frame::Teme)) {
        same(&again, trajectories, (1e-9, 1e-12));
    }
}

/// SP3 files.
pub fn sp3(bytes: &[u8]) {
    if format::read(bytes).is_err() {
        return;
    }
    let Ok(read) = Fleet::read(bytes, Some(Format::Sp3), None) else {
        return;
    };
    let Fleet::Sampled(trajectories) = read.fleet else {
        return;
    };
    let Some(ephemeris) = propagated(&trajectories) else {
        return;
    };
    let epoch = ephemeris.grid().epoch();
    let Ok(objects) = Object::all(ephemeris.satellites(), epoch) else {
        return;
    };
    let metadata = Metadata {
        originator: "FUZZ".to_owned(),
        creation: epoch,
        frame: Frame::EarthFixed,
        time_system: TimeSystem::Gps,
        frame_note: None,
        from_files: false,
        theory: Theory::Propagated(Model::J2),
        subject: Vec::new(),
    };
    let sampled = Sampled::new(&ephemeris, EarthFixed);
    let pairs: Vec<(&EphemerisSatellite, &Object)> =
        ephemeris.satellites().iter().zip(&objects).collect();
    let mut out = Vec::new();
    // What its columns do not hold is refused with a reason.
    if format::write(&mut out, Sp3Version::D, 'L', &metadata, &sampled, &pairs).is_err() {
        return;
    }
    let again = Fleet::read(out.as_slice(), Some(Format::Sp3), None).expect("our own file is read");
    if let Fleet::Sampled(again) = again.fleet
        && trajectories.iter().all(|one| is_in(one, Frame::EarthFixed))
    {
        // Six decimals of a kilometre and of a decimetre a second in three components.
        same(&again, &trajectories, (1e-6, 1e-10));
    }
}

/// Almanacs: what is read propagates to finite states, or is refused with a reason.
fn almanacs(bytes: &[u8], format: Format) {
    let Ok(read) = Fleet::read(bytes, Some(format), None) else {
        return;
    };
    let epoch = TimeSystem::Gps.epoch(Default::default());
    let grid = TimeGrid::new(epoch, 7_200.0, 3_600.0).expect("a valid grid");
    let Ok(ephemeris) = read.fleet.propagate(grid, Model::J2) else {
        return;
    };
    for satellite in ephemeris.satellites() {
        for t in grid.iter() {
            let Ok(state) = ephemeris.state(satellite, t) else {
                continue;
            };
            let numbers = [state.position_km.km(), state.velocity_km_s];
            assert!(numbers.iter().flatten().all(|number| number.is_finite()));
        }
    }
}

/// YUMA almanacs.
pub fn yuma(bytes: &[u8]) {
    almanacs(bytes, Format::Yuma);
}

/// SEM almanacs.
pub fn sem(bytes: &[u8]) {
    almanacs(bytes, Format::Sem);
}

use super::*;
use crate::frames::{Frame, State};
use crate::time::Epoch;
use nalgebra::Vector3;

fn fleet() -> Fleet {
    let satellite = |name: &str, id: &str| Trajectory::of_states(name, id, Frame::Teme, Vec::new());
    Fleet::Sampled(vec![
        satellite("NW-P01-S01", "2025-900A"),
        satellite("NW-P01-S02", "2025-900B"),
        satellite("NW-P02-S01", "2025-900C"),
    ])
}

/// Adds states to satellites as a fleet does.
fn unite(known: &mut Vec<Trajectory>, next: Trajectory) {
    let mut fleet = Fleet::Sampled(std::mem::take(known));
    fleet.append(Fleet::Sampled(vec![next]));
    if let Fleet::Sampled(united) = fleet {
        *known = united;
    }
}

fn chosen(only: &[&str], exclude: &[&str]) -> Result<Vec<String>, String> {
    let owned = |patterns: &[&str]| patterns.iter().map(|text| (*text).to_owned()).collect();
    let filter = SatelliteFilter {
        only: owned(only),
        exclude: owned(exclude),
    };
    let mut fleet = fleet();
    let choice = fleet.choose(&filter);
    choice.map_err(|error| error.to_string())?;
    Ok(fleet.labels())
}

#[test]
fn satellites_are_chosen_by_name_id_and_pattern() {
    let all = ["NW-P01-S01", "NW-P01-S02", "NW-P02-S01"];
    for (only, exclude, expected) in [
        (&[][..], &[][..], &all[..]),
        (&["NW-P01-*"], &[], &all[..2]),
        (&["*"], &["*s01"], &all[1..2]),
        (&["2025-900?"], &["2025-900A"], &all[1..]),
        (&["nw-p02-s01", "NW-P01-S02"], &[], &all[1..]),
    ] {
        let found = chosen(only, exclude).unwrap();
        assert_eq!(found, expected, "{only:?} {exclude:?}");
    }
    let error = chosen(&["NW-P01-*", "NW-P03-S01"], &[]).unwrap_err();
    assert!(
        error.starts_with("no satellite matches 'NW-P03-S01'; did you mean 'NW-P0"),
        "{error}"
    );
    let error = chosen(&[], &["GALILEO*"]).unwrap_err();
    assert_eq!(error, "no satellite matches 'GALILEO*'");
    let error = chosen(&["NW-P01-S01"], &["NW-*"]).unwrap_err();
    assert_eq!(error, "the selection excludes all 3 satellites");
}

#[test]
fn stars_take_any_characters() {
    for (pattern, text, fits) in [
        ("*", "", true),
        ("a*b*c", "aXbYbZc", true),
        ("a*b*c", "aXcYb", false),
        ("a?c", "ac", false),
        ("A?c", "abC", true),
        ("", "a", false),
        ("a**", "a", true),
    ] {
        assert_eq!(matches(pattern, text), fits, "{pattern} {text}");
    }
}

/// States of one satellite in files of two days are one satellite; states at the same instants are not.
#[test]
fn states_of_one_satellite_are_joined_if_they_follow_each_other() {
    let part = |name: &str, id: &str, first: usize| {
        let state = |k: usize| {
            let at = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
            let x = Vector3::x() * (7_000.0 + k as f64);
            (at.plus_seconds(k as f64), State::new(x, Vector3::y()))
        };
        let states = (first..first + 3).map(state).collect();
        Trajectory::of_states(name, id, Frame::Teme, states)
    };
    let united = |parts: &[Trajectory]| {
        let mut known = Vec::new();
        parts
            .iter()
            .for_each(|part| unite(&mut known, part.clone()));
        known
            .iter()
            .map(|one: &Trajectory| one.samples().len())
            .collect::<Vec<_>>()
    };
    // One instant in common, in either order.
    let (one, next) = (part("A", "2025-900A", 0), part("UNKNOWN", "2025-900A", 2));
    assert_eq!(united(&[one.clone(), next.clone()]), [5]);
    assert_eq!(united(&[next, one.clone()]), [5]);
    assert_eq!(united(&[one.clone(), part("A", "2025-900A", 1)]), [3, 3]);
    assert_eq!(united(&[one.clone(), part("B", "2025-900A", 2)]), [3, 3]);
    assert_eq!(united(&[one.clone(), part("A", "2025-900B", 2)]), [3, 3]);
    // In another frame: each arc keeps its own.
    let mut known = vec![one];
    let mut fixed = part("A", "A", 3);
    fixed.arcs[0].frame = Frame::EarthFixed;
    unite(&mut known, fixed);
    let frames: Vec<Frame> = known[0]
        .samples()
        .iter()
        .map(|(_, frame, _)| *frame)
        .collect();
    assert_eq!(frames, [[Frame::Teme; 3], [Frame::EarthFixed; 3]].concat());
}

/// Days of SP3 that follow each other at their spacing are one arc; segments and later days are not.
#[test]
fn days_that_follow_each_other_are_one_arc() {
    let start = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let day = |first: usize, is_open: bool| {
        let state = |k: usize| {
            let state = State::new(Vector3::x() * (7_000.0 + k as f64), Vector3::y());
            (start.plus_seconds(900.0 * k as f64), state)
        };
        let states = (first..first + 4).map(state).collect();
        let mut day = Trajectory::of_states("G01", "G01", Frame::EarthFixed, states);
        day.arcs[0].is_open = is_open;
        day
    };
    let arcs = |parts: [Trajectory; 2]| {
        let mut known = Vec::new();
        parts.into_iter().for_each(|part| unite(&mut known, part));
        known[0].arcs.len()
    };
    assert_eq!(arcs([day(0, true), day(4, true)]), 1);
    assert_eq!(arcs([day(4, true), day(0, true)]), 1);
    assert_eq!(arcs([day(0, true), day(5, true)]), 2);
    assert_eq!(arcs([day(0, false), day(4, true)]), 2);
    // Midnight in both files: with the same position, one digit off, or two.
    let moved = |km: f64| {
        let mut next = day(3, true);
        for (_, state) in &mut next.arcs[0].nodes {
            state.position_km = state.position_km + Vector3::repeat(km);
        }
        next
    };
    assert_eq!(arcs([day(0, true), moved(0.0)]), 1);
    assert_eq!(arcs([moved(1e-6), day(0, true)]), 1);
    assert_eq!(arcs([day(0, true), moved(2e-6)]), 2);
    assert_eq!(arcs([day(0, false), moved(0.0)]), 2);
    let joined = |next: Trajectory| {
        let mut known = vec![day(0, true)];
        unite(&mut known, next);
        known.remove(0)
    };
    assert_eq!(joined(moved(0.0)).arcs[0].nodes.len(), 7);
    assert_eq!(joined(moved(2e-6)).samples().len(), 7);
    // Half a microsecond earlier is the same instant, also for the overlap.
    let mut early = moved(0.0);
    let shift = |at: &mut Epoch| *at = at.plus_seconds(-5e-7);
    early.arcs[0].nodes.iter_mut().for_each(|(at, _)| shift(at));
    shift(&mut early.arcs[0].useable.0);
    shift(&mut early.arcs[0].useable.1);
    let early = joined(early);
    assert_eq!((early.arcs.len(), early.samples().len()), (1, 7));
}

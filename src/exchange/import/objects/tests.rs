use super::*;
use crate::time::Epoch;
use nalgebra::Vector3;

fn fleet() -> Fleet {
    let satellite = |name: &str, id: &str| Trajectory {
        name: name.to_owned(),
        id: id.to_owned(),
        frame: Frame::Teme,
        states: Vec::new(),
    };
    Fleet::Sampled(vec![
        satellite("NW-P01-S01", "2025-900A"),
        satellite("NW-P01-S02", "2025-900B"),
        satellite("NW-P02-S01", "2025-900C"),
    ])
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
    assert_eq!(error, "the choice leaves none of the 3 satellites");
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
    let part = |name: &str, id: &str, first: usize| Trajectory {
        name: name.to_owned(),
        id: id.to_owned(),
        frame: Frame::Teme,
        states: (first..first + 3)
            .map(|k| {
                let at = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
                let x = Vector3::x() * (7_000.0 + k as f64);
                (at.plus_seconds(k as f64), State::new(x, Vector3::y()))
            })
            .collect(),
    };
    let united = |parts: &[Trajectory]| {
        let mut known = Vec::new();
        parts
            .iter()
            .for_each(|part| unite(&mut known, part.clone()));
        known
            .iter()
            .map(|one: &Trajectory| one.states.len())
            .collect::<Vec<_>>()
    };
    // One instant in common, in either order.
    let (one, next) = (part("A", "2025-900A", 0), part("UNKNOWN", "2025-900A", 2));
    assert_eq!(united(&[one.clone(), next.clone()]), [5]);
    assert_eq!(united(&[next, one.clone()]), [5]);
    assert_eq!(united(&[one.clone(), part("A", "2025-900A", 1)]), [3, 3]);
    assert_eq!(united(&[one.clone(), part("B", "2025-900A", 2)]), [3, 3]);
    assert_eq!(united(&[one.clone(), part("A", "2025-900B", 2)]), [3, 3]);
    // In another frame: all in TEME, where they were.
    let mut known = vec![one];
    let mut fixed = part("A", "A", 3);
    fixed.frame = Frame::EarthFixed;
    let (at, state) = fixed.states[1];
    let teme = FromTeme::to(Frame::EarthFixed, at, 0.0).undo(state);
    unite(&mut known, fixed);
    assert_eq!((known[0].frame, known[0].states.len()), (Frame::Teme, 6));
    assert_eq!(known[0].states[4].1.position_km.km(), teme.position_km.km());
}

//! What the keys of the search accept, and the words of all keys.

use super::{accepts, refuses};
use crate::scenario::{Constraint, Quantity, Relation};

#[test]
fn searches_are_bounded() {
    for (key, least) in [("planes", 1), ("satellites-per-plane", 0)] {
        let each = &format!(
            "expected [low, high], each an integer >= {least} and <= 100000, or one for both"
        );
        refuses("search", &format!("{key} = [-1, 5]"), key, each);
        refuses(
            "search",
            &format!("{key} = [11.5, 15]"),
            key,
            &format!("found 11.5, {each}"),
        );
        refuses(
            "search",
            &format!("{key} = [15, 11]"),
            key,
            "low limit is above the high",
        );
        assert_eq!(
            accepts("search", "planes = [11.0, 15]")
                .search
                .shells
                .as_slice()[0]
                .planes,
            [11, 15]
        );
    }
    let line = "planes = [1, 1000]\nsatellites-per-plane = [1, 101]";
    let message = "101000 satellites in a design, expected at most 100000";
    refuses("search", line, "planes", message);
    let range = "each a number >= 0 and <= 180, or one for both, in deg";
    refuses(
        "search",
        "inclination-deg = [40, 181]",
        "inclination-deg",
        range,
    );
    let range = "each a number > 0 and <= 100000, or one for both, in km";
    refuses("search", "altitude-km = [0, 1000]", "altitude-km", range);
    assert_eq!(
        accepts("search", "altitude-km = 925")
            .search
            .shells
            .as_slice()[0]
            .altitude_km,
        [925.0, 925.0].into()
    );
    for key in ["inclination-step-deg", "altitude-step-km"] {
        refuses(
            "search",
            &format!("{key} = 0"),
            key,
            "found 0, expected a number > 0, in",
        );
    }
    let line = "inclination-step-deg = 1e-9\n[optimizer]\nalgorithm = \"exhaustive\"";
    let message = "designs in an exhaustive search, expected at most 1000000000";
    refuses("search", line, "inclination-step-deg", message);
}

#[test]
fn phasing_is_below_the_number_of_planes() {
    let above = "the lowest phasing is 15, but with at most 15 planes it is at most 14";
    refuses("search", "phasing = 15", "phasing", above);
    refuses(
        "search",
        "phasing = -1",
        "phasing",
        "found -1, expected [low, high], each an integer",
    );
    refuses(
        "search",
        "phasing = [3, 1]",
        "phasing",
        "low limit is above the high",
    );
    let search = accepts("search", "phasing = [0, 20]").search;
    assert_eq!(search.shells.as_slice()[0].phasing, [0, 20]);
    // One plane alone has no phasing but 0, also by default.
    assert_eq!(
        accepts("search", "planes = 1").search.shells.as_slice()[0].phasing,
        [0, 0]
    );
}

#[test]
fn optimizers_are_bounded() {
    let refuses = |line: &str, message: &str| {
        let key = line.split_once(" =").unwrap().0;
        super::refuses("optimizer", line, key, message);
    };
    refuses(
        "population = 3",
        "found 3, expected an integer >= 4 and <= 10000",
    );
    refuses(
        "population = 10001",
        "found 10001, expected an integer >= 4 and <= 10000",
    );
    refuses("population = 30.5", "found 30.5, expected an integer");
    refuses(
        "generations = 0",
        "found 0, expected an integer >= 1 and <= 1000000",
    );
    refuses(
        "crossover-probability = 1.1",
        "found 1.1, expected a number >= 0 and <= 1",
    );
    refuses(
        "mutation-probability = -0.1",
        "found -0.1, expected a number >= 0 and <= 1",
    );
    let seeds = "expected an integer >= 0 and <= 18446744073709551615";
    refuses("seed = -1", seeds);
    refuses("seed = 18446744073709551616", seeds);
    let largest = accepts("optimizer", "seed = 18446744073709551615");
    assert_eq!(largest.optimizer.seed, u64::MAX);
    assert_eq!(accepts("optimizer", "seed = 0xff").optimizer.seed, 255);
    let choices = "did you mean \"nsga2\"? (choices: nsga2, mopso, random, exhaustive)";
    refuses("algorithm = \"nsga-ii\"", choices);
}

#[test]
fn objectives_are_known_and_different() {
    let choices = "unknown name \"mean-pdp\", did you mean \"mean-pdop\"? (choices: j-pos, j-cost, \
                   mean-pdop, cvar-pdop, p95-pdop, p99-pdop, max-pdop, satellites, planes, \
                   new-satellites, new-planes, mean-visible, availability, ";
    refuses(
        "objectives",
        "minimize = [\"mean-pdp\"]",
        "minimize",
        choices,
    );
    let twice = "\"planes\" appears more than once";
    refuses(
        "objectives",
        "minimize = [\"planes\", \"planes\"]",
        "minimize",
        twice,
    );
    let some = "found [], expected a list of one or more of \"j-pos\" | \"j-cost\"";
    refuses("objectives", "minimize = []", "minimize", some);
    refuses(
        "objectives",
        "minimize = \"j-pos\"",
        "minimize",
        "expected a list of one or more",
    );
    refuses(
        "objectives",
        "minimize = [1]",
        "minimize",
        "found 1, expected a list of",
    );
    let open = "expected a number > 0 and < 1";
    refuses("objectives", "cvar-level = 1", "cvar-level", open);
    refuses("objectives", "cvar-level = 0.0", "cvar-level", open);
    refuses(
        "objectives",
        "cvar-weight = -0.5",
        "cvar-weight",
        "expected a number >= 0",
    );
}

#[test]
fn a_reference_point_has_one_number_for_each_objective() {
    let key = "hypervolume-reference";
    let message = "3 numbers for 2 objectives, expected one for each";
    refuses(
        "objectives",
        "hypervolume-reference = [2, 22, 1]",
        key,
        message,
    );
    refuses(
        "objectives",
        "hypervolume-reference = [2, nan]",
        key,
        "found nan, expected a list",
    );
    let reference = |line: &str| accepts("objectives", line).objectives.hypervolume_reference;
    assert_eq!(
        reference("minimize = [\"j-cost\", \"j-pos\"]"),
        Some(vec![22.0, 2.0])
    );
    assert_eq!(reference("minimize = [\"j-cost\", \"planes\"]"), None);
    let given = reference("minimize = [\"max-pdop\"]\nhypervolume-reference = [3]");
    assert_eq!(given, Some(vec![3.0]));
}

#[test]
fn constraints_are_a_quantity_a_relation_and_a_number() {
    accepts(
        "objectives",
        "constraints = [\"availability >= 1\", \"coverage-4 >= 0\", \"least-visible >= 4\"]",
    );
    let line = "constraints = [\"max-pdop <= 2.5\", \"availability>=0.99\"]";
    let expected = [
        Constraint {
            quantity: Quantity::MaxPdop,
            relation: Relation::AtMost,
            bound: 2.5,
        },
        Constraint {
            quantity: Quantity::Availability,
            relation: Relation::AtLeast,
            bound: 0.99,
        },
    ];
    assert_eq!(accepts("objectives", line).objectives.constraints, expected);
    for (constraint, message) in [
        (
            "max-pdop < 2.5",
            "found \"max-pdop < 2.5\", expected a quantity, <= or >=, and a number",
        ),
        (
            "max-pdob <= 2.5",
            "unknown name \"max-pdob\", did you mean \"max-pdop\"?",
        ),
        (
            "max-pdop <= low",
            "found the bound \"low\", expected a finite number",
        ),
        (
            "max-pdop <= inf",
            "found the bound \"inf\", expected a finite number",
        ),
        (
            "availability >= 99",
            "found the bound \"99\", expected a number from 0 to 1: availability is a fraction",
        ),
        (
            "coverage-total-4 >= 1.0000001",
            "found the bound \"1.0000001\", expected a number from 0 to 1: coverage-total-4 is a fraction",
        ),
        (
            "coverage-1 <= -0.1",
            "found the bound \"-0.1\", expected a number from 0 to 1",
        ),
        ("<=", "unknown name \"\" (choices: j-pos"),
    ] {
        let line = format!("constraints = [\"{constraint}\"]");
        refuses("objectives", &line, "constraints", message);
    }
}

#[test]
fn bounds_of_one_quantity_go_together() {
    let line = "constraints = [\"planes >= 12\", \"planes <= 12\"]";
    assert_eq!(accepts("objectives", line).objectives.constraints.len(), 2);
    for (line, message) in [
        (
            "constraints = [\"planes <= 12\", \"satellites <= 200\", \"planes <= 13\"]",
            "planes <= appears more than once",
        ),
        (
            "constraints = [\"max-pdop <= 2\", \"max-pdop >= 3\"]",
            "max-pdop >= 3 and max-pdop <= 2 exclude every design",
        ),
    ] {
        refuses("objectives", line, "constraints", message);
    }
}

#[test]
fn ellipses_that_all_go_underground_are_no_search() {
    let error = super::parse("[search]\neccentricity = [0.5, 0.6]\n", &[]).unwrap_err();
    let text = error.to_string();
    assert!(
        text.contains("with an eccentricity of 0.5 at 1000 km the perigee height is -2689.1 km"),
        "{text}"
    );
    // One design of the search is enough.
    assert!(super::parse("[search]\neccentricity = [0.1, 0.6]\n", &[]).is_ok());
}

#[test]
fn words_are_known() {
    let refuses = |section: &str, key: &str, word: &str, message: &str| {
        super::refuses(section, &format!("{key} = {word}"), key, message);
    };
    let surfaces = "unknown name \"WGS84\", did you mean \"wgs84\"? (choices: wgs84, sphere)";
    refuses("earth", "surface", "\"WGS84\"", surfaces);
    refuses(
        "earth",
        "surface",
        "84",
        "found 84, expected \"wgs84\" | \"sphere\"",
    );
    let models = "did you mean \"j2\"? (choices: j2, two-body, j2-osculating, sgp4)";
    refuses("propagation", "model", "\"j2p\"", models);
    refuses(
        "region",
        "weights",
        "\"cos-lat\"",
        "did you mean \"cos-latitude\"?",
    );
    refuses(
        "visibility",
        "weighting",
        "\"none\"",
        "(choices: unit, sine-elevation)",
    );
    refuses(
        "gnss",
        "clocks",
        "\"persystem\"",
        "did you mean \"per-system\"?",
    );
    refuses(
        "gnss",
        "constellations",
        "[\"beidou\"]",
        "did you mean \"beidou-3\"?",
    );
    refuses(
        "gnss",
        "constellations",
        "[\"gps\", \"gps\"]",
        "\"gps\" appears more than once",
    );
    refuses(
        "gnss",
        "files",
        "[\"a.tle\", \"a.tle\"]",
        "\"a.tle\" appears more than once",
    );
    refuses(
        "gnss",
        "files",
        "\"a.tle\"",
        "found \"a.tle\", expected a list of paths",
    );
    refuses(
        "search",
        "pattern",
        "\"walker\"",
        "(choices: delta, star, lattice)",
    );
}

/// What altitude and inclination may follow from, read, written and resolved.
#[test]
fn altitude_and_inclination_may_follow() {
    let range = "expected \"repeat:REVOLUTIONS/DAYS\" such as \"repeat:15/1\", or [low, high]";
    for text in ["repeat:15", "repeat:0/1", "15/1"] {
        let line = format!("altitude-km = \"{text}\"");
        refuses("search", &line, "altitude-km", range);
    }
    let range = "expected \"sun-synchronous\", or [low, high]";
    refuses(
        "search",
        "inclination-deg = \"sunsync\"",
        "inclination-deg",
        range,
    );
    let below = "repeat:18/1 needs an orbit whose perigee is below the ground";
    refuses(
        "search",
        "altitude-km = \"repeat:18/1\"",
        "altitude-km",
        below,
    );
    let none = "no inclination is sun-synchronous at an altitude of 6600 km";
    let high = "altitude-km = [6500, 6600]\ninclination-deg = \"sun-synchronous\"";
    refuses("search", high, "altitude-km", none);
    let both = "inclination-deg = \"sun-synchronous\"\naltitude-km = \"repeat:233/16\"";
    let scenario = accepts("search", both);
    let space = &scenario.search.shells.as_slice()[0];
    let (inclination_deg, altitude_km) = space.orbit(None, None, 0.0).unwrap();
    assert!((inclination_deg - 98.2).abs() < 0.1 && (altitude_km - 705.0).abs() < 10.0);
}

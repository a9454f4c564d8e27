//! Range errors, windows and clocks of parts: what is refused, with line and key.

use super::{parse, refuses};
use crate::scenario::Scenario;

fn problem(text: &str) -> String {
    parse(text, &[]).unwrap_err().to_string()
}

fn reads(text: &str) -> Scenario {
    parse(text, &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

#[test]
fn a_range_error_is_a_length() {
    let accepted = "expected a number >= 0.001 and <= 1000, in m";
    for value in ["0", "-1", "nan", "\"1 m\""] {
        refuses("accuracy", &format!("leo-m = {value}"), "leo-m", accepted);
    }
    refuses(
        "accuracy",
        "leo-elevation = 1",
        "leo-elevation",
        "two numbers",
    );
    refuses(
        "accuracy",
        "leo-elevation = [0, 0]\nleo-m = 1\nbeidou-3-m = 1",
        "leo-elevation",
        "a and b are both 0",
    );
    refuses(
        "accuracy",
        "gps-elevation = [1, 1]",
        "gps-elevation",
        "set `accuracy.gps-m`",
    );
}

#[test]
fn every_system_in_use_has_a_range_error() {
    let text = "[accuracy]\nleo-m = 0.5\n[gnss]\nconstellations = [\"gps\", \"qzss\"]\nfiles = [\"a.tle\"]";
    let told = problem(text);
    for key in ["gps-m", "qzss-m", "files-m"] {
        let expected = format!(
            "study.toml:2: accuracy.leo-m: every system in use needs a range error; `accuracy.{key}` is missing"
        );
        assert!(told.contains(&expected), "{told}");
    }
    assert!(
        !told.contains("beidou") && told.matches("missing").count() == 3,
        "{told}"
    );
    assert!(problem("[accuracy]\nbeidou-3-m = 1").contains("`accuracy.leo-m` is missing"));
    // A system that is not in use may have one.
    let scenario = reads("[accuracy]\nleo-m = 0.5\ngps-m = 1\n[gnss]\nconstellations = []");
    assert_eq!(scenario.accuracy.in_use(&scenario.gnss).len(), 1);
    assert_eq!(reads("").accuracy.accuracy(&[], 0), None);
}

/// A system that comes in by `--set` is told there, not at a range error of the file.
#[test]
fn a_missing_range_error_is_told_where_its_system_is_given() {
    let text = "[accuracy]\nleo-m = 0.5\nbeidou-3-m = 1";
    let given = parse(text, &["gnss.constellations=[\"gps\"]"]);
    let told = given.unwrap_err().to_string();
    let expected = "--set gnss.constellations=[\"gps\"]: gnss.constellations: every system in use needs a range error; `accuracy.gps-m` is missing";
    assert!(told.starts_with(expected), "{told}");
}

/// A range error that nothing uses is told, and each only once.
#[test]
fn range_errors_of_other_systems_are_told() {
    let notes = |text: &str| {
        let read = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        reads(text).setup_with_notes(&read).unwrap().1
    };
    let text =
        "[accuracy]\nleo-m = 1\nbeidou-3-m = 1\ngps-m = 2\nfiles-m = 3\nfiles-elevation = [1, 1]";
    assert_eq!(
        notes(text),
        [
            "accuracy.gps-m is not used: `gnss.constellations` does not have the system",
            "accuracy.files-m is not used: `gnss.files` is empty",
        ]
    );
    assert!(notes("[accuracy]\nleo-m = 1\nbeidou-3-m = 1").is_empty());
}

#[test]
fn range_errors_are_in_the_order_of_the_systems() {
    let scenario = reads(
        "[accuracy]\nleo-m = 0.5\ngps-m = 1\ngps-elevation = [0, 2]\nnavic-m = 3\nfiles-m = 4\n\
         [gnss]\nconstellations = [\"navic\", \"gps\"]\nfiles = [\"a.tle\"]",
    );
    let presets = &scenario.gnss.constellations;
    let accuracy = scenario.accuracy.accuracy(presets, 2).unwrap();
    let sigmas: Vec<f64> = accuracy.gnss.iter().map(|of| of.sigma_m).collect();
    assert_eq!(sigmas, [3.0, 1.0, 4.0, 4.0]);
    let gps = accuracy.gnss[1];
    assert_eq!((gps.constant, gps.by_elevation), (0.0, 2.0));
    assert_eq!((accuracy.leo.sigma_m, accuracy.leo.constant), (0.5, 1.0));
}

#[test]
fn a_window_fits_into_the_span() {
    let told = problem("[time]\nduration-h = 1\n[metrics]\nwindow-min = 61");
    let expected =
        "study.toml:4: metrics.window-min: a window of 61 min is longer than the span of 60 min";
    assert!(told.starts_with(expected), "{told}");
    reads("[time]\nduration-h = 1\n[metrics]\nwindow-min = 60");
    let told = problem("[time]\nstep-s = 600\n[metrics]\nwindow-min = 10");
    let expected = "study.toml:4: metrics.window-min: a window of 10 min holds one instant, since the step is 10 min";
    assert!(told.contains(expected), "{told}");
    refuses(
        "metrics",
        "window-min = 0",
        "window-min",
        "expected a number > 0",
    );
}

#[test]
fn quantities_need_what_they_are_computed_from() {
    let without = "[gnss]\nconstellations = []\n[objectives]\n";
    for goals in [
        "minimize = [\"satellites\", \"gain-max-pdop\"]",
        "constraints = [\"gain-mean-pdop >= 0.2\"]",
    ] {
        let told = problem(&format!("{without}{goals}"));
        let (key, rest) = goals.split_once(" = ").unwrap();
        let named = if rest.contains("max") {
            "gain-max-pdop"
        } else {
            "gain-mean-pdop"
        };
        let expected = format!(
            "study.toml:4: objectives.{key}: {named} needs a GNSS to gain over, from `gnss.constellations` or `gnss.files`"
        );
        assert!(told.starts_with(&expected), "{told}");
        reads(&format!("[objectives]\n{goals}"));
    }
    for (text, expected) in [
        (
            "[objectives]\nconstraints = [\"gain-sigma-v-m >= 1\"]",
            "study.toml:2: objectives.constraints: gain-sigma-v-m needs the range errors of [accuracy]",
        ),
        (
            "[objectives]\nminimize = [\"sigma-h-m\", \"satellites\"]",
            "study.toml:2: objectives.minimize: sigma-h-m needs the range errors of [accuracy]",
        ),
        (
            "[objectives]\nconstraints = [\"error95-3d-m <= 2\"]",
            "study.toml:2: objectives.constraints: error95-3d-m needs the range errors of [accuracy]",
        ),
        (
            "[objectives]\nconstraints = [\"information-pdop <= 2\"]",
            "study.toml:2: objectives.constraints: information-pdop needs `metrics.window-min`",
        ),
    ] {
        let told = problem(text);
        assert!(told.starts_with(expected), "{told}");
    }
    // Each is told at its place in the list.
    let told =
        problem("[objectives]\nminimize = [\"satellites\",\n  \"sigma-h-m\", \"sigma-v-m\"]");
    let places = "study.toml:3: objectives.minimize: sigma-h-m needs the range errors of [accuracy]
  3 |   \"sigma-h-m\", \"sigma-v-m\"]
    |   ^^^^^^^^^^^
study.toml:3: objectives.minimize: sigma-v-m needs the range errors of [accuracy]
  3 |   \"sigma-h-m\", \"sigma-v-m\"]
    |                ^^^^^^^^^^^";
    assert_eq!(told.trim_end(), places);
    reads(
        "[accuracy]\nleo-m = 1\nbeidou-3-m = 1\n[objectives]\nconstraints = [\"error95-v-m <= 2\"]",
    );
}

#[test]
fn parts_have_no_clocks_where_all_systems_share_one() {
    let told = problem("[gnss]\nclocks = \"shared\"\nleo-clocks = \"per-part\"");
    assert!(
        told.starts_with(
            "study.toml:3: gnss.leo-clocks: \"per-part\" needs `gnss.clocks` = \"per-system\""
        ),
        "{told}"
    );
}

//! `validate` of designs of several shells, of several constellations, and of satellites from files.

use crate::cli::{Ran, ran};
use serde_json::Value;
use std::path::Path;
use tempfile::TempDir;

const SHORT: [&str; 6] = [
    "--set",
    "time.duration-h=2",
    "--set",
    "time.step-s=300",
    "--set",
    "region.step-deg=20",
];
const HYBRID: &str = "delta:53:20/5/1@1000+star:87:8/2/0@1100";

fn run(directory: &Path, command: &str, further: &[&str]) -> Ran {
    let ran = ran(
        directory,
        &[&[command, "--quiet"], &SHORT[..], further].concat(),
    );
    assert!(ran.status < 2 || ran.stdout.is_empty(), "{}", ran.stderr);
    ran
}

#[track_caller]
fn json(directory: &Path, further: &[&str]) -> Value {
    let ran = run(
        directory,
        "validate",
        &[&["--format", "json"], further].concat(),
    );
    assert_eq!(ran.status, 0, "{}{}", ran.stdout, ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

fn texts<'a>(found: &'a Value, list: &str, key: &str) -> Vec<&'a str> {
    let entries = found[list].as_array().unwrap().iter();
    entries.map(|one| one[key].as_str().unwrap()).collect()
}

/// Every shell by its letter, and the budget of both together first.
#[test]
fn every_shell_is_validated_and_all_of_them_together() {
    let directory = TempDir::new().unwrap();
    let found = json(
        directory.path(),
        &["--design", HYBRID, "--against", "sgp4,analytic"],
    );
    assert_eq!(found["design"]["shells"].as_array().unwrap().len(), 2);
    let names = texts(&found, "checks", "name");
    let of = |start: &str| names.iter().filter(|name| name.starts_with(start)).count();
    assert!(of("A/") > 10 && of("B/") > 10, "{names:?}");
    assert_eq!(of("A/") + of("B/"), names.len());
    let cases = texts(&found, "budget", "case");
    assert_eq!(cases[0], "mean-j2/sgp4");
    assert!(cases.contains(&"A/mean-j2/sgp4") && cases.contains(&"B/mean-j2/sgp4"));
    let budget = found["budget"].as_array().unwrap();
    let rms = |case: &str| {
        let line = budget.iter().find(|line| line["case"] == case).unwrap();
        line["rms_km"]["radial"].as_f64().unwrap()
    };
    let (all, a, b) = (
        rms("mean-j2/sgp4"),
        rms("A/mean-j2/sgp4"),
        rms("B/mean-j2/sgp4"),
    );
    let pooled = ((20.0 * a * a + 8.0 * b * b) / 28.0).sqrt();
    assert!((all / pooled - 1.0).abs() < 1e-12, "{all} {a} {b}");
}

/// A whole export against the design, and its files against each other and against other satellites.
#[test]
fn a_hybrid_and_its_files_are_compared_as_a_whole() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let export = ["--design", HYBRID, "--as", "oem,stk", "--out", "out"];
    assert_eq!(run(place, "export", &export).status, 0);
    let found = json(place, &["--design", HYBRID, "--against", "./out"]);
    for file in found["files"].as_array().unwrap() {
        assert_eq!(file["satellites"].as_array().unwrap().len(), 28);
        assert_eq!(file["agrees"], true, "{file}");
    }
    let files = [
        "--constellation",
        "theirs=out/oem",
        "--against",
        "./out/stk",
    ];
    let found = json(place, &files);
    assert!(found.get("design").is_none());
    assert_eq!(found["constellations"][0]["name"], "theirs");
    assert_eq!(found["constellations"][0]["satellites"], 28);
    assert_eq!(found["files"][0]["agrees"], true);
    let others = ["--constellation", "out/oem", "--exclude", "NW-B-*"];
    let others = [&others[..], &["--against", "./out/oem"]].concat();
    let ran = run(place, "validate", &others);
    // The same selection holds for both sides.
    assert_eq!(ran.status, 0, "{}", ran.stdout);
}

#[test]
fn several_constellations_are_told_apart_by_name() {
    let directory = TempDir::new().unwrap();
    let two = [
        "--design",
        "low=delta:53:20/5/1@700",
        "--design",
        "high=star:87:8/2/0@1100",
        "--against",
        "analytic",
    ];
    let found = json(directory.path(), &two);
    let names = texts(&found, "checks", "name");
    assert!(names.iter().any(|name| name.starts_with("low/analytic/")));
    assert!(names.iter().any(|name| name.starts_with("high/analytic/")));
    assert_eq!(found["constellations"][1]["notation"], "star:87:8/2/0@1100");
}

#[test]
fn a_standard_for_designs_refuses_satellites_from_files() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let export = ["--design", HYBRID, "--as", "oem", "--out", "out"];
    assert_eq!(run(place, "export", &export).status, 0);
    let refused = run(
        place,
        "validate",
        &["--constellation", "out/oem", "--against", "sgp4"],
    );
    assert_eq!(refused.status, 2);
    assert!(
        refused
            .stderr
            .contains("oem: sgp4 checks the propagation of a design"),
        "{}",
        refused.stderr
    );
}

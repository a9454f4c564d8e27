//! Geometry that determines no position, as a user meets it on the command line.

use crate::cli::ran;
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A ring of which every receiver sees two directions at most.
const RING: [&str; 12] = [
    "--set",
    "gnss.constellations=[]",
    "--set",
    "region.latitude-deg=[-30,30]",
    "--set",
    "region.longitude-deg=[-180,165]",
    "--set",
    "region.step-deg=15",
    "--set",
    "time.duration-h=2",
    "--set",
    "time.step-s=600",
];

/// Metrics, dilutions and series of satellites docked to each other, at the usual and the largest
/// cap, of a design and of a file: not one sample is solved, no number is made up, and the reason is
/// said once.
#[test]
fn docked_satellites_solve_nothing_on_any_path() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let design = ["--design", "delta:0:36/6/0@3000"];
    let export = ["export", "--as", "csv", "--out", "ring"];
    let exported = ran(place, &[&export[..], &design, &RING].concat());
    assert_eq!(exported.status, 0, "{}", exported.stderr);
    assert!(exported.stderr.contains("36 satellites are in 6 places"));
    for (source, series) in [
        (design, "a"),
        (["--constellation", "ring/elements.csv"], "b"),
    ] {
        for cap in ["visibility.pdop-cap=100", "visibility.pdop-cap=1e6"] {
            let options = [
                "--dops", "--format", "json", "--force", "--set", cap, "--series", series,
            ];
            let ran = ran(
                place,
                &[&["evaluate"], &source[..], &options, &RING].concat(),
            );
            assert_eq!(ran.status, 0, "{}", ran.stderr);
            let value: Value = serde_json::from_str(&ran.stdout).unwrap();
            let (metrics, dops) = (&value["metrics"], &value["dops"]);
            assert!(metrics["mean_visible"].as_f64().unwrap() > 2.0);
            assert_eq!(metrics["solved_fraction"], 0.0);
            assert_eq!(dops["solved_fraction"], 0.0);
            for nothing in [
                &metrics["mean_pdop"],
                &metrics["max_pdop"],
                &dops["gdop"],
                &dops["vdop"],
                &dops["tdop"][0]["tdop"],
            ] {
                assert_eq!(nothing, &Value::Null, "{value}");
            }
            for file in ["points.csv", "epochs.csv"] {
                let text = fs::read_to_string(place.join(series).join(file)).unwrap();
                let mut lines = text.lines();
                let header: Vec<_> = lines.next().unwrap().split(',').collect();
                let solved = header.iter().position(|&name| name == "solved_fraction");
                let all = lines.map(|line| line.split(',').nth(solved.unwrap()).unwrap());
                assert!(all.into_iter().all(|share| share == "0.0"), "{text}");
            }
            let warnings = ran.stderr.matches("36 satellites are in 6 places").count();
            assert_eq!(warnings, 1, "{}", ran.stderr);
            let named = "(NW-P01-S01 = NW-P02-S06 = NW-P03-S05 = 3 more; ";
            assert!(ran.stderr.contains(named), "{}", ran.stderr);
        }
    }
}

/// LEO alone hardly solves anything: fewest satellites under a bound on PDOP finds nothing feasible.
#[test]
fn a_bound_on_pdop_asks_for_solutions() {
    let directory = TempDir::new().unwrap();
    let arguments = [
        "optimize",
        "--format",
        "json",
        "--set",
        "gnss.constellations=[]",
        "--set",
        "objectives.minimize=[\"satellites\"]",
        "--set",
        "objectives.constraints=[\"mean-pdop <= 20\"]",
        "--set",
        "search.planes=[3, 5]",
        "--set",
        "search.satellites-per-plane=[4, 8]",
        "--set",
        "region.step-deg=20",
        "--set",
        "time.step-s=1200",
        "--set",
        "optimizer.generations=4",
    ];
    let ran = ran(directory.path(), &arguments);
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    let value: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(value["front"], Value::Array(vec![]));
}

/// The cap stops where rounding would decide.
#[test]
fn the_cap_has_a_limit() {
    let stderr = crate::cli::refused(&[
        "evaluate",
        "--design",
        "delta:55:24/6/1@925",
        "--set",
        "visibility.pdop-cap=1.1e6",
    ]);
    assert!(stderr.contains("visibility.pdop-cap"), "{stderr}");
    assert!(stderr.contains("<= 1000000"), "{stderr}");
}

//! Satellites that fail, as a user sees it.

use crate::cli::{ran, refused};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

const SMALL: [&str; 6] = [
    "--set",
    "region.step-deg=20",
    "--set",
    "time.step-s=1200",
    "--set",
    "time.duration-h=6",
];

fn with<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    arguments.iter().chain(&SMALL).copied().collect()
}

fn evaluated(directory: &TempDir, arguments: &[&str]) -> Value {
    let mut all = with(&["evaluate", "--format", "json"]);
    all.extend(arguments);
    let ran = ran(directory.path(), &all);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

/// A plane by name is its satellites one by one, in files of a run too.
#[test]
fn planes_satellites_and_files_are_out_of_service() {
    let place = TempDir::new().unwrap();
    let design = ["--design", "delta:55:12/3/1@925"];
    let whole = evaluated(&place, &design);
    let by_plane = evaluated(
        &place,
        &[&design[..], &["--without", "NW-P02,GEO-2"]].concat(),
    );
    let one_by_one = "NW-P02-S01,NW-P02-S02,NW-P02-S03,NW-P02-S04";
    let by_name = evaluated(
        &place,
        &[
            &design[..],
            &["--without", one_by_one, "--without", "beidou-3:GEO-2"],
        ]
        .concat(),
    );
    assert_eq!(by_plane["metrics"], by_name["metrics"]);
    let visible = |of: &Value| of["metrics"]["mean_visible"].as_f64().unwrap();
    assert!(visible(&by_plane) < 0.8 * visible(&whole));
    assert!(
        by_plane["metrics"]["mean_gnss_visible"].as_f64()
            < whole["metrics"]["mean_gnss_visible"].as_f64()
    );
    assert_ne!(by_plane["scenario"]["hash"], whole["scenario"]["hash"]);

    // Out of service all the time is out of service throughout, but the satellite still counts.
    fs::write(
        place.path().join("NW-P02.int"),
        "stk.v.4.3\nBEGIN IntervalList\nDateUnitAbrv UTCG\nBegin Intervals\n\"31 Dec 2024 00:00:00\" \"2 Jan 2025 00:00:00\"\n\
         END Intervals\nEND IntervalList\n",
    )
    .unwrap();
    let by_file = [
        "--set",
        "outages.file=NW-P02.int",
        "--without",
        "GEO-2",
        "--out",
        "run",
    ];
    let by_file = evaluated(&place, &[&design[..], &by_file].concat());
    assert_eq!(visible(&by_file), visible(&by_plane));
    assert_eq!(
        by_file["metrics"]["mean_pdop"],
        by_plane["metrics"]["mean_pdop"]
    );
    // The run holds a copy of the file, and what is made of it needs no other.
    fs::remove_file(place.path().join("NW-P02.int")).unwrap();
    let copy = fs::read_to_string(place.path().join("run/inputs/1/NW-P02.int")).unwrap();
    assert!(copy.contains("2 Jan 2025"));
    let plotted = ["plot", "run", "--figure", "series", "--out", "series.svg"];
    let plotted = ran(place.path(), &plotted);
    assert_eq!(plotted.status, 0, "{}", plotted.stderr);
    let losses = ["plot", "run", "--figure", "failures", "--as", "csv"];
    let losses = ran(place.path(), &losses);
    assert_eq!(
        (losses.status, losses.stdout.lines().count()),
        (0, 13),
        "{}",
        losses.stderr
    );
}

#[test]
fn bad_outages_are_named() {
    let design = ["--design", "delta:55:12/3/1@925"];
    let of = |arguments: &[&str]| refused(&[&with(&["evaluate"])[..], &design, arguments].concat());
    let error = of(&["--without", "NW-P04-S01"]);
    assert!(error.contains("'NW-P04-S01' is not a satellite or plane of delta:55:12/3/1@925, nor a satellite of beidou-3, did you mean 'NW-P0"), "{error}");
    let error = of(&["--without", "NW-P01,NW-P02,NW-P03"]);
    assert!(
        error.contains("all 12 satellites of delta:55:12/3/1@925 are out of service throughout"),
        "{error}"
    );
    let error = of(&["--set", "outages.file=nowhere.csv"]);
    assert!(error.contains("nowhere.csv: cannot read it"), "{error}");
    let error = refused(&with(&[
        "optimize",
        "--out",
        "run",
        "--set",
        "outages.satellites=[\"NW-P01\"]",
    ]));
    assert!(error.contains("'NW-P01' is no GNSS satellite"), "{error}");

    let place = TempDir::new().unwrap();
    fs::write(
        place.path().join("late.csv"),
        "satellite,start_utc,end_utc\nNW-P01-S01,2025-01-01T06:00:00Z,2025-01-01T07:00:00Z\n",
    )
    .unwrap();
    let arguments = [
        &with(&["evaluate", "--set", "outages.file=late.csv"])[..],
        &design,
    ]
    .concat();
    let late = ran(place.path(), &arguments);
    assert_eq!(late.status, 2);
    assert!(
        late.stderr.contains(
            "late.csv: line 2: 2025-01-01T06:00:00Z to 2025-01-01T07:00:00Z is outside the span of the study, \
             2025-01-01T00:00:00Z to 2025-01-01T06:00:00Z"
        ),
        "{}",
        late.stderr
    );
}

/// The contract of the JSON, against evaluations with `--without`.
#[test]
fn each_failure_is_an_evaluation_without_the_satellite() {
    let place = TempDir::new().unwrap();
    let design = [
        "--design",
        "delta:55:12/3/1@925",
        "--set",
        "objectives.availability-pdop=2",
    ];
    let of = evaluated(&place, &[&design[..], &["--failures", "1"]].concat());
    let failures = &of["failures"];
    assert_eq!(
        (&failures["k"], &failures["draws"]),
        (&1.into(), &Value::Null)
    );
    let satellites = failures["by_satellite"].as_array().unwrap();
    let planes = failures["by_plane"].as_array().unwrap();
    assert_eq!((satellites.len(), planes.len()), (12, 3));
    for part in satellites.iter().step_by(5).chain(planes) {
        let name = part["name"].as_str().unwrap();
        let anew = evaluated(&place, &[&design[..], &["--without", name]].concat());
        for metric in [
            "mean_visible",
            "mean_pdop",
            "cvar_pdop",
            "p95_pdop",
            "max_pdop",
            "availability",
            "longest_outage_s",
        ] {
            let [ours, anew] = [part, &anew].map(|of| of["metrics"][metric].as_f64().unwrap());
            // The lanes of the other path are in f32, their maximum to 1e-5.
            let difference = (ours - anew).abs();
            assert!(difference <= 1e-5 * anew, "{name} {metric}: {ours} {anew}");
        }
    }
    let largest = satellites
        .iter()
        .map(|one| one["metrics"]["max_pdop"].as_f64().unwrap());
    let largest = largest.fold(0.0, f64::max);
    assert_eq!(
        failures["worst"]["max_pdop"]["value"].as_f64(),
        Some(largest)
    );
    let mean: f64 = satellites
        .iter()
        .map(|one| one["metrics"]["cvar_pdop"].as_f64().unwrap())
        .sum();
    let mean = mean / 12.0 - failures["mean"]["cvar_pdop"].as_f64().unwrap();
    assert!(mean.abs() < 1e-12, "{mean}");
    let csv = with(&[
        "evaluate",
        "--format",
        "csv",
        "--failures",
        "1",
        "--design",
        "delta:55:12/3/1@925",
    ]);
    let csv = ran(place.path(), &csv).stdout;
    assert_eq!(csv.lines().count(), 1 + 12 + 3);
    assert!(
        csv.starts_with("name,lost,without,satellites_lost,mean_visible,"),
        "{csv}"
    );
    let error = refused(&with(&[
        "evaluate",
        "--design",
        "delta:55:2/2/1@925",
        "--failures",
        "2",
    ]));
    assert!(
        error.contains("--failures 2: delta:55:2/2/1@925 has 2 satellites, and one must be left"),
        "{error}"
    );
}

/// All pairs of few satellites are brute force; of many, draws of the seed and a search that finds a set at least as bad.
#[test]
fn pairs_are_all_or_drawn() {
    let place = TempDir::new().unwrap();
    let design = ["--design", "delta:55:8/2/1@925"];
    let pairs = evaluated(&place, &[&design[..], &["--failures", "2"]].concat());
    let pairs = &pairs["failures"];
    assert_eq!(
        (&pairs["cases"], &pairs["worst_is"]),
        (&28.into(), &"exact".into())
    );
    let worst = &pairs["worst"]["cvar_pdop"];
    let without = worst["without"].as_array().unwrap().iter();
    let without: Vec<&str> = without.map(|name| name.as_str().unwrap()).collect();
    let anew = evaluated(
        &place,
        &[&design[..], &["--without", &without.join(",")]].concat(),
    );
    let [ours, anew] =
        [&worst["value"], &anew["metrics"]["cvar_pdop"]].map(|of| of.as_f64().unwrap());
    assert!((ours / anew - 1.0).abs() < 1e-6, "{ours} {anew}");

    let many = [
        "--design",
        "delta:55:30/5/1@925",
        "--failures",
        "3",
        "--draws",
        "40",
    ];
    let first = evaluated(&place, &many);
    assert_eq!(first, evaluated(&place, &many));
    let drawn = &first["failures"];
    assert_eq!(
        (&drawn["draws"], &drawn["worst_is"]),
        (&40.into(), &"found-not-proved".into())
    );
    assert!(
        drawn["spread"]["mean_visible"]["standard_error"]
            .as_f64()
            .unwrap()
            > 0.0
    );
    let [worst, drawn] = [
        &drawn["worst"]["cvar_pdop"]["value"],
        &drawn["spread"]["cvar_pdop"]["max"],
    ];
    assert!(worst.as_f64() >= drawn.as_f64(), "{worst} {drawn}");
    let other = evaluated(
        &place,
        &[&many[..], &["--set", "optimizer.seed=2"]].concat(),
    );
    assert_ne!(first["failures"]["spread"], other["failures"]["spread"]);
}

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

/// A build-up and its retirement: each phase is an evaluation without what is not in service, and says when service begins.
#[test]
fn phases_say_when_service_begins_and_ends() {
    let place = TempDir::new().unwrap();
    fs::write(
        place.path().join("phases.csv"),
        "phase,add,remove\n2026,NW-P01,\n2027,NW-P02 NW-P03,\n2031,,NW-P01-S02\n",
    )
    .unwrap();
    let design = ["--design", "delta:55:12/3/1@925"];
    let of = |without: &str| evaluated(&place, &[&design[..], &["--without", without]].concat());
    let first = of("NW-P02,NW-P03");
    let bound = first["metrics"]["mean_pdop"].as_f64().unwrap() - 1e-3;
    let requires = format!("objectives.constraints=[\"mean-pdop <= {bound}\"]");
    let arguments = ["--phases", "phases.csv", "--set", &requires];
    let all = evaluated(&place, &[&design[..], &arguments].concat());
    let phases = &all["phases"];
    let rows = phases["phases"].as_array().unwrap();
    for (row, anew) in rows
        .iter()
        .zip([first, evaluated(&place, &design), of("NW-P01-S02")])
    {
        assert_eq!(
            row["metrics"]["mean_visible"],
            anew["metrics"]["mean_visible"]
        );
        assert_eq!(row["metrics"]["max_pdop"], anew["metrics"]["max_pdop"]);
    }
    let counts: Vec<_> = rows
        .iter()
        .map(|row| row["satellites"].as_u64().unwrap())
        .collect();
    assert_eq!(counts, [4, 12, 11]);
    assert_eq!(
        (&phases["service_begins"], &phases["service_ends"]),
        (&"2027".into(), &Value::Null)
    );
    let text = with(&[&["evaluate"], &design[..], &arguments].concat());
    let text = ran(place.path(), &text);
    assert!(
        text.stdout
            .contains("service begins in 2027 (mean-pdop <= "),
        "{}",
        text.stdout
    );
    let csv = with(
        &[
            &["evaluate", "--format", "csv"],
            &design[..],
            &arguments[..2],
        ]
        .concat(),
    );
    let csv = ran(place.path(), &csv).stdout;
    assert!(
        csv.starts_with("name,phase,satellites,serves,mean_visible,"),
        "{csv}"
    );
    assert_eq!(csv.lines().count(), 4);

    // Bad tables and names, with the line.
    let refused = |table: &str, more: &[&str]| {
        fs::write(place.path().join("bad.csv"), table).unwrap();
        let arguments = [&["evaluate", "--phases", "bad.csv"], &design[..], more].concat();
        let ran = ran(place.path(), &with(&arguments));
        assert_eq!(ran.status, 2, "{}", ran.stderr);
        ran.stderr
    };
    let error = refused("phase,add\na,NW-P01\nb,NW-P09\n", &[]);
    assert!(
        error.contains("bad.csv, line 3: 'NW-P09' is not a satellite or plane of delta:55:12/3/1@925, did you mean 'NW-P0"),
        "{error}"
    );
    let error = refused("phase,when\na,NW-P01\n", &[]);
    assert!(
        error.contains("bad.csv") && error.contains("line 1: found the column 'when'"),
        "{error}"
    );
    let error = refused("phase,add\na,NW-P01\nb,NW-P01\n", &[]);
    assert!(
        error.contains(
            "bad.csv, line 3: NW-P01-S01 is added in phase b, and it is in service already"
        ),
        "{error}"
    );
    let bound = ["--set", "objectives.constraints=[\"satellites <= 12\"]"];
    let error = refused("phase,add\na,NW-P01\n", &bound);
    assert!(
        error.contains("satellites <= 12 is not of its service"),
        "{error}"
    );
}

/// Spares raise what is expected, the draws are of the seed, and satellites of no plane have none.
#[test]
fn spares_are_drawn_from_the_seed() {
    let place = TempDir::new().unwrap();
    let of = |more: &[&str]| {
        let common = [
            "--design",
            "delta:55:24/3/1@925",
            "--set",
            "reliability.availability=0.8",
        ];
        evaluated(&place, &[&common[..], more].concat())["expected"].clone()
    };
    let spares = ["--set", "reliability.spares-per-plane=2"];
    let ours = of(&spares);
    assert_eq!(
        (&ours["spares_per_plane"], &ours["draws"]["draws"]),
        (&2.into(), &200.into())
    );
    // Ten satellites a plane, of which more than two down leave slots vacant.
    let down = |n: i32, ways: f64| ways * 0.2_f64.powi(n) * 0.8_f64.powi(10 - n);
    let filled = (down(0, 1.0) + down(1, 10.0) + down(2, 45.0)).powi(3);
    assert!((ours["all_filled"].as_f64().unwrap() - filled).abs() < 1e-12);
    let visible = |of: &Value| of["mean_visible"].as_f64().unwrap();
    assert!(visible(&ours) > 1.1 * visible(&of(&[])));
    assert_eq!(ours, of(&spares));
    assert_ne!(
        ours,
        of(&[&spares[..], &["--set", "optimizer.seed=2"]].concat())
    );
    let more = of(&[&spares[..], &["--draws", "800"]].concat());
    let error = more["draws"]["availability_standard_error"]
        .as_f64()
        .unwrap();
    assert!(
        error
            <= ours["draws"]["availability_standard_error"]
                .as_f64()
                .unwrap()
    );

    let design = ["evaluate", "--design", "delta:55:12/3/1@925"];
    let error = refused(&with(&[&design[..], &["--draws", "5"]].concat()));
    assert!(
        error.contains(
            "--draws: nothing is drawn without --failures or reliability.spares-per-plane"
        ),
        "{error}"
    );
    let error = refused(&with(&[&design[..], &spares].concat()));
    assert!(error.contains("reliability.spares-per-plane"), "{error}");
    let up = ["--set", "reliability.availability=0.9"];
    let goal = ["--set", "objectives.minimize=[\"expected-availability\"]"];
    let error = refused(&with(&[&design[..], &up, &spares, &goal].concat()));
    assert!(
        error.contains("expected-availability") && error.contains("spares-per-plane"),
        "{error}"
    );
}

/// Intervals that have no effect, or only a part of one, are warned of; a misspelt name is not a matter of propagation.
#[test]
fn outages_without_effect_are_warned_of() {
    let place = TempDir::new().unwrap();
    fs::write(
        place.path().join("odd.csv"),
        "satellite,start_utc,end_utc\nNW-P01-S01,2025-01-01T00:20:10Z,2025-01-01T00:39:00Z\n\
         NW-P01-S02,2024-12-31T00:00:00Z,2025-01-01T01:00:00Z\n",
    )
    .unwrap();
    let arguments = [
        "evaluate",
        "--design",
        "delta:55:12/3/1@925",
        "--set",
        "outages.file=odd.csv",
    ];
    let warned = ran(place.path(), &with(&arguments));
    assert_eq!(warned.status, 0, "{}", warned.stderr);
    for expected in [
        "odd.csv, line 2: NW-P01-S01 is out of service from 2025-01-01T00:20:10Z to 2025-01-01T00:39:00Z, between two samples 1200 s \
         apart: it has no effect",
        "odd.csv, line 3: NW-P01-S02 is out of service from 2024-12-31T00:00:00Z to 2025-01-01T01:00:00Z, of which only what is within",
    ] {
        assert!(warned.stderr.contains(expected), "{}", warned.stderr);
    }
    let error = refused(&with(&[&arguments[..3], &["--without", "NW-P09"]].concat()));
    assert!(
        !error.contains("propagate") && error.contains("'NW-P09' is not a satellite"),
        "{error}"
    );
}

/// Searches warn of them, too, where they are of the GNSS.
#[test]
fn searches_warn_of_outages_without_effect() {
    let place = TempDir::new().unwrap();
    let intervals =
        "satellite,start_utc,end_utc\nGEO-2,2024-12-31T00:00:00Z,2025-01-01T01:00:00Z\n";
    fs::write(place.path().join("odd.csv"), intervals).unwrap();
    let few = [
        "optimizer.population=4",
        "optimizer.generations=1",
        "search.planes=[2, 3]",
        "search.satellites-per-plane=[2, 3]",
        "objectives.constraints=[\"mean-pdop <= 9\"]",
        "outages.file=odd.csv",
    ];
    let settings: Vec<&str> = few.iter().flat_map(|&key| ["--set", key]).collect();
    for command in ["optimize", "size"] {
        let arguments = [&[command, "--out", command], &settings[..]].concat();
        let warned = ran(place.path(), &with(&arguments));
        assert_eq!(warned.status, 0, "{}", warned.stderr);
        let expected = "odd.csv, line 2: GEO-2 is out of service from 2024-12-31T00:00:00Z to 2025-01-01T01:00:00Z, of which only what";
        assert_eq!(
            warned.stderr.matches(expected).count(),
            1,
            "{}",
            warned.stderr
        );
    }
}

/// What `--without` does in the other commands: what is shown is without the satellites, and what writes all says so.
#[test]
fn other_commands_take_or_refuse_without() {
    let place = TempDir::new().unwrap();
    let design = ["--design", "delta:55:12/3/1@925"];
    let plot = |more: &[&str]| {
        let arguments = [&["plot", "--as", "csv"], &design[..], more].concat();
        let ran = ran(place.path(), &with(&arguments));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        ran.stdout
    };
    let map = ["--figure", "map"];
    let whole = plot(&map);
    let without = plot(&[&map[..], &["--without", "NW-P02"]].concat());
    let outages = plot(&[&map[..], &["--set", "outages.satellites=[\"NW-P02\"]"]].concat());
    assert!(whole != without && without == outages);
    let arguments = [
        &["validate", "--without", "NW-P02", "--against", "sgp4"],
        &design[..],
    ]
    .concat();
    let error = refused(&arguments);
    let expected = "--without NW-P02: validate compares every satellite, in service or not";
    assert!(error.contains(expected), "{error}");
}

/// An export without some satellites has the others as they are among all: names, numbers and elements; by the flag as by the scenario,
/// and what is read back is what was exported.
#[test]
fn an_export_leaves_out_what_is_out_of_service() {
    let place = TempDir::new().unwrap();
    let design = ["--design", "B=delta:53:12/3/1@1000+star:90:4/2/1@1100"];
    let export = |out: &str, more: &[&str]| {
        let products = ["export", "--as", "tle,csv,oem,stk,czml", "--out", out];
        let ran = ran(
            place.path(),
            &with(&[&products[..], &design[..], more].concat()),
        );
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        crate::common::contents(&place.path().join(out))
    };
    let text =
        |out: &str, name: &str| fs::read_to_string(place.path().join(out).join(name)).unwrap();
    let whole = export("whole", &["--check"]);
    let left = export("left", &["--without", "NW-A-P02,NW-B-P01-S02", "--check"]);
    let key = "outages.satellites=[\"NW-A-P02\",\"NW-B-P01-S02\",\"GEO-1\"]";
    export("key", &["--set", key]);
    assert_eq!(
        text("key", "constellation.tle"),
        text("left", "constellation.tle")
    );
    let of_whole: Vec<_> = whole
        .keys()
        .filter(|path| path.starts_with("oem"))
        .collect();
    let of_left: Vec<_> = left.keys().filter(|path| path.starts_with("oem")).collect();
    assert_eq!((of_whole.len(), of_left.len()), (16, 11));
    assert!(of_left.iter().all(|name| of_whole.contains(name)));
    let (all, kept) = (
        text("whole", "constellation.tle"),
        text("left", "constellation.tle"),
    );
    let of_lost = |name: &str| name.starts_with("NW-A-P02-") || name == "NW-B-P01-S02";
    let lines: Vec<&str> = all.lines().collect();
    let expected = lines.chunks(3).filter(|set| !of_lost(set[0].trim()));
    let expected: Vec<&str> = expected.flatten().copied().collect();
    assert_eq!(kept.lines().collect::<Vec<_>>(), expected);
    let manifest = text("left", "manifest.json");
    assert!(manifest.contains("\"out_of_service\": 5"), "{manifest}");
    assert!(!text("whole", "manifest.json").contains("out_of_service"));
    let oem = String::from_utf8(left[of_left[0]].clone()).unwrap();
    assert!(
        oem.contains("Out of service, and not here: 5 satellites of 16"),
        "{oem}"
    );
    let wrong = [
        "export",
        "--as",
        "tle",
        "--out",
        "x",
        "--without",
        "NW-A-P09",
    ];
    let error = refused(&[&wrong[..], &design[..]].concat());
    assert!(
        error.contains("'NW-A-P09' is not a satellite or plane of B"),
        "{error}"
    );
}

/// The map of the worst loss has, at each point, the worst of the maps without each satellite.
#[test]
fn the_map_of_the_worst_loss_is_that_of_all_maps() {
    let place = TempDir::new().unwrap();
    let column = |more: &[&str], name: &str| -> Vec<f64> {
        let common = [
            "plot",
            "--figure",
            "map",
            "--as",
            "csv",
            "--design",
            "delta:55:6/3/1@925",
        ];
        let ran = ran(place.path(), &with(&[&common[..], more].concat()));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let mut lines = ran
            .stdout
            .lines()
            .map(|line| line.split(',').collect::<Vec<_>>());
        let header = lines.next().unwrap();
        let at = header.iter().position(|one| *one == name).unwrap();
        lines.map(|line| line[at].parse().unwrap()).collect()
    };
    let worst = column(&["--measure", "n1-max-pdop"], "n1_max_pdop");
    let mut expected = vec![0.0_f64; worst.len()];
    for plane in 1..=3 {
        for slot in 1..=2 {
            let name = format!("NW-P0{plane}-S0{slot}");
            let one = column(&["--without", &name], "max_pdop");
            expected = expected.iter().zip(one).map(|(a, b)| a.max(b)).collect();
        }
    }
    for (ours, expected) in worst.iter().zip(&expected) {
        // The map of one constellation is in f32.
        assert!((ours / expected - 1.0).abs() < 1e-6, "{ours} {expected}");
    }
    let error = refused(&with(&[
        "plot",
        "--figure",
        "series",
        "--measure",
        "n1-max-pdop",
        "--design",
        "delta:55:6/3/1@925",
    ]));
    assert!(
        error.contains("figure series cannot show n1-max-pdop"),
        "{error}"
    );
}

/// The figure of failures has a row for each set, as many as are drawn.
#[test]
fn the_figure_of_failures_is_over_sets_too() {
    let place = TempDir::new().unwrap();
    let rows = |more: &[&str]| {
        let common = ["plot", "--figure", "failures", "--as", "csv"];
        let ran = ran(place.path(), &with(&[&common[..], more].concat()));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        ran.stdout
    };
    let pairs = rows(&["--design", "delta:55:8/2/1@925", "--failures", "2"]);
    assert_eq!(pairs.lines().count(), 1 + 28);
    assert!(pairs.contains(",NW-P01-S01+NW-P01-S02,"), "{pairs}");
    let many = [
        "--design",
        "delta:55:30/5/1@925",
        "--failures",
        "3",
        "--draws",
        "7",
    ];
    assert_eq!(rows(&many).lines().count(), 1 + 7);
    let error = refused(&with(&[
        "plot",
        "--figure",
        "map",
        "--failures",
        "2",
        "--design",
        "delta:55:8/2/1@925",
    ]));
    assert!(
        error.contains("--failures and --draws are of the figure failures, not of map"),
        "{error}"
    );
    // What is evaluated anew for each case is told.
    let metres = [
        "--set",
        "accuracy.leo-m=1",
        "--set",
        "accuracy.beidou-3-m=1",
    ];
    let of = [
        "evaluate",
        "--design",
        "delta:55:4/2/1@925",
        "--failures",
        "1",
    ];
    let told = ran(place.path(), &with(&[&of[..], &metres].concat()));
    assert!(
        told.stderr
            .contains("each case takes an evaluation of its own for the accuracy in metres"),
        "{}",
        told.stderr
    );
}

/// The section of the page has the worst case of `evaluate --failures` first, and both figures; without the flag there is none.
#[test]
fn the_report_has_the_losses() {
    let place = TempDir::new().unwrap();
    let design = ["--design", "delta:55:30/5/1@925"];
    let page = |more: &[&str]| {
        let arguments = [&["report", "--out", "page.html"], &design[..], more].concat();
        let ran = ran(place.path(), &with(&arguments));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        fs::read_to_string(place.path().join("page.html")).unwrap()
    };
    assert!(!page(&[]).contains("id=\"failures\""));
    let html = page(&["--failures", "1"]);
    let section = html.split("<section id=\"failures\">").nth(1).unwrap();
    let section = section.split("</section>").next().unwrap();
    assert_eq!(section.matches("data:image/svg+xml;base64,").count(), 2);
    assert_eq!(section.matches("<tr><td>NW-").count(), 20);
    assert!(
        section.contains("1 satellite, all 30 cases") && section.contains("10 more are left out"),
        "{section}"
    );
    let evaluated = evaluated(&place, &[&design[..], &["--failures", "1"]].concat());
    let worst = evaluated["failures"]["worst"]["cvar_pdop"]["without"][0]
        .as_str()
        .unwrap();
    let first = section.find("<tr><td>NW-").unwrap();
    assert!(
        section[first..].starts_with(&format!("<tr><td>{worst}</td>")),
        "{worst}"
    );
}

/// The figure of phases has the rows of `evaluate --phases`.
#[test]
fn the_figure_of_phases_has_a_row_each() {
    let place = TempDir::new().unwrap();
    fs::write(
        place.path().join("phases.csv"),
        "phase,add\na,NW-P01\nb,NW-P02 NW-P03\n",
    )
    .unwrap();
    let design = ["--design", "delta:55:12/3/1@925", "--phases", "phases.csv"];
    let plot = with(&[&["plot", "--figure", "phases", "--as", "csv"], &design[..]].concat());
    let plot = ran(place.path(), &plot);
    assert_eq!(plot.status, 0, "{}", plot.stderr);
    let rows: Vec<Vec<&str>> = plot
        .stdout
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let evaluated = evaluated(&place, &design);
    let phases = evaluated["phases"]["phases"].as_array().unwrap();
    assert_eq!(rows.len(), 1 + phases.len());
    for (row, phase) in rows[1..].iter().zip(phases) {
        assert_eq!(row[2], phase["phase"].as_str().unwrap());
        assert_eq!(row[3].parse::<u64>().ok(), phase["satellites"].as_u64());
        assert_eq!(
            row[5].parse::<f64>().ok(),
            phase["metrics"]["mean_pdop"].as_f64()
        );
    }
    let of = [
        "plot",
        "--figure",
        "phases",
        "--design",
        "delta:55:12/3/1@925",
    ];
    assert!(refused(&with(&of)).contains("figure phases needs its table: give --phases FILE"));
}

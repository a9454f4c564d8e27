//! Run directories: they stand alone, and what is found there is checked.

use crate::cli::{Ran, optimize, ran};
use crate::common::contents;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const POINTS: &str = "name,latitude_deg,longitude_deg,country\nBrest,48,-4,FR\n,52,5,NL\n";

/// A directory `study/` with a scenario that names a file of points and one of a GNSS.
fn with_files() -> TempDir {
    let directory = TempDir::new().unwrap();
    let export = "export --quiet --design delta:56:24/3/1@21528 --as tle --out gps";
    let export: Vec<&str> = export.split(' ').collect();
    assert_eq!(ran(directory.path(), &export).status, 0);
    let study = directory.path().join("study");
    fs::create_dir(&study).unwrap();
    let tle = directory.path().join("gps/constellation.tle");
    fs::rename(tle, study.join("gps.tle")).unwrap();
    fs::write(study.join("points.csv"), POINTS).unwrap();
    let text = "name = \"mine\"\n[time]\nstep-s = 7200\n[region]\npoints = \"points.csv\"\n\
                [gnss]\nconstellations = []\nfiles = [\"gps.tle\"]\n\
                [search]\nplanes = [5, 6]\nsatellites-per-plane = [5, 6]\n\
                [optimizer]\npopulation = 8\ngenerations = 3\n";
    fs::write(study.join("study.toml"), text).unwrap();
    directory
}

fn run(directory: &Path, line: &str) -> Ran {
    ran(directory, &line.split(' ').collect::<Vec<_>>())
}

#[track_caller]
fn done(directory: &Path, line: &str) -> Ran {
    let ran = run(directory, line);
    assert_eq!(ran.status, 0, "{line}: {}", ran.stderr);
    ran
}

/// Runs what cannot be run; what it says.
#[track_caller]
fn stopped(directory: &Path, line: &str, message: &str) {
    let ran = run(directory, line);
    assert_eq!(ran.status, 2, "{line}: {}{}", ran.stdout, ran.stderr);
    assert!(ran.stderr.contains(message), "{line}: {}", ran.stderr);
}

#[test]
fn a_run_needs_none_of_the_files_of_its_scenario() {
    let directory = with_files();
    let place = directory.path();
    done(place, "optimize study/study.toml --quiet --out run");
    done(
        place,
        "optimize study/study.toml --quiet --out whole --set optimizer.generations=6",
    );
    let text = fs::read_to_string(place.join("run/scenario.toml")).unwrap();
    assert!(text.contains("points = \"inputs/1/points.csv\""), "{text}");
    assert!(text.contains("files = [\"inputs/2/gps.tle\"]"), "{text}");
    for (name, bytes) in contents(&place.join("run")) {
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let is_free = !text.contains(&*place.to_string_lossy());
        assert!(is_free, "{} holds a path", name.display());
    }
    fs::remove_dir_all(place.join("study")).unwrap();
    let elsewhere = place.join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let report = done(&elsewhere, "report ../run");
    assert_eq!(
        report.stderr,
        "warning: inputs/1/points.csv: columns ignored: country\n"
    );
    done(&elsewhere, "plot ../run --figure map --out map.svg");
    let table = fs::read_to_string(elsewhere.join("map.csv")).unwrap();
    assert!(table.lines().nth(1).unwrap().ends_with(",Brest"), "{table}");
    done(
        &elsewhere,
        "export --run ../run --as tle,metrics --out exports",
    );
    done(&elsewhere, "validate --run ../run --against geographiclib");
    // The stored scenario is a scenario like any other, of the same hash.
    done(
        &elsewhere,
        "optimize ../run/scenario.toml --quiet --out again",
    );
    fs::remove_file(place.join("run/report.html")).unwrap();
    assert!(contents(&place.join("run")) == contents(&elsewhere.join("again")));
    // The run itself can be continued, named by its directory or by its scenario.
    done(
        &elsewhere,
        "optimize --quiet --resume --out ../run --set optimizer.generations=5",
    );
    done(
        &elsewhere,
        "optimize ../run/scenario.toml --quiet --resume --out ../run --set optimizer.generations=6",
    );
    // The checkpoint before the last knows the generations that were asked for then.
    for run in ["run", "whole"] {
        fs::remove_file(place.join(run).join("checkpoint.previous")).unwrap();
    }
    assert!(contents(&place.join("run")) == contents(&place.join("whole")));
}

#[test]
fn a_run_keeps_its_constellations_and_is_compared_with_their_designs() {
    let directory = with_files();
    let place = directory.path();
    done(place, "optimize study/study.toml --quiet --out plain");
    let scenario = place.join("study/study.toml");
    let text = fs::read_to_string(&scenario).unwrap();
    let named = "[constellations]\ndense = \"delta:50:144/12/1@2000\"\nfleet = { files = [\"fleet.tle\"] }\n";
    fs::write(&scenario, text + named).unwrap();
    let fleet = place.join("study/fleet.tle");
    fs::copy(place.join("study/gps.tle"), &fleet).unwrap();
    let line = "optimize study/study.toml --quiet --format json --out run";
    let result: Value = serde_json::from_str(&done(place, line).stdout).unwrap();
    let diagnostics = result["diagnostics"].as_array().unwrap();
    let told = diagnostics
        .iter()
        .filter(|one| one["code"] == "pick-dominated");
    let told: Vec<&str> = told.filter_map(|one| one["message"].as_str()).collect();
    let dense = "the constellation dense delta:50:144/12/1@2000 (j-pos ";
    assert!(told.iter().any(|told| told.starts_with(dense)), "{told:?}");
    // The search is the same with and without them.
    let hash = |run: &str| -> Value {
        let manifest = fs::read(place.join(run).join("run.json")).unwrap();
        let manifest: Value = serde_json::from_slice(&manifest).unwrap();
        manifest["scenario_hash"].clone()
    };
    assert_eq!(hash("run"), hash("plain"));
    let front = |run: &str| fs::read(place.join(run).join("front.csv")).unwrap();
    assert_eq!(front("run"), front("plain"));
    let text = fs::read_to_string(place.join("run/scenario.toml")).unwrap();
    let copy = "fleet = { files = [\"inputs/3/fleet.tle\"] }";
    assert!(text.contains(copy), "{text}");
    let copy = place.join("run/inputs/3/fleet.tle");
    let bytes = fs::read(&copy).unwrap();
    fs::write(&copy, &bytes[1..]).unwrap();
    stopped(place, "report run", "inputs/3/fleet.tle: checksum mismatch");
    fs::write(&copy, bytes).unwrap();
    done(place, "report run");
    // A search goes on with the copies, and without them if the constellations are others by now.
    fs::remove_file(&fleet).unwrap();
    let resumed = done(place, "optimize study/study.toml --resume --out run");
    let gone = "fleet.tle is missing or has changed since the run began";
    assert!(resumed.stderr.contains(gone), "{}", resumed.stderr);
    fs::remove_file(place.join("study/gps.tle")).unwrap();
    let other = "--set constellations.other=delta:55:4/2/1@925 --set constellations.fleet=delta:55:6/2/1@925";
    done(
        place,
        &format!("optimize study/study.toml --quiet --resume --out run {other}"),
    );
    let text = fs::read_to_string(place.join("run/scenario.toml")).unwrap();
    assert!(
        text.contains("fleet = \"delta:55:6/2/1@925\", other = "),
        "{text}"
    );
}

#[test]
fn seeds_stand_alone_too() {
    let directory = with_files();
    let place = directory.path();
    done(
        place,
        "optimize study/study.toml --quiet --seeds 2 --out runs",
    );
    fs::remove_dir_all(place.join("study")).unwrap();
    done(place, "report runs/seed-2");
    // The runs go on without the files, and one that is missing is made from their copies.
    fs::remove_dir_all(place.join("runs/seed-2")).unwrap();
    let resumed = done(
        place,
        "optimize --quiet --resume --seeds 3 --out runs --format csv",
    );
    assert_eq!(resumed.stdout.lines().count(), 1 + 3, "{}", resumed.stdout);
    done(place, "report runs/seed-3");
}

/// Seeds by shards in any order, and joined, leave what one process leaves.
#[test]
fn seeds_of_shards_are_those_of_one_process() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let seeds = |further: &[&str]| {
        let further = [&["--seeds", "3", "--format", "json"], further].concat();
        let ran = ran(place, &optimize(&further));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        ran.stdout
    };
    let whole = seeds(&["--out", "whole"]);
    for (shard, made) in [("2/2", vec![2]), ("1/2", vec![1, 2, 3])] {
        assert_eq!(seeds(&["--out", "parts", "--shard", shard]), "");
        let names = made.iter().map(|seed| format!("seed-{seed}"));
        let entries = fs::read_dir(place.join("parts")).unwrap();
        let mut found: Vec<_> = entries
            .map(|entry| entry.unwrap().file_name().display().to_string())
            .collect();
        found.sort();
        assert_eq!(found, names.collect::<Vec<_>>());
    }
    assert_eq!(seeds(&["--out", "parts", "--resume"]), whole);
    let [parts, whole] = ["parts", "whole"].map(|name| contents(&place.join(name)));
    assert_eq!(parts, whole);
}

#[test]
fn a_run_goes_on_with_its_own_files() {
    let directory = with_files();
    let place = directory.path();
    done(place, "optimize study/study.toml --quiet --out run");
    done(
        place,
        "optimize study/study.toml --quiet --out whole --set optimizer.generations=5",
    );
    fs::write(
        place.join("study/points.csv"),
        "latitude_deg,longitude_deg\n0,0\n",
    )
    .unwrap();
    stopped(
        place,
        "optimize study/study.toml --out run",
        "run holds a run of another scenario: points.csv has other contents; choose another",
    );
    let longer = "optimize study/study.toml --resume --out run --set optimizer.generations=5";
    let resumed = done(place, longer);
    let warning = "points.csv is missing or has changed since the run began; using its copy in run";
    assert!(resumed.stderr.contains(warning), "{}", resumed.stderr);
    assert!(contents(&place.join("run")) == contents(&place.join("whole")));
}

#[test]
fn a_changed_input_of_a_run_is_noticed() {
    let directory = with_files();
    let place = directory.path();
    done(place, "optimize study/study.toml --quiet --out run");
    let copy = place.join("run/inputs/1/points.csv");
    fs::write(&copy, POINTS.replace("48", "47")).unwrap();
    let message = "inputs/1/points.csv: checksum mismatch";
    for line in [
        "report run",
        "plot run --figure map",
        "validate --run run --against sgp4",
        "export --run run --as tle --out exports",
        "optimize --resume --out run",
    ] {
        stopped(place, line, message);
    }
    assert!(!place.join("exports").exists() && !place.join("run/report.html").exists());
    fs::remove_file(&copy).unwrap();
    stopped(
        place,
        "validate --run run --against sgp4",
        "region.points: cannot read inputs/1/points.csv",
    );
}

/// What differs is named with both values, of a run that is begun as of one that is resumed.
#[test]
fn a_run_of_another_scenario_says_what_differs() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    let other = [
        "--out",
        "run",
        "--set",
        "visibility.mask-deg=12",
        "--seed",
        "4",
    ];
    // A mask that is set for the paper's scenario is that of its GNSS too; in the run both are given.
    let of_default = "visibility.gnss-mask-deg is 7 there and 12 here, ";
    for further in [&[][..], &["--resume"]] {
        let other = ran(place, &optimize(&[&other, further].concat()));
        assert_eq!(other.status, 2, "{}", other.stderr);
        let expected = "run holds a run of another scenario: optimizer.seed is 1 there and 4 here, \
                        visibility.mask-deg is 7 there and 12 here; choose another --out";
        assert!(
            other.stderr.replace(of_default, "").contains(expected),
            "{}",
            other.stderr
        );
    }
}

/// The same command with --resume continues the run, whatever its --set options; so does --resume alone.
#[test]
fn the_same_command_resumes() {
    let directory = with_files();
    let place = directory.path();
    let line = "optimize --quiet --set region.points=study/points.csv --set time.step-s=7200 \
                --set optimizer.population=8 --set optimizer.generations=";
    done(place, &format!("{line}5 --out whole"));
    done(place, &format!("{line}3 --out run"));
    done(place, &format!("{line}4 --out run --resume"));
    done(
        place,
        "optimize --quiet --set optimizer.generations=5 --out run --resume",
    );
    for name in [
        "front.json",
        "history.json",
        "scenario.toml",
        "checkpoint",
        "run.json",
    ] {
        let read = |run: &str| fs::read(place.join(run).join(name)).unwrap();
        assert!(read("whole") == read("run"), "{name}");
    }
}

/// An error that is found only when the scenario is set up has its place as any other.
#[test]
fn errors_of_the_setup_have_a_line() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let files = [
        ("none.toml", "\n[region]\npoints = \"none.csv\"\n"),
        ("empty.toml", "[region]\n\n\npoints = \"empty.csv\"\n"),
        ("empty.csv", "latitude_deg,longitude_deg\n"),
        ("gnss.toml", "[gnss]\nfiles = [\n  \"empty.csv\"]\n"),
        ("design.toml", "reference-design = \"delta:55:7/2/1@925\"\n"),
        (
            "named.toml",
            "reference-design = \"fleet\"\n[constellations]\nfleet = { files = [\"empty.csv\"] }\n",
        ),
        (
            "fleet.toml",
            "[constellations]\nfleet = { files = [\"none.tle\"] }\n",
        ),
    ];
    for (name, text) in files {
        fs::write(place.join(name), text).unwrap();
    }
    for (scenario, message) in [
        (
            "none.toml",
            "none.toml:3: region.points: cannot read none.csv: ",
        ),
        (
            "empty.toml",
            "empty.toml:4: region.points: empty.csv: the list is empty",
        ),
        ("gnss.toml", "gnss.toml:2: gnss.files: empty.csv: "),
        (
            "fleet.toml",
            "fleet.toml:2: constellations.fleet.files: none.tle: cannot read it: ",
        ),
    ] {
        let design = "--design delta:55:4/2/1@925";
        stopped(place, &format!("evaluate {scenario} {design}"), message);
        stopped(place, &format!("optimize {scenario} --out out"), message);
    }
    stopped(
        place,
        "export none.toml --as tle --out out",
        "none.toml:3: region.points: cannot read none.csv: ",
    );
    stopped(
        place,
        "validate design.toml --against sgp4",
        "design.toml:1: reference-design: ",
    );
    stopped(
        place,
        "validate named.toml --against sgp4",
        "named.toml:1: reference-design: the constellation 'fleet' has satellites from files, but this needs a design",
    );
    stopped(
        place,
        "evaluate --set region.points=none.csv --design delta:55:4/2/1@925",
        "--set region.points=none.csv: region.points: cannot read none.csv",
    );
    assert_eq!(fs::read_dir(place).unwrap().count(), files.len());
}

#[test]
fn longitudes_beyond_a_turn_are_those_before() {
    let directory = TempDir::new().unwrap();
    let pdop = |longitudes: &str| -> f64 {
        let line = format!(
            "evaluate --design delta:55:24/6/1@925 --set region.longitude-deg={longitudes} \
             --set time.step-s=3600 --format json"
        );
        let value: Value = serde_json::from_str(&done(directory.path(), &line).stdout).unwrap();
        value["metrics"]["mean_pdop"].as_f64().unwrap()
    };
    let expected = pdop("[-10,10]");
    for same in ["[350,370]", "[350,10]", "[-370,-350]"] {
        if same.starts_with("[-370") {
            stopped(
                directory.path(),
                &format!("evaluate --design delta:55:4/2/1@925 --set region.longitude-deg={same}"),
                ">= -360 and <= 720",
            );
        } else {
            // The rounding of a longitude, which moves a point by 1e-12 km.
            assert!((pdop(same) - expected).abs() < 1e-9, "{same}");
        }
    }
}

#[test]
fn points_keep_their_names() {
    let directory = with_files();
    let place = directory.path();
    let design = "--design delta:55:24/6/1@925";
    let line = format!("evaluate study/study.toml {design} --series series");
    let evaluated = done(place, &line);
    assert!(
        evaluated
            .stderr
            .contains("points.csv: columns ignored: country"),
        "{}",
        evaluated.stderr
    );
    let table = fs::read_to_string(place.join("series/points.csv")).unwrap();
    let lines: Vec<&str> = table.lines().collect();
    assert!(
        lines[0].contains(",outage_cut,gain_mean_pdop,coverage_1,") && lines[0].ends_with(",name"),
        "{table}"
    );
    assert!(
        lines[1].ends_with(",Brest") && lines[2].ends_with(','),
        "{table}"
    );
    done(
        place,
        &format!("export study/study.toml {design} --as geojson,kml,czml --out maps"),
    );
    for (name, _) in contents(&place.join("maps")) {
        let is_map = ["kml", "czml"]
            .iter()
            .any(|end| name.extension().is_some_and(|e| e == *end));
        let is_metrics = name.to_string_lossy().contains("metrics");
        if is_map || is_metrics {
            let text = fs::read_to_string(place.join("maps").join(&name)).unwrap();
            assert!(text.contains("Brest"), "{}", name.display());
        }
    }
}

#[test]
fn lint_reports_the_files_that_can_be_read() {
    let directory = with_files();
    let linted = run(directory.path(), "lint study/gps.tle missing.tle");
    assert_eq!(linted.status, 2);
    assert_eq!(linted.stdout, "study/gps.tle: no findings as tle\n");
    assert!(
        linted.stderr.contains("cannot read missing.tle"),
        "{}",
        linted.stderr
    );
    let nothing = run(directory.path(), "lint missing.tle");
    assert_eq!((nothing.status, nothing.stdout.as_str()), (2, ""));
}

/// Element sets are warned of alike, whether they are a GNSS or the constellation itself.
#[test]
fn old_element_sets_are_warned_of() {
    let directory = with_files();
    let place = directory.path();
    fs::copy(place.join("study/gps.tle"), place.join("leo.tle")).unwrap();
    let later = "--set time.epoch=2025-02-01T00:00:00Z --set time.step-s=7200";
    let warned = |line: &str, name: &str, days: &str| {
        let ran = done(place, &format!("{line} {later}"));
        let expected = format!("warning: {name}: the element set of NW-P0");
        let is_warned = ran.stderr.contains(&expected) && ran.stderr.contains(days);
        assert!(is_warned, "{}", ran.stderr);
    };
    // The last sample is 22 hours after the epoch.
    warned(
        "evaluate --constellation leo.tle",
        "leo.tle",
        "is 31.9 days from the study",
    );
    warned(
        "evaluate study/study.toml --design delta:55:24/6/1@925",
        "gps",
        "is 31.9 days from the study",
    );
    let in_time = done(
        place,
        "evaluate --quiet --constellation leo.tle --set time.step-s=7200",
    );
    assert_eq!(in_time.stderr, "");
    let in_time = done(
        place,
        "evaluate --constellation leo.tle --set time.step-s=7200",
    );
    assert!(!in_time.stderr.contains("days from"), "{}", in_time.stderr);
}

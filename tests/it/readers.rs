//! Constellation files through the program: formats, directories, selections, and what is said of the rest.

use crate::cli::{Ran, ran};
use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;
use tempfile::TempDir;

const DESIGN: &str = "delta:55:4/2/1@925";
const SHORT: [&str; 6] = [
    "--set",
    "time.duration-h=1",
    "--set",
    "time.step-s=60",
    "--set",
    "region.step-deg=20",
];

/// A satellite of 925 km, a month before the study, with a name that looks like JSON.
const OTHER: &str = "{OTHER}\n\
    1 90009U 25900I   24336.00000000  .00000000  00000+0  00000+0 0    14\n\
    2 90009  55.0000  40.0000 0001000  20.0000  30.0000 13.90000000    14\n";

fn with_study(arguments: &[&str]) -> Vec<String> {
    let all = arguments.iter().chain(&SHORT);
    all.map(|argument| (*argument).to_owned()).collect()
}

fn run(directory: &Path, arguments: &[&str]) -> Ran {
    let all = with_study(arguments);
    let all: Vec<&str> = all.iter().map(String::as_str).collect();
    ran(directory, &all)
}

/// A directory `mixed` of the four satellites of the design as STK ephemerides, one of them packed and padded with zeros,
/// and of files that are no constellations.
fn mixed() -> TempDir {
    let directory = TempDir::new().unwrap();
    let export = ["export", "--design", DESIGN, "--as", "stk", "--out", "out"];
    let done = run(directory.path(), &export);
    assert_eq!(done.status, 0, "{}", done.stderr);
    let mixed = directory.path().join("mixed");
    fs::create_dir_all(mixed.join("older")).unwrap();
    for entry in fs::read_dir(directory.path().join("out/stk")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        let bytes = fs::read(&path).unwrap();
        if name.ends_with("P02-S01.e") {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
            encoder.write_all(&bytes).unwrap();
            let mut packed = encoder.finish().unwrap();
            packed.extend([0; 512]);
            fs::write(mixed.join(format!("{name}.gz")), packed).unwrap();
        } else if name.ends_with(".e") {
            fs::write(mixed.join(name), bytes).unwrap();
        }
    }
    fs::write(mixed.join("notes.txt"), "read me first\n").unwrap();
    fs::write(mixed.join("picture.png"), b"\x89PNG\r\n\x1a\n").unwrap();
    directory
}

#[test]
fn a_directory_is_its_constellation_files_and_the_rest_is_named() {
    let directory = mixed();
    // What the program itself wrote beside the files of an export is not worth a word.
    for name in ["manifest.json", "provenance.json"] {
        let [from, to] = ["out", "mixed"].map(|place| directory.path().join(place).join(name));
        fs::copy(from, to).unwrap();
    }
    let evaluate = ["evaluate", "--constellation", "mixed", "--format", "json"];
    let whole = run(directory.path(), &evaluate);
    assert_eq!(whole.status, 0, "{}", whole.stderr);
    let result: Value = serde_json::from_str(&whole.stdout).unwrap();
    assert_eq!(result["constellation"]["satellites"], 4);
    assert_eq!(result["constellation"]["format"], "stk");
    let told = "mixed: left out: 3 (older/, notes.txt, picture.png)";
    assert!(whole.stderr.contains(told), "{}", whole.stderr);
    // The packed one is where the design has it.
    let design = run(
        directory.path(),
        &["evaluate", "--design", DESIGN, "--format", "json"],
    );
    let expected: Value = serde_json::from_str(&design.stdout).unwrap();
    let mean = |result: &Value| result["metrics"]["mean_visible"].as_f64().unwrap();
    assert!((mean(&result) - mean(&expected)).abs() < 1e-12);
    // Bytes behind the packed data are told with the file.
    let packed = directory.path().join("mixed/NW-P02-S01.e.gz");
    let mut bytes = fs::read(&packed).unwrap();
    bytes.push(b'x');
    fs::write(&packed, bytes).unwrap();
    let damaged = run(directory.path(), &evaluate);
    assert_eq!(damaged.status, 2);
    for part in [
        "NW-P02-S01.e.gz",
        "follows the end of the gzip data",
        "move it out of mixed to leave it out",
    ] {
        assert!(damaged.stderr.contains(part), "{}", damaged.stderr);
    }
    // As it says: without the file the rest is read.
    fs::remove_file(&packed).unwrap();
    assert_eq!(run(directory.path(), &evaluate).status, 0);
    let empty = ["evaluate", "--constellation", "mixed/older"];
    let empty = run(directory.path(), &empty);
    assert_eq!(empty.status, 2);
    assert!(
        empty.stderr.contains("contains no constellation file"),
        "{}",
        empty.stderr
    );
}

#[test]
fn the_format_of_files_can_be_named() {
    let directory = mixed();
    fs::write(directory.path().join("other.txt"), OTHER).unwrap();
    let evaluated = |path: &str, format: &[&str]| {
        let arguments = ["evaluate", "--format", "json", "--constellation", path];
        run(directory.path(), &[&arguments[..], format].concat())
    };
    let detected = evaluated("other.txt", &[]);
    assert_eq!(detected.status, 2, "{}", detected.stdout);
    let named = evaluated("other.txt", &["--input-format", "tle"]);
    assert_eq!(named.status, 0, "{}", named.stderr);
    let result: Value = serde_json::from_str(&named.stdout).unwrap();
    assert_eq!(result["constellation"]["format"], "tle");
    // It holds for packed files, and for all files of a directory.
    let packed = evaluated("mixed/NW-P02-S01.e.gz", &["--input-format", "stk"]);
    assert_eq!(packed.status, 0, "{}", packed.stderr);
    let all = evaluated("mixed", &["--input-format", "stk"]);
    assert_eq!(all.status, 2);
    assert!(all.stderr.contains("notes.txt"), "{}", all.stderr);
    let wrong = evaluated("mixed/NW-P01-S01.e", &["--input-format", "oem"]);
    assert_eq!(wrong.status, 2);
    assert!(
        wrong.stderr.contains("line 1, column 1"),
        "{}",
        wrong.stderr
    );
    let unknown = evaluated("other.txt", &["--input-format", "tel"]);
    assert_eq!(unknown.status, 2);
    assert!(unknown.stderr.contains("tle"), "{}", unknown.stderr);
    let validated = |format: &[&str]| {
        let arguments = ["validate", "--design", DESIGN, "--against", "./other.txt"];
        run(directory.path(), &[&arguments[..], format].concat())
    };
    assert!(validated(&[]).stderr.contains("not a supported format"));
    let named = validated(&["--input-format", "tle"]);
    assert!(
        !named.stderr.contains("not a supported format"),
        "{}",
        named.stderr
    );
}

/// `--only` and `--exclude` mean in `validate` what they mean in `evaluate`.
#[test]
fn satellites_are_chosen_alike_by_every_command() {
    let directory = mixed();
    let other = OTHER.replace("{OTHER}", "OTHER").replace("24336", "25001");
    fs::write(directory.path().join("mixed/other.tle"), other).unwrap();
    let validated = |arguments: &[&str]| {
        let own = [
            "validate",
            "--design",
            DESIGN,
            "--format",
            "json",
            "--against",
            "./mixed",
        ];
        run(directory.path(), &[&own[..], arguments].concat())
    };
    let file = |ran: &Ran| {
        let result: Value =
            serde_json::from_str(&ran.stdout).unwrap_or_else(|_| panic!("{}", ran.stderr));
        result["files"][0].clone()
    };
    let all = validated(&[]);
    assert_eq!(all.status, 1, "{}", all.stderr);
    assert_eq!(
        file(&all)["unmatched_objects"],
        serde_json::json!(["OTHER"])
    );
    let without = validated(&["--exclude", "90009"]);
    assert_eq!(without.status, 0, "{}", without.stdout);
    assert_eq!(file(&without)["satellites"].as_array().unwrap().len(), 4);
    let first = validated(&["--only", "nw-p01-*"]);
    assert_eq!(file(&first)["satellites"].as_array().unwrap().len(), 2);
    // Two satellites of the design are not among those selected.
    assert_eq!(first.status, 1);
    for arguments in [["--only", "NW-P03-S01"], ["--exclude", "NW-P03-S01"]] {
        let evaluate = ["evaluate", "--constellation", "mixed"];
        let evaluated = run(directory.path(), &[&evaluate[..], &arguments].concat());
        for ran in [validated(&arguments), evaluated] {
            assert_eq!(ran.status, 2);
            let told = "no satellite matches 'NW-P03-S01'; did you mean 'NW-P0";
            assert!(ran.stderr.contains(told), "{}", ran.stderr);
        }
    }
    let nothing = ["validate", "--against", "analytic", "--only", "NW-*"];
    let nothing = run(directory.path(), &nothing);
    assert_eq!(nothing.status, 2);
    assert!(
        nothing
            .stderr
            .contains("--only and --exclude select satellites of files, and no file is given"),
        "{}",
        nothing.stderr
    );
}

/// What `evaluate` refuses although it is valid, `lint` finds at its keyword.
#[test]
fn another_centre_is_told_by_lint_as_by_evaluate() {
    let directory = TempDir::new().unwrap();
    let export = ["export", "--design", DESIGN, "--as", "oem", "--out", "out"];
    assert_eq!(run(directory.path(), &export).status, 0);
    let text = fs::read_to_string(directory.path().join("out/oem/NW-P01-S01.oem")).unwrap();
    let text = text.replace("CENTER_NAME = EARTH", "CENTER_NAME = MARS");
    let line = 1 + text[..text.find("CENTER_NAME").unwrap()]
        .matches('\n')
        .count();
    fs::write(directory.path().join("mars.oem"), text).unwrap();
    let linted = ran(directory.path(), &["lint", "mars.oem"]);
    assert_eq!(linted.status, 1, "{}", linted.stdout);
    for part in [
        "unsupported",
        "CENTER_NAME: MARS is valid, but only orbits about the Earth are read",
        &format!("mars.oem:{line}:"),
    ] {
        assert!(linted.stdout.contains(part), "{part}: {}", linted.stdout);
    }
    let evaluated = run(
        directory.path(),
        &["evaluate", "--constellation", "mars.oem"],
    );
    assert_eq!(evaluated.status, 2);
    assert!(
        evaluated.stderr.contains("MARS is not the Earth"),
        "{}",
        evaluated.stderr
    );
}

/// Files of several kinds, all of them old: each warning says how old.
#[test]
fn the_age_of_old_elements_is_told_in_days() {
    let directory = TempDir::new().unwrap();
    let export = [
        "export", "--design", DESIGN, "--as", "yuma,tle", "--out", "out",
    ];
    let exported = run(directory.path(), &export);
    assert_eq!(exported.status, 0, "{}", exported.stderr);
    let mixed = directory.path().join("mixed");
    fs::create_dir(&mixed).unwrap();
    for path in ["yuma/beidou-3.alm", "constellation.tle"] {
        let name = path.rsplit('/').next().unwrap();
        fs::copy(directory.path().join("out").join(path), mixed.join(name)).unwrap();
    }
    let files = "gnss.files=[\"mixed/beidou-3.alm\",\"mixed/constellation.tle\"]";
    let later = ["--set", "time.epoch=\"2025-03-01T00:00:00Z\""];
    let evaluate = ["evaluate", "--constellation", "mixed"];
    let gnss = [
        "evaluate",
        "--design",
        DESIGN,
        "--set",
        "gnss.constellations=[]",
        "--set",
        files,
    ];
    for (arguments, most) in [(&evaluate[..], 1), (&gnss[..], 2)] {
        let evaluated = run(directory.path(), &[arguments, &later[..]].concat());
        assert_eq!(evaluated.status, 0, "{}", evaluated.stderr);
        let told: Vec<&str> = evaluated
            .stderr
            .lines()
            .filter(|line| line.contains("element set"))
            .collect();
        assert_eq!(told.len(), most, "{}", evaluated.stderr);
        for line in told {
            // 1 January to 1 March.
            let days = line.split(" is ").last().unwrap();
            assert!(
                days.starts_with("59.") && days.contains(" days from the study"),
                "{line}"
            );
        }
    }
}

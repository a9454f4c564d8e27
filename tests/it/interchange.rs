//! Exports and readers at the edges of the machine: full disks, endless files, options and
//! destinations that do not match.

use crate::cli::{ran, refused};
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const SMALL: [&str; 6] = [
    "--design",
    "delta:55:24/6/1@925",
    "--set",
    "time.step-s=1200",
    "--set",
    "region.step-deg=20",
];

fn export(further: &[&str]) -> Vec<String> {
    let words = ["export", "--quiet", "--out", "x"].iter();
    let words = words.chain(&SMALL).chain(further);
    words.map(|word| (*word).to_owned()).collect()
}

/// Runs the program from a shell that has set limits first.
fn limited(directory: &Path, limits: &str, arguments: &[String]) -> Output {
    let program = assert_cmd::cargo::cargo_bin("navwalker");
    Command::new("sh")
        .args(["-c", &format!("{limits}; exec \"$0\" \"$@\"")])
        .arg(program)
        .args(arguments)
        .current_dir(directory)
        .output()
        .unwrap()
}

/// A file may have one block, as on a disk that is full then: every product fails, and leaves
/// nothing.
#[test]
fn a_disk_that_is_full_leaves_no_part_of_an_export() {
    for product in [
        "tle",
        "omm",
        "oem",
        "opm",
        "sp3",
        "stk",
        "csv",
        "tle-states",
    ] {
        let directory = TempDir::new().unwrap();
        // The signal of the limit is ignored, so that writing fails as on a full disk.
        let limits = "trap '' XFSZ; ulimit -f 1";
        let arguments = export(&["--as", product, "--omm-syntax", "xml"]);
        let output = limited(directory.path(), limits, &arguments);
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{product}: {stderr}");
        assert!(stderr.contains("cannot export to x"), "{product}: {stderr}");
        assert!(stderr.contains("File too large"), "{product}: {stderr}");
        assert!(output.stdout.is_empty());
        let left: Vec<_> = fs::read_dir(directory.path()).unwrap().collect();
        assert!(left.is_empty(), "{product} left {left:?}");
    }
}

/// What is there stays when the export that was to replace it fails.
#[test]
fn a_failed_export_keeps_the_one_before() {
    let directory = TempDir::new().unwrap();
    let words = export(&["--as", "tle"]);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    assert_eq!(ran(directory.path(), &words).status, 0);
    let before = fs::read(directory.path().join("x/manifest.json")).unwrap();
    let again = ran(directory.path(), &words);
    assert_eq!(again.status, 2);
    assert!(again.stderr.contains("x is not empty") && again.stderr.contains("--force"));
    let limits = "trap '' XFSZ; ulimit -f 1";
    let forced = limited(
        directory.path(),
        limits,
        &export(&["--as", "oem", "--force"]),
    );
    assert_eq!(forced.status.code(), Some(2));
    assert_eq!(
        fs::read(directory.path().join("x/manifest.json")).unwrap(),
        before
    );
}

/// A line of a gigabyte, in a file that takes no room, behind the beginning of each format.
#[test]
fn a_line_of_a_gigabyte_is_refused_in_bounded_memory() {
    let directory = TempDir::new().unwrap();
    for (name, beginning) in [
        ("a.tle", ""),
        ("a.oem", "CCSDS_OEM_VERS = 2.0\n"),
        ("a.sp3", "#dP"),
        ("a.csv", "OBJECT_NAME,EPOCH,MEAN_MOTION\n"),
        ("a.json", "[{\"OBJECT_NAME\":\""),
        ("a.xml", "<ndm><omm>"),
    ] {
        let path = directory.path().join(name);
        let mut file = File::create(&path).unwrap();
        file.write_all(beginning.as_bytes()).unwrap();
        file.set_len(1 << 30).unwrap();
        for command in ["lint", "evaluate"] {
            let mut arguments = vec![command.to_owned()];
            if command == "evaluate" {
                arguments.push("--constellation".to_owned());
            }
            arguments.push(name.to_owned());
            // KiB of address space, code and stacks of threads included.
            let output = limited(directory.path(), "ulimit -v 300000", &arguments);
            let expected = if command == "lint" { 1 } else { 2 };
            let stderr = String::from_utf8_lossy(&output.stderr);
            assert_eq!(
                output.status.code(),
                Some(expected),
                "{command} {name}: {stderr}"
            );
            let told = if command == "lint" {
                &output.stdout
            } else {
                &output.stderr
            };
            assert!(
                String::from_utf8_lossy(told).contains(name),
                "{command} {name}"
            );
        }
        fs::remove_file(path).unwrap();
    }
}

/// What a scenario names is kept as a whole, and may not be longer than that allows.
#[test]
fn a_scenario_of_a_gigabyte_is_refused() {
    let directory = TempDir::new().unwrap();
    let file = File::create(directory.path().join("long.toml")).unwrap();
    file.set_len(1 << 30).unwrap();
    let arguments = ["evaluate", "long.toml", "--design", SMALL[1]].map(str::to_owned);
    let output = limited(directory.path(), "ulimit -v 300000", &arguments);
    assert_eq!(output.status.code(), Some(2));
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.contains("larger than 64 MiB"), "{stderr}");
}

#[test]
fn gnss_stand_in_files_of_their_own() {
    let directory = TempDir::new().unwrap();
    let words = export(&["--as", "sp3", "--gnss", "beidou-3,gps", "--check"]);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let ran = ran(directory.path(), &words);
    assert_eq!(ran.status, 0, "{}{}", ran.stdout, ran.stderr);
    let read = |name: &str| fs::read_to_string(directory.path().join("x").join(name)).unwrap();
    for (name, ids, first) in [
        ("gnss/beidou-3.sp3", "+   30   C01C02", "PC01 "),
        ("gnss/gps.sp3", "+   24   G01G02", "PG01 "),
    ] {
        let text = read(name);
        assert!(
            text.contains(ids) && text.contains(&format!("\n{first}")),
            "{name}"
        );
    }
    assert!(!read("sp3/part-01.sp3").contains("\nPC"));
    assert!(read("manifest.json").contains("gnss/beidou-3.sp3"));
    let taken = [
        "export",
        "--as",
        "sp3",
        "--out",
        "x",
        "--gnss",
        "gps",
        "--sp3-letter",
        "G",
    ];
    assert!(refused(&taken).contains("'G' is the SP3 letter of gps"));
    let alone = ["export", "--as", "oem", "--out", "x", "--gnss", "gps"];
    assert!(refused(&alone).contains("add sp3 to --as"));
}

/// The metrics of an export are those of an evaluation.
#[test]
fn metrics_are_exported_as_they_are_evaluated() {
    let directory = TempDir::new().unwrap();
    let words = export(&["--as", "metrics"]);
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    assert_eq!(ran(directory.path(), &words).status, 0);
    let evaluate = [&["evaluate", "--series", "series"], &SMALL[..]].concat();
    assert_eq!(ran(directory.path(), &evaluate).status, 0);
    for name in ["points.csv", "epochs.csv"] {
        let read = |parent: &str| fs::read(directory.path().join(parent).join(name)).unwrap();
        assert_eq!(read("x/metrics"), read("series"), "{name}");
        assert!(read("series").split(|byte| *byte == b'\n').count() > 5);
    }
}

/// More satellites than one file of SP3 takes: ids start again in each part.
#[test]
fn the_parts_of_a_large_constellation_are_read_together() {
    let large = [
        "--design",
        "delta:55:104/13/1@925",
        "--set",
        "time.step-s=1200",
    ];
    for version in ["c", "d"] {
        let directory = TempDir::new().unwrap();
        let words = [
            "export",
            "--as",
            "sp3",
            "--sp3-version",
            version,
            "--check",
            "--out",
            "x",
        ];
        let exported = ran(directory.path(), &[&words[..], &large].concat());
        assert_eq!(exported.status, 0, "{}", exported.stderr);
        assert!(directory.path().join("x/sp3/part-02.sp3").exists());
        let evaluate = [
            "evaluate",
            "--constellation",
            "x/sp3",
            "--set",
            "time.step-s=1200",
        ];
        let evaluated = ran(directory.path(), &evaluate);
        if version == "d" {
            assert_eq!(evaluated.status, 0, "{}", evaluated.stderr);
            assert!(evaluated.stdout.contains("104"), "{}", evaluated.stdout);
        } else {
            // SP3-c has no room for names.
            assert!(
                evaluated.stderr.contains("appears twice"),
                "{}",
                evaluated.stderr
            );
        }
    }
}

/// The flag is the key of the scenario, and names of frames and times are taken in any case.
#[test]
fn the_creation_date_and_frames_can_be_chosen() {
    let directory = TempDir::new().unwrap();
    let date = ["--creation-date", "2026-03-04T05:06:07Z"];
    let words = export(
        &[
            &["--as", "oem", "--frame", "eme2000", "--time-system", "tai"],
            date.as_slice(),
        ]
        .concat(),
    );
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let first = ran(directory.path(), &words);
    assert_eq!(first.status, 0, "{}", first.stderr);
    let read = || fs::read_to_string(directory.path().join("x/oem/NW-P01-S01.oem")).unwrap();
    let text = read();
    for line in [
        "CREATION_DATE = 2026-03-04T05:06:07.000",
        "REF_FRAME = EME2000",
        "TIME_SYSTEM = TAI",
    ] {
        assert!(text.contains(line), "{line}");
    }
    let again = [words.as_slice(), &["--force"]].concat();
    assert_eq!(ran(directory.path(), &again).status, 0);
    assert_eq!(read(), text);
    let wrong = [
        "export",
        "--as",
        "oem",
        "--out",
        "x",
        "--creation-date",
        "yesterday",
    ];
    assert!(refused(&wrong).contains("creation-date"));
    let unknown = ["export", "--as", "oem", "--out", "x", "--frame", "ECI"];
    assert!(refused(&unknown).contains("EME2000"));
}

/// What a format cannot say is refused with what it can.
#[test]
fn what_a_format_cannot_hold_is_refused() {
    let century = ["--set", "time.epoch=2060-01-01T00:00:00Z"];
    let tle = [
        "export",
        "--as",
        "tle",
        "--out",
        "x",
        "--set",
        "time.step-s=1200",
    ];
    let told = refused(&[tle.as_slice(), &century].concat());
    assert!(told.contains("1957 to 2056"), "{told}");
    let letter = ["export", "--as", "sp3", "--out", "x", "--sp3-letter", "l"];
    assert!(refused(&letter).contains("not a capital letter"));
}

//! Exports of hybrids and of satellites from files, as they are typed.

use crate::cli::{ran, refused};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SHORT: [&str; 4] = ["--set", "time.step-s=300", "--set", "time.duration-h=1"];

fn export(directory: &Path, more: &[&str]) -> crate::cli::Ran {
    let done = ran(directory, &[&["export", "--quiet"], more, &SHORT].concat());
    assert_eq!(done.status, 0, "{}", done.stderr);
    done
}

fn metrics(directory: &Path, of: &[&str]) -> Value {
    let arguments = [&["evaluate", "--quiet", "--format", "json"], of, &SHORT].concat();
    let done = ran(directory, &arguments);
    assert_eq!(done.status, 0, "{}", done.stderr);
    let result: Value = serde_json::from_str(&done.stdout).unwrap();
    result["metrics"].clone()
}

/// Two exports under other prefixes and numbers are one constellation in a directory: that of both shells.
#[test]
fn two_exports_are_evaluated_together() {
    const ONE: &str = "delta:53:12/3/1@1000";
    const OTHER: &str = "star:90:8/2/1@1100";
    let directory = TempDir::new().unwrap();
    let both = directory.path().join("both");
    fs::create_dir(&both).unwrap();
    let further = [
        "--set",
        "export.name-prefix=POLAR",
        "--set",
        "export.first-catalog-number=95001",
    ];
    for (design, out, more) in [(ONE, "one", &[][..]), (OTHER, "other", &further)] {
        let options = [
            "--design", design, "--as", "oem", "--frame", "TEME", "--out", out,
        ];
        export(directory.path(), &[&options[..], more].concat());
        for entry in fs::read_dir(directory.path().join(out).join("oem")).unwrap() {
            let path = entry.unwrap().path();
            fs::copy(&path, both.join(path.file_name().unwrap())).unwrap();
        }
    }
    let hybrid = format!("{ONE}+{OTHER}");
    let [found, expected] = [
        metrics(directory.path(), &["--constellation", "both"]),
        metrics(directory.path(), &["--design", &hybrid]),
    ];
    for name in ["mean_visible", "mean_pdop", "max_pdop"] {
        let [found, expected] = [&found, &expected].map(|of| of[name].as_f64().unwrap());
        // Nine decimals of a kilometre.
        assert!(
            (found / expected - 1.0).abs() < 1e-9,
            "{name}: {found} {expected}"
        );
    }
}

/// A TLE goes out in the other formats and passes their gates; nothing is left behind by what cannot be expressed.
#[test]
fn a_file_of_element_sets_is_converted_and_checked() {
    let directory = TempDir::new().unwrap();
    export(
        directory.path(),
        &[
            "--design",
            "star:86.4:6/3/1@780",
            "--as",
            "tle",
            "--out",
            "source",
        ],
    );
    let source = ["--constellation", "iridium=source/constellation.tle"];
    let options = ["--as", "tle,omm,oem,sp3,stk,csv", "--check", "--out", "out"];
    let done = export(directory.path(), &[&source[..], &options].concat());
    assert_eq!(done.stdout.matches("passed").count(), 6, "{}", done.stdout);
    let read = |path: &str| fs::read_to_string(directory.path().join(path)).unwrap();
    assert_eq!(
        read("out/constellation.tle"),
        read("source/constellation.tle")
    );
    let manifest: Value = serde_json::from_str(&read("out/manifest.json")).unwrap();
    assert_eq!(manifest["constellation"], "iridium");
    let converted = manifest["converted"].as_str().unwrap();
    assert!(
        converted.starts_with("6 satellites from constellation.tle (tle:"),
        "{converted}"
    );
    let cannot = [
        &["export", "--out", "none", "--as", "yuma"],
        &source[..],
        &SHORT,
    ]
    .concat();
    let done = ran(directory.path(), &cannot);
    assert_eq!(done.status, 2);
    let error = done.stderr;
    assert!(
        error.contains("yuma cannot hold the satellites of constellation.tle"),
        "{error}"
    );
    let two = [
        "export",
        "--out",
        "none",
        "--as",
        "tle",
        "--design",
        "a=star:90:4/2/1@780",
        "--design",
        "delta:53:4/2/1@780",
    ];
    let error = refused(&two);
    assert!(
        error.contains("not of 2 (a, delta:53:4/2/1@780)"),
        "{error}"
    );
    assert!(!directory.path().join("none").exists());
}

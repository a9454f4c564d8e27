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

/// GNSS that a file gives as states have states between the samples of the study too, as the ephemerides of STK and the
/// positions of CZML need them; the ephemerides are those of the file.
#[test]
fn gnss_states_of_a_file_go_to_stk_and_czml() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let source = ["--design", "delta:56:6/3/1@21528", "--as", "oem", "--out"];
    export(place, &[&source[..], &["gnss"]].concat());
    let files = fs::read_dir(place.join("gnss/oem")).unwrap();
    let files = files.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut files: Vec<String> = files.map(|name| format!("\"gnss/oem/{name}\"")).collect();
    files.sort();
    let scenario = format!(
        "name = \"states\"\n[region]\nstep-deg = 20\n[gnss]\nconstellations = []\nfiles = [{}]\n",
        files.join(", ")
    );
    fs::write(place.join("states.toml"), scenario).unwrap();
    let options = [
        "--design",
        "delta:55:14/7/1@925",
        "--as",
        "stk,czml,metrics",
    ];
    export(
        place,
        &[&["states.toml"], &options[..], &["--out", "out"]].concat(),
    );
    let manifest = fs::read_to_string(place.join("out/manifest.json")).unwrap();
    let manifest: Value = serde_json::from_str(&manifest).unwrap();
    let files = manifest["files"].as_array().unwrap().iter();
    let is_gnss = |file: &&Value| {
        let path = file["path"].as_str().unwrap();
        path.starts_with("stk-scenario/gnss/")
    };
    let gnss: Vec<&Value> = files.filter(is_gnss).collect();
    assert_eq!(gnss.len(), 6);
    for file in gnss {
        // A centimetre; two interpolations of degree 7 between states 300 s apart.
        let interpolation_km = file["loss"]["interpolation_max_km"].as_f64().unwrap();
        assert!(interpolation_km < 1e-5, "{file}");
    }
    let against = [
        "--constellation",
        "gnss/oem",
        "--against",
        "./out/stk-scenario/gnss",
    ];
    let arguments = [
        &["validate", "--quiet", "--format", "json"],
        &against[..],
        &SHORT,
    ]
    .concat();
    let done = ran(place, &arguments);
    assert_eq!(done.status, 0, "{}{}", done.stdout, done.stderr);
    let found: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(found["files"][0]["agrees"], true, "{found}");
}

/// A name outside ASCII and a number past Alpha-5 go out in a TLE under others, which a warning and the manifest name. The
/// number is the first free one whose synthetic designator is free too.
#[test]
fn identities_that_no_format_holds_are_named() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let source = [
        "--design",
        "star:86.4:6/3/1@780",
        "--as",
        "omm",
        "--omm-syntax",
        "json",
    ];
    export(place, &[&source[..], &["--out", "source"]].concat());
    let text = fs::read_to_string(place.join("source/omm.json")).unwrap();
    let text = text.replace("\"NW-P01-S01\"", "\"Спутник 1\"");
    let text = text.replace("\"NORAD_CAT_ID\":90002", "\"NORAD_CAT_ID\":799500123");
    fs::write(place.join("own.json"), text).unwrap();
    let options = [
        "--constellation",
        "own.json",
        "--as",
        "tle,omm,oem",
        "--check",
    ];
    let talking = [&["export"], &options[..], &["--out", "out"], &SHORT].concat();
    let done = ran(place, &talking);
    assert_eq!(done.status, 0, "{}{}", done.stdout, done.stderr);
    let warning = "warning: names, numbers or designators that the formats cannot hold are changed: Спутник 1 as _______ 1, \
                   799500123 as 90007; manifest.json lists them under changed_identities\n";
    assert!(done.stderr.contains(warning), "{}", done.stderr);
    let tle = fs::read_to_string(place.join("out/constellation.tle")).unwrap();
    assert!(tle.starts_with("_______ 1\n1 90001U "), "{tle}");
    assert!(tle.contains("\nNW-P01-S02\n1 90007U "), "{tle}");
    let omm = fs::read_to_string(place.join("out/omm/NW-P01-S02.omm")).unwrap();
    assert!(omm.contains("\nNORAD_CAT_ID = 90007\n"), "{omm}");
}

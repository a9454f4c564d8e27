//! Whole scenarios for other programs, as they are typed.

use crate::cli::{ran, refused};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const DESIGN: [&str; 2] = ["--design", "delta:55:12/3/1@925"];

/// An hour over a coarse region.
const SMALL: [&str; 6] = [
    "--set",
    "region.step-deg=20",
    "--set",
    "time.step-s=300",
    "--set",
    "time.duration-h=1",
];

/// The files below a directory, by their paths.
fn files(below: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut open = vec![below.to_path_buf()];
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(&directory).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(below).unwrap().display().to_string();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// One export of all scenario formats: the same bytes on any number of threads, read back within the bounds,
/// with the settings that the other programs need, and evaluated again from the CZML.
#[test]
fn scenarios_are_exported_and_read_back() {
    let directory = TempDir::new().unwrap();
    let export = |out: &str, threads: &str| {
        let products = [
            "export",
            "--as",
            "czml,geojson,kml,stk,gmat,yuma",
            "--check",
        ];
        let place = ["--out", out, "--threads", threads];
        let arguments = [&products[..], &DESIGN, &SMALL, &place].concat();
        let ran = ran(directory.path(), &arguments);
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        assert!(ran.stdout.contains("czml") && !ran.stdout.contains("FAILED"));
        files(&directory.path().join(out))
    };
    let once = export("one", "1");
    assert_eq!(once, export("two", "2"));
    for path in [
        "scene.czml",
        "scene.kml",
        "geojson/region.geojson",
        "geojson/ground-tracks.geojson",
        "geojson/footprints.geojson",
        "stk-scenario/connect.txt",
        "stk-scenario/points.pnt",
        "stk-scenario/gnss/beidou-3-GEO-1.e",
        "gmat/navwalker.script",
        "gmat/navwalker-j2.cof",
        "yuma/beidou-3.alm",
    ] {
        assert!(once.contains_key(path), "{path}");
    }
    let manifest: Value = serde_json::from_slice(&once["manifest.json"]).unwrap();
    let told = |path: &str| {
        let entries = manifest["files"].as_array().unwrap();
        let entry = entries.iter().find(|entry| entry["path"] == path).unwrap();
        entry["assumptions"].to_string()
    };
    assert!(told("scene.czml").contains("masks: 7°"));
    assert!(told("stk-scenario/connect.txt").contains("not tested in STK"));
    assert!(told("gmat/navwalker.script").contains("osculating"));

    let mean_pdop = |how: &[&str]| {
        let arguments = [&["evaluate", "--format", "json"], how, &SMALL].concat();
        let ran = ran(directory.path(), &arguments);
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let result: Value = serde_json::from_str(&ran.stdout).unwrap();
        result["metrics"]["mean_pdop"].as_f64().unwrap()
    };
    let again = mean_pdop(&["--constellation", "one/scene.czml"]);
    // Half a metre over 500 km or more.
    assert!((again / mean_pdop(&DESIGN) - 1.0).abs() < 1e-6);
}

/// Points of a list are marks on the map and lines of the point file.
#[test]
fn lists_of_points_are_exported() {
    let directory = TempDir::new().unwrap();
    let points = "latitude_deg,longitude_deg\n52,5\n-90,0\n10,200\n";
    fs::write(directory.path().join("points.csv"), points).unwrap();
    let scenario = "[region]\npoints = \"points.csv\"\n[time]\nduration-h = 1\nstep-s = 600\n";
    fs::write(directory.path().join("points.toml"), scenario).unwrap();
    let arguments = [
        "export",
        "points.toml",
        "--as",
        "czml,geojson,kml,stk",
        "--out",
        "x",
    ];
    let ran = ran(directory.path(), &[&arguments[..], &DESIGN].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let files = files(&directory.path().join("x"));
    let text = |path: &str| String::from_utf8(files[path].clone()).unwrap();
    assert!(text("stk-scenario/points.pnt").contains("\n52 5\n-90 0\n10 -160\n"));
    assert!(text("scene.kml").contains("<Point><coordinates>-160,10</coordinates></Point>"));
    let region: Value = serde_json::from_slice(&files["geojson/region.geojson"]).unwrap();
    assert_eq!(region["features"][2]["geometry"]["coordinates"][0], -160.0);
}

#[test]
fn what_a_format_cannot_say_is_refused() {
    let export = |product: &'static str, set: &[&'static str]| {
        let pairs = set.iter().flat_map(|one| ["--set", one]);
        let arguments = ["export", "--as", product, "--out", "x"];
        refused(&arguments.into_iter().chain(pairs).collect::<Vec<_>>())
    };
    let none = export("yuma", &["gnss.constellations=[]"]);
    assert!(
        none.contains("gnss.constellations") && none.contains("--as sp3"),
        "{none}"
    );
    let sgp4 = export("gmat", &["propagation.model=sgp4"]);
    assert!(
        sgp4.contains("integrates J2") && sgp4.contains("--as oem"),
        "{sgp4}"
    );
    let fine = export("gmat", &["time.epoch=2025-01-01T00:00:00.0001Z"]);
    assert!(fine.contains("milliseconds"), "{fine}");
    for product in ["czml", "kml"] {
        let many = export(product, &["region.step-deg=0.3", "time.step-s=43200"]);
        assert!(
            many.contains("--as geojson") && many.contains("36"),
            "{many}"
        );
    }
}

//! Messages of `validate`: refusals, picks, and where the reports go.

use crate::cli::{optimize, ran, refused};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A study of little more than nothing.
const SHORT: [&str; 4] = ["--set", "time.duration-h=2", "--set", "region.step-deg=20"];

fn validate<'a>(further: &[&'a str]) -> Vec<&'a str> {
    [&["validate", "--quiet"], SHORT.as_slice(), further].concat()
}

#[test]
fn an_unknown_target_names_the_nearest() {
    let message = refused(&validate(&["--against", "sgp4,geograpiclib"]));
    assert!(
        message.contains("--against geograpiclib")
            && message.contains("did you mean \"geographiclib\"?"),
        "{message}"
    );
    assert!(refused(&validate(&["--against", "a.oem"])).contains("cannot read a.oem"));
}

/// J3 takes a circle at 1 km underground: satellite, instant and reason are told.
#[test]
fn a_decay_is_told() {
    let message = refused(&validate(&[
        "--design",
        "delta:55:4/2/1@1",
        "--against",
        "sgp4",
    ]));
    assert!(
        message.contains("NW-P0")
            && message.contains("at 2025-01-01T")
            && message.contains("the orbit has decayed"),
        "{message}"
    );
}

/// An element set whose drag drives the eccentricity out of its range, in a file: SGP4 itself gives up.
#[test]
fn an_element_set_that_sgp4_refuses_is_told() {
    let directory = TempDir::new().unwrap();
    let set = "FALLING\n\
        1 90001U 25900A   25001.00000000  .00000000  00000-0  99999+0 0    01\n\
        2 90001  55.0000   0.0000 0001000   0.0000   0.0000 16.40000000    04\n";
    fs::write(directory.path().join("falling.tle"), set).unwrap();
    let arguments = [
        "validate",
        "--design",
        "delta:55:1/1/0@180",
        "--set",
        "time.duration-h=48",
        "--set",
        "region.step-deg=20",
        "--against",
        "./falling.tle",
    ];
    let ran = ran(directory.path(), &arguments);
    assert_eq!(ran.status, 2, "{}", ran.stdout);
    assert!(
        ran.stderr.contains("FALLING: ") && ran.stderr.contains(" at 2025-01-01T00:"),
        "{}",
        ran.stderr
    );
}

/// Satellites in files are chosen by pattern; other contents are reported; old element sets give a warning.
#[test]
fn satellites_of_files_are_chosen_and_the_rest_is_told() {
    let directory = TempDir::new().unwrap();
    let omm = |name: &str, number: u32| {
        format!(
            "<omm id=\"CCSDS_OMM_VERS\" version=\"2.0\"><header><CREATION_DATE>2025-01-01T00:00:00</CREATION_DATE>\
             <ORIGINATOR>X</ORIGINATOR></header><body><segment><metadata><OBJECT_NAME>{name}</OBJECT_NAME>\
             <OBJECT_ID>UNKNOWN</OBJECT_ID><CENTER_NAME>EARTH</CENTER_NAME><REF_FRAME>TEME</REF_FRAME>\
             <TIME_SYSTEM>UTC</TIME_SYSTEM><MEAN_ELEMENT_THEORY>SGP4</MEAN_ELEMENT_THEORY></metadata><data>\
             <meanElements><EPOCH>2024-12-01T00:00:00</EPOCH><MEAN_MOTION>13.9</MEAN_MOTION>\
             <ECCENTRICITY>0.0001</ECCENTRICITY><INCLINATION>55.0</INCLINATION>\
             <RA_OF_ASC_NODE>10.0</RA_OF_ASC_NODE><ARG_OF_PERICENTER>20.0</ARG_OF_PERICENTER>\
             <MEAN_ANOMALY>30.0</MEAN_ANOMALY></meanElements><tleParameters><NORAD_CAT_ID>{number}</NORAD_CAT_ID>\
             <BSTAR>0.0</BSTAR></tleParameters></data></segment></body></omm>\n"
        )
    };
    let file = format!(
        "<ndm>\n{}{}<aem><header><ORIGINATOR>X</ORIGINATOR></header></aem>\n</ndm>\n",
        omm("ALPHA-1", 90001),
        omm("BETA-1", 90002)
    );
    fs::write(directory.path().join("mixed.xml"), file).unwrap();
    let evaluated = |arguments: &[&str]| {
        let mut all = vec![
            "evaluate",
            "--constellation",
            "mixed.xml",
            "--format",
            "json",
        ];
        all.extend(["--set", "time.duration-h=1", "--set", "time.step-s=600"]);
        all.extend(["--set", "region.step-deg=20"]);
        all.extend(arguments);
        ran(directory.path(), &all)
    };
    for (arguments, satellites) in [
        (&[][..], 2),
        (&["--only", "alpha-*"], 1),
        (&["--exclude", "90001"], 1),
    ] {
        let ran = evaluated(arguments);
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let result: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_eq!(result["constellation"]["satellites"], satellites);
        let told = "mixed.xml: left out: 1 (message: aem)";
        assert!(ran.stderr.contains(told), "{}", ran.stderr);
        assert!(
            ran.stderr.contains("31.0 days from the study"),
            "{}",
            ran.stderr
        );
    }
    let unknown = evaluated(&["--only", "ALPHA-2"]);
    assert_eq!(unknown.status, 2);
    let told = "no satellite matches 'ALPHA-2'; did you mean 'ALPHA-1'?";
    assert!(unknown.stderr.contains(told), "{}", unknown.stderr);
    let design = ["evaluate", "--design", "delta:55:4/2/1@925", "--only", "x"];
    assert_eq!(ran(directory.path(), &design).status, 2);
}

fn notation(path: &Path, place: impl Fn(&Value) -> bool) -> String {
    let front: Value = serde_json::from_slice(&fs::read(path).unwrap()).unwrap();
    let members = front["front"].as_array().unwrap();
    let member = members.iter().find(|member| place(member)).unwrap();
    member["design"]["notation"].as_str().unwrap().to_owned()
}

/// Each method picks, the hint says which design and why, and the fuzzy pick is the one of the front.
#[test]
fn a_pick_is_explained() {
    let directory = TempDir::new().unwrap();
    let searched = ran(directory.path(), &optimize(&["--out", "run"]));
    assert_eq!(searched.status, 0, "{}", searched.stderr);
    let front = directory.path().join("run/front.json");
    for (pick, reason) in [
        ("fuzzy", "the fuzzy pick"),
        ("sum", "sum of memberships"),
        ("topsis", "TOPSIS, equal weights"),
        ("knee", "the knee"),
        ("1", "the design with this index"),
    ] {
        let arguments = [
            "validate",
            "--run",
            "run",
            "--pick",
            pick,
            "--against",
            "analytic",
            "--format",
            "json",
        ];
        let ran = ran(directory.path(), &arguments);
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        assert!(ran.stderr.contains(reason), "{pick}: {}", ran.stderr);
        let result: Value = serde_json::from_str(&ran.stdout).unwrap();
        let picked = result["design"]["notation"].as_str().unwrap();
        match pick {
            "fuzzy" => assert_eq!(picked, notation(&front, |member| member["chosen"] == true)),
            "1" => assert_eq!(picked, notation(&front, |member| member["index"] == 1)),
            // The same pick is in the text of the search.
            _ => {
                let line = searched.stdout.lines().find(|line| {
                    line.contains(&format!("--pick {pick}: ")) && line.contains(picked)
                });
                assert!(line.is_some(), "{pick} {picked}: {}", searched.stdout);
            }
        }
    }
}

/// What was put into a run directory about the run stays when the run is repeated, and is not lost
/// without a word when another takes its place.
#[test]
fn a_validation_in_a_run_directory_survives() {
    let directory = TempDir::new().unwrap();
    let search = optimize(&["--out", "run"]);
    assert_eq!(ran(directory.path(), &search).status, 0);
    let into = [
        "validate",
        "--quiet",
        "--run",
        "run",
        "--against",
        "analytic",
        "--out",
        "run/validation",
    ];
    assert_eq!(ran(directory.path(), &into).status, 0);
    let report = directory.path().join("run/validation/report.json");
    let before = fs::read(&report).unwrap();
    let elsewhere = optimize(&["--out", "other"]);
    assert_eq!(ran(directory.path(), &elsewhere).status, 0);
    assert_eq!(ran(directory.path(), &search).status, 0);
    assert_eq!(fs::read(&report).unwrap(), before);
    // A report is not replaced unless that is said.
    let again = ran(directory.path(), &into);
    assert_eq!(again.status, 2);
    assert!(again.stderr.contains("--force"), "{}", again.stderr);
    assert_eq!(
        ran(directory.path(), &[into.as_slice(), &["--force"]].concat()).status,
        0
    );
    assert_eq!(fs::read(&report).unwrap(), before);
    let other = optimize(&["--out", "run", "--seed", "2", "--force"]);
    let aloud: Vec<&str> = other
        .into_iter()
        .filter(|word| *word != "--quiet")
        .collect();
    let forced = ran(directory.path(), &aloud);
    assert_eq!(forced.status, 0, "{}", forced.stderr);
    assert!(forced.stderr.contains("validation"), "{}", forced.stderr);
    assert!(!report.exists());
}

/// With BeiDou alone every sample is solved: availability depends on nothing, and with the number of
/// satellites as the other objective nothing depends on inclination and altitude.
#[test]
fn what_does_not_matter_is_said() {
    let directory = TempDir::new().unwrap();
    let arguments = [
        "--format",
        "json",
        "--set",
        "objectives.minimize=[\"availability\", \"satellites\"]",
        "--set",
        "objectives.availability-pdop=50",
    ];
    let ran = ran(directory.path(), &optimize(&arguments));
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let result: Value = serde_json::from_str(&ran.stdout).unwrap();
    let diagnostics = result["diagnostics"].as_array().unwrap();
    let message = |code: &str| {
        let found = diagnostics.iter().find(|one| one["code"] == code);
        found.unwrap_or_else(|| panic!("no {code} in {diagnostics:?}"))["message"]
            .as_str()
            .unwrap()
    };
    assert!(message("independent:availability").contains("`planes` and `satellites-per-plane`"));
    for variable in ["inclination-deg", "altitude-km"] {
        assert!(message(&format!("idle:{variable}")).contains(variable));
    }
}

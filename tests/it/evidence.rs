//! The committed reports of `validation/reports` still come out.

use serde_json::Value;
use std::path::Path;
use std::{fs, str};

/// Relative change of a number that another compiler or processor may make.
const RELATIVE: f64 = 1e-6;

fn made_again(scenario: &str) -> Value {
    let output = assert_cmd::Command::cargo_bin("navwalker")
        .unwrap()
        .args(["validate", scenario, "--against", "all", "--format", "json"])
        .output()
        .unwrap();
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        str::from_utf8(&output.stderr).unwrap()
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

fn committed(scenario: &str) -> Value {
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/reports");
    let text = fs::read_to_string(reports.join(format!("{scenario}.json"))).unwrap();
    serde_json::from_str(&text).unwrap()
}

fn assert_same_checks(scenario: &str) {
    let (again, before) = (made_again(scenario), committed(scenario));
    assert_eq!(again["scenario"], before["scenario"]);
    assert_eq!(again["design"], before["design"]);
    let (again, before) = (
        again["checks"].as_array().unwrap(),
        before["checks"].as_array().unwrap(),
    );
    assert_eq!(again.len(), before.len());
    for (a, b) in again.iter().zip(before) {
        assert_eq!(
            (&a["name"], &a["gate"].is_null()),
            (&b["name"], &b["gate"].is_null())
        );
        assert_eq!(a["passed"], b["passed"], "{}", a["name"]);
        let (x, y) = (a["value"].as_f64().unwrap(), b["value"].as_f64().unwrap());
        // What is rounding in itself may change as a whole, as long as it stays far below its gate.
        let rounding = 1e-3 * b["gate"].as_f64().unwrap_or(0.0) + 1e-9;
        assert!(
            (x - y).abs() <= RELATIVE * y.abs() + rounding,
            "{}: {x} was {y}",
            a["name"]
        );
    }
}

#[test]
fn regress_the_report_of_the_paper() {
    assert_same_checks("paper");
}

#[test]
fn regress_the_regional_report() {
    assert_same_checks("regional");
}

/// The table of designs of the repeated study, and the scenario it says it is of.
#[test]
fn regress_the_repeated_study() {
    let reports = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/reports");
    let text = fs::read_to_string(reports.join("reproduce.md")).unwrap();
    let hash = committed("paper")["scenario"]["hash"]
        .as_str()
        .unwrap()
        .to_owned();
    assert!(text.contains(&hash), "reproduce.md is of another scenario");
    let rows = text
        .lines()
        .skip_while(|line| *line != "## Table II")
        .skip(6);
    let mut count = 0;
    for row in rows.take_while(|row| row.starts_with("| ")) {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let output = assert_cmd::Command::cargo_bin("navwalker")
            .unwrap()
            .args(["evaluate", "--design", cells[1], "--format", "json"])
            .output()
            .unwrap();
        let found: Value = serde_json::from_slice(&output.stdout).unwrap();
        for (printed, metric, digits) in [(cells[3], "mean_visible", 4), (cells[6], "mean_pdop", 4)]
        {
            let value = found["metrics"][metric].as_f64().unwrap();
            assert_eq!(
                format!("{value:.digits$}"),
                printed,
                "{} {metric}",
                cells[0]
            );
        }
        count += 1;
    }
    assert_eq!(count, 11);
}

/// The versions in the reports are those that are built in.
#[test]
fn judges_are_those_of_the_lock_file() {
    let text =
        fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.lock")).unwrap();
    let lock: toml::Table = toml::from_str(&text).unwrap();
    let packages = lock["package"].as_array().unwrap();
    for judge in navwalker::validate::JUDGES {
        let locked = packages
            .iter()
            .find(|package| package["name"].as_str() == Some(&*judge.name))
            .unwrap();
        assert_eq!(
            locked["version"].as_str(),
            Some(&*judge.version),
            "{}",
            judge.name
        );
    }
}

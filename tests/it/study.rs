//! The study around a search, as it is typed: several seeds, sweeps, strategies, the paper.

use crate::cli::{optimize, ran, refused};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

/// A point that fronts of small constellations dominate some of.
const REFERENCE: &str = "objectives.hypervolume-reference=[50, 60]";

fn codes(result: &Value) -> Vec<&str> {
    let diagnostics = result["diagnostics"].as_array().unwrap();
    diagnostics
        .iter()
        .map(|diagnostic| diagnostic["code"].as_str().unwrap())
        .collect()
}

#[test]
fn several_seeds_are_several_runs() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let seeds = [
        "--seed", "5", "--seeds", "3", "--out", "all", "--format", "json", "--set", REFERENCE,
    ];
    let all = ran(place, &optimize(&seeds));
    assert_eq!(all.status, 0, "{}", all.stderr);
    let value: Value = serde_json::from_str(&all.stdout).unwrap();
    let runs = value["seeds"].as_array().unwrap();
    let numbers: Vec<_> = runs
        .iter()
        .map(|run| run["seed"].as_u64().unwrap())
        .collect();
    assert_eq!(numbers, [5, 6, 7]);
    assert!(value["hypervolume_spread"]["std_dev"].is_number());
    assert!(codes(&value).iter().any(|code| code.starts_with("seeds-")));

    // Each is the run that its seed alone gives, and the first is the one that is printed.
    let single = [
        "--seed", "6", "--out", "six", "--format", "json", "--set", REFERENCE,
    ];
    assert_eq!(ran(place, &optimize(&single)).status, 0);
    let read = |path: &str| fs::read(place.join(path)).unwrap();
    assert!(read("all/seed-6/front.json") == read("six/front.json"));
    let first: Value = serde_json::from_slice(&read("all/seed-5/front.json")).unwrap();
    assert_eq!(value["front"], first["front"]);
    assert!(place.join("all/seeds.csv").exists() && place.join("all/seeds.json").exists());

    // Again gives the same; resuming finished runs does, too.
    let again = ran(place, &optimize(&[&seeds[..], &["--resume"]].concat()));
    assert_eq!(again.stdout, all.stdout);
    let other = ["--seeds", "2", "--out", "."];
    assert!(
        ran(place, &optimize(&other))
            .stderr
            .contains("which is not the run of a seed")
    );
}

#[test]
fn a_front_is_certified_by_a_sweep() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    // Random search with eight draws, which the sweep beats easily.
    let certified = [
        "--out",
        "random",
        "--certify",
        "--format",
        "json",
        "--set",
        REFERENCE,
        "--set",
        "search.altitude-step-km=300",
        "--set",
        "search.inclination-step-deg=2",
        "--set",
        "optimizer.algorithm=random",
        "--set",
        "optimizer.generations=1",
    ];
    let random = ran(place, &optimize(&certified));
    assert_eq!(random.status, 0, "{}", random.stderr);
    let value: Value = serde_json::from_str(&random.stdout).unwrap();
    assert!(
        codes(&value).contains(&"dominated-by-sweep"),
        "{:?}",
        codes(&value)
    );
    let certificate = &value["certificate"];
    let number = |name: &str| certificate[name].as_f64().unwrap();
    assert!(number("exact_hypervolume") > number("found_hypervolume"));
    let distances = certificate["distances"].as_array().unwrap();
    assert_eq!(distances.len(), value["front"].as_array().unwrap().len());
    assert!(
        distances
            .iter()
            .any(|distance| distance.as_f64().unwrap() > 0.0)
    );
    assert!(certificate["missed"]["members"].as_u64().unwrap() > 0);
    // The sweep is a run of its own, which a second certificate takes up again.
    assert!(place.join("random-sweep/front.json").exists());
    assert_eq!(ran(place, &optimize(&certified)).stdout, random.stdout);
}

#[test]
fn every_objective_constraint_and_pattern_can_be_searched() {
    let directory = TempDir::new().unwrap();
    let objectives = [
        "j-pos",
        "j-cost",
        "mean-pdop",
        "cvar-pdop",
        "max-pdop",
        "satellites",
        "planes",
        "mean-visible",
        "availability",
        "launch-cost",
        "p95-pdop",
        "p99-pdop",
    ];
    for (n, objective) in objectives.into_iter().enumerate() {
        let minimize = format!("objectives.minimize=[\"{objective}\"]");
        let pattern = ["delta", "star", "lattice"][n % 3];
        let algorithm = ["nsga2", "mopso", "random"][n % 3];
        let pattern = format!("search.pattern={pattern}");
        let algorithm = format!("optimizer.algorithm={algorithm}");
        let further = [
            "--force",
            "--out",
            "run",
            "--format",
            "json",
            "--set",
            &minimize,
            "--set",
            &pattern,
            "--set",
            &algorithm,
            "--set",
            "search.phasing=[0, 9]",
            "--set",
            "objectives.constraints=[\"satellites <= 45\"]",
        ];
        let ran = ran(directory.path(), &optimize(&further));
        assert_eq!(ran.status, 0, "{objective}: {}", ran.stderr);
        let value: Value = serde_json::from_str(&ran.stdout).unwrap();
        let front = value["front"].as_array().unwrap();
        assert!(!front.is_empty(), "{objective}");
        // With one objective all members of a front share its value.
        let best = &front[0]["objectives"][objective];
        for member in front {
            assert_eq!(&member["objectives"][objective], best);
            assert!(member["design"]["satellites"].as_u64().unwrap() <= 45);
        }
    }
}

#[test]
fn a_search_that_cannot_succeed_says_so() {
    let set = |value: &'static str| refused(&["optimize", "--set", value]);
    for (value, expected) in [
        ("objectives.minimize=[\"j-pso\"]", "did you mean \"j-pos\""),
        (
            "objectives.constraints=[\"max-pdp <= 2\"]",
            "did you mean \"max-pdop\"",
        ),
        ("objectives.minimize=[\"j-pos\", \"j-pos\"]", "j-pos"),
        ("optimizer.generations=0", "expected an integer >= 1"),
        (
            "objectives.launch-cost-per-plane=-1",
            "expected a number >= 0",
        ),
        ("search.inclination-deg=[60, 40]", "above the high limit"),
    ] {
        let stderr = set(value);
        assert!(
            stderr.contains(expected),
            "{expected:?} is not in: {stderr}"
        );
    }
    let directory = TempDir::new().unwrap();
    let none = [
        "--set",
        "objectives.constraints=[\"max-pdop <= 0.1\"]",
        "--format",
        "json",
    ];
    let ran = ran(directory.path(), &optimize(&none));
    assert_eq!(ran.status, 1);
    let value: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(codes(&value), ["no-feasible-design"]);
}

#[test]
fn the_paper_is_repeated_into_a_directory() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let small = [
        "reproduce",
        "--quiet",
        "--set",
        "time.step-s=3600",
        "--set",
        "optimizer.population=4",
        "--set",
        "optimizer.generations=2",
    ];
    let with = |further: &[&'static str]| ran(place, &[&small[..], further].concat());
    let one = with(&["--format", "json", "--threads", "1"]);
    assert_eq!(one.status, 0, "{}", one.stderr);
    let value: Value = serde_json::from_str(&one.stdout).unwrap();
    assert_eq!(value["rows"].as_array().unwrap().len(), 11);
    let verdicts = ["met", "met under another assumption", "not met"];
    for line in value["lines"].as_array().unwrap() {
        assert!(
            verdicts.contains(&line["verdict"].as_str().unwrap()),
            "{line}"
        );
    }
    let read = |name: &str| fs::read_to_string(place.join("runs/reproduce").join(name)).unwrap();
    for (name, rows) in [
        ("table2.csv", 11),
        ("figure-3a.csv", 4 * 24),
        ("figure-3b.csv", 4 * 24),
        ("figure-4a.csv", 3 * 24),
        ("figure-4b.csv", 3 * 24),
    ] {
        assert_eq!(read(name).lines().count(), rows + 1, "{name}");
    }
    assert!(read("report.md").starts_with("# Reproduction of the paper"));
    // The same again replaces it with the same bytes; another study needs --force.
    let before = read("report.json");
    assert_eq!(with(&["--threads", "2"]).status, 0);
    assert!(read("report.json") == before);
    let other = with(&["--set", "visibility.mask-deg=10"]);
    assert_eq!(other.status, 2);
    assert!(other.stderr.contains("--force"), "{}", other.stderr);
}

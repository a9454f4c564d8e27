//! `size` as it is typed: the fewest satellites, their certificate, and what is refused.

use crate::cli::{ran, refused};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A search of a fraction of a second, without its constraints.
const SMALL: &str = "--quiet --set region.step-deg=20 --set time.step-s=3600 --set search.planes=[4,6] \
     --set search.satellites-per-plane=[4,8] --set search.inclination-step-deg=10 --set search.altitude-step-km=300 \
     --set search.phasing=[0,2] --set objectives.availability-pdop=1.6";

const AVAILABILITY: &str = "objectives.constraints=[\"availability >= 0.85\"]";

fn size(further: &[&str]) -> Vec<String> {
    let small = SMALL.split_whitespace();
    let words = ["size"]
        .into_iter()
        .chain(small)
        .chain(further.iter().copied());
    words.map(str::to_owned).collect()
}

fn run(place: &Path, further: &[&str]) -> crate::cli::Ran {
    let words = size(further);
    ran(place, &words.iter().map(String::as_str).collect::<Vec<_>>())
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

/// The answer, its files, and that of a sweep by `optimize` with the satellites as the only objective.
#[test]
fn the_fewest_satellites_are_those_of_a_sweep() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let arguments = ["--set", AVAILABILITY, "--out", "fewest", "--format", "json"];
    let found = run(place, &arguments);
    assert_eq!(found.status, 0, "{}", found.stderr);
    let result = json(&found.stdout);
    let fewest = result["fewest"].as_u64().unwrap();
    let designs = result["designs"].as_array().unwrap();
    assert!(!designs.is_empty());
    for one in designs {
        assert_eq!(one["design"]["satellites"], fewest);
        assert!(one["metrics"]["availability"].as_f64().unwrap() >= 0.85);
    }
    let rejected = result["rejected"].as_array().unwrap();
    assert!(
        rejected
            .iter()
            .all(|level| level["satellites"].as_u64().unwrap() < fewest)
    );
    let number: u64 = rejected
        .iter()
        .map(|level| level["designs"].as_u64().unwrap())
        .sum();
    let certificate = fs::read_to_string(place.join("fewest/certificate.csv")).unwrap();
    let below = certificate.lines().skip(1).filter(|line| {
        let satellites = line.split(',').next().unwrap();
        satellites.parse::<u64>().unwrap() < fewest
    });
    assert_eq!(below.count() as u64, number);
    assert!(result["above"][0]["satellites"].as_u64().unwrap() > fewest);
    // Between the steps, around the closest of two numbers below and around the best.
    let refined = result["refinement"].as_array().unwrap();
    let of = |satellites: u64| {
        refined
            .iter()
            .filter(|one| one["satellites"] == satellites)
            .count()
    };
    assert_eq!(of(fewest), designs.len().min(3));
    let below: Vec<u64> = rejected
        .iter()
        .rev()
        .take(2)
        .map(|level| level["satellites"].as_u64().unwrap())
        .collect();
    for satellites in below {
        assert!((1..=3).contains(&of(satellites)), "{satellites}");
    }
    for one in refined {
        assert_eq!(one["kept"], one["violation"] == 0.0);
        assert_eq!(
            one["kept"].as_bool().unwrap(),
            one["constraints"][0]["value"].as_f64().unwrap() >= 0.85
        );
    }
    let evaluations = &result["evaluations"];
    assert!(
        evaluations["samples_share"].as_f64().unwrap() < 0.9,
        "{evaluations}"
    );
    let file = fs::read_to_string(place.join("fewest/size.json")).unwrap();
    assert_eq!(json(&file), result);

    let sweep = [
        "--set",
        AVAILABILITY,
        "--set",
        "objectives.minimize=[\"satellites\"]",
        "--set",
        "optimizer.algorithm=exhaustive",
        "--out",
        "sweep",
        "--format",
        "json",
    ];
    let mut words = size(&sweep);
    words[0] = "optimize".to_owned();
    let swept = ran(place, &words.iter().map(String::as_str).collect::<Vec<_>>());
    assert_eq!(
        json(&swept.stdout)["front"][0]["objectives"]["satellites"],
        fewest as f64
    );

    let verified = ran(place, &["size", "--verify", "fewest", "--draw", "1000"]);
    assert_eq!(verified.status, 0, "{}", verified.stdout);
    assert!(
        verified.stdout.contains("nothing is wrong"),
        "{}",
        verified.stdout
    );
}

/// A certificate without a row, with a row of another design, or beside another result is not believed.
#[test]
fn a_changed_certificate_is_noticed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let arguments = ["--set", AVAILABILITY, "--out", "fewest", "--format", "json"];
    let result = json(&run(place, &arguments).stdout);
    let path = place.join("fewest/certificate.csv");
    let original = fs::read_to_string(&path).unwrap();
    let designs = result["designs"].as_array().unwrap();
    let kept = designs[0]["design"]["notation"]
        .as_str()
        .unwrap()
        .to_owned();
    let line = original.lines().nth(5).unwrap().to_owned();
    let design = line.split(',').nth(1).unwrap().to_owned();
    let next = result["above"][0]["satellites"].as_u64().unwrap();
    let of_next = |line: &&str| line.starts_with(&format!("{next},"));
    let above = original.lines().find(of_next).unwrap().to_owned();
    let without = |line: &str| original.replacen(&format!("{line}\n"), "", 1);
    let lines: Vec<&str> = original.lines().collect();
    let swapped = [&lines[..3], &[lines[4], lines[3]], &lines[5..]].concat();
    // What is changed, what must be said, and how many things are wrong: what is missing at one place says nothing about
    // the rest. Every change is also one of the checksum.
    let changes = [
        (
            without(&line),
            format!("1 design without a proof with 16 satellites, the first is {design}"),
            2,
        ),
        (
            without(&above),
            format!("with {next} satellites are without a proof, but the result says"),
            3,
        ),
        (
            original.replacen(&design, &kept, 1),
            "is rejected, but keeps the constraints".to_owned(),
            4,
        ),
        (
            swapped.join("\n") + "\n",
            "not in the order of the grid".to_owned(),
            2,
        ),
        (
            original.clone() + "oops\n",
            "not a row of a certificate: oops".to_owned(),
            2,
        ),
        (
            original.replacen("availability", "max-pdop", 1),
            "checksum".to_owned(),
            1,
        ),
    ];
    for (changed, finding, wrong) in changes {
        assert_ne!(changed, original);
        fs::write(&path, changed).unwrap();
        let verified = ran(place, &["size", "--verify", "fewest", "--draw", "100000"]);
        assert_eq!(verified.status, 1, "{}", verified.stdout);
        assert!(
            verified.stdout.contains(&finding),
            "{finding}: {}",
            verified.stdout
        );
        let found = verified.stdout.matches("wrong: ").count();
        assert_eq!(found, wrong, "{finding}: {}", verified.stdout);
    }
    fs::write(&path, &original).unwrap();
    let table = place.join("fewest/size.csv");
    let text = fs::read_to_string(&table).unwrap();
    for changed in [String::new(), text.replacen("delta", "star", 1)] {
        fs::write(&table, changed).unwrap();
        let verified = ran(place, &["size", "--verify", "fewest"]);
        assert_eq!(verified.status, 1, "{}", verified.stdout);
        assert!(
            verified
                .stdout
                .contains("size.csv does not have the designs of size.json"),
            "{}",
            verified.stdout
        );
    }
    fs::write(&table, &text).unwrap();
    // Every row is drawn, those with the fewest satellites and above among them.
    let all = [
        "size", "--verify", "fewest", "--draw", "100000", "--format", "json",
    ];
    let all = json(&ran(place, &all).stdout);
    assert_eq!(all["drawn"], result["certificate"]["designs"]);
    let more = result["above"][0]["kept"].as_u64().unwrap();
    assert_eq!(all["kept"], designs.len() as u64 + more);
    assert_eq!(all["passed"], true);
    fs::write(&path, &original).unwrap();
    let path = place.join("fewest/size.json");
    let text = fs::read_to_string(&path).unwrap();
    let rejected = design;
    fs::write(&path, text.replace(&kept, &rejected)).unwrap();
    let verified = ran(place, &["size", "--verify", "fewest"]);
    assert!(
        verified.stdout.contains("does not keep the constraints"),
        "{}",
        verified.stdout
    );
}

/// The same bytes on one thread and on two.
#[test]
fn threads_do_not_matter() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for threads in ["1", "2"] {
        let out = format!("on-{threads}");
        let arguments = [
            "--set",
            AVAILABILITY,
            "--out",
            &out,
            "--threads",
            threads,
            "--slack",
            "6",
        ];
        assert_eq!(run(place, &arguments).status, 0);
    }
    for file in ["size.json", "size.csv", "certificate.csv"] {
        let read = |out: &str| fs::read(place.join(out).join(file)).unwrap();
        assert!(read("on-1") == read("on-2"), "{file}");
    }
}

/// Constraints that no design keeps give the best by number of satellites, and status 1; those that all keep, the
/// smallest design.
#[test]
fn nothing_and_everything_may_keep_the_constraints() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let none = [
        "--set",
        "objectives.constraints=[\"max-pdop <= 1.3\"]",
        "--format",
        "json",
    ];
    let none = run(place, &none);
    let result = json(&none.stdout);
    assert_eq!((none.status, &result["fewest"]), (1, &Value::Null));
    let reached = result["best_reached"].as_array().unwrap();
    assert_eq!(reached.len(), result["rejected"].as_array().unwrap().len());
    assert!(reached[0]["constraints"][0]["value"].as_f64().unwrap() > 1.3);
    let text = run(
        place,
        &["--set", "objectives.constraints=[\"max-pdop <= 1.3\"]"],
    );
    assert!(
        text.stdout.contains("Best that was reached"),
        "{}",
        text.stdout
    );
    let all = [
        "--set",
        "objectives.constraints=[\"mean-visible >= 0\"]",
        "--format",
        "json",
    ];
    let all = json(&run(place, &[&all[..], &["--out", "all"]].concat()).stdout);
    assert_eq!(all["fewest"], 16);
    assert_eq!(all["rejected"].as_array().unwrap().len(), 0);
}

#[test]
fn what_makes_no_sense_is_refused() {
    for (arguments, message) in [
        ("size", "objectives.constraints is empty"),
        (
            "size --set objectives.constraints=[\"availability>=0.9\",\"availability<=0.8\"]",
            "exclude every design",
        ),
        (
            "size --set objectives.constraints=[\"availability>=0.9\"] --set search.inclination-step-deg=1e-7",
            "need --allow-large, or use larger steps",
        ),
        (
            "size --slack 2 --set objectives.minimize=[\"satellites\"] --set objectives.constraints=[\"availability>=0.9\"]",
            "expected one further objective",
        ),
        ("size --verify nowhere", "is not a run directory"),
        ("size --draw 3", "--verify"),
    ] {
        let words: Vec<&str> = arguments.split(' ').collect();
        let stderr = refused(&words);
        assert!(stderr.contains(message), "{arguments}: {stderr}");
    }
}

/// A search that was stopped goes on to the same answer: here it is taken back to an empty certificate.
#[test]
fn a_search_without_checkpoint_starts_over() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let arguments = ["--set", AVAILABILITY, "--out", "fewest"];
    let first = run(place, &arguments);
    let certificate = fs::read(place.join("fewest/certificate.csv")).unwrap();
    fs::remove_file(place.join("fewest/size.checkpoint")).unwrap();
    let again = run(place, &[&arguments[..], &["--resume"]].concat());
    assert_eq!(again.stdout, first.stdout);
    assert_eq!(
        fs::read(place.join("fewest/certificate.csv")).unwrap(),
        certificate
    );
    // With another slack the checkpoint does not fit.
    let other = run(
        place,
        &[&arguments[..], &["--resume", "--slack", "2"]].concat(),
    );
    assert_eq!(other.status, 2);
    assert!(other.stderr.contains("another --slack"), "{}", other.stderr);
    fs::write(place.join("fewest/size.checkpoint"), "{}\n{}\n").unwrap();
    let damaged = run(place, &[&arguments[..], &["--resume"]].concat());
    assert_eq!(damaged.status, 2);
    assert!(damaged.stderr.contains("is damaged"), "{}", damaged.stderr);
}

/// Shards in any order leave what one process leaves, also where one of their files is cut short, and are taken up where they are of
/// this search.
#[test]
fn shards_leave_what_one_process_leaves() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    // 27 135 points of the grid in four parts.
    let fine = [
        "--set",
        "search.inclination-step-deg=0.1",
        "--set",
        AVAILABILITY,
    ];
    let found = |further: &[&str]| {
        let words = size(&[&fine[..], &["--format", "csv"], further].concat());
        let told = words.iter().map(String::as_str);
        let told: Vec<&str> = told.filter(|word| *word != "--quiet").collect();
        let found = ran(place, &told);
        assert_eq!(found.status, 0, "{}", found.stderr);
        found
    };
    let whole = found(&["--out", "whole"]);
    for shard in ["3/3", "1/3", "2/3"] {
        let shard = found(&["--out", "parts", "--shard", shard]);
        assert_eq!(shard.stdout, "");
    }
    let mut parts: Vec<_> = fs::read_dir(place.join("parts/parts"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    parts.sort();
    assert!(parts.len() > 1, "{parts:?}");
    let bytes = fs::read(&parts[1]).unwrap();
    fs::write(&parts[1], &bytes[..bytes.len() - 10]).unwrap();
    let other = run(
        place,
        &[
            &fine[..],
            &[
                "--out",
                "parts",
                "--slack",
                "2",
                "--resume",
                "--set",
                "objectives.minimize=[\"satellites\",\"mean-pdop\"]",
            ],
        ]
        .concat(),
    );
    assert_eq!(other.status, 2, "{}", other.stderr);
    let merged = found(&["--out", "parts", "--resume"]);
    assert!(
        merged
            .stderr
            .contains("1.part: it is damaged; its designs are tried again"),
        "{}",
        merged.stderr
    );
    assert_eq!(merged.stdout, whole.stdout);
    let [parts, whole] = ["parts", "whole"].map(|name| crate::common::contents(&place.join(name)));
    assert_eq!(parts, whole);
    // What is done is said and not begun again.
    let late = found(&["--out", "parts", "--shard", "1/3"]);
    assert!(
        late.stderr.contains("has the result already"),
        "{}",
        late.stderr
    );
    let other = [
        "--out",
        "parts",
        "--shard",
        "1/3",
        "--set",
        "time.step-s=1800",
    ];
    let refused = run(place, &[&fine[..], &other].concat());
    assert_eq!(refused.status, 2);
    assert!(
        refused
            .stderr
            .contains("holds something other than a search"),
        "{}",
        refused.stderr
    );
}

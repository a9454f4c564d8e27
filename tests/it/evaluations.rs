//! `optimize --evaluations` and `--from`: everything that a search evaluated, and fronts of it for other goals.

use crate::cli::{Ran, ran};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A space of 54 designs, so that a sweep takes a second, with metrics that are computed on demand.
const SMALL: &str = "optimize --quiet --set region.step-deg=25 --set time.step-s=3600 --set search.planes=[4,6] \
     --set search.satellites-per-plane=[4,6] --set search.inclination-step-deg=10 --set search.altitude-step-km=300 \
     --set search.phasing=1 --set visibility.mask-deg=10 --set optimizer.population=8 --set optimizer.generations=4";

const FIRST: [&str; 2] = [
    "--set",
    "objectives.minimize=[\"gain-mean-pdop\",\"satellites\"]",
];
const OTHERS: [&str; 4] = [
    "--set",
    "objectives.minimize=[\"planes\",\"max-pdop\",\"launch-cost\"]",
    "--set",
    "objectives.constraints=[\"availability >= 0.9\",\"gain-p95-pdop >= 0\"]",
];

fn run(place: &Path, further: &[&[&str]]) -> Ran {
    let words = SMALL.split_whitespace();
    let words: Vec<&str> = words.chain(further.concat()).collect();
    ran(place, &words)
}

fn json(ran: &Ran) -> Value {
    serde_json::from_str(&ran.stdout).unwrap_or_else(|_| panic!("{}", ran.stderr))
}

/// Of a sweep, the front for other goals is that of a sweep for them, to the last digit of every metric.
#[test]
fn a_front_for_other_goals_is_that_of_a_sweep_for_them() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let sweep: &[&str] = &[
        "--set",
        "optimizer.algorithm=exhaustive",
        "--format",
        "json",
    ];
    let first = run(
        place,
        &[sweep, &FIRST, &["--evaluations", "--out", "first"]],
    );
    let first = json(&first);
    let others = json(&run(place, &[sweep, &OTHERS, &["--out", "others"]]));
    assert_ne!(first["front"], others["front"]);
    let from = |goals: &[&str]| {
        let words = [&["optimize", "--from", "first", "--format", "json"], goals].concat();
        json(&ran(place, &words))
    };
    let own = from(&[]);
    assert_eq!(own["front"], first["front"]);
    let found = from(&OTHERS);
    // The gain of the first goals is in the metrics of each evaluation, that of the others too: the same set.
    assert_eq!(found["front"], others["front"]);
    assert_eq!(found["evaluations"], others["evaluations"]);
    assert_eq!(found["diagnostics"][0]["code"], "from-evaluations");
    let table = fs::read_to_string(place.join("first/evaluations.csv")).unwrap();
    let evaluations = first["evaluations"].as_u64().unwrap();
    assert_eq!(table.lines().count() as u64, evaluations + 1);
    assert!(
        table.starts_with(
            "evaluation,generation,x_planes,x_satellites_per_plane,x_inclination_deg,"
        )
    );
    let last = table.lines().last().unwrap();
    assert!(last.starts_with(&format!("{evaluations},")), "{last}");
}

/// The table of a search that was resumed is that of an unbroken one, also where the flag is not repeated.
#[test]
fn a_resumed_table_equals_an_unbroken_one() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let long: &[&str] = &["--set", "optimizer.generations=6"];
    let unbroken = run(
        place,
        &[&FIRST, long, &["--evaluations", "--out", "unbroken"]],
    );
    assert_eq!(unbroken.status, 0, "{}", unbroken.stderr);
    run(place, &[&FIRST, &["--evaluations", "--out", "resumed"]]);
    let short = fs::read_to_string(place.join("resumed/evaluations.csv")).unwrap();
    // As a search leaves it that was killed while it wrote.
    fs::rename(
        place.join("resumed/evaluations.csv"),
        place.join("resumed/evaluations.partial.csv"),
    )
    .unwrap();
    fs::write(
        place.join("resumed/evaluations.partial.csv"),
        short + "33,5,4,4",
    )
    .unwrap();
    let resumed = run(place, &[&FIRST, long, &["--resume", "--out", "resumed"]]);
    assert_eq!(resumed.status, 0, "{}", resumed.stderr);
    for file in ["evaluations.csv", "evaluations.json", "front.json"] {
        let read = |out: &str| fs::read_to_string(place.join(out).join(file)).unwrap();
        assert!(read("unbroken") == read("resumed"), "{file}");
    }
    assert!(!place.join("resumed/evaluations.partial.csv").exists());
    // Without a table of the first generations there is none of all.
    run(place, &[&FIRST, &["--out", "without"]]);
    let refused = run(
        place,
        &[
            &FIRST,
            long,
            &["--evaluations", "--resume", "--out", "without"],
        ],
    );
    assert_eq!(refused.status, 2);
    assert!(
        refused
            .stderr
            .contains("no table of the 32 evaluations so far"),
        "{}",
        refused.stderr
    );
}

#[test]
fn what_cannot_be_had_from_evaluations_is_refused() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    run(place, &[&FIRST, &["--evaluations", "--out", "run"]]);
    run(place, &[&FIRST, &["--out", "without"]]);
    let refused = |words: &[&str], message: &str| {
        let ran = ran(place, &[&["optimize", "--from"], words].concat());
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{words:?}");
        assert!(ran.stderr.contains(message), "{words:?}: {}", ran.stderr);
    };
    refused(&["nowhere"], "is not a run directory");
    refused(&["without"], "a search writes them with --evaluations");
    refused(
        &["run", "--set", "objectives.minimize=[\"sigma-3d-m\"]"],
        "accuracy",
    );
    refused(
        &["run", "--set", "objectives.minimize=[\"n1-max-pdop\"]"],
        "n1-max-pdop has no value in any of the 32 evaluations",
    );
    refused(
        &["run", "--set", "objectives.minimize=[\"mean-pdopp\"]"],
        "mean-pdop",
    );
    for key in [
        "region.step-deg=20",
        "objectives.availability-pdop=2",
        "search.planes=[4,7]",
    ] {
        let (name, _) = key.split_once('=').unwrap();
        refused(
            &["run", "--set", key],
            &format!("--set {name}: the evaluations"),
        );
    }
    refused(&["run", "regional"], "cannot be used with");
    let table = place.join("run/evaluations.csv");
    let text = fs::read_to_string(&table).unwrap();
    fs::write(&table, text.replacen("\n2,", "\n7,", 1)).unwrap();
    refused(&["run"], "checksum mismatch");
    let stamp = place.join("run/evaluations.json");
    let of_other = fs::read_to_string(&stamp)
        .unwrap()
        .replacen("\"hash\": \"", "\"hash\": \"0", 1);
    fs::write(&stamp, of_other).unwrap();
    refused(&["run"], "evaluations of another scenario");
}

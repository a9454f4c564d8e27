//! Several constellations in one command: tables, series, lists of designs, and satellites that meet.

use crate::cli::{Ran, ran, refused};
use assert_cmd::Command;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SMALL: [&str; 4] = ["--set", "region.step-deg=20", "--set", "time.step-s=1200"];
const FIRST: &str = "delta:55:24/6/1@925";
const HYBRID: &str = "delta:53:20/5/1@1000+star:90:8/2/0@1100";

fn evaluate(directory: &Path, further: &[&str]) -> Ran {
    ran(directory, &[&["evaluate"], &SMALL[..], further].concat())
}

#[track_caller]
fn json(directory: &Path, further: &[&str]) -> Value {
    let ran = evaluate(directory, &[&["--format", "json"], further].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

/// A directory with a constellation file.
fn with_file() -> TempDir {
    let directory = TempDir::new().unwrap();
    let export = [
        "export", "--quiet", "--as", "tle", "--out", "fleet", "--design", FIRST,
    ];
    assert_eq!(ran(directory.path(), &export).status, 0);
    directory
}

const THREE: [&str; 6] = [
    "--design",
    FIRST,
    "--design",
    "hybrid=delta:53:20/5/1@1000+star:90:8/2/0@1100",
    "--constellation",
    "fleet/constellation.tle",
];

#[test]
fn several_constellations_stand_beside_the_gnss_alone() {
    let directory = with_file();
    let place = directory.path();
    let found = json(place, &[&THREE[..], &["--dops"]].concat());
    let entries = found["constellations"].as_array().unwrap();
    let names: Vec<_> = entries
        .iter()
        .map(|one| one["name"].as_str().unwrap())
        .collect();
    assert_eq!(names, [FIRST, "hybrid", "constellation.tle"]);
    assert_eq!(entries[1]["notation"], HYBRID);
    assert_eq!(entries[1]["design"]["shells"].as_array().unwrap().len(), 2);
    assert_eq!(entries[2]["files"][0], "constellation.tle");
    assert!(entries[2].get("notation").is_none() && entries[2].get("design").is_none());
    let satellites: Vec<_> = entries
        .iter()
        .map(|one| one["satellites"].as_u64().unwrap())
        .collect();
    assert_eq!(satellites, [24, 28, 24]);
    // Each as it is alone.
    for (n, one) in ["--design", "--design", "--constellation"]
        .iter()
        .zip(THREE.chunks(2))
        .map(|(_, pair)| pair)
        .enumerate()
    {
        let alone = json(place, &[one, &["--dops"]].concat());
        assert_eq!(alone["metrics"], entries[n]["metrics"]);
        assert_eq!(alone["dops"], entries[n]["dops"]);
        assert_eq!(alone["gnss_only"], found["gnss_only"]);
    }
    let alone = &found["gnss_only"]["metrics"];
    assert_eq!(alone["mean_visible"], 0.0);
    assert!(alone["j_cost"].is_null());
    let mean = |value: &Value| value["metrics"]["mean_pdop"].as_f64().unwrap();
    assert!(
        entries
            .iter()
            .all(|one| mean(one) < mean(&found["gnss_only"]))
    );
    assert_eq!(found["scenario"]["name"], "paper");
    assert_eq!(found["version"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn without_gnss_there_is_none_alone() {
    let directory = TempDir::new().unwrap();
    let none = ["--set", "gnss.constellations=[]", "--design", FIRST];
    let found = json(directory.path(), &none);
    assert!(found.as_object().unwrap().contains_key("gnss_only"));
    assert!(found["gnss_only"].is_null());
    let csv = evaluate(
        directory.path(),
        &[&none[..], &["--format", "csv"]].concat(),
    );
    assert_eq!(csv.stdout.lines().count(), 2);
}

/// A table has a column for each constraint, also beside DOPs, with a verdict for each row.
#[test]
fn a_table_has_the_verdict_on_each_constraint() {
    let directory = with_file();
    let bounds =
        "objectives.constraints=[\"availability >= 0.5\", \"mean-visible >= 1\", \"planes <= 6\"]";
    let given = [&THREE[..], &["--set", bounds, "--dops", "--format", "csv"]].concat();
    let csv = evaluate(directory.path(), &given);
    let mut reader = csv::Reader::from_reader(csv.stdout.as_bytes());
    let header = reader.headers().unwrap().clone();
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    let verdicts = |constraint: &str| {
        let at = header.iter().position(|one| one == constraint).unwrap();
        rows.iter()
            .map(|row| row[at].to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(verdicts("availability >= 0.5"), ["met"; 4]);
    let of_means: Vec<String> = verdicts("mean_visible")
        .iter()
        .map(|mean| match mean.parse::<f64>().unwrap() >= 1.0 {
            true => "met".to_owned(),
            false => "violated".to_owned(),
        })
        .collect();
    assert_eq!(verdicts("mean-visible >= 1"), of_means);
    assert!(of_means[0] == "met" && of_means[3] == "violated");
    let of_planes = ["met", "violated", "not defined", "not defined"];
    assert_eq!(verdicts("planes <= 6"), of_planes);
}

/// One table a stream, whose last row is the GNSS alone.
#[test]
fn a_table_has_a_row_for_each_and_columns_for_dops() {
    let directory = with_file();
    let place = directory.path();
    let csv = evaluate(
        place,
        &[&THREE[..], &["--dops", "--format", "csv"]].concat(),
    );
    let mut reader = csv::Reader::from_reader(csv.stdout.as_bytes());
    let header = reader.headers().unwrap().clone();
    let column = |name: &str| header.iter().position(|one| one == name).unwrap();
    assert_eq!(column("name"), 0);
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    let names: Vec<_> = rows.iter().map(|row| row[0].to_owned()).collect();
    assert_eq!(names, [FIRST, "hybrid", "constellation.tle", "gnss-only"]);
    assert_eq!(&rows[2][column("files")], "constellation.tle");
    assert_eq!(&rows[2][column("satellites")], "24");
    assert_eq!(&rows[3][column("satellites")], "0");
    let found = json(place, &[&THREE[..], &["--dops"]].concat());
    for (row, entry) in rows.iter().zip(found["constellations"].as_array().unwrap()) {
        let hdop = entry["dops"]["hdop"]["p95"].as_f64().unwrap();
        assert_eq!(row[column("hdop_p95")].parse(), Ok(hdop));
        let visible = entry["metrics"]["mean_visible"].as_f64().unwrap();
        assert_eq!(row[column("mean_visible")].parse(), Ok(visible));
    }
    // The clock of the LEO satellites has no dilution without any.
    assert_eq!(&rows[3][column("tdop_leo_mean")], "");
    let text = evaluate(
        place,
        &[
            &THREE[..],
            &["--set", "objectives.constraints=[\"planes <= 5\"]"],
        ]
        .concat(),
    );
    let lines: Vec<_> = text.stdout.lines().collect();
    assert!(lines[0].starts_with("3 constellations in scenario paper"));
    assert!(
        lines[3].ends_with("violated: planes <= 5"),
        "{}",
        text.stdout
    );
    assert!(
        lines[5].ends_with("not defined: planes <= 5"),
        "{}",
        text.stdout
    );
    assert!(lines[6].starts_with("GNSS alone"), "{}", text.stdout);
    assert_eq!(lines.len(), 7);
}

#[test]
fn each_of_several_has_a_folder_of_its_series() {
    let directory = with_file();
    let place = directory.path();
    let series = ["--series", "series", "--quiet", "--force"];
    for _ in 0..2 {
        let done = evaluate(place, &[&THREE[..], &series].concat());
        assert_eq!(done.status, 0, "{}", done.stderr);
    }
    let alone = evaluate(place, &["--design", FIRST, "--series", "alone"]);
    assert_eq!(alone.status, 0);
    for folder in ["delta_55_24_6_1@925", "hybrid", "constellation.tle"] {
        for table in ["epochs.csv", "points.csv"] {
            let text = fs::read_to_string(place.join("series").join(folder).join(table)).unwrap();
            assert!(text.lines().count() > 2, "{folder}/{table}");
        }
    }
    let same = |path: &str| fs::read_to_string(place.join(path)).unwrap();
    assert_eq!(
        same("series/delta_55_24_6_1@925/epochs.csv"),
        same("alone/epochs.csv")
    );
    // What somebody else put there is not deleted.
    fs::write(place.join("series/hybrid/notes.txt"), "mine").unwrap();
    let stopped = evaluate(place, &[&THREE[..], &series].concat());
    assert_eq!(stopped.status, 2);
    assert!(
        stopped.stderr.contains("hybrid/notes.txt"),
        "{}",
        stopped.stderr
    );
}

fn piped(arguments: &[&str], input: &str) -> Ran {
    let mut command = Command::cargo_bin("navwalker").unwrap();
    command.args(["evaluate"]).args(SMALL).args(arguments);
    let output = command.write_stdin(input).output().unwrap();
    Ran {
        status: output.status.code().unwrap(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

const LIST: &str = "\u{feff}# a comment\r\n\r\ndelta:55:24/6/1@925\r\ndelta:55:25/6/1@925\r\nstar:90:8/2/0@1100,e=0.01,w=270\r\n";

/// Bad lines are named and left out; the others are as they are alone.
#[test]
fn a_list_of_notations_is_evaluated_in_its_order() {
    let directory = TempDir::new().unwrap();
    let csv = ["--designs", "-", "--format", "csv"];
    let found = piped(&csv, LIST);
    assert_eq!(found.status, 1, "{}", found.stderr);
    assert!(
        found.stderr.contains("stdin:4: delta:55:25/6/1@925: "),
        "{}",
        found.stderr
    );
    assert_eq!(found.stderr.lines().count(), 1, "{}", found.stderr);
    let elliptic = "star:90:8/2/0@1100,e=0.01,w=270";
    let given = ["--design", FIRST, "--design", elliptic, "--format", "csv"];
    assert_eq!(found.stdout, evaluate(directory.path(), &given).stdout);
    let value: Value =
        serde_json::from_str(&piped(&["--designs", "-", "--format", "json"], LIST).stdout).unwrap();
    let given = json(directory.path(), &given[..4]);
    assert_eq!(value, given);
    // Of one design too.
    let one = piped(&["--designs", "-", "--format", "json"], FIRST);
    let value: Value = serde_json::from_str(&one.stdout).unwrap();
    assert_eq!(
        (
            one.status,
            value["constellations"].as_array().unwrap().len()
        ),
        (0, 1)
    );
    let none = piped(&csv, "delta:55:25/6/1@925\nno notation\n");
    assert_eq!((none.status, none.stdout.as_str()), (2, ""));
    assert!(
        none.stderr.contains("no design of stdin can be evaluated"),
        "{}",
        none.stderr
    );
    let empty = piped(&csv, "# nothing\n");
    assert!(
        empty.status == 2 && empty.stderr.contains("contains no design"),
        "{}",
        empty.stderr
    );
}

/// The columns of a table are found by their names, and its bytes do not depend on the number of threads.
#[test]
fn a_list_may_be_a_table_of_any_length() {
    let directory = TempDir::new().unwrap();
    let mut table = "altitude,Name,design\n# half-way\n".to_owned();
    for n in 0..300 {
        let altitude = 900 + n;
        let name = if n == 7 {
            "seventh".to_owned()
        } else {
            String::new()
        };
        table += &format!("{altitude},{name},\"delta:55:6/3/1@{altitude},e=0\"\n");
    }
    table += "1,short\n2,,\n";
    fs::write(directory.path().join("list.csv"), &table).unwrap();
    let list = ["--designs", "list.csv", "--set", "region.step-deg=60"];
    for format in ["csv", "json", "text"] {
        let of = |threads: &str| {
            let further = ["--format", format, "--threads", threads];
            evaluate(directory.path(), &[&list[..], &further].concat())
        };
        let (one, three) = (of("1"), of("3"));
        assert_eq!((one.status, three.status), (1, 1), "{}", one.stderr);
        assert!(
            one.stdout == three.stdout && one.stderr == three.stderr,
            "{format}"
        );
        assert!(
            one.stderr
                .contains("list.csv:303: 2 cells below a header of 3"),
            "{}",
            one.stderr
        );
        assert!(
            one.stderr.contains("list.csv:304: no design"),
            "{}",
            one.stderr
        );
        if format == "csv" {
            let rows: Vec<_> = one.stdout.lines().collect();
            assert_eq!(rows.len(), 1 + 300 + 1);
            assert!(rows[8].starts_with("seventh,"), "{}", rows[8]);
            assert!(rows[9].starts_with("delta:55:6/3/1@908,"), "{}", rows[9]);
            assert!(rows[301].starts_with("gnss-only,"), "{}", rows[301]);
        }
    }
    fs::write(directory.path().join("list.csv"), "name,notatoin\na,b\n").unwrap();
    let stopped = evaluate(directory.path(), &list);
    assert!(
        stopped.stderr.contains("no column 'design'"),
        "{}",
        stopped.stderr
    );
    assert_eq!(stopped.status, 2);
}

#[test]
fn constellations_that_cannot_be_told_apart_or_found_are_refused() {
    let twice = refused(&["evaluate", "--design", FIRST, "--design", FIRST]);
    assert!(twice.contains("two constellations are named"), "{twice}");
    let none = refused(&["evaluate"]);
    assert!(none.contains("--constellation FILE"), "{none}");
    let missing = refused(&["evaluate", "--designs", "none.csv"]);
    assert!(missing.contains("cannot read none.csv"), "{missing}");
}

/// The shells start at the same node, 0.005° apart in phase.
#[test]
fn satellites_that_meet_are_named_with_the_time() {
    let directory = TempDir::new().unwrap();
    let warned = |design: &str| evaluate(directory.path(), &["--design", design]).stderr;
    let text = warned("delta:53:20/5/1@1000+star:90:8/2/1@1000,u=0.005");
    let told = "NW-A-P01-S01 and NW-B-P01-S01 are 0.644 km apart at 2025-01-01T00:00:00Z";
    assert!(text.contains(told), "{text}");
    let apart = warned("delta:53:20/5/1@1000+star:90:8/2/1@1100,u=0.005");
    assert!(!apart.contains("warning"), "{apart}");
}

/// A run of given designs is taken wherever a run is, by name and by index, and is replaced like one.
#[test]
fn given_designs_make_a_run() {
    let directory = with_file();
    let place = directory.path();
    let designs = &THREE[..4];
    let out = ["--out", "run", "--quiet"];
    let first = evaluate(place, &[designs, &out].concat());
    assert_eq!((first.status, first.stderr.as_str()), (0, ""));
    let mut files: Vec<_> = fs::read_dir(place.join("run"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(
        files,
        [
            "front.csv",
            "front.json",
            "provenance.json",
            "run.json",
            "scenario.toml"
        ]
    );
    let front = fs::read_to_string(place.join("run/front.json")).unwrap();
    let front: Value = serde_json::from_str(&front).unwrap();
    let members = front["front"].as_array().unwrap();
    assert_eq!(
        (&members[1]["name"], &members[1]["index"]),
        (&"hybrid".into(), &2.into())
    );
    let compared = json(place, designs);
    for (member, entry) in members
        .iter()
        .zip(compared["constellations"].as_array().unwrap())
    {
        assert_eq!(member["metrics"], entry["metrics"]);
        assert_eq!(member["objectives"]["j-cost"], entry["metrics"]["j_cost"]);
    }
    let done = |line: &str| {
        let ran = ran(place, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(ran.status, 0, "{line}: {}", ran.stderr);
        ran
    };
    let exported = done("export --run run --pick hybrid --as tle --out by-name");
    assert!(exported.stdout.starts_with(HYBRID), "{}", exported.stdout);
    done("export --run run --pick 2 --as tle --out by-index");
    let tle = |out: &str| fs::read_to_string(place.join(out).join("constellation.tle")).unwrap();
    assert_eq!(tle("by-name"), tle("by-index"));
    done("validate --run run --pick 1 --against geographiclib");
    done("plot run --figure pareto --out pareto.svg");
    done("plot run --figure map --pick hybrid --out map.svg");
    let report = done("report run");
    // Satellites of the hybrid meet, which `evaluate` has said; nothing else is amiss.
    assert_eq!(report.stderr, "");
    let beside = done("plot run --figure cdf --design delta:90:8/2/0@800 --out beside.svg");
    assert_eq!(
        beside.stderr.matches("come within").count(),
        1,
        "{}",
        beside.stderr
    );
    let unknown = ran(
        place,
        &[
            "export", "--run", "run", "--pick", "polar", "--as", "tle", "--out", "x",
        ],
    );
    assert_eq!(unknown.status, 2);
    assert!(unknown.stderr.contains("hybrid"), "{}", unknown.stderr);

    // The same designs replace it, keeping what was added; others only with --force.
    assert_eq!(evaluate(place, &[designs, &out].concat()).status, 0);
    assert!(place.join("run/report.html").exists());
    let other = evaluate(place, &[&designs[..2], &out].concat());
    assert_eq!((other.status, other.stdout.as_str()), (2, ""));
    assert!(
        other.stderr.contains("a run of other constellations"),
        "{}",
        other.stderr
    );
    let forced = evaluate(place, &[&designs[..2], &out, &["--force"]].concat());
    assert_eq!(forced.status, 0, "{}", forced.stderr);
}

/// A run of given designs and a search of the same scenario do not replace each other.
#[test]
fn a_search_is_not_replaced_by_given_designs() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let search = [
        &["optimize", "--quiet", "--out", "run"],
        &SMALL[..],
        &[
            "--set",
            "optimizer.population=8",
            "--set",
            "optimizer.generations=2",
        ],
    ];
    assert_eq!(ran(place, &search.concat()).status, 0);
    let given = [
        "--out",
        "run",
        "--design",
        FIRST,
        "--set",
        "optimizer.population=8",
        "--set",
        "optimizer.generations=2",
    ];
    let stopped = evaluate(place, &given);
    assert_eq!(stopped.status, 2);
    assert!(
        stopped.stderr.contains("run holds a search"),
        "{}",
        stopped.stderr
    );
    assert!(place.join("run/history.json").exists());
}

//! Runs of constellations that were given, with satellites from files.

use crate::cli::{Ran, ran};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const FLEET: &str = "delta:55:24/6/1@925";

/// A directory with a scenario that names a pure and a mixed constellation, and files of satellites.
fn with_study() -> TempDir {
    let directory = TempDir::new().unwrap();
    let text = "name = \"st\"\n[region]\nlatitude-deg = [20, 50]\nlongitude-deg = [80, 120]\nstep-deg = 10\n[time]\nstep-s = 3600\n[constellations]\n\
        polar = \"star:90:12/3/1@900\"\n\
        mixed = { design = \"delta:40:6/2/1@800\", files = [\"fleet/constellation.tle\"], only = [\"NW-P02-*\"] }\n";
    fs::write(directory.path().join("st.toml"), text).unwrap();
    let line = format!("export --quiet --as tle --out fleet --design {FLEET}");
    done(directory.path(), &line);
    directory
}

fn run(place: &Path, line: &str) -> Ran {
    ran(place, &line.split(' ').collect::<Vec<_>>())
}

#[track_caller]
fn done(place: &Path, line: &str) -> Ran {
    let ran = run(place, line);
    assert_eq!(ran.status, 0, "{line}: {}", ran.stderr);
    ran
}

#[track_caller]
fn stopped(place: &Path, line: &str, told: &str) {
    let ran = run(place, line);
    assert_eq!(
        (ran.status, ran.stdout.as_str()),
        (2, ""),
        "{line}: {}",
        ran.stderr
    );
    assert!(ran.stderr.contains(told), "{line}: {}", ran.stderr);
}

/// A run of a design, a mixed constellation, a file, and a directory of which satellites are selected.
fn with_run() -> TempDir {
    let directory = with_study();
    let line = "evaluate st.toml --quiet --out run --design mixed --design pure=delta:55:24/6/1@925 \
        --constellation fleet/constellation.tle --constellation part=fleet --exclude NW-P01-*";
    done(directory.path(), line);
    directory
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

#[test]
fn a_run_of_files_needs_none_of_them() {
    let directory = with_run();
    let place = directory.path();
    let table = done(
        place,
        "evaluate st.toml --quiet --format json --design mixed --design pure=delta:55:24/6/1@925 \
         --constellation fleet/constellation.tle --constellation part=fleet --exclude NW-P01-*",
    );
    let table: Value = serde_json::from_str(&table.stdout).unwrap();
    let front = json(&place.join("run/front.json"));
    let members = front["front"].as_array().unwrap();
    for (member, entry) in members
        .iter()
        .zip(table["constellations"].as_array().unwrap())
    {
        assert_eq!(member["metrics"], entry["metrics"]);
        assert_eq!(member["name"], entry["name"]);
    }
    assert_eq!(members[3]["files"]["names"][0], "fleet");
    assert_eq!(members[3]["files"]["satellites"], 20);
    assert!(members[3]["design"].is_null() && members[1].get("files").is_none());
    fs::remove_dir_all(place.join("fleet")).unwrap();
    fs::remove_file(place.join("st.toml")).unwrap();

    let report = done(place, "report run --quiet");
    assert_eq!(report.stderr, "");
    let page = fs::read_to_string(place.join("run/report.html")).unwrap();
    for name in ["mixed", "pure", "constellation.tle", "part"] {
        assert!(page.contains(&format!("<bdi>{name}</bdi>")), "{name}");
    }
    assert!(page.contains("<small><bdi>fleet</bdi></small>"));
    let drawn = done(place, "plot run --figure pareto --as csv --quiet").stdout;
    assert_eq!(drawn.lines().count(), 5, "{drawn}");
    let series = done(place, "plot run --figure series --as csv --quiet").stdout;
    assert!(series.contains(",part\n"), "{series}");
    done(
        place,
        "plot run --figure map --pick part --out map.svg --quiet",
    );
    stopped(
        place,
        "plot run --figure map --quiet",
        "choose one with --pick, by its number or its name: mixed, pure, ",
    );

    let exported = done(
        place,
        "export --run run --pick part --as tle --out part --quiet",
    );
    assert!(
        exported
            .stdout
            .starts_with("part: 20 satellites from fleet"),
        "{}",
        exported.stdout
    );
    done(
        place,
        "export --run run --pick 3 --as tle --out third --check --quiet",
    );
    let tle = |out: &str| fs::read_to_string(place.join(out).join("constellation.tle")).unwrap();
    assert_eq!(
        (
            tle("part").matches("\n1 ").count(),
            tle("third").matches("\n1 ").count()
        ),
        (20, 20)
    );
    done(
        place,
        "validate --run run --pick mixed --against geographiclib --quiet",
    );
    done(
        place,
        "validate --run run --pick part --against ./part --quiet",
    );
    stopped(
        place,
        "validate --run run --pick part --against sgp4 --quiet",
        "sgp4 checks the propagation of a design",
    );
    stopped(
        place,
        "optimize --out run --resume",
        "run holds constellations evaluated as given, without a search",
    );
    stopped(
        place,
        "export --run run --pick fleet --as tle --out x",
        "or a name: mixed, pure, constellation.tle, part",
    );

    // What was evaluated can be evaluated again from the run.
    let again = done(place, "evaluate run/scenario.toml --quiet --format json");
    let again: Value = serde_json::from_str(&again.stdout).unwrap();
    let again = again["constellations"].as_array().unwrap();
    let metrics = |name: &str| {
        let mut found = again.iter().filter(|one| one["name"] == name);
        found.next().unwrap()["metrics"].clone()
    };
    assert_eq!(metrics("mixed"), members[0]["metrics"]);
    assert_eq!(metrics("constellation_tle"), members[2]["metrics"]);
    assert_eq!(metrics("part"), members[3]["metrics"]);
}

/// A table says of satellites outside shells only how many there are.
#[test]
fn a_table_has_no_planes_of_satellites_outside_shells() {
    let directory = with_run();
    let place = directory.path();
    let front = fs::read_to_string(place.join("run/front.csv")).unwrap();
    let evaluated = done(
        place,
        "evaluate st.toml --quiet --format csv --design mixed --design pure=delta:55:24/6/1@925 \
         --constellation fleet/constellation.tle --exclude NW-P01-*",
    );
    for table in [front, evaluated.stdout] {
        let mut reader = csv::Reader::from_reader(table.as_bytes());
        let header = reader.headers().unwrap().clone();
        let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
        let cell = |name: &str, column: &str| {
            let at = |wanted: &str| header.iter().position(|one| one == wanted).unwrap();
            let row = rows.iter().find(|row| &row[at("name")] == name).unwrap();
            row[at(column)].to_owned()
        };
        for column in [
            "pattern",
            "planes",
            "satellites_per_plane",
            "inclination_deg",
            "node_step_deg",
        ] {
            assert_eq!(cell("mixed", column), "", "{column}");
            assert_eq!(cell("constellation.tle", column), "", "{column}");
            assert_ne!(cell("pure", column), "", "{column}");
        }
        assert_eq!(cell("mixed", "notation"), "delta:40:6/2/1@800");
        assert_eq!(cell("mixed", "satellites"), "10");
        assert_eq!(cell("constellation.tle", "satellites"), "20");
        assert_eq!(cell("mixed", "files"), "constellation.tle");
    }
}

#[test]
fn a_changed_copy_is_noticed_by_every_command() {
    let directory = with_run();
    let place = directory.path();
    let copies = json(&place.join("run/run.json"));
    let copies = copies["inputs"].as_array().unwrap();
    let paths: Vec<PathBuf> = copies
        .iter()
        .map(|copy| place.join("run").join(copy["path"].as_str().unwrap()))
        .collect();
    assert_eq!(paths.len(), 3);
    let bytes = fs::read(&paths[2]).unwrap();
    fs::write(&paths[2], [bytes.as_slice(), b"\n"].concat()).unwrap();
    for line in [
        "report run",
        "plot run --figure pareto",
        "export --run run --pick pure --as tle --out x",
        "validate --run run --pick pure --against geographiclib",
    ] {
        stopped(
            place,
            line,
            "checksum mismatch: the file has changed since the run was made",
        );
    }
    assert!(!place.join("x").exists() && !place.join("run/report.html").exists());
}

/// The same files replace their run, other contents or another selection only with --force.
#[test]
fn a_run_of_other_files_is_another_run() {
    let directory = with_run();
    let place = directory.path();
    let line = "evaluate st.toml --quiet --out one --constellation fleet/constellation.tle";
    done(place, line);
    done(place, line);
    let other = "one holds a run of other constellations";
    stopped(place, &format!("{line} --only NW-P01-*"), other);
    let tle = place.join("fleet/constellation.tle");
    let text = fs::read_to_string(&tle).unwrap();
    let fewer: Vec<&str> = text.lines().take(6).collect();
    fs::write(&tle, fewer.join("\n") + "\n").unwrap();
    stopped(place, line, other);
    done(place, &format!("{line} --force"));
}

/// What cannot be written is said before the work, and nothing is left of what fails after it.
#[test]
fn the_place_of_a_run_is_tried_before_the_work() {
    let directory = with_study();
    let place = directory.path();
    fs::write(place.join("file"), "mine").unwrap();
    let ran = run(place, "evaluate st.toml --out file --design mixed");
    assert_eq!(ran.status, 2);
    assert!(
        ran.stderr.contains("a directory is needed"),
        "{}",
        ran.stderr
    );
    // The satellites of the design meet, which is found while working.
    assert!(!ran.stderr.contains("warning"), "{}", ran.stderr);
    let met = run(place, "evaluate st.toml --design mixed");
    assert!(met.stderr.contains("warning"), "{}", met.stderr);
    stopped(
        place,
        "evaluate st.toml --out fleet/run --constellation fleet",
        "is inside the input fleet",
    );

    let line = "evaluate st.toml --out made/run --design pure=delta:55:2/1/0@925 --set gnss.constellations=[]";
    stopped(place, line, "has no value of the objective");
    assert!(!place.join("made").exists());
}

/// A list takes the names of the scenario, with files, and tells a bad line.
#[test]
fn a_list_names_constellations_of_the_scenario() {
    let directory = with_study();
    let place = directory.path();
    let list =
        "name,design\na,polar\n,mixed\ngnss-only,polar\nb,polar+delta:55:4/2/1@900\nc,mixde\n";
    fs::write(place.join("list.csv"), list).unwrap();
    let ran = run(
        place,
        "evaluate st.toml --designs list.csv --format csv --quiet",
    );
    assert_eq!(ran.status, 1);
    let rows: Vec<Vec<&str>> = ran
        .stdout
        .lines()
        .map(|line| line.split(',').collect())
        .collect();
    let told: Vec<[&str; 3]> = rows.iter().map(|row| [row[0], row[1], row[5]]).collect();
    assert_eq!(
        told,
        [
            ["name", "notation", "satellites"],
            ["a", "star:90:12/3/1@900", "12"],
            ["mixed", "delta:40:6/2/1@800", "10"],
            ["b", "star:90:12/3/1@900+delta:55:4/2/1@900", "16"],
            ["gnss-only", "", "0"],
        ]
    );
    assert!(
        ran.stderr
            .contains("list.csv:4: the name gnss-only is that of the GNSS alone"),
        "{}",
        ran.stderr
    );
    assert!(ran.stderr.contains("list.csv:6: mixde: "), "{}", ran.stderr);
    assert!(
        ran.stderr.contains("did you mean 'mixed'?"),
        "{}",
        ran.stderr
    );
}

/// Whatever a name in a list holds, the JSON is JSON, has it escaped, and gives it back.
#[test]
fn json_of_a_list_survives_controls_in_names() {
    let directory = with_study();
    let place = directory.path();
    let name = "a\u{1b}[31m\u{8}\u{202e}\"\\b";
    let cell = name.replace('"', "\"\"");
    fs::write(
        place.join("list.csv"),
        format!("name,design\n\"{cell}\",polar\n"),
    )
    .unwrap();
    let ran = done(
        place,
        "evaluate st.toml --designs list.csv --format json --quiet",
    );
    assert!(
        ran.stdout.chars().all(|c| c == '\n' || !c.is_control()),
        "{:?}",
        ran.stdout
    );
    let found: Value = serde_json::from_str(&ran.stdout).unwrap();
    assert_eq!(found["constellations"][0]["name"], name);
}

#[test]
fn a_proposed_command_repeats_what_was_set() {
    let directory = with_study();
    let place = directory.path();
    let line = "evaluate st.toml --set visibility.mask-deg=10 --set gnss.constellations=['gps'] --design polar";
    let hint = done(place, line).stderr;
    let next = "next: navwalker validate st.toml --set visibility.mask-deg=10 \
        --set 'gnss.constellations=['\\''gps'\\'']' --design star:90:12/3/1@900 --against sgp4";
    assert!(hint.contains(next), "{hint}");
}

//! Searches among several shells, and beside what is fixed, on the command line.

use crate::cli::ran;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const TWO: &str = "name = \"two\"
[time]
duration-h = 3
step-s = 1800
[region]
step-deg = 25
[objectives]
minimize = [\"satellites\", \"mean-pdop\"]
[optimizer]
population = 8
generations = 4
[[search.shells]]
pattern = [\"delta\", \"star\"]
planes = [2, 3]
satellites-per-plane = [2, 3]
inclination-deg = [40, 50]
inclination-step-deg = 10
altitude-km = 1000
[[search.shells]]
planes = 2
satellites-per-plane = [0, 2]
inclination-deg = 88
altitude-km = 900
";

fn place(scenario: &str) -> TempDir {
    let directory = TempDir::new().unwrap();
    fs::write(directory.path().join("two.toml"), scenario).unwrap();
    directory
}

/// What a search prints as JSON.
fn searched(place: &Path, further: &[&str]) -> Value {
    searched_into(place, "run", further)
}

/// The same into a directory.
fn searched_into(place: &Path, run: &str, further: &[&str]) -> Value {
    let arguments = [
        "optimize", "two.toml", "--quiet", "--format", "json", "--out", run,
    ];
    let ran = ran(place, &[&arguments, further].concat());
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    serde_json::from_str(&ran.stdout).unwrap()
}

fn front(result: &Value) -> &[Value] {
    result["front"].as_array().unwrap()
}

#[test]
fn every_algorithm_searches_among_hybrids() {
    let directory = place(TWO);
    for algorithm in ["nsga2", "mopso", "random", "exhaustive"] {
        let set = format!("optimizer.algorithm={algorithm}");
        let found = searched(directory.path(), &["--force", "--set", &set]);
        for member in front(&found) {
            let shells = member["shells"].as_array().unwrap();
            assert_eq!(shells.len(), 2, "{algorithm}");
            let counts = shells
                .iter()
                .map(|shell| shell["satellites"].as_u64().unwrap_or(0));
            assert_eq!(Some(counts.sum()), member["design"]["satellites"].as_u64());
        }
        if algorithm == "exhaustive" {
            // Two patterns, two inclinations, 2 by 2 counts, and three sizes of the second shell.
            assert_eq!(found["evaluations"], 2 * 2 * 4 * 3);
        }
    }
    let table = fs::read_to_string(directory.path().join("run/front.csv")).unwrap();
    let header = table.lines().next().unwrap();
    assert!(
        header.contains(",a_pattern,a_planes,") && header.contains(",b_altitude_km,"),
        "{header}"
    );
    // Each shell in its own columns.
    for line in table.lines().skip(1) {
        let cell = |name: &str| {
            let place = header.split(',').position(|column| column == name);
            line.split(',').nth(place.unwrap()).unwrap()
        };
        assert_eq!(cell("a_altitude_km"), "1000", "{line}");
        assert!(["", "900"].contains(&cell("b_altitude_km")), "{line}");
        assert_eq!(
            cell("b_planes").is_empty(),
            cell("b_altitude_km").is_empty()
        );
    }
}

#[test]
fn a_search_among_hybrids_resumes_and_is_certified() {
    let directory = place(TWO);
    let at_once = searched(directory.path(), &[]);
    fs::remove_dir_all(directory.path().join("run")).unwrap();
    searched(directory.path(), &["--set", "optimizer.generations=2"]);
    assert_eq!(searched(directory.path(), &["--resume"]), at_once);
    let seeds = searched_into(directory.path(), "seeds", &["--certify", "--seeds", "2"]);
    assert_eq!(seeds["seeds"].as_array().unwrap().len(), 2);
}

#[test]
fn equal_shells_are_warned_of() {
    let directory = place(TWO);
    let equal = "search.shells=[{planes=[2,3]},{planes=4},{planes=[2,3]}]";
    let arguments = [
        "optimize",
        "two.toml",
        "--out",
        "run",
        "--set",
        equal,
        "--set",
        "optimizer.generations=1",
    ];
    let ran = ran(directory.path(), &arguments);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let told = "shells A and C of the search have the same intervals";
    assert!(ran.stderr.contains(told), "{}", ran.stderr);
}

/// Satellites of a file that are fixed: copied into the run, in every metric, and exported with a pick.
#[test]
fn a_search_adds_to_satellites_of_a_file() {
    let directory = place(TWO);
    let place = directory.path();
    let export: Vec<&str> = "export --quiet --as tle --out fixed --set export.name-prefix=OLD --design star:86.4:12/3/1@780"
        .split(' ')
        .collect();
    assert_eq!(ran(place, &export).status, 0);
    let given = [
        "--set",
        "constellations.old.files=['fixed/constellation.tle']",
        "--set",
        "search.fixed=old",
        "--set",
        "objectives.minimize=['new-satellites','mean-pdop']",
        "--set",
        "objectives.constraints=['satellites >= 12']",
    ];
    let found = searched(place, &given);
    assert_eq!(found["fixed"]["from_files"], 12);
    for member in front(&found) {
        let own = member["design"]["satellites"].as_f64().unwrap();
        assert_eq!(member["objectives"]["new-satellites"].as_f64(), Some(own));
        assert_eq!(
            member["constraints"]["satellites"].as_f64(),
            Some(own + 12.0)
        );
    }
    let alone = searched_into(place, "alone", &[]);
    assert!(alone.get("fixed").is_none());
    // The run needs the original no more.
    fs::remove_dir_all(place.join("fixed")).unwrap();
    let export: Vec<&str> = "export --quiet --run run --pick 1 --as tle --out files"
        .split(' ')
        .collect();
    let exported = ran(place, &export);
    assert_eq!(exported.status, 0, "{}", exported.stderr);
    let written = fs::read_to_string(place.join("files/constellation.tle")).unwrap();
    let names = |prefix: &str| {
        written
            .lines()
            .filter(|line| line.starts_with(prefix))
            .count()
    };
    assert_eq!(names("OLD-"), 12, "{written}");
    assert_eq!(
        names("NW-") as u64,
        front(&found)[0]["design"]["satellites"].as_u64().unwrap()
    );
    let report = ran(place, &["report", "run"]);
    assert_eq!(report.status, 0, "{}", report.stderr);
    // The maps are those of all satellites.
    let page = fs::read_to_string(place.join("run/report.html")).unwrap();
    assert!(
        page.contains("\"fixed_tracks\":{"),
        "the globe lacks what is fixed"
    );
}

/// A place with twelve satellites in a file, which the arguments name `old` and fix.
fn with_old_satellites(scenario: &str) -> (TempDir, [&'static str; 4]) {
    let directory = place(scenario);
    let export: Vec<&str> = "export --quiet --as tle --out fixed --set export.name-prefix=OLD --design star:86.4:12/3/1@780"
        .split(' ')
        .collect();
    assert_eq!(ran(directory.path(), &export).status, 0);
    let given = [
        "--set",
        "constellations.old.files=['fixed/constellation.tle']",
        "--set",
        "search.fixed=old",
    ];
    (directory, given)
}

/// Where every shell may be empty, the satellites of a file alone are on the front, and all commands take that
/// member.
#[test]
fn a_search_may_add_nothing_to_files() {
    let (directory, given) = with_old_satellites(TWO);
    let place = directory.path();
    let further = [
        "--set",
        "search.shells=[{planes=2,satellites-per-plane=[0,3],inclination-deg=50,altitude-km=1000}]",
        "--set",
        "objectives.minimize=['new-satellites','mean-pdop']",
        "--set",
        "objectives.constraints=['planes >= 0', 'launch-cost >= 0']",
        "--set",
        "optimizer.algorithm=exhaustive",
    ];
    let found = searched(place, &[&given[..], &further].concat());
    let first = &front(&found)[0];
    assert_eq!(first["design"], Value::Null);
    assert_eq!(first["objectives"]["new-satellites"], 0.0);
    assert_eq!(first["constraints"]["planes"], 0.0);
    assert_eq!(first["constraints"]["launch-cost"], 0.0);
    let table = fs::read_to_string(place.join("run/front.csv")).unwrap();
    assert!(
        table.lines().nth(1).unwrap().starts_with("1,,,,,0,"),
        "{table}"
    );
    // The same numbers as of the file by itself, which has nothing new either.
    let arguments = [
        &[
            "evaluate", "two.toml", "--quiet", "--format", "json", "--design", "old",
        ][..],
        &given,
        &further,
    ];
    let alone = ran(place, &arguments.concat());
    assert_eq!(alone.status, 0, "{}", alone.stderr);
    let alone: Value = serde_json::from_str(&alone.stdout).unwrap();
    let pdop = |of: &Value| of["metrics"]["mean_pdop"].as_f64().unwrap();
    // Two ways to the same positions.
    assert!((pdop(first) - pdop(&alone)).abs() < 1e-9);
    assert_eq!(alone["constraints"][0]["value"], 0.0);
    let export: Vec<&str> = "export --quiet --run run --pick 1 --as tle --out files"
        .split(' ')
        .collect();
    let exported = ran(place, &export);
    assert_eq!(exported.status, 0, "{}", exported.stderr);
    let written = fs::read_to_string(place.join("files/constellation.tle")).unwrap();
    assert_eq!(
        written
            .lines()
            .filter(|line| line.starts_with("1 "))
            .count(),
        12
    );
    for command in ["report run", "plot run --figure map --pick 1 --out map.svg"] {
        let arguments: Vec<&str> = command.split(' ').collect();
        let ran = ran(place, &arguments);
        assert_eq!(ran.status, 0, "{command}: {}", ran.stderr);
    }
    let text = ran(
        place,
        &[
            &["optimize", "two.toml", "--out", "again"][..],
            &given,
            &further,
        ]
        .concat(),
    );
    assert!(text.stdout.contains("nothing added"), "{}", text.stdout);
    assert!(
        text.stderr.contains("sweep of 4 designs, expected time "),
        "{}",
        text.stderr
    );
}

/// What is compared with a front is as it is by itself, and has nothing new where it is what is fixed.
#[test]
fn what_is_compared_keeps_its_own_numbers() {
    let (directory, given) = with_old_satellites(TWO);
    let place = directory.path();
    let both =
        "constellations.both={design='delta:50:4/2/1@1000',files=['fixed/constellation.tle']}";
    let further = [
        "--set",
        both,
        "--set",
        "objectives.minimize=['new-satellites','mean-pdop']",
    ];
    let study = [&given[..], &further].concat();
    searched(place, &study);
    let report = ran(place, &["report", "run"]);
    assert_eq!(report.status, 0, "{}", report.stderr);
    let told = "compared as given, without the satellites of constellation.tle that every design of the search has: \
                reference design; to compare";
    assert!(report.stderr.contains(told), "{}", report.stderr);
    let evaluated = [
        &["evaluate", "two.toml", "--quiet", "--format", "csv"][..],
        &study,
    ]
    .concat();
    let evaluated = ran(place, &evaluated);
    assert_eq!(evaluated.status, 0, "{}", evaluated.stderr);
    let table = ran(
        place,
        &[&["evaluate", "two.toml", "--quiet"][..], &study].concat(),
    );
    let row = |name: &str| {
        let line = table.stdout.lines().find(|line| line.starts_with(name));
        line.unwrap_or_default().to_owned()
    };
    // Three columns of gain follow.
    let new_satellites = |name: &str| row(name).split_whitespace().nth_back(3).map(str::to_owned);
    assert_eq!(
        new_satellites("old").as_deref(),
        Some("0"),
        "{}",
        table.stdout
    );
    assert_eq!(
        new_satellites("both").as_deref(),
        Some("4"),
        "{}",
        table.stdout
    );
}

#[test]
fn one_shell_of_a_file_is_set_by_its_number() {
    let directory = place(TWO);
    let set = [
        "--set",
        "search.shells.1.planes=3",
        "--set",
        "search.shells.2.altitude-km=1200",
    ];
    let found = searched(directory.path(), &set);
    for member in front(&found) {
        assert_eq!(member["shells"][0]["planes"], 3);
        let polar = &member["shells"][1]["altitude_km"];
        assert!(polar.is_null() || *polar == 1200.0, "{member}");
    }
    let wrong = ran(
        directory.path(),
        &[
            "optimize",
            "two.toml",
            "--out",
            "wrong",
            "--set",
            "search.shells.3.planes=3",
        ],
    );
    assert_eq!(wrong.status, 2);
    assert!(
        wrong
            .stderr
            .contains("there is no table 3, expected a number from 1 to 2"),
        "{}",
        wrong.stderr
    );
}

/// Two equal shells that are fixed are one place for each of their satellites.
#[test]
fn equal_fixed_shells_are_warned_of() {
    let directory = place(TWO);
    let shell = "star:86.4:12/3/1@780";
    let arguments = [
        "optimize",
        "two.toml",
        "--out",
        "run",
        "--set",
        &format!("search.fixed={shell}+{shell}"),
        "--set",
        "optimizer.generations=1",
    ];
    let ran = ran(directory.path(), &arguments);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(
        ran.stderr.contains("24 satellites are in 12 places"),
        "{}",
        ran.stderr
    );
}

/// A design that is fixed is in each notation, and a search may add nothing to it.
#[test]
fn a_search_adds_to_a_design() {
    let directory = place(TWO);
    let fixed = "star:86.4:12/3/1@780";
    let given = [
        "--set",
        &format!("search.fixed={fixed}"),
        "--set",
        "search.shells=[{planes=2,satellites-per-plane=[0,1],inclination-deg=50,altitude-km=1000}]",
        "--set",
        "objectives.minimize=['new-planes','mean-pdop']",
        "--set",
        "optimizer.algorithm=exhaustive",
    ];
    let found = searched(directory.path(), &given);
    let notations: Vec<&str> = front(&found)
        .iter()
        .map(|member| member["design"]["notation"].as_str().unwrap())
        .collect();
    assert_eq!(notations, [fixed, &format!("delta:50:2/2/1@1000+{fixed}")]);
    assert_eq!(front(&found)[0]["objectives"]["new-planes"], 0.0);
    assert_eq!(front(&found)[1]["objectives"]["new-planes"], 2.0);
    assert_eq!(found["fixed"]["in_design"], 12);
}

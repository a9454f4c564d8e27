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
    assert!(number("grid_hypervolume") > number("found_hypervolume"));
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

/// Without a reference, and with one that nothing dominates: front, history, seeds, certificate and a
/// resumed search measure at the point that the search chose.
#[test]
fn a_search_chooses_its_reference_and_keeps_it() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let minimize = "objectives.minimize=[\"mean-visible\", \"satellites\", \"launch-cost\"]";
    let json = |further: &[&str]| -> Value {
        let common = ["--force", "--format", "json", "--set", minimize];
        let ran = ran(place, &optimize(&[&common[..], further].concat()));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        serde_json::from_str(&ran.stdout).unwrap()
    };
    let last = |run: &str| -> Value {
        let text = fs::read(place.join(run).join("history.json")).unwrap();
        let history: Vec<Value> = serde_json::from_slice(&text).unwrap();
        history.last().unwrap().clone()
    };

    let free = json(&["--out", "free"]);
    let (volume, at) = (
        &free["hypervolume"]["value"],
        &free["hypervolume"]["reference"],
    );
    assert!(volume.as_f64().unwrap() > 0.0);
    assert_eq!(free["hypervolume"]["chosen"], true);
    assert_eq!(&last("free")["hypervolume"], volume);

    let written = "objectives.hypervolume-reference=[1e6, 1, 1]";
    let useless = json(&["--out", "useless", "--set", written]);
    let told = &useless["hypervolume"];
    assert!(told["value"].is_null() && told["reference"][1] == 1.0);
    assert_eq!(
        (&told["at_chosen"]["value"], &told["at_chosen"]["reference"]),
        (volume, at)
    );
    assert_eq!(&last("useless")["hypervolume_at_chosen"], volume);
    assert!(codes(&useless).contains(&"reference-not-dominated"));

    // Seven generations at once, and as many after a stop.
    let seven = ["--set", "optimizer.generations=7"];
    let longer = json(&[&["--out", "longer"], &seven[..]].concat());
    let resumed = json(&[&["--out", "free", "--resume"], &seven[..]].concat());
    assert_eq!(longer["hypervolume"], resumed["hypervolume"]);
    assert_eq!(&longer["hypervolume"]["reference"], at);

    let steps = [
        "search.altitude-step-km=300",
        "search.inclination-step-deg=5",
    ];
    let seeds = json(&[
        "--out",
        "seeds",
        "--seeds",
        "2",
        "--certify",
        "--set",
        steps[0],
        "--set",
        steps[1],
    ]);
    let certificate = &seeds["certificate"];
    assert_eq!(
        seeds["hypervolume"]["value"],
        seeds["seeds"][0]["hypervolume"]
    );
    assert_eq!(
        seeds["hypervolume"]["value"],
        certificate["found_hypervolume"]
    );
    assert!(certificate["grid_hypervolume"].as_f64().unwrap() > 0.0);
    assert!(seeds["hypervolume_spread"]["mean"].is_number());
    let joint = seeds["joint_front"].as_array().unwrap();
    assert!(joint.iter().any(|member| member["seed"] == 2), "{joint:?}");
    let table = fs::read_to_string(place.join("seeds/joint-front.csv")).unwrap();
    assert_eq!(table.lines().count(), joint.len() + 1);
    assert!(
        table.lines().next().unwrap().contains(",launch_cost,"),
        "{table}"
    );
}

/// Beside objectives that do not show it, a quantity under a constraint is in every output.
#[test]
fn a_constrained_quantity_is_in_every_output() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let sets = [
        "--set",
        "objectives.minimize=[\"satellites\"]",
        "--set",
        "objectives.constraints=[\"launch-cost <= 400\", \"mean-visible >= 0.1\"]",
    ];
    let output = |format: &str| {
        let further = [&["--force", "--out", "run", "--format", format], &sets[..]].concat();
        let ran = ran(place, &optimize(&further));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        ran.stdout
    };
    let value: Value = serde_json::from_str(&output("json")).unwrap();
    let costs = &value["front"][0]["constraints"];
    assert!(costs["launch-cost"].as_f64().unwrap() <= 400.0);
    assert!(costs["mean-visible"].as_f64().unwrap() >= 0.1);
    assert!(output("text").contains("J_cost  launch-cost  membership"));
    assert!(output("csv").contains("launch_cost"));
    let evaluate = |format: &str| {
        let mut arguments = vec![
            "evaluate",
            "--design",
            "delta:55:182/13/1@925",
            "--format",
            format,
        ];
        arguments.extend(["--set", "time.step-s=7200", "--set", "region.step-deg=20"]);
        arguments.extend(sets);
        ran(place, &arguments).stdout
    };
    let csv = evaluate("csv");
    // 182 (1 + 0.2 0.925) + 5 13.
    assert!(
        csv.contains(",launch_cost") && csv.contains(",280.67"),
        "{csv}"
    );
    let value: Value = serde_json::from_str(&evaluate("json")).unwrap();
    assert_eq!(value["constraints"][1]["constraint"], "mean-visible >= 0.1");
    assert_eq!(value["constraints"][1]["met"], true);
    let text = evaluate("text");
    let line = text
        .lines()
        .find(|line| line.starts_with("launch-cost <= 400"));
    assert!(
        line.is_some_and(|line| line.ends_with("280.67  met")),
        "{text}"
    );
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
        "least-visible",
        "mean-total-visible",
        "coverage-4",
        "coverage-total-8",
        "longest-outage-s",
        "p95-hdop",
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
    let value = &value["studies"][0];
    assert_eq!(value["name"], "paper");
    assert_eq!(value["tables"][0]["rows"].as_array().unwrap().len(), 11);
    let verdicts = [
        "met",
        "met-under-assumption",
        "fitted",
        "input",
        "not-met",
        "unconfirmed",
    ];
    for line in value["statements"].as_array().unwrap() {
        assert!(
            verdicts.contains(&line["verdict"].as_str().unwrap()),
            "{line}"
        );
    }
    let read =
        |name: &str| fs::read_to_string(place.join("runs/reproduce/paper").join(name)).unwrap();
    for (name, rows) in [
        ("table2.csv", 11),
        ("figure-3a.csv", 4 * 24),
        ("figure-3b.csv", 4 * 24),
        ("figure-4a.csv", 3 * 24),
        ("figure-4b.csv", 3 * 24),
    ] {
        assert_eq!(read(name).lines().count(), rows + 1, "{name}");
    }
    assert!(read("report.md").contains("\n## Table II\n"));
    assert_eq!(read("statements.csv").lines().count(), 49 + 1);
    let page = read("report.html");
    for figure in [
        "deviations-paper",
        "figure-2",
        "figure-3a",
        "figure-3b",
        "figure-4a",
        "figure-4b",
    ] {
        let drawn = read(&format!("{figure}.svg"));
        assert!(drawn.starts_with("<svg"), "{figure}");
        assert!(page.contains(&without_typeface(&drawn)), "{figure}");
        let pdf = fs::read(place.join(format!("runs/reproduce/paper/{figure}.pdf"))).unwrap();
        assert!(pdf.starts_with(b"%PDF"), "{figure}");
        let dots = fs::read(place.join(format!("runs/reproduce/paper/{figure}.png"))).unwrap();
        assert!(dots.starts_with(b"\x89PNG"), "{figure}");
    }
    // The same again replaces it with the same bytes; another study needs --force.
    let before = read("report.json");
    assert_eq!(with(&["--threads", "2"]).status, 0);
    assert!(read("report.json") == before);
    let other = with(&["--set", "visibility.mask-deg=10"]);
    assert_eq!(other.status, 2);
    assert!(other.stderr.contains("--force"), "{}", other.stderr);
    // What was put beside it stays: the same study keeps it, and another one says that it is in the way.
    let notes = place.join("runs/reproduce/paper/notes.txt");
    fs::write(&notes, "mine").unwrap();
    assert_eq!(with(&[]).status, 0);
    let other = with(&["--set", "visibility.mask-deg=10", "--force"]);
    assert_eq!(other.status, 2);
    let message = "did not write, and --force would delete them: notes.txt;";
    assert!(other.stderr.contains(message), "{}", other.stderr);
    assert_eq!(fs::read_to_string(&notes).unwrap(), "mine");
    assert!(read("report.json") == before);
}

/// A study of one's own beside a built-in one: what is not met and not explained is status 1.
#[test]
fn published_numbers_are_judged() {
    const MINE: &str = "name = \"mine\"
title = \"An example\"
source = \"A book\"
[scenario]
time = { duration-h = 1, step-s = 600 }
region = { latitude-deg = [10, 40], longitude-deg = [100, 100], step-deg = 30 }
[[statement]]
name = \"in view\"
of = \"star:86:72/6/1@900\"
metric = \"mean-visible\"
expected = 400
tolerance = 0.5
source = \"page 12\"
";
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(place.join("mine.toml"), MINE).unwrap();
    let reproduced = |studies: &[&str]| {
        let arguments = [&["reproduce", "--quiet", "--format", "json"], studies].concat();
        ran(place, &arguments)
    };
    let two = reproduced(&["sun-synchronous", "mine.toml", "--out", "two"]);
    assert_eq!(two.status, 1, "{}", two.stderr);
    let value: Value = serde_json::from_str(&two.stdout).unwrap();
    let [sun, mine] = value["studies"].as_array().unwrap().as_slice() else {
        panic!("{value}");
    };
    let sun = &sun["statements"][0];
    assert_eq!(sun["verdict"], "met");
    assert_eq!(
        (&sun["expected"], &sun["tolerance"]),
        (&0.985_647.into(), &6e-5.into())
    );
    assert_eq!(sun["unit"], "deg/day");
    let mine = &mine["statements"][0];
    assert_eq!(
        (&mine["verdict"], &mine["source"]),
        (&"not-met".into(), &"page 12".into())
    );
    assert!(mine["computed"].as_f64().unwrap() < 10.0);
    let report = fs::read_to_string(place.join("two/report.json")).unwrap();
    assert_eq!(report.trim(), two.stdout.trim());
    let markdown = fs::read_to_string(place.join("two/report.md")).unwrap();
    assert!(
        markdown.contains("| mine | 1 | 0 | 0 | 0 | 0 | 1 | 0 |"),
        "{markdown}"
    );
    assert!(
        markdown.contains("- in view: not met, and not explained"),
        "{markdown}"
    );
    // The figure has the number and its verdict; the page has the figure.
    let drawn = fs::read_to_string(place.join("two/deviations-mine.svg")).unwrap();
    assert!(drawn.contains("in view  (not-met)"), "{drawn}");
    let page = fs::read_to_string(place.join("two/report.html")).unwrap();
    assert!(
        page.contains(&without_typeface(&drawn))
            && page.contains("in view: not met, and not explained")
    );
    assert!(!page.contains("<script"));
    // Explained, it is no failure; the same studies again are replaced, others are not.
    let explained = MINE.replace("source = \"page", "disagreement = \"why\"\nsource = \"page");
    fs::write(place.join("mine.toml"), explained).unwrap();
    let other = reproduced(&["mine.toml", "--out", "two"]);
    assert_eq!(other.status, 2);
    assert!(
        other
            .stderr
            .contains("holds something other than this study"),
        "{}",
        other.stderr
    );
    for _ in 0..2 {
        let again = reproduced(&["mine.toml", "--out", "one"]);
        assert_eq!(again.status, 0, "{}", again.stderr);
    }
    // Another study in its place needs --force, and then nothing of the first is left.
    let forced = reproduced(&["sun-synchronous", "--out", "one", "--force"]);
    assert_eq!(forced.status, 0, "{}", forced.stderr);
    assert!(!place.join("one/deviations-mine.svg").exists());
    assert!(place.join("one/deviations-sun-synchronous.svg").exists());
    // By area nothing changes for one longitude, by another mask it does.
    let set = reproduced(&[
        "mine.toml",
        "--out",
        "set",
        "--set",
        "visibility.mask-deg=40",
    ]);
    let value: Value = serde_json::from_str(&set.stdout).unwrap();
    let higher = value["studies"][0]["statements"][0]["computed"]
        .as_f64()
        .unwrap();
    assert!(higher < mine["computed"].as_f64().unwrap());
    let listed = ran(place, &["reproduce", "--list", "--format", "json"]);
    let listed: Value = serde_json::from_str(&listed.stdout).unwrap();
    let names: Vec<&str> = listed["studies"]
        .as_array()
        .unwrap()
        .iter()
        .map(|study| study["name"].as_str().unwrap())
        .collect();
    assert_eq!(names[..2], ["paper", "gps-sps"]);
}

/// Each study has a directory of its own, so that a second one needs no --force.
#[test]
fn studies_have_places_of_their_own() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for (studies, made) in [
        (&["topex"][..], "topex"),
        (&["sun-synchronous"], "sun-synchronous"),
        (&["topex", "sun-synchronous"], "topex+sun-synchronous"),
        (&["topex"], "topex"),
    ] {
        let ran = ran(place, &[&["reproduce"][..], studies].concat());
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let report = place.join("runs/reproduce").join(made).join("report.json");
        let report: Value = serde_json::from_slice(&fs::read(report).unwrap()).unwrap();
        assert_eq!(report["studies"].as_array().unwrap().len(), studies.len());
    }
    let twice = refused(&["reproduce", "topex", "topex"]);
    assert!(twice.contains("study topex is given twice"), "{twice}");
}

/// What the published tables of skies, slots and repeats are, the program computes: no statement of these studies is unexpected.
#[test]
fn validate_quick_studies() {
    let directory = TempDir::new().unwrap();
    let studies = ["skies", "galileo", "glonass", "topex", "sun-synchronous"];
    let arguments = [&["reproduce", "--format", "json"][..], &studies].concat();
    let ran = ran(directory.path(), &arguments);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let value: Value = serde_json::from_str(&ran.stdout).unwrap();
    let counted = |verdict: &str| {
        let studies = value["studies"].as_array().unwrap().iter();
        let statements = studies.flat_map(|study| study["statements"].as_array().unwrap());
        statements.filter(|one| one["verdict"] == verdict).count()
    };
    // The numbers from memory; and the node of Galileo, which Moon and Sun turn too.
    assert_eq!(
        ["met", "unconfirmed", "not-met"].map(counted),
        [26, 5, 1],
        "{value}"
    );
}

/// The example of the documentation is short, and says why its number is not met.
#[test]
fn the_example_study_runs() {
    let directory = TempDir::new().unwrap();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/studies.md")).unwrap();
    let (_, rest) = text.split_once("```toml\n").unwrap();
    let (study, _) = rest.split_once("```").unwrap();
    assert!(study.lines().count() < 20, "{study}");
    fs::write(directory.path().join("mine.toml"), study).unwrap();
    let ran = ran(directory.path(), &["reproduce", "mine.toml"]);
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(
        ran.stdout.contains("met-under-assumption"),
        "{}",
        ran.stdout
    );
    assert!(
        ran.stdout.contains("note: mean visible, 72 satellites: "),
        "{}",
        ran.stdout
    );
}

/// The example with a table, a fit and a search is short, and each of its steps is in what it writes.
#[test]
fn the_example_study_with_steps_runs() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/studies.md")).unwrap();
    let study = text.split("```toml\n").nth(2).unwrap();
    let (study, _) = study.split_once("```").unwrap();
    assert!(study.lines().count() < 40, "{study}");
    fs::write(place.join("other.toml"), study).unwrap();
    let with = |further: &[&str]| {
        let arguments = ["reproduce", "other.toml", "--quiet", "--format", "json"];
        ran(place, &[&arguments[..], further].concat())
    };
    let one = with(&[]);
    assert_eq!(one.status, 0, "{}{}", one.stdout, one.stderr);
    let value: Value = serde_json::from_str(&one.stdout).unwrap();
    let study = &value["studies"][0];
    let verdicts: Vec<&str> = study["statements"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one["verdict"].as_str().unwrap())
        .collect();
    assert_eq!(verdicts, ["fitted", "fitted", "fitted", "met"]);
    let number = |value: &Value| value.as_f64().unwrap();
    let fit = &study["fits"][0];
    let median = number(&fit["median"]);
    assert_eq!(
        (&fit["vary"], number(&study["statements"][2]["expected"])),
        (&"visibility.mask-deg".into(), median)
    );
    // A lower mask sees more: with the median of the two as the mask, that row has its number.
    let mask = format!("visibility.mask-deg={median}");
    let there = with(&["--out", "there", "--set", &mask]);
    let there: Value = serde_json::from_str(&there.stdout).unwrap();
    let rows = there["studies"][0]["statements"].as_array().unwrap()[..2].iter();
    let off = rows.map(|one| (number(&one["computed"]) - number(&one["expected"])).abs());
    let least = off.fold(f64::INFINITY, f64::min);
    // A fit stops at a thirtieth of the tolerance.
    assert!(least < 0.05 / 30.0, "{least}");
    let search = &study["searches"][0];
    assert!(number(&search["evaluations"]) > 8.0);
    let pick = &search["members"][search["chosen"].as_u64().unwrap() as usize];
    let own = number(&pick["metrics"]["mean_visible"]);
    let of_b = number(&study["tables"][0]["rows"][1]["computed"][0]);
    let stated = number(&study["statements"][3]["computed"]);
    assert!((stated - 100.0 * (own / of_b - 1.0)).abs() < 1e-9);
    for (name, lines) in [("table2.csv", 3), ("statements.csv", 5)] {
        let path = place.join("runs/reproduce/other").join(name);
        assert_eq!(fs::read_to_string(path).unwrap().lines().count(), lines);
    }
    let other = with(&["--out", "seed", "--seed", "2"]);
    let other: Value = serde_json::from_str(&other.stdout).unwrap();
    assert_eq!(
        (&other["studies"][0]["seed"], &study["seed"]),
        (&2.into(), &1.into())
    );
    assert!(other["studies"][0]["searches"] != study["searches"]);
    assert_eq!(other["studies"][0]["fits"], study["fits"]);
}

/// What is wrong with a step is told with its line and the nearest name, and nothing is left behind.
#[test]
fn steps_that_are_wrong_are_refused() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = fs::read_to_string(root.join("docs/studies.md")).unwrap();
    let study = text.split("```toml\n").nth(2).unwrap();
    let (study, _) = study.split_once("```").unwrap();
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for (from, to, told) in [
        (
            "search:own",
            "search:owns",
            "other.toml:30: search:owns: the study has no search \"owns\", did you mean \"own\"?",
        ),
        (
            "fit:mask",
            "fit:msk",
            "other.toml:23: fit:msk: the study has no fit \"msk\", did you mean \"mask\"?",
        ),
        (
            "vary = \"visibility.mask-deg\"",
            "vary = \"visibility.mask-dge\"",
            "other.toml:8: scenario.visibility.mask-dge: unknown key, did you mean `visibility.mask-deg`?",
        ),
        (
            "vary = \"visibility.mask-deg\"",
            "vary = \"inclination\"",
            "other.toml:10: vary: found \"inclination\", did you mean \"inclination-deg\"?",
        ),
        (
            "range = [0, 30]",
            "range = [30, 0]",
            "other.toml:12: range: found [30.0, 0.0], expected two numbers, the lower first",
        ),
        ("range = [0, 30]", "rang = [0, 30]", "unknown field `rang`"),
        (
            "to = \"mean-visible\"",
            "to = \"mean-pdop\"",
            "other.toml:11: to: no table has a column of mean-pdop",
        ),
        (
            "tolerance = 0.05",
            "tolerance = 0",
            "other.toml:18: tolerance: found 0, expected a number above 0",
        ),
        (
            "values = [2.25]",
            "values = [2.25, 2]",
            "other.toml:20: row \"A\": values: found 2, expected 1 finite numbers",
        ),
        (
            "{ name = \"B\"",
            "{ name = \"A\"",
            "name: there are two rows \"A\"",
        ),
        (
            "file = \"table2\"",
            "file = \"report\"",
            "other.toml:17: file: \"report\" is another file",
        ),
        (
            "metric = \"implied\"",
            "metric = \"impleid\"",
            "other.toml:26: metric: unknown metric \"impleid\", did you mean \"implied\"?",
        ),
        (
            "percent-above = \"B\"",
            "against = \"B\"",
            "mean-visible is of one constellation, and compares with none; leave out against",
        ),
    ] {
        assert!(study.contains(from), "{from}");
        fs::write(place.join("other.toml"), study.replacen(from, to, 1)).unwrap();
        let found = ran(place, &["reproduce", "other.toml"]);
        assert_eq!(found.status, 2, "{told}");
        assert!(found.stderr.contains(told), "{}", found.stderr);
    }
    let left: Vec<_> = fs::read_dir(place).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

#[test]
fn a_study_that_is_wrong_is_refused() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(
        place.join("wrong.toml"),
        "name = \"a\"\ntitle = \"b\"\nsource = \"c\"\n",
    )
    .unwrap();
    for (arguments, told) in [
        (
            vec!["reproduce", "wrong.toml"],
            "wrong.toml:1: found no [[statement]] or [[table]], expected at least one",
        ),
        (
            vec!["reproduce", "missing.toml"],
            "cannot read missing.toml",
        ),
        (
            vec!["reproduce", "gps-spss"],
            "no built-in study 'gps-spss', did you mean 'gps-sps'? (choices: paper, gps-sps,",
        ),
        (
            vec!["reproduce", "gps-sps", "iridium", "--set", "time.step-s=60"],
            "--set time.step-s=60: several studies have several scenarios; give one study",
        ),
        (
            vec!["reproduce", "gps-sps", "--seed", "2"],
            "--seed 2 is of searches, and study gps-sps has none",
        ),
        (
            vec!["reproduce", "sun-synchronous", "--set", "time.stp-s=60"],
            "--set time.stp-s=60: time.stp-s: unknown key, did you mean `time.step-s`?",
        ),
    ] {
        let found = ran(place, &arguments);
        assert_eq!(found.status, 2, "{arguments:?}");
        assert!(found.stderr.contains(told), "{}", found.stderr);
    }
    let left: Vec<_> = fs::read_dir(place).unwrap().collect();
    assert_eq!(left.len(), 1, "{left:?}");
}

/// A figure as it is in a page: a file has its typeface in it.
fn without_typeface(svg: &str) -> String {
    let (open, rest) = svg.split_once("\n<style>").unwrap();
    open.to_owned() + rest.split_once("</style>").unwrap().1
}

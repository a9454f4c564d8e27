//! Where results come from, and what moved between two of them.

use crate::cli::{Ran, ran};
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SMALL: &str = "--set region.step-deg=25 --set time.step-s=1200 --set time.duration-h=4";
const SEARCH: &str =
    "--set optimizer.population=4 --set optimizer.generations=2 --set search.planes=[5,7]";

/// A space of a few designs, and a constraint that some of them keep.
const SMALLEST: &str = "--set search.planes=[5,5] --set search.satellites-per-plane=[5,6] --set \
                        search.inclination-step-deg=20 --set search.altitude-step-km=600 --set \
                        objectives.constraints=[\"mean-visible>=0.1\"]";

fn run(place: &Path, line: &str) -> Ran {
    ran(place, &line.split_whitespace().collect::<Vec<_>>())
}

#[track_caller]
fn done(place: &Path, line: &str) -> Ran {
    let ran = run(place, line);
    assert_eq!(ran.status, 0, "{line}: {}", ran.stderr);
    ran
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

fn read(path: &Path) -> Value {
    json(&fs::read_to_string(path.join("provenance.json")).unwrap())
}

#[test]
fn every_output_directory_says_where_it_comes_from() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::create_dir(place.join("deep")).unwrap();
    let study = format!(
        "[region]\nstep-deg = 25\n[time]\nstep-s = 1200\nduration-h = 4\n{}",
        "[search]\nplanes = [5, 7]\n"
    );
    fs::write(place.join("deep/mine.toml"), study).unwrap();
    let design = "--design delta:55:6/3/1@925";
    for (command, out) in [
        (format!("optimize deep/mine.toml {SEARCH} --threads 1 --out o/run"), "o/run"),
        (format!("optimize deep/mine.toml {SEARCH} --seeds 2 --out o/seeds"), "o/seeds"),
        (format!("optimize deep/mine.toml {SEARCH} --seeds 2 --out o/seeds --resume"), "o/seeds/seed-2"),
        (format!("evaluate deep/mine.toml {design} --out o/given"), "o/given"),
        (format!("evaluate deep/mine.toml {design} --series o/series"), "o/series"),
        (format!("size deep/mine.toml {SMALLEST} --out o/size"), "o/size"),
        (format!("export deep/mine.toml {design} --as tle --out o/export"), "o/export"),
        (format!("validate deep/mine.toml {design} --against geographiclib --out o/validation"), "o/validation"),
        ("sweep deep/mine.toml --set search.planes=[5,5] --set search.satellites-per-plane=[5,5] --set \
          search.inclination-step-deg=20 --set search.altitude-step-km=600 --shard 1/1 --out o/sweep".to_owned(), "o/sweep"),
        ("reproduce topex --out o/topex".to_owned(), "o/topex"),
    ] {
        done(place, &format!("{command} --quiet"));
        let found = read(&place.join(out));
        let words: Vec<&str> = found["command"].as_array().unwrap().iter().map(|word| word.as_str().unwrap()).collect();
        let expected: Vec<&str> = command.split_whitespace().collect();
        assert_eq!(words[0], "navwalker");
        assert_eq!(words[1], expected[0], "{command}");
        let line = words.join(" ");
        for left_out in ["--out", "--threads", "--resume", "--shard", "--quiet", "deep", "o/"] {
            assert!(!line.contains(left_out), "{line}: {left_out}");
        }
        assert!(words.contains(&"mine.toml") || words[1] == "reproduce", "{line}");
        assert_eq!(found["version"], env!("CARGO_PKG_VERSION"));
        assert!(found["platform"].as_str().unwrap().contains(std::env::consts::ARCH));
        assert_eq!(found["scenarios"][0]["hash"].as_str().unwrap().len(), 64, "{found}");
    }
    // Manifests name the file beside them, and runs of all kinds have one.
    for (out, manifest) in [
        ("o/run", "run.json"),
        ("o/seeds/seed-2", "run.json"),
        ("o/given", "run.json"),
        ("o/size", "run.json"),
        ("o/sweep", "run.json"),
        ("o/export", "manifest.json"),
    ] {
        let path = place.join(out);
        let named = json(&fs::read_to_string(path.join(manifest)).unwrap());
        let named = named["provenance"].as_str().unwrap();
        let found = json(&fs::read_to_string(path.join(named)).unwrap());
        assert_eq!(found["program"], "navwalker", "{out}");
    }
    // What was read back is what the results say.
    let front = fs::read_to_string(place.join("o/run/front.json")).unwrap();
    assert_eq!(
        json(&front)["scenario"],
        read(&place.join("o/run"))["scenarios"][0]
    );
}

#[test]
fn the_provenance_of_a_result_is_the_same_wherever_and_however_it_was_made() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    done(
        place,
        &format!("optimize {SMALL} {SEARCH} --quiet --threads 1 --out one"),
    );
    done(
        place,
        &format!("optimize --threads 2 {SMALL} --quiet {SEARCH} --out=deep/two"),
    );
    let bytes = |run: &str| fs::read(place.join(run).join("provenance.json")).unwrap();
    assert_eq!(bytes("one"), bytes("deep/two"));
}

#[test]
fn a_diff_tells_what_moved_and_by_how_much() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for (out, further) in [("a", ""), ("b", ""), ("c", "--set visibility.mask-deg=9")] {
        done(
            place,
            &format!("optimize {SMALL} {SEARCH} {further} --quiet --out {out}"),
        );
    }
    let equal = done(place, "diff a b");
    assert!(equal.stdout.contains("none moved"), "{}", equal.stdout);
    let moved = run(place, "diff a c");
    assert_eq!(moved.status, 1, "{}", moved.stderr);
    assert!(
        moved.stdout.contains("visibility.mask-deg"),
        "{}",
        moved.stdout
    );
    assert!(
        moved.stdout.contains("--set visibility.mask-deg=9"),
        "{}",
        moved.stdout
    );
    let all = json(&run(place, "diff a c --format json").stdout);
    let mask = all["moved"]
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["quantity"] == "visibility.mask-deg")
        .unwrap();
    assert_eq!(
        (&mask["file"], &mask["difference"]),
        (&json("\"scenario.toml\""), &json("2.0"))
    );
    // Rows are matched by design, so the difference of a metric is that of its evaluations.
    for (out, mask) in [("d", "7"), ("e", "9")] {
        done(
            place,
            &format!(
                "evaluate {SMALL} --set visibility.mask-deg={mask} --design x=delta:55:24/6/1@925 --quiet --out {out}"
            ),
        );
    }
    let evaluated = |mask: &str| {
        let line = format!(
            "evaluate {SMALL} --set visibility.mask-deg={mask} --design delta:55:24/6/1@925 --format json --quiet"
        );
        json(&done(place, &line).stdout)["metrics"]["mean_visible"]
            .as_f64()
            .unwrap()
    };
    let all = json(&run(place, "diff d e --format json").stdout);
    let one = all["moved"].as_array().unwrap().iter().find(|one| {
        one["quantity"]
            .as_str()
            .unwrap()
            .ends_with("metrics.mean_visible")
    });
    let difference = one.unwrap()["difference"].as_f64().unwrap();
    assert_eq!(difference, evaluated("9") - evaluated("7"));
    done(place, "diff d e --relative 2");
}

#[test]
fn sweeps_are_compared_design_by_design_in_either_format() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let space = "--set search.planes=[5,5] --set search.satellites-per-plane=[5,6] --set search.inclination-step-deg=20 \
                 --set search.altitude-step-km=600";
    done(place, &format!("sweep {SMALL} {space} --quiet --out a"));
    done(
        place,
        &format!("sweep {SMALL} {space} --quiet --as csv --out b"),
    );
    done(
        place,
        &format!("sweep {SMALL} {space} --set visibility.mask-deg=8 --quiet --out c"),
    );
    let equal = done(place, "diff a b");
    assert!(equal.stdout.contains("none moved"), "{}", equal.stdout);
    let moved = run(place, "diff a c --format csv");
    assert_eq!(moved.status, 1);
    assert!(
        moved
            .stdout
            .lines()
            .any(|line| line.starts_with("table,mean_visible,")),
        "{}",
        moved.stdout
    );
}

#[test]
fn what_cannot_be_compared_is_named() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::create_dir(place.join("empty")).unwrap();
    fs::write(place.join("bad.json"), "{").unwrap();
    fs::write(place.join("good.json"), "{}").unwrap();
    fs::write(place.join("good.csv"), "a\n1\n").unwrap();
    for (line, message) in [
        ("diff missing good.json", "cannot read missing"),
        ("diff bad.json good.json", "it is not JSON"),
        ("diff empty good.json", "have no file in common"),
        ("diff good.csv good.json", "have no file in common"),
        (
            "diff good.json good.json --relative -1",
            "expected a number, at least 0",
        ),
    ] {
        let ran = run(place, line);
        assert_eq!(ran.status, 2, "{line}: {}", ran.stderr);
        assert!(ran.stderr.contains(message), "{line}: {}", ran.stderr);
    }
}

/// A page and a figure have no values of their own: the error names the file that has them.
#[test]
fn what_is_drawn_is_compared_by_the_files_beside_it() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for (out, mask) in [("a", "7"), ("b", "9")] {
        let line = format!(
            "evaluate {SMALL} --set visibility.mask-deg={mask} --design x=delta:55:24/6/1@925 --quiet --out {out}"
        );
        done(place, &line);
        done(place, &format!("report {out} --quiet"));
        done(
            place,
            &format!("plot {out} --figure histogram --quiet --out {out}/figures/h.svg"),
        );
    }
    let pages = run(place, "diff a/report.html b/report.html");
    assert_eq!(pages.status, 2, "{}", pages.stderr);
    assert!(
        pages.stderr.contains("a/report.html is drawn from values"),
        "{}",
        pages.stderr
    );
    assert!(pages.stderr.contains("front.json"), "{}", pages.stderr);
    assert!(
        !pages.stderr.contains("provenance.json"),
        "{}",
        pages.stderr
    );
    let figures = run(place, "diff a/figures/h.svg b/figures/h.svg");
    assert_eq!(figures.status, 2);
    assert!(
        figures.stderr.contains("in h.csv beside it"),
        "{}",
        figures.stderr
    );
    done(place, "diff a/report.html a/report.html");
    // In directories the tables move; a figure beside a table that moved is not named again.
    let both = run(place, "diff a b");
    assert_eq!(both.status, 1);
    assert!(
        both.stdout.contains("drawn differently: report.html\n"),
        "{}",
        both.stdout
    );
    assert!(both.stdout.contains("figures/h.csv"), "{}", both.stdout);
    fs::remove_file(place.join("a/report.html")).unwrap();
    fs::remove_dir_all(place.join("b")).unwrap();
    let line = format!(
        "evaluate {SMALL} --set visibility.mask-deg=7 --design x=delta:55:24/6/1@925 --quiet --out b"
    );
    done(place, &line);
    done(place, "report b --quiet");
    fs::remove_dir_all(place.join("a/figures")).unwrap();
    done(place, "diff a b");
}

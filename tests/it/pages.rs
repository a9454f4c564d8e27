//! The pages of `size` and `sweep`: their answers are those of the results, whatever was found.

use crate::cli::{Ran, ran};
use crate::common::contents;
use serde_json::Value;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A study of a fraction of a second with 72 designs.
const SMALL: &str = "--quiet --set region.step-deg=25 --set time.step-s=3600 --set search.planes=[4,6] \
     --set search.satellites-per-plane=[4,5] --set search.inclination-step-deg=10 --set search.altitude-km=[850,1000]";

fn run(place: &Path, words: &str) -> Ran {
    let words: Vec<&str> = words.split_whitespace().collect();
    ran(place, &words)
}

fn page(place: &Path, directory: &str) -> String {
    let html = fs::read_to_string(place.join(directory).join("report.html")).unwrap();
    assert!(!html.contains("<script"), "{directory}");
    assert!(!html.contains("NaN"), "{directory}");
    html
}

fn json(place: &Path, file: &str) -> Value {
    serde_json::from_slice(&fs::read(place.join(file)).unwrap()).unwrap()
}

fn figures(html: &str) -> usize {
    html.matches("<figure><svg").count()
}

#[test]
fn the_page_of_a_size_has_the_answer_its_proofs_and_figures() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let constraints = "--set objectives.constraints=[\"mean-visible>=1\",\"availability>=0.5\"]";
    let line = format!("size {SMALL} {constraints} --slack 8 --out found");
    let found = run(place, &line);
    assert_eq!(found.status, 0, "{}", found.stderr);
    let (html, result) = (page(place, "found"), json(place, "found/size.json"));
    let fewest = result["fewest"].as_u64().unwrap();
    let answer = format!("Fewest satellites of scenario paper: {fewest}, with");
    assert!(
        html.contains(&answer) && found.stdout.starts_with(&answer),
        "{answer}"
    );
    for one in result["designs"].as_array().unwrap() {
        let notation = one["design"]["notation"].as_str().unwrap();
        assert!(html.contains(&format!("<td>{notation}</td>")), "{notation}");
    }
    assert!(html.contains(result["certificate"]["sha256"].as_str().unwrap()));
    // Designs, each constraint, the front, and what the rules rejected.
    let rejected = result["rules"]
        .as_array()
        .unwrap()
        .iter()
        .any(|rule| rule["designs"] != 0);
    assert_eq!(figures(&html), 1 + 2 + 1 + usize::from(rejected));
    let resumed = run(place, &format!("{line} --resume --threads 1"));
    assert_eq!(resumed.status, 0, "{}", resumed.stderr);
    assert_eq!(page(place, "found"), html);
}

/// Nothing kept, everything kept, and a space of one design.
#[test]
fn degenerate_searches_have_pages_too() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let one = "--set search.planes=4 --set search.satellites-per-plane=4 --set search.inclination-deg=55 \
               --set search.altitude-km=900 --set search.phasing=1";
    for (out, further, constraint, status) in [
        ("nothing", "", "max-pdop<=0.1", 1),
        ("all", "", "planes<=50", 0),
        ("one", one, "planes<=50", 0),
        (
            "unsolved",
            "--set visibility.mask-deg=89.9",
            "mean-pdop<=3",
            1,
        ),
    ] {
        let line = format!(
            "size {SMALL} {further} --set objectives.constraints=[\"{constraint}\"] --out {out}"
        );
        let ran = run(place, &line);
        assert_eq!(ran.status, status, "{out}: {}", ran.stderr);
        let html = page(place, out);
        let answer = ran.stdout.lines().next().unwrap();
        assert!(html.contains(answer), "{out}");
    }
    assert!(page(place, "all").contains("no design of the search space has fewer satellites"));
    // What is the same for all designs has no figure.
    for (out, further) in [
        ("one-swept", one),
        ("unsolved-swept", "--set visibility.mask-deg=89.9"),
    ] {
        let ran = run(place, &format!("sweep {SMALL} {further} --out {out}"));
        assert_eq!(ran.status, 0, "{out}: {}", ran.stderr);
        assert_eq!(figures(&page(place, out)), 0, "{out}");
    }
}

#[test]
fn the_page_of_a_sweep_has_the_best_of_its_table() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let swept = run(
        place,
        &format!("sweep {SMALL} --as csv --out whole --threads 1"),
    );
    assert_eq!(swept.status, 0, "{}", swept.stderr);
    let html = page(place, "whole");
    let mut table = csv::Reader::from_path(place.join("whole/table.csv")).unwrap();
    let columns = table.headers().unwrap().clone();
    let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
    let (notation, pdop) = (at("notation"), at("mean_pdop"));
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let value = |row: &csv::StringRecord| row[pdop].parse::<f64>().unwrap();
    let best = rows
        .iter()
        .min_by(|a, b| value(a).total_cmp(&value(b)))
        .unwrap();
    assert!(
        html.contains(&format!("<td>{}</td>", &best[notation])),
        "{best:?}"
    );
    assert!(
        html.contains(&format!("<td class=\"number\">{:.4}</td>", value(best))),
        "{best:?}"
    );
    assert!(html.contains("72 designs of the space"), "{html}");
    assert!(html.contains(json(place, "whole/index.json")["sha256"].as_str().unwrap()));
    // Mean PDOP, CVaR and mean visible by four variables; every design is always available.
    assert!(figures(&html) >= 12, "{}", figures(&html));
    // In parts, by two threads: the page is the same but for the table's name and checksum.
    for shard in ["2/2", "1/2"] {
        let part = run(
            place,
            &format!("sweep {SMALL} --as csv --chunk 7 --shard {shard} --threads 2 --out parts"),
        );
        assert_eq!(part.status, 0, "{}", part.stderr);
        assert!(!place.join("parts/report.html").exists());
    }
    assert_eq!(run(place, "sweep --merge --quiet --out parts").status, 0);
    let [one, other] = ["whole", "parts"].map(|out| contents(&place.join(out)));
    let name = Path::new("report.html");
    assert_eq!(one[name], other[name]);
}

/// `report` is of runs: the page of a size or a sweep stays, unless another place is given.
#[test]
fn the_page_of_another_command_is_not_replaced() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let size = format!("size {SMALL} --set objectives.constraints=[\"planes<=50\"] --out size");
    assert_eq!(run(place, &size).status, 0);
    assert_eq!(run(place, &format!("sweep {SMALL} --out sweep")).status, 0);
    assert_eq!(
        run(place, "reproduce topex --quiet --out reproduce").status,
        0
    );
    for (out, command) in [
        ("size", "size"),
        ("sweep", "sweep"),
        ("reproduce", "validate or reproduce"),
    ] {
        let before = page(place, out);
        let refused = run(place, &format!("report {out} --quiet"));
        assert_eq!(refused.status, 2, "{out}: {}", refused.stderr);
        let message = format!("{out} holds the results and the page of {command};");
        assert!(refused.stderr.contains(&message), "{}", refused.stderr);
        assert_eq!(page(place, out), before);
    }
}

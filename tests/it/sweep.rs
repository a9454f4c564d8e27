//! `sweep` as it is typed: chunks, shards, what is damaged or missing, and the front of the table.

use crate::cli::{Ran, ran, refused};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A space of 72 designs in a fraction of a second.
const SMALL: &str = "--quiet --set region.step-deg=25 --set time.step-s=3600 --set search.planes=[4,6] \
     --set search.satellites-per-plane=[4,5] --set search.inclination-step-deg=10 --set search.altitude-km=[850,1000]";

fn run(place: &Path, words: &str) -> Ran {
    let words: Vec<&str> = words.split_whitespace().collect();
    ran(place, &words)
}

fn swept(place: &Path, further: &str) -> Ran {
    run(place, &format!("sweep {SMALL} {further}"))
}

fn index(store: &Path) -> Value {
    serde_json::from_slice(&fs::read(store.join("index.json")).unwrap()).unwrap()
}

/// The results of the chunks of a store, sorted.
fn chunks(store: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(store.join("chunks")).unwrap();
    let mut found: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    found.sort();
    found
}

/// The same bytes for one thread and two, in whatever chunks, by shards in any order, and after an interruption.
#[test]
fn the_table_does_not_depend_on_how_it_was_made() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for format in ["parquet", "csv"] {
        let whole = format!("whole-{format}");
        let ran = swept(
            place,
            &format!("--as {format} --out {whole} --threads 1 --format json"),
        );
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        let printed: Value = serde_json::from_str(&ran.stdout).unwrap();
        assert_eq!(printed, index(&place.join(&whole)));
        assert_eq!(printed["designs"], 72);
        let table = fs::read(place.join(&whole).join(format!("table.{format}"))).unwrap();
        let parts = format!("parts-{format}");
        for shard in ["3/3", "1/3", "2/3"] {
            let words =
                format!("--as {format} --out {parts} --chunk 7 --threads 2 --shard {shard}");
            let ran = swept(place, &words);
            assert_eq!(ran.status, 0, "{}", ran.stderr);
        }
        assert!(!place.join(&parts).join("index.json").exists());
        let merged = run(place, &format!("sweep --merge --out {parts}"));
        assert_eq!(merged.status, 0, "{}", merged.stderr);
        assert_eq!(index(&place.join(&parts))["sha256"], printed["sha256"]);
        let again = fs::read(place.join(&parts).join(format!("table.{format}"))).unwrap();
        assert_eq!(again, table);
        assert_eq!(chunks(&place.join(&parts)).len(), 11);
    }
}

/// The metrics of a row are those that `evaluate` gives for its design.
#[test]
fn rows_are_what_evaluate_gives() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(
        place.join("designs.csv"),
        "name,design\nfirst,delta:55:20/4/1@900\n\"b, c\",star:90:12/3/1@800+delta:40:4/2/1@1000\n",
    )
    .unwrap();
    let study = "--set region.step-deg=25 --set time.step-s=3600";
    let ran = run(
        place,
        &format!("sweep {study} --designs designs.csv --as csv --out store --quiet"),
    );
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    let table = fs::read_to_string(place.join("store/table.csv")).unwrap();
    let evaluated = run(
        place,
        &format!("evaluate {study} --designs designs.csv --format csv --quiet"),
    );
    let rows = |text: &str| -> Vec<csv::StringRecord> {
        let mut reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .from_reader(text.as_bytes());
        reader.records().map(Result::unwrap).collect()
    };
    let (swept, evaluated) = (rows(&table), rows(&evaluated.stdout));
    assert_eq!(swept.len(), 3);
    let mut compared = 0;
    for (place, name) in swept[0].iter().enumerate() {
        let Some(other) = evaluated[0].iter().position(|one| one == name) else {
            continue;
        };
        compared += 1;
        for row in 1..3 {
            assert_eq!(
                swept[row][place], evaluated[row][other],
                "{name}, row {row}"
            );
        }
    }
    assert!(compared > 40, "{compared}");
}

/// A result that is cut, changed or missing is said, and made again.
#[test]
fn damaged_results_are_named_and_made_again() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(swept(place, "--as csv --chunk 20 --out store").status, 0);
    let store = place.join("store");
    let table = fs::read(store.join("table.csv")).unwrap();
    let all = chunks(&store);
    assert_eq!(all.len(), 4);
    let bytes = fs::read(&all[0]).unwrap();
    fs::write(&all[0], &bytes[..bytes.len() / 2]).unwrap();
    let text = fs::read_to_string(&all[1]).unwrap();
    // One digit of one metric.
    let changed = text.replacen("0.", "1.", 1);
    assert_ne!(changed, text);
    fs::write(&all[1], changed).unwrap();
    fs::copy(&all[3], &all[2]).unwrap();
    fs::remove_file(&all[3]).unwrap();
    let status = run(place, "sweep --status --out store --format json");
    assert_eq!(status.status, 0, "{}", status.stderr);
    let status: Value = serde_json::from_str(&status.stdout).unwrap();
    assert_eq!(status["done"], 0);
    assert_eq!(status["missing"].as_array().unwrap().len(), 1);
    let damaged = status["damaged"].as_array().unwrap();
    let mut reasons: Vec<&str> = damaged
        .iter()
        .map(|one| one["reason"].as_str().unwrap())
        .collect();
    reasons.sort_unstable();
    assert!(
        reasons[0].contains("does not match its checksum"),
        "{reasons:?}"
    );
    assert!(reasons[1].contains("cut short"), "{reasons:?}");
    assert!(reasons[2].contains("another chunk"), "{reasons:?}");
    let merged = run(place, "sweep --merge --out store");
    assert_eq!(merged.status, 1, "{}", merged.stderr);
    assert!(merged.stdout.contains("missing  1"), "{}", merged.stdout);
    let from = run(place, "optimize --from store");
    assert_eq!(from.status, 2, "{}", from.stdout);
    assert!(from.stderr.contains("sweep --resume"), "{}", from.stderr);
    fs::remove_file(store.join("table.csv")).unwrap();
    let resumed = run(place, "sweep --resume --out store");
    assert_eq!(resumed.status, 0, "{}", resumed.stderr);
    assert!(
        resumed.stderr.contains("computed again"),
        "{}",
        resumed.stderr
    );
    assert_eq!(fs::read(store.join("table.csv")).unwrap(), table);
}

/// The front of a sweep is that of an exhaustive search.
#[test]
fn the_front_is_that_of_an_exhaustive_search() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(swept(place, "--chunk 10 --out store").status, 0);
    let from = run(place, "optimize --from store --quiet --format csv");
    let search = run(
        place,
        &format!("optimize {SMALL} --set optimizer.algorithm=exhaustive --out run --format csv"),
    );
    assert_eq!((from.status, search.status), (0, 0), "{}", from.stderr);
    assert_eq!(from.stdout, search.stdout);
    let other = run(
        place,
        "optimize --from store --quiet --format csv --set objectives.minimize=[\"satellites\",\"max-pdop\"]",
    );
    assert_eq!(other.status, 0, "{}", other.stderr);
    assert_ne!(other.stdout, from.stdout);
    let changed = run(place, "optimize --from store --set visibility.mask-deg=20");
    assert_eq!(changed.status, 2);
}

/// What is another sweep is never mixed with the one that is there.
#[test]
fn another_sweep_is_refused_with_what_differs() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(swept(place, "--chunk 40 --out store").status, 0);
    let again = swept(place, "--chunk 40 --out store");
    assert_eq!(again.status, 2);
    assert!(again.stderr.contains("--resume"), "{}", again.stderr);
    for (further, told) in [
        ("--set visibility.mask-deg=8", "the scenario is another"),
        ("--chunk 30", "--chunk is 40 there and 30 here"),
        ("--as csv", "--as is parquet there and csv here"),
    ] {
        let other = swept(place, &format!("{further} --resume --out store"));
        assert_eq!(other.status, 2, "{further}");
        assert!(other.stderr.contains(told), "{}", other.stderr);
    }
    // The seed and the algorithm of a search do not matter.
    let seed = swept(place, "--set optimizer.seed=9 --resume --out store");
    assert_eq!(seed.status, 0, "{}", seed.stderr);
    fs::write(place.join("store/mine.txt"), "mine").unwrap();
    let forced = swept(place, "--as csv --force --out store");
    assert_eq!(forced.status, 2);
    assert!(forced.stderr.contains("mine.txt"), "{}", forced.stderr);
    fs::remove_file(place.join("store/mine.txt")).unwrap();
    assert_eq!(swept(place, "--as csv --force --out store").status, 0);
    assert!(place.join("store/table.csv").exists());
    assert!(!place.join("store/table.parquet").exists());
}

/// A disk that takes no file of a certain size: the sweep says so, keeps what is done and leaves nothing half-written, and goes on to
/// the same bytes once there is room.
#[cfg(unix)]
#[test]
fn a_full_disk_loses_only_what_was_not_done() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(swept(place, "--as csv --out whole").status, 0);
    let whole = fs::read(place.join("whole/table.csv")).unwrap();
    // Chunks fit and the table does not; then not even the chunk.
    for (chunk, done, cannot) in [(10, 8, "table.csv"), (72, 0, "chunks")] {
        let store = format!("store-{chunk}");
        let words = format!("sweep {SMALL} --as csv --chunk {chunk} --out {store}");
        let program = assert_cmd::cargo::cargo_bin!("navwalker");
        let limited = "trap '' XFSZ; ulimit -f 30; exec \"$0\" \"$@\"";
        let mut shell = std::process::Command::new("sh");
        shell.current_dir(place).args(["-c", limited]).arg(program);
        let output = shell.args(words.split_whitespace()).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{told}");
        assert!(told.contains("cannot write"), "{told}");
        assert!(told.contains(cannot), "{told}");
        let store = place.join(store);
        assert_eq!(chunks(&store).len(), done, "{told}");
        assert!(!store.join("table.csv").exists() && !store.join("index.json").exists());
        let name = store.file_name().unwrap().display().to_string();
        let resumed = run(place, &format!("sweep --resume --out {name} --quiet"));
        assert_eq!(resumed.status, 0, "{}", resumed.stderr);
        assert_eq!(fs::read(store.join("table.csv")).unwrap(), whole);
    }
}

#[test]
fn what_cannot_be_swept_is_refused() {
    let large = refused(&[
        "sweep",
        "--out",
        "store",
        "--set",
        "search.inclination-step-deg=0.0001",
        "--set",
        "search.altitude-step-km=0.01",
    ]);
    assert!(large.contains("--allow-large"), "{large}");
    assert!(large.contains("TB"), "{large}");
    let none = refused(&["sweep", "--merge", "--out", "store"]);
    assert!(none.contains("store has no sweep"), "{none}");
    let shard = refused(&["sweep", "--shard", "3/2", "--out", "store"]);
    assert!(shard.contains("expected I/N"), "{shard}");
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(
        place.join("list.txt"),
        "delta:55:4/2/1@925\ndelta:55:4/3/1@925\n",
    )
    .unwrap();
    let list = run(place, "sweep --designs list.txt --out store");
    assert_eq!(list.status, 2);
    assert!(list.stderr.contains("list.txt:2: "), "{}", list.stderr);
    assert!(!place.join("store").exists());
}

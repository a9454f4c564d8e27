//! `evaluate --tile` and `--merge` as they are typed.

use crate::cli::{Ran, ran, refused};
use crate::common::contents;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const STUDY: &str = "--set region.step-deg=10 --set time.step-s=1800 --set visibility.mask-deg=30 \
     --set region.weights=cos-latitude";
const DESIGN: &str = "--design delta:55:60/6/1@925";

fn run(place: &Path, words: &str) -> Ran {
    let words: Vec<&str> = words.split_whitespace().collect();
    ran(place, &words)
}

/// Runs what must be done.
fn done(place: &Path, words: &str) -> Ran {
    let ran = run(place, words);
    assert_eq!(ran.status, 0, "{words}: {}", ran.stderr);
    ran
}

/// Makes the files `1.tile`, `2.tile` and so on, the last first.
fn tiles(place: &Path, study: &str, count: usize) {
    for tile in (1..=count).rev() {
        let words = format!("evaluate {study} {DESIGN} --tile {tile}/{count} --out {tile}.tile");
        let ran = done(place, &words);
        assert_eq!(ran.stdout, "");
        // What it takes is told before the work.
        let told = format!("42 points x 48 instants are 2016 samples in {count} tiles: one takes");
        assert!(ran.stderr.contains(&told), "{}", ran.stderr);
    }
}

/// In every format, and as a run directory, from one tile, from some, and from one for each instant, on any number of threads.
#[test]
fn merged_tiles_print_what_the_whole_prints() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let all = format!("{STUDY} --quiet");
    let whole = done(place, &format!("evaluate {all} {DESIGN} --format json"));
    assert!(whole.stdout.contains("gnss_only"));
    done(place, &format!("evaluate {all} {DESIGN} --out whole"));
    tiles(place, STUDY, 5);
    for format in ["json", "text", "csv"] {
        let words = format!("evaluate {all} {DESIGN} --format {format}");
        let whole = done(place, &words);
        let merged = "--merge 4.tile 1.tile 5.tile 2.tile 3.tile";
        let merged = done(place, &format!("{words} {merged}"));
        assert_eq!(merged.stdout, whole.stdout);
    }
    let out = "--out merged --merge 1.tile 2.tile 3.tile 4.tile 5.tile";
    done(place, &format!("evaluate {all} {DESIGN} {out}"));
    let [merged, whole] = ["merged", "whole"].map(|name| contents(&place.join(name)));
    assert_eq!(merged, whole);
    let words = format!("evaluate {all} {DESIGN} --tile 2/5");
    done(place, &format!("{words} --threads 1 --out one"));
    done(place, &format!("{words} --threads 3 --out three"));
    let files = ["one", "three", "2.tile"].map(|name| fs::read(place.join(name)).unwrap());
    assert_eq!(files[0], files[1]);
    assert_eq!(files[0], files[2]);
}

/// One error, which names the file or the tile; nothing is printed.
#[test]
fn wrong_sets_of_tiles_are_refused() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let all = format!("{STUDY} --quiet");
    tiles(place, STUDY, 3);
    let refused = |further: &str, named: &str| {
        let ran = run(place, &format!("evaluate {all} {further}"));
        assert_eq!((ran.status, ran.stdout.as_str()), (2, ""), "{further}");
        assert!(ran.stderr.contains(named), "{further}: {}", ran.stderr);
    };
    let two = "--merge 1.tile 3.tile";
    refused(&format!("{DESIGN} {two}"), "tile 2 of 3 is missing");
    refused(
        &format!("{DESIGN} {two} 1.tile"),
        "1.tile and 1.tile are both tile 1 of 3",
    );
    let three = "--merge 1.tile 2.tile 3.tile";
    refused(
        &format!("{DESIGN} --set visibility.mask-deg=31 {three}"),
        "1.tile is a tile of another evaluation: the scenario is another",
    );
    refused(
        &format!("--design delta:56:60/6/1@925 {three}"),
        "the constellation is delta:55:60/6/1@925 there and delta:56:60/6/1@925 here",
    );
    refused(
        &format!("{DESIGN} --design delta:56:60/6/1@925 {three}"),
        "there are 2",
    );
    refused(&format!("{DESIGN} --merge none.tile"), "none.tile");
    let bytes = fs::read(place.join("2.tile")).unwrap();
    fs::write(place.join("short.tile"), &bytes[..bytes.len() - 100]).unwrap();
    refused(
        &format!("{DESIGN} --merge 1.tile short.tile 3.tile"),
        "short.tile: it is damaged: it is cut short",
    );
    let mut changed = bytes.clone();
    changed[bytes.len() / 2] ^= 1;
    fs::write(place.join("changed.tile"), changed).unwrap();
    refused(
        &format!("{DESIGN} --merge 1.tile changed.tile 3.tile"),
        "changed.tile: it is damaged: it does not match its checksum",
    );
    fs::write(place.join("text.tile"), "name,design\n").unwrap();
    refused(
        &format!("{DESIGN} --merge text.tile"),
        "text.tile: it is not a tile of an evaluation",
    );
}

/// What cannot be cut, and a disk that is full.
#[test]
fn what_cannot_be_a_tile_is_refused() {
    let small = format!("evaluate {STUDY} {DESIGN}");
    let tile = |further: &str| {
        let words = format!("{small} {further}");
        refused(&words.split_whitespace().collect::<Vec<_>>())
    };
    let none = tile("--tile 1/2");
    assert!(none.contains("--out"), "{none}");
    let many = tile("--tile 1/49 --out a.tile");
    assert!(many.contains("there are 48 instants"), "{many}");
    let window = tile("--tile 1/2 --out a.tile --set metrics.window-min=60");
    assert!(
        window.contains("an evaluation with the PDOP of windows cannot be cut"),
        "{window}"
    );
    let series = tile("--tile 1/2 --out a.tile --series s");
    assert!(series.contains("cannot be used with"), "{series}");
    #[cfg(target_os = "linux")]
    {
        let full = tile("--tile 1/2 --out /dev/full");
        assert!(full.contains("cannot write /dev/full"), "{full}");
    }
}

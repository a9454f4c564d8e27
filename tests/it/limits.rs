//! What is very large is said before it starts, and not started unasked.

use crate::cli::{optimize, ran, refused};
use std::fs;
use tempfile::TempDir;

fn line(text: &str) -> Vec<&str> {
    text.split(' ').collect()
}

/// Each would take hours, or more memory than there is, if it were started.
#[test]
fn what_is_very_large_is_not_started() {
    for (command, message) in [
        (
            "evaluate --design delta:55:4/2/1@925 --threads 1000000",
            "--threads 1000000: expected at most ",
        ),
        (
            "optimize --seeds 1001 --out runs",
            "1001 is not in 1..=1000",
        ),
        (
            "optimize --certify --set search.inclination-step-deg=1e-7 --out run",
            "--certify would evaluate 65000000325 designs, expected at most 1000000000; use a larger",
        ),
        (
            "optimize --certify --seeds 2 --set search.inclination-step-deg=1e-7 --out run",
            "expected at most 1000000000",
        ),
        (
            "export --design delta:55:10000/100/1@925 --set time.step-s=1 --as oem,csv --out a",
            "about 10003 files of 296.4 GB in all, in about 2 h; more than 10.0 GB needs --allow-large",
        ),
        (
            "evaluate --design delta:55:4/2/1@925 --set time.step-s=86.4 --set region.step-deg=0.5 \
             --set region.latitude-deg=[-90,90] --set region.longitude-deg=[0,360] \
             --set metrics.window-min=5",
            "or start it anyway with --allow-large",
        ),
    ] {
        let stderr = refused(&line(command));
        assert!(stderr.contains(message), "{command}: {stderr}");
    }
}

/// What `--threads` takes is said: a whole number from 1.
#[test]
fn no_threads_are_refused() {
    for given in ["0", "-1", "1.5", "many"] {
        let command = format!("evaluate --design delta:55:4/2/1@925 --threads={given}");
        let stderr = refused(&line(&command));
        let told = format!(
            "invalid value '{given}' for '--threads <N>': expected a whole number, at least 1 and at most 4 for each core"
        );
        assert!(stderr.contains(&told), "{stderr}");
    }
}

/// The size is told when it takes a while, and `--allow-large` starts what is refused otherwise: here it
/// gets as far as the place, which cannot be had.
#[cfg(target_os = "linux")]
#[test]
fn an_export_is_told_and_allowed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let export =
        "export --design delta:55:10000/100/1@925 --as oem --out /proc/self/a --set time.step-s=";
    let (large, very_large) = (format!("{export}60"), format!("{export}1 --allow-large"));
    for (command, size) in [(large, "1.7 GB"), (very_large, "101.1 GB")] {
        let refused = ran(place, &line(&command));
        assert_eq!(refused.status, 2);
        let told = format!("writing about 10001 files of {size} in all, in about ");
        assert!(refused.stderr.contains(&told), "{}", refused.stderr);
    }
}

/// The size is looked at before anything else is done: states are not interpolated, of which a warning would tell.
#[test]
fn the_size_of_an_export_comes_first() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let small =
        "export --quiet --design delta:55:24/6/1@925 --set time.duration-h=1 --as oem --out a";
    assert_eq!(ran(place, &line(small)).status, 0);
    let large = "export --constellation a/oem --set time.duration-h=0.9 --set time.step-s=0.001 --as oem,csv --out b";
    let refused = ran(place, &line(large));
    assert_eq!(refused.status, 2);
    assert!(
        refused
            .stderr
            .starts_with("error: the export would be about 27 files of "),
        "{}",
        refused.stderr
    );
}

/// A file of a run that is longer than any that a run writes is not read.
#[test]
fn files_of_a_run_are_read_up_to_a_bound() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    let bound = "the file is larger than ";
    for (name, command, status) in [
        ("front.json", "export --run run --as tle --out a", 2),
        ("history.json", "report run --out page.html", 0),
        ("run.json", "report run --out page.html", 0),
        ("checkpoint", "optimize --resume --out run", 0),
    ] {
        let path = place.join("run").join(name);
        let before = fs::read(&path).unwrap();
        let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
        file.set_len(2 << 30).unwrap();
        let ran = ran(place, &line(command));
        assert_eq!(ran.status, status, "{name}: {}", ran.stderr);
        assert!(ran.stderr.contains(bound), "{name}: {}", ran.stderr);
        fs::write(&path, before).unwrap();
    }
}

/// A checkpoint does not grow with the generations behind it, and the log beside it only as they do. A
/// hundred generations have the records of a front each; the lines of later ones are shorter.
#[test]
fn checkpoints_do_not_grow_with_the_generations() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let sizes = |generations: u32| {
        let generations = format!("optimizer.generations={generations}");
        let arguments = optimize(&["--out", "run", "--set", &generations]);
        assert_eq!(ran(place, &arguments).status, 0);
        ["checkpoint", "checkpoint.log"]
            .map(|name| fs::metadata(place.join("run").join(name)).unwrap().len() as f64)
    };
    let ([short, short_log], [long, long_log]) = (sizes(25), sizes(100));
    // The digits of the counters, and a population of other numbers.
    assert!((0.8..1.2).contains(&(long / short)), "{short} {long}");
    assert!(
        (2.0..6.0).contains(&(long_log / short_log)),
        "{short_log} {long_log}"
    );
}

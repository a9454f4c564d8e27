//! Ctrl-C at any moment of a search: what is finished stays, and the exit status is 130.

use crate::cli::{optimize, ran};
use crate::common::{self, contents, signal};
use std::fs;
use std::io::Read;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// Time within which a program that was told to stop is gone.
const SOON: Duration = Duration::from_secs(300);

fn started(directory: &Path, arguments: &[&str]) -> Child {
    common::started(directory, arguments, Stdio::piped)
}

/// Waits until something is there while the child works.
#[track_caller]
fn wait_for(child: &mut Child, path: &Path) {
    while !path.exists() {
        assert_eq!(child.try_wait().unwrap(), None, "it was too fast");
        std::thread::sleep(Duration::from_millis(1));
    }
}

fn interrupt(child: &Child) {
    signal(child, "INT");
}

/// The exit status and stderr of a child that was told to stop; its stdout is not read before.
#[track_caller]
fn ended(mut child: Child) -> (i32, String) {
    let since = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        if since.elapsed() > SOON {
            child.kill().unwrap();
            panic!("Ctrl-C did not end it");
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let mut stderr = String::new();
    child.stderr.unwrap().read_to_string(&mut stderr).unwrap();
    (status.code().unwrap(), stderr)
}

/// `optimize` without `--quiet`, to read the hints.
fn talking<'a>(further: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = optimize(further);
    arguments.retain(|argument| *argument != "--quiet");
    arguments
}

const LONG: [&str; 2] = ["--set", "optimizer.generations=100000"];
const STEPS: [&str; 4] = [
    "--set",
    "search.inclination-step-deg=10",
    "--set",
    "search.altitude-step-km=300",
];

/// Waits until a search has written a checkpoint. Its mark on the run is there before, and gone again at the end.
fn wait_for_checkpoint(child: &mut Child, run: &Path) {
    wait_for(child, &run.join(".lock"));
    let checkpoint = fs::read(run.join("checkpoint")).unwrap();
    while fs::read(run.join("checkpoint")).is_ok_and(|now| now == checkpoint) {
        assert_eq!(child.try_wait().unwrap(), None);
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// A finished run is repeated and interrupted: with the same budget nothing changes; with a larger one
/// the results stay, and the checkpoint goes on.
#[test]
fn a_finished_run_outlives_an_interrupted_repetition() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for further in [&[][..], &["--seeds", "2"], &["--certify"]] {
        let further = [further, &STEPS].concat();
        let whole = optimize(&[&["--out", "run"], further.as_slice()].concat());
        assert_eq!(ran(place, &whole).status, 0);
        let before = contents(place);
        let name = match further[0] {
            "--seeds" => "run/seed-1",
            _ => "run",
        };
        let run = place.join(name);
        for resume in [&[][..], &["--resume"]] {
            let more = [&["--out", "run"], further.as_slice(), &LONG, resume].concat();
            let mut child = started(place, &talking(&more));
            wait_for_checkpoint(&mut child, &run);
            interrupt(&child);
            let (status, stderr) = ended(child);
            assert_eq!(status, 130, "{further:?}: {stderr}");
            let kept = "keeps the results after generation 4 that it had\ncontinue with the same";
            assert!(stderr.contains(kept), "{further:?}: {stderr}");
            let mut after = contents(place);
            let mut expected = before.clone();
            for files in [&mut after, &mut expected] {
                files.retain(|path, _| !is_of_progress(path, Path::new(name)));
            }
            assert!(after == expected, "{further:?}");
        }
        // The whole is reached from what was left.
        let resumed = [&["--out", "run", "--resume"], further.as_slice(), &LONG].concat();
        let mut child = started(place, &talking(&resumed));
        wait_for_checkpoint(&mut child, &run);
        interrupt(&child);
        let (_, stderr) = ended(child);
        assert!(stderr.contains("resuming after generation "), "{stderr}");
        fs::remove_dir_all(place.join("run")).unwrap();
        let _ = fs::remove_dir_all(place.join("run-sweep"));
    }
}

/// Whether a file may change before the end: the checkpoints, and the scenario of a sweep, which is
/// finished and written anew with the budget that it does not use.
fn is_of_progress(path: &Path, run: &Path) -> bool {
    let name = path.file_name().unwrap().to_string_lossy();
    (path.starts_with(run) && name.starts_with("checkpoint"))
        || path == Path::new("run-sweep/scenario.toml")
}

/// With the same budget the repetition has nothing to add, and changes no byte before its end.
#[test]
fn a_repetition_that_is_interrupted_changes_nothing() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let longer = ["--out", "run", "--set", "optimizer.generations=300"];
    assert_eq!(ran(place, &optimize(&longer)).status, 0);
    let before = contents(place);
    for shorter in ["optimizer.generations=300", "optimizer.generations=299"] {
        // Between the lock and the search, Ctrl-C ends the program at once and without a word.
        let meets_the_search = || {
            let mut child = started(place, &talking(&["--out", "run", "--set", shorter]));
            wait_for(&mut child, &place.join("run/.lock"));
            interrupt(&child);
            let (status, stderr) = ended(child);
            assert_eq!(status, 130, "{stderr}");
            let kept = "run keeps the results after generation 300 that it had\n";
            assert!(stderr.is_empty() || stderr.ends_with(kept), "{stderr}");
            !stderr.is_empty()
        };
        assert!((0..20).any(|_| meets_the_search()));
        assert!(contents(place) == before);
    }
    // One that comes to its end replaces the run, checkpoints and all, by what it would be on its own.
    let short = |out| optimize(&["--out", out, "--set", "optimizer.generations=3"]);
    assert_eq!(ran(place, &short("run")).status, 0);
    assert_eq!(ran(place, &short("other")).status, 0);
    assert!(contents(&place.join("run")) == contents(&place.join("other")));
}

/// Two generations of some time each, so that Ctrl-C meets the second, which is the last.
const SLOW: [&str; 8] = [
    "--set",
    "optimizer.generations=2",
    "--set",
    "optimizer.population=60",
    "--set",
    "time.step-s=120",
    "--threads",
    "1",
];

/// Ctrl-C in the last generation: the results are complete, and the status still says that it was
/// pressed. No further seed is begun.
#[test]
fn ctrl_c_in_the_last_generation_is_not_swallowed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for (further, run, next) in [
        (&[][..], "run", "complete results: run\n"),
        (&["--seeds", "2"], "run/seed-1", "run/seed-1\ncontinue with"),
    ] {
        let arguments = [&["--out", "run"], SLOW.as_slice(), further].concat();
        let mut child = started(place, &talking(&arguments));
        wait_for(&mut child, &place.join(run).join("checkpoint"));
        interrupt(&child);
        let (status, stderr) = ended(child);
        assert_eq!(status, 130, "{stderr}");
        let expected = "interrupted after generation 2 of 2; complete results: ";
        assert!(
            stderr.contains(expected) && stderr.contains(next),
            "{stderr}"
        );
        assert!(place.join(run).join("front.json").exists());
        assert!(!place.join("run/seed-2").exists() && !place.join("run/seeds.csv").exists());
        fs::remove_dir_all(place.join("run")).unwrap();
    }
}

/// Ctrl-C after the results are in their place, while they are printed to a reader that does not read.
#[test]
fn ctrl_c_after_the_search_ends_the_program() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let large = [
        "--out",
        "run",
        "--format",
        "json",
        "--set",
        "optimizer.population=900",
        "--set",
        "objectives.minimize=[\"mean-pdop\", \"launch-cost\"]",
        "--set",
        "objectives.hypervolume-reference=[9, 9]",
    ];
    let arguments = talking(&large);
    let mut child = started(place, &arguments);
    wait_for(&mut child, &place.join("run/front.json"));
    // More than a pipe holds.
    let front = fs::metadata(place.join("run/front.json")).unwrap();
    assert!(front.len() > 70_000, "{}", front.len());
    std::thread::sleep(Duration::from_millis(200));
    interrupt(&child);
    let (status, stderr) = ended(child);
    assert_eq!(status, 130, "{stderr}");
    assert!(!stderr.contains("stopping after"), "{stderr}");
    assert!(!place.join("run/.lock").exists());
}

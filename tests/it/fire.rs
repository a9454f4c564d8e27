//! The program under fire: killed at any moment, given places that it cannot have.

use crate::cli::{optimize, ran};
use crate::common;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

fn started(directory: &Path, arguments: &[&str]) -> Child {
    common::started(directory, arguments, Stdio::null)
}

/// Names in a directory, sorted.
fn names(directory: &Path) -> Vec<String> {
    let entries = fs::read_dir(directory).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let mut names: Vec<String> = names.collect();
    names.sort();
    names
}

fn line(text: &str) -> Vec<&str> {
    text.split(' ').collect()
}

const EXPORT: &str = "export --quiet --design delta:55:24/6/1@925 --as oem,stk,sp3 --out a";

/// Waits for a staged directory beside the place of an export, then kills.
#[cfg(unix)]
fn killed_while_staged(place: &Path, name: &str) -> i32 {
    let mut child = started(place, &line(EXPORT));
    while !names(place)
        .iter()
        .any(|name| name.starts_with(".a.navwalker-"))
    {
        assert_eq!(child.try_wait().unwrap(), None, "the export was too fast");
        std::thread::sleep(Duration::from_millis(1));
    }
    common::signal(&child, name);
    child.wait().unwrap().code().unwrap_or(-1)
}

#[cfg(unix)]
#[test]
fn ctrl_c_leaves_nothing() {
    let directory = TempDir::new().unwrap();
    assert_eq!(killed_while_staged(directory.path(), "INT"), 130);
    assert_eq!(names(directory.path()), [""; 0]);
}

/// What a kill leaves is in nobody's way: the next export has only its own files, and removes it.
#[cfg(unix)]
#[test]
fn what_a_kill_leaves_is_removed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    killed_while_staged(place, "KILL");
    assert_eq!(names(place).len(), 1);
    // Files of users, and a link, that only look alike.
    fs::write(place.join(".a.navwalker-notes"), "mine").unwrap();
    fs::create_dir(place.join("precious")).unwrap();
    fs::write(place.join("precious/file"), "mine").unwrap();
    let link = place.join(".a.navwalker-abcdefghijkl");
    std::os::unix::fs::symlink("precious", &link).unwrap();
    assert_eq!(ran(place, &line(EXPORT)).status, 0);
    let expected = [
        ".a.navwalker-abcdefghijkl",
        ".a.navwalker-notes",
        "a",
        "precious",
    ];
    assert_eq!(names(place), expected);
    assert_eq!(names(&place.join("precious")), ["file"]);
    assert!(
        !names(&place.join("a"))
            .iter()
            .any(|name| name.starts_with('.'))
    );
}

/// A staged file that its writer still holds is not taken for stale.
#[test]
fn what_is_being_written_stays() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let held = place.join(".a.navwalker-abcdefghijkl");
    fs::create_dir(&held).unwrap();
    let lock = fs::File::open(&held).unwrap();
    lock.try_lock().unwrap();
    assert_eq!(ran(place, &line(EXPORT)).status, 0);
    assert!(held.exists());
    drop(lock);
    assert_eq!(ran(place, &line(&format!("{EXPORT} --force"))).status, 0);
    assert_eq!(names(place), ["a"]);
}

/// A search that is killed at any of its moments resumes to the bytes of one that was not.
#[test]
fn a_search_resumes_wherever_it_is_killed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for further in [&[][..], &["--seeds", "2"], &["--certify"]] {
        let steps = [
            "--set",
            "search.inclination-step-deg=10",
            "--set",
            "search.altitude-step-km=300",
        ];
        let further = [further, &steps].concat();
        let whole = optimize(&[&["--out", "whole"], further.as_slice()].concat());
        assert_eq!(ran(place, &whole).status, 0);
        let broken = optimize(&[&["--out", "broken", "--resume"], further.as_slice()].concat());
        // Each time a little further: from before the directory is there to the end.
        for milliseconds in (1..400).step_by(7) {
            let mut child = started(place, &broken);
            std::thread::sleep(Duration::from_millis(milliseconds));
            child.kill().unwrap();
            if child.wait().unwrap().success() {
                break;
            }
        }
        let resumed = ran(place, &broken);
        assert_eq!(resumed.status, 0, "{further:?}: {}", resumed.stderr);
        for (one, other) in [("whole", "broken"), ("whole-sweep", "broken-sweep")] {
            let (one, other) = (place.join(one), place.join(other));
            if one.exists() {
                assert_same(&one, &other);
                fs::remove_dir_all(one).unwrap();
                fs::remove_dir_all(other).unwrap();
            }
        }
        assert_eq!(names(place), [""; 0], "{further:?}");
    }
}

fn assert_same(one: &Path, other: &Path) {
    assert_eq!(names(one), names(other), "{}", other.display());
    for name in names(one) {
        let (one, other) = (one.join(&name), other.join(&name));
        if one.is_dir() {
            assert_same(&one, &other);
        } else {
            assert!(
                fs::read(one).unwrap() == fs::read(&other).unwrap(),
                "{}",
                other.display()
            );
        }
    }
}

/// What a kill leaves before the first checkpoint, and between the renames of a checkpoint.
#[test]
fn a_run_without_a_checkpoint_resumes() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    let front = fs::read(place.join("run/front.json")).unwrap();
    for lost in [&["checkpoint"][..], &["checkpoint", "checkpoint.previous"]] {
        for name in lost {
            fs::remove_file(place.join("run").join(name)).unwrap();
        }
        fs::write(place.join("run/.checkpoint.navwalker-abcdefghijkl"), "half").unwrap();
        let log = place.join("run/checkpoint.log");
        let begun = fs::read_to_string(&log).unwrap() + "{\"generation\":";
        fs::write(&log, begun).unwrap();
        let resumed = ran(place, &optimize(&["--out", "run", "--resume"]));
        assert_eq!(resumed.status, 0, "{}", resumed.stderr);
        assert!(fs::read(place.join("run/front.json")).unwrap() == front);
        let left = names(&place.join("run"));
        assert!(!left.iter().any(|name| name.starts_with('.')), "{left:?}");
    }
}

/// What users put beside a run, before it and while it works, stays.
#[test]
fn what_lies_beside_a_run_stays() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    fs::create_dir(place.join("run/notes")).unwrap();
    fs::write(place.join("run/notes/one.txt"), "mine").unwrap();
    let longer = [
        "--out",
        "run",
        "--resume",
        "--set",
        "optimizer.generations=400",
    ];
    let mut child = started(place, &optimize(&longer));
    while !place.join("run/.lock").exists() {
        assert_eq!(child.try_wait().unwrap(), None);
        std::thread::sleep(Duration::from_millis(1));
    }
    fs::write(place.join("run/two.txt"), "mine too").unwrap();
    assert!(child.wait().unwrap().success());
    assert_eq!(
        fs::read_to_string(place.join("run/notes/one.txt")).unwrap(),
        "mine"
    );
    assert_eq!(
        fs::read_to_string(place.join("run/two.txt")).unwrap(),
        "mine too"
    );
    let history = fs::read_to_string(place.join("run/history.csv")).unwrap();
    assert_eq!(history.lines().count(), 1 + 400);
}

/// A second process in the same run gets an error that names the first.
#[cfg(unix)]
#[test]
fn a_run_has_one_process() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let long = ["--out", "run", "--set", "optimizer.generations=100000"];
    let mut child = started(place, &optimize(&long));
    while !place.join("run/.lock").exists() {
        std::thread::sleep(Duration::from_millis(1));
    }
    std::thread::sleep(Duration::from_millis(50));
    for further in ["--resume", "--force"] {
        let second = ran(place, &optimize(&["--out", "run", further]));
        assert_eq!(second.status, 2, "{}", second.stderr);
        let message = format!("run is in use: process {} works in it", child.id());
        assert!(second.stderr.contains(&message), "{}", second.stderr);
    }
    child.kill().unwrap();
    child.wait().unwrap();
    // A process that is gone holds nothing.
    let next = ran(place, &optimize(&["--out", "run"]));
    assert_eq!(next.status, 0, "{}", next.stderr);
    assert!(!place.join("run/.lock").exists());
}

/// A place that cannot be had is found before the work, and nothing is left of the attempt.
#[test]
fn a_place_is_tried_before_the_work() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(place.join("file"), "mine").unwrap();
    let too_long = "x".repeat(300);
    // The work would take hours.
    let long = ["--set", "optimizer.generations=100000", "--out"];
    for (out, message) in [
        (
            "file",
            "is a file or lies in one, and a directory is needed",
        ),
        (
            "file/run",
            "is a file or lies in one, and a directory is needed",
        ),
        (too_long.as_str(), "too long"),
        ("/proc/self/run", "cannot"),
        ("/proc", "something other than a run"),
    ] {
        let optimized = ran(place, &[optimize(&[]), long.to_vec(), vec![out]].concat());
        assert_eq!(optimized.status, 2, "{out}: {}", optimized.stderr);
        assert!(
            optimized.stderr.contains(message),
            "{out}: {}",
            optimized.stderr
        );
        let evaluate = "evaluate --design delta:55:182/13/1@925 --set time.step-s=0.2 --set \
                        region.step-deg=2 --force --series";
        let evaluated = ran(place, &[line(evaluate), vec![out]].concat());
        assert_eq!(
            (evaluated.status, evaluated.stdout.as_str()),
            (2, ""),
            "{out}"
        );
    }
    assert_eq!(names(place), ["file"]);
    assert_eq!(fs::read_to_string(place.join("file")).unwrap(), "mine");
}

/// A run with a sweep, metrics, element sets, a scenario and a repository.
fn make_inputs(place: &Path) {
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    fs::create_dir(place.join("run-sweep")).unwrap();
    fs::copy(
        place.join("run/front.json"),
        place.join("run-sweep/front.json"),
    )
    .unwrap();
    let metrics = "export --quiet --run run --as metrics --out maps";
    assert_eq!(ran(place, &line(metrics)).status, 0);
    fs::write(place.join("study.toml"), "name = \"mine\"\n").unwrap();
    let tle = "export --quiet --design delta:55:24/6/1@925 --as tle --out fleet/of/us";
    assert_eq!(ran(place, &line(tle)).status, 0);
    fs::create_dir_all(place.join("repository/.git")).unwrap();
    fs::create_dir_all(place.join("inside")).unwrap();
}

/// Inputs are not outputs: whatever `--force` says, they stay.
#[test]
fn inputs_stay() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    make_inputs(place);
    let all = || -> Vec<_> {
        let mut all = Vec::new();
        let mut waiting = vec![place.to_owned()];
        while let Some(next) = waiting.pop() {
            for name in names(&next) {
                let path = next.join(name);
                all.push((path.clone(), fs::read(&path).unwrap_or_default()));
                if path.is_dir() {
                    waiting.push(path);
                }
            }
        }
        all
    };
    let before = all();
    let export = "export --run run --as tle --force --out";
    let evaluate = "evaluate --constellation fleet/of/us/constellation.tle --force --series";
    for (command, message) in [
        (
            "report run --out run/front.json".to_owned(),
            "is inside the input run",
        ),
        (
            "plot run --figure pareto --out run/front.svg".to_owned(),
            "is inside the input run",
        ),
        (
            "plot run --figure pareto --force --out run/history.svg".to_owned(),
            "is inside the input run",
        ),
        (
            "plot run --figure pareto --force --out run-sweep/front.svg".to_owned(),
            "is inside the input run-sweep",
        ),
        // A file that --set names beside --run.
        (
            "export --run run --set region.points=../maps/metrics/points.csv --as metrics --force --out maps"
                .to_owned(),
            "maps contains the input run/../maps/metrics/points.csv",
        ),
        (
            format!("{export} run"),
            "contains files that this command did not write",
        ),
        (format!("{export} run/new"), "is inside the input run"),
        (format!("{export} ."), "contains the working directory"),
        (format!("{export} /"), "is the root of the file system"),
        (format!("{export} repository"), "it is a repository"),
        (
            "optimize --force --out .".to_owned(),
            "contains the working directory",
        ),
        (
            format!("{evaluate} fleet"),
            "contains files that this command did not write",
        ),
        (
            format!("{evaluate} fleet/of/us"),
            "contains files that this command did not write",
        ),
        (
            "export study.toml --as tle --out study.toml".to_owned(),
            "a directory is needed",
        ),
    ] {
        let refused = ran(place, &line(&command));
        assert_eq!(refused.status, 2, "{command}: {}", refused.stderr);
        assert!(
            refused.stderr.contains(message),
            "{command}: {}",
            refused.stderr
        );
    }
    // An empty directory may be replaced, but not the one that the program stands in.
    let inside = place.join("inside");
    let refused = ran(&inside, &line("export --as tle --out ."));
    assert!(
        refused.stderr.contains("the working directory"),
        "{}",
        refused.stderr
    );
    assert!(all() == before);
    // The program's own places in a run are not inputs.
    for command in [
        "report run --out run/report.html",
        "plot run --figure pareto --out run/figures/pareto.svg",
        "validate --run run --against sgp4 --out run/validation",
    ] {
        let done = ran(place, &line(command));
        assert_eq!(done.status, 0, "{command}: {}", done.stderr);
    }
}

/// The table of a figure takes no name that exists with other contents, unless that is said.
#[test]
fn the_table_of_a_figure_replaces_nothing() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    fs::write(place.join("front.csv"), "mine").unwrap();
    let plot = line("plot run --figure pareto --out front.svg");
    let refused = ran(place, &plot);
    assert_eq!(refused.status, 2);
    assert!(
        refused
            .stderr
            .contains("front.csv, which contains something else"),
        "{}",
        refused.stderr
    );
    assert_eq!(names(place), ["front.csv", "run"]);
    assert_eq!(fs::read_to_string(place.join("front.csv")).unwrap(), "mine");
    assert_eq!(
        ran(place, &[plot.clone(), vec!["--force"]].concat()).status,
        0
    );
    // Its own table does not stop it.
    assert_eq!(ran(place, &plot).status, 0);
}

/// `--force` says what it would delete that this program did not write, and stops.
#[test]
fn force_replaces_only_what_was_written() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let forced = line("export --quiet --design delta:55:24/6/1@925 --as oem --force --out a");
    assert_eq!(ran(place, &forced).status, 0);
    assert_eq!(ran(place, &forced).status, 0);
    fs::write(place.join("a/oem/notes.txt"), "mine").unwrap();
    let refused = ran(place, &forced);
    assert_eq!(refused.status, 2);
    assert!(
        refused
            .stderr
            .contains("--force would delete them: oem/notes.txt;"),
        "{}",
        refused.stderr
    );
    assert!(place.join("a/oem/notes.txt").exists());
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    fs::write(place.join("run/notes.txt"), "mine").unwrap();
    let refused = ran(
        place,
        &optimize(&["--out", "run", "--seed", "2", "--force"]),
    );
    assert_eq!(refused.status, 2);
    assert!(
        refused.stderr.contains("would delete them: notes.txt;"),
        "{}",
        refused.stderr
    );
}

/// A link as output keeps being one, and what it leads to is written.
#[cfg(unix)]
#[test]
fn a_link_as_output_stays_a_link() {
    use std::os::unix::fs::symlink;
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::create_dir(place.join("disk")).unwrap();
    symlink("disk/run", place.join("run")).unwrap();
    symlink("disk/page.html", place.join("page.html")).unwrap();
    for _ in 0..2 {
        assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
        assert_eq!(ran(place, &line("report run --out page.html")).status, 0);
    }
    assert!(place.join("run").is_symlink() && place.join("page.html").is_symlink());
    assert!(place.join("disk/run/front.json").exists());
    assert_eq!(names(&place.join("disk")), ["page.html", "run"]);
    assert_eq!(names(place), ["disk", "page.html", "run"]);
}

/// A checkpoint that is whole but of other lengths is refused, not run into.
#[test]
fn a_checkpoint_of_other_lengths_is_refused() {
    use sha2::{Digest, Sha256};
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    assert_eq!(ran(place, &optimize(&["--out", "run"])).status, 0);
    let path = place.join("run/checkpoint");
    let text = fs::read_to_string(&path).unwrap();
    let (header, state) = text.split_once('\n').unwrap();
    let sha256 = |text: &str| -> String {
        let sum = Sha256::digest(text.as_bytes());
        sum.iter().map(|byte| format!("{byte:02x}")).collect()
    };
    let mut damaged = Vec::new();
    for pointer in [
        "/nsga2/population/0/genome",
        "/nsga2/population/0/objectives",
    ] {
        let mut header: serde_json::Value = serde_json::from_str(header).unwrap();
        let mut state: serde_json::Value = serde_json::from_str(state).unwrap();
        state
            .pointer_mut(pointer)
            .unwrap()
            .as_array_mut()
            .unwrap()
            .pop();
        let state = state.to_string();
        header["sha256"] = sha256(&state).into();
        damaged.push(format!("{header}\n{state}\n"));
    }
    // A step less in the log.
    let log = fs::read_to_string(place.join("run/checkpoint.log")).unwrap();
    let lines: Vec<&str> = log.split_inclusive('\n').collect();
    let mut shorter: serde_json::Value = serde_json::from_str(header).unwrap();
    assert_eq!(shorter["records"], lines.len());
    shorter["records"] = (lines.len() - 1).into();
    shorter["records_sha256"] = sha256(&lines[..lines.len() - 1].concat()).into();
    damaged.push(format!("{shorter}\n{state}"));
    for text in damaged {
        fs::write(&path, &text).unwrap();
        let refused = ran(place, &optimize(&["--out", "run", "--resume"]));
        assert_eq!(refused.status, 2, "{text}: {}", refused.stderr);
        let message = "run contains a checkpoint of another search";
        assert!(
            refused.stderr.contains(message),
            "{text}: {}",
            refused.stderr
        );
    }
    // A log that has not what the checkpoints say.
    fs::write(&path, &text).unwrap();
    fs::write(place.join("run/checkpoint.log"), log.replace('1', "2")).unwrap();
    let refused = ran(place, &optimize(&["--out", "run", "--resume"]));
    let message = "the log of its steps is missing or does not match, and no earlier checkpoint";
    assert_eq!(refused.status, 2, "{}", refused.stderr);
    assert!(refused.stderr.contains(message), "{}", refused.stderr);
}

/// Directories that are not there are made for a file, as for a directory, and go again if the command fails; where they
/// cannot be made, the message does not name a staging file.
#[test]
fn missing_directories_are_made() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let of = "--set region.step-deg=20 --set time.duration-h=1 --design delta:55:6/3/1@925";
    for command in [
        format!("plot --figure cdf --measure mean-visible {of} --out none/so/far"),
        format!("report {of} --out none/so/far.html"),
    ] {
        let failed = ran(place, &line(&command.replace("6/3/1", "6/4/1")));
        assert_eq!(failed.status, 2);
        assert!(names(place).is_empty(), "{:?}", names(place));
        let made = ran(place, &line(&command));
        assert_eq!(made.status, 0, "{}", made.stderr);
        fs::remove_dir_all(place.join("none")).unwrap();
        fs::write(place.join("none"), "a file").unwrap();
        let refused = ran(place, &line(&command));
        assert_eq!(refused.status, 2);
        assert!(refused.stderr.contains("none"), "{}", refused.stderr);
        assert!(
            !refused.stderr.contains(".navwalker-"),
            "{}",
            refused.stderr
        );
        fs::remove_file(place.join("none")).unwrap();
    }
}

/// The manifest of an export that is compared with leads nowhere else.
#[test]
fn a_manifest_stays_in_its_directory() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let export = line("export --quiet --design delta:55:6/3/1@925 --as tle --out a");
    assert_eq!(ran(place, &export).status, 0);
    fs::rename(
        place.join("a/constellation.tle"),
        place.join("constellation.tle"),
    )
    .unwrap();
    let manifest = fs::read_to_string(place.join("a/manifest.json")).unwrap();
    for path in [
        "../constellation.tle".to_owned(),
        place.join("constellation.tle").display().to_string(),
    ] {
        let other = manifest.replace("\"constellation.tle\"", &format!("\"{path}\""));
        assert!(other != manifest);
        fs::write(place.join("a/manifest.json"), other).unwrap();
        let refused = ran(
            place,
            &line("validate --design delta:55:6/3/1@925 --against ./a"),
        );
        assert_eq!(refused.status, 2, "{}{}", refused.stdout, refused.stderr);
        assert!(
            refused.stderr.contains("which is outside the directory"),
            "{}",
            refused.stderr
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn help_to_a_full_device_fails() {
    let program = assert_cmd::cargo::cargo_bin!("navwalker");
    for arguments in [
        &["--help"][..],
        &["optimize", "--help"],
        &["--version"],
        &["scenario", "list"],
    ] {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = Command::new(program)
            .args(arguments)
            .stdout(full)
            .output()
            .unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(!output.stderr.is_empty(), "{arguments:?}");
    }
}

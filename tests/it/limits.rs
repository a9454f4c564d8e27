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
            "evaluate --design delta:55:4/2/1@925 --set time.duration-h=168 --set region.step-deg=0.5 \
             --set region.latitude-deg=[-90,90] --set region.longitude-deg=[-180,180]",
            "259920 points x 10080 instants are 2.6e9 samples; one evaluation of 200 satellites takes about ",
        ),
        (
            "optimize --out run --set time.duration-h=168 --set region.step-deg=0.5 \
             --set region.latitude-deg=[-90,90] --set region.longitude-deg=[-180,180]",
            "More than 1e9 need --allow-large, or evaluate --tile I/N, or use a coarser region.step-deg or time.step-s",
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

/// A globe at two degrees by a minute over 44 days: it is refused whole, and a tile of it is told and evaluated.
#[test]
fn a_scenario_of_any_size_goes_in_tiles() {
    let directory = TempDir::new().unwrap();
    let globe = "evaluate --design delta:55:4/2/1@925 --set time.duration-h=1056 --set region.step-deg=2 \
         --set region.latitude-deg=[-90,90] --set region.longitude-deg=[-180,180] --set gnss.constellations=[] --threads 1";
    let ran = |further: &str| ran(directory.path(), &line(&format!("{globe}{further}")));
    let whole = ran("");
    assert_eq!(whole.status, 2);
    let told = "16380 points x 63360 instants are 1.0e9 samples";
    assert!(whole.stderr.contains(told), "{}", whole.stderr);
    let tile = ran(" --tile 63360/63360 --out last.tile");
    assert_eq!(tile.status, 0, "{}", tile.stderr);
    let told = format!("{told} in 63360 tiles: one takes less than 1 s here, ");
    assert!(tile.stderr.contains(&told), "{}", tile.stderr);
    // Of the last instant, four bytes for each point, rounded up to sixteen of them, between two lines.
    let bytes = fs::metadata(directory.path().join("last.tile"))
        .unwrap()
        .len();
    assert!((4 * 16_380..4 * 16_396 + 4096).contains(&bytes), "{bytes}");
}

/// The most memory that a process has had so far, bytes: the kernel says it while the process lives.
#[cfg(target_os = "linux")]
fn peak_bytes(words: &str) -> (u64, String) {
    use std::process::Stdio;
    let directory = TempDir::new().unwrap();
    let mut child = crate::common::started(directory.path(), &line(words), Stdio::piped);
    let mut peak = 0;
    let status = format!("/proc/{}/status", child.id());
    while child.try_wait().unwrap().is_none() {
        let text = fs::read_to_string(&status).unwrap_or_default();
        let found = text.lines().find_map(|line| line.strip_prefix("VmHWM:"));
        let kib = found.and_then(|text| text.trim().strip_suffix("kB")?.trim().parse().ok());
        peak = peak.max(kib.map_or(0, |kib: u64| kib * 1024));
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    let output = child.wait_with_output().unwrap();
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{words}: {stderr}");
    (peak, stderr)
}

/// What is told before the work is what the work takes, of a globe of one degree: as a tile, with the GNSS, whose sums are not kept, and as a
/// stream of more values than are kept. The program itself has 36 MB beside it, and an allocator keeps some more; two thirds of what is told may not be needed.
#[cfg(target_os = "linux")]
#[test]
fn the_memory_that_is_told_is_the_memory_that_is_taken() {
    use navwalker::scenario::Scenario;
    let keys = [
        ("region.step-deg", "1"),
        ("region.latitude-deg", "[-90,90]"),
        ("region.longitude-deg", "[-180,180]"),
        ("time.step-s", "1080"),
    ];
    let set = keys.map(|(key, value)| format!("--set {key}={value}"));
    let globe = format!(
        "evaluate --design delta:55:4/2/1@925 --threads 2 {}",
        set.join(" ")
    );
    let check = |words: &str, told: u64, taken: u64| {
        let most = told + told / 4 + 60_000_000;
        assert!(taken <= most, "{words}: {told} told, {taken} taken");
        assert!(3 * taken >= told, "{words}: {told} told, {taken} taken");
    };
    let tile = format!("{globe} --tile 1/10 --out a.tile");
    let (taken, stderr) = peak_bytes(&tile);
    let told = stderr.split(" MB of memory").next().unwrap();
    let told: u64 = told.rsplit(' ').next().unwrap().parse().unwrap();
    check(&tile, told * 1_000_000, taken);
    let mut overrides = keys.map(|(key, value)| format!("{key}={value}")).to_vec();
    overrides.push("gnss.constellations=[]".to_owned());
    let scenario = Scenario::parse(
        "paper",
        navwalker::scenario::builtin("paper").unwrap().as_bytes(),
        &overrides,
    )
    .unwrap();
    let setup = scenario.setup(&|_| unreachable!()).unwrap();
    assert!(setup.sample_count() > 4 << 20, "it is a stream");
    let globe = format!("{globe} --set gnss.constellations=[]");
    let (taken, _) = peak_bytes(&globe);
    check(&globe, setup.memory_bytes(2, 1), taken);
}

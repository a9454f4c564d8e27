//! What is looked at: reports, figures, pages of help.

use assert_cmd::Command;
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

fn navwalker(directory: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::cargo_bin("navwalker").unwrap();
    command
        .current_dir(directory)
        .args(arguments)
        .output()
        .unwrap()
}

fn stdout(output: &Output) -> String {
    assert_eq!(
        output.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// A run of a fraction of a second, with its report and a validation.
fn small_run() -> TempDir {
    let directory = TempDir::new().unwrap();
    let small = [
        "region.step-deg=20",
        "time.step-s=1800",
        "optimizer.population=8",
        "optimizer.generations=4",
        "search.planes=[5, 7]",
        "search.satellites-per-plane=[5, 7]",
    ];
    let mut arguments = vec!["optimize", "--quiet", "--out", "run", "--report"];
    arguments.extend(small.iter().flat_map(|set| ["--set", set]));
    let printed = stdout(&navwalker(directory.path(), &arguments));
    assert!(printed.contains("j-cost over j-pos"), "{printed}");
    directory
}

#[test]
fn a_validation_comes_into_the_report_of_its_run() {
    let directory = small_run();
    let page = directory.path().join("run/report.html");
    let check = "sgp4/rates/node/mean-j2";
    assert!(!fs::read_to_string(&page).unwrap().contains(check));
    let validate = ["validate", "--run", "run", "--against", "sgp4", "--report"];
    stdout(&navwalker(directory.path(), &validate));
    assert!(fs::read_to_string(&page).unwrap().contains(check));
    let kept = directory.path().join("run/validation/report.json");
    assert!(kept.exists());
    // What is there is not replaced unasked.
    let again = navwalker(directory.path(), &validate);
    assert_eq!(again.status.code(), Some(2));
    let forced = [&validate[..], &["--force"]].concat();
    stdout(&navwalker(directory.path(), &forced));
}

#[test]
fn a_report_is_written_and_repeats() {
    let directory = small_run();
    let page = directory.path().join("run/report.html");
    let first = fs::read_to_string(&page).unwrap();
    assert!(first.starts_with("<!DOCTYPE html>") && first.trim_end().ends_with("</html>"));
    let printed = stdout(&navwalker(directory.path(), &["report", "run"]));
    assert_eq!(printed.trim(), "run/report.html");
    assert!(
        fs::read_to_string(&page).unwrap() == first,
        "the bytes differ"
    );
    // Nothing of this machine is in the page.
    assert!(!first.contains(directory.path().to_str().unwrap()));

    let elsewhere = [
        "report",
        "run",
        "--out",
        "other.html",
        "--compare",
        "star:86.4:24/6/1@900",
        "--front",
        "run",
    ];
    stdout(&navwalker(directory.path(), &elsewhere));
    let other = fs::read_to_string(directory.path().join("other.html")).unwrap();
    assert!(other.contains("star:86.4:24/6/1@900") && other.contains("front of NSGA-II"));
}

#[test]
fn a_damaged_run_is_reported_with_its_gaps() {
    let directory = small_run();
    let run = directory.path().join("run");
    fs::write(run.join("history.json"), "[{").unwrap();
    fs::remove_file(run.join("scenario.toml")).unwrap();
    let output = navwalker(directory.path(), &["report", "run"]);
    stdout(&output);
    let warned = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        warned.contains("history.json is damaged") && warned.contains("scenario.toml is missing")
    );
    let page = fs::read_to_string(run.join("report.html")).unwrap();
    assert!(page.contains("history.json is damaged") && page.contains("id=\"pareto\""));

    fs::remove_file(run.join("front.json")).unwrap();
    fs::remove_file(run.join("history.json")).unwrap();
    let output = navwalker(directory.path(), &["report", "run"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("is not a run directory"));
}

#[test]
fn every_figure_is_drawn_with_its_table() {
    let directory = small_run();
    let validate = [
        "validate",
        "--quiet",
        "--run",
        "run",
        "--against",
        "sgp4",
        "--out",
        "run/validation",
    ];
    navwalker(directory.path(), &validate);
    for (figure, column) in [
        ("pareto", "j_pos"),
        ("map", "longitude_deg"),
        ("cdf", "share"),
        ("series", "elapsed_s"),
        ("convergence", "evaluations"),
        ("budget", "rms_in_track_km"),
    ] {
        for form in ["svg", "png"] {
            let out = format!("{figure}.{form}");
            let printed = stdout(&navwalker(
                directory.path(),
                &["plot", "run", "--figure", figure, "--out", &out],
            ));
            assert_eq!(printed, format!("{out}\n{figure}.csv\n"));
            let bytes = fs::read(directory.path().join(&out)).unwrap();
            let magic: &[u8] = if form == "svg" { b"<svg" } else { b"\x89PNG" };
            assert!(bytes.starts_with(magic), "{out}");
        }
        let table = fs::read_to_string(directory.path().join(format!("{figure}.csv"))).unwrap();
        assert!(
            table
                .lines()
                .next()
                .unwrap()
                .split(',')
                .any(|name| name == column),
            "{table}"
        );
        assert!(table.lines().count() > 1);
        let printed = stdout(&navwalker(
            directory.path(),
            &["plot", "run", "--figure", figure, "--as", "csv"],
        ));
        assert_eq!(printed, table);
    }
}

#[test]
fn figures_that_are_not_there_say_why() {
    let directory = small_run();
    let refused = |arguments: &[&str]| {
        let output = navwalker(directory.path(), &[&["plot", "run"], arguments].concat());
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        String::from_utf8(output.stderr).unwrap()
    };
    for (arguments, expected) in [
        (
            ["--figure", "budget", "--as", "svg"].as_slice(),
            "no validation against SGP4",
        ),
        (
            &["--figure", "map", "--measure", "pdop"],
            "it shows mean-visible, mean-pdop",
        ),
        (
            &["--figure", "series", "--measure", "availability"],
            "figure series cannot show availability",
        ),
        (&["--figure", "maps"], "did you mean \"map\"?"),
        (
            &["--figure", "map", "--pick", "99"],
            "cannot pick 99: the front has",
        ),
        (&["--figure", "map", "--out", "map.gif"], "use --as"),
        (
            &["--figure", "map", "--out", "nowhere/map.svg"],
            "nowhere/map.svg",
        ),
    ] {
        let stderr = refused(arguments);
        assert!(
            stderr.contains(expected),
            "{expected:?} is not in: {stderr}"
        );
    }
}

#[test]
fn help_can_be_read_and_completed() {
    let directory = TempDir::new().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let script = stdout(&navwalker(directory.path(), &["completions", shell]));
        assert!(
            script.contains("navwalker") && script.contains("optimize"),
            "{shell}"
        );
    }
    let page = stdout(&navwalker(directory.path(), &["man"]));
    assert!(page.contains(".TH navwalker 1"), "{page}");
    let page = stdout(&navwalker(directory.path(), &["man", "optimize"]));
    assert!(page.contains("navwalker\\-optimize") && page.contains("Example:"));
    let names = stdout(&navwalker(directory.path(), &["man", "--out", "man"]));
    for name in names.lines() {
        assert!(directory.path().join("man").join(name).exists(), "{name}");
    }
    assert!(names.lines().any(|name| name == "navwalker-report.1"));
    assert_eq!(
        navwalker(directory.path(), &["man", "optimise"])
            .status
            .code(),
        Some(2)
    );
}

/// Without a terminal there are no colours, whatever the options.
#[test]
fn no_terminal_means_no_colours() {
    let directory = TempDir::new().unwrap();
    for arguments in [
        ["report", "nowhere"].as_slice(),
        &["--no-color", "report", "nowhere"],
        &["frobnicate"],
    ] {
        let output = navwalker(directory.path(), arguments);
        assert_eq!(output.status.code(), Some(2));
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert!(
            stderr.starts_with("error:") && !stderr.contains('\u{1b}'),
            "{stderr:?}"
        );
    }
}

/// A terminal has colours; `--no-color` and NO_COLOR take them away.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_has_colours_unless_told_otherwise() {
    let program = assert_cmd::cargo::cargo_bin!("navwalker");
    let coloured = |arguments: &str, no_color: bool| {
        let mut script = std::process::Command::new("script");
        script.args([
            "-qec",
            &format!("{} {arguments}", program.display()),
            "/dev/null",
        ]);
        script.env("TERM", "xterm-256color").env_remove("NO_COLOR");
        if no_color {
            script.env("NO_COLOR", "1");
        }
        let output = script.output().unwrap();
        String::from_utf8_lossy(&output.stdout).contains("\u{1b}[")
    };
    for arguments in ["report nowhere", "frobnicate"] {
        assert!(coloured(arguments, false), "{arguments}");
        assert!(
            !coloured(&format!("--no-color {arguments}"), false),
            "{arguments}"
        );
        assert!(!coloured(arguments, true), "{arguments}");
    }
}

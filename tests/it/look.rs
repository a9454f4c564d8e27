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
        "--design",
        "beside=star:86.4:24/6/1@900",
        "--front",
        "run",
    ];
    stdout(&navwalker(directory.path(), &elsewhere));
    let other = fs::read_to_string(directory.path().join("other.html")).unwrap();
    assert!(other.contains("star:86.4:24/6/1@900") && other.contains("front of NSGA-II"));
    assert!(other.contains("<bdi>beside</bdi>") && other.contains("<bdi>reference design</bdi>"));
}

/// Two constellations in a coarse scenario: a design and its satellites from a file, moved to another altitude.
const TWO: [&str; 8] = [
    "--set",
    "region.step-deg=20",
    "--set",
    "time.step-s=3600",
    "--design",
    "ours=delta:55:36/6/1@900+star:90:12/3/1@800",
    "--constellation",
    "theirs=theirs/elements.csv",
];

/// A directory with the satellites of another constellation in it.
fn with_theirs() -> TempDir {
    let directory = TempDir::new().unwrap();
    let export = [
        "export",
        "--quiet",
        "--design",
        "star:86.4:24/6/1@780",
        "--as",
        "csv",
        "--out",
        "theirs",
    ];
    stdout(&navwalker(directory.path(), &export));
    directory
}

#[test]
fn constellations_are_reported_without_a_run() {
    let directory = with_theirs();
    let report = [&["report", "paper", "--quiet"], &TWO[..]].concat();
    let printed = stdout(&navwalker(directory.path(), &report));
    assert_eq!(printed, "report.html\n");
    let page = fs::read_to_string(directory.path().join("report.html")).unwrap();
    for told in [
        "<bdi>ours</bdi>",
        "<bdi>elements.csv</bdi>",
        "GNSS alone",
        "ours dominates theirs",
        "step-deg = 20\n",
    ] {
        assert!(page.contains(told), "{told}");
    }
    assert!(!page.contains("id=\"membership\"") && !page.contains("The search"));
    assert!(!page.contains(directory.path().to_str().unwrap()));
    stdout(&navwalker(directory.path(), &report));
    let again = fs::read_to_string(directory.path().join("report.html")).unwrap();
    assert!(page == again, "the bytes differ");
}

#[test]
fn constellations_are_plotted_without_a_run() {
    let directory = with_theirs();
    let plot = |further: &[&str]| {
        let arguments = [&["plot", "--quiet"], &TWO[..], further].concat();
        navwalker(directory.path(), &arguments)
    };
    let table = |further: &[&str]| stdout(&plot(&[further, &["--as", "csv"]].concat()));
    for figure in ["cdf", "series", "pareto"] {
        let rows = table(&["--figure", figure]);
        let named = |name: &str| rows.lines().any(|row| row.ends_with(name));
        assert!(named(",ours") && named(",theirs"), "{figure}: {rows}");
        let drawn = stdout(&plot(&["--figure", figure]));
        assert!(
            drawn.contains("ours") && drawn.contains("theirs"),
            "{figure}"
        );
    }
    // A map shows the one that is picked by name or number, and does not choose.
    let map = |pick: &str| table(&["--figure", "map", "--pick", pick]);
    let (first, second) = (map("ours"), map("theirs"));
    assert_ne!(first, second);
    assert_eq!(first, map("1"));
    assert_eq!(second, map("2"));
    let refused = plot(&["--figure", "map"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert_eq!(refused.status.code(), Some(2));
    assert!(told.contains("choose one with --pick"), "{told}");
    for (further, error) in [
        (
            ["--figure", "map", "--pick", "3"],
            "--pick 3: expected a number from 1 to 2, or a name among ours, theirs",
        ),
        (
            ["--figure", "map", "--pick", "fuzzy"],
            "or a name among ours, theirs",
        ),
        (
            ["--figure", "convergence", "--as", "csv"],
            "figure convergence is of a run",
        ),
        (
            ["--figure", "budget", "--as", "csv"],
            "figure budget is of a run",
        ),
        (
            ["--figure", "pareto", "--front", "theirs"],
            "--front is of a run",
        ),
    ] {
        let refused = plot(&further);
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{further:?}");
        assert!(told.contains(error), "{told}");
    }
}

#[test]
fn what_cannot_be_shown_is_refused() {
    let directory = with_theirs();
    let design = ["--design", "delta:55:36/6/1@900"];
    for (arguments, error) in [
        (vec!["report"], "scenario paper names no constellations"),
        (
            vec!["report", "nowhere/run"],
            "nowhere/run is neither a run directory nor a scenario",
        ),
        (
            vec!["report", "pape"],
            "pape is neither a run directory nor a scenario",
        ),
        (vec!["report", "theirs"], "theirs is not a run directory"),
        (
            [&["report", "--design", "delta:55:36/6/1@900"], &design[..]].concat(),
            "two constellations are named delta:55:36/6/1@900",
        ),
        (
            [
                &[
                    "report",
                    "--out",
                    "theirs/elements.csv",
                    "--constellation",
                    "theirs/elements.csv",
                ],
                &design[..],
            ]
            .concat(),
            "theirs/elements.csv is an input",
        ),
        (
            vec!["report", "--constellation", "absent.tle"],
            "absent.tle",
        ),
    ] {
        let refused = navwalker(directory.path(), &arguments);
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{arguments:?}");
        assert!(told.contains(error), "{told}");
    }
    assert!(!directory.path().join("report.html").exists());
}

/// The constellations of a run are compared with its front, and picked by name.
#[test]
fn a_run_is_plotted_beside_constellations() {
    let directory = small_run();
    let plot = |further: &[&str]| {
        let arguments = [
            "plot",
            "run",
            "--quiet",
            "--as",
            "csv",
            "--design",
            "ours=delta:55:36/6/1@900",
        ];
        navwalker(directory.path(), &[&arguments, further].concat())
    };
    let cdf = stdout(&plot(&["--figure", "cdf"]));
    assert!(cdf.lines().any(|row| row.ends_with(",ours")), "{cdf}");
    let map = |pick: &str| stdout(&plot(&["--figure", "map", "--pick", pick]));
    assert_ne!(map("ours"), map("fuzzy"));
    let refused = plot(&["--figure", "map", "--pick", "theirs"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        told.contains("or a name among reference design, ours"),
        "{told}"
    );
    let refused = plot(&["--figure", "map", "--set", "visibility.mask-deg=5"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(
        told.contains("a run keeps the scenario that it was made with"),
        "{told}"
    );
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
    for (figure, reason) in [("pareto", "the front is empty"), ("map", "")] {
        let output = navwalker(directory.path(), &["plot", "run", "--figure", figure]);
        assert_eq!(output.status.code(), Some(2), "{figure}");
        assert!(
            String::from_utf8_lossy(&output.stderr).contains(reason),
            "{figure}"
        );
    }
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
        for (form, magic) in [("svg", &b"<svg"[..]), ("pdf", b"%PDF"), ("png", b"\x89PNG")] {
            let out = format!("{figure}.{form}");
            let printed = stdout(&navwalker(
                directory.path(),
                &["plot", "run", "--figure", figure, "--out", &out],
            ));
            assert_eq!(printed, format!("{out}\n{figure}.csv\n"));
            let bytes = fs::read(directory.path().join(&out)).unwrap();
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
            &["--figure", "series", "--measure", "longest-outage-s"],
            "figure series cannot show longest-outage-s",
        ),
        (&["--figure", "maps"], "did you mean \"map\"?"),
        (
            &["--figure", "map", "--pick", "99"],
            "cannot pick 99: the front has",
        ),
        (
            &["--figure", "map", "--width-mm", "0"],
            "width 0 mm is outside 40 to 1200 mm",
        ),
        (
            &["--figure", "map", "--width-mm", "60", "--font-size", "20"],
            "has no room for text of 20 pt",
        ),
        (&["--figure", "map", "--range", "3,1"], "the lower first"),
        (
            &["--figure", "map", "--clip-percentile", "0"],
            "above 0 and at most 100",
        ),
        (
            &["--figure", "cdf", "--log", "--range", "0,3"],
            "a logarithmic axis needs values above 0",
        ),
        (
            &["--figure", "convergence", "--log"],
            "are of the figures map, cdf",
        ),
        (
            &["--figure", "cdf", "--projection", "equal-earth"],
            "--projection is of the figure map",
        ),
        (&["--figure", "map", "--out", "map.gif"], "use --as"),
        (
            &["--figure", "map", "--out", "/dev/null/map.svg"],
            "/dev/null/map.svg",
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

/// A run of given designs is shown like constellations with a scenario.
#[test]
fn a_run_of_given_designs_is_shown_as_constellations() {
    let directory = TempDir::new().unwrap();
    let evaluate = [
        "evaluate",
        "--quiet",
        "--set",
        "region.step-deg=20",
        "--set",
        "time.step-s=3600",
        "--design",
        "few=delta:55:36/6/1@900",
        "--design",
        "many=delta:55:64/8/1@900",
        "--out",
        "given",
    ];
    stdout(&navwalker(directory.path(), &evaluate));
    let report = navwalker(directory.path(), &["report", "given"]);
    assert_eq!(stdout(&report), "given/report.html\n");
    assert!(report.stderr.is_empty(), "{report:?}");
    let page = fs::read_to_string(directory.path().join("given/report.html")).unwrap();
    for told in ["<bdi>few</bdi>", "<bdi>many</bdi>", "By j-pos and j-cost, "] {
        assert!(page.contains(told), "{told}");
    }
    for absent in [
        "id=\"membership\"",
        "The search",
        "What is missing",
        "reference design",
    ] {
        assert!(!page.contains(absent), "{absent}");
    }
    let plot = |further: &[&str]| {
        let arguments = [&["plot", "given", "--quiet", "--as", "csv"], further].concat();
        stdout(&navwalker(directory.path(), &arguments))
    };
    let map = |pick: &str| plot(&["--figure", "map", "--pick", pick]);
    assert_eq!(map("1"), map("few"));
    assert_eq!(map("2"), map("many"));
    assert!([map("few"), map("many")].contains(&map("fuzzy")));
    assert!(plot(&["--figure", "pareto"]).contains(",many\n"));
}

/// The constellations of a scenario are shown if none are given, and beside the front of a run.
#[test]
fn the_constellations_of_a_scenario_are_shown() {
    let directory = with_theirs();
    let scenario = "[region]\nstep-deg = 20\n[time]\nstep-s = 3600\n[constellations]\n\
        hybrid = \"delta:55:36/6/1@900+star:90:12/3/1@800\"\n\
        theirs = { files = [\"theirs/elements.csv\"] }\n";
    fs::write(directory.path().join("study.toml"), scenario).unwrap();
    let run = |arguments: &[&str]| stdout(&navwalker(directory.path(), arguments));
    let page = |path: &str| fs::read_to_string(directory.path().join(path)).unwrap();
    run(&["report", "study.toml", "--quiet"]);
    let all = page("report.html");
    assert!(all.contains("<bdi>hybrid</bdi>") && all.contains("<bdi>theirs</bdi>"));
    run(&["report", "study.toml", "--quiet", "--design", "hybrid"]);
    let one = page("report.html");
    assert!(one.contains("<bdi>hybrid</bdi>") && !one.contains("<bdi>theirs</bdi>"));
    let optimize = [
        "optimize",
        "study.toml",
        "--quiet",
        "--set",
        "optimizer.population=8",
        "--set",
        "optimizer.generations=2",
        "--out",
        "run",
    ];
    run(&optimize);
    // A constellation of the scenario that is also given is shown once.
    run(&["report", "run", "--quiet", "--design", "hybrid"]);
    let beside = page("run/report.html");
    for name in ["reference design", "hybrid", "theirs"] {
        assert_eq!(
            beside.matches(&format!("<bdi>{name}</bdi>")).count(),
            1,
            "{name}"
        );
    }
}

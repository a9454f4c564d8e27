//! Every flag of every command has an effect that a user sees: one row each, and none without a row.

use crate::cli::{Ran, coloured, ran};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// What a flag changes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Seen {
    Stdout,
    Stderr,
    /// The exit status.
    Status,
    /// What is written to `out`: its names and their contents.
    Out,
}
use Seen::{Out, Status, Stderr, Stdout};

/// A command and one of its flags, the rest of a command line, what the flag adds to it, and what that changes.
struct Row(&'static str, &'static str, &'static str, &'static str, Seen);

/// In place of these words stand the arguments of a small study.
const SHORTHANDS: [(&str, &str); 7] = [
    (
        "SMALL",
        "--set region.step-deg=25 --set time.step-s=1200 --set time.duration-h=4",
    ),
    ("DESIGN", "--design delta:55:6/3/1@925"),
    ("OTHER", "--design delta:60:4/2/1@800"),
    (
        "SEARCH",
        "--set optimizer.population=4 --set optimizer.generations=2 --set search.planes=[5,7]",
    ),
    (
        "FEWEST",
        "--set region.step-deg=30 --set time.step-s=7200 --set objectives.constraints=[\"availability>=0.85\"] \
         --set objectives.availability-pdop=1.6 --set search.planes=[4,6] --set search.satellites-per-plane=[4,8] \
         --set search.inclination-step-deg=20 --set search.altitude-step-km=600",
    ),
    (
        "SWEPT",
        "--set region.step-deg=30 --set time.step-s=7200 --set search.planes=[4,5] --set search.satellites-per-plane=[4,4] \
         --set search.inclination-step-deg=20 --set search.altitude-step-km=600",
    ),
    (
        "LITTLE",
        "--set region.step-deg=30 --set time.step-s=7200 --set optimizer.population=4 --set optimizer.generations=1",
    ),
];

/// A flag that is refused without the value that it needs, or with a wrong one, is read; what it changes is told here. Words
/// before `|` are a command that runs first.
const ROWS: &[Row] = &[
    Row(
        "optimize",
        "set",
        "--out out SMALL SEARCH",
        "--set visibility.mask-deg=20",
        Stdout,
    ),
    Row("optimize", "out", "SMALL SEARCH", "--out out", Out),
    Row(
        "optimize",
        "seed",
        "--out out SMALL SEARCH",
        "--seed 5",
        Stdout,
    ),
    Row(
        "optimize",
        "seeds",
        "--out out SMALL SEARCH",
        "--seeds 2",
        Out,
    ),
    Row(
        "optimize",
        "shard",
        "--out out SMALL SEARCH --seeds 2",
        "--shard 1/2",
        Out,
    ),
    Row(
        "optimize",
        "certify",
        "--out out SMALL SEARCH --set search.satellites-per-plane=[5,7] --set search.inclination-step-deg=20 --set search.altitude-step-km=600",
        "--certify",
        Stdout,
    ),
    Row(
        "optimize",
        "resume",
        "optimize --out out SMALL SEARCH | --out out SMALL SEARCH --set optimizer.generations=3",
        "--resume",
        Stderr,
    ),
    Row(
        "optimize",
        "force",
        "optimize --out out SMALL SEARCH | --out out SMALL SEARCH --seed 2",
        "--force",
        Status,
    ),
    Row(
        "optimize",
        "evaluations",
        "--out out SMALL SEARCH",
        "--evaluations",
        Out,
    ),
    Row(
        "optimize",
        "from",
        "optimize --out old SMALL SEARCH --evaluations | SMALL SEARCH",
        "--from old",
        Stdout,
    ),
    Row(
        "optimize",
        "report",
        "--out out SMALL SEARCH",
        "--report",
        Out,
    ),
    Row(
        "optimize",
        "format",
        "--out out SMALL SEARCH",
        "--format csv",
        Stdout,
    ),
    Row(
        "size",
        "set",
        "--out out FEWEST",
        "--set visibility.mask-deg=20",
        Stdout,
    ),
    Row("size", "out", "FEWEST", "--out out", Out),
    Row("size", "shard", "--out out FEWEST", "--shard 1/2", Stdout),
    Row("size", "slack", "--out out FEWEST", "--slack 3", Stdout),
    Row(
        "size",
        "verify",
        "size --out out FEWEST |",
        "--verify out",
        Status,
    ),
    Row(
        "size",
        "draw",
        "size --out out FEWEST | --verify out",
        "--draw 3",
        Stdout,
    ),
    Row(
        "size",
        "resume",
        "size --out out FEWEST | --out out FEWEST",
        "--resume",
        Stderr,
    ),
    Row(
        "size",
        "force",
        "optimize --out out LITTLE | --out out FEWEST",
        "--force",
        Status,
    ),
    Row("size", "format", "--out out FEWEST", "--format csv", Stdout),
    Row(
        "sweep",
        "set",
        "--out out SWEPT",
        "--set visibility.mask-deg=20",
        Stdout,
    ),
    Row("sweep", "out", "SWEPT", "--out out", Out),
    Row(
        "sweep",
        "designs",
        "--out out SWEPT",
        "--designs list.txt",
        Stdout,
    ),
    Row("sweep", "as", "--out out SWEPT", "--as csv", Out),
    Row("sweep", "chunk", "--out out SWEPT", "--chunk 2", Stdout),
    Row("sweep", "shard", "--out out SWEPT", "--shard 1/2", Stdout),
    Row(
        "sweep",
        "merge",
        "sweep --out out SWEPT --shard 1/1 |",
        "--merge --out out",
        Out,
    ),
    Row(
        "sweep",
        "status",
        "sweep --out out SWEPT |",
        "--status --out out",
        Status,
    ),
    Row(
        "sweep",
        "resume",
        "sweep --out out SWEPT | --out out SWEPT",
        "--resume",
        Status,
    ),
    Row(
        "sweep",
        "force",
        "sweep --out out SWEPT | --out out SWEPT --chunk 3",
        "--force",
        Status,
    ),
    Row("sweep", "format", "--out out SWEPT", "--format csv", Stdout),
    Row(
        "evaluate",
        "set",
        "DESIGN SMALL",
        "--set visibility.mask-deg=20",
        Stdout,
    ),
    Row("evaluate", "design", "SMALL", "DESIGN", Status),
    Row(
        "evaluate",
        "failures",
        "DESIGN SMALL",
        "--failures 1",
        Stdout,
    ),
    Row(
        "evaluate",
        "draws",
        "--design delta:55:30/5/1@925 --failures 3 SMALL",
        "--draws 5",
        Stdout,
    ),
    Row(
        "evaluate",
        "phases",
        "DESIGN SMALL",
        "--phases phases.csv",
        Stdout,
    ),
    Row(
        "evaluate",
        "without",
        "DESIGN SMALL",
        "--without NW-P01-S02,GEO-1",
        Stdout,
    ),
    Row(
        "evaluate",
        "constellation",
        "SMALL",
        "--constellation six.csv",
        Status,
    ),
    Row(
        "evaluate",
        "input-format",
        "SMALL --constellation six.csv",
        "--input-format tle",
        Status,
    ),
    Row(
        "evaluate",
        "only",
        "SMALL --constellation six.csv",
        "--only NW-P01-*",
        Stdout,
    ),
    Row(
        "evaluate",
        "exclude",
        "SMALL --constellation six.csv",
        "--exclude NW-P01-S01",
        Stdout,
    ),
    Row("evaluate", "dops", "DESIGN SMALL", "--dops", Stdout),
    Row(
        "evaluate",
        "gnss-phases",
        "DESIGN SMALL",
        "--gnss-phases 2",
        Stdout,
    ),
    Row(
        "evaluate",
        "relative-nodes",
        "--design delta:55:6/3/1@925+star:90:4/2/1@1100 SMALL",
        "--relative-nodes 2",
        Stdout,
    ),
    Row("evaluate", "series", "DESIGN SMALL", "--series out", Out),
    Row(
        "evaluate",
        "tile",
        "DESIGN SMALL --out out",
        "--tile 1/2",
        Out,
    ),
    Row(
        "evaluate",
        "merge",
        "evaluate DESIGN SMALL --tile 1/2 --out out | DESIGN SMALL",
        "--merge out",
        Status,
    ),
    Row(
        "evaluate",
        "force",
        "evaluate DESIGN SMALL --series out | OTHER SMALL --series out",
        "--force",
        Status,
    ),
    Row(
        "evaluate",
        "format",
        "DESIGN SMALL",
        "--format json",
        Stdout,
    ),
    Row("lint", "as", "six.tle", "--as sp3", Status),
    Row("lint", "format", "six.csv six.tle", "--format json", Stdout),
    Row(
        "diff",
        "absolute",
        "two.csv four.csv",
        "--absolute 2",
        Status,
    ),
    Row(
        "diff",
        "relative",
        "two.csv four.csv",
        "--relative 0.5",
        Status,
    ),
    Row(
        "diff",
        "format",
        "two.csv four.csv",
        "--format json",
        Stdout,
    ),
    Row("dop", "mask-deg", "sky.csv", "--mask-deg 12", Stdout),
    Row("dop", "clocks", "sky.csv", "--clocks shared", Stdout),
    Row(
        "dop",
        "weighting",
        "sky.csv",
        "--weighting sine-elevation",
        Stdout,
    ),
    Row("dop", "format", "sky.csv", "--format json", Stdout),
    Row(
        "orbit",
        "format",
        "delta:55:6/3/1@925",
        "--format json",
        Stdout,
    ),
    Row(
        "separation",
        "all-phasings",
        "delta:55:6/3/1@925",
        "--all-phasings",
        Stdout,
    ),
    Row(
        "separation",
        "duration-h",
        "delta:55:6/3/1@925+star:90:6/3/1@1000",
        "--duration-h 2",
        Stdout,
    ),
    Row(
        "separation",
        "format",
        "delta:55:6/3/1@925",
        "--format json",
        Stdout,
    ),
    Row(
        "lifetime",
        "mass-kg",
        "delta:55:6/3/1@925",
        "--mass-kg 100",
        Stdout,
    ),
    Row(
        "lifetime",
        "area-m2",
        "delta:55:6/3/1@925",
        "--area-m2 1",
        Stdout,
    ),
    Row(
        "lifetime",
        "drag-coefficient",
        "delta:55:6/3/1@925",
        "--drag-coefficient 2",
        Stdout,
    ),
    Row(
        "lifetime",
        "box-km",
        "delta:55:6/3/1@925",
        "--box-km 1",
        Stdout,
    ),
    Row(
        "lifetime",
        "sigma-a-km",
        "delta:55:6/3/1@925",
        "--sigma-a-km 1",
        Stdout,
    ),
    Row(
        "lifetime",
        "sigma-i-deg",
        "delta:55:6/3/1@925",
        "--sigma-i-deg 0.1",
        Stdout,
    ),
    Row(
        "lifetime",
        "format",
        "delta:55:6/3/1@925",
        "--format json",
        Stdout,
    ),
    Row(
        "reproduce",
        "set",
        "--out out LITTLE",
        "--set visibility.mask-deg=10",
        Stdout,
    ),
    Row("reproduce", "all", "--out out LITTLE", "--all", Status),
    Row("reproduce", "list", "--out out LITTLE", "--list", Stdout),
    Row("reproduce", "out", "LITTLE", "--out out", Out),
    Row("reproduce", "seed", "--out out LITTLE", "--seed 2", Out),
    Row(
        "reproduce",
        "force",
        "reproduce sun-synchronous --out out | --out out LITTLE",
        "--force",
        Status,
    ),
    Row(
        "reproduce",
        "format",
        "--out out LITTLE",
        "--format csv",
        Stdout,
    ),
    Row(
        "export",
        "set",
        "DESIGN SMALL --as oem --out out",
        "--set time.step-s=600",
        Out,
    ),
    Row(
        "export",
        "design",
        "SMALL --as tle --out out",
        "DESIGN",
        Out,
    ),
    Row(
        "export",
        "without",
        "DESIGN SMALL --as tle --out out",
        "--without NW-P01-S02",
        Out,
    ),
    Row("export", "run", "--as tle --out out", "--run run", Out),
    Row(
        "export",
        "pick",
        "--run run --as tle --out out",
        "--pick 2",
        Out,
    ),
    Row("export", "as", "DESIGN SMALL --out out", "--as tle", Status),
    Row(
        "export",
        "out",
        "DESIGN SMALL --as tle",
        "--out out",
        Status,
    ),
    Row(
        "export",
        "force",
        "export DESIGN SMALL --as tle --out out | OTHER SMALL --as tle --out out",
        "--force",
        Status,
    ),
    Row(
        "export",
        "frame",
        "DESIGN SMALL --as oem --out out",
        "--frame GCRF",
        Out,
    ),
    Row(
        "export",
        "time-system",
        "DESIGN SMALL --as oem --out out",
        "--time-system TAI",
        Out,
    ),
    Row(
        "export",
        "omm-syntax",
        "DESIGN SMALL --as omm --out out",
        "--omm-syntax json",
        Out,
    ),
    Row(
        "export",
        "oem-syntax",
        "DESIGN SMALL --as oem --out out",
        "--oem-syntax xml",
        Out,
    ),
    Row(
        "export",
        "opm-syntax",
        "DESIGN SMALL --as opm --out out",
        "--opm-syntax xml",
        Out,
    ),
    Row(
        "export",
        "oem-combined",
        "DESIGN SMALL --as oem --oem-syntax xml --out out",
        "--oem-combined",
        Out,
    ),
    Row(
        "export",
        "tle-theory",
        "DESIGN SMALL --as tle --out out",
        "--tle-theory kepler",
        Out,
    ),
    Row(
        "export",
        "ccsds-version",
        "DESIGN SMALL --as oem --out out",
        "--ccsds-version 3.0",
        Out,
    ),
    Row(
        "export",
        "sp3-version",
        "DESIGN SMALL --as sp3 --out out",
        "--sp3-version c",
        Out,
    ),
    Row(
        "export",
        "check",
        "DESIGN SMALL --as csv --out out",
        "--check",
        Stdout,
    ),
    Row(
        "export",
        "creation-date",
        "DESIGN SMALL --as oem --out out",
        "--creation-date 2025-02-01T00:00:00Z",
        Out,
    ),
    Row(
        "export",
        "gnss",
        "DESIGN SMALL --as sp3 --out out",
        "--gnss gps",
        Out,
    ),
    Row(
        "export",
        "sp3-letter",
        "DESIGN SMALL --as sp3 --out out",
        "--sp3-letter X",
        Out,
    ),
    Row(
        "validate",
        "set",
        "DESIGN SMALL --against sgp4",
        "--set time.duration-h=2",
        Stdout,
    ),
    Row(
        "validate",
        "design",
        "SMALL --set reference-design=delta:60:4/2/1@800 --against sgp4",
        "DESIGN",
        Stdout,
    ),
    Row(
        "validate",
        "run",
        "SMALL --set reference-design=delta:60:4/2/1@800 --against analytic",
        "--run run",
        Stdout,
    ),
    Row(
        "validate",
        "pick",
        "--run run --against analytic",
        "--pick 2",
        Stdout,
    ),
    Row(
        "validate",
        "against",
        "DESIGN SMALL",
        "--against sgp4",
        Status,
    ),
    Row(
        "validate",
        "input-format",
        "DESIGN SMALL --against ./six.tle",
        "--input-format sp3",
        Status,
    ),
    Row(
        "validate",
        "out",
        "DESIGN SMALL --against sgp4",
        "--out out",
        Out,
    ),
    Row(
        "validate",
        "report",
        "--run run --against analytic --out out",
        "--report",
        Stderr,
    ),
    Row(
        "validate",
        "force",
        "export DESIGN SMALL --as tle --out out | DESIGN SMALL --against sgp4 --out out",
        "--force",
        Stderr,
    ),
    Row(
        "validate",
        "format",
        "DESIGN SMALL --against sgp4",
        "--format markdown",
        Stdout,
    ),
    Row("report", "front", "run --out out", "--front other", Out),
    Row(
        "report",
        "validation",
        "run --out out",
        "--validation checks",
        Out,
    ),
    Row("report", "out", "run", "--out out", Out),
    Row(
        "plot",
        "front",
        "run --figure pareto",
        "--front other",
        Stdout,
    ),
    Row(
        "plot",
        "validation",
        "run --figure budget",
        "--validation checks",
        Status,
    ),
    Row(
        "plot",
        "without",
        "SMALL --figure cdf --measure mean-visible OTHER",
        "--without NW-P01",
        Stdout,
    ),
    Row(
        "plot",
        "phases",
        "SMALL --figure phases DESIGN",
        "--phases phases.csv",
        Status,
    ),
    Row(
        "plot",
        "failures",
        "SMALL --figure failures --as csv DESIGN",
        "--failures 2",
        Stdout,
    ),
    Row(
        "plot",
        "draws",
        "SMALL --figure failures --as csv --failures 3 --design delta:55:30/5/1@925",
        "--draws 5",
        Stdout,
    ),
    Row("plot", "figure", "run", "--figure pareto", Status),
    Row(
        "plot",
        "measure",
        "run --figure map",
        "--measure max-pdop",
        Stdout,
    ),
    Row(
        "plot",
        "pick",
        "run --figure map --measure mean-visible",
        "--pick 2",
        Stdout,
    ),
    Row("plot", "as", "run --figure pareto", "--as csv", Stdout),
    Row(
        "plot",
        "width-mm",
        "run --figure pareto",
        "--width-mm 85",
        Stdout,
    ),
    Row(
        "plot",
        "font-size",
        "run --figure pareto",
        "--font-size 10",
        Stdout,
    ),
    Row(
        "plot",
        "title",
        "run --figure pareto",
        "--title none",
        Stdout,
    ),
    Row(
        "plot",
        "log",
        "run --figure map --measure mean-visible",
        "--log",
        Stdout,
    ),
    Row(
        "plot",
        "range",
        "run --figure map --measure mean-visible",
        "--range 0.01,9",
        Stdout,
    ),
    Row(
        "plot",
        "clip-percentile",
        "run --figure map --measure mean-visible",
        "--clip-percentile 50",
        Stdout,
    ),
    Row(
        "plot",
        "projection",
        "run --figure map --measure mean-visible",
        "--projection equal-earth",
        Stdout,
    ),
    Row("plot", "out", "run --figure pareto", "--out out", Out),
    Row(
        "plot",
        "force",
        "plot run --figure pareto --out out.svg | run --figure map --measure mean-visible --out out.svg",
        "--force",
        Status,
    ),
    Row("scenario list", "format", "", "--format json", Stdout),
    Row(
        "scenario show",
        "set",
        "",
        "--set visibility.mask-deg=20",
        Stdout,
    ),
    Row("man", "out", "", "--out out", Out),
    // Of the program, for every command.
    Row(
        "evaluate",
        "designs",
        "SMALL DESIGN",
        "--designs list.txt",
        Stdout,
    ),
    Row("evaluate", "out", "SMALL DESIGN", "--out out", Out),
    Row(
        "export",
        "constellation",
        "SMALL --as csv --out out",
        "--constellation six.csv",
        Out,
    ),
    Row(
        "export",
        "input-format",
        "SMALL --as csv --out out --constellation six.csv",
        "--input-format tle",
        Status,
    ),
    Row(
        "export",
        "only",
        "SMALL --as csv --out out --constellation six.csv",
        "--only NW-P01-*",
        Out,
    ),
    Row(
        "export",
        "exclude",
        "SMALL --as csv --out out --constellation six.csv",
        "--exclude NW-P01-S01",
        Out,
    ),
    Row(
        "validate",
        "constellation",
        "SMALL --against ./six.tle",
        "--constellation six.csv",
        Stdout,
    ),
    Row(
        "validate",
        "only",
        "SMALL --against ./six.tle --constellation six.csv",
        "--only NW-P01-*",
        Stdout,
    ),
    Row(
        "validate",
        "exclude",
        "SMALL --against ./six.tle --constellation six.csv",
        "--exclude NW-P01-S01",
        Stdout,
    ),
    Row("report", "design", "SMALL --out out OTHER", "DESIGN", Out),
    Row(
        "report",
        "constellation",
        "SMALL --out out OTHER",
        "--constellation six.csv",
        Out,
    ),
    Row(
        "report",
        "input-format",
        "SMALL --out out --constellation six.csv",
        "--input-format tle",
        Status,
    ),
    Row(
        "report",
        "only",
        "SMALL --out out --constellation six.csv",
        "--only NW-P01-*",
        Out,
    ),
    Row(
        "report",
        "exclude",
        "SMALL --out out --constellation six.csv",
        "--exclude NW-P01-S01",
        Out,
    ),
    Row(
        "report",
        "failures",
        "SMALL --out out DESIGN",
        "--failures 1",
        Out,
    ),
    Row(
        "report",
        "draws",
        "SMALL --out out --failures 3 --design delta:55:30/5/1@925",
        "--draws 5",
        Out,
    ),
    Row(
        "report",
        "without",
        "SMALL --out out OTHER",
        "--without NW-P01",
        Out,
    ),
    Row(
        "report",
        "set",
        "SMALL --out out OTHER",
        "--set visibility.mask-deg=20",
        Out,
    ),
    Row(
        "plot",
        "design",
        "SMALL --figure cdf --measure mean-visible OTHER",
        "DESIGN",
        Stdout,
    ),
    Row(
        "plot",
        "constellation",
        "SMALL --figure cdf --measure mean-visible OTHER",
        "--constellation six.csv",
        Stdout,
    ),
    Row(
        "plot",
        "input-format",
        "SMALL --figure cdf --measure mean-visible --constellation six.csv",
        "--input-format tle",
        Status,
    ),
    Row(
        "plot",
        "only",
        "SMALL --figure cdf --measure mean-visible --constellation six.csv",
        "--only NW-P01-*",
        Stdout,
    ),
    Row(
        "plot",
        "exclude",
        "SMALL --figure cdf --measure mean-visible --constellation six.csv",
        "--exclude NW-P01-*",
        Stdout,
    ),
    Row(
        "plot",
        "set",
        "SMALL --figure cdf --measure mean-visible OTHER",
        "--set visibility.mask-deg=20",
        Stdout,
    ),
    Row(
        "",
        "allow-large",
        "export --design delta:55:10000/100/1@925 --as oem --out /proc/self/a --set time.step-s=1",
        "--allow-large",
        Stderr,
    ),
    Row(
        "",
        "threads",
        "evaluate DESIGN SMALL",
        "--threads 0",
        Status,
    ),
    Row("", "quiet", "evaluate DESIGN SMALL", "--quiet", Stderr),
    Row("", "no-color", "evaluate", "--no-color", Stderr),
    Row("", "version", "", "--version", Status),
];

/// The flags of the program itself, which every command has; `--help` is how the rows are checked.
const GLOBAL: [&str; 6] = [
    "threads",
    "allow-large",
    "quiet",
    "no-color",
    "version",
    "help",
];

fn words(text: &str) -> Vec<String> {
    let mut text = format!(" {text} ");
    for (word, arguments) in SHORTHANDS {
        text = text.replace(&format!(" {word} "), &format!(" {arguments} "));
        text = text.replace(&format!(" {word} "), &format!(" {arguments} "));
    }
    text.split_whitespace().map(str::to_owned).collect()
}

/// Runs the program as if stderr were a terminal that shows colours.
fn run(place: &Path, text: &str) -> Ran {
    let words = words(text);
    coloured(place, &words.iter().map(String::as_str).collect::<Vec<_>>())
}

/// A file, or every file below a directory, with its contents.
fn contents(path: &Path) -> Vec<(String, Vec<u8>)> {
    if !path.is_dir() {
        let bytes = fs::read(path).ok();
        return bytes
            .into_iter()
            .map(|bytes| (path.display().to_string(), bytes))
            .collect();
    }
    let entries = fs::read_dir(path).unwrap();
    let mut entries: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    // Every flag is in the command that the provenance holds, whatever else it changes.
    entries.retain(|entry| !entry.ends_with("provenance.json"));
    entries.sort();
    entries.iter().flat_map(|entry| contents(entry)).collect()
}

/// The status, stdout, stderr, and what is written.
type Outcome = (i32, String, String, Vec<(String, Vec<u8>)>);

fn outcome(place: &Path, command: &str, arguments: &str) -> Outcome {
    for made in ["out", "out.svg", "out.csv", "out-sweep", "runs"] {
        let made = place.join(made);
        let _ = if made.is_dir() {
            fs::remove_dir_all(made)
        } else {
            fs::remove_file(made)
        };
    }
    let (first, arguments) = arguments.split_once('|').unwrap_or(("", arguments));
    if !first.is_empty() {
        let ran = run(place, first);
        assert_eq!(ran.status, 0, "{first}: {}", ran.stderr);
    }
    let ran = run(place, &format!("{command} {arguments}"));
    (
        ran.status,
        ran.stdout,
        ran.stderr,
        contents(&place.join("out")),
    )
}

/// The help of a command, which clap writes from its definition.
fn help(command: &str) -> String {
    let words = words(&format!("{command} --help"));
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    ran(Path::new("."), &words).stdout
}

/// Long flags in the help of a command.
fn flags(command: &str) -> Vec<String> {
    let text = help(command);
    let flag = |line: &str| {
        let line = line.trim_start();
        let line = line
            .strip_prefix("-")
            .filter(|rest| rest.get(1..3) == Some(", "))
            .map_or(line, |rest| &rest[3..]);
        let name = line.strip_prefix("--")?;
        let end = name.find(|c: char| !c.is_ascii_alphanumeric() && c != '-');
        Some(name[..end.unwrap_or(name.len())].to_owned())
    };
    text.lines().filter_map(flag).collect()
}

/// The commands in a help text.
fn commands(of: &str) -> Vec<String> {
    let text = help(of);
    let lines = text.lines().skip_while(|line| *line != "Commands:").skip(1);
    let lines = lines.take_while(|line| !line.is_empty());
    let name = |line: &str| {
        line.strip_prefix("  ")?
            .split(' ')
            .next()
            .map(str::to_owned)
    };
    let names = lines
        .filter_map(name)
        .filter(|name| !name.is_empty() && name != "help");
    names
        .map(|name| format!("{of} {name}").trim().to_owned())
        .collect()
}

#[test]
fn every_flag_has_a_row() {
    let mut all = BTreeSet::new();
    let mut waiting = vec![String::new()];
    while let Some(command) = waiting.pop() {
        for flag in flags(&command) {
            let is_global = GLOBAL.contains(&flag.as_str());
            if flag != "help" && (command.is_empty() || !is_global) {
                all.insert((command.clone(), flag));
            }
        }
        waiting.extend(commands(&command));
    }
    let rows = ROWS.iter().map(|row| (row.0.to_owned(), row.1.to_owned()));
    assert_eq!(all, rows.collect());
}

#[test]
fn every_flag_has_its_effect() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    for first in [
        "export --quiet DESIGN SMALL --as csv,tle --out six",
        "optimize --quiet --out run SMALL SEARCH",
        "optimize --quiet --out other SMALL SEARCH --seed 9",
        "validate --quiet DESIGN SMALL --against sgp4 --out checks",
    ] {
        assert_eq!(run(place, first).status, 0, "{first}");
    }
    fs::rename(place.join("six/elements.csv"), place.join("six.csv")).unwrap();
    fs::rename(place.join("six/constellation.tle"), place.join("six.tle")).unwrap();
    let sky = "azimuth_deg,elevation_deg,system\n0,15,a\n90,40,a\n200,25,b\n300,70,b\n45,11,b\n";
    fs::write(place.join("sky.csv"), sky).unwrap();
    fs::write(place.join("two.csv"), "x\n2\n").unwrap();
    fs::write(place.join("four.csv"), "x\n4\n").unwrap();
    fs::write(place.join("list.txt"), "delta:60:4/2/1@800\n").unwrap();
    fs::write(place.join("phases.csv"), "phase,add\na,NW-P01\n").unwrap();
    let mut none = Vec::new();
    for Row(command, flag, arguments, with, seen) in ROWS {
        let written = if *with == "DESIGN" { "--design" } else { with };
        assert!(
            written.starts_with(&format!("--{flag}")),
            "{command} --{flag}"
        );
        let before = outcome(place, command, arguments);
        let after = outcome(place, command, &format!("{arguments} {with}"));
        let has_effect = match seen {
            Stdout => before.1 != after.1 && before.0 < 2 && after.0 < 2,
            Stderr => before.2 != after.2,
            Status => before.0 != after.0,
            Out => before.3 != after.3 && after.0 < 2,
        };
        if !has_effect {
            none.push((command, flag, after.0, after.1, after.2));
        }
    }
    assert!(none.is_empty(), "{none:#?}");
}

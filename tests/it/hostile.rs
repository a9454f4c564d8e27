//! Texts of others are shown, not obeyed: names, paths and messages on their way to a terminal, a report or a table.

use crate::cli::{Ran, coloured};
use navwalker::printable::is_obeyed;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A name that clears the screen, changes colours, reverses what follows, hides and splits itself, in markup.
const NAME: &str =
    "EVIL\u{1b}[2J\u{9b}31m\u{202e}\u{2066}\u{200b}\u{2028}\u{61c}\u{7f}|`<b>[x](y)</script>";

/// What a name with a line break would print as a line of its own.
const FORGED: &str = "error: forged";

/// The study of all commands below.
const STUDY: &str = "--design delta:55:6/3/1@925 --set time.duration-h=2 --set time.step-s=600 --set region.step-deg=25";

/// How a format writes the name.
#[derive(Clone, Copy)]
enum Written {
    /// As it is: the format has printable ASCII only, and the file is refused.
    Refused,
    Xml,
    Json,
    Csv,
    /// In the name of the file.
    InPath,
}

impl Written {
    fn text(self) -> String {
        match self {
            Self::Refused => NAME.to_owned(),
            Self::InPath => format!("{}\n{FORGED}", NAME.replace('/', "-")),
            Self::Xml => {
                let escaped = NAME.replace('&', "&amp;").replace('<', "&lt;");
                format!("{escaped}&#10;{FORGED}").replace('\u{1b}', "&#27;")
            }
            Self::Json => {
                let text = serde_json::to_string(&format!("{NAME}\n{FORGED}")).unwrap();
                text.trim_matches('"').to_owned()
            }
            Self::Csv => format!("\"{NAME}\n{FORGED}\""),
        }
    }
}

/// Every format that carries names: the export, the file, and how the name is written.
const FORMATS: [(&str, &str, Written); 16] = [
    ("--as tle", "constellation.tle", Written::Refused),
    ("--as omm", "omm/NW-P01-S01.omm", Written::Refused),
    ("--as omm --omm-syntax xml", "omm.xml", Written::Xml),
    ("--as omm --omm-syntax json", "omm.json", Written::Json),
    ("--as omm --omm-syntax csv", "omm.csv", Written::Csv),
    ("--as oem", "oem/NW-P01-S01.oem", Written::Refused),
    (
        "--as oem --oem-syntax xml",
        "oem/NW-P01-S01.xml",
        Written::Xml,
    ),
    ("--as opm", "opm/NW-P01-S01.opm", Written::Refused),
    (
        "--as opm --opm-syntax xml",
        "opm/NW-P01-S01.xml",
        Written::Xml,
    ),
    ("--as sp3", "sp3/part-01.sp3", Written::Refused),
    ("--as stk", "stk/NW-P01-S01.e", Written::InPath),
    ("--as csv", "elements.csv", Written::Csv),
    ("--as csv", "states.csv", Written::Csv),
    ("--as tle-states", "tle-states.csv", Written::Csv),
    ("--as czml", "scene.czml", Written::Json),
    ("--as yuma", "yuma/beidou-3.alm", Written::Refused),
];

/// Runs a command line in which `FILE` and `GNSS` stand for a file.
fn ran(directory: &Path, arguments: &str, file: Option<&str>) -> Ran {
    let arguments = arguments.split(' ').map(|word| match (word, file) {
        ("FILE", Some(file)) => file.to_owned(),
        ("GNSS", Some(file)) => format!("gnss.files=[{}]", serde_json::to_string(file).unwrap()),
        (word, _) => word.to_owned(),
    });
    let arguments: Vec<String> = arguments.collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    coloured(directory, &arguments)
}

/// Fails if a text has anything that is obeyed, or a line that a name has begun.
fn assert_shown(text: &str, of: &str) {
    let mut plain = text.to_owned();
    for own in ["\u{1b}[1;31m", "\u{1b}[1;33m", "\u{1b}[0m"] {
        plain = plain.replace(own, "");
    }
    let obeyed = plain.find(|c| is_obeyed(c) && c != '\n');
    let near = obeyed.map(|at| &plain[..at + 1]);
    assert_eq!(near, None, "{of}");
    let forged = plain.lines().find(|line| line.starts_with("error: forged"));
    assert_eq!(forged, None, "{of}: {plain}");
}

/// Everything of text kind in a directory.
fn assert_files_shown(directory: &Path, of: &str) {
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let text = fs::read_to_string(&path).unwrap();
        assert_shown(&text, &format!("{of}: {}", path.display()));
        if path.extension().is_some_and(|extension| extension == "md") {
            for markup in ["<b>", "[x](y)", "|`"] {
                let plain = text
                    .match_indices(markup)
                    .filter(|(at, _)| !text[..*at].ends_with('\\'));
                assert_eq!(plain.count(), 0, "{markup} in {}: {text}", path.display());
            }
        }
    }
}

#[test]
fn names_from_files_are_shown_not_obeyed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    let mut otherwise = Vec::new();
    for (n, (export, path, written)) in FORMATS.into_iter().enumerate() {
        let out = format!("export-{n}");
        let exported = ran(
            place,
            &format!("export --quiet {STUDY} {export} --out {out}"),
            None,
        );
        assert_eq!(exported.status, 0, "{}", exported.stderr);
        let text = fs::read_to_string(place.join(&out).join(path)).unwrap();
        let text = match written {
            Written::InPath => text,
            _ if path.ends_with(".alm") => text.replacen("almanac for", &written.text(), 1),
            _ => text.replace("NW-P01-S01", &written.text()),
        };
        let extension = path.rsplit_once('.').unwrap().1;
        let stem = match written {
            Written::InPath => written.text(),
            _ => format!("file-{n}"),
        };
        let file = format!("./{stem}.{extension}");
        fs::write(place.join(&file), text).unwrap();
        // The same satellites in two files of one directory.
        let twice = format!("twice-{n}");
        fs::create_dir(place.join(&twice)).unwrap();
        for copy in ["a", "b"] {
            let copy = place.join(&twice).join(format!("{copy}.{extension}"));
            fs::copy(place.join(&file), copy).unwrap();
        }
        let mut seen = String::new();
        for command in [
            "lint FILE",
            "lint --format json FILE",
            "lint --format csv FILE",
            "evaluate CONSTELLATION --constellation FILE",
            "evaluate CONSTELLATION --constellation TWICE",
            "evaluate CONSTELLATION --constellation FILE --format json",
            "evaluate CONSTELLATION --constellation FILE --format csv --only nobody",
            "evaluate STUDY --set GNSS --series series",
            "validate STUDY --against FILE --out report --force",
            "validate STUDY --against FILE --format junit",
        ] {
            let constellation = STUDY.split_once(" --set").unwrap().1;
            let command = command.replace("STUDY", STUDY).replace("TWICE", &twice);
            let command = command.replace("CONSTELLATION", &format!("--set{constellation}"));
            let ran = ran(place, &command, Some(&file));
            let of = format!("{export}: {command} ({})", ran.status);
            assert!(ran.status <= 2, "{of}");
            assert_shown(&ran.stdout, &of);
            assert_shown(&ran.stderr, &of);
            if command.ends_with("json") || command.ends_with("json FILE") {
                let json = serde_json::from_str::<serde_json::Value>(&ran.stdout);
                assert!(json.is_ok() || ran.status == 2, "{of}: {}", ran.stdout);
            }
            seen += &(ran.stdout + &ran.stderr);
            for made in ["report", "series"] {
                if place.join(made).exists() {
                    assert_files_shown(&place.join(made), &of);
                    fs::remove_dir_all(place.join(made)).unwrap();
                }
            }
        }
        // The name has come through, as what it is.
        if matches!(written, Written::Refused) == seen.contains(r"EVIL\u{1b}[2J\u{9b}31m\u{202e}") {
            otherwise.push((export, path, seen));
        }
    }
    assert!(otherwise.is_empty(), "{otherwise:#?}");
}

/// What is typed, or stands in a scenario or a table of points, comes back in messages.
#[test]
fn what_is_typed_is_shown_not_obeyed() {
    let directory = TempDir::new().unwrap();
    let place = directory.path();
    fs::write(
        place.join("points.csv"),
        format!("latitude_deg,longitude_deg\n\"{NAME}\n{FORGED}\",1\n"),
    )
    .unwrap();
    fs::write(
        place.join("named.csv"),
        format!("latitude_deg,longitude_deg,name\n1,1,\u{202e}\u{2066}{NAME}\n"),
    )
    .unwrap();
    fs::write(
        place.join("named2.csv"),
        "latitude_deg,longitude_deg,name\n1,1,a\u{202e}b\u{200b}c\n",
    )
    .unwrap();
    fs::write(
        place.join("bad.toml"),
        format!("name = '{NAME}'\n[{NAME}]\n"),
    )
    .unwrap();
    fs::write(
        place.join("quoted.toml"),
        "name = \"a\\u001b\\u202e\"\n\"\\u202ekey\\u001b\" = 1\n",
    )
    .unwrap();
    fs::write(
        place.join("sky.csv"),
        "azimuth_deg,elevation_deg,sky,system,e\u{202e}\n1,1,a\u{202e}b,c\u{200b}\n",
    )
    .unwrap();
    fs::write(
        place.join("sky2.csv"),
        format!("azimuth_deg,elevation_deg\n\"{NAME}\n{FORGED}\",1\n"),
    )
    .unwrap();
    let hostile = "a\\u001b[2J\\u202e<b>|`[x](y)";
    let statement = format!(
        "[[statement]]\nname = \"{hostile}\"\nof = \"delta:55:6/3/1@925\"\nmetric = \"raan-deg\"\nat-least = 1\n\
         source = \"{hostile}\"\ndisagreement = \"{hostile}\"\n"
    );
    fs::write(
        place.join("study.toml"),
        format!("name = \"s\"\ntitle = \"{hostile}\"\nsource = \"{hostile}\"\nnotes = [\"{hostile}\"]\n{statement}"),
    )
    .unwrap();
    for command in [
        "dop FILE",
        "dop sky.csv",
        "dop sky.csv --format json",
        "dop sky.csv --format csv",
        "dop sky2.csv",
        "orbit FILE",
        "reproduce FILE",
        "reproduce study.toml",
        "reproduce study.toml --format markdown",
        "FILE",
        "evaluate FILE --design delta:55:6/3/1@925",
        "evaluate --design FILE",
        "evaluate --set FILE --design delta:55:6/3/1@925",
        "evaluate --set GNSS --design delta:55:6/3/1@925",
        "evaluate --set region.points=\"points.csv\" --design delta:55:6/3/1@925",
        "evaluate --set region.points=\"named.csv\" --design delta:55:6/3/1@925 --series bad",
        "evaluate --set region.points=\"named2.csv\" --design delta:55:6/3/1@925 --set time.duration-h=1 --series series",
        "evaluate bad.toml --design delta:55:6/3/1@925",
        "evaluate quoted.toml --design delta:55:6/3/1@925",
        "scenario show --set GNSS",
        "lint FILE",
        "validate --against FILE",
        "validate --against sgp4,FILE",
        "report FILE",
        "plot FILE --figure FILE",
        "man FILE",
        "export --as FILE --out FILE",
    ] {
        let ran = ran(place, command, Some(NAME));
        assert!(ran.status == 2 || ran.status == 0, "{command}");
        assert_shown(&ran.stdout, command);
        assert_shown(&ran.stderr, command);
    }
    assert_files_shown(&place.join("runs/reproduce/s"), "reproduce");
    let points = fs::read_to_string(place.join("series/points.csv")).unwrap();
    assert!(points.contains(r"a\u{202e}b\u{200b}c"), "{points}");
}

//! Constellations by name.

use super::{defaults, parse};
use crate::exchange::lint::Format;
use crate::scenario::{
    ConstellationParts, NamedConstellation, NoDesign, Scenario, SetupError, json_schema, template,
};
use std::io;

const TEXT: &str = "\
[constellations]
zulu = \"delta:53:160/10/1@1000+star:90:40/5/1@1100\"
iridium = { files = [\"iridium.tle\"], input-format = \"tle\", exclude = [\"IRIDIUM 7*\"] }

[constellations.mixed]
design = \"star:90:4/2/1@925\"
files = [\"a.tle\", \"b.sp3\"]
only = [\"X\"]
";

fn parts(design: Option<&str>, files: &[&str]) -> ConstellationParts {
    ConstellationParts {
        design: design.map(|notation| notation.parse().unwrap()),
        ..ConstellationParts::of_files(files.iter().map(|&file| file.to_owned()).collect())
    }
}

fn named(name: &str, parts: ConstellationParts) -> NamedConstellation {
    let name = name.to_owned();
    NamedConstellation { name, parts }
}

fn names(scenario: &Scenario) -> Vec<&str> {
    let named = scenario.constellations.iter();
    named.map(|one| one.name.as_str()).collect()
}

/// The lines of the problems, without excerpts.
fn problems(text: &str, overrides: &[&str]) -> Vec<String> {
    let problems = parse(text, overrides).unwrap_err();
    problems
        .as_slice()
        .iter()
        .map(ToString::to_string)
        .collect()
}

#[test]
fn constellations_are_read_in_the_order_as_written() {
    let scenario = parse(TEXT, &[]).unwrap();
    let hybrid = "delta:53:160/10/1@1000+star:90:40/5/1@1100";
    let iridium = ConstellationParts {
        input_format: Some(Format::Tle),
        exclude: vec!["IRIDIUM 7*".to_owned()],
        ..parts(None, &["iridium.tle"])
    };
    let mixed = ConstellationParts {
        only: vec!["X".to_owned()],
        ..parts(Some("star:90:4/2/1@925"), &["a.tle", "b.sp3"])
    };
    let expected = [
        named("zulu", parts(Some(hybrid), &[])),
        named("iridium", iridium),
        named("mixed", mixed),
    ];
    assert_eq!(scenario.constellations, expected);
    assert_eq!(scenario.files(), ["iridium.tle", "a.tle", "b.sp3"]);
    let copies = ["1/i", "2/a", "3/b"].map(str::to_owned);
    assert_eq!(scenario.with_files(&copies).files(), copies);
    assert_eq!(defaults().constellations, []);
}

#[test]
fn the_canonical_form_is_a_table_on_one_line() {
    let text = parse(TEXT, &[]).unwrap().to_toml();
    let line = "\nconstellations = { zulu = \"delta:53:160/10/1@1000+star:90:40/5/1@1100\", \
        iridium = { files = [\"iridium.tle\"], input-format = \"tle\", exclude = [\"IRIDIUM 7*\"] }, \
        mixed = { design = \"star:90:4/2/1@925\", files = [\"a.tle\", \"b.sp3\"], only = [\"X\"] } }\n";
    assert!(text.contains(line), "{text}");
    assert!(defaults().to_toml().contains("\nconstellations = {}\n"));
}

#[test]
fn arguments_are_merged_by_name() {
    let delta = "delta:55:4/2/1@925";
    let scenario = parse(
        TEXT,
        &[
            "constellations.zulu=delta:55:4/2/1@925",
            "constellations.mixed.files=['c.tle']",
            "constellations={ new = 'delta:55:4/2/1@925' }",
            "constellations.added.files=['d.tle']",
            "constellations.added.exclude=['Y']",
        ],
    )
    .unwrap();
    assert_eq!(
        names(&scenario),
        ["zulu", "iridium", "mixed", "new", "added"]
    );
    assert_eq!(scenario.constellations[0].parts, parts(Some(delta), &[]));
    let mixed = ConstellationParts {
        only: vec!["X".to_owned()],
        ..parts(Some("star:90:4/2/1@925"), &["c.tle"])
    };
    assert_eq!(scenario.constellations[2].parts, mixed);
    assert_eq!(scenario.constellations[3].parts, parts(Some(delta), &[]));
    assert_eq!(scenario.files(), ["iridium.tle", "c.tle", "d.tle"]);
    // Files beside what was a notation alone.
    let both = parse(TEXT, &["constellations.zulu.files=['z.tle']"]).unwrap();
    let zulu = &both.constellations[0].parts;
    assert!(zulu.design.is_some() && zulu.files == ["z.tle"]);
    let fresh = parse("", &["constellations.x=delta:55:4/2/1@925"]).unwrap();
    assert_eq!(fresh.constellations, [named("x", parts(Some(delta), &[]))]);
}

#[test]
fn problems_are_where_they_are_with_their_key() {
    let text = "[constellations]\n\
        a = \"delta:55:7/2/1@925\"\n\
        b = { files = [] }\n\
        c = { fils = [\"c.tle\"] }\n\
        \"d e\" = \"delta:55:4/2/1@925\"\n\
        f = 3\n\
        g = {}\n\
        h = { design = \"delta:55:4/2/1@925\", only = [\"X\"] }\n\
        i = { files = [\"i.tle\"], input-format = \"tel\" }\n\
        j = { files = [\"j.tle\", \"j.tle\"] }\n\
        [constellations.k]\n\
        design = \"a+b\"\n";
    let found = problems(text, &[]);
    let expected = [
        "study.toml:2: constellations.a: ",
        "study.toml:3: constellations.b.files: found [], expected a list of one or more paths",
        "study.toml:4: constellations.c.fils: unknown key, did you mean `files`? \
         (choices: design, files, input-format, only, exclude)",
        "study.toml:5: constellations.d e: found the name \"d e\", expected a name of letters, digits, '-' and '_'",
        "study.toml:6: constellations.f: found 3, expected a design in Walker notation",
        "study.toml:7: constellations.g: the constellation has no satellites: give `design`, `files` or both",
        "study.toml:8: constellations.h.only: this is about satellites from files, but `files` is not given",
        "study.toml:9: constellations.i.input-format: unknown name \"tel\" (choices: tle, oem, ",
        "study.toml:10: constellations.j.files: \"j.tle\" appears more than once",
        "study.toml:12: constellations.k.design: shell A: ",
    ];
    assert_eq!(found.len(), expected.len(), "{found:#?}");
    for (found, expected) in found.iter().zip(expected) {
        assert!(found.starts_with(expected), "{found}\n{expected}");
    }
    let whole = problems(
        "\nconstellations = [1]\n",
        &["constellations.x=delta:55:4/2/1@925"],
    );
    let [whole] = whole.as_slice() else {
        panic!("{whole:?}");
    };
    assert!(
        whole.starts_with("study.toml:2: constellations: found [1], expected a table of names, "),
        "{whole}"
    );
    let twice = problems("[constellations]\na = \"x\"\na = \"y\"", &[]);
    assert!(
        twice[0].starts_with("study.toml:3: not TOML: "),
        "{twice:?}"
    );
}

#[test]
fn problems_of_arguments_name_them_and_replaced_values_have_none() {
    for (argument, problem) in [
        (
            "constellations.zulu=star",
            "constellations.zulu: 'star' is not a design",
        ),
        (
            "constellations.mixed.only=3",
            "constellations.mixed.only: found 3, expected ",
        ),
        (
            "constellations.new.only=['X']",
            "constellations.new.only: this is about satellites",
        ),
        (
            "constellations={ new = {} }",
            "constellations.new: the constellation has no",
        ),
        (
            "constellations=3",
            "constellations: found 3, expected a table of names",
        ),
        ("constellations.=3", "constellations."),
    ] {
        let found = problems(TEXT, &[argument]);
        let expected = format!("--set {argument}: {problem}");
        assert!(found[0].starts_with(&expected), "{found:?}\n{expected}");
    }
    let wrong = "[constellations]\nx = 3\ny = { files = 4 }";
    let right = [
        "constellations.x=delta:55:4/2/1@925",
        "constellations.y.files=['y.tle']",
    ];
    assert_eq!(names(&parse(wrong, &right).unwrap()), ["x", "y"]);
}

#[test]
fn a_design_is_a_notation_or_a_name() {
    let scenario = parse(TEXT, &["reference-design=zulu"]).unwrap();
    let design = scenario.reference_design().unwrap();
    assert_eq!(
        design.to_string(),
        "delta:53:160/10/1@1000+star:90:40/5/1@1100"
    );
    let polar = "star:90:4/2/1@925";
    assert_eq!(scenario.design(polar).unwrap().to_string(), polar);
    for files in ["iridium", "mixed"] {
        assert_eq!(
            scenario.design(files),
            Err(NoDesign::HasFiles(files.to_owned()))
        );
    }
    let unknown = scenario.design("zuul").unwrap_err().to_string();
    assert!(
        unknown.starts_with("'zuul' is not a design; the form is pattern:"),
        "{unknown}"
    );
    let names = "nor is it a constellation of the scenario, did you mean 'zulu'? (choices: zulu, iridium, mixed)";
    assert!(unknown.ends_with(names), "{unknown}");
    let wrong = scenario.design("delta:55:7/2/1@925").unwrap_err();
    assert!(matches!(wrong, NoDesign::Notation(_)), "{wrong}");
    let none = defaults().design("zulu").unwrap_err().to_string();
    assert!(
        none.ends_with("and the scenario names no constellations"),
        "{none}"
    );
}

#[test]
fn files_become_satellites_or_an_error_at_their_key() {
    let elements = "object,epoch_utc,semi_major_axis_km,eccentricity,inclination_deg,raan_deg,arg_perigee_deg,mean_anomaly_deg\n\
        A-1,2025-01-01T00:00:00Z,7300,0,50,0,0,0\n\
        A-2,2025-01-01T00:00:00Z,7300,0,50,0,0,180\n";
    let text = "[constellations]\n\
        both = { design = \"delta:55:4/2/1@925\", files = [\"in/a.csv\"], only = [\"A-2\"] }\n\
        none = { files = [\"none.csv\"] }\n\
        other = { files = [\"in/a.csv\"], exclude = [\"B*\"] }\n\
        damaged = { files = [\"in/a.csv\"], input-format = \"sp3\" }\n";
    let scenario = parse(text, &[]).unwrap();
    let read = |file: &str| match file {
        "in/a.csv" => Ok(elements.as_bytes().to_vec()),
        _ => Err(io::Error::from(io::ErrorKind::NotFound)),
    };
    let grid = scenario.time_grid().unwrap();
    let [both, wrong @ ..] = scenario.constellations.as_slice() else {
        panic!("four are named");
    };
    let (both, notes) = both.read(&read, grid).unwrap();
    assert_eq!((both.name.as_str(), both.satellite_count()), ("both", 5));
    let files = both.files.unwrap();
    assert_eq!(
        (files.names, files.fleet.labels()),
        (vec!["a.csv".to_owned()], vec!["A-2".to_owned()])
    );
    assert!(notes.is_empty(), "{notes:?}");
    let told: Vec<String> = wrong
        .iter()
        .map(|one| place_of(text, &one.read(&read, grid).unwrap_err()))
        .collect();
    let expected = [
        "study.toml:3: constellations.none.files: none.csv: cannot read it: ",
        "study.toml:4: constellations.other.files: a.csv: no satellite matches 'B*'",
        "study.toml:5: constellations.damaged.files: in/a.csv: ",
    ];
    for (told, expected) in told.iter().zip(expected) {
        assert!(told.starts_with(expected), "{told}\n{expected}");
    }
    assert_eq!(told.len(), expected.len());
    let unreadable = scenario.unreadable("none.csv", io::ErrorKind::NotFound.into());
    assert!(
        place_of(text, &unreadable).starts_with(expected[0]),
        "{unreadable}"
    );
}

/// What is told of an error of the setup.
fn place_of(text: &str, error: &SetupError) -> String {
    let problems = Scenario::setup_problem::<&str>("study.toml", text.as_bytes(), &[], error);
    problems.as_slice()[0].to_string()
}

#[test]
fn the_template_shows_constellations_that_parse() {
    let template = template();
    let line = template
        .lines()
        .find_map(|line| line.strip_prefix("# constellations = "));
    let scenario = parse(&format!("constellations = {}", line.unwrap()), &[]).unwrap();
    assert_eq!(names(&scenario), ["hybrid", "iridium"]);
}

#[test]
fn the_schema_describes_a_constellation() {
    let schema = &json_schema()["properties"]["constellations"];
    assert_eq!(schema["propertyNames"]["pattern"], "^[A-Za-z0-9_-]+$");
    let table = &schema["additionalProperties"]["anyOf"][1];
    assert_eq!(table["additionalProperties"], false);
    assert_eq!(table["properties"]["files"]["minItems"], 1);
    assert_eq!(
        table["properties"]["design"]["description"],
        "Shells, in Walker notation"
    );
    assert_eq!(table["dependentRequired"]["only"][0], "files");
    assert_eq!(table["anyOf"][0]["required"][0], "design");
}

#[test]
fn the_name_of_the_gnss_alone_is_reserved() {
    let text = "[constellations]\na = \"delta:55:4/2/1@925\"\ngnss-only = \"delta:55:4/2/1@925\"\n";
    let told = problems(text, &[]);
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0]
            .contains(":3: constellations.gnss-only: the name gnss-only is that of the GNSS alone"),
        "{told:?}"
    );
    assert_eq!(
        problems("", &["constellations.gnss-only.files=['a.tle']"]).len(),
        1
    );
}

#[test]
fn names_of_designs_join_like_notations() {
    let scenario = parse(TEXT, &["constellations.polar=star:90:4/2/1@925"]).unwrap();
    let design = scenario.design("polar+delta:55:4/2/1@900+zulu").unwrap();
    assert_eq!(
        design.to_string(),
        "star:90:4/2/1@925+delta:55:4/2/1@900+delta:53:160/10/1@1000+star:90:40/5/1@1100"
    );
    let with_files = scenario.design("polar+mixed").unwrap_err();
    assert_eq!(with_files, NoDesign::HasFiles("mixed".to_owned()));
    // What a reference design says is what counts, not how.
    let by_name = parse(
        TEXT,
        &[
            "constellations.polar=star:90:4/2/1@925",
            "reference-design=polar+polar",
        ],
    );
    let spelled = parse(
        "",
        &["reference-design=star:90:4/2/1@925+star:90:4/2/1@925"],
    );
    assert_eq!(by_name.unwrap().hash(&[]), spelled.unwrap().hash(&[]));
}

//! Several shells of a search, and what is fixed beside them.

use super::{accepts, defaults, parse, problem, refuses};
use crate::scenario::{Pattern, Scenario, SearchShells, json_schema};
use crate::search::ShellSpace;

const TWO: &str = "[search]
altitude-step-km = 25
[[search.shells]]
pattern = \"delta\"
planes = [4, 8]
inclination-step-deg = 2
[[search.shells]]
pattern = [\"star\", \"delta\"]
planes = 3
satellites-per-plane = [0, 9]
raan-deg = [-10, 10]
node-step-deg = 30
arg-latitude-deg = 45
raan-step-deg = 5
";

fn shells(scenario: &Scenario) -> &[ShellSpace] {
    scenario.search.shells.as_slice()
}

#[test]
fn shells_have_the_defaults_and_the_steps_of_the_search() {
    let scenario = parse(TWO, &[]).unwrap();
    let [first, second] = shells(&scenario) else {
        panic!("{scenario:?}");
    };
    let default = &shells(&defaults())[0].clone();
    assert_eq!(first.pattern, [Pattern::Delta]);
    assert_eq!(first.planes, [4, 8]);
    assert_eq!(first.satellites_per_plane, default.satellites_per_plane);
    assert_eq!(first.raan_deg, None);
    // Its own, that of [search], and the default of both.
    assert_eq!(first.steps.inclination_step_deg, 2.0);
    assert_eq!(first.steps.altitude_step_km, 25.0);
    assert_eq!(
        first.steps.eccentricity_step,
        default.steps.eccentricity_step
    );
    assert_eq!(
        second.steps.inclination_step_deg,
        default.steps.inclination_step_deg
    );
    assert_eq!(second.pattern, [Pattern::Star, Pattern::Delta]);
    assert_eq!(second.raan_deg, Some([-10.0, 10.0]));
    assert_eq!(second.arg_latitude_deg, Some([45.0, 45.0]));
    assert_eq!(second.node_step_deg, Some([30.0, 30.0]));
    assert_eq!(second.steps.raan_step_deg, Some(5.0));
    assert_eq!(second.steps.arg_latitude_step_deg, None);
    // One plane more or less, one step.
    assert_eq!(first.grid_points(), 5.0 * 5.0 * 11.0 * 25.0);
    let text = scenario.to_toml();
    assert!(!text.contains("\nplanes"), "{text}");
    assert_eq!(parse(&text, &[]), Ok(scenario));
}

/// A list of one shell is the same search as the keys of `[search]`.
#[test]
fn a_list_of_one_is_one_shell() {
    let listed = parse("[[search.shells]]\nplanes = [4, 8]\nphasing = [0, 2]", &[]).unwrap();
    let one = accepts("search", "planes = [4, 8]\nphasing = [0, 2]");
    assert_eq!(listed.design_space(), one.design_space());
    assert!(matches!(listed.search.shells, SearchShells::Listed(_)));
}

#[test]
fn an_argument_replaces_the_intervals_of_a_file() {
    let file = "[search]\nplanes = [4, 8]\naltitude-step-km = 20";
    let scenario = parse(file, &["search.shells=[{}, { planes = 7 }]"]).unwrap();
    let shells = shells(&scenario);
    assert_eq!((shells[0].planes, shells[1].planes), ([11, 15], [7, 7]));
    assert_eq!(shells[1].steps.altitude_step_km, 20.0);
}

/// One shell, or one key of it, by its number from 1.
#[test]
fn an_argument_sets_a_key_of_one_shell() {
    let set = |arguments: &[&str]| parse(TWO, arguments);
    let scenario = set(&[
        "search.shells.1.planes=[3,6]",
        "search.shells.2.altitude-step-km=40",
        "search.shells.2.raan-deg=5",
    ])
    .unwrap();
    let [first, second] = shells(&scenario) else {
        panic!("{scenario:?}");
    };
    let before = parse(TWO, &[]).unwrap();
    let expected = ShellSpace {
        planes: [3, 6],
        ..shells(&before)[0].clone()
    };
    assert_eq!(*first, expected);
    assert_eq!(second.steps.altitude_step_km, 40.0);
    assert_eq!(second.raan_deg, Some([5.0, 5.0]));
    assert_eq!(second.planes, [3, 3]);
    // A whole table, of which a later argument sets a key.
    let scenario = set(&[
        "search.shells.2={ planes = 7, phasing = 2 }",
        "search.shells.2.phasing=3",
    ])
    .unwrap();
    let second = &shells(&scenario)[1];
    assert_eq!((second.planes, second.phasing), ([7, 7], [3, 3]));
    assert_eq!(second.raan_deg, None);
    // Tables of an argument have numbers too.
    let listed = parse("", &["search.shells=[{}, {}]", "search.shells.2.planes=4"]).unwrap();
    assert_eq!(shells(&listed)[1].planes, [4, 4]);
}

#[test]
fn problems_of_a_number_are_told() {
    let told = |text: &str, argument: &str| {
        let problems = parse(text, &[argument]).unwrap_err();
        let told: Vec<String> = problems
            .as_slice()
            .iter()
            .map(ToString::to_string)
            .collect();
        told.join("\n")
    };
    for number in ["0", "3", "-1", "first", ""] {
        let argument = format!("search.shells.{number}.planes=3");
        assert_eq!(
            told(TWO, &argument),
            format!(
                "--set {argument}: search.shells: there is no table {number}, expected a number from 1 to 2"
            )
        );
    }
    assert_eq!(
        told("", "search.shells.1.planes=3"),
        "--set search.shells.1.planes=3: search.shells: there is no table 1: the scenario has no such list"
    );
    let value = told(TWO, "search.shells.2.planes=0");
    assert!(
        value.starts_with(
            "--set search.shells.2.planes=0: search.shells.2.planes: found 0, expected"
        ),
        "{value}"
    );
    let unknown = told(TWO, "search.shells.1.plains=3");
    assert!(
        unknown.starts_with(
            "--set search.shells.1.plains=3: search.shells.1.plains: unknown key, did you mean `planes`?"
        ),
        "{unknown}"
    );
    let deeper = told(TWO, "search.shells.1.planes.low=3");
    assert!(
        deeper.contains("search.shells.1.planes.low: unknown key"),
        "{deeper}"
    );
    let table = told(TWO, "search.shells.2=3");
    assert!(
        table
            .starts_with("--set search.shells.2=3: search.shells.2: found 3, expected a table of "),
        "{table}"
    );
    // A problem of the file stays where it is.
    let file = "[[search.shells]]\nplanes = 0\n";
    assert!(told(file, "search.shells.1.phasing=0").starts_with("study.toml:2: "));
}

#[test]
fn intervals_of_one_shell_are_refused_beside_a_list() {
    let text = "[search]\nplanes = [4, 8]\npattern = \"star\"\n[[search.shells]]\nplanes = 3\n";
    let problems = parse(text, &[]).unwrap_err();
    let told: Vec<String> = problems
        .as_slice()
        .iter()
        .map(ToString::to_string)
        .collect();
    let which = "`search.shells` lists the shells: give this key in each [[search.shells]] instead, or leave out \
                 `search.shells`";
    assert_eq!(
        told,
        [
            format!("study.toml:2: search.planes: {which}"),
            format!("study.toml:3: search.pattern: {which}"),
        ]
    );
}

#[test]
fn problems_of_a_shell_are_told_where_they_are() {
    let told = |table: &str| {
        let text = format!("[[search.shells]]\n[[search.shells]]\n{table}\n");
        problem(&text).to_string()
    };
    assert_eq!(
        told("planes = 0"),
        "study.toml:3: search.shells.2.planes: found 0, expected [low, high], each an integer >= 1 and <= 100000, or \
         one for both"
    );
    assert!(
        told("plains = 3").contains("search.shells.2.plains: unknown key, did you mean `planes`?"),
        "{}",
        told("plains = 3")
    );
    assert!(
        told("phasing = 20").contains(
            "search.shells.2.phasing: the lowest phasing is 20, but with at most 15 planes"
        )
    );
    assert!(
        told("satellites-per-plane = 0")
            .contains("search.shells.2.satellites-per-plane: the shell never has a satellite")
    );
    let lattice = told("pattern = [\"delta\", \"lattice\"]\nnode-step-deg = 30");
    assert!(
        lattice.starts_with(
            "study.toml:4: search.shells.2.node-step-deg: node-step-deg does not apply to lattice"
        ),
        "{lattice}"
    );
    assert!(told("pattern = [\"delta\", \"delta\"]").contains("\"delta\" appears more than once"));
    assert!(
        told("pattern = []")
            .contains("found [], expected \"delta\" | \"star\" | \"lattice\", or a list of them")
    );
    assert!(told("pattern = \"detla\"").contains(
        "unknown name \"detla\", did you mean \"delta\"? (choices: delta, star, lattice)"
    ));
    let many = "[[search.shells]]\nplanes = 300\nsatellites-per-plane = 200\n".repeat(2);
    assert!(
        problem(&many)
            .to_string()
            .contains("search.shells: 120000 satellites in a design, expected at most 100000")
    );
}

#[test]
fn a_search_has_a_satellite_at_least() {
    let message = "every shell can be empty, so that a design could have no satellite; let `satellites-per-plane` of \
                   one of them begin at 1, or give `search.fixed`";
    refuses(
        "search",
        "satellites-per-plane = [0, 5]",
        "satellites-per-plane",
        message,
    );
    let empty = "{ satellites-per-plane = [0, 5] }";
    refuses(
        "search",
        &format!("shells = [{empty}, {empty}]"),
        "shells",
        message,
    );
    refuses(
        "search",
        "shells = []",
        "shells",
        "found an empty list, expected at least one shell",
    );
    accepts("search", &format!("shells = [{empty}, {{}}]"));
    accepts(
        "search",
        "satellites-per-plane = [0, 5]\nfixed = \"delta:55:4/2/1@800\"",
    );
}

#[test]
fn what_is_fixed_is_a_notation_or_a_name() {
    let named =
        "[constellations]\niridium = \"star:86.4:66/6/3@780,node-step=31.6\"\n[search]\nfixed = ";
    let scenario = parse(&format!("{named}\"iridium\""), &[]).unwrap();
    let design = scenario.design_space().fixed.unwrap();
    assert_eq!(design.satellite_count(), 66);
    assert_eq!(scenario.goals().fixed, Some(design));
    let unknown = problem(&format!("{named}\"iridum\"")).to_string();
    assert!(
        unknown.starts_with("study.toml:4: search.fixed: ")
            && unknown.contains("did you mean 'iridium'? (choices: iridium)"),
        "{unknown}"
    );
    let wrong = problem("[search]\nfixed = \"delta:55:5/2/1@800\"").to_string();
    assert!(
        wrong.contains("satellites T = 5 is not a multiple of planes P = 2"),
        "{wrong}"
    );
}

/// What is fixed is computed, by whatever name, and so are its files.
#[test]
fn the_hash_covers_what_is_fixed() {
    let design = "delta:55:4/2/1@800";
    let by_notation = parse("", &[&format!("search.fixed={design}")]).unwrap();
    let by_name = |name: &str, design: &str| {
        let named = format!("constellations.{name}={design}");
        parse("", &[&named, &format!("search.fixed={name}")]).unwrap()
    };
    assert_eq!(by_name("a", design).hash(&[]), by_notation.hash(&[]));
    assert_eq!(by_name("b", design).hash(&[]), by_notation.hash(&[]));
    assert_ne!(
        by_name("a", "delta:55:6/2/1@800").hash(&[]),
        by_notation.hash(&[])
    );
    let of_files = |further: &[&str]| {
        let files = [
            "constellations.compared.files=['c.tle']",
            "constellations.orbiting.files=['f.tle', 'g.tle']",
            "gnss.files=['n.tle']",
            "search.fixed=orbiting",
        ];
        parse("", &[&files, further].concat()).unwrap()
    };
    let scenario = of_files(&[]);
    assert_eq!(scenario.files(), ["n.tle", "f.tle", "g.tle", "c.tle"]);
    assert_eq!(scenario.computed_files(), 3);
    let copies = ["1", "2", "3", "4"].map(str::to_owned);
    assert_eq!(scenario.with_files(&copies).files(), copies);
    let hash = scenario.hash(&[b"n", b"f", b"g", b"c"]);
    assert_eq!(scenario.hash(&[b"n", b"f", b"g", b"other"]), hash);
    assert_ne!(scenario.hash(&[b"n", b"f", b"other", b"c"]), hash);
    assert_eq!(
        scenario.with_files(&copies).hash(&[b"n", b"f", b"g", b"c"]),
        hash
    );
    let fewer = of_files(&["constellations.orbiting.exclude=['X*']"]);
    assert_ne!(fewer.hash(&[b"n", b"f", b"g", b"c"]), hash);
}

#[test]
fn the_template_shows_shells_that_parse() {
    let template = crate::scenario::template();
    let example = |key: &str| {
        let line = template
            .lines()
            .find(|line| line.starts_with(&format!("# {key} = ")));
        line.unwrap().trim_start_matches("# ").to_owned()
    };
    let scenario = accepts("search", &example("shells"));
    let [first, second] = shells(&scenario) else {
        panic!("{template}");
    };
    assert!(!first.may_be_empty() && second.may_be_empty());
    for key in [
        "fixed",
        "raan-deg",
        "arg-latitude-deg",
        "node-step-deg",
        "raan-step-deg",
    ] {
        accepts("search", &example(key));
    }
}

#[test]
fn the_schema_describes_a_shell() {
    let schema = json_schema();
    let shell = &schema["properties"]["search"]["properties"]["shells"]["items"];
    assert_eq!(shell["additionalProperties"], false);
    assert_eq!(
        shell["properties"]["planes"]["description"],
        "Number of planes"
    );
    assert!(shell["properties"]["inclination-step-deg"].is_object());
}

//! Where problems are, what they say, and how they look.

use super::{parse, problem, refuses};
use crate::scenario::{Fault, Place, Scenario, ScenarioProblem};

#[test]
fn names_are_safe_in_a_path() {
    for name in ["../up", ".hidden", "a b", "a/b", "", "é", "-x"] {
        let text = format!("name = \"{name}\"");
        let message = problem(&text).to_string();
        let start = format!("study.toml:1: name: found \"{name}\", expected a text of letters");
        assert!(message.starts_with(&start), "{message}");
    }
    assert_eq!(
        parse("name = \"Asia-2_b.1\"", &[]).unwrap().name,
        "Asia-2_b.1"
    );
    let originator = "expected a text of printable ASCII";
    refuses("export", "originator = \"ÖBB\"", "originator", originator);
    refuses("export", "originator = \"A\\tB\"", "originator", originator);
    let prefix =
        "expected a text of letters, digits and '-' that begins with a letter, 1 to 8 bytes";
    for wrong in ["", "9A", "-A", "A B", "NAVWALKER", "Ä"] {
        let line = format!("name-prefix = \"{wrong}\"");
        refuses("export", &line, "name-prefix", prefix);
    }
    for wrong in ["0", "340000", "-1", "1.5", "\"1\""] {
        let line = format!("first-catalog-number = {wrong}");
        refuses(
            "export",
            &line,
            "first-catalog-number",
            "an integer >= 1 and <= 339999",
        );
    }
    refuses(
        "export",
        "creation-date = 1",
        "creation-date",
        "found 1, expected a UTC instant",
    );
}

#[test]
fn unknown_keys_suggest_the_nearest() {
    let region = "(choices: latitude-deg, longitude-deg, step-deg, weights, spacing-km, polygon, country, points, weight-grid, terrain, antenna-height-m)";
    let nearest = format!("unknown key, did you mean `region.latitude-deg`? {region}");
    refuses("region", "latitude = [3, 54]", "latitude", &nearest);
    refuses(
        "time",
        "duration_h = 5",
        "duration_h",
        "did you mean `time.duration-h`?",
    );
    refuses(
        "time",
        "mask-deg = 5",
        "mask-deg",
        "did you mean `visibility.mask-deg`?",
    );
    refuses("region", "j = 5", "j", &format!("unknown key {region}"));
    refuses(
        "region",
        "step-deg.x = 5",
        "step-deg",
        "found a table, expected a number > 0",
    );
}

#[test]
fn unknown_sections_suggest_the_nearest() {
    let message = problem("\n[serach]\nplanes = 3\n").to_string();
    let start = "study.toml:2: serach: unknown key, did you mean `search`? (choices: name, ";
    assert!(message.starts_with(start), "{message}");
    let message = problem("duration-h = 3\n").to_string();
    let start = "study.toml:1: duration-h: unknown key, did you mean `time.duration-h`?";
    assert!(message.starts_with(start), "{message}");
}

#[test]
fn a_section_is_no_value() {
    let expected = "study.toml:1: time: [time] is a section; set one of its keys: \
                    epoch, duration-h, step-s";
    assert_eq!(problem("time = 5").to_string(), expected);
    assert_eq!(problem("[[time]]").to_string(), expected);
}

#[test]
fn dotted_keys_and_inline_tables_are_sections_too() {
    let expected = parse("[time]\nstep-s = 30\nduration-h = 2", &[]).unwrap();
    assert_eq!(
        parse("time.step-s = 30\ntime.duration-h = 2", &[]).unwrap(),
        expected
    );
    assert_eq!(
        parse("time = { step-s = 30, duration-h = 2 }", &[]).unwrap(),
        expected
    );
    assert_eq!(
        parse("\u{feff}[time]\r\nstep-s = 30\r\nduration-h = 2\r\n", &[]).unwrap(),
        expected
    );
}

#[test]
fn all_problems_are_reported_at_once_in_order() {
    let text = "\
[visibility]
mask-deg = 95      # too high
[time]
step-s = 0
duration-s = 5
[gnss]
constellations = [\"beidou\", \"gps\", \"gps\"]
";
    let overrides = ["optimizer.population=2", "tme.step-s=5"];
    let problems = parse(text, &overrides).unwrap_err();
    let expected = "\
study.toml:2: visibility.mask-deg: found 95, expected a number >= 0 and < 90, in deg
  2 | mask-deg = 95      # too high
    |            ^^
study.toml:4: time.step-s: found 0, expected a number > 0, in s
  4 | step-s = 0
    |          ^
study.toml:5: time.duration-s: unknown key, did you mean `time.duration-h`? (choices: epoch, duration-h, step-s)
  5 | duration-s = 5
    | ^^^^^^^^^^
study.toml:7: gnss.constellations: unknown name \"beidou\", did you mean \"beidou-3\"? (choices: beidou-3, gps, galileo, glonass, qzss, navic)
  7 | constellations = [\"beidou\", \"gps\", \"gps\"]
    |                   ^^^^^^^^
study.toml:7: gnss.constellations: \"gps\" appears more than once
  7 | constellations = [\"beidou\", \"gps\", \"gps\"]
    |                                    ^^^^^
--set optimizer.population=2: optimizer.population: found 2, expected an integer >= 4 and <= 10000
--set tme.step-s=5: tme.step-s: unknown key, did you mean `time.step-s`? (choices: time, earth, propagation, region, visibility, gnss, outages, reliability, accuracy, metrics, objectives, search, optimizer, export)";
    assert_eq!(problems.to_string(), expected);
}

#[test]
fn a_wrong_value_hides_no_check_that_needs_it() {
    // With the wrong step there is no count of samples to complain about, only the step.
    let problems = parse("[time]\nstep-s = \"1\"\nduration-h = 8784", &[]).unwrap_err();
    assert_eq!(problems.as_slice().len(), 1, "{problems}");
}

#[test]
fn text_that_is_not_toml_says_where() {
    let syntax = problem("name = \"x\"\n[time]\nstep-s = \n");
    assert!(matches!(syntax.fault, Fault::Syntax { .. }), "{syntax}");
    assert!(
        syntax.to_string().starts_with("study.toml:3: not TOML: "),
        "{syntax}"
    );
    let twice = problem("[time]\nstep-s = 5\nstep-s = 6\n").to_string();
    assert!(
        twice.starts_with("study.toml:3: not TOML: duplicate key"),
        "{twice}"
    );
}

#[test]
fn bytes_that_are_not_text_say_where() {
    let bytes = b"name = \"x\"\n[time]\n# \xff\n";
    let problems = Scenario::parse::<&str>("study.toml", bytes, &[]).unwrap_err();
    let [
        ScenarioProblem {
            place: Place::File { line, column, .. },
            fault,
            ..
        },
    ] = problems.as_slice()
    else {
        panic!("{problems}");
    };
    assert_eq!((*line, *column, fault), (3, 3, &Fault::NotUtf8));
}

#[test]
fn excerpts_of_long_lines_are_cut_around_the_problem() {
    let padding = " ".repeat(300);
    let text = format!("[time]\nstep-s ={padding}\"soon\" # {padding}end");
    let problem = problem(&text);
    let Place::File {
        column, excerpt, ..
    } = problem.place
    else {
        panic!("the problem is in the file");
    };
    assert_eq!(column, 309);
    assert!(excerpt.text.chars().count() <= 96, "{}", excerpt.text);
    let meant: String = excerpt
        .text
        .chars()
        .skip(excerpt.offset)
        .take(excerpt.length)
        .collect();
    assert_eq!(meant, "\"soon\"");
}

#[test]
fn control_characters_do_not_reach_the_terminal() {
    let problems = parse("\"a\\u001b[31mb\" = \"\u{7f}\"", &[])
        .unwrap_err()
        .to_string();
    assert!(
        !problems.contains(|c: char| c.is_control() && c != '\n'),
        "{problems:?}"
    );
}

#[test]
fn a_file_of_nonsense_has_a_bounded_number_of_problems() {
    // A hundred thousand wrong elements on one line took minutes when all were shown.
    let text = format!("[gnss]\nfiles = [{}]\n", "0, ".repeat(100_000));
    assert_eq!(parse(&text, &[]).unwrap_err().as_slice().len(), 1000);
}

#[test]
fn texts_have_a_longest_length() {
    let longest = "a".repeat(100);
    assert_eq!(
        parse(&format!("name = \"{longest}\""), &[]).unwrap().name,
        longest
    );
    let message = problem(&format!("name = \"{longest}a\"")).to_string();
    assert!(message.ends_with("1 to 100 bytes"), "{message}");
}

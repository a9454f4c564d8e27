//! Tests of parsing, validation, overrides and the canonical form.

mod agreement;
mod built_in;
mod constellations;
mod metres;
mod nested;
mod overrides;
mod problems;
mod random;
mod search;
mod setting;
mod shells;

use super::{Problems, Scenario, ScenarioProblem};

/// Parses `text` under the label `study.toml`.
fn parse(text: &str, overrides: &[&str]) -> Result<Scenario, Problems> {
    Scenario::parse("study.toml", text.as_bytes(), overrides)
}

fn defaults() -> Scenario {
    parse("", &[]).unwrap()
}

/// The only problem of `text`.
fn problem(text: &str) -> ScenarioProblem {
    let problems = parse(text, &[]).unwrap_err();
    let [problem] = problems.as_slice() else {
        panic!("{text}\nhas not one problem but\n{problems}");
    };
    problem.clone()
}

/// Checks the line, the key, and the message (in part) of the only problem of `section` with `line`.
#[track_caller]
fn refuses(section: &str, line: &str, key: &str, message: &str) {
    let text = format!("name = \"x\"\n\n[{section}]\n{line}\n");
    let problem = problem(&text).to_string();
    let start = format!("study.toml:4: {section}.{key}: ");
    assert!(
        problem.starts_with(&start),
        "{problem}\nstarts not with\n{start}"
    );
    assert!(
        problem.contains(message),
        "{problem}\ncontains not\n{message}"
    );
}

#[track_caller]
fn accepts(section: &str, line: &str) -> Scenario {
    parse(&format!("[{section}]\n{line}\n"), &[]).unwrap_or_else(|problems| panic!("{problems}"))
}

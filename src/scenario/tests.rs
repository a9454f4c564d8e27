//! Tests of parsing, validation, overrides and the canonical form.

mod agreement;
mod built_in;
mod overrides;
mod problems;
mod random;

use super::{Problems, Scenario};

/// Parses `text` under the label `study.toml`.
fn parse(text: &str, overrides: &[&str]) -> Result<Scenario, Problems> {
    Scenario::parse("study.toml", text.as_bytes(), overrides)
}

fn defaults() -> Scenario {
    parse("", &[]).unwrap()
}

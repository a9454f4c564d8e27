//! A validation as text, Markdown and `JUnit`.

use super::{Align, Table, ValidateResult};
use crate::earth;
use crate::validate::Check;
use crate::validate::residuals::{BudgetLine, Ric};
use quick_xml::escape::escape;
use std::fmt::Write;

/// Digits that tell a number of any size apart: four significant ones, plainly written.
pub(super) fn digits(value: f64) -> String {
    let magnitude = if value == 0.0 {
        0.0
    } else {
        value.abs().log10().floor()
    };
    if (-4.0..6.0).contains(&magnitude) {
        format!("{value:.*}", (3.0 - magnitude).clamp(0.0, 7.0) as usize)
    } else {
        format!("{value:.3e}")
    }
}

fn budget_table(budget: &[BudgetLine]) -> Table {
    let right = Align::Right;
    let mut table = Table::new(&[
        ("case", Align::Left),
        ("rms R", right),
        ("I", right),
        ("C (km)", right),
        ("max R", right),
        ("I", right),
        ("C (km)", right),
        ("growth R", right),
        ("I", right),
        ("C (km/day)", right),
    ]);
    let cells = |ric: &Ric| [ric.radial, ric.in_track, ric.cross_track].map(|x| format!("{x:.3}"));
    for line in budget {
        let numbers = [&line.rms_km, &line.max_km, &line.growth_km_per_day].map(cells);
        table.row(
            [line.case.clone()]
                .into_iter()
                .chain(numbers.into_iter().flatten()),
        );
    }
    table
}

fn check_table(checks: &[Check]) -> Table {
    let mut table = Table::new(&[
        ("", Align::Left),
        ("check", Align::Left),
        ("value", Align::Right),
        ("gate", Align::Right),
        ("unit", Align::Left),
    ]);
    for check in checks {
        let verdict = match (check.gate, check.passed) {
            (None, _) => "info",
            (Some(_), true) => "pass",
            (Some(_), false) => "FAIL",
        };
        let gate = check.gate.map_or_else(String::new, digits);
        table.row([
            verdict.to_owned(),
            check.name.clone(),
            digits(check.value),
            gate,
            check.unit.clone(),
        ]);
    }
    table
}

/// What every number rests on, in one line.
fn conventions() -> String {
    format!(
        "mu {} km3/s2, R {} km, J2 {:e}; SGP4: WGS-72, AFSPC mode, B* = 0; TEME; UT1 = UTC",
        earth::MU_KM3_S2,
        earth::RADIUS_KM,
        earth::J2
    )
}

fn verdict(result: &ValidateResult) -> String {
    let gated = result
        .findings
        .checks
        .iter()
        .filter(|check| check.gate.is_some())
        .count();
    let failed = result
        .findings
        .checks
        .iter()
        .filter(|check| !check.passed)
        .count();
    if failed == 0 {
        format!("passed: all {gated} gates are kept")
    } else {
        format!("FAILED: {failed} of {gated} gates are not kept")
    }
}

/// The validation for a terminal.
#[must_use]
pub fn validation_text(result: &ValidateResult) -> String {
    let mut text = format!(
        "{} in scenario {}, navwalker {}\n{}\n",
        result.design.notation,
        result.scenario.name,
        result.version,
        conventions()
    );
    if !result.findings.budget.is_empty() {
        text +=
            "\nError budget: second minus first, radial, in-track and cross-track of the first\n";
        text += &budget_table(&result.findings.budget).to_text();
        for line in &result.findings.budget {
            let worst = &line.worst;
            let _ = writeln!(
                text,
                "{}: {}; worst {} at {} s, {:.3} km",
                line.case, line.cause, worst.satellite, worst.elapsed_s, worst.distance_km
            );
        }
    }
    text += "\nChecks\n";
    text += &check_table(&result.findings.checks).to_text();
    for reason in reasons(&result.findings.checks) {
        let _ = writeln!(text, "{reason}");
    }
    let _ = writeln!(text, "\n{}", verdict(result));
    text
}

/// Why the gates are where they are, each reason once, with the checks that it is for.
fn reasons(checks: &[Check]) -> Vec<String> {
    let mut seen: Vec<(&str, Vec<&str>)> = Vec::new();
    for check in checks {
        match seen.iter_mut().find(|(reason, _)| *reason == check.reason) {
            Some((_, names)) if names.contains(&check.quantity.as_str()) => {}
            Some((_, names)) => names.push(&check.quantity),
            None => seen.push((&check.reason, vec![&check.quantity])),
        }
    }
    seen.iter()
        .map(|(reason, names)| format!("{}: {reason}", names.join(", ")))
        .collect()
}

/// The validation for an appendix.
#[must_use]
pub fn validation_markdown(result: &ValidateResult) -> String {
    let mut text = format!(
        "# Validation of `{}`\n\nScenario {} (`{}`), navwalker {}.\n\n{}.\n\n**{}**\n",
        result.design.notation,
        result.scenario.name,
        result.scenario.hash,
        result.version,
        conventions(),
        verdict(result)
    );
    if !result.findings.budget.is_empty() {
        text += "\n## Error budget\n\nSecond minus first, in the radial, in-track and cross-track axes of the first.\n\n";
        text += &budget_table(&result.findings.budget).to_markdown();
        text += "\n";
        for line in &result.findings.budget {
            let _ = writeln!(text, "- `{}`: {}", line.case, line.cause);
        }
    }
    text += "\n## Checks\n\n";
    text += &check_table(&result.findings.checks).to_markdown();
    text += "\nReasons of the gates:\n\n";
    for reason in reasons(&result.findings.checks) {
        let _ = writeln!(text, "- {reason}");
    }
    text
}

/// The checks as `JUnit` XML: a test case each, with the value as its output.
#[must_use]
pub fn checks_junit(checks: &[Check]) -> String {
    let failures = checks.iter().filter(|check| !check.passed).count();
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<testsuites><testsuite name=\"navwalker validate\" tests=\"{}\" failures=\"{failures}\">",
        checks.len()
    );
    for check in checks {
        let gate = check.gate.map_or_else(|| "none".to_owned(), digits);
        let message = format!(
            "{} {} {}, gate {gate}",
            check.quantity,
            digits(check.value),
            check.unit
        );
        let (name, message) = (escape(check.name.as_str()), escape(message.as_str()));
        let _ = write!(text, "<testcase classname=\"navwalker\" name=\"{name}\">");
        if check.passed {
            let _ = write!(text, "<system-out>{message}</system-out>");
        } else {
            let reason = escape(check.reason.as_str());
            let _ = write!(text, "<failure message=\"{message}\">{reason}</failure>");
        }
        text += "</testcase>\n";
    }
    text += "</testsuite></testsuites>\n";
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_suit_the_size() {
        assert_eq!(digits(8.682_3), "8.682");
        assert_eq!(digits(-300.689), "-300.7");
        assert_eq!(digits(0.000_42), "0.0004200");
        assert_eq!(digits(1.2e-9), "1.200e-9");
        assert_eq!(digits(0.0), "0.000");
    }

    #[test]
    fn junit_is_well_formed_and_escaped() {
        let check = |passed| Check {
            name: "a<b".to_owned(),
            quantity: "\"q\"".to_owned(),
            unit: "km".to_owned(),
            statistic: "max".to_owned(),
            value: 2.0,
            gate: Some(1.0),
            passed,
            reason: "x & y".to_owned(),
        };
        let text = checks_junit(&[check(true), check(false)]);
        let mut reader = quick_xml::Reader::from_str(&text);
        let mut cases = 0;
        loop {
            match reader.read_event().unwrap() {
                quick_xml::events::Event::Start(start) if start.name().as_ref() == "testcase" => {
                    cases += 1
                }
                quick_xml::events::Event::Eof => break,
                _ => {}
            }
        }
        assert_eq!(cases, 2);
        assert!(text.contains("failures=\"1\"") && text.contains("x &amp; y"));
    }
}

//! A validation as text, CSV and `JUnit`; [`appendix`] has what a reviewer reads.

mod appendix;

pub use appendix::validation_markdown;
#[cfg(feature = "figures")]
pub(crate) use appendix::{headline, sections};

use super::{Align, Table};
use crate::keyword::Keyword;
use crate::printable::printable;
use crate::run::{Basis, ValidateResult};
use crate::units::{counted, round_decimal};
use crate::validate::distribution::Distribution;
use crate::validate::file::FileComparison;
use crate::validate::residuals::{BudgetLine, Ric};
use crate::validate::sgp4::SweepCell;
use crate::validate::{Check, Outcome, Tally};
use quick_xml::escape::escape;
use serde::Serialize;
use std::fmt::Write;

/// Four significant digits, in scientific notation only for very large and very small values; `none`
/// if the value is not finite.
pub(crate) fn digits(value: f64) -> String {
    if !value.is_finite() {
        return "none".to_owned();
    }
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
        ("RMS R", right),
        ("I", right),
        ("C (km)", right),
        ("maximum R", right),
        ("I", right),
        ("C (km)", right),
        ("growth R", right),
        ("I", right),
        ("C (km/day)", right),
    ]);
    let cells = |ric: &Ric| {
        [ric.radial, ric.in_track, ric.cross_track].map(|x| format!("{:.3}", round_decimal(x, 3)))
    };
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

/// The checks, with further columns where a report has them.
fn check_table<const N: usize>(
    checks: &[Check],
    further: [(&str, Align); N],
    cells: impl Fn(&Check) -> [String; N],
) -> Table {
    let common = [
        ("", Align::Left),
        ("check", Align::Left),
        ("value", Align::Right),
        ("gate", Align::Right),
        ("unit", Align::Left),
    ];
    let mut table = Table::new(&[common.as_slice(), &further].concat());
    for check in checks {
        let common = [
            check.outcome().to_string(),
            check.name.clone(),
            digits(check.value),
            check.gate.map_or_else(String::new, digits),
            check.unit.clone(),
        ];
        table.row(common.into_iter().chain(cells(check)));
    }
    table
}

/// The conventions behind every number, in one line.
fn conventions(basis: &Basis) -> String {
    let judges: Vec<String> = basis
        .judges
        .iter()
        .map(|one| format!("{} {}", one.name, one.version))
        .collect();
    format!(
        "mu {} km3/s2, R {} km, J2 {:e}; SGP4: WGS-72, AFSPC mode, B* = 0; TEME; UT1 = UTC at the epoch; {}; no random numbers",
        basis.mu_km3_s2,
        basis.radius_km,
        basis.j2,
        judges.join(", ")
    )
}

/// The residuals of the checks and of the budget.
fn distributions(result: &ValidateResult) -> Vec<&Distribution> {
    let of_budget = result.findings.budget.iter();
    of_budget
        .filter_map(|line| line.distance.as_ref())
        .chain(&result.findings.distributions)
        .collect()
}

fn distribution_table(distributions: &[&Distribution]) -> Table {
    let right = Align::Right;
    let mut table = Table::new(&[
        ("residual", Align::Left),
        ("n", right),
        ("median", right),
        ("95 %", right),
        ("99 %", right),
        ("maximum", right),
        ("unit", Align::Left),
        ("worst", Align::Left),
    ]);
    for one in distributions {
        table.row([
            one.name.clone(),
            one.n.to_string(),
            digits(one.median),
            digits(one.q95),
            digits(one.q99),
            digits(one.max),
            one.unit.clone(),
            one.worst.clone(),
        ]);
    }
    table
}

/// Maximum number of satellites of a comparison in a table; JSON has all of them.
const LISTED: usize = 12;

/// The satellites that differ most.
fn satellite_table(comparison: &FileComparison) -> Table {
    let right = Align::Right;
    let mut table = Table::new(&[
        ("slot", Align::Left),
        ("object", Align::Left),
        ("samples", right),
        ("offset R", right),
        ("I", right),
        ("C (km)", right),
        ("drift R", right),
        ("I", right),
        ("C (km/day)", right),
        ("maximum (km)", right),
    ]);
    let mut satellites: Vec<_> = comparison.satellites.iter().collect();
    satellites.sort_by(|a, b| b.max_km.total_cmp(&a.max_km));
    for one in satellites.into_iter().take(LISTED) {
        let ric = |ric: &Ric| [ric.radial, ric.in_track, ric.cross_track].map(digits);
        let head = [
            one.slot.clone(),
            one.object.clone(),
            one.samples.to_string(),
        ];
        let numbers = ric(&one.offset_km)
            .into_iter()
            .chain(ric(&one.drift_km_per_day));
        let cells = head.into_iter().chain(numbers);
        table.row(cells.chain([digits(one.max_km)]));
    }
    table
}

/// The outcome of a comparison, in sentences.
fn comparison_lines(comparison: &FileComparison) -> Vec<String> {
    let mut lines = vec![format!(
        "{} matched by {}{}",
        counted(comparison.satellites.len(), "satellite"),
        comparison.matched_by,
        if comparison.satellites.len() > LISTED {
            format!("; the {LISTED} with the largest differences are listed, JSON has all")
        } else {
            String::new()
        }
    )];
    for (what, names) in [
        ("slots without an object", &comparison.unmatched_slots),
        ("objects without a slot", &comparison.unmatched_objects),
    ] {
        if !names.is_empty() {
            let shown: Vec<_> = names.iter().take(LISTED).map(String::as_str).collect();
            let more = if names.len() > LISTED { " ..." } else { "" };
            lines.push(format!(
                "{} {what}: {}{more}",
                names.len(),
                shown.join(", ")
            ));
        }
    }
    lines.push(match &comparison.explanation {
        Some(found) => {
            let left = match found.before_km {
                Some(before_km) => format!(
                    "with it {} of {} km rms remain",
                    digits(found.after_km),
                    digits(before_km)
                ),
                None => format!(
                    "with it every object matches a slot, {} km rms away",
                    digits(found.after_km)
                ),
            };
            format!("explained by {}: {}; {left}", found.convention, found.meaning)
        }
        None if comparison.agrees => {
            "the states agree with the design to a decimetre".to_owned()
        }
        None if comparison.matched_agree() => {
            "the matched objects agree with the design to a decimetre; the others are missing or belong to another design"
                .to_owned()
        }
        None => {
            "no known convention of a design explains the difference".to_owned()
        }
    });
    lines
}

fn verdict(result: &ValidateResult) -> String {
    Tally::of(&result.findings.checks).to_string()
}

/// The cases of the swept budget that a table shows, after that of the model of the study.
const SWEPT: [(&str, &str); 2] = [
    ("mean-j2/sgp4-no-j3j4", "no J3, J4: R"),
    ("osculating-j2/sgp4-no-j3j4", "osculating: R"),
];

/// The budget by cause over inclination and altitude.
fn sweep_table(sweep: &[SweepCell]) -> Table {
    let right = Align::Right;
    let model = sweep.first().and_then(|cell| cell.budget.first());
    let of_model = model.map_or_else(String::new, |line| format!("{} R", line.case));
    let mut table = Table::new(&[
        ("i (deg)", right),
        ("h (km)", right),
        (of_model.as_str(), right),
        ("I", right),
        ("C", right),
        (SWEPT[0].1, right),
        ("I", right),
        ("C", right),
        (SWEPT[1].1, right),
        ("I", right),
        ("C (km RMS)", right),
        ("Keplerian mean motion (km/day)", right),
        ("fraction of gate", right),
    ]);
    for cell in sweep {
        let case = |name: &str| cell.budget.iter().find(|line| line.case == name);
        let mut cells = vec![
            cell.inclination_deg.to_string(),
            cell.altitude_km.to_string(),
        ];
        let shown = [cell.budget.first(), case(SWEPT[0].0), case(SWEPT[1].0)];
        for line in shown {
            cells.extend(match line {
                Some(line) => line.rms_km.axes().map(|km| format!("{km:.3}")),
                None => [const { String::new() }; 3],
            });
        }
        cells.push(case("kepler-slot").map_or_else(String::new, |line| {
            format!("{:.1}", line.growth_km_per_day.in_track)
        }));
        cells.push(format!("{:.2}", cell.share_of_gate));
        table.row(cells);
    }
    table
}

/// The validation for a terminal.
#[must_use]
pub fn validation_text(result: &ValidateResult) -> String {
    let mut text = format!(
        "{} in scenario {}, propagation model {}, navwalker {}\n{}\n",
        result.subject(),
        result.scenario.name,
        result.model,
        result.version,
        conventions(&result.basis)
    );
    for note in &result.findings.notes {
        let _ = writeln!(text, "note: {note}");
    }
    if !result.findings.budget.is_empty() {
        text += "\nError budget: second minus first, in radial, in-track and cross-track axes of the first\n";
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
    if !result.findings.sweep.is_empty() {
        text += "\nOver inclination and altitude, circular patterns; cases as in the budget\n";
        text += &sweep_table(&result.findings.sweep).to_text();
    }
    text += "\nChecks\n";
    text += &check_table(&result.findings.checks, [], |_| []).to_text();
    for reason in reasons(&result.findings.checks) {
        let _ = writeln!(text, "{reason}");
    }
    let residuals = distributions(result);
    if !residuals.is_empty() {
        text += "\nResiduals\n";
        text += &distribution_table(&residuals).to_text();
    }
    for comparison in &result.findings.files {
        let _ = writeln!(text, "\nFile {}", comparison.source);
        text += &satellite_table(comparison).to_text();
        for line in comparison_lines(comparison) {
            let _ = writeln!(text, "{line}");
        }
    }
    let _ = writeln!(text, "\n{}", verdict(result));
    text
}

/// The reason for each gate, once, with the checks it applies to.
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

/// A check as a row of CSV; JSON has the same fields except the verdict.
#[derive(Serialize)]
struct CheckRecord<'a> {
    name: &'a str,
    quantity: &'a str,
    unit: &'a str,
    statistic: &'a str,
    value: Option<f64>,
    gate: Option<f64>,
    passed: Option<bool>,
    verdict: &'static str,
    reason: &'a str,
}

impl<'a> CheckRecord<'a> {
    fn of(check: &'a Check) -> Self {
        Self {
            name: &check.name,
            quantity: &check.quantity,
            unit: &check.unit,
            statistic: &check.statistic,
            value: check.value.is_finite().then_some(check.value),
            gate: check.gate,
            passed: check.passed,
            verdict: check.outcome().keyword(),
            reason: &check.reason,
        }
    }
}

/// The checks of a validation, one per row.
///
/// # Errors
/// Never for a table in memory.
pub fn checks_csv(checks: &[Check]) -> std::io::Result<String> {
    let records: Vec<CheckRecord<'_>> = checks.iter().map(CheckRecord::of).collect();
    super::records_csv(&records)
}

/// The checks as `JUnit` XML: one test case each, with the value as its output. A check without a
/// gate is a skipped test, which no reader counts as passed.
#[must_use]
pub fn checks_junit(checks: &[Check]) -> String {
    let tally = Tally::of(checks);
    let counts = format!(
        "tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"{}\"",
        checks.len(),
        tally.failed,
        tally.info
    );
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<testsuites {counts}><testsuite name=\"navwalker validate\" {counts}>"
    );
    for check in checks {
        let gate = check.gate.map_or_else(
            || "no gate".to_owned(),
            |gate| format!("gate {}", digits(gate)),
        );
        let message = format!(
            "{} {} {}, {gate}",
            check.quantity,
            digits(check.value),
            check.unit
        );
        let (name, message) = (printable(&check.name), printable(&message));
        let (name, message) = (escape(name.as_ref()), escape(message.as_ref()));
        let reason = escape(check.reason.as_str());
        let _ = write!(text, "<testcase classname=\"navwalker\" name=\"{name}\">");
        let _ = match check.outcome() {
            Outcome::Pass => write!(text, "<system-out>{message}</system-out>"),
            Outcome::Fail => write!(text, "<failure message=\"{message}\">{reason}</failure>"),
            Outcome::Info => write!(
                text,
                "<skipped message=\"info: {message}\"/><system-out>{reason}</system-out>"
            ),
        };
        text += "</testcase>\n";
    }
    text += "</testsuite></testsuites>\n";
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::validate::CheckedQuantity;

    #[test]
    fn digits_suit_the_size() {
        assert_eq!(digits(8.682_3), "8.682");
        assert_eq!(digits(-300.689), "-300.7");
        assert_eq!(digits(0.000_42), "0.0004200");
        assert_eq!(digits(1.2e-9), "1.200e-9");
        assert_eq!(digits(0.0), "0.000");
    }

    fn check(value: f64, gate: Option<f64>) -> Check {
        let quantity = CheckedQuantity {
            quantity: "\"q\"",
            unit: "km",
            statistic: "max",
        };
        Check::new("a<b", quantity, value, gate, "x & y")
    }

    /// One that passes, one that fails, and two without a gate.
    fn checks() -> [Check; 4] {
        [
            check(1.0, Some(1.0)),
            check(2.0, Some(1.0)),
            check(2.0, None),
            check(f64::NAN, None),
        ]
    }

    /// The elements of a name, and the values of an attribute of them.
    fn attributes(text: &str, element: &str, attribute: &str) -> Vec<Option<String>> {
        let mut reader = quick_xml::Reader::from_str(text);
        let mut found = Vec::new();
        loop {
            use quick_xml::events::Event;
            match reader.read_event().unwrap() {
                Event::Start(start) | Event::Empty(start) if start.name().as_ref() == element => {
                    let value = start.try_get_attribute(attribute).unwrap();
                    found.push(value.map(|value| {
                        let value = value.normalized_value(quick_xml::XmlVersion::default());
                        value.unwrap().into_owned()
                    }));
                }
                Event::Eof => return found,
                _ => {}
            }
        }
    }

    /// A line without a gate does not count as a passed test.
    #[test]
    fn junit_counts_as_the_other_formats_do() {
        let text = checks_junit(&checks());
        assert_eq!(attributes(&text, "testcase", "name").len(), 4);
        for (attribute, count) in [("tests", "4"), ("failures", "1"), ("skipped", "2")] {
            let stated = attributes(&text, "testsuite", attribute);
            assert_eq!(stated, [Some(count.to_owned())], "{attribute}");
        }
        assert_eq!(attributes(&text, "failure", "message").len(), 1);
        let skipped = attributes(&text, "skipped", "message");
        assert_eq!(skipped.len(), 2);
        assert_eq!(skipped[0].as_deref(), Some("info: \"q\" 2.000 km, no gate"));
        assert!(text.contains("x &amp; y") && text.contains("a&lt;b"));
    }

    #[test]
    fn every_format_says_info_of_a_line_without_a_gate() {
        let checks = checks();
        assert_eq!(
            Tally::of(&checks).to_string(),
            "FAILED: 1 of 2 gates; 2 checks have no gate (info)"
        );
        let table = check_table(&checks, [], |_| []).to_text();
        let verdicts: Vec<&str> = table
            .lines()
            .filter_map(|line| line.split_whitespace().next())
            .filter(|word| Outcome::from_keyword(word).is_ok())
            .collect();
        assert_eq!(verdicts, ["pass", "FAIL", "info", "info"]);
        let csv = checks_csv(&checks).unwrap();
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let columns = reader.headers().unwrap().clone();
        let at = |name: &str| columns.iter().position(|column| column == name).unwrap();
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        let cells = |name: &str| -> Vec<String> {
            rows.iter().map(|row| row[at(name)].to_owned()).collect()
        };
        assert_eq!(cells("verdict"), ["pass", "FAIL", "info", "info"]);
        assert_eq!(cells("passed"), ["true", "false", "", ""]);
        let json = serde_json::to_value(checks).unwrap();
        let passed: Vec<&serde_json::Value> = (json.as_array().unwrap().iter())
            .map(|check| &check["passed"])
            .collect();
        assert!(passed[0] == true && passed[1] == false);
        assert!(passed[2].is_null() && passed[3].is_null() && json[3]["gate"].is_null());
    }
}

//! Proof that each gate can fail: parts of the library are replaced by faulty ones, and the gates
//! meant for the error, and only related ones, must fail.
//!
//! The gates are those of [`CAUGHT_ERRORS`], as in the table of `validation/README.md`; tests compare them.

mod theories;
mod views;

use super::{CAUGHT_ERRORS, Findings, Parts, Subject, Target, caught_by, testing};
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// A planted error.
struct PlantedError {
    /// The error, as the table of the documentation names it.
    error: &'static str,
    /// The model of the study.
    model: Model,
    /// The library with the error in it.
    parts: fn() -> Parts,
    /// The targets that use the part.
    reaches: &'static [Target],
    /// Parts of the names of all gates that may fail.
    related: &'static [&'static str],
}

impl PlantedError {
    /// The gates that fail.
    fn fails(&self) -> &'static [&'static str] {
        let caught = CAUGHT_ERRORS
            .iter()
            .find(|caught| caught.error == self.error);
        caught.map_or(&[], |caught| caught.gates)
    }
}

/// The errors, in the order of the documentation.
fn planted() -> Vec<&'static PlantedError> {
    theories::ERRORS.iter().chain(views::ERRORS).collect()
}

/// All targets except the paper, which concerns other designs.
const TARGETS: [Target; 4] = [
    Target::Sgp4,
    Target::GeographicLib,
    Target::Numerical,
    Target::Analytic,
];

/// The findings of some targets on a design at 40°, where no error cancels out, at an epoch that a
/// TLE cannot represent, in steps shorter than a pass.
fn findings(model: Model, parts: Parts, targets: &[Target]) -> Findings {
    let epoch = Epoch::from_utc("2025-03-20T11:22:33.4444444Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 86_400.0, 480.0).unwrap();
    let evaluator = testing::evaluator_of(model, grid);
    let subject = Subject {
        shell: "delta:40:30/6/1@925".parse().unwrap(),
        evaluator: &evaluator,
        parts,
        number: None,
    };
    let mut findings = Findings::default();
    for target in targets {
        findings.append(target.findings(&subject).unwrap());
    }
    findings
}

fn failures(model: Model, parts: Parts, targets: &[Target]) -> BTreeSet<String> {
    let found = findings(model, parts, targets);
    found.failures().map(|check| check.name.clone()).collect()
}

/// Every error fails the gates that the table lists and no unrelated one, and every gate of the
/// default model fails under some error.
#[test]
fn each_error_fails_its_gates_and_each_gate_can_fail() {
    let mut missed: BTreeSet<String> = BTreeSet::new();
    let errors = planted();
    let failed: Vec<BTreeSet<String>> = errors
        .par_iter()
        .map(|planted| failures(planted.model, (planted.parts)(), planted.reaches))
        .collect();
    let mut complaints = Vec::new();
    for (planted, failed) in errors.into_iter().zip(failed) {
        let quiet = planted
            .fails()
            .iter()
            .filter(|gate| !failed.contains(**gate));
        complaints.extend(quiet.map(|gate| format!("{}: {gate} did not fail", planted.error)));
        let related = |name: &&String| planted.related.iter().any(|kind| name.contains(kind));
        let unrelated = failed.iter().filter(|name| !related(name));
        complaints
            .extend(unrelated.map(|gate| format!("{}: unrelated {gate} failed", planted.error)));
        missed.extend(failed);
    }
    let gates = findings(Model::J2, Parts::default(), &TARGETS).checks;
    let gates = gates.into_iter().filter(|check| check.gate.is_some());
    let never = gates.filter(|check| !missed.contains(&check.name));
    complaints.extend(never.map(|check| format!("{} fails under no error", check.name)));
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn nothing_fails_without_an_error() {
    for model in [Model::J2, Model::J2Osculating, Model::Sgp4] {
        assert_eq!(
            failures(model, Parts::default(), &TARGETS),
            BTreeSet::new(),
            "{model}"
        );
    }
}

/// Each error that a report names is planted here, and a check is found by the end of its name.
#[test]
fn the_errors_of_reports_are_the_planted_ones() {
    let names: Vec<&str> = planted().iter().map(|planted| planted.error).collect();
    let of_reports: Vec<&str> = CAUGHT_ERRORS.iter().map(|caught| caught.error).collect();
    assert_eq!(names, of_reports);
    let of_shell: Vec<&str> = caught_by("A/geographiclib/azimuth").collect();
    assert_eq!(of_shell, ["swapped azimuth axes"]);
    assert_eq!(caught_by("ageographiclib/azimuth").count(), 0);
}

/// The documentation has the rows of the table, and no others.
#[test]
fn the_documented_table_is_this_one() {
    let text = include_str!("../../validation/README.md");
    let section = text.split("## Planted errors").nth(1).unwrap();
    let section = section.split("\n## ").next().unwrap();
    let documented: Vec<&str> = section
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(2)
        .collect();
    let rows: Vec<String> = planted()
        .into_iter()
        .map(|planted| {
            let gates: Vec<String> = planted
                .fails()
                .iter()
                .map(|gate| format!("`{gate}`"))
                .collect();
            let model = planted.model;
            format!("| {} | `{model}` | {} |", planted.error, gates.join(", "))
        })
        .collect();
    assert_eq!(documented, rows, "the rows are:\n{}", rows.join("\n"));
}

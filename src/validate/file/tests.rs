use super::*;
use crate::constellation::Design;
use crate::evaluate::Evaluator;
use crate::formats::export::{Choices, Product, Subject as Exported, testing::in_memory};
use crate::formats::manifest::Study;
use crate::formats::trajectory::Trajectory;
use crate::frames::Frame;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use crate::validate::testing;

const DESIGN: &str = "delta:40:20/5/1@925";

fn epoch() -> Epoch {
    Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap())
}

fn grid() -> TimeGrid {
    TimeGrid::new(epoch(), 43_200.0, 300.0).unwrap()
}

fn evaluator() -> Evaluator {
    testing::evaluator(grid())
}

fn design() -> Design {
    DESIGN.parse().unwrap()
}

/// The design as another program might have flown it, sampled in TEME.
fn flown(convention: &str) -> Vec<Comparand> {
    let evaluator = evaluator();
    let subject = Subject::new(design(), &evaluator);
    conventions::flown(&subject, convention)
        .into_iter()
        .map(|(name, flight)| {
            let states = grid()
                .iter()
                .map(|t| (epoch().plus_seconds(t), flight.state_at(t).unwrap()));
            Comparand::States(Trajectory {
                id: name.clone(),
                name,
                frame: Frame::Teme,
                states: states.collect(),
            })
        })
        .collect()
}

fn renamed(mut comparands: Vec<Comparand>) -> Vec<Comparand> {
    for (n, comparand) in comparands.iter_mut().enumerate() {
        if let Comparand::States(trajectory) = comparand {
            trajectory.name = format!("SAT{n}");
        }
    }
    comparands
}

fn compared(comparands: &[Comparand]) -> Result<Findings, ValidateError> {
    let evaluator = evaluator();
    against_file(&Subject::new(design(), &evaluator), "test", comparands)
}

/// Every convention that the list knows is found again from what it makes, by name and by place.
#[test]
fn each_convention_explains_its_own_ephemeris() {
    for name in conventions::names().filter(|name| *name != "mean-j2") {
        // For a delta pattern the second is no mistake that could be made.
        if name == "delta-for-star" {
            continue;
        }
        let findings = compared(&flown(name)).unwrap();
        let comparison = &findings.files[0];
        let found = comparison
            .explanation
            .as_ref()
            .map(|e| e.convention.as_str());
        assert_eq!(found, Some(name), "{:?}", comparison.explanation);
        assert_eq!(comparison.matched_by, "name");
        assert!(findings.passed(), "{name}: {:#?}", findings.checks);
    }
}

#[test]
fn the_design_itself_needs_no_explanation() {
    let findings = compared(&renamed(flown("mean-j2"))).unwrap();
    let comparison = &findings.files[0];
    assert_eq!(comparison.matched_by, "place");
    assert!(comparison.agrees && comparison.explanation.is_none());
    // Instants are kept to the nanosecond: 1e-5 m at 7.5 km/s.
    assert!(comparison.satellites.iter().all(|one| one.max_km < 1e-7));
    assert!(findings.passed());
    let flips = findings
        .checks
        .iter()
        .find(|c| c.name == "file/test/flipped-decisions");
    assert_eq!(flips.unwrap().value, 0.0);
}

/// What is exported comes back: each format by its own reader, in its own frame.
#[test]
fn exported_files_are_the_design() {
    let subject = Exported {
        design: design(),
        model: Model::J2,
        grid: grid(),
        study: Study {
            name: "test".to_owned(),
            hash: String::new(),
        },
        originator: "TEST".to_owned(),
        creation: epoch(),
    };
    for (product, most_km) in [
        // Nine decimals of a km; EME2000 there and back.
        (Product::Oem, 1e-6),
        // Six decimals of a km.
        (Product::Sp3, 2e-6),
        (Product::Stk, 1e-6),
        // SGP4 is another theory: the budget of SGP4.
        (Product::Tle, 25.0),
        (Product::Omm, 25.0),
    ] {
        let (_, files) = in_memory(&subject, &[product], Choices::default());
        let mut comparands = Vec::new();
        for (path, bytes) in &files {
            if path != "manifest.json" {
                comparands.extend(read(path, bytes.as_slice()).unwrap());
            }
        }
        let findings = compared(&comparands).unwrap();
        let comparison = &findings.files[0];
        assert!(findings.passed(), "{product:?}: {:#?}", findings.checks);
        let worst = comparison
            .satellites
            .iter()
            .map(|one| one.max_km)
            .fold(0.0, f64::max);
        assert!(worst < most_km, "{product:?}: {worst}");
    }
}

#[test]
fn missing_and_surplus_objects_fail_by_name() {
    let mut comparands = flown("mean-j2");
    comparands.remove(3);
    let findings = compared(&comparands).unwrap();
    assert_eq!(findings.files[0].unmatched_slots, ["NW-P01-S04"]);
    let failed: Vec<_> = findings
        .checks
        .iter()
        .filter(|c| !c.passed)
        .map(|c| c.name.as_str())
        .collect();
    assert_eq!(failed, ["file/test/unmatched-slots"]);
    // No metrics of part of a constellation.
    assert!(
        findings
            .checks
            .iter()
            .all(|c| !c.name.ends_with("mean-visible"))
    );
}

#[test]
fn another_epoch_is_an_error_that_says_so() {
    let mut comparands = flown("mean-j2");
    for comparand in &mut comparands {
        if let Comparand::States(trajectory) = comparand {
            for (at, _) in &mut trajectory.states {
                *at = at.plus_seconds(10.0 * 86_400.0);
            }
        }
    }
    let error = compared(&comparands).unwrap_err().to_string();
    assert!(error.contains("2025-01-11T00:00:00Z"), "{error}");
}

#[test]
fn a_short_span_fails_and_is_measured() {
    let mut comparands = flown("mean-j2");
    if let Comparand::States(trajectory) = &mut comparands[0] {
        trajectory.states.truncate(73);
    }
    let findings = compared(&comparands).unwrap();
    let check = findings
        .checks
        .iter()
        .find(|c| c.name == "file/test/uncovered-span")
        .unwrap();
    // 72 of 143 steps are covered.
    assert!(!check.passed && (check.value - 71.0 / 143.0).abs() < 1e-12);
}

#[test]
fn a_file_that_breaks_its_format_is_named() {
    let error = read("x.oem", "CCSDS_OEM_VERS = 9.0\n".as_bytes())
        .unwrap_err()
        .to_string();
    assert!(error.starts_with("x.oem: line 1"), "{error}");
}

/// Orekit integrates J2 from the design's elements, which it takes as osculating: the comparison
/// says so, and what is left is that of two integrators.
#[test]
fn validate_an_ephemeris_of_orekit() {
    const OREKIT: &[u8] = include_bytes!("../../../validation/cases/orekit/j2-from-osculating.oem");
    let evaluator = testing::evaluator(TimeGrid::new(epoch(), 21_600.0, 600.0).unwrap());
    let subject = Subject::new("delta:40:8/4/1@925".parse().unwrap(), &evaluator);
    let findings = against_file(&subject, "orekit", &read("orekit.oem", OREKIT).unwrap()).unwrap();
    assert!(findings.passed(), "{:#?}", findings.checks);
    let comparison = &findings.files[0];
    assert_eq!(
        (comparison.matched_by.as_str(), comparison.satellites.len()),
        ("place", 8)
    );
    let explanation = comparison.explanation.as_ref().unwrap();
    assert_eq!(explanation.convention, "elements-taken-as-osculating");
    // Both integrate to well below a metre in six hours; the file has 1e-9 km.
    assert!(explanation.after_km < 1e-6, "{explanation:?}");
    assert!(explanation.before_km > 10.0, "{explanation:?}");
}

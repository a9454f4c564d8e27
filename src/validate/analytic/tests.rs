use super::*;
use crate::evaluate::{Evaluator, Setup};
use crate::keyword::Keyword;
use crate::time::{Epoch, TimeGrid};
use crate::validate::testing;
use crate::visibility::Mask;

#[test]
fn closed_forms_hold_for_every_pattern() {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 86_400.0, 300.0).unwrap();
    for model in Model::ALL {
        let evaluator = testing::evaluator_of(*model, grid);
        holds_for_every_pattern(&evaluator);
    }
}

fn holds_for_every_pattern(evaluator: &Evaluator) {
    let model = evaluator.setup().model;
    for notation in [
        "delta:55:60/6/1@925",
        "delta:40:24/4/3@600",
        "star:86.4:66/6/2@780",
        "lattice:63.4:45/9/5@1200,e=0.02,w=270",
        "delta:55:1/1/0@925",
    ] {
        let subject = Subject::new(notation.parse().unwrap(), evaluator);
        let findings = against_closed_forms(&subject).unwrap();
        let failed: Vec<_> = findings.failures().collect();
        assert!(failed.is_empty(), "{model} {notation}: {failed:#?}");
    }
}

/// Passes that fall between samples are no fault of the propagation: what is counted is reported without a gate.
#[test]
fn a_step_longer_than_a_pass_has_no_gate() {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let check = |step_s: f64| {
        let grid = TimeGrid::new(epoch, 86_400.0, step_s).unwrap();
        let evaluator = testing::evaluator_of(Model::J2, grid);
        let subject = Subject::new("star:86.4:66/6/2@780".parse().unwrap(), &evaluator);
        let mut found = quadrature::checks(&subject).unwrap().into_iter();
        found
            .find(|check| check.name == "analytic/mean-visible")
            .unwrap()
    };
    // A satellite at 780 km passes over a site in about eight minutes.
    let (fine, coarse) = (check(300.0), check(3600.0));
    assert!(fine.gate.is_some() && fine.value.abs() < fine.gate.unwrap());
    assert_eq!(coarse.gate, None);
    assert!(
        coarse
            .reason
            .contains("a step of 3600 s is longer than a pass"),
        "{}",
        coarse.reason
    );
}

#[test]
fn a_constellation_that_is_never_seen_has_no_relative_difference() {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 86_400.0, 300.0).unwrap();
    let setup = testing::evaluator_of(Model::J2, grid).setup().clone();
    let mask = Mask::from_degrees(89.0).unwrap();
    let evaluator = Evaluator::new(Setup { mask, ..setup }).unwrap();
    // Never over the points, which begin at 5° N.
    let subject = Subject::new("delta:1:4/2/1@200".parse().unwrap(), &evaluator);
    let found = quadrature::checks(&subject).unwrap();
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].value, 0.0);
}

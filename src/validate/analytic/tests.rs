use super::*;
use crate::evaluate::Evaluator;
use crate::keyword::Keyword;
use crate::time::{Epoch, TimeGrid};
use crate::validate::testing;

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

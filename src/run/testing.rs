//! Members of a front for tests.

use super::{DesignSummary, Diagnostic, FrontMember, Hypervolume, ScenarioStamp, SearchSummary};
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::evaluate::testing::no_metrics;

/// A member with this index and design and few visible satellites.
pub(crate) fn member(index: usize, notation: &str) -> FrontMember {
    let design: Design = notation.parse().unwrap();
    FrontMember {
        index,
        name: None,
        design: Some(DesignSummary::from(&design)),
        files: None,
        shells: Vec::new(),
        metrics: Metrics {
            mean_visible: 8.0,
            ..no_metrics()
        },
        objectives: Vec::new(),
        constraints: Vec::new(),
        membership: 0.5,
        membership_sum: 0.5,
        chosen: false,
    }
}

/// A search by another version, with a diagnostic.
pub(crate) fn summary() -> SearchSummary {
    SearchSummary {
        evaluations: 900,
        hypervolume: Hypervolume {
            value: Some(0.6),
            reference: Some(vec![2.0, 22.0]),
            chosen: false,
            at_chosen: None,
        },
        seed: 7,
        algorithm: "nsga2".to_owned(),
        generations: [30, 30],
        fixed: None,
        diagnostics: vec![Diagnostic::new("c", "m".to_owned())],
        certificate: None,
        scenario: ScenarioStamp {
            name: "paper".to_owned(),
            hash: "h".to_owned(),
        },
        version: "0.0.0".to_owned(),
    }
}

//! Members of a front for tests.

use super::{DesignSummary, Diagnostic, FrontMember, Hypervolume, ScenarioStamp, SearchSummary};
use crate::constellation::Design;
use crate::evaluate::{Coverage, Metrics};

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
            mean_pdop: None,
            cvar_pdop: None,
            cvar_level: 0.95,
            p50_pdop: None,
            p95_pdop: None,
            p99_pdop: None,
            max_pdop: None,
            solved_fraction: 0.0,
            availability: 0.0,
            j_pos: None,
            j_cost: None,
            least_visible: 0,
            coverage: Coverage::default(),
            mean_gnss_visible: 0.0,
            mean_total_visible: 0.0,
            coverage_total: Coverage::default(),
            longest_outage_s: 0.0,
            longest_outage_cut: false,
            p95_hdop: None,
            p95_vdop: None,
            information_pdop: None,
            sigma_3d_m: None,
            sigma_h_m: None,
            sigma_v_m: None,
            error95_3d_m: None,
            error95_h_m: None,
            error95_v_m: None,
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

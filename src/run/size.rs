//! The result of a search for the fewest satellites, and its certificate.

mod tables;

pub use tables::{basis_word, certificate_heading, certificate_rows, size_csv};

use super::results::{DesignSummary, ScenarioStamp};
use crate::constellation::Design;
use crate::evaluate::Metrics;
use crate::search::size::{
    ClosestDesign, KeptDesign, LevelSummary, RefinedDesign, RejectionBasis, SizeProblem,
    SizeSearch, Witness,
};
use serde::{Deserialize, Serialize};

/// The result.
pub const SIZE_JSON: &str = "size.json";
/// The designs with the fewest satellites as a table.
pub const SIZE_CSV: &str = "size.csv";
/// The proof for each rejected design.
pub const CERTIFICATE_CSV: &str = "certificate.csv";
/// The state of the search.
pub const SIZE_CHECKPOINT: &str = "size.checkpoint";

/// A design that keeps all constraints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizedDesign {
    /// Place among the designs of its number of satellites, from 1.
    pub rank: usize,
    /// The design.
    pub design: DesignSummary,
    /// Its metrics.
    pub metrics: Metrics,
    /// The least distance of a constrained quantity from its bound, relative to the bound (absolute for bounds below 1).
    pub margin: f64,
    /// Each constraint with the value of its quantity.
    pub constraints: Vec<KeptConstraint>,
}

/// A constraint and how far it is kept.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct KeptConstraint {
    /// The constraint as written.
    pub constraint: String,
    /// The value of its quantity; `None` if it has none.
    pub value: Option<f64>,
    /// Distance of the value from the bound, in the unit of the quantity; negative on the wrong side.
    pub margin: Option<f64>,
}

/// The designs of one number of satellites, all of them rejected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RejectedLevel {
    /// Satellites.
    pub satellites: usize,
    /// Designs of the grid.
    pub designs: u64,
    /// The proofs for the designs that came closest; the certificate has those for all.
    pub witnesses: Vec<Witness>,
}

/// The designs of a number of satellites above the fewest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LevelAbove {
    /// Satellites.
    pub satellites: usize,
    /// Designs of the grid.
    pub designs: u64,
    /// Designs that keep the constraints.
    pub kept: u64,
    /// The best of them by margin.
    pub best: Vec<SizedDesign>,
}

/// The best that was reached with some satellites where nothing keeps the constraints.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BestReached {
    /// Satellites.
    pub satellites: usize,
    /// The one that violates the constraints least.
    pub design: DesignSummary,
    /// Sum of its violations.
    pub violation: f64,
    /// Each constraint with the value of its quantity.
    pub constraints: Vec<KeptConstraint>,
}

/// A point of the front of satellites against a further objective.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeFrontMember {
    /// Satellites.
    pub satellites: usize,
    /// Value of the objective.
    pub value: f64,
    /// The design that has it.
    pub design: DesignSummary,
    /// Its metrics.
    pub metrics: Metrics,
}

/// The exact front of satellites against a further objective, up to a number of satellites.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeFront {
    /// The objective.
    pub objective: String,
    /// Satellites up to which the front is exact.
    pub up_to: usize,
    /// Its points, by satellites.
    pub members: Vec<SizeFrontMember>,
}

/// The best design around one of the grid, with values between the steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Refinement {
    /// Satellites.
    pub satellites: usize,
    /// Notation of the design of the grid.
    pub from: String,
    /// The best that was found.
    pub design: DesignSummary,
    /// Whether it keeps the constraints.
    pub kept: bool,
    /// Sum of its violations.
    pub violation: f64,
    /// Each constraint with the value of its quantity.
    pub constraints: Vec<KeptConstraint>,
    /// Designs that were evaluated.
    pub evaluations: u64,
}

/// A design under other samples than those that the answer is exact for.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RobustnessRow {
    /// Notation of the design.
    pub design: String,
    /// Its satellites.
    pub satellites: usize,
    /// The samples: `scenario`, `half step`, `half grid`, `phase 1/8` and so on.
    pub samples: String,
    /// Whether it keeps the constraints there.
    pub kept: bool,
    /// Each constraint with the value of its quantity.
    pub constraints: Vec<KeptConstraint>,
}

/// How much was evaluated.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SizeEvaluations {
    /// Designs of which at least one sample was evaluated.
    pub begun: u64,
    /// Designs that were evaluated in full.
    pub finished: u64,
    /// Samples that were evaluated, as a share of those of all designs that were tried.
    pub samples_share: f64,
}

/// What a rule rejected.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RuleReport {
    /// The constraint.
    pub constraint: String,
    /// How it rejected.
    pub basis: RejectionBasis,
    /// Designs that it rejected.
    pub designs: u64,
    /// Share of the samples of these designs that need not be evaluated.
    pub samples_saved: f64,
}

/// The certificate that goes with a result.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SizeCertificate {
    /// Its file.
    pub path: String,
    /// Rejected designs in it, one a line.
    pub designs: u64,
    /// Its SHA-256, hex.
    pub sha256: String,
}

/// The output of `size` and the content of `size.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SizeResult {
    /// The fewest satellites of the grid that keep the constraints; `None` if no design does.
    pub fewest: Option<usize>,
    /// All designs of that number that keep the constraints, the best first: by the least margin of their
    /// constraints, then by fewer planes, then in the order of the grid.
    pub designs: Vec<SizedDesign>,
    /// The next numbers of satellites.
    pub above: Vec<LevelAbove>,
    /// Fewer satellites: every design is rejected.
    pub rejected: Vec<RejectedLevel>,
    /// If nothing keeps the constraints, the best by number of satellites.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub best_reached: Vec<BestReached>,
    /// Satellites against a further objective, if asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub front: Option<SizeFront>,
    /// Around the best designs and the closest rejected ones, the best between the steps of the grid: evidence of what a
    /// finer grid would give, not a proof.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub refinement: Vec<Refinement>,
    /// The best designs, and the closest of those rejected with one satellite number less, at half the step, on half
    /// the grid and at eight phases of the GNSS.
    pub robustness: Vec<RobustnessRow>,
    /// The constraints.
    pub constraints: Vec<String>,
    /// PDOP up to which a sample counts as available.
    pub availability_pdop: f64,
    /// Samples for which the answer is exact.
    pub samples: u64,
    /// Designs that were tried: all of the grid up to the last number of satellites.
    pub designs_tried: u64,
    /// How much was evaluated.
    pub evaluations: SizeEvaluations,
    /// What each rule rejected.
    pub rules: Vec<RuleReport>,
    /// The proofs.
    pub certificate: SizeCertificate,
    /// The study.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: String,
}

/// Designs that are looked at under other samples and between the steps.
const LOOKED_AT: usize = 3;

impl SizeResult {
    /// The result of a finished search.
    #[must_use]
    pub fn new(
        problem: &SizeProblem<'_>,
        search: &SizeSearch,
        closest: &[ClosestDesign],
        certificate: SizeCertificate,
        scenario: ScenarioStamp,
    ) -> Self {
        let setup = problem.problem().evaluator().setup();
        let fewest = search.fewest();
        let is_below = |level: &&LevelSummary| fewest.is_none_or(|n| level.satellites < n);
        let is_above = |level: &&LevelSummary| fewest.is_some_and(|n| level.satellites > n);
        let of_fewest = search
            .levels()
            .iter()
            .find(|l| Some(l.satellites) == fewest);
        let below: Vec<_> = search.levels().iter().filter(is_below).collect();
        let above = search.levels().iter().filter(is_above);
        Self {
            fewest,
            designs: of_fewest.map_or_else(Vec::new, |level| sized(problem, &level.best)),
            above: above
                .map(|level| LevelAbove {
                    satellites: level.satellites,
                    designs: level.designs,
                    kept: level.kept,
                    best: sized(problem, &level.best),
                })
                .collect(),
            best_reached: match fewest {
                Some(_) => Vec::new(),
                None => best_reached(problem, closest),
            },
            rejected: below.into_iter().map(rejected).collect(),
            front: front(search),
            refinement: Vec::new(),
            robustness: Vec::new(),
            constraints: problem
                .constraints()
                .iter()
                .map(ToString::to_string)
                .collect(),
            availability_pdop: setup.metrics.availability_pdop,
            samples: setup.sample_count() as u64,
            designs_tried: search.tried(),
            evaluations: SizeEvaluations {
                begun: search.begun(),
                finished: search.finished(),
                samples_share: search.samples_share(problem),
            },
            rules: rules(problem, search),
            certificate,
            scenario,
            version: super::VERSION.to_owned(),
        }
    }

    /// The best designs of the fewest satellites.
    #[must_use]
    pub fn best(&self) -> Vec<Design> {
        let best = self.designs.iter().take(LOOKED_AT);
        best.filter_map(|one| one.design.design()).collect()
    }

    /// Reads `size.json`.
    ///
    /// # Errors
    /// If the bytes are not such a result.
    pub fn read(bytes: &[u8]) -> serde_json::Result<Self> {
        serde_json::from_slice(bytes)
    }
}

fn rejected(level: &LevelSummary) -> RejectedLevel {
    RejectedLevel {
        satellites: level.satellites,
        designs: level.designs,
        witnesses: level.witnesses.clone(),
    }
}

fn sized(problem: &SizeProblem<'_>, designs: &[KeptDesign]) -> Vec<SizedDesign> {
    let one = |(n, kept): (usize, &KeptDesign)| {
        let design: Design = kept.design.parse().ok()?;
        Some(SizedDesign {
            rank: n + 1,
            design: DesignSummary::from(&design),
            metrics: kept.metrics,
            margin: kept.margin,
            constraints: constraints(problem, &design, &kept.metrics),
        })
    };
    designs.iter().enumerate().filter_map(one).collect()
}

fn constraints(
    problem: &SizeProblem<'_>,
    design: &Design,
    metrics: &Metrics,
) -> Vec<KeptConstraint> {
    let all = problem.violations(design, metrics);
    all.map(|(constraint, value, _)| KeptConstraint {
        constraint: constraint.to_string(),
        value,
        margin: value.map(|value| constraint.inside(value)),
    })
    .collect()
}

/// Some designs under the samples of a problem.
#[must_use]
pub fn robustness(
    problem: &SizeProblem<'_>,
    designs: &[Design],
    samples: &str,
) -> Vec<RobustnessRow> {
    let row = |design: &Design| {
        let metrics = problem.assessed(design)?;
        let mut violations = problem.violations(design, &metrics);
        Some(RobustnessRow {
            design: design.to_string(),
            satellites: design.satellite_count() + problem.satellites_beside(),
            samples: samples.to_owned(),
            kept: violations.all(|(.., violation)| violation == 0.0),
            constraints: constraints(problem, design, &metrics),
        })
    };
    designs.iter().filter_map(row).collect()
}

/// The best of each number of satellites.
fn best_reached(problem: &SizeProblem<'_>, closest: &[ClosestDesign]) -> Vec<BestReached> {
    let levels = closest.chunk_by(|a, b| a.satellites == b.satellites);
    let best = levels.filter_map(|level| level.first());
    best.map(|one| BestReached {
        satellites: one.satellites,
        violation: one.violation,
        constraints: constraints(problem, &one.design, &one.metrics),
        design: DesignSummary::from(&one.design),
    })
    .collect()
}

/// What was found between the steps.
#[must_use]
pub fn refinements(problem: &SizeProblem<'_>, refined: &[RefinedDesign]) -> Vec<Refinement> {
    let of = |one: &RefinedDesign| Refinement {
        satellites: one.satellites,
        from: one.from.clone(),
        design: DesignSummary::from(&one.design),
        kept: one.violation == 0.0,
        violation: one.violation,
        constraints: constraints(problem, &one.design, &one.metrics),
        evaluations: one.evaluations,
    };
    refined.iter().map(of).collect()
}

/// What no design with fewer satellites has.
fn front(search: &SizeSearch) -> Option<SizeFront> {
    let objective = search.objective()?;
    let mut members: Vec<SizeFrontMember> = Vec::new();
    for level in search.levels() {
        let best = level.best_by_objective.as_ref();
        let Some((best, value)) = best.and_then(|best| Some((best, best.objective?))) else {
            continue;
        };
        let is_better = members
            .last()
            .is_none_or(|last| objective.minimised(value) < objective.minimised(last.value));
        let design = best.design.parse::<Design>().ok();
        if let Some(design) = design.filter(|_| is_better) {
            members.push(SizeFrontMember {
                satellites: level.satellites,
                value,
                design: DesignSummary::from(&design),
                metrics: best.metrics,
            });
        }
    }
    Some(SizeFront {
        objective: objective.to_string(),
        up_to: search.levels().last().map_or(0, |level| level.satellites),
        members,
    })
}

fn rules(problem: &SizeProblem<'_>, search: &SizeSearch) -> Vec<RuleReport> {
    let report = |saving: &crate::search::size::RuleSaving| RuleReport {
        constraint: saving.constraint.clone(),
        basis: saving.basis,
        designs: saving.designs,
        samples_saved: problem.samples_share(1) * saving.tiles_saved as f64
            / saving.designs.max(1) as f64,
    };
    search.savings().iter().map(report).collect()
}

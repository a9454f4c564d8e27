//! Results in formats for people and for programs.

mod baseline;
mod certificate;
pub mod coastline;
mod compared;
mod comparison_columns;
mod csv;
mod deployment;
mod diagnostics;
mod diff;
#[cfg(feature = "figures")]
mod dominance;
mod evaluated;
#[cfg(feature = "figures")]
mod evidence_page;
mod expected;
pub mod failures;
#[cfg(feature = "figures")]
pub mod figures;
mod from_evaluations;
pub(crate) mod front_table;
mod labels;
mod lifetime;
mod orbits;
#[cfg(feature = "figures")]
pub mod page;
pub(crate) mod phases;
pub mod profile;
mod relative_nodes;
mod results;
pub(crate) mod section;
mod seeds;
mod separations;
pub(crate) mod shown;
mod size;
#[cfg(feature = "figures")]
mod size_page;
mod skies;
mod studies;
mod study_files;
#[cfg(feature = "figures")]
mod study_page;
mod study_sections;
#[cfg(all(feature = "figures", feature = "sweep"))]
mod sweep_page;
#[cfg(all(feature = "figures", feature = "sweep"))]
mod sweep_summary;
mod table;
#[cfg(feature = "validate")]
pub(crate) mod validation;
#[cfg(feature = "figures")]
mod validation_page;

pub use baseline::{Baseline, compared_designs};
pub use compared::Compared;
pub use comparison_columns::{ComparisonColumn, comparison_columns, on_demand_quantities};
pub use csv::{ConstellationColumns, outages_csv, records_csv};
pub use deployment::{DeploymentSummary, PhaseService};
pub use diagnostics::{at_bounds, diagnose, dominated_by, seed_spread};
pub use diff::{Diff, Moved, ResultFile, ResultFileError, Side, Tolerance};
pub use evaluated::{
    Alone, Assessment, ConstellationEntry, ConstellationResult, ConstellationSummary,
    ConstraintCheck, EvaluateResult,
};
#[cfg(feature = "figures")]
pub use evidence_page::EvidencePageError;
pub use expected::{ExpectedService, SpareService};
pub use from_evaluations::{EvaluatedFront, EvaluationSource, NotEvaluated};
pub use labels::quantity_label;
pub use lifetime::{
    DesignLifetime, DisposalResult, DragResult, InjectionResult, LifetimeOptions, ShellLifetime,
    lifetimes_csv, lifetimes_text,
};
pub use orbits::{OrbitResult, RepeatResult, orbits_csv, orbits_text};
#[cfg(feature = "cli")]
pub(crate) use phases::in_order;
pub use phases::{PhaseRange, PhaseSpread};
pub use relative_nodes::{MetricRanges, NodeSpread, RelativeNodeResult, RelativeNodes};
pub use results::NoMember;
pub use seeds::{JointMember, SeedRun, SeedsResult, Spread};
pub use separations::{
    ApproachResult, DesignSeparation, SeparationResult, separations_csv, separations_text,
};
pub use size::size_text;
#[cfg(feature = "figures")]
pub use size_page::write_size_page;
pub use skies::{SkyClockResult, SkyResult, skies_csv, skies_text};
pub use studies::{
    StatementRecord, StudiesResult, StudyResult, StudyStamp, statements_csv, studies_markdown,
    studies_text,
};
pub use study_files::study_tables;
#[cfg(all(feature = "figures", feature = "sweep"))]
pub use sweep_page::write_sweep_page;
#[cfg(all(feature = "figures", feature = "sweep"))]
pub use sweep_summary::SweepSummary;
pub use table::{Align, Table};
#[cfg(feature = "validate")]
pub use validation::{checks_csv, checks_junit, validation_markdown, validation_text};
#[cfg(feature = "figures")]
pub use validation_page::write_validation_page;

//! Results as people and programs read them.

mod csv;
mod diagnostics;
mod results;
mod table;
mod validation;

pub use csv::{
    CsvError, checks_csv, constellation_csv, dops_csv, front_csv, history_csv, metrics_csv,
    records_csv,
};
pub use diagnostics::{Diagnostic, diagnose};
pub use results::{
    ConstellationResult, ConstellationSummary, DesignSummary, EvaluateResult, FrontMember,
    Hypervolume, OptimizeResult, ScenarioStamp, ValidateResult,
};
pub use table::{Align, Table};
pub use validation::{checks_junit, validation_markdown, validation_text};

/// The version of this program, which every result carries.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

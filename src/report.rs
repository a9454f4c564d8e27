//! Results as people and programs read them.

pub mod coastline;
mod csv;
mod diagnostics;
#[cfg(feature = "figures")]
pub mod figures;
#[cfg(feature = "figures")]
pub mod page;
pub mod profile;
mod results;
pub mod run;
mod table;
mod validation;

pub use csv::{CsvError, checks_csv, front_csv, history_csv, metrics_csv};
pub use diagnostics::{Diagnostic, diagnose};
pub use results::{
    DesignSummary, EvaluateResult, FrontMember, Hypervolume, OptimizeResult, ScenarioStamp,
    ValidateResult,
};
pub use table::{Align, Table};
pub use validation::{checks_junit, validation_markdown, validation_text};

/// The version of this program, which every result carries.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

//! Results as people and programs read them.

mod diagnostics;
mod results;
mod table;

pub use diagnostics::{Diagnostic, diagnose};
pub use results::{
    DesignSummary, EvaluateResult, FrontMember, Hypervolume, OptimizeResult, ScenarioStamp,
    ValidateResult,
};
pub use table::{Align, Table};

/// The version of this program, which every result carries.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

//! The parts that a report is made of, whatever it is written as.

use super::Table;

/// What stands before the sections of a report.
#[cfg(feature = "validate")]
pub(crate) struct Headline {
    /// What the report is of.
    pub(crate) title: String,
    /// Scenario, version, conventions.
    pub(crate) lines: Vec<String>,
    /// The answer, in a sentence.
    pub(crate) verdict: String,
    /// Notes on the whole.
    pub(crate) notes: Vec<String>,
}

/// A table with its title and what is said of it.
pub(crate) struct ReportSection {
    /// Its heading.
    pub(crate) title: String,
    /// What the table shows, in a sentence or two.
    pub(crate) caption: String,
    /// The numbers.
    pub(crate) table: Table,
    /// What follows from them, or is not in the table.
    pub(crate) remarks: Vec<String>,
}

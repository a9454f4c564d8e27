//! A run directory of designs that were given.

use super::EvaluationContext;
use crate::cli::output;
use crate::cli::run::RunDirectory;
use crate::cli::study::Study;
use crate::report::ConstellationEntry;
use crate::run::OptimizeResult;
use crate::scenario::Scenario;
use anyhow::{Context, Result};
use std::path::Path;

/// The run, not yet in its place.
pub(super) struct GivenRun {
    directory: RunDirectory,
    result: OptimizeResult,
}

impl GivenRun {
    /// The run of these designs; fails if a constellation cannot be a member, or the directory may not be replaced.
    pub(super) fn new(
        out: &Path,
        work: &EvaluationContext<'_>,
        study: &Study,
        entries: &[ConstellationEntry],
    ) -> Result<Self> {
        let result = OptimizeResult::of_given(entries, work.scenario, work.stamp.clone())
            .with_context(|| format!("cannot write a run to {}", out.display()))?;
        let described =
            |entry: &ConstellationEntry| format!("{} = {}", entry.name, entry.made_of());
        let given = entries.iter().map(described).collect();
        let directory = RunDirectory::open_for(out.to_owned(), study, given, work.args.force)?;
        Ok(Self { directory, result })
    }

    /// Puts the run in its place.
    pub(super) fn finish(mut self, scenario: &Scenario) -> Result<()> {
        self.directory.place(scenario, &self.result)?;
        let place = self.directory.display();
        output::hint(&format!(
            "\nrun written to {place}\nnext: navwalker report {place}"
        ));
        Ok(())
    }
}

//! A run directory of designs that were given.

use super::EvaluationContext;
use crate::cli::output;
use crate::cli::run::RunDirectory;
use crate::cli::study::Study;
use crate::exchange::constellation::Constellation;
use crate::optimize::Pick;
use crate::report::ConstellationEntry;
use crate::run::OptimizeResult;
use crate::scenario::Scenario;
use anyhow::{Context, Result, bail};
use std::path::Path;

/// Refuses what cannot be a member of a run: satellites from files, and names that `--pick` takes for a method or
/// an index.
pub(super) fn require_designs(given: &[Constellation]) -> Result<()> {
    for one in given {
        if one.files.is_some() {
            bail!(
                "{} has satellites from files; a run is made of designs: omit it, or --out",
                one.name
            );
        }
        if one.name.parse::<Pick>().is_ok() {
            bail!(
                "--pick {} is a method or an index, so that no design of a run can have this name",
                one.name
            );
        }
    }
    Ok(())
}

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

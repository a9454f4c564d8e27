//! Arguments of `navwalker scenario`.

use super::{OutputFormat, StudyArgs};
use clap::{Args, Subcommand};

#[derive(Debug, Args)]
pub(crate) struct ScenarioArgs {
    #[command(subcommand)]
    pub(crate) action: ScenarioAction,
}

#[derive(Debug, Subcommand)]
pub(crate) enum ScenarioAction {
    /// List the built-in scenarios.
    List {
        /// Output format.
        #[arg(long, value_enum, default_value = "text")]
        format: OutputFormat,
    },
    /// Print a scenario with every default filled in.
    ///
    /// Example: navwalker scenario show regional --set visibility.mask-deg=15
    #[command(verbatim_doc_comment)]
    Show {
        #[command(flatten)]
        study: StudyArgs,
    },
    /// Print a commented scenario file with every key, to start from.
    ///
    /// Example: navwalker scenario new > study.toml
    #[command(verbatim_doc_comment)]
    New,
    /// Print the JSON schema of scenario files, for editors.
    Schema,
}

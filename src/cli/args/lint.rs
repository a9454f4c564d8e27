//! The arguments of `lint`.

use super::OutputFormat;
use crate::exchange::lint::Format;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct LintArgs {
    /// Files to check.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,

    /// Check against this format instead of the detected one.
    #[arg(long = "as", value_name = "FORMAT")]
    pub(crate) format: Option<Format>,

    /// Output format.
    #[arg(long = "format", value_enum, default_value = "text")]
    pub(crate) output: OutputFormat,
}

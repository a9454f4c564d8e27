//! The arguments of `sweep`.

use super::{OutputFormat, StudyArgs};
use crate::run::sweep::TableFormat;
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Clone, Args)]
pub(crate) struct SweepArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// Directory of the sweep: what it is a sweep of, the result of each chunk, and the merged table.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,

    /// Evaluate the designs of a list in place of the search space: CSV with a column `design` (or `notation`) and
    /// perhaps `name`, or one notation a line; `-` is stdin.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["merge", "status"])]
    pub(crate) designs: Option<PathBuf>,

    /// Format of the results: parquet or csv [default: parquet].
    #[arg(long = "as", value_name = "FORMAT", conflicts_with_all = ["merge", "status"])]
    pub(crate) table_format: Option<TableFormat>,

    /// Designs in a chunk [default: some seconds of work on one thread, by a fixed model].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=1_000_000_000), conflicts_with_all = ["merge", "status"])]
    pub(crate) chunk: Option<u64>,

    /// Evaluate part I of N, every N-th chunk from the I-th, for a job array over one directory: each process begins the
    /// sweep or joins it, and nothing is merged.
    #[arg(long, value_name = "I/N", conflicts_with_all = ["merge", "status", "force"])]
    pub(crate) shard: Option<Shard>,

    /// Merge the results of all chunks into one table with an index; the exit status is 1 if some are missing.
    #[arg(long, conflicts_with_all = ["scenario", "overrides", "resume", "force", "status"])]
    pub(crate) merge: bool,

    /// Show which chunks are done, and evaluate nothing.
    #[arg(long, conflicts_with_all = ["scenario", "overrides", "resume", "force"])]
    pub(crate) status: bool,

    /// Continue the sweep in the directory; without SCENARIO, that of the directory.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Replace another sweep in the directory; other files are never deleted.
    #[arg(long)]
    pub(crate) force: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// One of several parts, counted from 1: `2/8`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Shard {
    pub(crate) part: usize,
    pub(crate) parts: usize,
}

impl std::str::FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let wrong = || "expected I/N with 1 <= I <= N, as in 2/8".to_owned();
        let (part, parts) = text.split_once('/').ok_or_else(wrong)?;
        let number = |text: &str| text.parse::<usize>().map_err(|_| wrong());
        let (part, parts) = (number(part)?, number(parts)?);
        if part == 0 || part > parts {
            return Err(wrong());
        }
        Ok(Self { part, parts })
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.part, self.parts)
    }
}

impl Shard {
    /// Whether a chunk or a seed is in the part, by its number from 0.
    pub(crate) fn holds(self, number: usize) -> bool {
        number % self.parts == self.part - 1
    }
}

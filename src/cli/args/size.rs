//! The arguments of `size`.

use super::{OutputFormat, Shard, StudyArgs};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Clone, Args)]
pub(crate) struct SizeArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// Directory for the result and its certificate [default: runs/<scenario>-size].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Go on to N satellites more than the fewest, and print the exact front of satellites against the first
    /// objective of the scenario that is not `satellites`.
    #[arg(long, value_name = "N")]
    pub(crate) slack: Option<usize>,

    /// Try part I of N of the designs, every N-th of some thousands from the I-th, for a job array over one directory; the same
    /// command with `--resume` in place of `--shard` makes the result when all are done.
    #[arg(long, value_name = "I/N", conflicts_with_all = ["verify", "resume", "force"])]
    pub(crate) shard: Option<Shard>,

    /// Check the certificate in DIR instead: that it has every design of the grid with fewer satellites, and by full
    /// evaluations of a part of it and of the result. The exit status is 1 if something is wrong.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["scenario", "overrides", "out", "slack", "resume", "force"])]
    pub(crate) verify: Option<PathBuf>,

    /// Rejected designs that --verify evaluates in full, drawn by the seed of the scenario; all if there are fewer.
    #[arg(long, value_name = "N", default_value = "200", requires = "verify")]
    pub(crate) draw: usize,

    /// Resume the search in the directory.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Replace another run that this program wrote; other files are never deleted.
    #[arg(long)]
    pub(crate) force: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

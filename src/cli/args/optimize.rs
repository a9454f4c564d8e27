//! The arguments of `optimize`.

use super::{OutputFormat, Shard, StudyArgs};
use clap::Args;
use std::path::PathBuf;

/// Maximum number of seeds in one command: the results of all of them are in memory at the end.
const MAX_SEEDS: u64 = 1000;

#[derive(Debug, Clone, Args)]
pub(crate) struct OptimizeArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// Run directory to write [default: runs/<scenario>-<seed>].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Seed of the search; the same as `--set optimizer.seed=N`.
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,

    /// Run this many consecutive seeds, at most 1000, starting with the scenario's, and report their spread
    /// and joint front.
    ///
    /// Each seed has its own run in DIR/seed-N; the summary is in DIR/seeds.csv and DIR/seeds.json, what
    /// no seed's front dominates in DIR/joint-front.csv. The front of the first seed and the summary are
    /// printed. All hypervolumes are at one reference point, which is printed too.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_SEEDS))]
    pub(crate) seeds: Option<u64>,

    /// Run part I of N of the seeds, every N-th from the I-th, for a job array over one directory; the same command with
    /// `--resume` in place of `--shard` makes the summary when all are done.
    #[arg(long, value_name = "I/N", requires = "seeds", conflicts_with_all = ["certify", "from"])]
    pub(crate) shard: Option<Shard>,

    /// Also sweep the search space on a grid of the scenario's steps and compare the fronts: both
    /// hypervolumes, the distance of each design, and what was missed.
    ///
    /// The sweep is a separate run in DIR-sweep, resumed if it exists.
    #[arg(long)]
    pub(crate) certify: bool,

    /// Resume from the checkpoint in the run directory; without SCENARIO with the scenario of the run.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Replace another run that this program wrote; other files are never deleted.
    #[arg(long)]
    pub(crate) force: bool,

    /// Also write every design that is evaluated, with all its metrics, to evaluations.csv in the run directory.
    #[arg(long)]
    pub(crate) evaluations: bool,

    /// Print the front of the evaluations that a run in DIR wrote with --evaluations, or of a sweep in DIR, for other objectives or
    /// constraints, as in --set objectives.minimize=["satellites","max-pdop"]. Nothing is evaluated, and nothing is
    /// written.
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["scenario", "out", "seed", "seeds", "certify", "resume", "force", "evaluations", "report"]
    )]
    pub(crate) from: Option<PathBuf>,

    /// Also write report.html, as `navwalker report` does.
    #[arg(long, conflicts_with = "seeds")]
    pub(crate) report: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

//! Arguments of `evaluate`.

use super::{ConstellationArgs, OutputFormat, StudyArgs};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct EvaluateArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    #[command(flatten)]
    pub(crate) constellations: ConstellationArgs,

    /// Evaluate the designs of a list, of any length: CSV with a column `design` (or `notation`) and perhaps
    /// `name`, or one notation a line; a constellation of the scenario may be given by its name; `-` is stdin.
    ///
    /// Blank lines and lines that begin with `#` are skipped. Results are printed in the order of the list as they
    /// come. A line that cannot be evaluated is named on stderr and left out, and the exit status is 1; it is 2 if
    /// no line can be. There are no warnings about satellites in one place or on collision course.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["series", "out", "gnss_phases"])]
    pub(crate) designs: Option<PathBuf>,

    /// Add GDOP, HDOP, VDOP and each system's TDOP: mean and tail.
    #[arg(long)]
    pub(crate) dops: bool,

    /// Evaluate at N equally spaced phases of the built-in GNSS constellations, as for N epochs over a sidereal day, and
    /// add the minimum, mean and maximum of each metric.
    ///
    /// A nominal constellation begins at an arbitrary place; the metrics of a scenario are those of one phase.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub(crate) gnss_phases: Option<u32>,

    /// Write metrics by instant (epochs.csv) and by point (points.csv) to this directory, of several
    /// constellations to a folder each.
    #[arg(long, value_name = "DIR")]
    pub(crate) series: Option<PathBuf>,

    /// Write a run directory of these constellations, with copies of their files, which `report`, `plot`,
    /// `export --run` and `validate --run` take like that of a search; `--pick` takes their names too.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Replace a series directory that is not empty, or another run; what this program did not write is never
    /// deleted.
    #[arg(long)]
    pub(crate) force: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

//! Arguments of `evaluate`.

use super::{ConstellationArgs, OutputFormat, Shard, StudyArgs};
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
    #[arg(long, value_name = "FILE", conflicts_with_all = ["series", "out", "gnss_phases", "relative_nodes"])]
    pub(crate) designs: Option<PathBuf>,

    /// Take these satellites out of service throughout: satellites (NW-P01-S03), planes (NW-P03) or shells (NW-A) of the
    /// constellations, or GNSS satellites (gps:A3); the same as adding them to `outages.satellites` of the scenario.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub(crate) without: Vec<String>,

    /// Add GDOP, HDOP, VDOP and each system's TDOP: mean and tail.
    #[arg(long)]
    pub(crate) dops: bool,

    /// Evaluate at N equally spaced phases of the built-in GNSS constellations, as for N epochs over a sidereal day, and
    /// add the minimum, mean and maximum of each metric.
    ///
    /// A nominal constellation begins at an arbitrary place; the metrics of a scenario are those of one phase.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub(crate) gnss_phases: Option<u32>,

    /// Evaluate designs of several shells at N relative nodes, equally spaced in the time in which their shells turn by 360°
    /// against each other, and add the minimum, mean and maximum of each metric.
    ///
    /// Shells of other inclination or altitude drift apart, so that the metrics of a day are those of one relative node. The
    /// nodes of the first shell, all phases and the Earth stay.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub(crate) relative_nodes: Option<u32>,

    /// Add what the failure of any K LEO satellites does (1 to 3): the mean, the worst and without which satellites.
    ///
    /// For one satellite all cases are evaluated exactly, by satellite and by plane (a lost launch). For two and three, all
    /// sets if there are at most 1000, and otherwise draws, with a greedy search with exchanges for the worst set.
    /// With `--format csv` one row for each satellite and plane is printed in place of the constellation.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=3), conflicts_with = "designs")]
    pub(crate) failures: Option<u8>,

    /// Number of draws from the seed of the scenario: of sets for `--failures`, and of vacant slots where the scenario has
    /// `reliability.spares-per-plane` [default: 200].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(crate) draws: Option<u32>,

    /// Add the phases of a build-up or a drawdown, planes launched one after the other: the metrics in each, and in which service
    /// begins.
    ///
    /// FILE is CSV with the columns `phase` (a date or another name) and `add` or `remove` or both, whose cells name satellites
    /// (NW-P01-S03), planes (NW-P03) or shells (NW-A), separated by spaces. What is first said to be added is missing before; all
    /// else is there from the start. A phase serves if it meets the constraints of the scenario, or, without any, if every sample is
    /// available. With `--format csv` one row for each phase is printed in place of the constellation.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["designs", "failures"])]
    pub(crate) phases: Option<PathBuf>,

    /// Write metrics by instant (epochs.csv) and by point (points.csv) to this directory, of several
    /// constellations to a folder each.
    #[arg(long, value_name = "DIR")]
    pub(crate) series: Option<PathBuf>,

    /// Evaluate part I of N of the instants of one constellation, and write what is found to the file `--out`, for `--merge`.
    ///
    /// Tiles may be evaluated anywhere and in any order. What the file takes, the memory and the time are told before the work; the
    /// memory does not grow with the instants. Accuracy in metres, windows, HDOP and failures cannot be cut into tiles.
    #[arg(
        long, value_name = "I/N", requires = "out",
        conflicts_with_all = ["merge", "designs", "dops", "gnss_phases", "relative_nodes", "failures", "draws", "phases", "series", "force", "format"]
    )]
    pub(crate) tile: Option<Shard>,

    /// Print the result of one constellation from the files of all its tiles, to the bit as without tiles; the scenario and the
    /// constellation must be given as for `--tile`.
    #[arg(
        long, value_name = "FILE", num_args = 1..,
        conflicts_with_all = ["designs", "dops", "gnss_phases", "relative_nodes", "failures", "draws", "phases", "series"]
    )]
    pub(crate) merge: Vec<PathBuf>,

    /// Write a run directory of these constellations, with copies of their files, which `report`, `plot`,
    /// `export --run` and `validate --run` take like that of a search; `--pick` takes their names too. With `--tile`, the file
    /// of the tile.
    #[arg(long, value_name = "PATH")]
    pub(crate) out: Option<PathBuf>,

    /// Replace a series directory that is not empty, or another run; what this program did not write is never
    /// deleted.
    #[arg(long)]
    pub(crate) force: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

//! What can be typed.

mod products;
mod run_view;
mod scenario;

pub(crate) use run_view::{PlotArgs, ReportArgs, RunArgs};
pub(crate) use scenario::{ScenarioAction, ScenarioArgs};

use crate::constellation::Design;
use crate::constellation::gnss::Preset;
use crate::exchange::export::Product;
use crate::formats::ccsds::{CcsdsVersion, oem, omm};
use crate::formats::metadata::ElementChoice;
use crate::formats::sp3::Version as Sp3Version;
use crate::formats::text::timestamp::TimeSystem;
use crate::formats::trajectory::{frame_of_name, time_system_of_name};
use crate::frames::Frame;
use crate::optimize::Pick;
use clap::{Args, Parser, Subcommand, ValueEnum};
use products::PRODUCTS;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Designs, evaluates, exports and validates LEO Walker constellations that augment a GNSS.
///
/// A study is described by a scenario: a TOML file, or one of the built-in `paper` and
/// `regional`. Results go to stdout and everything else to stderr. The exit status is 0 when
/// done, 1 when done but a gate failed or no feasible design was found, 2 when the command could
/// not run, and 130 after Ctrl-C.
#[derive(Debug, Parser)]
#[command(
    name = "navwalker",
    version,
    propagate_version = true,
    max_term_width = 100
)]
pub(crate) struct Cli {
    /// Use this many threads instead of all cores; results do not depend on it.
    #[arg(long, global = true, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Print results and errors only, no progress and no hints.
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,

    /// Print without colours, as the variable NO_COLOR does.
    #[arg(long, global = true)]
    pub(crate) no_color: bool,

    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Search for the Pareto set of designs; the main job.
    ///
    /// Runs the algorithm of the scenario, prints the non-dominated designs of its last population
    /// and writes a run directory with the front, the history and a checkpoint of each generation.
    /// Ctrl-C keeps the results so far; `--resume` goes on from the checkpoint.
    ///
    /// Example: navwalker optimize --seed 7 --set optimizer.generations=60
    #[command(verbatim_doc_comment)]
    Optimize(OptimizeArgs),

    /// Compute visibility, PDOP, its tail and cost of one design, or of satellites from files.
    ///
    /// Example: navwalker evaluate --design delta:55:182/13/1@925 --set visibility.mask-deg=10
    #[command(verbatim_doc_comment)]
    Evaluate(EvaluateArgs),

    /// Check files against the standard of their format: TLE, OMM, OEM, OPM, SP3, STK ephemeris, CZML,
    /// and tables of elements and states.
    ///
    /// Example: navwalker lint constellation.tle oem/*.oem
    #[command(verbatim_doc_comment)]
    Lint(LintArgs),

    /// Repeat the study that this program implements: its tables and figures, ours beside theirs.
    ///
    /// Every statement of the paper is judged by a computed rule: met, met under another assumption
    /// (one changed at a time), or not met. DIR gets the report and the data of each figure.
    ///
    /// Example: navwalker reproduce --set visibility.mask-deg=10
    #[command(verbatim_doc_comment)]
    Reproduce(ReproduceArgs),

    /// Write a design into files that other tools read, with a manifest of what each says and loses.
    ///
    /// Example: navwalker export --run runs/paper-1 --pick fuzzy --as tle,oem --out exports
    #[command(verbatim_doc_comment, after_help = PRODUCTS)]
    Export(ExportArgs),

    /// Check a design's propagation against independent standards, with gates that have reasons.
    ///
    /// Example: navwalker validate --design star:86.4:66/6/2@780 --against sgp4
    #[command(verbatim_doc_comment)]
    Validate(ValidateArgs),

    /// Write one self-contained HTML page about a run.
    ///
    /// The page shows the trade-off, and of each design that is clicked the maps, the tail, the
    /// series and a globe; it needs no network. It goes to report.html in the run directory. What
    /// is damaged or missing in the directory is named, and the rest is shown.
    ///
    /// A validation is shown when it lies in DIR/validation:
    ///   navwalker validate --run runs/paper-1 --against sgp4 --report
    ///
    /// Example: navwalker report runs/paper-1 --compare star:86.4:180/12/1@925
    #[command(verbatim_doc_comment)]
    Report(ReportArgs),

    /// Draw a figure of a run for a paper or a review, with the table behind it.
    ///
    /// pareto       the front in the plane of the first two objectives
    /// map          --measure mean-visible, mean-pdop, p95-pdop, max-pdop, availability
    /// cdf          --measure mean-visible, mean-pdop, max-pdop (over time), or pdop with its tail
    /// series       --measure mean-visible, mean-pdop, max-pdop
    /// convergence  the hypervolume over the evaluations
    /// budget       the error budget of a validation
    ///
    /// With --out the table goes beside the figure, as the same name with .csv; without it the
    /// figure goes to stdout. The same run gives the same bytes.
    ///
    /// Example: navwalker plot runs/paper-1 --figure map --measure max-pdop --out max-pdop.svg
    #[command(verbatim_doc_comment)]
    Plot(PlotArgs),

    /// List, show or create scenarios.
    ///
    /// Example: navwalker scenario new > study.toml
    #[command(verbatim_doc_comment)]
    Scenario(ScenarioArgs),

    /// Print the completions of a shell.
    ///
    /// Example: navwalker completions bash > ~/.local/share/bash-completion/completions/navwalker
    #[command(verbatim_doc_comment)]
    Completions {
        /// The shell.
        #[arg(value_enum)]
        shell: clap_complete::Shell,
    },

    /// Print a manual page, or write all of them.
    ///
    /// Example: navwalker man optimize | man -l -
    #[command(verbatim_doc_comment)]
    Man {
        /// The command whose page is printed [default: that of the program].
        #[arg(value_name = "COMMAND", conflicts_with = "out")]
        command: Option<String>,

        /// Write the pages of all commands into this directory.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// Which study a command works on.
#[derive(Debug, Clone, Args)]
pub(crate) struct StudyArgs {
    /// A scenario file, or the name of a built-in scenario.
    #[arg(value_name = "SCENARIO", default_value = "paper")]
    pub(crate) scenario: String,

    /// Override a scenario key, as in `--set visibility.mask-deg=10`; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) overrides: Vec<String>,
}

/// The form of a result on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// Tables to read.
    Text,
    /// One JSON object.
    Json,
    /// Comma-separated values with a header.
    Csv,
}

#[derive(Debug, Clone, Args)]
pub(crate) struct OptimizeArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// Where the run goes [default: runs/<scenario>-<seed>].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Seed of the search; the same as `--set optimizer.seed=N`.
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,

    /// Run this many seeds, from the one of the scenario upwards, and report their spread.
    ///
    /// Each seed is a run of its own in DIR/seed-N; DIR gets the table of all as seeds.csv and
    /// seeds.json. What is printed is the front of the first seed and the table.
    #[arg(long, value_name = "N")]
    pub(crate) seeds: Option<NonZeroUsize>,

    /// Also sweep the whole search space on the scenario's steps and hold the front against the
    /// exact one: both hypervolumes, the distance of each member, and what was missed.
    ///
    /// The sweep is a run of its own in DIR-sweep, which is resumed when it is there.
    #[arg(long)]
    pub(crate) certify: bool,

    /// Go on from the checkpoint of the run directory.
    #[arg(long)]
    pub(crate) resume: bool,

    /// Replace a directory that holds something else.
    #[arg(long)]
    pub(crate) force: bool,

    /// Also write report.html, as `navwalker report` does.
    #[arg(long, conflicts_with = "seeds")]
    pub(crate) report: bool,

    /// Form of the result on stdout.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

#[derive(Debug, Args)]
pub(crate) struct EvaluateArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// The design as `pattern:inclination:T/P/F@altitude[,e=E][,w=DEG]`, degrees and km.
    #[arg(
        long,
        value_name = "NOTATION",
        required_unless_present = "constellation"
    )]
    pub(crate) design: Option<Design>,

    /// Evaluate the satellites of a file instead: TLE, OMM, OEM, OPM, SP3, STK ephemeris, CZML, or a
    /// table of elements or states; a directory stands for its files; may be repeated.
    #[arg(long, value_name = "FILE", conflicts_with = "design")]
    pub(crate) constellation: Vec<PathBuf>,

    /// Add GDOP, HDOP, VDOP and the TDOP of each system: mean and tail.
    #[arg(long)]
    pub(crate) dops: bool,

    /// Write metrics per instant and per point into this directory: epochs.csv and points.csv.
    #[arg(long, value_name = "DIR")]
    pub(crate) series: Option<PathBuf>,

    /// Replace a series directory that holds something.
    #[arg(long, requires = "series")]
    pub(crate) force: bool,

    /// Form of the result on stdout.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// The form of a study on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyFormat {
    /// Tables to read.
    Text,
    /// One JSON object.
    Json,
    /// Comma-separated values with a header: the statements.
    Csv,
    /// Markdown, for an appendix.
    Markdown,
}

#[derive(Debug, Args)]
pub(crate) struct ReproduceArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// Where the report and the data of the figures go.
    #[arg(long, value_name = "DIR", default_value = "runs/reproduce")]
    pub(crate) out: PathBuf,

    /// Seed of the searches; the same as `--set optimizer.seed=N`.
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,

    /// Replace a directory that holds something else.
    #[arg(long)]
    pub(crate) force: bool,

    /// Form of the result on stdout.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: StudyFormat,
}

/// One design: given, or picked from a run.
#[derive(Debug, Args)]
#[group(required = false, multiple = true)]
pub(crate) struct DesignArgs {
    /// The design as `pattern:inclination:T/P/F@altitude[,e=E][,w=DEG]`, degrees and km.
    #[arg(long, value_name = "NOTATION", conflicts_with = "run")]
    pub(crate) design: Option<Design>,

    /// Take the design, and the scenario, from the run in this directory.
    #[arg(long, value_name = "DIR")]
    pub(crate) run: Option<PathBuf>,

    /// Which design of the run: fuzzy, sum, topsis, knee, or the index of a front member.
    #[arg(long, value_name = "PICK", default_value = "fuzzy", requires = "run")]
    pub(crate) pick: Pick,
}

#[derive(Debug, Args)]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    #[command(flatten)]
    pub(crate) design: DesignArgs,

    /// Products, separated by commas; they are listed below.
    #[arg(
        long = "as",
        value_name = "PRODUCTS",
        value_delimiter = ',',
        required = true
    )]
    pub(crate) products: Vec<Product>,

    /// Where the files go; an empty or new directory.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,

    /// Replace a directory that holds something.
    #[arg(long)]
    pub(crate) force: bool,

    /// Frame of OEM, OPM and STK states: EME2000, GCRF, ITRF, or TEME [default: EME2000].
    #[arg(long, value_name = "FRAME", value_parser = frame_of_name)]
    pub(crate) frame: Option<Frame>,

    /// Time system of OEM and OPM: UTC, TAI, GPS or TT.
    #[arg(long, value_name = "SYSTEM", default_value = "UTC", value_parser = time_system_of_name)]
    pub(crate) time_system: TimeSystem,

    /// Notation of the OMM: kvn, xml, json or csv.
    #[arg(long, value_name = "SYNTAX", default_value = "kvn")]
    pub(crate) omm_syntax: omm::Notation,

    /// Notation of the OEM: kvn or xml.
    #[arg(long, value_name = "SYNTAX", default_value = "kvn")]
    pub(crate) oem_syntax: oem::Notation,

    /// Write the OEM of all satellites into one XML file; needs `--oem-syntax xml`.
    #[arg(long)]
    pub(crate) oem_combined: bool,

    /// How element sets are made: kozai (the J2 mean elements), fit (least squares of SGP4 to the
    /// trajectory), or kepler (the common mistake, for comparisons).
    #[arg(long, value_name = "THEORY", default_value = "kozai")]
    pub(crate) tle_theory: ElementChoice,

    /// Version of CCSDS messages: 2.0 or 3.0.
    #[arg(long, value_name = "VERSION", default_value = "2.0")]
    pub(crate) ccsds_version: CcsdsVersion,

    /// Version of SP3: c or d.
    #[arg(long, value_name = "VERSION", default_value = "d")]
    pub(crate) sp3_version: Sp3Version,

    /// Read every product back, evaluate the scenario from it, and print how far it is from the
    /// design; status 1 if it is farther than its digits and theory explain.
    #[arg(long)]
    pub(crate) check: bool,

    /// When the CCSDS messages say that they were made, as in 2025-01-01T00:00:00Z; the same as
    /// `--set export.creation-date=...`, whose default is the epoch of the study.
    #[arg(long, value_name = "UTC")]
    pub(crate) creation_date: Option<String>,

    /// Also write SP3 of these nominal constellations, each into a file of its own under gnss/:
    /// beidou-3 (ids C01 ...), gps (G01 ...), galileo (E01 ...), glonass (R01 ...).
    #[arg(long, value_name = "SYSTEMS", value_delimiter = ',')]
    pub(crate) gnss: Vec<Preset>,

    /// Letter of the satellite ids of SP3.
    #[arg(long, value_name = "LETTER", default_value = "L")]
    pub(crate) sp3_letter: char,
}

/// The form of a validation on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReportFormat {
    /// Tables to read.
    Text,
    /// One JSON object.
    Json,
    /// Comma-separated values with a header: the checks.
    Csv,
    /// Markdown, for an appendix.
    Markdown,
    /// `JUnit` XML, for continuous integration.
    Junit,
}

#[derive(Debug, Args)]
pub(crate) struct ValidateArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    #[command(flatten)]
    pub(crate) design: DesignArgs,

    /// What to check against, separated by commas: sgp4, geographiclib, numerical, analytic, paper,
    /// all, or files and directories of another program (OEM, OMM, TLE, SP3, STK .e; anything with a
    /// `.` or `/` in its path).
    #[arg(long, value_name = "TARGETS", value_delimiter = ',', required = true)]
    pub(crate) against: Vec<String>,

    /// Also write the report in every form into this directory.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Also write the page of the run with this validation in it, as `navwalker report` does. The
    /// reports go to `validation` in the run directory, unless --out says otherwise.
    #[arg(long, requires = "run")]
    pub(crate) report: bool,

    /// Replace a directory that holds something.
    #[arg(long)]
    pub(crate) force: bool,

    /// Form of the result on stdout.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: ReportFormat,
}

#[derive(Debug, Args)]
pub(crate) struct LintArgs {
    /// The files.
    #[arg(value_name = "FILE", required = true)]
    pub(crate) files: Vec<PathBuf>,

    /// Check against this format instead of the one that the file shows.
    #[arg(long = "as", value_name = "FORMAT")]
    pub(crate) format: Option<crate::exchange::lint::Format>,

    /// Form of the result on stdout.
    #[arg(long = "format", value_enum, default_value = "text")]
    pub(crate) output: Format,
}

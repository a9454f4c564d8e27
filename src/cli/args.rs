//! The arguments of the program.

mod diff;
mod evaluate;
mod export;
mod lifetime;
mod lint;
mod member_pick;
mod optimize;
mod products;
mod run_view;
mod satellites;
mod scenario;
mod separation;
mod size;
mod sky;
mod sweep;

pub(crate) use diff::DiffArgs;
pub(crate) use evaluate::EvaluateArgs;
pub(crate) use export::ExportArgs;
pub(crate) use lifetime::LifetimeArgs;
pub(crate) use lint::LintArgs;
pub(crate) use member_pick::MemberPick;
pub(crate) use optimize::OptimizeArgs;
pub(crate) use run_view::{LookArgs, PlotArgs, ReportArgs, ViewArgs};
pub(crate) use satellites::SatelliteArgs;
pub(crate) use scenario::{ScenarioAction, ScenarioArgs};
pub(crate) use separation::SeparationArgs;
pub(crate) use size::SizeArgs;
pub(crate) use sky::{DopArgs, OrbitArgs};
pub(crate) use sweep::{Shard, SweepArgs};

use crate::cli::constellations::Named;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Designs, evaluates, exports and validates LEO Walker constellations that augment a GNSS.
///
/// A study is described by a scenario: a TOML file, or one of the built-in `paper`,
/// `regional`, `global`, `europe` and `robust`. Results go to stdout and everything else to stderr. The exit status is 0 when
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
    /// Use this many threads instead of all cores, at most 4 for each core; results do not depend on the
    /// number.
    #[arg(long, global = true, value_name = "N", value_parser = thread_count)]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Start what is very large: an export of more than 10 GB, an evaluation that needs more memory than is
    /// available, a search for the fewest satellites among more than 1e9 designs, a sweep whose table has more than 10 GB.
    #[arg(long, global = true)]
    pub(crate) allow_large: bool,

    /// Print only results and errors: no progress, no hints.
    #[arg(long, short, global = true)]
    pub(crate) quiet: bool,

    /// Print without colours, like the environment variable NO_COLOR.
    #[arg(long, global = true)]
    pub(crate) no_color: bool,

    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Search for the Pareto set of designs.
    ///
    /// Runs the algorithm of the scenario, prints the non-dominated designs of its last population
    /// and writes a run directory with the front, the history and a checkpoint of each generation.
    /// Ctrl-C keeps the results so far; `--resume` continues from the checkpoint.
    ///
    /// Example: navwalker optimize --seed 7 --set optimizer.generations=60
    #[command(verbatim_doc_comment)]
    Optimize(OptimizeArgs),

    /// Find the fewest satellites that keep the constraints, exactly, with a proof for every design below.
    ///
    /// Takes the designs of the search space on the steps of a sweep by rising number of satellites, and
    /// drops each as soon as its samples prove that a constraint of the scenario (`objectives.constraints`)
    /// cannot be kept. The answer is that of a sweep: exact for the samples and the grid of the scenario.
    /// The exit status is 1 if no design keeps the constraints.
    ///
    /// DIR gets the result, the designs and the certificate, a proof for each rejected design. Ctrl-C keeps
    /// what is done; `--resume` continues.
    ///
    /// Example: navwalker size --set objectives.availability-pdop=1.5 --set search.phasing=[0,14]
    ///            --set 'objectives.constraints=["availability >= 0.999"]'
    #[command(verbatim_doc_comment)]
    Size(SizeArgs),

    /// Evaluate every design of a search space or a list, and keep every metric, in chunks that can be computed anywhere.
    ///
    /// DIR gets the result of each chunk and, at the end, one table of all designs (Parquet, or CSV by `--as csv`)
    /// with an index of checksums. Its bytes do not depend on threads, machines or the order of the work. Ctrl-C keeps the
    /// chunks that are done; `--resume` continues. `--shard I/N` evaluates a part in a job array over one
    /// directory, and `--merge` ends it. `navwalker optimize --from DIR` takes the front from the table.
    ///
    /// Examples: navwalker sweep --set search.inclination-step-deg=2 --out sweep
    ///           navwalker sweep --designs designs.csv --shard $SLURM_ARRAY_TASK_ID/100 --out sweep
    #[command(verbatim_doc_comment)]
    Sweep(SweepArgs),

    /// Compute visibility, PDOP with its tail, and cost of constellations: designs, or satellites from files.
    ///
    /// Several are compared in one table, with the GNSS alone in its last row.
    ///
    /// Example: navwalker evaluate --design delta:55:182/13/1@925 --design polar=star:90:182/13/1@925
    #[command(verbatim_doc_comment)]
    Evaluate(EvaluateArgs),

    /// Check files against the standard of their format, with line, column and rule.
    ///
    /// Formats: TLE, OMM, OEM, OPM, SP3, STK ephemeris, CZML, YUMA and SEM almanacs, and tables of
    /// elements and states.
    ///
    /// Example: navwalker lint constellation.tle oem/*.oem
    #[command(verbatim_doc_comment)]
    Lint(LintArgs),

    /// Compare two results: what moved, and by how much.
    ///
    /// A and B are directories that this program wrote (runs, evaluations, sweeps, reports of `validate` and
    /// `reproduce`, exports), or two JSON, TOML or CSV files of one kind. Rows are matched by their design or name. Each
    /// quantity that moved has a line with its largest move; `--format csv` lists every value. The exit status is 1 if
    /// anything moved by more than the tolerance.
    ///
    /// Example: navwalker diff runs/paper-1 runs/paper-2 --relative 1e-9
    #[command(verbatim_doc_comment)]
    Diff(DiffArgs),

    /// Compute the dilution of precision of skies: satellites by azimuth and elevation.
    ///
    /// GDOP, PDOP, HDOP, VDOP and TDOP by least squares, with a clock for each system. A sky that cannot be
    /// solved has none, and the reason is told.
    ///
    /// Example: navwalker dop sky.csv --mask-deg 5
    #[command(verbatim_doc_comment)]
    Dop(DopArgs),

    /// Show periods, rates and the ground track of orbits, and the sun-synchronous inclination at their altitude.
    ///
    /// By secular J2, from mean elements. The repeats of the ground track are those within 70 nodal days that
    /// come closer to the first ascending node than all before, each with the altitude at which it is exact.
    ///
    /// Example: navwalker orbit delta:97.4018:1/1/0@500
    #[command(verbatim_doc_comment)]
    Orbit(OrbitArgs),

    /// Show how close any two satellites of a design come to each other, which they are, and where and when.
    ///
    /// By mean elements under secular J2. Within a shell, satellites keep their places, and the least distance is a
    /// closed form; between shells of other rates it is the difference in altitude, sooner or later.
    ///
    /// Example: navwalker separation delta:55:182/13/1@925 --all-phasings
    #[command(verbatim_doc_comment)]
    Separation(SeparationArgs),

    /// Show what years do to the shells of a design: rates beyond J2, drag, slot keeping, decay, and errors of injection.
    ///
    /// By closed forms from mean elements, with the mean atmosphere of NRLMSISE-00 at low, moderate and high solar activity
    /// (F10.7 of 65, 140 and 250). Single seasons and planes have 0.54 to 1.46 times the mean density.
    ///
    /// Example: navwalker lifetime delta:55:182/13/1@925 --mass-kg 150 --area-m2 1.5
    #[command(verbatim_doc_comment)]
    Lifetime(LifetimeArgs),

    /// Reproduce published numbers: those of the paper that this program implements, or of other studies.
    ///
    /// Every statement gets a computed verdict: met, met-under-assumption (one is changed at a time),
    /// fitted (the assumption was found from it), input (copied), not-met, or unconfirmed (nothing to
    /// compare with, or a number from memory). DIR gets the report as JSON, Markdown and an HTML page, the
    /// figures as SVG and PNG, and for the paper its tables and the data of each figure. The exit status is 1 if a number is not met and its study does not say why.
    ///
    /// Examples: navwalker reproduce --set visibility.mask-deg=10
    ///           navwalker reproduce gps-sps iridium
    #[command(verbatim_doc_comment)]
    Reproduce(ReproduceArgs),

    /// Export a constellation to files for other tools, with a manifest of what each contains.
    ///
    /// The constellation is a design, a design of a run, or the satellites of files. These are
    /// converted: states by the theory of their format (SGP4 for element sets, interpolation for
    /// states), element sets unchanged in TLE and OMM. What a product cannot express is an error.
    ///
    /// Example: navwalker export --run runs/paper-1 --pick fuzzy --as tle,oem --out exports
    #[command(verbatim_doc_comment, after_help = products::help())]
    Export(ExportArgs),

    /// Check a design's propagation against independent standards, with a gate and a reason for each.
    ///
    /// The model under test is that of the scenario (`propagation.model`); it is the first of each
    /// case. Checks without a gate are for information. The exit status is 1 if a gate fails.
    /// With --out DIR the reports are also written as text, JSON, CSV, Markdown and JUnit, and as a page with figures to
    /// read or print, where each gate has its reason and the planted errors that fail it.
    ///
    /// Example: navwalker validate --design star:86.4:66/6/2@780 --against sgp4
    #[command(verbatim_doc_comment)]
    Validate(ValidateArgs),

    /// Write one self-contained HTML page about a run, or about constellations.
    ///
    /// The page of a run shows the trade-off and, for the selected design, maps, distributions, time
    /// series and a globe; it needs no network. It is written to report.html in the run directory.
    /// Damaged or missing files are named; the rest is shown.
    ///
    /// Constellations given by --design and --constellation are compared with the front and with each
    /// other: a table with the best of each column, who dominates whom, and each can be selected like
    /// a design of the front. With a scenario in place of a run, the page shows them alone and is
    /// written to report.html in the working directory.
    ///
    /// A validation is included if it is in RUN/validation:
    ///   navwalker validate --run runs/paper-1 --against sgp4 --report
    ///
    /// Examples: navwalker report runs/paper-1 --design star:86.4:180/12/1@925
    ///           navwalker report paper --design delta:55:182/13/1@925 --design polar=star:90:182/13/1@925
    #[command(verbatim_doc_comment)]
    Report(ReportArgs),

    /// Draw a figure of a run, or of constellations, for a paper or a review, with the data behind it.
    ///
    /// pareto       the plane of two objectives: the front, other fronts and constellations, the fuzzy pick
    /// map          --measure over the region, such as max-pdop, availability or n1-max-pdop
    /// cdf          the distribution of --measure over points, instants or both; of pdop with its tail
    /// series       --measure over time
    /// histogram    how often so many satellites are in view
    /// timeline     the outages of the points that are out longest
    /// failures     the CVaR of PDOP over the loss of one, two or three satellites
    /// phases       --measure over the phases of a build-up or a drawdown
    /// convergence  the hypervolume over the evaluations of a run
    /// budget       the error budget of a validation of a run
    ///
    /// Constellations given by --design and --constellation are drawn beside a run, or alone with a
    /// scenario. With --out, the data is written next to the figure with the extension .csv; without
    /// it, the figure goes to stdout. The same input always gives the same bytes.
    ///
    /// Examples: navwalker plot runs/paper-1 --figure map --measure max-pdop --width-mm 85 --out max-pdop.pdf
    ///           navwalker plot paper --figure cdf --design delta:55:182/13/1@925 --out cdf.svg
    #[command(verbatim_doc_comment)]
    Plot(PlotArgs),

    /// List, show or create scenarios.
    ///
    /// Example: navwalker scenario new > study.toml
    #[command(verbatim_doc_comment)]
    Scenario(ScenarioArgs),

    /// Print shell completions.
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
        /// The command to describe [default: the program as a whole].
        #[arg(value_name = "COMMAND", conflicts_with = "out")]
        command: Option<String>,

        /// Write the pages of all commands into this directory.
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
    },
}

/// A word of a command line as a shell takes it.
pub(crate) fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_./:,=+@%\\".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', "'\\''"))
}

/// The study to work on.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct StudyArgs {
    /// A scenario file, or the name of a built-in scenario [default: paper].
    #[arg(value_name = "SCENARIO")]
    pub(crate) scenario: Option<String>,

    /// Override a scenario key, as in `--set visibility.mask-deg=10`; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) overrides: Vec<String>,

    /// The scenario itself, where another program gives its text.
    #[arg(skip)]
    pub(crate) text: Option<ScenarioText>,
}

/// A scenario as a text.
#[derive(Debug, Clone)]
pub struct ScenarioText {
    /// What messages call it.
    pub label: String,
    /// The text, TOML.
    pub text: String,
    /// The directory to which the files that it names are relative.
    pub directory: PathBuf,
}

impl StudyArgs {
    /// The named scenario, or the paper's.
    pub(crate) fn name(&self) -> &str {
        self.scenario.as_deref().unwrap_or("paper")
    }

    /// The same arguments for a command that is proposed.
    pub(crate) fn words(&self) -> String {
        let name = std::iter::once(quoted(self.name()));
        let overrides = self
            .overrides
            .iter()
            .map(|one| format!("--set {}", quoted(one)));
        name.chain(overrides).collect::<Vec<_>>().join(" ")
    }
}

/// Constellations, each given directly.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ConstellationArgs {
    /// A design as `pattern:inclination:T/P/F@altitude[,e=E][,w=DEG][,raan=DEG][,u=DEG][,node-step=DEG]`, degrees
    /// and km; `+` joins shells; or the name of a constellation of the scenario. A name before it labels the
    /// results, as in `polar=star:90:182/13/1@925`; may be repeated.
    #[arg(long, value_name = "[NAME=]NOTATION")]
    pub(crate) design: Vec<Named>,

    /// The satellites in a file: TLE, OMM, OEM, OPM, SP3, STK ephemeris, CZML, YUMA and SEM almanacs, or a table
    /// of elements or states, also packed by gzip; a directory is one constellation, of all its files that are
    /// read. A name before it labels the results; may be repeated.
    #[arg(long, value_name = "[NAME=]FILE")]
    pub(crate) constellation: Vec<Named>,

    /// Read the files in this format instead of the one that their content shows.
    #[arg(long, value_name = "FORMAT")]
    pub(crate) input_format: Option<crate::exchange::lint::Format>,

    #[command(flatten)]
    pub(crate) satellites: SatelliteArgs,
}

/// Constellations given directly, or a design picked from a run.
#[derive(Debug, Args)]
pub(crate) struct ChosenArgs {
    #[command(flatten)]
    pub(crate) given: ConstellationArgs,

    /// Take the design, and the scenario, from the run in this directory.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["design", "constellation"])]
    pub(crate) run: Option<PathBuf>,

    /// Which design of the run: fuzzy, sum, topsis, knee, its index on the front, or its name.
    #[arg(long, value_name = "PICK", default_value = "fuzzy", requires = "run")]
    pub(crate) pick: MemberPick,
}

/// Output format on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum OutputFormat {
    /// Tables for reading.
    Text,
    /// One JSON object.
    Json,
    /// Comma-separated values with a header.
    Csv,
}

/// Output format of a study on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum StudyFormat {
    /// Tables for reading.
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
    /// Built-in studies or study files (docs/studies.md) [default: paper].
    #[arg(value_name = "STUDY", conflicts_with = "all")]
    pub(crate) studies: Vec<String>,

    /// All built-in studies.
    #[arg(long)]
    pub(crate) all: bool,

    /// List the built-in studies.
    #[arg(long, conflicts_with_all = ["all", "studies"])]
    pub(crate) list: bool,

    /// Override a key of the scenario of the study, as in `--set visibility.mask-deg=10`; may be repeated.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) overrides: Vec<String>,

    /// Directory for the report, its page and the figures [default: runs/reproduce/STUDY; of several studies their names
    /// joined by +, or all].
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Seed of the paper's searches; the same as `--set optimizer.seed=N`.
    #[arg(long, value_name = "N")]
    pub(crate) seed: Option<u64>,

    /// Replace another run that this program wrote; other files are never deleted.
    #[arg(long)]
    pub(crate) force: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: StudyFormat,
}

/// Output format of a validation on stdout.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ReportFormat {
    /// Tables for reading.
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
    pub(crate) chosen: ChosenArgs,

    /// Refused: of evaluate, report and plot.
    #[arg(long, hide = true, value_name = "NAME", value_delimiter = ',')]
    pub(crate) without: Vec<String>,

    /// What to check against, separated by commas: sgp4, geographiclib, numerical, analytic, paper,
    /// all, or files and directories written by another program (OEM, OMM, TLE, SP3, STK .e; any
    /// target with a `.` or `/` in it is a path).
    #[arg(long, value_name = "TARGETS", value_delimiter = ',', required = true)]
    pub(crate) against: Vec<String>,

    /// Also write the report in every format to this directory.
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,

    /// Also write the page of the run, including this validation, as `navwalker report` does. The
    /// reports go to `validation` in the run directory unless --out names another.
    #[arg(long, requires = "run")]
    pub(crate) report: bool,

    /// Replace a directory that is not empty.
    #[arg(long)]
    pub(crate) force: bool,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: ReportFormat,
}

/// A number of threads; how many there may be is known when they start.
fn thread_count(text: &str) -> Result<NonZeroUsize, &'static str> {
    let found = text.parse();
    found.map_err(|_| "expected a whole number, at least 1 and at most 4 for each core")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_proposed_command_can_be_pasted() {
        let study = StudyArgs {
            scenario: Some("my study.toml".to_owned()),
            text: None,
            overrides: ["time.step-s=60", "gnss.files=['a b.tle']"]
                .map(str::to_owned)
                .to_vec(),
        };
        assert_eq!(
            study.words(),
            "'my study.toml' --set time.step-s=60 --set 'gnss.files=['\\''a b.tle'\\'']'"
        );
        assert_eq!(
            quoted("delta:55:4/2/1@925,e=0.01"),
            "delta:55:4/2/1@925,e=0.01"
        );
        assert_eq!(
            (quoted(""), quoted("$(x)")),
            ("''".to_owned(), "'$(x)'".to_owned())
        );
    }
}

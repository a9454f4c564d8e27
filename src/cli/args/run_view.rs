//! Arguments of the commands that show a run, or constellations.

use super::{ConstellationArgs, StudyArgs};
use crate::report::figures::draw::Form;
use crate::report::figures::{Figure, Measure, Projection};
use clap::Args;
use std::path::PathBuf;

/// A run or a scenario, and what to compare with it.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ViewArgs {
    /// A run directory, whose front is shown; or a scenario file or the name of a built-in scenario, in which
    /// constellations are shown, its own if none are given [default: paper].
    #[arg(value_name = "RUN | SCENARIO")]
    pub(crate) subject: Option<String>,

    /// Override a key of the scenario, as in `--set visibility.mask-deg=10`; may be repeated. A run keeps the
    /// scenario that it was made with.
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub(crate) overrides: Vec<String>,

    #[command(flatten)]
    pub(crate) constellations: ConstellationArgs,

    /// Take these satellites out of service throughout, as for `evaluate`: satellites (NW-P01-S03), planes (NW-P03), shells
    /// (NW-A) or GNSS satellites (gps:A3). A run keeps those of its scenario.
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    pub(crate) without: Vec<String>,

    /// Also show the front of this run, in addition to the sweep of --certify; may be repeated. Only with a run.
    #[arg(long, value_name = "DIR")]
    pub(crate) front: Vec<PathBuf>,

    /// The report.json of a validation, or its directory [default: RUN/validation]. Only with a run.
    #[arg(long, value_name = "PATH")]
    pub(crate) validation: Option<PathBuf>,
}

impl ViewArgs {
    /// The run directory, if it is one that is shown.
    pub(crate) fn run(&self) -> Option<PathBuf> {
        let named = PathBuf::from(self.subject.as_ref()?);
        named.is_dir().then_some(named)
    }

    /// The scenario, if it is not a run that is shown.
    pub(crate) fn study(&self) -> StudyArgs {
        StudyArgs {
            scenario: self.subject.clone(),
            overrides: self.overrides.clone(),
            text: None,
        }
    }
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    #[command(flatten)]
    pub(crate) view: ViewArgs,

    /// Add what the failure of any K satellites does (1 to 3), as for `evaluate --failures`: the distribution, the worst cases and
    /// the map of the worst loss.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub(crate) failures: Option<u8>,

    /// Number of draws of --failures [default: 200].
    #[arg(long, value_name = "N", requires = "failures", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(crate) draws: Option<u32>,

    /// Page to write [default: RUN/report.html, or report.html].
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

/// How a figure looks in print.
#[derive(Debug, Args)]
pub(crate) struct LookArgs {
    /// Width of the figure, mm: 85 for one column of a journal [default: 180].
    #[arg(long, value_name = "MM", allow_negative_numbers = true)]
    pub(crate) width_mm: Option<f64>,

    /// Size of the text, points [default: 8].
    #[arg(long, value_name = "PT", allow_negative_numbers = true)]
    pub(crate) font_size: Option<f64>,

    /// Title in place of the usual one; none for no title.
    #[arg(long, value_name = "TEXT")]
    pub(crate) title: Option<String>,

    /// Logarithmic axis of the measure, or logarithmic colours of a map.
    #[arg(long)]
    pub(crate) log: bool,

    /// Ends of the axis of the measure, or of the colours of a map; values beyond have the colour of the end.
    #[arg(
        long,
        value_name = "LOW,HIGH",
        value_delimiter = ',',
        allow_negative_numbers = true
    )]
    pub(crate) range: Option<Vec<f64>>,

    /// End the axis of the measure, or the colours of a map, at this percentile of its values.
    #[arg(long, value_name = "P")]
    pub(crate) clip_percentile: Option<f64>,

    /// How a map shows the Earth: plate-carree or equal-earth, which has areas in proportion [default: equal-earth for the
    /// globe, else plate-carree].
    #[arg(long)]
    pub(crate) projection: Option<Projection>,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    #[command(flatten)]
    pub(crate) view: ViewArgs,

    /// Figure to draw: pareto, map, cdf, series, histogram, timeline, failures, phases, convergence or budget.
    #[arg(long)]
    pub(crate) figure: Figure,

    /// Quantity of a map, a distribution or a series.
    #[arg(long)]
    pub(crate) measure: Option<Measure>,

    /// What a map or a timeline shows, and what comes first in a distribution or a series: of a run fuzzy, sum, topsis, knee or
    /// the index of a design on the front; otherwise, or beside the front, the name of a constellation or its
    /// number from 1 [default: fuzzy, or the first constellation; needed for a map or a timeline of one of several].
    #[arg(long, value_name = "PICK")]
    pub(crate) pick: Option<String>,

    /// Satellites that fail together in the figure failures: 1 to 3, all sets or draws as for `evaluate --failures` [default: 1].
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u8).range(1..=3))]
    pub(crate) failures: Option<u8>,

    /// The table of the figure phases, as for `evaluate --phases`.
    #[arg(long, value_name = "FILE")]
    pub(crate) phases: Option<PathBuf>,

    /// Number of draws of the figure failures [default: 200].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=1_000_000))]
    pub(crate) draws: Option<u32>,

    /// File format: svg, pdf (vector, with the typeface embedded), png (300 dots per inch), or csv for the data alone
    /// [default: by the extension of --out, or svg].
    #[arg(long = "as", value_name = "FORM")]
    pub(crate) form: Option<Form>,

    #[command(flatten)]
    pub(crate) look: LookArgs,

    /// Figure to write, in directories that are made for it; its data goes next to it.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,

    /// Replace the table next to the figure.
    #[arg(long)]
    pub(crate) force: bool,
}

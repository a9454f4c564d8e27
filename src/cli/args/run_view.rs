//! What can be typed to show a run.

use crate::constellation::Design;
use crate::optimize::Pick;
use crate::report::figures::draw::Form;
use crate::report::figures::{Figure, Measure};
use clap::Args;
use std::path::PathBuf;

/// A run, and what is shown beside it.
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// A run directory.
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,

    /// Show this design beside the front, besides the scenario's reference design; may be repeated.
    #[arg(long, value_name = "NOTATION")]
    pub(crate) compare: Vec<Design>,

    /// Show the front of this run too, besides the sweep of --certify; may be repeated.
    #[arg(long, value_name = "DIR")]
    pub(crate) front: Vec<PathBuf>,

    /// The report.json of a validation, or its directory [default: DIR/validation].
    #[arg(long, value_name = "PATH")]
    pub(crate) validation: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct ReportArgs {
    #[command(flatten)]
    pub(crate) run: RunArgs,

    /// Where the page goes [default: DIR/report.html].
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    #[command(flatten)]
    pub(crate) run: RunArgs,

    /// What is drawn: pareto, map, cdf, series, convergence or budget.
    #[arg(long)]
    pub(crate) figure: Figure,

    /// What a map, a distribution or a series shows.
    #[arg(long)]
    pub(crate) measure: Option<Measure>,

    /// Which design of the run a map, a distribution or a series shows: fuzzy, knee, or an index.
    #[arg(long, value_name = "PICK", default_value = "fuzzy")]
    pub(crate) pick: Pick,

    /// Form: svg, png, or csv for the table alone [default: by the name of --out, or svg].
    #[arg(long = "as", value_name = "FORM")]
    pub(crate) form: Option<Form>,

    /// Where the figure goes; the table goes beside it.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

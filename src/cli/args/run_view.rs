//! Arguments of the commands that show a run.

use super::MemberPick;
use crate::constellation::Design;
use crate::report::figures::draw::Form;
use crate::report::figures::{Figure, Measure};
use clap::Args;
use std::path::{Path, PathBuf};

impl RunArgs {
    /// What is read.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = &Path> {
        let directory = std::iter::once(&self.directory);
        let others = self.front.iter().chain(&self.validation);
        directory.chain(others).map(PathBuf::as_path)
    }
}

/// A run, and what to compare it with.
#[derive(Debug, Args)]
pub(crate) struct RunArgs {
    /// A run directory.
    #[arg(value_name = "DIR")]
    pub(crate) directory: PathBuf,

    /// Compare the front with this design, in addition to the reference design; may be repeated.
    #[arg(long, value_name = "NOTATION")]
    pub(crate) compare: Vec<Design>,

    /// Also show the front of this run, in addition to the sweep of --certify; may be repeated.
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

    /// Page to write [default: DIR/report.html].
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct PlotArgs {
    #[command(flatten)]
    pub(crate) run: RunArgs,

    /// Figure to draw: pareto, map, cdf, series, convergence or budget.
    #[arg(long)]
    pub(crate) figure: Figure,

    /// Quantity of a map, a distribution or a series.
    #[arg(long)]
    pub(crate) measure: Option<Measure>,

    /// Design of a map, a distribution or a series: fuzzy, sum, topsis, knee, its index, or its name.
    #[arg(long, value_name = "PICK", default_value = "fuzzy")]
    pub(crate) pick: MemberPick,

    /// File format: svg, png, or csv for the data alone [default: by the extension of --out, or svg].
    #[arg(long = "as", value_name = "FORM")]
    pub(crate) form: Option<Form>,

    /// Figure to write; its data goes next to it.
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,

    /// Replace the table next to the figure.
    #[arg(long)]
    pub(crate) force: bool,
}

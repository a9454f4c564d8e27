//! The arguments of `separation`.

use super::OutputFormat;
use crate::constellation::Design;
use clap::Args;

#[derive(Debug, Args)]
pub(crate) struct SeparationArgs {
    /// Designs, as `delta:55:182/13/1@925`: pattern, inclination, T/P/F and altitude; + joins shells.
    #[arg(value_name = "NOTATION", required = true)]
    pub(crate) designs: Vec<Design>,

    /// A row for each phasing F from 0 to P - 1 in place of the one given; of a hybrid, of its first shell.
    #[arg(long)]
    pub(crate) all_phasings: bool,

    /// Add the closest approach between shells of other rates within this time from the epoch, hours.
    #[arg(long, value_name = "H", value_parser = hours)]
    pub(crate) duration_h: Option<f64>,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// Hours above zero, up to a year.
fn hours(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(hours) if hours > 0.0 && hours <= 8784.0 => Ok(hours),
        _ => Err("expected hours above 0, at most 8784".to_owned()),
    }
}

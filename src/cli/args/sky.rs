//! The arguments of `dop` and `orbit`.

use super::OutputFormat;
use crate::constellation::Design;
use crate::dop::{Clocks, ObservationWeights};
use clap::Args;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct DopArgs {
    /// A CSV table with the columns azimuth_deg and elevation_deg, and perhaps system (its satellites share a clock) and
    /// sky (a name; one table may hold several skies); `-` is stdin.
    #[arg(value_name = "FILE")]
    pub(crate) file: PathBuf,

    /// Use the satellites at this elevation or higher, degrees, from 0 to below 90.
    #[arg(long, value_name = "DEG", default_value = "0", value_parser = mask)]
    pub(crate) mask_deg: f64,

    /// Which satellites share a clock: per-system, or shared by all.
    #[arg(long, value_name = "CLOCKS", default_value = "per-system")]
    pub(crate) clocks: Clocks,

    /// How observations are weighted: unit, or sine-elevation.
    #[arg(long, value_name = "WEIGHTS", default_value = "unit")]
    pub(crate) weighting: ObservationWeights,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

/// An elevation mask in degrees.
fn mask(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(mask_deg) if (0.0..90.0).contains(&mask_deg) => Ok(mask_deg),
        _ => Err("expected degrees from 0 to below 90".to_owned()),
    }
}

#[derive(Debug, Args)]
pub(crate) struct OrbitArgs {
    /// Designs, as `delta:97.4:1/1/0@500`: pattern, inclination, T/P/F and altitude; each shell is an orbit.
    #[arg(value_name = "NOTATION", required = true)]
    pub(crate) designs: Vec<Design>,

    /// Output format.
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: OutputFormat,
}

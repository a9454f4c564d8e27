//! `navwalker orbit`: periods, rates and ground tracks.

use crate::cli::args::{OrbitArgs, OutputFormat};
use crate::cli::{Status, output};
use crate::report::{OrbitResult, orbits_csv, orbits_text};
use anyhow::Result;

pub(crate) fn run(args: &OrbitArgs) -> Result<Status> {
    let orbits: Vec<OrbitResult> = args
        .designs
        .iter()
        .flat_map(OrbitResult::of_design)
        .collect();
    output::result(&match args.format {
        OutputFormat::Text => orbits_text(&orbits),
        OutputFormat::Json => crate::printable::json(&orbits)? + "\n",
        OutputFormat::Csv => orbits_csv(&orbits)?,
    })?;
    Ok(Status::Done)
}

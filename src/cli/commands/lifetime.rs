//! `navwalker lifetime`: what years do to the shells of designs.

use crate::cli::args::{LifetimeArgs, OutputFormat};
use crate::cli::{Status, output};
use crate::orbit::drag::DragSpacecraft;
use crate::report::{DesignLifetime, LifetimeOptions, lifetimes_csv, lifetimes_text};
use anyhow::{Context, Result};

pub(crate) fn run(args: &LifetimeArgs) -> Result<Status> {
    let options = LifetimeOptions {
        spacecraft: DragSpacecraft::new(args.mass_kg, args.area_m2, args.drag_coefficient)?,
        box_km: args.box_km,
        sigma_a_km: args.sigma_a_km,
        sigma_i_deg: args.sigma_i_deg,
    };
    let mut found = Vec::new();
    for design in &args.designs {
        found.push(DesignLifetime::of(design, &options).with_context(|| design.to_string())?);
    }
    output::result(&match args.format {
        OutputFormat::Text => lifetimes_text(&found),
        OutputFormat::Json => crate::printable::json(&found)? + "\n",
        OutputFormat::Csv => lifetimes_csv(&found)?,
    })?;
    Ok(Status::Done)
}

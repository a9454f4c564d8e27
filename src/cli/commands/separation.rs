//! `navwalker separation`: how close satellites come to each other.

use crate::cli::args::{OutputFormat, SeparationArgs};
use crate::cli::{Status, output};
use crate::constellation::{Design, Shell};
use crate::report::{DesignSeparation, separations_csv, separations_text};
use anyhow::{Context, Result};

pub(crate) fn run(args: &SeparationArgs) -> Result<Status> {
    let mut found = Vec::new();
    for design in designs(args)? {
        let separation = DesignSeparation::of(&design, args.duration_h);
        found.push(separation.with_context(|| format!("{design}: --duration-h"))?);
    }
    output::result(&match args.format {
        OutputFormat::Text => separations_text(&found),
        OutputFormat::Json => crate::printable::json(&found)? + "\n",
        OutputFormat::Csv => separations_csv(&found)?,
    })?;
    Ok(Status::Done)
}

/// The designs, with `--all-phasings` each with every phasing of its first shell.
fn designs(args: &SeparationArgs) -> Result<Vec<Design>> {
    if !args.all_phasings {
        return Ok(args.designs.clone());
    }
    let mut designs = Vec::new();
    for design in &args.designs {
        let [first, others @ ..] = design.shells() else {
            continue;
        };
        for phasing in 0..first.planes() {
            let shells =
                std::iter::once(with_phasing(first, phasing)?).chain(others.iter().copied());
            designs.push(Design::new(shells.collect())?);
        }
    }
    Ok(designs)
}

/// The same shell with another phasing.
fn with_phasing(shell: &Shell, phasing: usize) -> Result<Shell> {
    let parameters = crate::constellation::ShellParameters {
        phasing,
        ..shell.parameters()
    };
    Ok(Shell::new(parameters)?
        .with_ellipse(shell.eccentricity(), shell.arg_perigee_deg())?
        .with_orientation(shell.orientation())?)
}

//! The constellations that a command works on, from its arguments.

use crate::cli::args::ConstellationArgs;
use crate::cli::study::Study;
use crate::cli::{coincidence, output, read_constellation};
use crate::ephemeris::Ephemeris;
use crate::evaluate::Setup;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::exchange::import::SatelliteFilter;
use crate::time::TimeGrid;
use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};

/// An argument that may begin with a name: `NAME=TEXT`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Named {
    /// The name, if given: letters, digits, `-` and `_`.
    pub(crate) name: Option<String>,
    /// What it names.
    pub(crate) text: String,
}

impl std::str::FromStr for Named {
    type Err = std::convert::Infallible;

    fn from_str(argument: &str) -> Result<Self, Self::Err> {
        let is_name = |name: &&str| {
            let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
            !name.is_empty() && name.chars().all(allowed)
        };
        let named = argument.split_once('=');
        Ok(match named.filter(|(name, _)| is_name(name)) {
            Some((name, text)) => Self {
                name: Some(name.to_owned()),
                text: text.to_owned(),
            },
            None => Self {
                name: None,
                text: argument.to_owned(),
            },
        })
    }
}

impl ConstellationArgs {
    /// Whether no constellation was given.
    pub(crate) fn is_empty(&self) -> bool {
        self.design.is_empty() && self.constellation.is_empty()
    }

    /// The files and directories that are read.
    pub(crate) fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.constellation.iter().map(|one| Path::new(&one.text))
    }
}

/// The constellations given on the command line: the designs, then the files, each in its order.
pub(crate) fn resolve(args: &ConstellationArgs, study: &Study) -> Result<Vec<Constellation>> {
    let mut found = Vec::new();
    for given in &args.design {
        let one = of_notation(&given.text, study)?;
        found.push(renamed(one, given));
    }
    for given in &args.constellation {
        let one = of_files(args, &PathBuf::from(&given.text))?;
        found.push(renamed(one, given));
    }
    require_different_names(&found)?;
    Ok(found)
}

/// The satellites of a constellation on the grid of a setup, with warnings of what is old, interpolated or in
/// one place.
pub(crate) fn propagate(one: &Constellation, setup: &Setup) -> Result<Ephemeris> {
    let ephemeris = one
        .ephemeris(setup.grid, setup.model)
        .with_context(|| format!("cannot propagate {}", one.name))?;
    warn_of_files(one, setup.grid);
    coincidence::warn(&setup.gnss, setup.grid, Some(&ephemeris));
    Ok(ephemeris)
}

/// Warns of old element sets and of interpolated states.
pub(crate) fn warn_of_files(one: &Constellation, grid: TimeGrid) {
    let Some(files) = &one.files else { return };
    if let Some(stale) = files.fleet.stale(&one.name, grid) {
        output::warning(&stale.to_string());
    }
    for note in files.fleet.sampling_notes(grid) {
        output::warning(&note.to_string());
    }
}

fn renamed(one: Constellation, given: &Named) -> Constellation {
    match &given.name {
        Some(name) => one.named(name.clone()),
        None => one,
    }
}

/// A design by its notation.
fn of_notation(text: &str, _study: &Study) -> Result<Constellation> {
    let design = text.parse().with_context(|| format!("--design {text}"))?;
    Ok(Constellation::of_design(design))
}

/// The satellites of a file or a directory that the arguments select.
fn of_files(args: &ConstellationArgs, path: &PathBuf) -> Result<Constellation> {
    let (formats, mut fleet) =
        read_constellation::read(std::slice::from_ref(path), args.input_format)?;
    fleet.choose(&SatelliteFilter {
        only: args.only.clone(),
        exclude: args.exclude.clone(),
    })?;
    let name = path.file_name().unwrap_or(path.as_os_str());
    Ok(Constellation::of_files(FileSatellites {
        names: vec![name.to_string_lossy().into_owned()],
        formats,
        fleet,
    }))
}

fn require_different_names(constellations: &[Constellation]) -> Result<()> {
    for (n, one) in constellations.iter().enumerate() {
        if constellations[..n]
            .iter()
            .any(|other| other.name == one.name)
        {
            bail!(
                "two constellations are named {}; name them apart, as in --design first=NOTATION",
                one.name
            );
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_ends_at_the_first_equals_sign() {
        for (argument, name, text) in [
            (
                "delta:55:4/2/1@925,e=0.01",
                None,
                "delta:55:4/2/1@925,e=0.01",
            ),
            (
                "polar=star:90:4/2/1@925",
                Some("polar"),
                "star:90:4/2/1@925",
            ),
            ("a_b-3=x=y.tle", Some("a_b-3"), "x=y.tle"),
            ("./a=b.tle", None, "./a=b.tle"),
            ("=b.tle", None, "=b.tle"),
        ] {
            let found: Named = argument.parse().unwrap();
            assert_eq!(found.name.as_deref(), name, "{argument}");
            assert_eq!(found.text, text, "{argument}");
        }
    }
}

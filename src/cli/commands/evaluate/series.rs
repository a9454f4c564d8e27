//! The series of `evaluate`: metrics by instant and by point.

use crate::cli::args::EvaluateArgs;
use crate::cli::files::{self, StagedDirectory};
use crate::cli::provenance::provenance;
use crate::cli::study::Study;
use crate::constellation::identity::UniqueTexts;
use crate::ephemeris::Ephemeris;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::Constellation;
use crate::report::{outages_csv, records_csv};
use crate::run::ResultProvenance;
use anyhow::Result;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The tables of a series.
const TABLES: [&str; 4] = ["epochs.csv", "points.csv", "histogram.csv", "outages.csv"];

/// Longest name of a folder, in characters.
const LONGEST_NAME: usize = 80;

/// The directory of `--series`, not yet in its place.
pub(super) struct SeriesDirectory {
    staged: StagedDirectory,
    provenance: ResultProvenance,
    place: PathBuf,
    /// The folder of each constellation; for a single one the directory itself.
    folders: Vec<String>,
}

impl SeriesDirectory {
    /// The directory, if it is asked for and may be written.
    pub(super) fn new(
        args: &EvaluateArgs,
        study: &Study,
        given: &[Constellation],
    ) -> Result<Option<Self>> {
        let Some(place) = args.series.clone() else {
            return Ok(None);
        };
        files::require_replaceable(&place, args.force, &own(&place))?;
        let inputs = study.inputs();
        let inputs = inputs.iter().map(PathBuf::as_path);
        files::refuse_inputs(&place, inputs.chain(args.constellations.inputs()))?;
        let folders = match given {
            [_] => vec![String::new()],
            several => folders(several.iter().map(|one| one.name.as_str())),
        };
        Ok(Some(Self {
            staged: StagedDirectory::new(&place)?,
            provenance: provenance(vec![study.stamp()?]),
            place,
            folders,
        }))
    }

    /// Writes the series of the constellation in this place of the arguments.
    pub(super) fn write(
        &self,
        number: usize,
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
    ) -> Result<()> {
        let series = evaluator.series(ephemeris)?;
        let tables = [
            records_csv(&series.epochs)?,
            records_csv(&series.points)?,
            records_csv(&series.histograms.rows())?,
            outages_csv(&series)?,
        ];
        let path = |name: &str| match self.folders[number].as_str() {
            "" => name.to_owned(),
            folder => format!("{folder}/{name}"),
        };
        let named = TABLES.into_iter().map(path);
        let files: Vec<_> = named.zip(tables.map(String::into_bytes)).collect();
        files::write_all(self.staged.path(), &files)
    }

    /// Says what is written where.
    pub(super) fn told(&self) -> String {
        let place = self.place.display();
        match self.folders.as_slice() {
            [_] => format!("\n{} written to {place}", TABLES.join(", ")),
            several => format!(
                "\n{} written to {place}, in {}",
                TABLES.join(", "),
                several.join(", ")
            ),
        }
    }

    /// Puts the directory in its place.
    pub(super) fn commit(self) -> Result<()> {
        self.staged.commit(&self.provenance)
    }
}

/// The files of a series that may be in a directory: in itself, and in its folders.
fn own(directory: &Path) -> BTreeSet<String> {
    let mut own: BTreeSet<String> = TABLES.map(str::to_owned).into();
    for entry in fs::read_dir(directory).into_iter().flatten().flatten() {
        let folder = entry.file_name().to_string_lossy().into_owned();
        own.extend(TABLES.map(|name| format!("{folder}/{name}")));
    }
    own
}

/// A folder for each name: without characters that some file systems refuse, and no two alike, whatever the
/// case.
fn folders<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let mut folders = UniqueTexts::default();
    names
        .map(|name| folders.take_by(safe(name), "-", str::to_lowercase))
        .collect()
}

fn safe(name: &str) -> String {
    let kept = |c: char| c.is_alphanumeric() || "-_.,+=@".contains(c);
    let safe: String = name
        .chars()
        .map(|c| if kept(c) { c } else { '_' })
        .take(LONGEST_NAME)
        .collect();
    // Neither hidden, nor `..`, nor with an end that some file systems drop.
    let trimmed = safe.trim_matches('.');
    if trimmed.is_empty() {
        return "constellation".to_owned();
    }
    trimmed.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_are_safe_and_differ() {
        let names = [
            "delta:55:182/13/1@925",
            "delta:55:182_13_1@925",
            "..",
            "Polar",
            "polar",
            "a b.tle.",
        ];
        let expected = [
            "delta_55_182_13_1@925",
            "delta_55_182_13_1@925-2",
            "constellation",
            "Polar",
            "polar-2",
            "a_b.tle",
        ];
        assert_eq!(folders(names.into_iter()), expected);
        let long = "delta:55:4/2/1@925+".repeat(20);
        assert_eq!(safe(&long).len(), LONGEST_NAME);
    }
}

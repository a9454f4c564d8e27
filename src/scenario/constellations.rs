//! The constellations of a scenario: what is behind a name, and the satellites of their files.

use super::Scenario;
use super::setup::SetupError;
use super::values::{ConstellationParts, NamedConstellation};
use crate::constellation::{Design, NotationError};
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::exchange::import::{
    Fleet, Merged, MergedFiles, NoSuchSatellite, ReadFleetError, SatelliteFilter, StateChoice,
};
use crate::keyword::nearest;
use crate::time::TimeGrid;
use std::io;
use thiserror::Error;

/// Why a text is not a design of a scenario.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum NoDesign {
    /// It is like a notation, but wrong.
    #[error(transparent)]
    Notation(#[from] NotationError),
    /// It is like a name, but there is no such constellation.
    #[error("{notation}; {}", no_such(.text, .known))]
    Unknown {
        /// The text.
        text: String,
        /// Why it is not a notation.
        notation: NotationError,
        /// The names of the constellations.
        known: Vec<String>,
    },
    /// It names satellites from files.
    #[error("the constellation '{0}' has satellites from files, but this needs a design alone")]
    HasFiles(String),
}

fn no_such(text: &str, known: &[String]) -> String {
    if known.is_empty() {
        return "and the scenario names no constellations".to_owned();
    }
    let names: Vec<&str> = known.iter().map(String::as_str).collect();
    let meant = nearest(text, &names);
    let meant = meant.map_or_else(String::new, |name| format!(", did you mean '{name}'?"));
    let names = names.join(", ");
    format!("nor is it a constellation of the scenario{meant} (choices: {names})")
}

/// Why the files of a constellation do not give its satellites.
#[derive(Debug, Error)]
pub enum ConstellationFileError {
    /// A file cannot be read.
    #[error("cannot read it: {0}")]
    Io(#[from] io::Error),
    /// A line of it is wrong, or its format is not read.
    #[error(transparent)]
    Format(#[from] ReadFleetError),
    /// The selection does not fit the files.
    #[error(transparent)]
    Selection(#[from] NoSuchSatellite),
}

impl Scenario {
    /// The constellation of this name.
    #[must_use]
    pub fn constellation(&self, name: &str) -> Option<&NamedConstellation> {
        self.constellations.iter().find(|one| one.name == name)
    }

    /// The design that a text is the notation or the name of; `+` joins either.
    ///
    /// # Errors
    /// If it is neither, or names satellites from files.
    pub fn design(&self, text: &str) -> Result<Design, NoDesign> {
        let notation_of = |part: &str| match self.constellation(part.trim()) {
            None => Ok(part.to_owned()),
            Some(named) => match named.only_design() {
                Some(design) => Ok(design.to_string()),
                None => Err(NoDesign::HasFiles(named.name.clone())),
            },
        };
        let parts: Vec<String> = text.split('+').map(notation_of).collect::<Result<_, _>>()?;
        parts.join("+").parse().map_err(|notation| {
            // A notation has colons, a name has none.
            if text.contains(':') {
                return NoDesign::Notation(notation);
            }
            let named = self.constellations.iter();
            NoDesign::Unknown {
                text: text.to_owned(),
                notation,
                known: named.map(|one| one.name.clone()).collect(),
            }
        })
    }
}

impl Scenario {
    /// The constellation that every design of the search has beside its own shells, if any.
    ///
    /// # Errors
    /// If it is neither a notation nor the name of a constellation.
    pub fn fixed(&self) -> Result<Option<NamedConstellation>, NoDesign> {
        let Some(text) = &self.search.fixed else {
            return Ok(None);
        };
        if let Some(named) = self.constellation(text) {
            return Ok(Some(named.clone()));
        }
        let design = self.design(text)?;
        Ok(Some(NamedConstellation {
            name: text.clone(),
            parts: ConstellationParts::of_design(design),
        }))
    }

    /// Shells that every design of the search has beside its own.
    pub(super) fn fixed_shells(&self) -> Option<Design> {
        self.fixed().ok()??.parts.design
    }
}

impl NamedConstellation {
    /// The constellation in a study on `grid`, with notes on parts of its files that are not read. `read` returns the
    /// bytes of a file by the path as written.
    ///
    /// # Errors
    /// If a file cannot be read, or the satellites that are selected are not in the files.
    pub fn read(
        &self,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
        grid: TimeGrid,
    ) -> Result<(Constellation, Vec<String>), SetupError> {
        let mut notes = Vec::new();
        let files = match self.parts.files.as_slice() {
            [] => None,
            _ => Some(self.satellites(read, grid, &mut notes)?),
        };
        let constellation = Constellation {
            name: self.name.clone(),
            design: self.parts.design.clone(),
            files,
        };
        Ok((constellation, notes))
    }

    fn satellites(
        &self,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
        grid: TimeGrid,
        notes: &mut Vec<String>,
    ) -> Result<FileSatellites, SetupError> {
        let ConstellationParts {
            files,
            only,
            exclude,
            ..
        } = &self.parts;
        let filter = SatelliteFilter {
            only: only.clone(),
            exclude: exclude.clone(),
        };
        let choice = StateChoice::new(filter.clone(), grid);
        let mut merged = self.merged(read, &choice, notes)?;
        if merged.fleet.lacks_states(&filter) {
            notes.clear();
            merged = self.merged(read, &choice.of_all(), notes)?;
        }
        let name = |file: &String| file.rsplit('/').next().unwrap_or(file).to_owned();
        let names: Vec<String> = files.iter().map(name).collect();
        let called = names.join(", ");
        FileSatellites::new(names, merged, &filter)
            .map_err(|source| self.error(&called, source.into()))
    }

    /// The satellites of all files.
    fn merged(
        &self,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
        choice: &StateChoice,
        notes: &mut Vec<String>,
    ) -> Result<Merged, SetupError> {
        let mut merged = MergedFiles::default();
        for file in &self.parts.files {
            let error = |error| self.error(file, error);
            let name = file.rsplit('/').next().unwrap_or(file);
            let bytes = read(file).map_err(|source| error(source.into()))?;
            let format = self.parts.input_format;
            let imported = Fleet::read_chosen(bytes.as_slice(), format, Some(name), choice)
                .map_err(|source| error(source.into()))?;
            if !imported.left_out.is_empty() {
                notes.push(format!("{file}: {}", imported.left_out));
            }
            merged.add(imported);
        }
        Ok(merged.finish().unwrap_or_else(|| Merged {
            formats: Vec::new(),
            fleet: Fleet::Sets(Vec::new()),
            origins: Vec::new(),
        }))
    }

    /// The error of a file of this constellation.
    pub(super) fn error(&self, file: &str, source: ConstellationFileError) -> SetupError {
        SetupError::Constellation {
            name: self.name.clone(),
            file: file.to_owned(),
            source: Box::new(source),
        }
    }
}

//! From the bytes of a file to what can be compared.

use crate::exchange::import::{Fleet, ReadFleetError};
use crate::exchange::lint::Format;
use crate::formats::text::finding::LeftOut;
use crate::formats::trajectory::Trajectory;
use std::io::BufRead;
use thiserror::Error;

/// Why a file cannot be compared with a design.
#[derive(Debug, Error)]
pub enum FileError {
    /// The text breaks a rule of its format, or its states have no way to TEME.
    #[error("{file}: {source}")]
    Read {
        /// The file.
        file: String,
        /// What is wrong with it.
        source: ReadFleetError,
    },
    /// Mean elements or almanacs, which are of other theories.
    #[error("{0} holds mean elements or almanacs; states or SGP4 element sets can be compared")]
    MeanElements(String),
    /// SGP4 does not propagate an element set.
    #[error("{object}: {source}")]
    ElementSet {
        /// The object.
        object: String,
        /// Why not.
        source: crate::orbit::PropagationError,
    },
    /// No state lies in the span of the study.
    #[error(
        "none of the {objects} objects has a state within the span of the study, {from} to {to}; the first object covers {first} to {last}"
    )]
    AnotherEpoch {
        /// Objects of the files.
        objects: usize,
        /// First instant of the study.
        from: String,
        /// Last instant of the study.
        to: String,
        /// First instant of the first object.
        first: String,
        /// Its last.
        last: String,
    },
    /// No object is near a slot.
    #[error(
        "none of the {objects} objects of {source_name} matches one of the {slots} slots by name or place"
    )]
    NothingMatches {
        /// The files.
        source_name: String,
        /// Objects in them.
        objects: usize,
        /// Slots of the design.
        slots: usize,
    },
    /// No object at all.
    #[error("{0} has no object")]
    Empty(String),
}

/// An object of a file.
#[derive(Debug, Clone, PartialEq)]
pub enum Comparand {
    /// Sampled states.
    States(Trajectory),
    /// An element set, to be propagated by SGP4.
    Elements(Box<::sgp4::Elements>),
}

/// The objects of a file in `format`, or in the one that its content or else its name shows, and what is not read of it.
///
/// # Errors
/// When the file breaks its format, or its states are in a frame or time that is not known.
pub fn read(
    file: &str,
    input: impl BufRead,
    format: Option<Format>,
) -> Result<(Vec<Comparand>, LeftOut), FileError> {
    let read = Fleet::read(input, format, Some(file)).map_err(|source| FileError::Read {
        file: file.to_owned(),
        source,
    })?;
    let found = comparands(file, read.fleet)?;
    if found.is_empty() {
        return Err(FileError::Empty(file.to_owned()));
    }
    Ok((found, read.left_out))
}

/// What of a constellation can be compared.
///
/// # Errors
/// If it holds mean elements.
pub fn comparands(file: &str, fleet: Fleet) -> Result<Vec<Comparand>, FileError> {
    Ok(match fleet {
        Fleet::Sets(sets) => {
            let boxed = sets.into_iter().map(Box::new);
            boxed.map(Comparand::Elements).collect()
        }
        Fleet::Sampled(trajectories) => {
            let sampled = trajectories.into_iter().filter(|one| !one.arcs.is_empty());
            sampled.map(Comparand::States).collect()
        }
        Fleet::Elements(_) | Fleet::Almanacs(_) => {
            return Err(FileError::MeanElements(file.to_owned()));
        }
        Fleet::Mixed(parts) => {
            let mut all = Vec::new();
            for part in parts {
                all.extend(comparands(file, part)?);
            }
            all
        }
    })
}

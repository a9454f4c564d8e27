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
    /// The text violates its format, or its states cannot be transformed to TEME.
    #[error("{file}: {source}")]
    Read {
        /// The file.
        file: String,
        /// What is wrong with it.
        source: ReadFleetError,
    },
    /// Mean elements or almanacs, which belong to other theories.
    #[error(
        "{0} holds mean elements or almanacs; only states and SGP4 element sets can be compared"
    )]
    MeanElements(String),
    /// SGP4 fails to propagate an element set.
    #[error("{object}: {source}")]
    ElementSet {
        /// The object.
        object: String,
        /// Why not.
        source: crate::orbit::PropagationError,
    },
    /// No state is within the time span of the study.
    #[error(
        "none of the {objects} objects has a state within the time span of the study, {from} to {to}; the first object covers {first} to {last}"
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
        "none of the {objects} objects of {source_name} matches any of the {slots} slots by name or position"
    )]
    NothingMatches {
        /// The files.
        source_name: String,
        /// Objects in them.
        objects: usize,
        /// Slots of the design.
        slots: usize,
    },
    /// An object without a state at an instant at which the constellation has one.
    #[error(
        "{source_name}: {object} has no state at an instant at which the satellite that it is compared with has one; \
         set time.epoch and time.step-s to instants of both"
    )]
    NoCommonInstant {
        /// The files.
        source_name: String,
        /// The object.
        object: String,
    },
    /// No object at all.
    #[error("{0} has no objects")]
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

/// The objects of a file and what was left out of it. Without a `format`, the format is recognised by
/// content or else by name.
///
/// # Errors
/// If the file violates its format, or its states are in an unknown frame or time system.
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

//! From the bytes of a file to what can be compared.

use crate::formats::lint::Format;
use crate::formats::omm::Notation;
use crate::formats::trajectory::{Trajectory, TrajectoryError};
use crate::formats::{ReadError, oem, omm, sp3, stk, tle};
use crate::frames::{Frame, State};
use crate::words::UnknownWord;
use nalgebra::Vector3;
use thiserror::Error;

/// Why a file cannot be compared with a design.
#[derive(Debug, Error)]
pub enum FileError {
    /// The text breaks a rule of its format.
    #[error("{file}: {source}")]
    Read {
        /// The file.
        file: String,
        /// The rule.
        source: ReadError,
    },
    /// A frame, centre or time system that has no way to TEME.
    #[error("{file}: {source}")]
    Trajectory {
        /// The file.
        file: String,
        /// What is not known.
        source: TrajectoryError,
    },
    /// A frame that has no way to TEME.
    #[error("{file}: {source}")]
    Frame {
        /// The file.
        file: String,
        /// The name of the frame.
        source: UnknownWord,
    },
    /// SGP4 does not fly an element set.
    #[error("{object}: {source}")]
    ElementSet {
        /// The object.
        object: String,
        /// Why not.
        source: crate::orbit::PropagationError,
    },
    /// No state lies in the span of the study.
    #[error(
        "no state of the {objects} objects lies in the span of the study, {from} to {to}; the first object has {first} to {last}"
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
    /// An element set, to be flown by SGP4.
    Elements(Box<::sgp4::Elements>),
}

/// The objects of a file, its format told by its content or else its name.
///
/// # Errors
/// When the file breaks its format, or its states are in a frame or time that is not known.
pub fn read(file: &str, bytes: &[u8]) -> Result<Vec<Comparand>, FileError> {
    let broken = |source: ReadError| FileError::Read {
        file: file.to_owned(),
        source,
    };
    let of_sets = |sets: Vec<::sgp4::Elements>| {
        let boxed = sets.into_iter().map(Box::new);
        boxed.map(Comparand::Elements).collect::<Vec<_>>()
    };
    let messages = |notation| -> Result<Vec<Comparand>, FileError> {
        let messages = omm::read(bytes, notation).map_err(broken)?;
        Ok(of_sets(messages.into_iter().map(|one| one.set).collect()))
    };
    let found = match Format::of(bytes, Some(file)) {
        Format::Tle => of_sets(tle::read(bytes).map_err(broken)?),
        Format::Omm => messages(Notation::Kvn)?,
        Format::OmmXml => messages(Notation::Xml)?,
        Format::OmmJson => messages(Notation::Json)?,
        Format::OmmCsv => messages(Notation::Csv)?,
        Format::Oem => of_oem(file, &oem::read(bytes).map_err(broken)?)?,
        Format::Sp3 => of_sp3(file, sp3::read(bytes).map_err(broken)?)?,
        Format::Stk => vec![of_stk(file, stk::read(bytes).map_err(broken)?)],
    };
    if found.is_empty() {
        return Err(FileError::Empty(file.to_owned()));
    }
    Ok(found)
}

/// The segments of a message; those of one object are one trajectory.
fn of_oem(file: &str, message: &oem::Oem) -> Result<Vec<Comparand>, FileError> {
    let mut found: Vec<Trajectory> = Vec::new();
    for segment in &message.segments {
        let part = segment
            .trajectory()
            .map_err(|source| FileError::Trajectory {
                file: file.to_owned(),
                source,
            })?;
        let same = |whole: &&mut Trajectory| whole.id == part.id && whole.frame == part.frame;
        match found.iter_mut().find(same) {
            Some(whole) => whole.states.extend(part.states),
            None => found.push(part),
        }
    }
    Ok(found.into_iter().map(Comparand::States).collect())
}

/// Positions without velocities get none: only the epochs and places are compared.
fn of_sp3(file: &str, table: sp3::Sp3) -> Result<Vec<Comparand>, FileError> {
    let frame = crate::formats::trajectory::frame_of_name(&table.frame).or_else(|source| {
        // SP3 names a realisation of the Earth-fixed frame: IGS14, WGS84, ITR08.
        let earth_fixed = ["IGS", "IGb", "WGS", "ITR", "PZ-"];
        if earth_fixed
            .iter()
            .any(|start| table.frame.starts_with(start))
        {
            return Ok(Frame::EarthFixed);
        }
        Err(FileError::Frame {
            file: file.to_owned(),
            source,
        })
    })?;
    let objects = table.ids.into_iter().zip(table.states);
    Ok(objects
        .filter(|(_, samples)| !samples.is_empty())
        .map(|(id, samples)| {
            let state = |sample: &sp3::Sample| {
                let state = State {
                    position_km: sample.position_km,
                    velocity_km_s: sample.velocity_km_s.unwrap_or_else(Vector3::zeros),
                };
                (sample.at, state)
            };
            Comparand::States(Trajectory {
                name: id.clone(),
                id,
                frame,
                states: samples.iter().map(state).collect(),
            })
        })
        .collect())
}

/// One file is one object, named by its file.
fn of_stk(file: &str, ephemeris: stk::StkEphemeris) -> Comparand {
    let name = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let name = name.strip_suffix(".e").unwrap_or(name).to_owned();
    let epoch = crate::time::Epoch::from_utc(ephemeris.scenario_epoch.and_utc());
    let states = ephemeris.states.into_iter();
    Comparand::States(Trajectory {
        id: name.clone(),
        name,
        frame: ephemeris.frame,
        states: states
            .map(|(elapsed_s, state)| (epoch.plus_seconds(elapsed_s), state))
            .collect(),
    })
}

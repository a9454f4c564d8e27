//! Satellites read from a file of any format, propagated by the theory that the file implies.
//!
//! Element sets (TLE, OMM) propagate by SGP4; tables of mean elements, and parameter messages that hold
//! them, by the model of the study; sampled states are used as they are, at their samples.

mod propagation;

pub use propagation::FleetError;

use crate::ephemeris::derivative::velocities;
use crate::exchange::lint::Format;
use crate::formats::ccsds::omm::OmmSyntax;
use crate::formats::ccsds::{oem, omm, opm};
use crate::formats::csv::ElementsRow;
use crate::formats::maps::czml;
use crate::formats::trajectory::{TrajectoryError, frame_of_name, time_system_of_name};
use crate::formats::{ReadError, csv};
use crate::formats::{sp3, stk, tle};
use crate::frames::{Frame, Position, State};
use crate::keyword::UnknownKeyword;
use crate::time::Epoch;
use std::io::BufRead;
use thiserror::Error;

/// Satellites as read from files.
#[derive(Debug, Clone, PartialEq)]
pub enum Fleet {
    /// Element sets for SGP4.
    Sets(Vec<sgp4::Elements>),
    /// Mean elements of secular J2.
    Elements(Vec<ElementsRow>),
    /// States.
    Sampled(Vec<crate::formats::trajectory::Trajectory>),
    /// Positions with the polynomials between them.
    Tracks(Vec<crate::formats::maps::czml::CzmlTrack>),
}

/// Why a file gives no satellites.
#[derive(Debug, Error)]
pub enum ReadFleetError {
    /// It violates its format.
    #[error(transparent)]
    Read(#[from] ReadError),
    /// Its states cannot be transformed to a known frame.
    #[error(transparent)]
    Trajectory(#[from] TrajectoryError),
    /// A parameter message of another program: one state, and no theory to propagate it.
    #[error("{name}: the message has a state at one instant but no mean elements to propagate")]
    NoTheory {
        /// The satellite.
        name: String,
    },
    /// Files of one constellation that propagate by different theories.
    #[error("one file has {first} and another {second}; give files of one kind")]
    Mixed {
        /// The content of the first.
        first: &'static str,
        /// The content of the other.
        second: &'static str,
    },
    /// A satellite whose file has a single sample without a velocity, or two at one instant.
    #[error("{name}: there are no velocities, and too few positions to derive them")]
    NoVelocity {
        /// The satellite.
        name: String,
    },
}

impl Fleet {
    /// Reads a file in `format`, or in the format detected from its beginning and its name.
    ///
    /// # Errors
    /// If the file violates its format, or its states are in an unknown frame or time system.
    pub fn read(
        mut input: impl BufRead,
        format: Option<Format>,
        file_name: Option<&str>,
    ) -> Result<(Format, Self), ReadFleetError> {
        let format = match format {
            Some(format) => format,
            None => Format::of(input.fill_buf().map_err(ReadError::Io)?, file_name),
        };
        let fleet = match format {
            Format::Tle => Self::Sets(tle::read(input)?),
            Format::Omm => Self::of_omm(omm::read(input, OmmSyntax::Kvn)?),
            Format::OmmXml => Self::of_omm(omm::read(input, OmmSyntax::Xml)?),
            Format::OmmJson => Self::of_omm(omm::read(input, OmmSyntax::Json)?),
            Format::OmmCsv => Self::of_omm(omm::read(input, OmmSyntax::Csv)?),
            Format::Oem => Self::of_oem(vec![oem::read(input)?])?,
            Format::OemXml => Self::of_oem(oem::read_xml(input)?)?,
            Format::Opm => Self::of_opm(opm::read(input)?)?,
            Format::Sp3 => Self::of_sp3(sp3::read(input)?)?,
            Format::Stk => Self::of_stk(stk::read(input)?, file_name),
            Format::ElementsCsv => Self::Elements(csv::read_elements(input)?),
            Format::Czml => Self::Tracks(czml::read(input)?),
            Format::StatesCsv => Self::Sampled(csv::read_states(input)?),
        };
        Ok((format, fleet))
    }

    fn of_omm(messages: Vec<omm::Omm>) -> Self {
        Self::Sets(messages.into_iter().map(|message| message.set).collect())
    }

    /// The segments of one satellite follow each other.
    fn of_oem(messages: Vec<oem::Oem>) -> Result<Self, ReadFleetError> {
        let mut trajectories: Vec<crate::formats::trajectory::Trajectory> = Vec::new();
        for message in &messages {
            let first = trajectories.len();
            for segment in &message.segments {
                let next = segment.trajectory()?;
                let same = trajectories[first..]
                    .iter_mut()
                    .find(|before| before.id == next.id && before.frame == next.frame);
                match same {
                    Some(before) => join(&mut before.states, next.states),
                    None => trajectories.push(next),
                }
            }
        }
        Ok(Self::Sampled(trajectories))
    }

    fn of_opm(message: opm::Opm) -> Result<Self, ReadFleetError> {
        let system = time_system_of_name(&message.time_system).map_err(TrajectoryError::Name)?;
        match message.mean_elements() {
            Some(elements) => Ok(Self::Elements(vec![ElementsRow {
                name: message.object_name,
                epoch: system.epoch(message.epoch),
                elements,
            }])),
            None => Err(ReadFleetError::NoTheory {
                name: message.object_name,
            }),
        }
    }

    fn of_sp3(file: sp3::Sp3) -> Result<Self, ReadFleetError> {
        let frame = frame_of_sp3(&file.frame).map_err(TrajectoryError::Name)?;
        let mut trajectories = Vec::new();
        let given = file.ids.iter().zip(&file.states);
        for (id, samples) in given.filter(|(_, samples)| !samples.is_empty()) {
            let positions: Vec<(Epoch, Position<Frame>)> =
                samples.iter().map(|s| (s.at, s.position_km)).collect();
            let given: Option<Vec<_>> = samples.iter().map(|s| s.velocity_km_s).collect();
            let velocities = given
                .or_else(|| velocities(&positions))
                .ok_or_else(|| ReadFleetError::NoVelocity { name: id.clone() })?;
            let state = |((at, position_km), velocity_km_s)| {
                let state = State {
                    position_km,
                    velocity_km_s,
                };
                (at, state)
            };
            trajectories.push(crate::formats::trajectory::Trajectory {
                name: file.name_of(id).unwrap_or(id).to_owned(),
                id: id.clone(),
                frame,
                states: positions.into_iter().zip(velocities).map(state).collect(),
            });
        }
        Ok(Self::Sampled(trajectories))
    }

    /// Names sampled satellites by their position, from 1: for files that each restart their ids, such as
    /// the parts of a large constellation in SP3.
    pub fn name_by_place(&mut self) {
        if let Self::Sampled(trajectories) = self {
            for (place, trajectory) in (1..).zip(trajectories) {
                trajectory.name = format!("{place}");
            }
        }
    }

    /// The file does not name its satellite, which gets the name of the file.
    fn of_stk(file: stk::StkEphemeris, file_name: Option<&str>) -> Self {
        let file_name = file_name.unwrap_or("satellite");
        let file_name = file_name.rsplit(['/', '\\']).next().unwrap_or(file_name);
        let name = file_name
            .rsplit_once('.')
            .map_or(file_name, |(stem, _)| stem);
        let epoch = Epoch::from_utc(file.scenario_epoch.and_utc());
        let at =
            |(elapsed_s, state): &(f64, State<Frame>)| (epoch.plus_seconds(*elapsed_s), *state);
        Self::Sampled(vec![crate::formats::trajectory::Trajectory {
            name: name.to_owned(),
            id: name.to_owned(),
            frame: file.frame,
            states: file.states.iter().map(at).collect(),
        }])
    }

    /// Adds the satellites of another file.
    ///
    /// # Errors
    /// If they propagate by another theory.
    pub fn append(&mut self, other: Self) -> Result<(), ReadFleetError> {
        match (&mut *self, other) {
            (Self::Sets(sets), Self::Sets(more)) => sets.extend(more),
            (Self::Elements(rows), Self::Elements(more)) => rows.extend(more),
            (Self::Sampled(states), Self::Sampled(more)) => states.extend(more),
            (Self::Tracks(tracks), Self::Tracks(more)) => tracks.extend(more),
            (first, second) => {
                return Err(ReadFleetError::Mixed {
                    first: first.content(),
                    second: second.content(),
                });
            }
        }
        Ok(())
    }

    /// Its content, in words.
    #[must_use]
    pub fn content(&self) -> &'static str {
        match self {
            Self::Sets(_) => "SGP4 element sets",
            Self::Elements(_) => "mean elements",
            Self::Sampled(_) => "sampled states",
            Self::Tracks(_) => "interpolated positions",
        }
    }

    /// Number of satellites.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Sets(sets) => sets.len(),
            Self::Elements(rows) => rows.len(),
            Self::Sampled(trajectories) => trajectories.len(),
            Self::Tracks(tracks) => tracks.len(),
        }
    }

    /// Whether there are no satellites.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Merges the states of a later segment with those of an earlier one, in time order; if segments
/// share an instant or overlap, the states of the earlier one are used.
fn join(before: &mut Vec<(Epoch, State<Frame>)>, next: Vec<(Epoch, State<Frame>)>) {
    before.extend(next);
    if !before.is_sorted_by(|(one, _), (other, _)| one < other) {
        // The sort is stable.
        before.sort_by_key(|(at, _)| *at);
        before.dedup_by_key(|(at, _)| *at);
    }
}

/// SP3 names a realisation of the Earth-fixed frame in five characters, as `IGS14`, `WGS84`,
/// `ITR08`; positions are Earth-fixed even without a name.
fn frame_of_sp3(name: &str) -> Result<Frame, UnknownKeyword> {
    let earth_fixed = ["IGS", "IGB", "WGS", "ITR", "PZ", "SLR", "UNDEF"];
    let upper = name.to_ascii_uppercase();
    if upper.is_empty() || earth_fixed.iter().any(|start| upper.starts_with(start)) {
        return Ok(Frame::EarthFixed);
    }
    frame_of_name(name)
}

#[cfg(test)]
mod tests;

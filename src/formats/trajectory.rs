//! A satellite's states as a file gives them, in the library's own terms.

use crate::formats::text::timestamp::TimeSystem;
use crate::frames::{Frame, State};
use crate::keyword::{Keyword, UnknownKeyword};
use crate::time::Epoch;
use thiserror::Error;

/// States of one satellite, in the order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// Name of the satellite.
    pub name: String,
    /// Its identifier.
    pub id: String,
    /// Frame of the states.
    pub frame: Frame,
    /// The states and their instants.
    pub states: Vec<(Epoch, State<Frame>)>,
}

/// Why the states of a file cannot be compared with ours.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum TrajectoryError {
    /// Another centre than the Earth.
    #[error("{name}: centre {center} is not the Earth")]
    Center {
        /// The satellite.
        name: String,
        /// The centre that the file names.
        center: String,
    },
    /// A frame that the library has no rotation to, or a time system that it cannot turn
    /// into UTC.
    #[error(transparent)]
    Name(#[from] UnknownKeyword),
}

/// The frame that a name in a file means.
///
/// Every realisation of the ITRF (`ITRF2000`, `ITRF-97`) is the Earth-fixed frame, `ICRF` of an
/// Earth orbit is GCRF, and `J2000` is what older files call EME2000.
///
/// # Errors
/// If the library has no such frame.
pub fn frame_of_name(name: &str) -> Result<Frame, UnknownKeyword> {
    match name.to_ascii_uppercase().as_str() {
        "J2000" => Ok(Frame::Eme2000),
        "ICRF" => Ok(Frame::Gcrf),
        upper if upper.starts_with("ITRF") => Ok(Frame::EarthFixed),
        upper => Frame::from_keyword(upper),
    }
}

/// The time system that a name in a file means; case does not matter (CCSDS 502.0-B-3, 7.5.3).
///
/// # Errors
/// If the library cannot turn it into UTC.
pub fn time_system_of_name(name: &str) -> Result<TimeSystem, UnknownKeyword> {
    TimeSystem::from_keyword(&name.to_ascii_uppercase())
}

//! A satellite's states as a file gives them, in the library's own terms.

use crate::ephemeris::arc::{Arc, Interpolation, SAME_INSTANT_S};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::{Frame, State};
use crate::keyword::{Keyword, UnknownKeyword};
use crate::time::Epoch;
use thiserror::Error;

/// States of one satellite.
#[derive(Debug, Clone, PartialEq)]
pub struct Trajectory {
    /// Name of the satellite.
    pub name: String,
    /// Its identifier.
    pub id: String,
    /// Its arcs, by start time; at an instant that two share, the earlier one is used.
    pub arcs: Vec<Arc>,
}

impl Trajectory {
    /// One arc of states in order of time, with no interpolation specified.
    #[must_use]
    pub fn of_states(
        name: &str,
        id: &str,
        frame: Frame,
        states: Vec<(Epoch, State<Frame>)>,
    ) -> Self {
        Self {
            name: name.to_owned(),
            id: id.to_owned(),
            arcs: Vec::from_iter(Arc::new(frame, Interpolation::OF_STATES, states)),
        }
    }

    /// The samples within the valid spans, in time order, without repeated instants.
    #[must_use]
    pub fn samples(&self) -> Vec<(Epoch, Frame, State<Frame>)> {
        let mut samples: Vec<(Epoch, Frame, State<Frame>)> = Vec::new();
        for arc in &self.arcs {
            samples.extend(arc.samples().map(|(at, state)| (*at, arc.frame, *state)));
        }
        let is_after = |one: Epoch, other: Epoch| other.seconds_since(one) > SAME_INSTANT_S;
        if !samples.is_sorted_by(|one, other| is_after(one.0, other.0)) {
            // The sort is stable.
            samples.sort_by_key(|(at, ..)| *at);
            samples.dedup_by(|next, one| !is_after(one.0, next.0));
        }
        samples
    }

    /// The arc that is valid at an instant.
    #[must_use]
    pub fn arc_at(&self, at: Epoch) -> Option<&Arc> {
        self.arcs.iter().find(|arc| arc.covers(at))
    }

    /// The first and last instants at which an arc is valid.
    #[must_use]
    pub fn span(&self) -> Option<(Epoch, Epoch)> {
        let first = self.arcs.iter().map(|arc| arc.useable.0).min()?;
        let last = self.arcs.iter().map(|arc| arc.useable.1).max()?;
        Some((first, last))
    }
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

/// Prefixes of the names of Earth-fixed frames: realisations of the ITRF (`ITRF2000`, `ITR08`), those of
/// navigation systems and of services (`IGS20`, `IGb14`, `SLR20`), and `ECEF` as such.
const EARTH_FIXED: [&str; 10] = [
    "ITR", "IGS", "IGB", "WGS84", "WGS-84", "SLR", "GTRF", "BTRF", "CGCS", "PZ",
];

/// The frame with this name in files; case does not matter.
///
/// Every realisation of the ITRF is the Earth-fixed frame, and so are the frames of navigation systems, which
/// agree with it to centimetres. `ICRF` of an Earth orbit is GCRF, and `J2000` is what older files call EME2000. Frames that
/// are true or mean of date (`TOD`, `MOD`, `TDR`) are not read.
///
/// # Errors
/// If the library has no such frame.
pub fn frame_of_name(name: &str) -> Result<Frame, UnknownKeyword> {
    match name.to_ascii_uppercase().as_str() {
        "J2000" => Ok(Frame::Eme2000),
        "ICRF" => Ok(Frame::Gcrf),
        "TEMEOFDATE" => Ok(Frame::Teme),
        "ECEF" | "ECF" => Ok(Frame::EarthFixed),
        upper if EARTH_FIXED.iter().any(|start| upper.starts_with(start)) => Ok(Frame::EarthFixed),
        upper => Frame::from_keyword(upper),
    }
}

/// The frame that SP3 names in five characters; without a name, positions are Earth-fixed too.
///
/// # Errors
/// If the library has no such frame.
pub fn frame_of_sp3_name(name: &str) -> Result<Frame, UnknownKeyword> {
    match name.trim() {
        "" | "UNDEF" => Ok(Frame::EarthFixed),
        name => frame_of_name(name),
    }
}

/// The time system that a name in a file means; case does not matter (CCSDS 502.0-B-3, 7.5.3).
///
/// # Errors
/// If the library cannot turn it into UTC.
pub fn time_system_of_name(name: &str) -> Result<TimeSystem, UnknownKeyword> {
    TimeSystem::from_keyword(&name.to_ascii_uppercase())
}

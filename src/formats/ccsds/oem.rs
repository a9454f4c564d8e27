//! CCSDS Orbit Ephemeris Messages in keyword = value notation and in XML, written and read.
//!
//! Source: CCSDS 502.0-B-3, *Orbit Data Messages* (April 2023), sections 5, 7 and 8; version 2.0
//! is that of 502.0-B-2, which differs by the optional header keywords. One object a file
//! (5.1.3), no comment between ephemeris lines (7.8.9), numbers of at most 16 digits (7.5.6). In
//! XML (505.0-B-2) a combined instantiation holds the messages of several objects.

mod open_segment;
mod read;
mod rules;
mod write;
mod xml;

pub use open_segment::SegmentChoice;
pub use read::{parse, parse_kept, read};
pub use write::{OemMessage, OemWriter, write_combined_xml};
pub(super) use xml::OemXmlMessage;
pub use xml::{parse_xml, read_xml};

use crate::ephemeris::arc::{Arc, Interpolation};
use crate::ephemeris::hermite::Hermite;
use crate::formats::ccsds::kvn::{CcsdsHeader, write_comments};
use crate::formats::metadata::{Metadata, Object};
use crate::formats::text::fixed::FixedDecimals;
use crate::formats::text::timestamp::{SecondDigits, TimeSystem, calendar};
use crate::formats::trajectory::{Trajectory, TrajectoryError, frame_of_name, time_system_of_name};
use crate::frames::{Frame, State};
use crate::keyword::keywords;
use crate::printable::printable;
use crate::time::TimeGrid;
use chrono::NaiveDateTime;
use nalgebra::Vector3;
use std::io::{self, Write};

/// The remark on a message in TEME, which is only written on request.
pub(crate) const TEME_NOTE: &str =
    "CCSDS 502.0-B-3 (4.2.4.9) reserves TEME for OMMs made from TLEs; some readers reject it here";

/// The warning for a message in BeiDou time.
pub(crate) const BDT_NOTE: &str = "BDT is not a time system of CCSDS 502.0-B-3 (SANA registry): agree on it with who reads the message";

keywords! {
    /// How a message is written down.
    OemSyntax {
        /// Keyword = value lines.
        Kvn = "kvn",
        /// XML.
        Xml = "xml",
    }
}

/// Keyword of the version.
const VERSION: &str = "CCSDS_OEM_VERS";

/// A whole message.
#[derive(Debug, Clone, PartialEq)]
pub struct Oem {
    /// The header.
    pub header: CcsdsHeader,
    /// The segments, in the order of the file.
    pub segments: Vec<Segment>,
}

/// The metadata of a segment (table 5-3).
#[derive(Debug, Clone, PartialEq)]
pub struct SegmentMetadata {
    /// Comments after `META_START`.
    pub comments: Vec<String>,
    /// Name of the satellite.
    pub object_name: String,
    /// Identifier of the satellite.
    pub object_id: String,
    /// Origin of the frame.
    pub center_name: String,
    /// Name of the frame.
    pub ref_frame: String,
    /// Epoch of the frame.
    pub ref_frame_epoch: Option<NaiveDateTime>,
    /// Name of the time system.
    pub time_system: String,
    /// First instant.
    pub start_time: NaiveDateTime,
    /// First instant for which a state may be interpolated.
    pub useable_start_time: Option<NaiveDateTime>,
    /// Last instant for which a state may be interpolated.
    pub useable_stop_time: Option<NaiveDateTime>,
    /// Last instant.
    pub stop_time: NaiveDateTime,
    /// Interpolation method and degree.
    pub interpolation: Option<(String, usize)>,
}

/// A segment: its metadata and its ephemeris lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// Its metadata.
    pub metadata: SegmentMetadata,
    /// Comments before the first ephemeris line.
    pub comments: Vec<String>,
    /// The ephemeris lines, or those of them that are kept; all have been checked. A covariance is checked on reading, and
    /// not kept.
    pub states: Vec<StateLine>,
}

/// An ephemeris line (5.2.4).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StateLine {
    /// Instant in the time system of the segment.
    pub epoch: NaiveDateTime,
    /// Position and velocity in the frame of the segment, km and km/s.
    pub state: State<Frame>,
    /// Acceleration, km/s².
    pub acceleration_km_s2: Option<Vector3<f64>>,
}

impl Oem {
    /// Writes the message in keyword = value notation.
    ///
    /// # Errors
    /// If writing fails.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        self.header.write(out, VERSION)?;
        for segment in &self.segments {
            let digits = segment.digits();
            write_metadata(out, &segment.metadata, digits)?;
            write_comments(out, &segment.comments)?;
            for line in &segment.states {
                write_state(out, line, digits)?;
            }
        }
        Ok(())
    }
}

impl Segment {
    /// The decimals of a second that its times need.
    fn digits(&self) -> SecondDigits {
        let metadata = &self.metadata;
        let edges = [
            Some(metadata.start_time),
            metadata.useable_start_time,
            metadata.useable_stop_time,
            Some(metadata.stop_time),
            metadata.ref_frame_epoch,
        ];
        let lines = self.states.iter().map(|line| line.epoch);
        lines
            .chain(edges.into_iter().flatten())
            .map(SecondDigits::of_stamp)
            .fold(SecondDigits::FEWEST, Ord::max)
    }

    /// The states in the library's terms: those of the usable span, since the others are there to interpolate and
    /// need not be where the satellite was (table 5-3).
    ///
    /// # Errors
    /// If the centre is not the Earth, or the frame or the time system is unknown.
    pub fn into_trajectory(self) -> Result<Trajectory, TrajectoryError> {
        let interpolation = self.interpolation();
        let metadata = &self.metadata;
        if !metadata.center_name.eq_ignore_ascii_case("EARTH") {
            return Err(TrajectoryError::Center {
                name: printable(&metadata.object_name).into_owned(),
                center: printable(&metadata.center_name).into_owned(),
            });
        }
        let time_system = time_system_of_name(&metadata.time_system)?;
        let instant = |line: StateLine| (time_system.epoch(line.epoch), line.state);
        let frame = frame_of_name(&metadata.ref_frame)?;
        // In the memory of the lines, of which the rest is given back.
        let mut nodes: Vec<_> = self.states.into_iter().map(instant).collect();
        nodes.shrink_to_fit();
        let arc = Arc::new(frame, interpolation, nodes);
        // The samples beyond the useable span are there to interpolate (5.2.4.4, table 5-3).
        let (first, last) = metadata.useable_span();
        let span = (time_system.epoch(first), time_system.epoch(last));
        let arcs = match arc {
            Some(arc) => Vec::from_iter(arc.within(span)),
            // A segment without lines is refused: these are not kept.
            None => vec![Arc::without_states(frame, interpolation, span)],
        };
        Ok(Trajectory {
            name: metadata.object_name.clone(),
            id: metadata.object_id.clone(),
            arcs,
        })
    }

    /// The interpolation that the segment names, or that of states.
    fn interpolation(&self) -> Interpolation {
        match &self.metadata.interpolation {
            Some((method, degree)) => match method.to_ascii_uppercase().as_str() {
                "HERMITE" => Interpolation::Hermite(*degree | 1),
                "LINEAR" => Interpolation::Lagrange(1),
                _ => Interpolation::Lagrange(*degree),
            },
            None => Interpolation::OF_STATES,
        }
    }
}

/// The metadata of a satellite's segment.
pub(crate) fn segment_metadata(
    metadata: &Metadata,
    object: &Object,
    grid: TimeGrid,
    hermite: Option<Hermite>,
) -> SegmentMetadata {
    let stamp = |elapsed_s| {
        let at = grid.epoch().plus_seconds(elapsed_s);
        metadata.time_system.stamp(at)
    };
    let mut comments = Vec::new();
    if metadata.frame == Frame::Teme {
        comments.push(TEME_NOTE.to_owned());
    }
    if metadata.time_system == TimeSystem::Bdt {
        comments.push(BDT_NOTE.to_owned());
    }
    // 7.8.12 c requires the accuracy.
    if let Some(hermite) = hermite {
        comments.push(format!(
            "Error of this interpolation halfway between lines: at most {:.1e} km",
            hermite.max_error_km
        ));
    }
    SegmentMetadata {
        comments,
        object_name: object.name.clone(),
        object_id: object.id.clone(),
        center_name: "EARTH".to_owned(),
        ref_frame: metadata.frame.to_string(),
        ref_frame_epoch: None,
        time_system: metadata.time_system.to_string(),
        start_time: stamp(0.0),
        useable_start_time: None,
        useable_stop_time: None,
        stop_time: stamp(grid.elapsed_s(grid.len() - 1)),
        interpolation: hermite.map(|hermite| ("HERMITE".to_owned(), hermite.degree)),
    }
}

fn write_metadata(
    out: &mut impl Write,
    metadata: &SegmentMetadata,
    digits: SecondDigits,
) -> io::Result<()> {
    writeln!(out, "\nMETA_START")?;
    write_comments(out, &metadata.comments)?;
    for (key, value) in metadata.pairs(digits) {
        writeln!(out, "{key} = {value}")?;
    }
    writeln!(out, "META_STOP\n")
}

impl SegmentMetadata {
    /// The first and last valid instants of the segment.
    #[must_use]
    pub fn useable_span(&self) -> (NaiveDateTime, NaiveDateTime) {
        (
            self.useable_start_time.unwrap_or(self.start_time),
            self.useable_stop_time.unwrap_or(self.stop_time),
        )
    }

    /// The keywords and their values in the order of table 5-3.
    pub(crate) fn pairs(&self, digits: SecondDigits) -> Vec<(&'static str, String)> {
        let time = |stamp| calendar(stamp, digits);
        let (method, degree) = match &self.interpolation {
            Some((method, degree)) => (Some(method.clone()), Some(degree.to_string())),
            None => (None, None),
        };
        [
            ("OBJECT_NAME", Some(self.object_name.clone())),
            ("OBJECT_ID", Some(self.object_id.clone())),
            ("CENTER_NAME", Some(self.center_name.clone())),
            ("REF_FRAME", Some(self.ref_frame.clone())),
            ("REF_FRAME_EPOCH", self.ref_frame_epoch.map(time)),
            ("TIME_SYSTEM", Some(self.time_system.clone())),
            ("START_TIME", Some(time(self.start_time))),
            ("USEABLE_START_TIME", self.useable_start_time.map(time)),
            ("USEABLE_STOP_TIME", self.useable_stop_time.map(time)),
            ("STOP_TIME", Some(time(self.stop_time))),
            ("INTERPOLATION", method),
            ("INTERPOLATION_DEGREE", degree),
        ]
        .into_iter()
        .filter_map(|(key, value)| Some((key, value?)))
        .collect()
    }
}

/// Positions to 1e-9 km and velocities to 1e-12 km/s: below what doubles lose in a day.
fn write_state(out: &mut impl Write, line: &StateLine, digits: SecondDigits) -> io::Result<()> {
    let (r, v) = (line.state.position_km.km(), line.state.velocity_km_s);
    out.write_all(calendar(line.epoch, digits).as_bytes())?;
    for x in [r.x, r.y, r.z] {
        write!(out, " {}", FixedDecimals::<9>(x))?;
    }
    let accelerations = line.acceleration_km_s2.map(|a| [a.x, a.y, a.z]);
    for x in [v.x, v.y, v.z]
        .into_iter()
        .chain(accelerations.into_iter().flatten())
    {
        write!(out, " {}", FixedDecimals::<12>(x))?;
    }
    writeln!(out)
}

#[cfg(test)]
mod tests;

//! Writes the messages of satellites on a grid, state by state, so that none is held in memory.

use super::{StateLine, VERSION, segment_metadata, write_metadata, write_state};
use crate::ephemeris::EphemerisSatellite;
use crate::ephemeris::hermite::Hermite;
use crate::ephemeris::sampled::Sampled;
use crate::formats::WriteError;
use crate::formats::ccsds::kvn::{CcsdsHeader, CcsdsVersion};
use crate::formats::ccsds::xml;
use crate::formats::metadata::{Metadata, Object};
use crate::formats::text::timestamp::SecondDigits;
use crate::frames::Frame;
use std::io::Write;

/// What the messages of an export share.
pub struct OemWriter<'a> {
    /// Version of the messages.
    pub version: CcsdsVersion,
    /// Their metadata.
    pub metadata: &'a Metadata,
    /// The satellites in the frame of the messages.
    pub sampled: &'a Sampled<'a, Frame>,
    /// What was measured for these states; without it no interpolation is named.
    pub hermite: Option<Hermite>,
}

impl OemWriter<'_> {
    fn digits(&self) -> SecondDigits {
        SecondDigits::of_grid(&self.sampled.grid())
    }

    fn lines(
        &self,
        satellite: &EphemerisSatellite,
        mut write: impl FnMut(&StateLine) -> std::io::Result<()>,
    ) -> Result<(), WriteError> {
        for sample in self.sampled.states(satellite) {
            let (at, state) = sample?;
            write(&StateLine {
                epoch: self.metadata.time_system.stamp(at),
                state,
                acceleration_km_s2: None,
            })?;
        }
        Ok(())
    }

    /// Writes the message of one satellite in keyword = value notation.
    ///
    /// # Errors
    /// If the satellite has no state, or the output fails.
    pub fn kvn(
        &self,
        out: &mut impl Write,
        satellite: &EphemerisSatellite,
        object: &Object,
    ) -> Result<(), WriteError> {
        let digits = self.digits();
        CcsdsHeader::new(self.version, self.metadata).write(out, VERSION)?;
        let segment = segment_metadata(self.metadata, object, self.sampled.grid(), self.hermite);
        write_metadata(out, &segment, digits)?;
        self.lines(satellite, |line| write_state(out, line, digits))
    }

    /// Writes the message of one satellite as an XML file.
    ///
    /// # Errors
    /// If the satellite has no state, or the output fails.
    pub fn xml(
        &self,
        out: &mut impl Write,
        satellite: &EphemerisSatellite,
        object: &Object,
    ) -> Result<(), WriteError> {
        xml::begin_file(out, "oem", VERSION, self.version)?;
        self.xml_content(out, satellite, object)
    }

    fn xml_content(
        &self,
        out: &mut impl Write,
        satellite: &EphemerisSatellite,
        object: &Object,
    ) -> Result<(), WriteError> {
        let digits = self.digits();
        xml::write_header(out, &CcsdsHeader::new(self.version, self.metadata))?;
        writeln!(out, "<body>")?;
        let segment = segment_metadata(self.metadata, object, self.sampled.grid(), self.hermite);
        super::xml::begin_segment(out, &segment, &[], digits)?;
        self.lines(satellite, |line| super::xml::write_state(out, line, digits))?;
        super::xml::end_segment(out)?;
        writeln!(out, "</body>\n</oem>")?;
        Ok(())
    }
}

/// One of several messages in a file.
pub struct OemMessage<'a> {
    /// The satellite.
    pub satellite: &'a EphemerisSatellite,
    /// Its identity.
    pub object: &'a Object,
    /// Its metadata.
    pub metadata: Metadata,
    /// What was measured for its states.
    pub hermite: Option<Hermite>,
}

/// Writes the messages of several satellites as one combined instantiation in XML.
///
/// # Errors
/// If a satellite has no state, or the output fails.
pub fn write_combined_xml<'a>(
    out: &mut impl Write,
    version: CcsdsVersion,
    sampled: &Sampled<'_, Frame>,
    messages: impl Iterator<Item = OemMessage<'a>>,
) -> Result<(), WriteError> {
    xml::begin_ndm(out, version)?;
    for message in messages {
        writeln!(out, "<oem id=\"{VERSION}\" version=\"{version}\">")?;
        let writer = OemWriter {
            version,
            metadata: &message.metadata,
            sampled,
            hermite: message.hermite,
        };
        writer.xml_content(out, message.satellite, message.object)?;
    }
    xml::end_ndm(out)?;
    Ok(())
}

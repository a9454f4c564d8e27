//! CCSDS Orbit Mean-Elements Messages for SGP4, written and read in four notations.
//!
//! Sources: CCSDS 502.0-B-3, section 4 (KVN), section 8 and 505.0-B-2 (XML); for JSON and CSV,
//! which no standard describes, `CelesTrak`'s *GP Data Formats*: an object or a row of the same
//! keywords. Unlike a TLE, an OMM keeps all digits, so the elements lose nothing.
//! `MEAN_MOTION_DOT` and `_DDOT` hold what a TLE holds (half and a sixth of the derivatives).

mod read;

pub(super) use read::OmmXmlMessage;
pub use read::{parse_csv, parse_json, parse_kvn, parse_xml};

use crate::formats::ccsds::kvn::{CcsdsHeader, CcsdsVersion};
use crate::formats::metadata::Metadata;
use crate::formats::text::finding::FindingList;
use crate::formats::text::timestamp::{SecondDigits, calendar};
use crate::formats::{ReadError, WriteError};
use crate::keyword::keywords;
use std::io::{self, BufRead, Write};

/// Keyword of the version.
const VERSION: &str = "CCSDS_OMM_VERS";

/// What the metadata of a message for SGP4 say, in their order.
const METADATA: [(&str, &str); 4] = [
    ("CENTER_NAME", "EARTH"),
    ("REF_FRAME", "TEME"),
    ("TIME_SYSTEM", "UTC"),
    ("MEAN_ELEMENT_THEORY", "SGP4"),
];

keywords! {
    /// How a message is written down.
    OmmSyntax {
        /// Keyword = value lines, one message a file.
        Kvn = "kvn",
        /// XML, any number of messages in one combined instantiation (`ndm`).
        Xml = "xml",
        /// An array of objects.
        Json = "json",
        /// A table.
        Csv = "csv",
    }
}

/// A message.
#[derive(Debug, Clone, PartialEq)]
pub struct Omm {
    /// Its header; JSON and CSV have none, and catalogues leave it incomplete.
    pub header: Option<CcsdsHeader>,
    /// Its element set.
    pub set: sgp4::Elements,
    /// Line on which it begins.
    pub line: usize,
}

/// Reads all messages of a file; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead, notation: OmmSyntax) -> Result<Vec<Omm>, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut messages = Vec::new();
    parse(input, notation, &mut findings, |message| {
        messages.push(message)
    })?;
    findings.unless_error(messages)
}

/// Passes every valid message to `take`, until the list of findings is full.
///
/// # Errors
/// A failure of the input.
pub fn parse(
    input: impl BufRead,
    notation: OmmSyntax,
    findings: &mut FindingList,
    take: impl FnMut(Omm),
) -> io::Result<()> {
    match notation {
        OmmSyntax::Kvn => parse_kvn(input, findings, take),
        OmmSyntax::Xml => parse_xml(input, findings, take),
        OmmSyntax::Json => parse_json(input, findings, take),
        OmmSyntax::Csv => parse_csv(input, findings, take),
    }
}

/// A value of a message.
enum OmmValue {
    Text(String),
    Number(String),
}

impl OmmValue {
    fn text(&self) -> &str {
        match self {
            Self::Text(text) | Self::Number(text) => text,
        }
    }
}

/// A number with `decimals` decimals, without the zeros at its end but one.
fn decimal(value: f64, decimals: usize) -> OmmValue {
    let text = format!("{value:.decimals$}");
    let short = text.trim_end_matches('0');
    OmmValue::Number(if short.ends_with('.') {
        format!("{short}0")
    } else {
        short.to_owned()
    })
}

/// A small number in floating-point notation, at most 16 digits.
fn scientific(value: f64) -> OmmValue {
    match value {
        0.0 => OmmValue::Number("0.0".to_owned()),
        _ => OmmValue::Number(format!("{value:.15e}")),
    }
}

/// Name and identifier of a set (table 4-2).
fn identity(set: &sgp4::Elements) -> [(&'static str, OmmValue); 2] {
    let or_unknown = |text: &Option<String>| {
        let unknown = || "UNKNOWN".to_owned();
        OmmValue::Text(text.clone().unwrap_or_else(unknown))
    };
    [
        ("OBJECT_NAME", or_unknown(&set.object_name)),
        ("OBJECT_ID", or_unknown(&set.international_designator)),
    ]
}

/// The mean elements (table 4-3): 12 decimals of a degree, 4e-16 of an orbit.
fn elements(set: &sgp4::Elements) -> [(&'static str, OmmValue); 7] {
    let epoch = calendar(set.datetime, SecondDigits::of_stamp(set.datetime));
    [
        ("EPOCH", OmmValue::Text(epoch)),
        ("MEAN_MOTION", decimal(set.mean_motion, 13)),
        ("ECCENTRICITY", decimal(set.eccentricity, 15)),
        ("INCLINATION", decimal(set.inclination, 12)),
        ("RA_OF_ASC_NODE", decimal(set.right_ascension, 12)),
        ("ARG_OF_PERICENTER", decimal(set.argument_of_perigee, 12)),
        ("MEAN_ANOMALY", decimal(set.mean_anomaly, 12)),
    ]
}

/// The TLE related parameters (table 4-3).
fn tle_parameters(set: &sgp4::Elements) -> [(&'static str, OmmValue); 8] {
    let class = match set.classification {
        sgp4::Classification::Unclassified => "U",
        sgp4::Classification::Classified => "C",
        sgp4::Classification::Secret => "S",
    };
    let count = |value: u64| OmmValue::Number(value.to_string());
    [
        ("EPHEMERIS_TYPE", count(u64::from(set.ephemeris_type))),
        ("CLASSIFICATION_TYPE", OmmValue::Text(class.to_owned())),
        ("NORAD_CAT_ID", count(set.norad_id)),
        ("ELEMENT_SET_NO", count(set.element_set_number)),
        ("REV_AT_EPOCH", count(set.revolution_number)),
        ("BSTAR", scientific(set.drag_term)),
        ("MEAN_MOTION_DOT", scientific(set.mean_motion_dot)),
        ("MEAN_MOTION_DDOT", scientific(set.mean_motion_ddot)),
    ]
}

/// Writes one message in keyword = value notation.
///
/// # Errors
/// If writing fails.
pub fn write_kvn(
    out: &mut impl Write,
    header: &CcsdsHeader,
    set: &sgp4::Elements,
) -> Result<(), WriteError> {
    header.write(out, VERSION)?;
    for (key, value) in identity(set) {
        writeln!(out, "{key} = {}", value.text())?;
    }
    for (key, value) in METADATA {
        writeln!(out, "{key} = {value}")?;
    }
    for (key, value) in elements(set).into_iter().chain(tle_parameters(set)) {
        writeln!(out, "{key} = {}", value.text())?;
    }
    Ok(())
}

/// The header that the messages of an export share.
#[must_use]
pub fn header(version: CcsdsVersion, metadata: &Metadata) -> CcsdsHeader {
    CcsdsHeader::new(version, metadata)
}

/// Writes messages as one combined instantiation in XML.
///
/// # Errors
/// If writing fails.
pub fn write_xml(
    out: &mut impl Write,
    header: &CcsdsHeader,
    sets: &[sgp4::Elements],
) -> Result<(), WriteError> {
    crate::formats::ccsds::xml::begin_ndm(out, header.version)?;
    for set in sets {
        writeln!(out, "<omm id=\"{VERSION}\" version=\"{}\">", header.version)?;
        crate::formats::ccsds::xml::write_header(out, header)?;
        writeln!(out, "<body><segment><metadata>")?;
        let fixed = METADATA.map(|(key, value)| (key, OmmValue::Text(value.to_owned())));
        write_leaves(out, identity(set).into_iter().chain(fixed))?;
        writeln!(out, "</metadata><data><meanElements>")?;
        write_leaves(out, elements(set))?;
        writeln!(out, "</meanElements><tleParameters>")?;
        write_leaves(out, tle_parameters(set))?;
        writeln!(out, "</tleParameters></data></segment></body></omm>")?;
    }
    crate::formats::ccsds::xml::end_ndm(out)?;
    Ok(())
}

fn write_leaves(
    out: &mut impl Write,
    pairs: impl IntoIterator<Item = (&'static str, OmmValue)>,
) -> io::Result<()> {
    pairs.into_iter().try_for_each(|(key, value)| {
        crate::formats::ccsds::xml::write_leaves(out, [(key, value.text())])
    })
}

/// Writes messages as an array of JSON objects.
///
/// # Errors
/// If writing fails.
pub fn write_json(out: &mut impl Write, sets: &[sgp4::Elements]) -> Result<(), WriteError> {
    write!(out, "[")?;
    for (index, set) in sets.iter().enumerate() {
        write!(out, "{}\n{{", if index == 0 { "" } else { "," })?;
        for (member, (key, value)) in values(set).enumerate() {
            let comma = if member == 0 { "" } else { "," };
            write!(out, "{comma}\"{key}\":")?;
            match value {
                OmmValue::Text(text) => {
                    serde_json::to_writer(&mut *out, &text).map_err(io::Error::from)?
                }
                OmmValue::Number(number) => write!(out, "{number}")?,
            }
        }
        write!(out, "}}")?;
    }
    writeln!(out, "\n]")?;
    Ok(())
}

/// Writes messages as a table.
///
/// # Errors
/// If writing fails.
pub fn write_csv(out: &mut impl Write, sets: &[sgp4::Elements]) -> Result<(), WriteError> {
    let mut table = ::csv::Writer::from_writer(out);
    let mut header_written = false;
    for set in sets {
        let (keys, values): (Vec<_>, Vec<_>) = values(set).unzip();
        if !std::mem::replace(&mut header_written, true) {
            table
                .write_record(&keys)
                .map_err(crate::formats::csv::io_error)?;
        }
        let texts = values.iter().map(OmmValue::text);
        table
            .write_record(texts)
            .map_err(crate::formats::csv::io_error)?;
    }
    table.flush()?;
    Ok(())
}

/// What JSON and CSV hold.
fn values(set: &sgp4::Elements) -> impl Iterator<Item = (&'static str, OmmValue)> {
    identity(set)
        .into_iter()
        .chain(elements(set))
        .chain(tle_parameters(set))
}

#[cfg(test)]
mod tests;

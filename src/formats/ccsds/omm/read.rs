//! Reads messages in every notation into element sets.

use super::{METADATA, Omm, VERSION};
use crate::formats::ccsds::keywords::{
    COVARIANCE, KvnKeyword, SPACECRAFT, may, must, named, should,
};
use crate::formats::ccsds::kvn::{CcsdsHeader, Item, KvnBlock, item, lines};
use crate::formats::ccsds::ndm::{self, NdmMessage};
use crate::formats::ccsds::xml::XmlNode;
use crate::formats::csv::CsvTable;
use crate::formats::text::finding::FindingList;
use crate::formats::text::json::Objects;
use crate::formats::text::lines::keep_comment;
use std::io::{self, BufRead};

/// Tables 4-1 to 4-3 in their order, the covariance at the end. Catalogues leave the date and
/// the originator out.
const ELEMENTS: &[KvnKeyword] = &[
    must(VERSION),
    may("CLASSIFICATION"),
    should("CREATION_DATE"),
    should("ORIGINATOR"),
    may("MESSAGE_ID"),
    named("OBJECT_NAME"),
    named("OBJECT_ID"),
    must("CENTER_NAME"),
    must("REF_FRAME"),
    may("REF_FRAME_EPOCH"),
    must("TIME_SYSTEM"),
    must("MEAN_ELEMENT_THEORY"),
    must("EPOCH"),
    may("SEMI_MAJOR_AXIS").unit("km"),
    may("MEAN_MOTION").unit("rev/day"),
    must("ECCENTRICITY").number(),
    must("INCLINATION").unit("deg"),
    must("RA_OF_ASC_NODE").unit("deg"),
    must("ARG_OF_PERICENTER").unit("deg"),
    must("MEAN_ANOMALY").unit("deg"),
    may("GM").unit("km**3/s**2"),
];

/// The TLE related parameters of table 4-3, whose need depends on the theory.
const TLE_PARAMETERS: &[KvnKeyword] = &[
    may("EPHEMERIS_TYPE"),
    may("CLASSIFICATION_TYPE"),
    may("NORAD_CAT_ID"),
    may("ELEMENT_SET_NO"),
    may("REV_AT_EPOCH"),
    may("BSTAR").unit("1/ER"),
    may("BTERM").unit("m**2/kg"),
    may("MEAN_MOTION_DOT").unit("rev/day**2"),
    may("MEAN_MOTION_DDOT").unit("rev/day**3"),
    may("AGOM").unit("m**2/kg"),
];

/// A message.
const MESSAGE: &[&[KvnKeyword]] = &[ELEMENTS, SPACECRAFT, TLE_PARAMETERS, COVARIANCE];

/// The members that a JSON object or a CSV row must or may have; others are ignored.
const RECORD: &[KvnKeyword] = &[
    may("CENTER_NAME"),
    may("REF_FRAME"),
    may("TIME_SYSTEM"),
    may("MEAN_ELEMENT_THEORY"),
    should("OBJECT_NAME"),
    should("OBJECT_ID"),
    must("EPOCH"),
    must("MEAN_MOTION").unit("rev/day"),
    must("ECCENTRICITY").number(),
    must("INCLINATION").unit("deg"),
    must("RA_OF_ASC_NODE").unit("deg"),
    must("ARG_OF_PERICENTER").unit("deg"),
    must("MEAN_ANOMALY").unit("deg"),
    may("EPHEMERIS_TYPE"),
    may("CLASSIFICATION_TYPE"),
    must("NORAD_CAT_ID"),
    may("ELEMENT_SET_NO"),
    may("REV_AT_EPOCH"),
    may("BSTAR").unit("1/ER"),
    may("BTERM").unit("m**2/kg"),
    may("MEAN_MOTION_DOT").unit("rev/day**2"),
    may("MEAN_MOTION_DDOT").unit("rev/day**3"),
    may("AGOM").unit("m**2/kg"),
];

/// Keywords that users define (4.2.4.10); they are ignored.
const USER_DEFINED: &str = "USER_DEFINED";

/// Reads keyword = value notation. The standard has one message a file; files of several, as
/// catalogues give them out, are read with a warning.
///
/// # Errors
/// A failure of the input.
pub fn parse_kvn(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(Omm),
) -> io::Result<()> {
    let mut lines = lines(input);
    let mut block = KvnBlock::new(MESSAGE);
    let (mut begin, mut started) = (1, false);
    while let Some(line) = lines.next(findings)? {
        match item(&line, findings) {
            Item::Blank => {}
            Item::Comment(text) => keep_comment(&mut block.comments, text),
            Item::Pair(pair) if pair.key.starts_with(USER_DEFINED) => {}
            Item::Pair(pair) => {
                if pair.key == VERSION && started {
                    let message = "a second message begins; the standard allows one per file";
                    findings.warning(pair.key_place, "omm-several", message);
                    message_of(&block, begin, line.number, findings)
                        .into_iter()
                        .for_each(&mut take);
                    block = KvnBlock::new(MESSAGE);
                }
                if pair.key == VERSION {
                    begin = line.number;
                }
                started = true;
                block.accept(&pair, findings);
            }
            Item::Other(_) => {
                findings.error((line.number, 1), "omm-line", "not a keyword = value pair");
            }
        }
    }
    message_of(&block, begin, lines.number().max(1), findings)
        .into_iter()
        .for_each(take);
    Ok(())
}

/// Reads XML: a message, or a combined instantiation of any number, whose messages of other kinds are left out by
/// name.
///
/// # Errors
/// A failure of the input.
pub fn parse_xml(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(Omm),
) -> io::Result<()> {
    ndm::parse(input, &["omm"], findings, |message| {
        if let NdmMessage::Omm(message) = message {
            take(message);
        }
    })
}

/// A message in XML while it is read.
pub(in crate::formats::ccsds) struct OmmXmlMessage {
    begin: usize,
    block: KvnBlock,
}

impl OmmXmlMessage {
    pub(in crate::formats::ccsds) fn new(
        version: Option<&str>,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Self {
        let mut block = KvnBlock::new(MESSAGE);
        if let Some(version) = version {
            block.accept_at((VERSION, version), None, place, findings);
        }
        Self {
            begin: place.0,
            block,
        }
    }

    pub(in crate::formats::ccsds) fn node(
        &mut self,
        node: &XmlNode,
        place: (usize, usize),
        findings: &mut FindingList,
    ) {
        let XmlNode::Leaf(leaf) = node else { return };
        match leaf.name.as_str() {
            "COMMENT" => keep_comment(&mut self.block.comments, &leaf.text),
            name if name.starts_with(USER_DEFINED) => {}
            name => {
                let pair = (name, leaf.text.trim());
                let unit = leaf.unit.as_deref();
                self.block.accept_at(pair, unit, place, findings);
            }
        }
    }

    pub(in crate::formats::ccsds) fn end(
        &self,
        place: (usize, usize),
        findings: &mut FindingList,
    ) -> Option<Omm> {
        message_of(&self.block, self.begin, place.0, findings)
    }
}

/// Reads an array of JSON objects, or one object.
///
/// # Errors
/// A failure of the input.
pub fn parse_json(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(Omm),
) -> io::Result<()> {
    let mut objects = Objects::new(input);
    while let Some(object) = objects.next(findings)? {
        let Some(members) = object.members(findings) else {
            continue;
        };
        let mut block = KvnBlock::of_record(&[RECORD]);
        for (key, value) in &members {
            if is_given(&block, key, value) {
                block.accept_at((key, value), None, object.place_of(key), findings);
            }
        }
        let place = object.place_of("");
        record_of(&block, place, findings)
            .into_iter()
            .for_each(&mut take);
        if findings.is_full() {
            break;
        }
    }
    Ok(())
}

/// Reads a table whose first row names the keywords.
///
/// # Errors
/// A failure of the input.
pub fn parse_csv(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(Omm),
) -> io::Result<()> {
    let mut table = CsvTable::new(input);
    let Some(keys) = table.header(findings)? else {
        return Ok(());
    };
    if keys
        .iter()
        .all(|key| !KvnBlock::of_record(&[RECORD]).knows(key))
    {
        findings.error(
            (1, 1),
            "csv-header",
            "none of the columns is an OMM keyword",
        );
        return Ok(());
    }
    let mut row = ::csv::StringRecord::new();
    while let Some(line) = table.next(&mut row, findings)? {
        let mut block = KvnBlock::of_record(&[RECORD]);
        for (column, (key, value)) in keys.iter().zip(&row).enumerate() {
            if is_given(&block, key, value) {
                block.accept_at((key, value), None, (line, column + 1), findings);
            }
        }
        record_of(&block, (line, 1), findings)
            .into_iter()
            .for_each(&mut take);
        if findings.is_full() {
            break;
        }
    }
    Ok(())
}

/// Whether a value of a record is given: an empty one counts as missing, except that an empty identifier is reported.
fn is_given(block: &KvnBlock, key: &str, value: &str) -> bool {
    block.knows(key) && (!value.is_empty() || matches!(key, "OBJECT_NAME" | "OBJECT_ID"))
}

fn message_of(
    block: &KvnBlock,
    begin: usize,
    end: usize,
    findings: &mut FindingList,
) -> Option<Omm> {
    block.finish((end, 1), findings);
    let header = CcsdsHeader::read(block, VERSION, findings);
    let set = set(block, (begin, 1), findings);
    Some(Omm {
        header,
        set: set?,
        line: begin,
    })
}

fn record_of(block: &KvnBlock, place: (usize, usize), findings: &mut FindingList) -> Option<Omm> {
    block.finish(place, findings);
    Some(Omm {
        header: None,
        set: set(block, place, findings)?,
        line: place.0,
    })
}

/// The element set, if it is one for SGP4 and in range.
fn set(
    block: &KvnBlock,
    place: (usize, usize),
    findings: &mut FindingList,
) -> Option<sgp4::Elements> {
    let mut fits = fits_sgp4(block, place, findings);
    let mut bounded = |key: &str, low: f64, high: f64| {
        let value = block.number(key)?;
        if (low..=high).contains(&value) {
            return Some(value);
        }
        let message = format!("{key} {value} is outside {low} to {high}");
        findings.error(block.place(key), "omm-range", message);
        None
    };
    let angles = [
        bounded("INCLINATION", 0.0, 180.0),
        bounded("RA_OF_ASC_NODE", -360.0, 360.0),
        bounded("ARG_OF_PERICENTER", -360.0, 360.0),
        bounded("MEAN_ANOMALY", -360.0, 360.0),
    ];
    let eccentricity = bounded("ECCENTRICITY", 0.0, 0.999_999_999);
    let mean_motion = bounded("MEAN_MOTION", 1e-6, 20.0);
    let classification = match block.text("CLASSIFICATION_TYPE").as_deref() {
        None | Some("U") => sgp4::Classification::Unclassified,
        Some("C") => sgp4::Classification::Classified,
        Some("S") => sgp4::Classification::Secret,
        Some(other) => {
            let message = format!("CLASSIFICATION_TYPE '{other}' is not U, C or S");
            findings.error(block.place("CLASSIFICATION_TYPE"), "omm-value", message);
            fits = false;
            sgp4::Classification::Unclassified
        }
    };
    let [
        inclination,
        right_ascension,
        argument_of_perigee,
        mean_anomaly,
    ] = angles;
    let known = |text: &String| text != "UNKNOWN";
    let number = |key| block.number(key).unwrap_or(0.0);
    let (mean_motion_dot, mean_motion_ddot, drag_term) = (
        number("MEAN_MOTION_DOT"),
        number("MEAN_MOTION_DDOT"),
        number("BSTAR"),
    );
    let mut count = |key| block.count(key, findings).unwrap_or(0);
    let ephemeris_type = count("EPHEMERIS_TYPE");
    let set = sgp4::Elements {
        object_name: block.text("OBJECT_NAME").filter(known),
        international_designator: block.text("OBJECT_ID").filter(known),
        norad_id: count("NORAD_CAT_ID"),
        classification,
        element_set_number: count("ELEMENT_SET_NO"),
        revolution_number: count("REV_AT_EPOCH"),
        datetime: block.stamp("EPOCH", findings)?,
        mean_motion_dot,
        mean_motion_ddot,
        drag_term,
        inclination: inclination?,
        right_ascension: right_ascension?,
        eccentricity: eccentricity?,
        argument_of_perigee: argument_of_perigee?,
        mean_anomaly: mean_anomaly?,
        mean_motion: mean_motion?,
        ephemeris_type: u8::try_from(ephemeris_type).unwrap_or(u8::MAX),
    };
    fits.then_some(set)
}

/// Whether the message is one for SGP4 (4.2.4.6).
fn fits_sgp4(block: &KvnBlock, place: (usize, usize), findings: &mut FindingList) -> bool {
    let mut fits = true;
    for (key, expected) in METADATA {
        let Some(found) = block.text(key) else {
            continue;
        };
        let same = match key {
            "MEAN_ELEMENT_THEORY" => matches!(found.as_str(), "SGP4" | "SGP/SGP4" | "SGP"),
            _ => found.eq_ignore_ascii_case(expected),
        };
        if !same {
            let message = format!("{key} {found} is not {expected}, which SGP4 needs (4.2.4.6)");
            findings.error(block.place(key), "omm-theory", message);
            fits = false;
        }
    }
    for (key, why) in [("MEAN_MOTION", "4.2.4.6"), ("NORAD_CAT_ID", "table 4-3")] {
        if block.text(key).is_none() && block.is_message() {
            let message = format!("{key} is missing, which SGP4 needs ({why})");
            findings.error(place, "ccsds-missing", message);
            fits = false;
        }
    }
    fits & is_not_sgp4_xp(block, place, findings)
}

/// Types of element sets for SGP4: 0, the default of catalogues, and 2.
const SGP4_TYPES: [&str; 2] = ["0", "2"];

/// Whether nothing belongs to SGP4-XP, whose B* and derivatives mean other things (table 4-3).
fn is_not_sgp4_xp(block: &KvnBlock, place: (usize, usize), findings: &mut FindingList) -> bool {
    let mut fits = true;
    let mut refuse = |key: &str, message: String| {
        findings.error(block.place(key), "omm-theory", message);
        fits = false;
    };
    if let Some(found) = block.text("EPHEMERIS_TYPE")
        && !SGP4_TYPES.contains(&found.as_str())
    {
        let name = if found == "4" { ", SGP4-XP," } else { "" };
        let message = format!("EPHEMERIS_TYPE {found}{name} is not 0 or 2, which are SGP4");
        refuse("EPHEMERIS_TYPE", message);
    }
    for key in ["BTERM", "AGOM"] {
        if block.text(key).is_some() {
            let beside = match block.text("BSTAR") {
                Some(_) if key == "BTERM" => "; it replaces BSTAR and cannot be given with it",
                _ => "",
            };
            refuse(
                key,
                format!("{key} belongs to SGP4-XP, which is not propagated here{beside}"),
            );
        }
    }
    if fits && block.is_message() && block.text("BSTAR").is_none() {
        let message = "BSTAR is missing, which SGP4 needs (table 4-3); it is taken as 0";
        findings.warning(place, "ccsds-missing", message);
    }
    fits
}

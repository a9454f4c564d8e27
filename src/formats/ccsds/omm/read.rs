//! Reads messages in every notation into element sets.

use super::{METADATA, Omm, VERSION};
use crate::formats::ccsds::kvn::{
    COVARIANCE, CcsdsHeader, Item, KvnBlock, KvnKeyword, item, may, must, should,
};
use crate::formats::ccsds::xml::{Nodes, XmlNode};
use crate::formats::csv::CsvTable;
use crate::formats::text::finding::FindingList;
use crate::formats::text::json::Objects;
use crate::formats::text::lines::Lines;
use std::io::{self, BufRead};

/// Tables 4-1 to 4-3 in their order, the covariance at the end. Catalogues leave the date and
/// the originator out.
const MESSAGE: &[KvnKeyword] = &[
    must(VERSION),
    may("CLASSIFICATION"),
    should("CREATION_DATE"),
    should("ORIGINATOR"),
    may("MESSAGE_ID"),
    must("OBJECT_NAME"),
    must("OBJECT_ID"),
    must("CENTER_NAME"),
    must("REF_FRAME"),
    may("REF_FRAME_EPOCH"),
    must("TIME_SYSTEM"),
    must("MEAN_ELEMENT_THEORY"),
    must("EPOCH"),
    may("SEMI_MAJOR_AXIS"),
    may("MEAN_MOTION"),
    must("ECCENTRICITY"),
    must("INCLINATION"),
    must("RA_OF_ASC_NODE"),
    must("ARG_OF_PERICENTER"),
    must("MEAN_ANOMALY"),
    may("GM"),
    may("MASS"),
    may("SOLAR_RAD_AREA"),
    may("SOLAR_RAD_COEFF"),
    may("DRAG_AREA"),
    may("DRAG_COEFF"),
    may("EPHEMERIS_TYPE"),
    may("CLASSIFICATION_TYPE"),
    may("NORAD_CAT_ID"),
    may("ELEMENT_SET_NO"),
    may("REV_AT_EPOCH"),
    may("BSTAR"),
    may("BTERM"),
    may("MEAN_MOTION_DOT"),
    may("MEAN_MOTION_DDOT"),
    may("AGOM"),
];

/// What an object of JSON or a row of CSV must and may hold; other members are passed over.
const RECORD: &[KvnKeyword] = &[
    may("CENTER_NAME"),
    may("REF_FRAME"),
    may("TIME_SYSTEM"),
    may("MEAN_ELEMENT_THEORY"),
    may("OBJECT_NAME"),
    may("OBJECT_ID"),
    must("EPOCH"),
    must("MEAN_MOTION"),
    must("ECCENTRICITY"),
    must("INCLINATION"),
    must("RA_OF_ASC_NODE"),
    must("ARG_OF_PERICENTER"),
    must("MEAN_ANOMALY"),
    may("EPHEMERIS_TYPE"),
    may("CLASSIFICATION_TYPE"),
    must("NORAD_CAT_ID"),
    may("ELEMENT_SET_NO"),
    may("REV_AT_EPOCH"),
    may("BSTAR"),
    may("MEAN_MOTION_DOT"),
    may("MEAN_MOTION_DDOT"),
];

/// Keywords that users define (4.2.4.10); they are passed over.
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
    let mut lines = Lines::new(input);
    let mut block = KvnBlock::new(&[MESSAGE, COVARIANCE]);
    let (mut begin, mut started) = (1, false);
    while let Some(line) = lines.next(findings)? {
        match item(&line, findings) {
            Item::Blank => {}
            Item::Comment(text) => block.comments.push(text.to_owned()),
            Item::Pair(pair) if pair.key.starts_with(USER_DEFINED) => {}
            Item::Pair(pair) => {
                if pair.key == VERSION && started {
                    let message = "a second message begins; the standard allows one per file";
                    findings.warning(pair.key_place, "omm-several", message);
                    message_of(&block, begin, line.number, findings)
                        .into_iter()
                        .for_each(&mut take);
                    block = KvnBlock::new(&[MESSAGE, COVARIANCE]);
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

/// Reads XML: a message, or a combined instantiation of any number; messages of other kinds in
/// it are passed over.
///
/// # Errors
/// A failure of the input.
pub fn parse_xml(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(Omm),
) -> io::Result<()> {
    let mut nodes = Nodes::new(input);
    let mut message: Option<(usize, KvnBlock)> = None;
    let mut any = false;
    while let Some((place, node)) = nodes.next(findings)? {
        match (node, &mut message) {
            (XmlNode::Open(name, version), _) if name == "omm" => {
                let mut block = KvnBlock::new(&[MESSAGE, COVARIANCE]);
                if let Some(version) = version {
                    block.accept_at((VERSION, &version), place, findings);
                }
                any = true;
                message = Some((place.0, block));
            }
            (XmlNode::Close(name), Some((begin, block))) if name == "omm" => {
                message_of(block, *begin, nodes.place().0, findings)
                    .into_iter()
                    .for_each(&mut take);
                message = None;
            }
            (XmlNode::Leaf(name, text), Some((_, block))) => match name.as_str() {
                "COMMENT" => block.comments.push(text),
                _ if name.starts_with(USER_DEFINED) => {}
                _ => block.accept_at((&name, text.trim()), place, findings),
            },
            _ => {}
        }
        if findings.is_full() {
            return Ok(());
        }
    }
    if !any {
        findings.error(nodes.place(), "omm-empty", "the file has no message");
    }
    Ok(())
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
        let mut block = KvnBlock::unordered(&[RECORD]);
        for (key, value) in &members {
            if block.knows(key) && !value.is_empty() {
                block.accept_at((key, value), object.place_of(key), findings);
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
        .all(|key| !KvnBlock::unordered(&[RECORD]).knows(key))
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
        let mut block = KvnBlock::unordered(&[RECORD]);
        for (column, (key, value)) in keys.iter().zip(&row).enumerate() {
            if block.knows(key) && !value.is_empty() {
                block.accept_at((key, value), (line, column + 1), findings);
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
        let value = block.number(key, findings)?;
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
    let mut number = |key| block.number(key, findings).unwrap_or(0.0);
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
    if block.text("MEAN_MOTION").is_none() {
        let message = "MEAN_MOTION is missing, which SGP4 needs (4.2.4.6)";
        findings.error(place, "ccsds-missing", message);
        fits = false;
    }
    fits
}

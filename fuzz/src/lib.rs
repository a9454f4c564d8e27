//! What must hold for any bytes: a reader does not panic, and what it accepts is written and read
//! back as the same.
//!
//! A file may hold more digits than its writer gives, so that the first writing may round; from
//! then on nothing moves: with v = read(bytes), v₁ = read(write(v)), v₁ is v to the written digits
//! and read(write(v₁)) is v₁ exactly.

mod rasters;
mod sampled;
mod tables;

use navwalker::exchange::import::{Fleet, ReadFleetError};
use navwalker::exchange::lint::{self, Format};
use navwalker::formats::ReadError;
use navwalker::formats::ccsds::omm::{self, OmmSyntax};
use navwalker::formats::ccsds::{CcsdsHeader, CcsdsVersion};
use navwalker::formats::ccsds::{oem, opm};
use navwalker::formats::csv::{self, ElementsRow};
use navwalker::formats::maps::czml;
use navwalker::formats::metadata::{CatalogNumber, Object};
use navwalker::formats::text::finding::Severity;
use navwalker::formats::{stk, tle};
use navwalker::frames::{Frame, State};
use navwalker::keyword::Keyword;
use std::fmt::Debug;

pub use rasters::terrain;
pub use sampled::{sem, sp3, yuma};
pub use tables::{skies, tables};

/// Writes and reads again, twice: nothing moves after the first time, which it returns.
fn settled<T: Debug + PartialEq>(
    read: impl Fn(&[u8]) -> Result<T, ReadError>,
    write: impl Fn(&T) -> Vec<u8>,
    first: &T,
) -> T {
    let again = |value: &T| {
        let bytes = write(value);
        let text = String::from_utf8_lossy(&bytes).into_owned();
        read(&bytes).unwrap_or_else(|error| panic!("{error}: our own file is refused:\n{text}"))
    };
    let second = again(first);
    let third = again(&second);
    assert_eq!(second, third, "what is written moves");
    second
}

/// Whether two numbers are the same to `digits` decimals, or to the last bits of a large one.
fn near(one: f64, other: f64, digits: i32) -> bool {
    let rounding = 0.51 * 10_f64.powi(-digits);
    (one - other).abs() <= rounding + 4.0 * f64::EPSILON * one.abs()
}

/// Asserts that two states are the same to the decimals that files are written with.
fn same_state(one: &State<Frame>, other: &State<Frame>) {
    let (position_km, expected_km) = (one.position_km.km(), other.position_km.km());
    for axis in 0..3 {
        assert!(near(position_km[axis], expected_km[axis], 9));
        assert!(near(one.velocity_km_s[axis], other.velocity_km_s[axis], 12));
    }
}

/// Two-line element sets.
pub fn tle(bytes: &[u8]) {
    let Ok(sets) = tle::read(bytes) else { return };
    // Longer and foreign names are read with a warning, and have no place in a line of 24 characters.
    let fits = |name: &String| name.len() <= 24 && name.is_ascii();
    if !sets
        .iter()
        .filter_map(|set| set.object_name.as_ref())
        .all(fits)
    {
        return;
    }
    let write = |sets: &Vec<sgp4::Elements>| {
        let mut out = Vec::new();
        let written = sets.iter().try_for_each(|set| tle::write(&mut out, set));
        written.expect("what is read can be written");
        out
    };
    let again = settled(|bytes: &[u8]| tle::read(bytes), write, &sets);
    assert_eq!(again.len(), sets.len());
    for (one, other) in again.iter().zip(&sets) {
        assert!(same_set(one, other), "{one:?}\nis not\n{other:?}");
    }
}

fn same_set(one: &sgp4::Elements, other: &sgp4::Elements) -> bool {
    let numbers = [
        (one.mean_motion, other.mean_motion, 13),
        (one.eccentricity, other.eccentricity, 15),
        (one.inclination, other.inclination, 12),
        (one.right_ascension, other.right_ascension, 12),
        (one.argument_of_perigee, other.argument_of_perigee, 12),
        (one.mean_anomaly, other.mean_anomaly, 12),
    ];
    let small = [
        (one.drag_term, other.drag_term),
        (one.mean_motion_dot, other.mean_motion_dot),
        (one.mean_motion_ddot, other.mean_motion_ddot),
    ];
    one.datetime == other.datetime
        && one.norad_id == other.norad_id
        && one.object_name == other.object_name
        && one.international_designator == other.international_designator
        && one.classification == other.classification
        && one.element_set_number == other.element_set_number
        && one.revolution_number == other.revolution_number
        && one.ephemeris_type == other.ephemeris_type
        && numbers.iter().all(|(a, b, digits)| near(*a, *b, *digits))
        && small.iter().all(|(a, b)| (a - b).abs() <= 1e-14 * a.abs())
}

type Message = (Option<CcsdsHeader>, sgp4::Elements);

fn write_omm(notation: OmmSyntax, messages: &[Message]) -> Vec<u8> {
    let mut out = Vec::new();
    let header = messages.iter().find_map(|(header, _)| header.clone());
    let header = header.unwrap_or_else(|| CcsdsHeader {
        version: CcsdsVersion::V2,
        comments: Vec::new(),
        classification: None,
        creation_date: messages[0].1.datetime,
        originator: "FUZZ".to_owned(),
        message_id: None,
    });
    let sets: Vec<_> = messages.iter().map(|(_, set)| set.clone()).collect();
    match notation {
        OmmSyntax::Kvn => sets
            .iter()
            .try_for_each(|set| omm::write_kvn(&mut out, &header, set)),
        OmmSyntax::Xml => omm::write_xml(&mut out, &header, &sets),
        OmmSyntax::Json => omm::write_json(&mut out, &sets),
        OmmSyntax::Csv => omm::write_csv(&mut out, &sets),
    }
    .expect("what is read can be written");
    out
}

fn read_omm(bytes: &[u8], notation: OmmSyntax) -> Result<Vec<Message>, ReadError> {
    let messages = omm::read(bytes, notation)?;
    Ok(messages
        .into_iter()
        .map(|message| (message.header, message.set))
        .collect())
}

/// The format that the bytes show.
fn format_of(bytes: &[u8]) -> Option<Format> {
    navwalker::exchange::recognise::recognise(bytes, None)
        .ok()?
        .content
        .ok()
}

/// Mean-elements messages in the notation that the bytes show.
pub fn omm(bytes: &[u8]) {
    let notation = match format_of(bytes) {
        Some(Format::OmmXml) => OmmSyntax::Xml,
        Some(Format::OmmJson) => OmmSyntax::Json,
        Some(Format::OmmCsv) => OmmSyntax::Csv,
        _ => OmmSyntax::Kvn,
    };
    let Ok(messages) = read_omm(bytes, notation) else {
        return;
    };
    if messages.is_empty() {
        return;
    }
    let read = |bytes: &[u8]| read_omm(bytes, notation);
    let again = settled(read, |messages| write_omm(notation, messages), &messages);
    assert_eq!(again.len(), messages.len());
    for ((_, one), (_, other)) in again.iter().zip(&messages) {
        assert!(same_set(one, other), "{one:?}\nis not\n{other:?}");
    }
}

/// Ephemeris messages, keyword = value or XML.
pub fn oem(bytes: &[u8]) {
    if format_of(bytes) == Some(Format::OemXml) {
        let Ok(messages) = oem::read_xml(bytes) else {
            return;
        };
        for message in messages {
            let read = |bytes: &[u8]| oem::read_xml(bytes).map(|mut read| read.remove(0));
            same_oem(read, |message, out| message.write_xml(out), &message);
        }
    } else if let Ok(message) = oem::read(bytes) {
        same_oem(
            |bytes: &[u8]| oem::read(bytes),
            |message, out| message.write(out),
            &message,
        );
        // The other notation says the same, but for blanks at the ends of comments.
        let mut out = Vec::new();
        message.write_xml(&mut out).expect("memory takes the bytes");
        let in_xml = oem::read_xml(out.as_slice()).expect("our own file is read");
        assert_eq!(in_xml[0].segments.len(), message.segments.len());
    }
}

fn same_oem(
    read: impl Fn(&[u8]) -> Result<oem::Oem, ReadError>,
    write: impl Fn(&oem::Oem, &mut Vec<u8>) -> std::io::Result<()>,
    message: &oem::Oem,
) {
    let write = |message: &oem::Oem| {
        let mut out = Vec::new();
        write(message, &mut out).expect("memory takes the bytes");
        out
    };
    let again = settled(read, write, message);
    assert_eq!(again.header, message.header);
    assert_eq!(again.segments.len(), message.segments.len());
    for (one, other) in again.segments.iter().zip(&message.segments) {
        assert_eq!(one.metadata, other.metadata);
        assert_eq!(one.comments, other.comments);
        assert_eq!(one.states.len(), other.states.len());
        for (one, other) in one.states.iter().zip(&other.states) {
            assert_eq!(one.epoch, other.epoch);
            same_state(&one.state, &other.state);
        }
    }
}

/// Parameter messages, keyword = value or XML.
pub fn opm(bytes: &[u8]) {
    if format_of(bytes) == Some(Format::OpmXml) {
        for message in opm::read_xml(bytes).unwrap_or_default() {
            let read = |bytes: &[u8]| opm::read_xml(bytes).map(|mut read| read.remove(0));
            same_opm(read, opm::OpmSyntax::Xml, &message);
        }
    } else if let Ok(message) = opm::read(bytes) {
        same_opm(
            |bytes: &[u8]| opm::read(bytes),
            opm::OpmSyntax::Kvn,
            &message,
        );
    }
}

fn same_opm(
    read: impl Fn(&[u8]) -> Result<opm::Opm, ReadError>,
    syntax: opm::OpmSyntax,
    message: &opm::Opm,
) {
    let write = |message: &opm::Opm| {
        let mut out = Vec::new();
        let written = message.write_as(syntax, &mut out);
        written.expect("memory takes the bytes");
        out
    };
    let again = settled(read, write, message);
    assert_eq!(again.header, message.header);
    assert_eq!(again.epoch, message.epoch);
    assert_eq!(again.user_defined, message.user_defined);
    assert_eq!(again.mean_elements(), message.mean_elements());
    assert_eq!(again.keplerian.is_some(), message.keplerian.is_some());
    same_state(&again.state, &message.state);
}

/// STK ephemerides.
pub fn stk(bytes: &[u8]) {
    let Ok(file) = stk::read(bytes) else { return };
    let write = |file: &stk::StkEphemeris| {
        let mut out = Vec::new();
        file.write(&mut out).expect("memory takes the bytes");
        out
    };
    let again = settled(|bytes: &[u8]| stk::read(bytes), write, &file);
    assert_eq!(again.scenario_epoch, file.scenario_epoch);
    assert_eq!(again.frame, file.frame);
    assert_eq!(again.states.len(), file.states.len());
    for ((one_s, one), (other_s, other)) in again.states.iter().zip(&file.states) {
        assert!(near(*one_s, *other_s, 9), "{one_s} is not {other_s}");
        same_state(one, other);
    }
}

/// Tables of elements and of states.
pub fn csv(bytes: &[u8]) {
    if let Ok(rows) = csv::read_elements(bytes) {
        same_elements(&rows);
    }
    if let Ok(trajectories) = csv::read_states(bytes) {
        sampled::states(&trajectories);
    }
}

fn same_elements(rows: &[ElementsRow]) {
    for row in rows {
        let object = Object {
            name: row.name.clone(),
            catalog_number: CatalogNumber::new(90_001).expect("a number in range"),
            id: "2025-900A".to_owned(),
        };
        let mut out = Vec::new();
        let one = [csv::ElementsOf {
            slot: Some(navwalker::constellation::Slot::FIRST),
            elements: row.elements,
            object: &object,
        }];
        csv::write_elements(&mut out, &one, row.epoch).expect("what is read can be written");
        let again = csv::read_elements(out.as_slice()).expect("our own file is read");
        assert_eq!((&again[0].name, again[0].epoch), (&row.name, row.epoch));
        let numbers = |row: &ElementsRow| {
            let e = row.elements;
            [
                e.semi_major_axis_km,
                e.eccentricity,
                e.inclination_rad,
                e.raan_rad,
                e.arg_perigee_rad,
                e.mean_anomaly_rad,
            ]
        };
        // Radians to degrees and back: a few roundings.
        let same = numbers(&again[0])
            .into_iter()
            .zip(numbers(row))
            .all(|(a, b)| near(a, b, 14));
        assert!(same, "{row:?} is not {:?}", again[0]);
    }
}

/// The first byte names a format, or leaves it to the content: the linter does not panic, keeps
/// its limit, and has an error exactly where the reader refuses the file.
pub fn lint(bytes: &[u8]) {
    let Some((choice, bytes)) = bytes.split_first() else {
        return;
    };
    let format = Format::ALL.get(usize::from(*choice)).copied();
    let limit = 3 + usize::from(choice % 5);
    let report = lint::lint(bytes, format, None, limit).expect("memory does not fail");
    assert!(report.findings.len() <= limit);
    assert!(
        report
            .findings
            .iter()
            .all(|finding| finding.line > 0 && finding.column > 0)
    );
    let Some(format) = report.format else {
        assert!(Fleet::read(bytes, None, None).is_err());
        return;
    };
    let all = lint::lint(bytes, Some(format), None, usize::MAX).expect("memory does not fail");
    let first = all
        .findings
        .iter()
        .find(|finding| finding.severity == Severity::Error);
    let read = Fleet::read(bytes, Some(format), None);
    match (first, read) {
        (Some(_), Err(ReadFleetError::Read(_))) => {}
        (Some(first), other) => panic!("lint says {first}, the reader {other:?}"),
        (None, Err(ReadFleetError::Read(error))) => panic!("lint has no error, the reader {error}"),
        (None, _) => {}
    }
}

/// CZML: at each of its samples a satellite is where the sample says, and beyond its span it is nowhere.
pub fn czml(bytes: &[u8]) {
    let Ok(trajectories) = czml::read(bytes) else {
        return;
    };
    for arc in trajectories.iter().flat_map(|one| &one.arcs) {
        assert!(arc.nodes.windows(2).all(|pair| pair[0].0 < pair[1].0));
        for (at, expected) in arc.samples() {
            let (state, _) = arc.state(*at).expect("an instant of the span");
            assert_eq!(state.position_km, expected.position_km);
        }
        let (first, last) = arc.useable;
        assert!(arc.state(first.plus_seconds(-1.0)).is_none());
        assert!(arc.state(last.plus_seconds(1.0)).is_none());
    }
}

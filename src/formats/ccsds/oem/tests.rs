use super::*;
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::ephemeris::sampled::Sampled;
use crate::formats::ccsds::CcsdsVersion;
use crate::formats::metadata::Theory;
use crate::formats::text::finding::{Finding, FindingList, Severity};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::to_teme;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use proptest::prelude::*;

/// The example of CCSDS 502.0-B-3, annex G6, as far as it is printed, with the covariance of
/// the edition before it.
const BLUE_BOOK: &str = "\
CCSDS_OEM_VERS = 3.0
CREATION_DATE = 1996-11-04T17:22:31
ORIGINATOR    = NASA/JPL

META_START
OBJECT_NAME   = MARS GLOBAL SURVEYOR
OBJECT_ID     = 1996-062A
CENTER_NAME   = MARS BARYCENTER
REF_FRAME     = EME2000
TIME_SYSTEM   = UTC
START_TIME    = 2019-12-18T12:00:00.331
USEABLE_START_TIME = 2019-12-18T12:10:00.331
USEABLE_STOP_TIME = 2019-12-28T21:23:00.331
STOP_TIME     = 2019-12-28T21:28:00.331
INTERPOLATION = HERMITE
INTERPOLATION_DEGREE = 7
META_STOP
COMMENT This file was produced by M.R. Pigs, OSAR NAV/JPL, 2019NOV 04. It is
COMMENT to be used for DSN scheduling purposes only.

2019-12-18T12:00:00.331 2789.619 -280.045 -1746.755 4.73372 -2.49586 -1.04195
2019-12-18T12:01:00.331 2783.419 -308.143 -1877.071 5.18604 -2.42124 -1.99608
2019-12-18T12:02:00.331 2776.033 -336.859 -2008.682 5.63678 -2.33951 -1.94687
2019-12-28T21:28:00.331 -3881.024 563.959 -682.773 -3.28827 -3.66735 1.63861
META_START
OBJECT_NAME   = MARS GLOBAL SURVEYOR
OBJECT_ID     = 1996-062A
CENTER_NAME   = MARS BARYCENTER
REF_FRAME     = EME2000
TIME_SYSTEM   = UTC
START_TIME    = 2019-12-28T21:29:07.267
USEABLE_START_TIME = 2019-12-28T22:08:02.5
USEABLE_STOP_TIME = 2019-12-30T01:18:02.5
STOP_TIME     = 2019-12-30T01:28:02.267
INTERPOLATION = HERMITE
INTERPOLATION_DEGREE = 7
META_STOP
COMMENT This block begins after trajectory correction maneuver TCM-3.
2019-12-28T21:29:07.267 -2432.166 -063.042 1742.754 7.33702 -3.495867 -1.041945
2019-12-28T21:59:02.267 -2445.234 -878.141 1873.073 1.86043 -3.421256 -0.996366
2019-12-28T22:00:02.267 -2458.079 -683.858 2007.684 6.36786 -3.339563 -0.946654
2019-12-30T01:28:02.267 2164.375 1115.811 -688.131 -3.53328 -2.88452 0.88535
COVARIANCE_START
EPOCH = 2019-12-28T21:29:07.267
COV_REF_FRAME = EME2000
3.3313494e-04
4.6189273e-04 6.7824216e-04
-3.0700078e-04 -4.2212341e-04 3.2319319e-04
-3.3493650e-07 -4.6860842e-07 2.4849495e-07 4.2960228e-10
-2.2118325e-07 -2.8641868e-07 1.7980986e-07 2.6088992e-10 1.7675147e-10
-3.0413460e-07 -4.9894969e-07 3.5403109e-07 1.8692631e-10 1.0088625e-10 6.2244443e-10
COVARIANCE_STOP
";

fn findings(text: impl AsRef<[u8]>) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(50);
    parse(text.as_ref(), &mut findings, |_| ()).unwrap();
    let found = findings.into_vec();
    // These examples are of other orbits than those that are imported.
    let broken = found.into_iter().filter(|one| one.rule != "unsupported");
    broken.collect()
}

fn ephemeris(step_s: f64) -> Ephemeris {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 7_200.0, step_s).unwrap();
    let design: Design = "delta:55:6/3/1@925".parse().unwrap();
    Ephemeris::of_design(&design, Model::J2, grid).unwrap()
}

fn metadata(frame: Frame, time_system: TimeSystem) -> Metadata {
    Metadata {
        originator: "NAVWALKER".to_owned(),
        creation: ephemeris(60.0).grid().epoch(),
        frame,
        time_system,
        theory: Theory::Propagated(Model::J2),
        subject: vec!["Design: delta:55:6/3/1@925".to_owned()],
        frame_note: None,
        from_files: false,
    }
}

fn written(ephemeris: &Ephemeris, metadata: &Metadata, version: CcsdsVersion) -> String {
    let satellite = &ephemeris.satellites()[1];
    let object = Object::numbered(&satellite.name, 1, ephemeris.grid().epoch()).unwrap();
    let sampled = Sampled::new(ephemeris, metadata.frame);
    let hermite = Hermite::measured(&sampled, satellite).unwrap();
    let mut out = Vec::new();
    let writer = OemWriter {
        version,
        metadata,
        sampled: &sampled,
        hermite,
    };
    writer.kvn(&mut out, satellite, &object).unwrap();
    String::from_utf8(out).unwrap()
}

#[test]
fn validate_the_example_of_the_blue_book() {
    assert_eq!(findings(BLUE_BOOK), []);
    let message = read(BLUE_BOOK.as_bytes()).unwrap();
    assert_eq!(message.header.originator, "NASA/JPL");
    assert_eq!(message.segments.len(), 2);
    let first = &message.segments[0];
    assert_eq!(first.comments.len(), 2);
    assert_eq!(
        first.metadata.interpolation,
        Some(("HERMITE".to_owned(), 7))
    );
    let line = first.states[1];
    assert_eq!(
        line.state.position_km.km(),
        Vector3::new(2783.419, -308.143, -1877.071)
    );
    assert_eq!(
        line.state.velocity_km_s,
        Vector3::new(5.18604, -2.42124, -1.99608)
    );
    assert_eq!(line.epoch.to_string(), "2019-12-18 12:01:00.331");
    let error = first.clone().into_trajectory().unwrap_err().to_string();
    assert!(error.ends_with("centre MARS BARYCENTER is not the Earth"));
    // Written in our digits it means the same.
    let mut out = Vec::new();
    message.write(&mut out).unwrap();
    assert_eq!(read(out.as_slice()).unwrap(), message);
}

#[test]
fn what_is_written_reads_back_and_writes_the_same() {
    for (frame, system) in [
        (Frame::Eme2000, TimeSystem::Utc),
        (Frame::EarthFixed, TimeSystem::Gps),
        (Frame::Teme, TimeSystem::Utc),
        (Frame::Gcrf, TimeSystem::Tt),
    ] {
        for (step_s, version) in [(60.0, CcsdsVersion::V2), (0.1 + 599.3, CcsdsVersion::V3)] {
            let text = written(&ephemeris(step_s), &metadata(frame, system), version);
            assert_eq!(findings(&text), [], "{frame} {step_s}");
            let message = read(text.as_bytes()).unwrap();
            let mut again = Vec::new();
            message.write(&mut again).unwrap();
            assert_eq!(String::from_utf8(again).unwrap(), text);
        }
    }
}

/// The states read from the file are those of the model: TEME again, within the digits.
#[test]
fn states_survive_frames_and_time_systems() {
    let ephemeris = ephemeris(60.0);
    let satellite = &ephemeris.satellites()[1];
    for (frame, system) in [
        (Frame::EarthFixed, TimeSystem::Gps),
        (Frame::Eme2000, TimeSystem::Tai),
    ] {
        let text = written(&ephemeris, &metadata(frame, system), CcsdsVersion::V2);
        let trajectory = read(text.as_bytes()).unwrap().segments[0]
            .clone()
            .into_trajectory()
            .unwrap();
        let arc = &trajectory.arcs[0];
        assert_eq!((arc.frame, arc.nodes.len()), (frame, 120));
        for ((at, state), expected) in arc.nodes.iter().zip(ephemeris.states(satellite)) {
            let (elapsed_s, expected) = expected.unwrap();
            assert_eq!(at.seconds_since(ephemeris.grid().epoch()), elapsed_s);
            let teme = to_teme(*state, frame, ephemeris.grid().epoch(), elapsed_s);
            // Half a digit in three components, and rotations in doubles at 7303 km.
            assert!((teme.position_km - expected.position_km).norm() < 2e-9);
            assert!((teme.velocity_km_s - expected.velocity_km_s).norm() < 2e-12);
        }
    }
}

#[test]
fn times_have_the_digits_of_the_step() {
    let utc = metadata(Frame::Eme2000, TimeSystem::Utc);
    let text = written(&ephemeris(0.1), &utc, CcsdsVersion::V2);
    assert!(text.contains("\n2025-01-01T00:00:00.300 "));
    assert!(text.contains("\nSTOP_TIME = 2025-01-01T01:59:59.900\n"));
    let text = written(&ephemeris(1.0 / 3.0), &utc, CcsdsVersion::V2);
    assert!(text.contains("\n2025-01-01T00:00:00.333333333 "));
}

#[test]
fn broken_rules_are_named_with_their_place() {
    let cases = [
        (
            "CREATION_DATE = 1996-11-04T17:22:31\n",
            "",
            (4, 1, "ccsds-missing"),
        ),
        ("= 3.0", "= 9.0", (1, 18, "ccsds-version")),
        (
            "ORIGINATOR    = NASA/JPL",
            "ORIGINATOR    =",
            (3, 16, "ccsds-empty"),
        ),
        ("CENTER_NAME ", "CENTRE_NAME ", (8, 1, "ccsds-keyword")),
        (
            "TIME_SYSTEM   = UTC\nSTART_TIME    = 2019-12-28",
            "TIME_SYSTEM   = TAI\nSTART_TIME    = 2019-12-28",
            (30, 17, "oem-time-system"),
        ),
        (
            "12:01:00.331 2783",
            "11:01:00.331 2783",
            (22, 1, "oem-time-order"),
        ),
        (
            "12:01:00.331 2783",
            "12:00:00.331 2783",
            (22, 1, "oem-time-order"),
        ),
        ("2783.419", "2783,419", (22, 25, "ccsds-number")),
        ("2783.419", "NaN", (22, 25, "ccsds-number")),
        (
            "2783.419",
            "2783.41900000000000000",
            (22, 25, "ccsds-digits"),
        ),
        ("2783.419 ", "", (22, 1, "oem-fields")),
        (
            "2019-12-18T12:02",
            "2019-12-18 12:02",
            (23, 1, "oem-fields"),
        ),
        (
            "META_STOP\nCOMMENT This file",
            "COMMENT This file",
            (20, 1, "oem-line"),
        ),
        ("COVARIANCE_STOP\n", "", (51, 1, "oem-truncated")),
        (
            "4.6189273e-04 6.7824216e-04\n",
            "4.6189273e-04\n",
            (47, 1, "oem-covariance"),
        ),
        ("= 1996-11-04T17", "= 1996-11-04 17", (2, 17, "ccsds-time")),
        (
            "OBJECT_ID     = 1996-062A\nCENTER_NAME   = MARS BARYCENTER",
            "CENTER_NAME   = MARS BARYCENTER\nOBJECT_ID     = 1996-062A",
            (8, 1, "ccsds-order"),
        ),
        (
            "INTERPOLATION_DEGREE = 7",
            "INTERPOLATION_DEGREE = 9",
            (5, 1, "oem-interpolation"),
        ),
        ("INTERPOLATION_DEGREE = 7\n", "", (15, 17, "ccsds-missing")),
        (
            "2019-12-18T12:02",
            "COMMENT here\n2019-12-18T12:02",
            (23, 1, "oem-comment"),
        ),
        (
            "OBJECT_NAME   = MARS",
            "object_name   = MARS",
            (6, 1, "ccsds-keyword"),
        ),
        (
            "= 2019-12-28T21:28:00.331\nINTERP",
            "= 2019-12-18T12:01:30\nINTERP",
            (23, 1, "oem-span"),
        ),
    ];
    for (from, to, (line, column, rule)) in cases {
        let text = BLUE_BOOK.replacen(from, to, 1);
        assert_ne!(text, BLUE_BOOK, "{from}");
        let found = findings(&text);
        let expected = found
            .iter()
            .find(|f| (f.line, f.column, f.rule) == (line, column, rule))
            .unwrap_or_else(|| panic!("{to:?}: {found:#?}"));
        let read = read(text.as_bytes());
        assert_eq!(
            read.is_err(),
            expected.severity == Severity::Error,
            "{expected}"
        );
    }
}

#[test]
fn files_that_are_no_message_are_refused() {
    for text in ["", "\n\n", "hello", "CCSDS_OEM_VERS = 2.0\n", "\0\0\0\0"] {
        assert!(read(text.as_bytes()).is_err(), "{text:?}");
        assert!(!findings(text).is_empty(), "{text:?}");
    }
    let windows = format!("\u{feff}{}", BLUE_BOOK.replace('\n', "\r\n"));
    assert_eq!(
        read(windows.as_bytes()).unwrap(),
        read(BLUE_BOOK.as_bytes()).unwrap()
    );
    let tabs = BLUE_BOOK.replace(" = ", "\t=\t");
    assert_eq!(
        read(tabs.as_bytes()).unwrap(),
        read(BLUE_BOOK.as_bytes()).unwrap()
    );
    assert_eq!(findings(tabs)[0].rule, "tab");
}

/// The message of the standard in XML, as 505.0-B-2 lays it out, with a covariance.
fn blue_book_xml() -> String {
    let mut out = Vec::new();
    read(BLUE_BOOK.as_bytes())
        .unwrap()
        .write_xml(&mut out)
        .unwrap();
    let covariance = "<covarianceMatrix><EPOCH>2019-12-28T21:29:07.267</EPOCH>\
                      <CX_X>3.3e-04</CX_X></covarianceMatrix></data>";
    String::from_utf8(out)
        .unwrap()
        .replacen("</data>", covariance, 1)
}

fn findings_xml(text: impl AsRef<[u8]>) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(50);
    parse_xml(text.as_ref(), &mut findings, |_| ()).unwrap();
    let found = findings.into_vec();
    found
        .into_iter()
        .filter(|one| one.rule != "unsupported")
        .collect()
}

#[test]
fn xml_means_what_the_lines_mean() {
    let text = blue_book_xml();
    assert_eq!(findings_xml(&text), []);
    assert_eq!(
        read_xml(text.as_bytes()).unwrap(),
        [read(BLUE_BOOK.as_bytes()).unwrap()]
    );
    // Units, which the schema allows, and foreign layout.
    let foreign = text
        .replace("<X>", "\n\t<X units=\"km\">")
        .replace('\n', "\r\n");
    assert_eq!(
        read_xml(foreign.as_bytes()).unwrap(),
        read_xml(text.as_bytes()).unwrap()
    );
}

#[test]
fn combined_xml_reads_back_satellite_by_satellite() {
    let ephemeris = ephemeris(600.0);
    let epoch = ephemeris.grid().epoch();
    let metadata = metadata(Frame::Gcrf, TimeSystem::Tai);
    let sampled = Sampled::new(&ephemeris, metadata.frame);
    let objects = Object::all(ephemeris.satellites(), epoch).unwrap();
    let writer = OemWriter {
        version: CcsdsVersion::V3,
        metadata: &metadata,
        sampled: &sampled,
        hermite: None,
    };
    let mut combined = Vec::new();
    let satellites = ephemeris.satellites().iter();
    let messages = satellites.clone().zip(&objects);
    let messages = messages.map(|(satellite, object)| OemMessage {
        satellite,
        object,
        metadata: metadata.clone(),
        hermite: None,
    });
    write_combined_xml(&mut combined, CcsdsVersion::V3, &sampled, messages).unwrap();
    assert_eq!(findings_xml(&combined), []);
    let messages = read_xml(combined.as_slice()).unwrap();
    assert_eq!(messages.len(), 6);
    for ((satellite, object), message) in satellites.zip(&objects).zip(&messages) {
        let (mut lines, mut alone) = (Vec::new(), Vec::new());
        writer.kvn(&mut lines, satellite, object).unwrap();
        assert_eq!(read(lines.as_slice()).unwrap(), *message);
        // Write, read, write is the identity.
        writer.xml(&mut alone, satellite, object).unwrap();
        let mut again = Vec::new();
        read_xml(alone.as_slice()).unwrap()[0]
            .write_xml(&mut again)
            .unwrap();
        assert_eq!(
            String::from_utf8(again).unwrap(),
            String::from_utf8(alone).unwrap()
        );
    }
}

#[test]
fn broken_rules_of_xml_are_named() {
    for (from, to, rule) in [
        ("<X>2783.419", "<X>NaN", "ccsds-number"),
        ("<Y>-308.143000000</Y>\n", "", "ccsds-missing"),
        (
            "<Y>-308.143000000</Y>",
            "<Y>1</Y><Y>2</Y>",
            "ccsds-repeated",
        ),
        (
            "12:01:00.331</EPOCH>",
            "12:00:00.331</EPOCH>",
            "oem-time-order",
        ),
        ("<TIME_SYSTEM>UTC", "<TIME_SYSTEM>TAI", "oem-time-system"),
        ("version=\"3.0\"", "version=\"9.0\"", "ccsds-version"),
        ("<ORIGINATOR>", "<AUTHOR/><ORIGINATOR>", "ccsds-keyword"),
        ("</oem>", "", "xml-truncated"),
    ] {
        let text = blue_book_xml().replacen(from, to, 1);
        let found = findings_xml(&text);
        assert!(found.iter().any(|f| f.rule == rule), "{to}: {found:#?}");
        assert!(read_xml(text.as_bytes()).is_err(), "{to}");
    }
    for text in ["", "<", "<ndm></ndm>", "<oem></oem>", "<oem/>", "plain"] {
        assert!(read_xml(text.as_bytes()).is_err(), "{text}");
    }
}

proptest! {
    #[test]
    fn truncated_files_are_refused_or_whole(at in 0..BLUE_BOOK.len()) {
        let _ = read(&BLUE_BOOK.as_bytes()[..at]);
        let _ = findings(&BLUE_BOOK[..at]);
    }

    #[test]
    fn damaged_files_never_panic(at in 0..BLUE_BOOK.len(), byte in any::<u8>(), cut in 0_usize..40) {
        let mut bytes = BLUE_BOOK.as_bytes().to_vec();
        bytes[at] = byte;
        bytes.drain(at..(at + cut).min(BLUE_BOOK.len()));
        let _ = findings(&bytes);
    }

    #[test]
    fn damaged_xml_never_panics(share in 0.0..1.0_f64, byte in any::<u8>(), cut in 0_usize..40) {
        let mut bytes = blue_book_xml().into_bytes();
        let at = (share * bytes.len() as f64) as usize;
        bytes[at] = byte;
        bytes.drain(at..(at + cut).min(bytes.len()));
        let _ = findings_xml(&bytes);
    }
}

use super::*;
use crate::formats::metadata::{ElementChoice, Object, Theory};
use crate::formats::text::finding::{Finding, Severity};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::Frame;
use crate::keyword::Keyword;
use crate::orbit::sgp4::MeanMotionSlot;
use crate::time::Epoch;
use proptest::prelude::*;

/// The example of CCSDS 502.0-B-3, annex G4.
const BLUE_BOOK: &str = "\
CCSDS_OMM_VERS = 3.0
CREATION_DATE = 2020-065T16:00:00
ORIGINATOR    = NOAA
MESSAGE_ID    = OMM 202013719185
OBJECT_NAME   = GOES 9
OBJECT_ID     = 1995-025A
CENTER_NAME   = EARTH
REF_FRAME     = TEME
TIME_SYSTEM   = UTC
MEAN_ELEMENT_THEORY = SGP/SGP4
EPOCH         = 2020-064T10:34:41.4264
MEAN_MOTION   = 1.00273272
ECCENTRICITY  = 0.0005013
INCLINATION   = 3.0539
RA_OF_ASC_NODE= 81.7939
ARG_OF_PERICENTER = 249.2363
MEAN_ANOMALY  = 150.1602
GM            = 398600.8
EPHEMERIS_TYPE= 0
CLASSIFICATION_TYPE = U
NORAD_CAT_ID  = 23581
ELEMENT_SET_NO= 0925
REV_AT_EPOCH  = 4316
BSTAR         = 0.0001
MEAN_MOTION_DOT = -0.00000113
MEAN_MOTION_DDOT = 0.0
";

/// The example of the `sgp4` crate's documentation, from `CelesTrak`.
const CELESTRAK_JSON: &str = r#"[{
    "OBJECT_NAME": "ISS (ZARYA)",
    "OBJECT_ID": "1998-067A",
    "EPOCH": "2020-07-12T01:19:07.402656",
    "MEAN_MOTION": 15.49560532,
    "ECCENTRICITY": 0.0001771,
    "INCLINATION": 51.6435,
    "RA_OF_ASC_NODE": 225.4004,
    "ARG_OF_PERICENTER": 44.9625,
    "MEAN_ANOMALY": 5.1087,
    "EPHEMERIS_TYPE": 0,
    "CLASSIFICATION_TYPE": "U",
    "NORAD_CAT_ID": 25544,
    "ELEMENT_SET_NO": 999,
    "REV_AT_EPOCH": 23587,
    "BSTAR": 0.0049645,
    "MEAN_MOTION_DOT": 0.00289036,
    "MEAN_MOTION_DDOT": 0
}]"#;

/// The same set in the form that `CelesTrak` gives out as XML.
const CELESTRAK_XML: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<ndm xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
<omm id="CCSDS_OMM_VERS" version="2.0">
<header><CREATION_DATE/><ORIGINATOR/></header>
<body><segment><metadata><OBJECT_NAME>ISS (ZARYA)</OBJECT_NAME><OBJECT_ID>1998-067A</OBJECT_ID>
<CENTER_NAME>EARTH</CENTER_NAME><REF_FRAME>TEME</REF_FRAME><TIME_SYSTEM>UTC</TIME_SYSTEM>
<MEAN_ELEMENT_THEORY>SGP4</MEAN_ELEMENT_THEORY></metadata>
<data><meanElements><EPOCH>2020-07-12T01:19:07.402656</EPOCH><MEAN_MOTION>15.49560532</MEAN_MOTION>
<ECCENTRICITY>.0001771</ECCENTRICITY><INCLINATION>51.6435</INCLINATION>
<RA_OF_ASC_NODE>225.4004</RA_OF_ASC_NODE><ARG_OF_PERICENTER>44.9625</ARG_OF_PERICENTER>
<MEAN_ANOMALY>5.1087</MEAN_ANOMALY></meanElements><tleParameters><EPHEMERIS_TYPE>0</EPHEMERIS_TYPE>
<CLASSIFICATION_TYPE>U</CLASSIFICATION_TYPE><NORAD_CAT_ID>25544</NORAD_CAT_ID>
<ELEMENT_SET_NO>999</ELEMENT_SET_NO><REV_AT_EPOCH>23587</REV_AT_EPOCH><BSTAR>.49645E-2</BSTAR>
<MEAN_MOTION_DOT>.289036E-2</MEAN_MOTION_DOT><MEAN_MOTION_DDOT>0</MEAN_MOTION_DDOT></tleParameters></data>
</segment></body></omm></ndm>"#;

fn findings(text: impl AsRef<[u8]>, notation: OmmSyntax) -> Vec<Finding> {
    let mut findings = FindingList::of_linter(50);
    parse(text.as_ref(), notation, &mut findings, |_| ()).unwrap();
    findings.into_vec()
}

fn some_header() -> CcsdsHeader {
    let metadata = Metadata {
        originator: "NAVWALKER".to_owned(),
        creation: Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap()),
        frame: Frame::Teme,
        time_system: TimeSystem::Utc,
        theory: Theory::Sgp4Elements(ElementChoice::Kozai),
        subject: vec!["Design: <a & b>".to_owned()],
        frame_note: None,
        from_files: false,
    };
    header(CcsdsVersion::V2, &metadata)
}

fn written(notation: OmmSyntax, header: &CcsdsHeader, sets: Vec<sgp4::Elements>) -> String {
    let mut out = Vec::new();
    match notation {
        OmmSyntax::Kvn => write_kvn(&mut out, header, &sets[0]).unwrap(),
        OmmSyntax::Xml => write_xml(&mut out, header, &sets).unwrap(),
        OmmSyntax::Json => write_json(&mut out, &sets).unwrap(),
        OmmSyntax::Csv => write_csv(&mut out, &sets).unwrap(),
    }
    String::from_utf8(out).unwrap()
}

fn design_sets() -> Vec<sgp4::Elements> {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00.123456789Z".parse().unwrap());
    let design: crate::constellation::Design =
        "lattice:63.4:14/7/2@950,e=0.01,w=270".parse().unwrap();
    let set = |(index, satellite): (usize, &crate::constellation::Satellite)| {
        let object = Object::numbered("A <&> \"B\", C", index, epoch).unwrap();
        crate::formats::element_set(&satellite.elements, &object, epoch, MeanMotionSlot::Kozai)
    };
    design.satellites().iter().enumerate().map(set).collect()
}

#[test]
fn validate_the_example_of_the_blue_book() {
    assert_eq!(findings(BLUE_BOOK, OmmSyntax::Kvn), []);
    let message = read(BLUE_BOOK.as_bytes(), OmmSyntax::Kvn)
        .unwrap()
        .remove(0);
    let set = &message.set;
    assert_eq!(set.norad_id, 23581);
    assert_eq!(
        (set.mean_motion, set.eccentricity),
        (1.002_732_72, 0.000_501_3)
    );
    assert_eq!(set.drag_term, 1e-4);
    assert_eq!(set.element_set_number, 925);
    assert_eq!(set.datetime.to_string(), "2020-03-04 10:34:41.426400");
    assert_eq!(
        message.header.unwrap().message_id.as_deref(),
        Some("OMM 202013719185")
    );
}

/// The reader of the `sgp4` crate finds the same set, and ours finds the set that it wrote.
#[test]
fn validate_json_against_another_reader() {
    let ours = read(CELESTRAK_JSON.as_bytes(), OmmSyntax::Json).unwrap();
    let theirs: Vec<sgp4::Elements> = serde_json::from_str(CELESTRAK_JSON).unwrap();
    assert_eq!(ours[0].set, theirs[0]);
    let sets = design_sets();
    let text = written(OmmSyntax::Json, &some_header(), sets.clone());
    let theirs: Vec<sgp4::Elements> = serde_json::from_str(&text).unwrap();
    let ours: Vec<_> = read(text.as_bytes(), OmmSyntax::Json)
        .unwrap()
        .into_iter()
        .map(|m| m.set)
        .collect();
    assert_eq!(ours, theirs);
    // 12 decimals of a degree, 13 of a revolution a day.
    for (read, exact) in ours.iter().zip(&sets) {
        assert!((read.mean_anomaly - exact.mean_anomaly).abs() <= 5.1e-13);
        assert!((read.mean_motion - exact.mean_motion).abs() <= 5.1e-14);
        assert_eq!(read.datetime, exact.datetime);
    }
}

/// What `CelesTrak` gives out as XML lacks the header and the zeros before the points.
#[test]
fn catalogues_that_bend_the_rules_are_read_with_warnings() {
    let from_xml = read(CELESTRAK_XML.as_bytes(), OmmSyntax::Xml)
        .unwrap()
        .remove(0);
    let from_json = read(CELESTRAK_JSON.as_bytes(), OmmSyntax::Json)
        .unwrap()
        .remove(0);
    assert_eq!(from_xml.set, from_json.set);
    let rules: Vec<_> = findings(CELESTRAK_XML, OmmSyntax::Xml)
        .iter()
        .map(|f| f.rule)
        .collect();
    assert_eq!(
        rules,
        [
            "ccsds-empty",
            "ccsds-empty",
            "ccsds-point",
            "ccsds-point",
            "ccsds-point"
        ]
    );
}

#[test]
fn what_is_written_reads_back_and_writes_the_same() {
    for notation in OmmSyntax::ALL {
        let sets = match notation {
            OmmSyntax::Kvn => design_sets()[5..6].to_vec(),
            _ => design_sets(),
        };
        let header = some_header();
        let text = written(*notation, &header, sets);
        assert_eq!(findings(&text, *notation), [], "{notation}");
        let messages = read(text.as_bytes(), *notation).unwrap();
        if let Some(read_header) = &messages[0].header {
            assert_eq!(*read_header, header);
        }
        let again = messages.into_iter().map(|message| message.set).collect();
        assert_eq!(written(*notation, &header, again), text);
    }
}

#[test]
fn places_of_broken_rules_are_told() {
    let cases = [
        (
            OmmSyntax::Kvn,
            "= SGP/SGP4",
            "= DSST",
            (10, 23, "omm-theory"),
        ),
        (OmmSyntax::Kvn, "= TEME", "= EME2000", (8, 17, "omm-theory")),
        (
            OmmSyntax::Kvn,
            "= 3.0539",
            "= 203.05",
            (14, 17, "omm-range"),
        ),
        (
            OmmSyntax::Kvn,
            "= 0.0005013",
            "= -0.1",
            (13, 17, "omm-range"),
        ),
        (
            OmmSyntax::Kvn,
            "EPOCH         = 2020-064T10:34:41.4264\n",
            "",
            (25, 1, "ccsds-missing"),
        ),
        (
            OmmSyntax::Kvn,
            "MEAN_MOTION   = 1.00273272",
            "SEMI_MAJOR_AXIS = 42164.0",
            (1, 1, "ccsds-missing"),
        ),
        (
            OmmSyntax::Kvn,
            "= 0.0001",
            "= nan",
            (24, 17, "ccsds-number"),
        ),
        (OmmSyntax::Kvn, "= 4316", "= -1", (23, 17, "ccsds-number")),
        (OmmSyntax::Json, "51.6435", "351.6435", (7, 5, "omm-range")),
        (OmmSyntax::Json, "15.49560532,", "", (6, 19, "json-syntax")),
        (OmmSyntax::Json, "}]", "", (1, 2, "json-truncated")),
        (OmmSyntax::Json, "}]", "}", (19, 2, "json-truncated")),
        (OmmSyntax::Json, "[{", "nonsense", (1, 1, "json-syntax")),
        (
            OmmSyntax::Json,
            "\"EPOCH\"",
            "\"EPOCHE\"",
            (1, 2, "ccsds-missing"),
        ),
        (
            OmmSyntax::Json,
            "2020-07-12T",
            "2020-07-12 ",
            (4, 5, "ccsds-time"),
        ),
        (
            OmmSyntax::Xml,
            "</omm></ndm>",
            "",
            (15, 18, "xml-truncated"),
        ),
        (
            OmmSyntax::Xml,
            "</metadata>",
            "</metadatas>",
            (7, 48, "xml-syntax"),
        ),
        (OmmSyntax::Xml, "51.6435", "x", (9, 38, "ccsds-number")),
        (OmmSyntax::Xml, "EARTH", "&bomb;", (6, 14, "xml-syntax")),
        (
            OmmSyntax::Xml,
            "<ndm",
            "<!DOCTYPE a><ndm",
            (2, 1, "xml-syntax"),
        ),
    ];
    let mut misplaced = Vec::new();
    for (notation, from, to, expected) in cases {
        let original = match notation {
            OmmSyntax::Kvn => BLUE_BOOK,
            OmmSyntax::Json => CELESTRAK_JSON,
            _ => CELESTRAK_XML,
        };
        let text = original.replacen(from, to, 1);
        assert_ne!(text, original, "{from}");
        assert!(read(text.as_bytes(), notation).is_err());
        let found = findings(&text, notation);
        if !found.iter().any(|f| (f.line, f.column, f.rule) == expected) {
            let places: Vec<_> = found.iter().map(|f| (f.line, f.column, f.rule)).collect();
            misplaced.push((from, expected, places));
        }
    }
    assert!(misplaced.is_empty(), "{misplaced:#?}");
}

#[test]
fn tables_are_checked_row_by_row() {
    let table = written(OmmSyntax::Csv, &some_header(), design_sets());
    let rows: Vec<&str> = table.lines().collect();
    let found = findings(format!("{}\n{},1\n", rows[0], rows[1]), OmmSyntax::Csv);
    assert_eq!((found[0].line, found[0].rule), (2, "csv-fields"));
    let found = findings(table.replacen("63.4", "163.4x", 1), OmmSyntax::Csv);
    assert_eq!(
        (found[0].line, found[0].column, found[0].rule),
        (2, 6, "omm-number")
    );
    assert_eq!(findings("a,b\n1,2\n", OmmSyntax::Csv)[0].rule, "csv-header");
    let windows = format!("\u{feff}{}", table.replace('\n', "\r\n"));
    assert_eq!(
        read(windows.as_bytes(), OmmSyntax::Csv).unwrap(),
        read(table.as_bytes(), OmmSyntax::Csv).unwrap()
    );
}

#[test]
fn catalogues_of_several_messages_are_read_with_a_warning() {
    let twice = BLUE_BOOK.repeat(2);
    let found = findings(&twice, OmmSyntax::Kvn);
    assert_eq!(found.len(), 1);
    assert_eq!((found[0].line, found[0].severity), (27, Severity::Warning));
    let messages = read(twice.as_bytes(), OmmSyntax::Kvn).unwrap();
    assert_eq!((messages.len(), messages[1].line), (2, 27));
}

#[test]
fn hostile_files_are_refused_in_bounded_memory() {
    let deep = "<a>".repeat(1_000);
    assert_eq!(findings(deep, OmmSyntax::Xml)[0].rule, "xml-syntax");
    let long = format!("<ndm><omm>{}</omm></ndm>", "x".repeat(1 << 20));
    assert_eq!(findings(long, OmmSyntax::Xml)[0].rule, "xml-syntax");
    let long = format!("[{{\"A\":\"{}\"}}]", "x".repeat(3 << 20));
    assert_eq!(findings(long, OmmSyntax::Json)[0].rule, "json-truncated");
    for notation in OmmSyntax::ALL {
        for text in ["", "\0\0", "\n\n"] {
            assert!(
                read(text.as_bytes(), *notation).is_err(),
                "{notation} {text:?}"
            );
        }
    }
}

proptest! {
    #[test]
    fn damaged_files_never_panic(at in any::<prop::sample::Index>(), byte in any::<u8>(), cut in 0_usize..60) {
        for (text, notation) in [(BLUE_BOOK, OmmSyntax::Kvn), (CELESTRAK_JSON, OmmSyntax::Json), (CELESTRAK_XML, OmmSyntax::Xml), ("EPOCH,MEAN_MOTION\n\"1\",2\n3,4\n", OmmSyntax::Csv)] {
            let mut bytes = text.as_bytes().to_vec();
            let at = at.index(bytes.len());
            bytes[at] = byte;
            bytes.drain(at..(at + cut).min(text.len()));
            let _ = findings(&bytes, notation);
        }
    }
}

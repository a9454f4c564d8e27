use super::*;
use crate::exchange::export::testing::{in_memory, is_read, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::import::Fleet;
use crate::keyword::Keyword;
use crate::time::{Epoch, TimeGrid};
use flate2::Compression;
use flate2::write::GzEncoder;
use std::io::Write;

fn of(bytes: &[u8], name: Option<&str>) -> Result<Format, String> {
    let found = recognise(bytes, name).unwrap().content;
    found.map_err(|unread| unread.to_string())
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

fn exported() -> Vec<(String, Vec<u8>)> {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
    let subject = subject("delta:55:4/2/1@925".parse().unwrap(), grid);
    in_memory(&subject, Product::ALL, Choices::default())
        .1
        .into_iter()
        .collect()
}

/// What the program writes is recognised without its name, over blank lines and comments of 100 kB, packed or not;
/// products without a reader are not recognised.
#[test]
fn our_own_files_are_recognised_over_any_preamble() {
    let long = "operator notice ".repeat(6_000);
    for (path, bytes) in exported() {
        let Ok(format) = of(&bytes, None) else {
            assert!(!is_read(&path), "{path}");
            continue;
        };
        assert!(is_read(&path), "{path} is taken for {format}");
        assert_eq!(
            of(&packed(&bytes), Some("x.unknown.gz")),
            Ok(format),
            "{path}"
        );
        let preamble = match format {
            Format::OemXml | Format::OmmXml | Format::OpmXml => {
                format!("<?xml version=\"1.0\"?>\n<!-- {long} -->\n")
            }
            Format::OmmJson | Format::Czml => "\n".repeat(100_000),
            Format::Oem | Format::Omm | Format::Opm => format!("COMMENT {long}\n"),
            _ => "\r\n".repeat(50_000),
        };
        let text = String::from_utf8(bytes).unwrap();
        let text = text
            .strip_prefix("<?xml version=\"1.0\" encoding=\"UTF-8\"?>")
            .unwrap_or(&text);
        let text = format!("\u{feff}{preamble}{text}");
        assert_eq!(of(text.as_bytes(), None), Ok(format), "{path}");
    }
}

#[test]
fn roots_are_recognised_whatever_their_prefix() {
    for (text, expected) in [
        ("<ndm:oem xmlns:ndm='x'>", Ok(Format::OemXml)),
        (
            "<!DOCTYPE ndm>\n<ndm>\n<COMMENT>a</COMMENT>\n<omm id='x'>",
            Ok(Format::OmmXml),
        ),
        ("<ndm><!-- <omm> --><x:oem>", Ok(Format::OemXml)),
        ("<omm>", Ok(Format::OmmXml)),
        ("<ndm:opm id='x'>", Ok(Format::OpmXml)),
        ("<ndm>\n<opm>", Ok(Format::OpmXml)),
        ("<ocm>", Err("a CCSDS OCM in XML")),
        ("<!DOCTYPE html><html>", Err("a web page")),
        ("<kml xmlns='x'>", Err("KML")),
        ("<gpx>", Err("XML with the root element <gpx>")),
        (
            "<!-- without end",
            Err("XML that ends before its first element"),
        ),
    ] {
        let found = of(text.as_bytes(), Some("a.oem"));
        let expected =
            expected.map_err(|what| format!("not a supported format: it looks like {what}"));
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn what_is_not_read_is_named() {
    let rinex = format!(
        "{:>9}{:11}{:<20}{:<20}RINEX VERSION / TYPE\n",
        "3.04", "", "N: GNSS NAV DATA", "M: MIXED"
    );
    let satnogs = r#"[{"tle0": "0 A", "tle1": "1 25544U", "tle2": "2 25544", "tle_source": "x"}]"#;
    for (bytes, told) in [
        (rinex.as_bytes(), "a RINEX 3.04 file of navigation messages"),
        (b"CCSDS_OCM_VERS = 3.0\n", "a CCSDS OCM"),
        (b"COMMENT x\n\nCCSDS_TDM_VERS = 2.0\n", "a CCSDS TDM"),
        (satnogs.as_bytes(), "SatNOGS"),
        (
            br#"{"type": "FeatureCollection", "features": []}"#,
            "GeoJSON",
        ),
        // An item of an array is not a key.
        (
            br#"{"a": ["x", "OBJECT_NAME"], "type": "FeatureCollection"}"#,
            "GeoJSON",
        ),
        (
            br#"{"design": {"id": "document"}}"#,
            "JSON, but neither CZML nor OMM",
        ),
        (b"[]", "JSON, but neither CZML nor OMM"),
        (b"\x1f\x9d\x90", "Unix compress"),
        (b"PK\x03\x04", "a zip archive"),
        (b"%=SNX 2.02", "a SINEX file"),
        (b"", "the file is empty"),
        (
            b"\n\nonce upon a time",
            "it begins with \"once upon a time\"",
        ),
    ] {
        let error = of(bytes, Some("a.txt")).unwrap_err();
        assert!(error.contains(told), "{error}");
        let refused = Fleet::read(bytes, None, Some("a.txt"))
            .unwrap_err()
            .to_string();
        assert_eq!(refused, error);
        let report = crate::exchange::lint::lint(bytes, None, Some("a.txt"), 10).unwrap();
        assert_eq!(
            (report.format, report.findings[0].rule),
            (None, "unknown-format")
        );
        assert_eq!(report.findings[0].message, error);
    }
}

#[test]
fn names_help_where_content_does_not() {
    assert_eq!(of(b"", Some("a.b.SP3")), Ok(Format::Sp3));
    assert_eq!(of(b"x", Some("a.e.gz")), Ok(Format::Stk));
    assert_eq!(of(b"x", Some("a.tle")), Ok(Format::Tle));
    assert!(of(b"x", Some("a.txt")).is_err() && of(b"x", None).is_err());
    assert_eq!(of(b"\xef\xbb\xbfstk.v.4.3", Some("a.csv")), Ok(Format::Stk));
    // The content counts more than the name.
    assert_eq!(
        of(b"CCSDS_OEM_VERS = 2.0\n", Some("a.sp3")),
        Ok(Format::Oem)
    );
    assert_eq!(
        of(
            b"******** Week  299 almanac for PRN-01 ********\nID: 01\n",
            None
        ),
        Ok(Format::Yuma)
    );
    assert_eq!(
        of(b"31  CURRENT.ALM\n 299 258048\n\n1\n63\n0\n", None),
        Ok(Format::Sem)
    );
    assert!(of(b"31 28\n5 6 7\n", None).is_err());
}

/// Truncated and damaged gzip is reported as such, and a decompression bomb is cut off after 64 MiB.
#[test]
fn damaged_gzip_is_told() {
    let (_, sp3) = exported()
        .into_iter()
        .find(|(path, _)| path.ends_with(".sp3"))
        .unwrap();
    let whole = packed(&sp3);
    let read =
        |bytes: &[u8]| Fleet::read(bytes, None, Some("a.sp3.gz")).map(|read| read.fleet.len());
    assert_eq!(read(&whole).unwrap(), 4);
    let error = read(&whole[..whole.len() * 2 / 3]).unwrap_err().to_string();
    assert_eq!(error, "the gzip data are truncated");
    let mut damaged = whole.clone();
    let middle = damaged.len() / 2;
    damaged[middle..middle + 8].fill(0xff);
    let error = read(&damaged).unwrap_err().to_string();
    assert!(
        error.starts_with("the gzip data are") || error.starts_with("line "),
        "{error}"
    );
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    encoder
        .write_all(b"#dP2025  1  1  0  0  0.00000000       1 ORBIT ITRF  FIT  HNT\n")
        .unwrap();
    let blank = b"/*\n".repeat(1 << 18);
    for _ in 0..150 {
        encoder.write_all(&blank).unwrap();
    }
    let bomb = encoder.finish().unwrap();
    let error = read(&bomb).unwrap_err().to_string();
    assert!(error.contains("more than 200 times their size"), "{error}");
}

/// Members one after the other are one file, zeros behind the last one are padding, and anything else is told with its
/// place, whatever the size of the pieces in which the input comes.
#[test]
fn what_follows_gzip_data_is_read_padding_or_told() {
    let (_, tle) = exported()
        .into_iter()
        .find(|(path, _)| path.ends_with(".tle"))
        .unwrap();
    let cut = 1 + tle.iter().position(|byte| *byte == b'\n').unwrap();
    let members = [packed(&tle[..cut]), packed(b""), packed(&tle[cut..])].concat();
    let read = |bytes: &[u8], capacity: usize| {
        let input = BufReader::with_capacity(capacity, bytes);
        let read = Fleet::read(input, None, Some("a.tle.gz"));
        read.map(|read| read.fleet.len())
            .map_err(|error| error.to_string())
    };
    for capacity in [1, 7, 4096] {
        for padding in [0, 1, 511, 10_000] {
            let padded = [&members[..], &vec![0; padding]].concat();
            assert_eq!(read(&padded, capacity), Ok(4), "{capacity} {padding}");
        }
        for (behind, place) in [(&b"end"[..], 1), (b"\0\0x", 3), (b"\0\x1f\x8b", 2)] {
            let error = read(&[&members[..], behind].concat(), capacity).unwrap_err();
            let expected = format!(
                "byte {} follows the end of the gzip data, and is not the beginning of more",
                members.len() + place
            );
            assert_eq!(error, expected);
        }
        let error = read(&[&members[..], b"\x1f\x8b\x08"].concat(), capacity).unwrap_err();
        assert_eq!(error, "the gzip data are truncated");
    }
}

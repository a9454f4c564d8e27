use super::testing::in_memory;
use super::*;
use crate::formats::ccsds::oem;
use crate::formats::tle;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

fn subject() -> ExportSubject {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    testing::subject(
        "delta:55:14/7/1@925".parse().unwrap(),
        TimeGrid::new(epoch, 7_200.0, 60.0).unwrap(),
    )
}

fn exported(products: &[Product], choices: Choices) -> (Manifest, BTreeMap<String, Vec<u8>>) {
    in_memory(&subject(), products, choices)
}

#[test]
fn the_manifest_names_every_file_with_its_hash() {
    let (manifest, files) = exported(Product::ALL, Choices::default());
    let mut named: Vec<_> = manifest
        .files
        .iter()
        .map(|file| file.path.as_str())
        .collect();
    named.push(FILE_NAME);
    named.sort_unstable();
    assert_eq!(named, files.keys().map(String::as_str).collect::<Vec<_>>());
    for file in &manifest.files {
        let digest = Sha256::digest(&files[&file.path]);
        let hex: String = digest.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(file.sha256, hex, "{}", file.path);
    }
    assert_eq!(
        Manifest::read(files[FILE_NAME].as_slice()).unwrap(),
        manifest
    );
    assert_eq!(manifest.design.as_deref(), Some("delta:55:14/7/1@925"));
    let of = |format: &'static str| {
        manifest
            .files
            .iter()
            .filter(move |file| file.format == format)
    };
    assert_eq!(of("oem").count(), 14);
    assert_eq!(of("tle").map(|file| file.objects).sum::<usize>(), 14);
    assert!(of("tle").all(|file| file.loss.quantisation_max_km.is_some_and(|km| km > 1e-4)));
    assert!(of("oem").all(|file| file.frame == "EME2000" && file.time_system == "UTC"));
}

#[test]
fn exports_are_the_same_twice() {
    let once = exported(Product::ALL, Choices::default());
    assert_eq!(once, exported(Product::ALL, Choices::default()));
}

#[test]
fn choices_reach_the_files() {
    let choices = Choices {
        frame: Frame::Teme,
        ccsds_version: CcsdsVersion::V3,
        elements: ElementChoice::Kepler,
        ..Choices::default()
    };
    let (manifest, files) = exported(&[Product::Oem, Product::Tle], choices);
    let text = String::from_utf8(files["oem/NW-P01-S02.oem"].clone()).unwrap();
    assert!(text.starts_with("CCSDS_OEM_VERS = 3.0\n"));
    assert!(
        text.contains("\nREF_FRAME = TEME\n") && text.contains("COMMENT CCSDS 502.0-B-3 (4.2.4.9)")
    );
    assert!(manifest.files[0].loss.note.is_some());
    assert!(manifest.files[14].theory.contains("Kepler"));
    let sets = tle::read(files["constellation.tle"].as_slice()).unwrap();
    // sqrt(mu/a³) at 7303.137 km in revolutions per day.
    let kepler =
        (398_600.441_8_f64 / 7_303.137_f64.powi(3)).sqrt() * 86_400.0 / std::f64::consts::TAU;
    assert!((sets[0].mean_motion - kepler).abs() < 5e-9);
}

/// The tables hold the same states as the files in their formats.
#[test]
fn tables_agree_with_the_files() {
    let (_, files) = exported(
        &[Product::Csv, Product::Oem, Product::Tle, Product::TleStates],
        Choices {
            frame: Frame::EarthFixed,
            ..Choices::default()
        },
    );
    let mut states = ::csv::Reader::from_reader(files["states.csv"].as_slice());
    let rows: Vec<_> = states.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 14 * 120);
    let message = oem::read(files["oem/NW-P02-S01.oem"].as_slice()).unwrap();
    let of_satellite = rows.iter().filter(|row| &row[0] == "NW-P02-S01");
    for (row, line) in of_satellite.zip(&message.segments[0].states) {
        // Both are written to 1e-9 km from the same double.
        let x: f64 = row[9].parse().unwrap();
        assert_eq!(x, line.state.position_km.km().x);
    }
    let mut elements = ::csv::Reader::from_reader(files["elements.csv"].as_slice());
    let first = elements.records().next().unwrap().unwrap();
    assert_eq!(&first[0], "NW-P01-S01");
    assert_eq!(&first[6], "7303.137");
    assert!(files["tle-states.csv"].len() > 100 * rows.len());
}

#[test]
fn a_failing_sink_is_an_error() {
    let sink = |_: &str| -> io::Result<Vec<u8>> { Err(io::Error::other("disk full")) };
    let request = Request {
        subject: &subject(),
        shown: None,
        products: &[Product::Tle],
        choices: Choices::default(),
    };
    let error = export(&request, &sink).unwrap_err();
    assert_eq!(error.to_string(), "disk full");
}

//! Identities of files that some format cannot hold: every satellite goes out, and the manifest says under which other one.

use super::constellations::{exported, of_file};
use crate::exchange::constellation::Constellation;
use crate::exchange::export::testing::in_memory;
use crate::exchange::export::{Choices, Naming, Product};
use crate::exchange::import::Fleet;
use crate::exchange::manifest::Identifier;
use crate::formats::tle;
use crate::keyword::Keyword;
use crate::orbit::Model;

/// Names outside ASCII that become alike, numbers past Alpha-5, a designator outside ASCII, and a satellite that every
/// format can hold.
fn satellites() -> Constellation {
    let satellite = |(name, id, number, anomaly): (&str, &str, u32, u32)| {
        format!(
            "{{\"OBJECT_NAME\":\"{name}\",\"OBJECT_ID\":\"{id}\",\"EPOCH\":\"2025-01-01T00:00:00\",\
             \"MEAN_MOTION\":14.0,\"ECCENTRICITY\":0.001,\"INCLINATION\":53.0,\"RA_OF_ASC_NODE\":10.0,\
             \"ARG_OF_PERICENTER\":20.0,\"MEAN_ANOMALY\":{anomaly}.0,\"EPHEMERIS_TYPE\":0,\
             \"CLASSIFICATION_TYPE\":\"U\",\"NORAD_CAT_ID\":{number},\"ELEMENT_SET_NO\":1,\"REV_AT_EPOCH\":0,\
             \"BSTAR\":0.0,\"MEAN_MOTION_DOT\":0.0,\"MEAN_MOTION_DDOT\":0.0}}"
        )
    };
    let satellites = [
        ("Ω-1", "1998-067A", 25_544, 0),
        ("Ψ-1", "1998-067B", 799_500_123, 60),
        ("ISS (ZARYA)", "1998-067C", 339_999, 120),
        ("LAST", "1998-067Д", 340_000, 180),
        ("FIRST", "1998-067E", 90_001, 240),
    ]
    .map(satellite);
    of_file(
        "own.json",
        format!("[{}]", satellites.join(",\n")).as_bytes(),
    )
}

/// Name, number and designator of each satellite as it is written.
const WRITTEN: [(&str, u64, &str); 5] = [
    ("_-1", 25_544, "1998-067A"),
    ("_-1 #2", 90_002, "1998-067B"),
    ("ISS (ZARYA)", 339_999, "1998-067C"),
    ("LAST", 90_003, "2025-900C"),
    ("FIRST", 90_001, "1998-067E"),
];

fn identities(fleet: &Fleet) -> Vec<(String, u64, String)> {
    let Fleet::Sets(sets) = fleet else {
        panic!("{}", fleet.content());
    };
    let of = |set: &sgp4::Elements| {
        let text = |text: &Option<String>| text.clone().unwrap();
        (
            text(&set.object_name),
            set.norad_id,
            text(&set.international_designator),
        )
    };
    sets.iter().map(of).collect()
}

#[test]
fn element_sets_of_any_identity_go_out() {
    let constellation = satellites();
    let truth = constellation
        .ephemeris(super::constellations::grid(), Model::J2)
        .unwrap();
    for product in [Product::Tle, Product::Omm] {
        let (manifest, files) = exported(constellation.clone(), product);
        let mut whole: Option<Fleet> = None;
        for file in &manifest.files {
            let read = Fleet::read(files[&file.path].as_slice(), None, Some(&file.path)).unwrap();
            match &mut whole {
                None => whole = Some(read.fleet),
                Some(whole) => whole.append(read.fleet),
            }
        }
        let fleet = whole.unwrap();
        let expected = WRITTEN.map(|(name, number, id)| (name.to_owned(), number, id.to_owned()));
        assert_eq!(identities(&fleet), expected, "{product}");
        // In their own order and places.
        let found = fleet
            .propagate(super::constellations::grid(), Model::J2)
            .unwrap();
        for (one, other) in found.satellites().iter().zip(truth.satellites()) {
            let one = found.state(one, 3_600.0).unwrap().position_km;
            let other = truth.state(other, 3_600.0).unwrap().position_km;
            // The digits of a TLE.
            assert!((one - other).norm() < 0.1, "{product}");
        }
        let changed = manifest.changed_identities.iter();
        let changed: Vec<_> = changed
            .map(|one| (one.identifier, one.source.as_str(), one.written.as_str()))
            .collect();
        let expected = [
            (Identifier::Name, "Ω-1", "_-1"),
            (Identifier::Name, "Ψ-1", "_-1 #2"),
            (Identifier::CatalogueNumber, "799500123", "90002"),
            (Identifier::CatalogueNumber, "340000", "90003"),
            (Identifier::Designator, "1998-067Д", "2025-900C"),
        ];
        assert_eq!(changed, expected, "{product}");
    }
}

/// New numbers begin with the first catalogue number of the study; what can be held is not in the list.
#[test]
fn new_numbers_begin_where_the_study_says() {
    let subject = crate::exchange::export::ExportSubject {
        naming: Naming {
            first_catalog_number: 70_000,
            ..Naming::default()
        },
        ..crate::exchange::export::testing::subject_of(satellites(), super::constellations::grid())
    };
    let (manifest, files) = in_memory(&subject, &[Product::Tle], Choices::default());
    let sets = tle::read(files["constellation.tle"].as_slice()).unwrap();
    let numbers: Vec<u64> = sets.iter().map(|set| set.norad_id).collect();
    assert_eq!(numbers, [25_544, 70_000, 339_999, 70_001, 90_001]);
    let json = std::str::from_utf8(&files["manifest.json"]).unwrap();
    assert!(
        json.contains("\"identifier\": \"catalogue-number\""),
        "{json}"
    );
    assert_eq!(manifest.files[0].format, Product::Tle.keyword());
    let (manifest, _) = exported(
        of_file("own.tle", &files["constellation.tle"]),
        Product::Omm,
    );
    assert_eq!(manifest.changed_identities, []);
}

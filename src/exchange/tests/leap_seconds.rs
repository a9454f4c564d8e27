//! Spans over a leap second, in every product and from every reader: what a file says of its instants is compared
//! with labels that others define, since writer and reader could share an error.

use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::exchange::export::testing::{in_memory, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::import::Fleet;
use crate::formats::ccsds::{oem, omm};
use crate::formats::text::timestamp::TimeSystem;
use crate::frames::Frame;
use crate::keyword::Keyword;
use crate::orbit::Model;
use crate::time::{Epoch, TimeGrid};
use std::collections::BTreeMap;

type Files = BTreeMap<String, Vec<u8>>;

fn design() -> Design {
    "delta:55:4/2/1@925".parse().unwrap()
}

/// Samples every 30 s over `epoch` + 60 s, which is where the leap seconds of the tests begin.
fn grid(epoch: &str) -> TimeGrid {
    let epoch = Epoch::from_utc(epoch.parse().unwrap());
    TimeGrid::new(epoch, 180.0, 30.0).unwrap()
}

fn exported(grid: TimeGrid, product: Product, choices: Choices) -> Files {
    let mut files = in_memory(&subject(design(), grid), &[product], choices).1;
    files.remove("manifest.json");
    files
}

fn text<'a>(files: &'a Files, path: &str) -> &'a str {
    std::str::from_utf8(&files[path]).unwrap()
}

/// The first words of the lines that begin with a digit.
fn first_words(text: &str) -> Vec<&str> {
    let lines = text
        .lines()
        .filter(|line| line.starts_with(char::is_numeric));
    lines.filter_map(|line| line.split(' ').next()).collect()
}

/// IERS Bulletin C 52: the leap second of 2016-12-31 has a label in UTC, and in the other systems, which are
/// TAI - 19 s, TAI, TAI + 32.184 s and TAI - 33 s, the labels continue evenly.
#[test]
fn validate_labels_of_products_over_a_leap_second() {
    let grid = grid("2016-12-31T23:59:00Z");
    let labels = |system| match system {
        TimeSystem::Utc => [
            "2016-12-31T23:59:30.000",
            "2016-12-31T23:59:60.000",
            "2017-01-01T00:00:29.000",
        ],
        TimeSystem::Gps => [
            "2016-12-31T23:59:47.000",
            "2017-01-01T00:00:17.000",
            "2017-01-01T00:00:47.000",
        ],
        TimeSystem::Tai => [
            "2017-01-01T00:00:06.000",
            "2017-01-01T00:00:36.000",
            "2017-01-01T00:01:06.000",
        ],
        TimeSystem::Tt => [
            "2017-01-01T00:00:38.184",
            "2017-01-01T00:01:08.184",
            "2017-01-01T00:01:38.184",
        ],
        TimeSystem::Bdt => [
            "2016-12-31T23:59:33.000",
            "2017-01-01T00:00:03.000",
            "2017-01-01T00:00:33.000",
        ],
    };
    for system in TimeSystem::ALL {
        let choices = Choices {
            time_system: *system,
            ..Choices::default()
        };
        let files = exported(grid, Product::Oem, choices);
        let found = first_words(text(&files, "oem/NW-P01-S01.oem"));
        assert_eq!(found[1..4], labels(*system), "{system}");
    }
    let utc = labels(TimeSystem::Utc);
    let files = exported(grid, Product::Csv, Choices::default());
    for (line, label) in text(&files, "states.csv").lines().skip(2).zip(utc) {
        assert_eq!(line.split(',').nth(1), Some(label));
    }
    // Uniform in GPS time, as its header says.
    let files = exported(grid, Product::Sp3, Choices::default());
    let sp3 = text(&files, "sp3/part-01.sp3");
    let epochs: Vec<&str> = sp3.lines().filter(|line| line.starts_with("*  ")).collect();
    assert_eq!(
        epochs[..4],
        [
            "*  2016 12 31 23 59 17.00000000",
            "*  2016 12 31 23 59 47.00000000",
            "*  2017  1  1  0  0 17.00000000",
            "*  2017  1  1  0  0 47.00000000",
        ]
    );
    assert!(sp3.contains("## 1929 604757.00000000    30.00000000 57753 "));
    // With a scene, STK has its Connect commands too.
    let products = [Product::Stk, Product::Czml];
    let files = in_memory(&subject(design(), grid), &products, Choices::default()).1;
    let stk = text(&files, "stk/NW-P01-S01.e");
    assert!(stk.contains("ScenarioEpoch 31 Dec 2016 23:59:00.000000000\n"));
    assert_eq!(first_words(stk), ["0", "30", "60", "90", "120", "150"]);
    let connect = text(&files, "stk-scenario/connect.txt");
    assert!(connect.contains("\"31 Dec 2016 23:59:00.000000\" \"1 Jan 2017 00:01:59.000000\"\n"));
    assert!(text(&files, "scene.czml").contains("2016-12-31T23:59:00Z/2017-01-01T00:01:59Z"));
}

/// 23:59:60 is an instant: it is the epoch of every product except a TLE, whose epoch is the next instant that
/// it can express.
#[test]
fn an_epoch_may_lie_inside_a_leap_second() {
    let grid = grid("2015-06-30T23:59:60.25Z");
    let files = |product| exported(grid, product, Choices::default());
    for (product, path, label) in [
        (
            Product::Omm,
            "omm/NW-P01-S01.omm",
            "EPOCH = 2015-06-30T23:59:60.250\n",
        ),
        (
            Product::Opm,
            "opm/NW-P01-S01.opm",
            "EPOCH = 2015-06-30T23:59:60.250\n",
        ),
        (
            Product::Oem,
            "oem/NW-P01-S01.oem",
            "START_TIME = 2015-06-30T23:59:60.250\n",
        ),
        (
            Product::Stk,
            "stk/NW-P01-S01.e",
            "ScenarioEpoch 30 Jun 2015 23:59:60.250000000\n",
        ),
        (Product::Csv, "elements.csv", ",2015-06-30T23:59:60.250,"),
        (
            Product::Gmat,
            "gmat/navwalker.script",
            "Epoch = '30 Jun 2015 23:59:60.250'\n",
        ),
        (Product::Czml, "scene.czml", "\"2015-06-30T23:59:60.250Z\""),
        // Day 182 of 2015 is 1 July.
        (Product::Tle, "constellation.tle", " 15182.00000000 "),
    ] {
        let files = files(product);
        assert!(text(&files, path).contains(label), "{path}");
    }
}

/// The manifest says up to when leap seconds are known, and how far from an ITRF the Earth-fixed frame is at the epoch.
#[test]
fn the_manifest_tells_of_time() {
    let choices = Choices {
        frame: Frame::EarthFixed,
        time_system: TimeSystem::Bdt,
        ..Choices::default()
    };
    let subject = subject(design(), grid("2015-06-30T23:59:00Z"));
    let (manifest, files) = in_memory(&subject, &[Product::Oem, Product::Opm], choices);
    assert!(
        manifest
            .conventions
            .time
            .contains("up to 2027-06-28; none is assumed after it")
    );
    assert!(
        manifest
            .conventions
            .distance_from_itrf
            .contains("about 360 m")
    );
    for file in &manifest.files {
        let note = file.loss.note.as_deref().unwrap();
        assert!(note.contains("not a time system of CCSDS"), "{note}");
    }
    let oem = text(&files, "oem/NW-P01-S01.oem");
    assert!(oem.contains("COMMENT Off an ITRF with Earth-orientation data by about 360 m"));
    assert!(oem.contains("COMMENT BDT is not a time system of CCSDS"));
}

/// What is read back is where the design is at the same SI seconds, to the digits of the files.
#[test]
fn readers_count_seconds_over_a_leap_second() {
    for epoch in [
        "2016-12-31T23:59:00Z",
        "2015-06-30T23:58:59.5Z",
        "2016-12-31T23:59:60.75Z",
    ] {
        let grid = grid(epoch);
        let check = |product, choices, most_km: f64| {
            let files = exported(grid, product, choices);
            let apart_km = apart_km(&files, grid);
            assert!(apart_km < most_km, "{epoch} {product}: {apart_km} km");
        };
        for system in TimeSystem::ALL {
            for (frame, oem) in [
                (Frame::Eme2000, oem::OemSyntax::Kvn),
                (Frame::EarthFixed, oem::OemSyntax::Xml),
            ] {
                let choices = Choices {
                    frame,
                    oem,
                    time_system: *system,
                    ..Choices::default()
                };
                check(Product::Oem, choices, 1e-8);
                check(Product::Opm, choices, 1e-8);
            }
        }
        check(Product::Stk, Choices::default(), 1e-8);
        check(Product::Sp3, Choices::default(), 1e-6);
        check(Product::Czml, Choices::default(), 2.2e-3);
        let mut elements = exported(grid, Product::Csv, Choices::default());
        let states = elements.remove("states.csv").unwrap();
        for table in [elements, Files::from([("states.csv".to_owned(), states)])] {
            assert!(apart_km(&table, grid) < 1e-8, "{epoch}");
        }
    }
}

/// Sets hold at the instant of their file, to the nanosecond; a TLE's is the midnight after the leap second.
#[test]
fn sets_hold_at_their_instant_inside_a_leap_second() {
    let grid = grid("2016-12-31T23:59:60.75Z");
    let check = |product, choices, at: Epoch| {
        for bytes in exported(grid, product, choices).values() {
            let Fleet::Sets(sets) = Fleet::read(bytes.as_slice(), None, None).unwrap().fleet else {
                panic!("{product}");
            };
            for set in sets {
                assert_eq!(Epoch::from_utc(set.datetime.and_utc()), at, "{product}");
            }
        }
    };
    for omm in omm::OmmSyntax::ALL {
        let choices = Choices {
            omm: *omm,
            ..Choices::default()
        };
        check(Product::Omm, choices, grid.epoch());
    }
    let midnight = grid.epoch().plus_seconds(0.25);
    assert_eq!(midnight.to_string(), "2017-01-01T00:00:00Z");
    check(Product::Tle, Choices::default(), midnight);
}

/// Largest distance of the satellites of files from the design, km.
fn apart_km(files: &Files, grid: TimeGrid) -> f64 {
    let mut fleets = files.iter().map(|(path, bytes)| {
        let name = path.rsplit('/').next();
        Fleet::read(bytes.as_slice(), None, name).unwrap().fleet
    });
    let mut fleet = fleets.next().unwrap();
    fleets.for_each(|next| fleet.append(next));
    let read = fleet.propagate(grid, Model::J2).unwrap();
    let truth = Ephemeris::of_design(&design(), Model::J2, grid).unwrap();
    let mut worst_km = 0.0_f64;
    for (one, other) in read.satellites().iter().zip(truth.satellites()) {
        for t in grid.iter() {
            let (one, other) = (read.state(one, t).unwrap(), truth.state(other, t).unwrap());
            worst_km = worst_km.max((one.position_km - other.position_km).norm());
        }
    }
    worst_km
}

/// A file in GPS time, uniform in SI seconds from 2016-12-31 23:59:43 UTC on, as agencies write it: each record is at
/// its place to the last digit.
#[test]
fn validate_an_sp3_of_gps_time_over_a_leap_second() {
    let mut lines = vec![
        "#dP2017  1  1  0  0  0.00000000       4 ORBIT IGS20 FIT  XXX".to_owned(),
        "## 1930      0.00000000    15.00000000 57754 0.0000000000000".to_owned(),
        "+    1   G01  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0".to_owned(),
        "%c G  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc".to_owned(),
    ];
    for k in 0..4 {
        lines.push(format!("*  2017  1  1  0  0 {:11.8}", f64::from(k) * 15.0));
        lines.push(format!(
            "PG01  26560.00000{k}      0.000000  -1000.00000{k} 999999.999999"
        ));
        lines.push(format!(
            "VG01      0.00000{k}  30000.000000      0.000000 999999.999999"
        ));
    }
    lines.push("EOF\n".to_owned());
    let fleet = Fleet::read(lines.join("\n").as_bytes(), None, None)
        .unwrap()
        .fleet;
    let grid = TimeGrid::new(
        Epoch::from_utc("2016-12-31T23:59:43Z".parse().unwrap()),
        60.0,
        15.0,
    )
    .unwrap();
    let read = fleet.propagate(grid, Model::J2).unwrap();
    for (k, elapsed_s) in grid.iter().enumerate() {
        let teme = read.state(&read.satellites()[0], elapsed_s).unwrap();
        let fixed = crate::frames::from_teme(teme, Frame::EarthFixed, grid.epoch(), elapsed_s);
        let expected_km = nalgebra::Vector3::new(26_560.0, 0.0, -1000.0)
            + nalgebra::Vector3::new(1e-6, 0.0, -1e-6) * k as f64;
        // Rotations forth and back in doubles.
        assert!((fixed.position_km.km() - expected_km).norm() < 1e-10, "{k}");
    }
}

/// Second 60 exists in UTC only; in a file of another system it is refused, with its place.
#[test]
fn second_60_is_refused_in_other_systems() {
    let oem = |system: &str| {
        format!(
            "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2016-12-01T00:00:00\nORIGINATOR = X\nMETA_START\n\
             OBJECT_NAME = A\nOBJECT_ID = 2016-001A\nCENTER_NAME = EARTH\nREF_FRAME = EME2000\n\
             TIME_SYSTEM = {system}\nSTART_TIME = 2016-12-31T23:59:59\nSTOP_TIME = 2017-01-01T00:00:01\n\
             META_STOP\n2016-12-31T23:59:59 7303 0 0 0 7.38 0\n2016-12-31T23:59:60 7302.9 7.38 0 0 7.38 0\n\
             2017-01-01T00:00:01 7302.9 14.8 0 0 7.38 0\n"
        )
    };
    let read = |text: &str| Fleet::read(text.as_bytes(), None, None).map(|read| read.fleet.len());
    assert_eq!(read(&oem("UTC")).unwrap(), 1);
    let error = read(&oem("TAI")).unwrap_err().to_string();
    assert!(error.starts_with("line 14, "), "{error}");
    assert!(error.contains("TAI has no second 60"), "{error}");
    let sp3 = |system: &str| {
        format!(
            "#dP2016 12 31 23 59 60.00000000       1 ORBIT IGS20 FIT  XXX\n\
             ## 1929 604816.00000000    15.00000000 57753 0.9999999999999\n\
             +    1   G01  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0  0\n\
             %c G  cc {system} ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc\n\
             *  2016 12 31 23 59 60.00000000\n\
             PG01  26560.000000      0.000000  -1000.000000 999999.999999\nEOF\n"
        )
    };
    let error = read(&sp3("GPS")).unwrap_err().to_string();
    assert!(error.contains("GPS has no second 60"), "{error}");
}

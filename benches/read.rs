//! How fast every format is read, in bytes a second.
//!
//! `cargo bench --bench read`; `DIVAN_SAMPLE_COUNT` sets the samples of each case. One thread; the files are in memory
//! and hold a thousand satellites, or 24 satellites at 1440 instants.

mod written;

use divan::Bencher;
use divan::counter::BytesCount;
use flate2::Compression;
use flate2::write::GzEncoder;
use navwalker::exchange::export::{Choices, Product};
use navwalker::exchange::import::Fleet;
use navwalker::formats::ccsds::{oem, omm, opm};
use navwalker::orbit::Model;
use std::io::Write;

fn main() {
    divan::main();
}

const SOUND: &str = "the design can be exported";

/// Designs of the element formats and of the state formats, and the instants of the latter.
const ELEMENTS: &str = "delta:55:1000/20/1@925";
const STATES: &str = "delta:55:24/6/1@925";
const SAMPLES: usize = 1440;

const CASES: [&str; 17] = [
    "tle",
    "omm-kvn",
    "omm-xml",
    "omm-json",
    "omm-csv",
    "opm",
    "opm-xml",
    "yuma",
    "sem",
    "elements-csv",
    "oem-kvn",
    "oem-xml",
    "sp3",
    "sp3.gz",
    "stk",
    "czml",
    "states-csv",
];

/// The files of a case: name and bytes.
fn files(name: &str) -> Vec<(String, Vec<u8>)> {
    let exported = |design: &str, product: Product, choices: Choices| {
        written::files(&written::subject(design, SAMPLES), product, choices)
    };
    let omm = |syntax: omm::OmmSyntax| {
        let choices = Choices {
            omm: syntax,
            ..Choices::default()
        };
        exported(ELEMENTS, Product::Omm, choices)
    };
    let oem = |syntax: oem::OemSyntax| {
        let choices = Choices {
            oem: syntax,
            ..Choices::default()
        };
        exported(STATES, Product::Oem, choices)
    };
    let plain = |design: &str, product: Product| exported(design, product, Choices::default());
    match name {
        "tle" => plain(ELEMENTS, Product::Tle),
        "omm-kvn" => omm(omm::OmmSyntax::Kvn),
        "omm-xml" => omm(omm::OmmSyntax::Xml),
        "omm-json" => omm(omm::OmmSyntax::Json),
        "omm-csv" => omm(omm::OmmSyntax::Csv),
        "opm" => plain(ELEMENTS, Product::Opm),
        "opm-xml" => {
            let choices = Choices {
                opm: opm::OpmSyntax::Xml,
                ..Choices::default()
            };
            exported(ELEMENTS, Product::Opm, choices)
        }
        "yuma" => vec![("a.alm".to_owned(), yuma().into_bytes())],
        "sem" => vec![("a.al3".to_owned(), sem().into_bytes())],
        "elements-csv" | "states-csv" => {
            let design = if name == "states-csv" {
                STATES
            } else {
                ELEMENTS
            };
            let mut files = plain(design, Product::Csv);
            files.retain(|(path, _)| path.starts_with(&name[..6]));
            files
        }
        "oem-kvn" => oem(oem::OemSyntax::Kvn),
        "oem-xml" => oem(oem::OemSyntax::Xml),
        "sp3" => plain(STATES, Product::Sp3),
        "sp3.gz" => plain(STATES, Product::Sp3)
            .into_iter()
            .map(packed)
            .collect(),
        "stk" => plain(STATES, Product::Stk),
        _ => vec![("a.czml".to_owned(), czml().into_bytes())],
    }
}

fn packed((name, bytes): (String, Vec<u8>)) -> (String, Vec<u8>) {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(&bytes).expect("memory takes the bytes");
    let bytes = encoder.finish().expect("memory takes the bytes");
    (format!("{name}.gz"), bytes)
}

/// 63 satellites in the fields of the definition.
fn yuma() -> String {
    let block = |prn: u32| {
        format!(
            "******** Week 299 almanac for PRN-{prn:02} ********\n\
             ID:                         {prn:02}\n\
             Health:                     000\n\
             Eccentricity:               0.5000000000E-002\n\
             Time of Applicability(s):  258048.0000\n\
             Orbital Inclination(rad):   0.9600000000\n\
             Rate of Right Ascen(r/s):  -0.8000000000E-008\n\
             SQRT(A)  (m 1/2):           5153.500000\n\
             Right Ascen at Week(rad):   0.1000000000E+001\n\
             Argument of Perigee(rad):   0.500000000\n\
             Mean Anom(rad):            -0.{prn:02}00000000E+000\n\
             Af0(s):                     0.0000000000E+000\n\
             Af1(s/s):                   0.0000000000E+000\n\
             week:                        299\n\n"
        )
    };
    (1..=63).map(block).collect()
}

/// The same in the layout of SEM.
fn sem() -> String {
    let block = |prn: u32| {
        format!(
            "\n{prn}\n63\n0\n 5.0000000E-03  5.0000000E-03 -2.5000000E-09\n \
             5.1535000E+03  1.0000000E-01  2.0000000E-01\n 3.{prn:02}00000E-01  \
             0.0000000E+00  0.0000000E+00\n0\n11\n"
        )
    };
    let blocks: String = (1..=63).map(block).collect();
    format!("63  CURRENT.ALM\n 299 258048\n{blocks}")
}

/// A document of positions, with six decimals of a metre.
fn czml() -> String {
    let subject = written::subject(STATES, SAMPLES);
    let ephemeris = subject.constellation.ephemeris(subject.grid, Model::J2);
    let ephemeris = ephemeris.expect(SOUND);
    let mut packets = vec!["{\"id\":\"document\",\"version\":\"1.0\"}".to_owned()];
    for satellite in ephemeris.satellites() {
        let samples = ephemeris.states(satellite).map(|sample| {
            let (t, state) = sample.expect(SOUND);
            let r = state.position_km.km() * 1e3;
            format!("{t},{:.6},{:.6},{:.6}", r.x, r.y, r.z)
        });
        let samples: Vec<String> = samples.collect();
        packets.push(format!(
            "{{\"id\":\"{}\",\"position\":{{\"epoch\":\"2025-01-01T00:00:00Z\",\
             \"referenceFrame\":\"INERTIAL\",\"interpolationAlgorithm\":\"LAGRANGE\",\
             \"interpolationDegree\":7,\"cartesian\":[{}]}}}}",
            satellite.name,
            samples.join(",")
        ));
    }
    format!("[{}]", packets.join(",\n"))
}

#[divan::bench(args = CASES)]
fn read(bencher: Bencher, name: &str) {
    let files = files(name);
    let bytes: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    bencher.counter(BytesCount::new(bytes)).bench_local(|| {
        let fleets = files.iter().map(|(path, bytes)| {
            let read = Fleet::read(bytes.as_slice(), None, Some(path)).expect("the file is valid");
            read.fleet.len()
        });
        fleets.sum::<usize>()
    });
}

//! Tests of every reader: damaged files, and files as other programs write them.

mod constellations;
mod foreign;
mod hostile;
mod identities;
mod kinds;
mod leap_seconds;

use crate::exchange::export::testing::{in_memory, is_read, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::lint::Format;
use crate::exchange::recognise::recognise;
use crate::formats::ccsds::{oem, omm, opm};
use crate::keyword::Keyword;
use crate::time::{Epoch, TimeGrid};

/// SEM is read and not written: two satellites in the layout of its definition.
const SEM: &str = "\
2  CURRENT.ALM
 299 258048

1
63
0
 5.0000000E-03  5.0000000E-03 -2.5000000E-09
 5.1535000E+03  1.0000000E-01  2.0000000E-01
 3.0000000E-01  0.0000000E+00  0.0000000E+00
0
11

2
61
0
 1.0000000E-02 -2.0000000E-03 -2.6000000E-09
 5.1536000E+03 -7.5000000E-01 -2.0000000E-01
-4.0000000E-01  1.0000000E-05  0.0000000E+00
0
11
";

/// A small valid file of every format, by our own writers.
fn samples() -> Vec<(Format, String)> {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let subject = subject(
        "lattice:55:4/2/1@925,e=0.01,w=30".parse().unwrap(),
        TimeGrid::new(epoch, 360.0, 90.0).unwrap(),
    );
    let mut found: Vec<(Format, String)> = Vec::new();
    for ((notation, oem), opm) in omm::OmmSyntax::ALL
        .iter()
        .zip(oem::OemSyntax::ALL.iter().cycle())
        .zip(opm::OpmSyntax::ALL.iter().cycle())
    {
        let choices = Choices {
            omm: *notation,
            oem: *oem,
            opm: *opm,
            oem_combined: *oem == oem::OemSyntax::Xml,
            ..Choices::default()
        };
        for (path, bytes) in in_memory(&subject, Product::ALL, choices).1 {
            if !is_read(&path) {
                continue;
            }
            let format = recognise(bytes.as_slice(), None).unwrap().content.unwrap();
            let known = found.iter().any(|(known, _)| *known == format);
            if !known {
                found.push((format, String::from_utf8(bytes).unwrap()));
            }
        }
    }
    found.push((Format::Sem, SEM.to_owned()));
    assert_eq!(found.len(), Format::ALL.len());
    found
}

//! Tests of every reader: damaged files, and files as other programs write them.

mod foreign;
mod hostile;

use crate::exchange::export::testing::{in_memory, is_read, subject};
use crate::exchange::export::{Choices, Product};
use crate::exchange::lint::Format;
use crate::formats::ccsds::{oem, omm};
use crate::keyword::Keyword;
use crate::time::{Epoch, TimeGrid};

/// A small valid file of every format, by our own writers.
fn samples() -> Vec<(Format, String)> {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let subject = subject(
        "lattice:55:4/2/1@925,e=0.01,w=30".parse().unwrap(),
        TimeGrid::new(epoch, 360.0, 90.0).unwrap(),
    );
    let mut found: Vec<(Format, String)> = Vec::new();
    for (notation, oem) in omm::OmmSyntax::ALL
        .iter()
        .zip(oem::OemSyntax::ALL.iter().cycle())
    {
        let choices = Choices {
            omm: *notation,
            oem: *oem,
            oem_combined: *oem == oem::OemSyntax::Xml,
            ..Choices::default()
        };
        for (path, bytes) in in_memory(&subject, Product::ALL, choices).1 {
            let format = Format::of(&bytes, None);
            let known = found.iter().any(|(known, _)| *known == format);
            if is_read(&path) && !known {
                found.push((format, String::from_utf8(bytes).unwrap()));
            }
        }
    }
    assert_eq!(found.len(), Format::ALL.len());
    found
}

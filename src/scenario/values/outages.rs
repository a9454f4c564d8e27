//! Satellites that are out of service.

use crate::scenario::keys::{key, section};
use crate::scenario::reader::Reader;
use crate::scenario::rule::{ListOf, Text, TextOrTexts};

section! {
    /// Satellites out of service, of constellations and of the GNSS.
    #[derive(Debug, Clone, PartialEq, Eq)]
    pub struct SatelliteOutages in "outages", finish clear_absent {
        /// Out of service throughout, by name: a satellite (`NW-P01-S03`, or as its file names it), a plane or shell of a
        /// design (`NW-P03`, `NW-A`), or a GNSS satellite (`GEO-1`, `gps:A3`).
        pub satellites: Vec<String> = ListOf(Text::Any), follows "none",
            example vec!["NW-P01-S03".to_owned(), "gps:A3".to_owned()];
        /// One file or several of intervals out of service: CSV with the columns satellite, start_utc and end_utc, or interval
        /// lists of STK (.int); one that names no satellites is of the satellite that the file is named after. Paths relative to
        /// this file.
        pub file: Vec<String> = TextOrTexts, follows "none", example vec!["outages.csv".to_owned()];
    }
}

fn clear_absent(outages: &mut SatelliteOutages, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(SatelliteOutages.satellites)) {
        outages.satellites = Vec::new();
    }
    if !reader.is_given(key!(SatelliteOutages.file)) {
        outages.file = Vec::new();
    }
}

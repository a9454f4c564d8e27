//! Files that are read one after the other as one constellation.

use super::{Fleet, GatheredFleet, Imported};
use crate::exchange::lint::Format;

/// The satellites of the files so far, and the formats found, each once.
#[derive(Debug, Default)]
pub struct MergedFiles {
    formats: Vec<Format>,
    fleet: Option<GatheredFleet>,
    count: usize,
    /// The file of each satellite, kind by kind: those of a file follow the satellites of their kind.
    origins: Vec<Vec<usize>>,
}

/// The satellites of all files.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// The formats found, each once.
    pub formats: Vec<Format>,
    /// The satellites.
    pub fleet: Fleet,
    /// The number, from 0, of the first file that each satellite is in.
    pub origins: Vec<usize>,
}

impl MergedFiles {
    /// Adds a file, whose satellites may continue those of earlier ones.
    pub fn add(&mut self, imported: Imported) {
        if !self.formats.contains(&imported.format) {
            self.formats.push(imported.format);
        }
        match &mut self.fleet {
            None => self.fleet = Some(imported.fleet.into()),
            Some(fleet) => fleet.add(imported.fleet),
        }
        let parts = self.fleet.as_ref().map_or(&[][..], GatheredFleet::parts);
        self.origins.resize_with(parts.len(), Vec::new);
        for (origins, part) in self.origins.iter_mut().zip(parts) {
            origins.resize(part.len(), self.count);
        }
        self.count += 1;
    }

    /// What was read; `None` without a file.
    #[must_use]
    pub fn finish(self) -> Option<Merged> {
        Some(Merged {
            formats: self.formats,
            fleet: self.fleet?.finish(),
            origins: self.origins.concat(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "object,epoch_utc,semi_major_axis_km,eccentricity,inclination_deg,raan_deg,arg_perigee_deg,mean_anomaly_deg\n";
    const TLE: &str = "1 00005U 58002B   00179.78495062  .00000023  00000-0  28098-4 0  4753\n\
         2 00005  34.2682 348.7242 1859667 331.7664  19.3264 10.82419157413667\n";

    fn elements(names: &[&str]) -> Imported {
        let row = |name: &&str| format!("{name},2025-01-01T00:00:00Z,7300,0,50,0,0,0\n");
        let text = names
            .iter()
            .map(row)
            .fold(HEAD.to_owned(), |all, row| all + &row);
        Fleet::read(text.as_bytes(), None, Some("some.csv")).unwrap()
    }

    /// Kinds are kept together, whatever the order of the files.
    #[test]
    fn each_satellite_has_the_number_of_its_file() {
        let mut merged = MergedFiles::default();
        assert!(MergedFiles::default().finish().is_none());
        merged.add(elements(&["A", "B"]));
        merged.add(Fleet::read(TLE.as_bytes(), None, Some("one.tle")).unwrap());
        merged.add(elements(&["C"]));
        let merged = merged.finish().unwrap();
        let labels = merged.fleet.labels();
        assert_eq!(labels[..3], ["A", "B", "C"]);
        assert_eq!(merged.origins, [0, 0, 2, 1]);
        assert_eq!(merged.fleet.len(), 4);
    }
}

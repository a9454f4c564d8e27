//! Files that are read one after the other as one constellation.

use super::{Fleet, GatheredFleet, Imported};
use crate::exchange::lint::Format;

/// The satellites of the files so far, and the formats found, each once.
#[derive(Debug, Default)]
pub struct MergedFiles {
    formats: Vec<Format>,
    fleet: Option<GatheredFleet>,
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
    }

    /// The formats and the satellites; `None` without a file.
    #[must_use]
    pub fn finish(self) -> Option<(Vec<Format>, Fleet)> {
        Some((self.formats, self.fleet?.finish()))
    }
}

//! The results that a run directory holds already.

use crate::cli::files;
use crate::run::FRONT_JSON;
use serde::Deserialize;
use std::path::Path;

/// The part of [`FRONT_JSON`] that says how far its search got.
#[derive(Deserialize)]
pub(super) struct HeldResults {
    pub(super) generations: [u64; 2],
}

impl HeldResults {
    /// Those in a directory, if any can be read.
    pub(super) fn of(directory: &Path) -> Option<Self> {
        let bytes = files::read_run(&directory.join(FRONT_JSON)).ok()?;
        serde_json::from_slice(&bytes).ok()
    }

    pub(super) fn is_finished(&self) -> bool {
        self.generations[0] >= self.generations[1]
    }
}

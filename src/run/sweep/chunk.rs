//! A chunk, its name, and its result as a file that proves to be that of the chunk.

use super::designs::SweptDesign;
use super::format::{TableFormat, read_table, table_bytes};
use super::{SweepPlan, SweepSource};
use crate::keyword::Keyword;
use crate::run::checkpoint::hex;
use crate::run::typed_columns::TypedColumns;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::io;
use thiserror::Error;

/// Some designs of a sweep, with all that their results depend on.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct SweepChunk {
    /// SHA-256, hex, of what follows.
    pub name: String,
    /// Version of the program.
    pub version: String,
    /// The hash of the scenario without its optimiser.
    pub scenario_hash: String,
    /// Where the designs come from.
    pub source: SweepSource,
    /// The designs.
    pub designs: Vec<SweptDesign>,
}

impl SweepChunk {
    /// The chunk of a plan with these designs.
    #[must_use]
    pub fn new(plan: &SweepPlan, designs: Vec<SweptDesign>) -> Self {
        let mut chunk = Self {
            name: String::new(),
            version: plan.version.clone(),
            scenario_hash: plan.scenario.hash.clone(),
            source: plan.source,
            designs,
        };
        chunk.name = chunk.computed_name();
        chunk
    }

    fn computed_name(&self) -> String {
        let mut hash = Sha256::new();
        let mut add = |text: &str| {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        };
        add(&self.version);
        add(&self.scenario_hash);
        add(self.source.keyword());
        for one in &self.designs {
            add(one.name.as_deref().unwrap_or_default());
            add(&one.notation);
        }
        hex(&hash.finalize())
    }

    /// Whether the name is that of what it holds.
    #[must_use]
    pub fn is_intact(&self) -> bool {
        self.name == self.computed_name()
    }
}

/// Why a file is not the result of a chunk.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ChunkError {
    /// Not a table in the format of the sweep, or cut short.
    #[error("it is damaged: {reason}")]
    Damaged {
        /// What is wrong.
        reason: String,
    },
    /// The result of another chunk.
    #[error("it is the result of another chunk")]
    Other,
    /// Its values are not those that were written.
    #[error("it is damaged: its values do not match its checksum")]
    Checksum,
}

const CHUNK_NOTE: &str = "navwalker.chunk";
const DIGEST_NOTE: &str = "navwalker.sha256";

/// The result of a chunk as a file: its table, with the name of the chunk and a checksum of the values.
///
/// # Errors
/// Never for a table in memory.
pub fn write_chunk(format: TableFormat, name: &str, table: TypedColumns) -> io::Result<Vec<u8>> {
    let notes = [(CHUNK_NOTE, name.to_owned()), (DIGEST_NOTE, table.digest())];
    table_bytes(format, table, &notes)
}

/// The table in the result of a chunk.
///
/// # Errors
/// If it is not the result of the chunk of this name, whole and as it was written.
pub fn read_chunk(
    format: TableFormat,
    name: &str,
    bytes: Vec<u8>,
) -> Result<TypedColumns, ChunkError> {
    let (table, notes) =
        read_table(format, bytes).map_err(|reason| ChunkError::Damaged { reason })?;
    let note = |key: &str| {
        let found = notes.iter().find(|(one, _)| one == key);
        let missing = || ChunkError::Damaged {
            reason: "its end is missing".to_owned(),
        };
        found.map(|(_, value)| value.as_str()).ok_or_else(missing)
    };
    if note(CHUNK_NOTE)? != name {
        return Err(ChunkError::Other);
    }
    if note(DIGEST_NOTE)? != table.digest() {
        return Err(ChunkError::Checksum);
    }
    Ok(table)
}

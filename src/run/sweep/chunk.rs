//! A chunk, its name, and its result as a file that proves to be that of the chunk.

use super::designs::SweptDesign;
use super::format::{TableFormat, read_table, table_bytes};
use super::{SweepPlan, SweepSource};
use crate::keyword::Keyword;
use crate::run::checkpoint::{hex, hex_sha256};
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
    /// Its bytes are not those that were written.
    #[error("it is damaged: it does not match its checksum")]
    Checksum,
}

const CHUNK_NOTE: &str = "navwalker.chunk";
/// The SHA-256 of the file with zeros in place of its digits: both formats keep notes as plain text, so that it is checked
/// before anything is parsed.
const SEAL_NOTE: &str = "navwalker.sha256";
/// Hexadecimal digits of a SHA-256.
const SEAL_DIGITS: usize = 64;
/// Most bytes between the key of a note and its value.
const SEAL_DISTANCE: usize = 8;

/// The result of a chunk as a file: its table, with the name of the chunk and a checksum of the file.
///
/// # Errors
/// Never for a table in memory.
pub fn write_chunk(format: TableFormat, name: &str, table: TypedColumns) -> io::Result<Vec<u8>> {
    let notes = [
        (CHUNK_NOTE, name.to_owned()),
        (SEAL_NOTE, "0".repeat(SEAL_DIGITS)),
    ];
    let mut bytes = table_bytes(format, table, &notes)?;
    let seal = hex_sha256(&bytes);
    let place = seal_place(&bytes).ok_or_else(|| io::Error::other("no place for a checksum"))?;
    bytes[place..place + SEAL_DIGITS].copy_from_slice(seal.as_bytes());
    Ok(bytes)
}

/// Where the digits of the checksum begin.
fn seal_place(bytes: &[u8]) -> Option<usize> {
    let key = SEAL_NOTE.as_bytes();
    let at = bytes.windows(key.len()).rposition(|window| window == key)?;
    let after = at + key.len();
    let is_digit = |byte: &u8| matches!(byte, b'0'..=b'9' | b'a'..=b'f');
    (after..=after + SEAL_DISTANCE).find(|place| {
        let digits = bytes.get(*place..place + SEAL_DIGITS);
        digits.is_some_and(|digits| digits.iter().all(is_digit))
    })
}

/// Checks that a file is as it was written.
fn check_seal(bytes: &[u8]) -> Result<(), ChunkError> {
    let place = seal_place(bytes).ok_or_else(|| ChunkError::Damaged {
        reason: "its checksum is missing, so that it may be cut short".to_owned(),
    })?;
    let mut unsealed = bytes.to_vec();
    let digits = &mut unsealed[place..place + SEAL_DIGITS];
    let found = digits.to_vec();
    digits.fill(b'0');
    if hex_sha256(&unsealed).as_bytes() == found {
        return Ok(());
    }
    Err(ChunkError::Checksum)
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
    check_seal(&bytes)?;
    let (table, notes) =
        read_table(format, bytes).map_err(|reason| ChunkError::Damaged { reason })?;
    let mut own = notes.iter().filter(|(key, _)| key == CHUNK_NOTE);
    if own.next().is_none_or(|(_, found)| found != name) {
        return Err(ChunkError::Other);
    }
    Ok(table)
}

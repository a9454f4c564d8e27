//! The checkpoint of a run in two lines: the identity of the run and the state of the search. The records
//! of its steps are in a file of their own that only grows, since writing all of them at each step would
//! take time and space that grow with the square of the steps.

use super::VERSION;
use crate::optimize::{Record, Search};
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use thiserror::Error;

/// The identity of a run; only a run with the same identity continues or replaces it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Hash of the scenario.
    pub scenario_hash: String,
    /// Seed of the search.
    pub seed: u64,
    /// Version of the program.
    pub version: String,
    /// The constellations of a run without a search, by name: `polar = star:90:182/13/1@925`; with the SHA-256 of
    /// how files are read and of what is in them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub given: Vec<String>,
}

impl Identity {
    /// The identity of a run of `scenario` with this hash.
    #[must_use]
    pub fn of(scenario: &Scenario, hash: String) -> Self {
        Self {
            scenario_hash: hash,
            seed: scenario.optimizer.seed,
            version: VERSION.to_owned(),
            given: Vec::new(),
        }
    }

    /// The identity of a run of given constellations, named by what they are.
    #[must_use]
    pub fn of_given(self, given: Vec<String>) -> Self {
        Self { given, ..self }
    }

    /// The identity in a checkpoint, whose second line may be damaged.
    #[must_use]
    pub fn read(checkpoint: &str) -> Option<Self> {
        let header: CheckpointHeader = serde_json::from_str(checkpoint.lines().next()?).ok()?;
        Some(header.identity)
    }
}

/// The first line; the second is the state of the search as JSON.
#[derive(Debug, Serialize, Deserialize)]
struct CheckpointHeader {
    #[serde(flatten)]
    identity: Identity,
    /// SHA-256 of the second line, hex.
    sha256: String,
    /// Steps of the search; each has a line in the log.
    records: u64,
    /// SHA-256 of these lines, hex.
    records_sha256: String,
}

/// The log of a search, a line of JSON for each step: what is written of it so far.
#[derive(Debug, Clone, Default)]
pub struct RecordLog {
    records: usize,
    hash: Sha256,
}

impl RecordLog {
    /// The lines that the log lacks.
    ///
    /// # Errors
    /// Never for records in memory.
    pub fn extend(&mut self, records: &[Record]) -> serde_json::Result<String> {
        let mut lines = String::new();
        for record in records.get(self.records..).unwrap_or_default() {
            lines += &serde_json::to_string(record)?;
            lines.push('\n');
        }
        self.records = records.len();
        self.hash.update(&lines);
        Ok(lines)
    }

    fn sha256(&self) -> String {
        hex(&self.hash.clone().finalize())
    }
}

/// Why a checkpoint cannot be read.
#[derive(Debug, Error)]
pub enum CheckpointError {
    /// Not UTF-8.
    #[error("not UTF-8")]
    Text(#[source] std::str::Utf8Error),
    /// No second line.
    #[error("truncated")]
    Short,
    /// The first line.
    #[error("unreadable header")]
    Header(#[source] serde_json::Error),
    /// The checksum of the second line does not match.
    #[error("checksum mismatch")]
    Checksum,
    /// The second line.
    #[error("unreadable state")]
    State(#[source] serde_json::Error),
    /// The log has not the records of the checkpoint.
    #[error("the log of its steps is missing or does not match")]
    Log,
}

/// The text of a checkpoint, and the lines that the log of the search lacks.
///
/// # Errors
/// Never for a search in memory.
pub fn write(
    identity: &Identity,
    search: &mut Search,
    log: &mut RecordLog,
) -> serde_json::Result<(String, String)> {
    let records = std::mem::take(search.records_mut());
    let state = serde_json::to_string(search);
    let lines = log.extend(&records);
    *search.records_mut() = records;
    let (state, lines) = (state?, lines?);
    let header = CheckpointHeader {
        identity: identity.clone(),
        sha256: hex_sha256(state.as_bytes()),
        records: log.records as u64,
        records_sha256: log.sha256(),
    };
    let header = serde_json::to_string(&header)?;
    Ok((format!("{header}\n{state}\n"), lines))
}

/// Reads a checkpoint and the log beside it, which may go on beyond it.
///
/// # Errors
/// If they are not intact.
pub fn read(bytes: &[u8], log: &[u8]) -> Result<(Identity, Search), CheckpointError> {
    let text = str::from_utf8(bytes).map_err(CheckpointError::Text)?;
    let (header, state) = text.split_once('\n').ok_or(CheckpointError::Short)?;
    let header: CheckpointHeader = serde_json::from_str(header).map_err(CheckpointError::Header)?;
    let state = state.trim_end();
    if hex_sha256(state.as_bytes()) != header.sha256 {
        return Err(CheckpointError::Checksum);
    }
    let mut search: Search = serde_json::from_str(state).map_err(CheckpointError::State)?;
    *search.records_mut() = read_log(&header, log).ok_or(CheckpointError::Log)?;
    Ok((header.identity, search))
}

/// The records of a checkpoint, if the log has them.
fn read_log(header: &CheckpointHeader, log: &[u8]) -> Option<Vec<Record>> {
    let count = usize::try_from(header.records).ok()?;
    let mut hash = Sha256::new();
    let mut records = Vec::new();
    for line in log.split_inclusive(|byte| *byte == b'\n').take(count) {
        hash.update(line);
        records.push(serde_json::from_slice(line).ok()?);
    }
    let is_whole = records.len() == count && hex(&hash.finalize()) == header.records_sha256;
    is_whole.then_some(records)
}

/// SHA-256, hex.
pub(crate) fn hex_sha256(bytes: &[u8]) -> String {
    hex(&Sha256::digest(bytes))
}

/// Hex of some bytes.
pub(crate) fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spoiled_checkpoint_is_noticed() {
        let header = CheckpointHeader {
            identity: Identity {
                scenario_hash: "h".to_owned(),
                seed: 1,
                version: VERSION.to_owned(),
                given: Vec::new(),
            },
            sha256: hex_sha256(b"other"),
            records: 0,
            records_sha256: hex_sha256(b""),
        };
        let text = format!("{}\n{{}}\n", serde_json::to_string(&header).unwrap());
        let error = read(text.as_bytes(), b"").unwrap_err().to_string();
        assert_eq!(error, "checksum mismatch");
        assert!(read(b"", b"").is_err());
        let error = read(b"\xff\n{}", b"").unwrap_err().to_string();
        assert_eq!(error, "not UTF-8");
    }
}

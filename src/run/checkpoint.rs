//! The checkpoint of a run in two lines: the identity of the run and the state of the search.

use super::VERSION;
use crate::optimize::Search;
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
    /// The designs of a run without a search, by name: `polar = star:90:182/13/1@925`.
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

    /// The identity of a run of given designs, named by what they are.
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
}

/// The text of a checkpoint.
///
/// # Errors
/// Never for a search in memory.
pub fn write(identity: &Identity, search: &Search) -> serde_json::Result<String> {
    let state = serde_json::to_string(search)?;
    let header = CheckpointHeader {
        identity: identity.clone(),
        sha256: hex_sha256(state.as_bytes()),
    };
    Ok(format!("{}\n{state}\n", serde_json::to_string(&header)?))
}

/// Reads a checkpoint.
///
/// # Errors
/// If it is not intact.
pub fn read(bytes: &[u8]) -> Result<(Identity, Search), CheckpointError> {
    let text = str::from_utf8(bytes).map_err(CheckpointError::Text)?;
    let (header, state) = text.split_once('\n').ok_or(CheckpointError::Short)?;
    let header: CheckpointHeader = serde_json::from_str(header).map_err(CheckpointError::Header)?;
    let state = state.trim_end();
    if hex_sha256(state.as_bytes()) != header.sha256 {
        return Err(CheckpointError::Checksum);
    }
    let search = serde_json::from_str(state).map_err(CheckpointError::State)?;
    Ok((header.identity, search))
}

pub(super) fn hex_sha256(bytes: &[u8]) -> String {
    let sum = Sha256::digest(bytes);
    sum.iter().map(|byte| format!("{byte:02x}")).collect()
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
        };
        let text = format!("{}\n{{}}\n", serde_json::to_string(&header).unwrap());
        let error = read(text.as_bytes()).unwrap_err().to_string();
        assert_eq!(error, "checksum mismatch");
        assert!(read(b"").is_err());
        let error = read(b"\xff\n{}").unwrap_err().to_string();
        assert_eq!(error, "not UTF-8");
    }
}

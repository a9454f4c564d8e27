//! What a store lists: its chunks, and once it is merged its table.

use super::SweepPlan;
use csv::Writer;
use serde::{Deserialize, Serialize};
use std::io;

/// A chunk in the list of a store.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct ChunkEntry {
    /// The name of the chunk.
    pub name: String,
    /// Number of its designs.
    pub designs: u64,
}

/// The list of the chunks of a sweep as a table, in their order.
///
/// # Errors
/// Never for a list in memory.
pub fn chunks_csv(chunks: &[ChunkEntry]) -> io::Result<String> {
    let mut writer = Writer::from_writer(Vec::new());
    writer.write_record(["name", "designs"])?;
    for one in chunks {
        writer.write_record([one.name.clone(), one.designs.to_string()])?;
    }
    crate::run::tables::text(writer)
}

/// The chunks in such a table.
///
/// # Errors
/// If it is none.
pub fn read_chunks(bytes: &[u8]) -> Result<Vec<ChunkEntry>, csv::Error> {
    csv::Reader::from_reader(bytes).deserialize().collect()
}

/// The index of a merged sweep, which a reader needs to trust its table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepIndex {
    /// The hash of the scenario without its optimiser.
    pub scenario_hash: String,
    /// Version of the program.
    pub version: String,
    /// Number of designs, the rows of the table.
    pub designs: u64,
    /// Designs without metrics: they cannot be propagated.
    pub without_metrics: u64,
    /// The merged table.
    pub table: String,
    /// SHA-256 of the merged table, hex.
    pub sha256: String,
    /// The chunks, in the order of the table.
    pub chunks: Vec<IndexedChunk>,
}

/// A chunk in the index.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct IndexedChunk {
    /// The name of the chunk.
    pub name: String,
    /// Number of its designs.
    pub designs: u64,
    /// SHA-256 of its result, hex.
    pub sha256: String,
}

impl SweepIndex {
    /// The index of a sweep of these chunks, whose table is written.
    #[must_use]
    pub fn new(
        plan: &SweepPlan,
        chunks: Vec<IndexedChunk>,
        without_metrics: u64,
        sha256: String,
    ) -> Self {
        Self {
            scenario_hash: plan.scenario.hash.clone(),
            version: plan.version.clone(),
            designs: chunks.iter().map(|one| one.designs).sum(),
            without_metrics,
            table: plan.table(),
            sha256,
            chunks,
        }
    }
}

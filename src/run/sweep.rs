//! A sweep: every design of a space or a list evaluated, every metric kept, in chunks that can be computed anywhere.
//!
//! A chunk is a scenario, a version and some designs; its name is the SHA-256 of these, its result a file of that name. So
//! chunks can be repeated, resumed, merged and audited, and the merged table does not depend on where they were computed.

mod chunk;
mod designs;
mod evaluator;
mod format;
mod index;
mod parquet;

pub use chunk::{ChunkError, SweepChunk, read_chunk, write_chunk};
pub use designs::{SweepDesigns, SweptDesign, designs_csv, read_designs};
pub use evaluator::SweepEvaluator;
pub use format::{TableFormat, TableWriter};
pub use index::{ChunkEntry, IndexedChunk, SweepIndex, chunks_csv, read_chunks};

use super::checkpoint::hex_sha256;
use super::{ScenarioStamp, VERSION};
use crate::evaluate::Setup;
use crate::keyword::{Keyword, keywords};
use crate::optimize::OptimizeError;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// What a store is a sweep of.
pub const SWEEP_JSON: &str = "sweep.json";
/// The names of its chunks, with their places in the sweep.
pub const CHUNKS_CSV: &str = "chunks.csv";
/// The designs of a list.
pub const DESIGNS_CSV: &str = "designs.csv";
/// The directory of the results of its chunks.
pub const CHUNKS: &str = "chunks";
/// The index of a merged sweep.
pub const INDEX_JSON: &str = "index.json";

/// Time of a chunk on one thread that its size aims at, seconds.
const CHUNK_S: f64 = 3.0;
/// Times of evaluation on a processor with AVX-512, rounded: they need not be right on another, only the same.
///
/// Time of a sample without LEO satellites, seconds.
const SAMPLE_S: f64 = 10e-9;
/// Time that each satellite adds to a sample, seconds.
const SATELLITE_S: f64 = 60e-12;
/// Time of the position of a satellite at an instant, and of its selection by the tiles, seconds.
const POSITION_S: f64 = 4e-9;
/// Time of a design beside its samples, its row of the table included, seconds.
const DESIGN_S: f64 = 0.1e-3;

keywords! {
    /// Where the designs of a sweep come from.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    SweepSource {
        /// The search space of the scenario, on the steps of its grid.
        Space = "space",
        /// A list.
        List = "list",
    }
}

/// How many samples an evaluation has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleShape {
    /// Ground points.
    pub points: usize,
    /// Instants.
    pub instants: usize,
}

impl From<&Setup> for SampleShape {
    fn from(setup: &Setup) -> Self {
        Self {
            points: setup.sites.len(),
            instants: setup.grid.len(),
        }
    }
}

/// What a store is a sweep of: the content of [`SWEEP_JSON`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SweepPlan {
    /// The study; its hash leaves out the optimiser and its seed, on which no metric depends.
    pub scenario: ScenarioStamp,
    /// Version of the program.
    pub version: String,
    /// Where the designs come from.
    pub source: SweepSource,
    /// The format of chunks and of the merged table.
    pub format: TableFormat,
    /// Points of the grid, or designs of the list.
    pub points: u64,
    /// Points in a chunk.
    pub chunk: u64,
    /// SHA-256 of [`DESIGNS_CSV`], hex; `None` for a space.
    pub designs_sha256: Option<String>,
}

impl SweepPlan {
    /// The plan of a sweep of these designs, over these samples: in chunks of so many points if that is given, or else
    /// of [`chunk_size`].
    ///
    /// # Errors
    /// If there are more than 2^53 points, or one is repaired to what is not in the space.
    pub fn new(
        scenario: ScenarioStamp,
        designs: &SweepDesigns<'_>,
        format: TableFormat,
        (chunk, samples): (Option<u64>, SampleShape),
    ) -> Result<Self, OptimizeError> {
        let mean = designs.mean_satellites()?;
        let (source, designs_sha256) = match designs {
            SweepDesigns::Space { .. } => (SweepSource::Space, None),
            SweepDesigns::List(list) => {
                let text = designs_csv(list).unwrap_or_default();
                (SweepSource::List, Some(hex_sha256(text.as_bytes())))
            }
        };
        Ok(Self {
            scenario,
            version: VERSION.to_owned(),
            source,
            format,
            points: designs.points()?,
            chunk: chunk.unwrap_or_else(|| chunk_size(samples, mean)),
            designs_sha256,
        })
    }

    /// Number of chunks.
    #[must_use]
    pub fn chunks(&self) -> u64 {
        self.points.div_ceil(self.chunk.max(1))
    }

    /// The points of a chunk, by its number from 0.
    #[must_use]
    pub fn points_of(&self, chunk: u64) -> Range<u64> {
        let end = (chunk + 1).saturating_mul(self.chunk).min(self.points);
        chunk * self.chunk..end
    }

    /// The name of the merged table.
    #[must_use]
    pub fn table(&self) -> String {
        format!("table.{}", self.format.keyword())
    }

    /// The path of the result of a chunk in the store.
    #[must_use]
    pub fn chunk_path(&self, name: &str) -> String {
        format!("{CHUNKS}/{name}.{}", self.format.keyword())
    }

    /// What differs in `other`, in words, if anything.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let told = |what: &str, theirs: &dyn std::fmt::Display, ours: &dyn std::fmt::Display| {
            Some(format!("{what} is {theirs} there and {ours} here"))
        };
        if self.version != other.version {
            return told("the version", &self.version, &other.version);
        }
        if self.scenario.hash != other.scenario.hash {
            return Some("the scenario is another".to_owned());
        }
        if self.source != other.source || self.designs_sha256 != other.designs_sha256 {
            return Some("the designs are others".to_owned());
        }
        if self.format != other.format {
            return told("--as", &self.format, &other.format);
        }
        (self.chunk != other.chunk)
            .then(|| told("--chunk", &self.chunk, &other.chunk))
            .flatten()
    }
}

/// Designs in a chunk by a fixed model of the cost, so that every machine makes the same chunks: some seconds on one
/// thread for designs of so many samples and, on average, satellites.
#[must_use]
pub fn chunk_size(samples: SampleShape, mean_satellites: f64) -> u64 {
    let designs = CHUNK_S / sweep_time_s(1.0, samples, mean_satellites);
    designs.round().max(1.0) as u64
}

/// Time of all designs on one thread by the same model, seconds.
#[must_use]
pub fn sweep_time_s(designs: f64, samples: SampleShape, mean_satellites: f64) -> f64 {
    let instants = samples.instants as f64;
    let at_instant_s = samples.points as f64 * (SAMPLE_S + SATELLITE_S * mean_satellites)
        + POSITION_S * mean_satellites;
    designs * (DESIGN_S + instants * at_instant_s)
}

#[cfg(test)]
mod tests;

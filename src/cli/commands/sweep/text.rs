//! What `sweep` prints.

use crate::cli::args::OutputFormat;
use crate::cli::sweep_store::{ChunkState, SweepStore};
use crate::run::sweep::{SweepIndex, SweepPlan};
use crate::units::counted;
use anyhow::Result;
use serde::Serialize;

/// Chunks that are named in a text.
const MOST_NAMED: usize = 10;

/// How far a sweep is.
#[derive(Debug, Serialize)]
pub(super) struct SweepStatus<'a> {
    #[serde(flatten)]
    plan: &'a SweepPlan,
    /// Number of its designs.
    designs: u64,
    chunks: usize,
    done: usize,
    /// The chunks that are missing, by number from 1.
    missing: Vec<usize>,
    /// The chunks whose results cannot be used.
    damaged: Vec<DamagedChunk>,
    #[serde(skip)]
    states: &'a [ChunkState],
    #[serde(skip)]
    store: &'a SweepStore,
}

#[derive(Debug, Serialize)]
struct DamagedChunk {
    chunk: usize,
    reason: String,
}

impl<'a> SweepStatus<'a> {
    pub(super) fn of(store: &'a SweepStore, states: &'a [ChunkState]) -> Self {
        let numbered = || (1..).zip(states);
        let missing = numbered().filter(|(_, state)| **state == ChunkState::Missing);
        let damaged = numbered().filter_map(|(chunk, state)| match state {
            ChunkState::Damaged(reason) => Some(DamagedChunk {
                chunk,
                reason: reason.clone(),
            }),
            _ => None,
        });
        let done = states.iter().filter(|state| **state == ChunkState::Done);
        Self {
            plan: store.plan(),
            designs: store.chunks().iter().map(|chunk| chunk.designs).sum(),
            chunks: states.len(),
            done: done.count(),
            missing: missing.map(|(chunk, _)| chunk).collect(),
            damaged: damaged.collect(),
            states,
            store,
        }
    }

    pub(super) fn shown(&self, format: OutputFormat) -> Result<String> {
        Ok(match format {
            OutputFormat::Json => crate::printable::json(self)?,
            OutputFormat::Csv => self.csv(),
            OutputFormat::Text => self.text(),
        })
    }

    fn text(&self) -> String {
        let mut text = heading(self.plan, self.designs, self.chunks);
        text += &format!("done     {}\n", self.done);
        if !self.missing.is_empty() {
            text += &format!("missing  {}\n", named(&self.missing));
        }
        for one in self.damaged.iter().take(MOST_NAMED) {
            text += &format!("damaged  {}: {}\n", one.chunk, one.reason);
        }
        if self.damaged.len() > MOST_NAMED {
            text += &format!("damaged  {} in all\n", self.damaged.len());
        }
        text
    }

    fn csv(&self) -> String {
        let mut text = "chunk,name,designs,state\n".to_owned();
        let chunks = self.store.chunks().iter();
        for ((number, chunk), state) in (1..).zip(chunks).zip(self.states) {
            let state = match state {
                ChunkState::Done => "done",
                ChunkState::Missing => "missing",
                ChunkState::Damaged(_) => "damaged",
            };
            text += &format!("{number},{},{},{state}\n", chunk.name, chunk.designs);
        }
        text
    }
}

fn heading(plan: &SweepPlan, designs: u64, chunks: usize) -> String {
    let designs = counted(usize::try_from(designs).unwrap_or(usize::MAX), "design");
    format!(
        "Sweep of scenario {}: {designs} of the {} in {}\n\n",
        plan.scenario.name,
        plan.source,
        counted(chunks, "chunk")
    )
}

/// Numbers in runs: `3, 5-8`.
fn named(numbers: &[usize]) -> String {
    let runs = numbers.chunk_by(|a, b| a + 1 == *b);
    let shown = runs.map(|run| match run {
        [one] => one.to_string(),
        [first, .., last] => format!("{first}-{last}"),
        [] => String::new(),
    });
    let shown: Vec<String> = shown.collect();
    let some = &shown[..shown.len().min(MOST_NAMED)];
    let more = if shown.len() > MOST_NAMED {
        ", …"
    } else {
        ""
    };
    format!("{} ({}{more})", numbers.len(), some.join(", "))
}

/// The result of a merged sweep.
pub(super) fn merged(
    store: &SweepStore,
    index: &SweepIndex,
    format: OutputFormat,
) -> Result<String> {
    Ok(match format {
        OutputFormat::Json => crate::printable::json(index)?,
        OutputFormat::Csv => {
            let mut text = "chunk,name,designs,sha256\n".to_owned();
            for (number, chunk) in (1..).zip(&index.chunks) {
                let (name, designs, sha256) = (&chunk.name, chunk.designs, &chunk.sha256);
                text += &format!("{number},{name},{designs},{sha256}\n");
            }
            text
        }
        OutputFormat::Text => {
            let mut text = heading(store.plan(), index.designs, index.chunks.len());
            text += &format!("table    {}\n", index.table);
            text += &format!("rows     {}\n", index.designs);
            if index.without_metrics > 0 {
                text += &format!(
                    "         {} without metrics: they cannot be propagated\n",
                    index.without_metrics
                );
            }
            text += &format!("SHA-256  {}\n", index.sha256);
            text
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_chunks_are_told_in_runs() {
        assert_eq!(named(&[3]), "1 (3)");
        assert_eq!(named(&[1, 2, 3, 7, 9, 10]), "6 (1-3, 7, 9-10)");
        let odd: Vec<usize> = (0..30).map(|n| 2 * n + 1).collect();
        assert!(named(&odd).ends_with("19, …)"), "{}", named(&odd));
    }
}

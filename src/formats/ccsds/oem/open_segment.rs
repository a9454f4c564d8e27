//! A segment while it is read, in both notations.

use super::{Segment, SegmentMetadata, StateLine};
use crate::formats::kept_states::{KeptStates, StateKeeper};
use crate::formats::trajectory::time_system_of_name;
use crate::time::Epoch;
use chrono::NaiveDateTime;

/// Says which states of the satellite of a segment are kept.
pub type SegmentChoice<'a> = &'a dyn Fn(&SegmentMetadata) -> KeptStates<Epoch>;

/// A segment whose lines are being read.
pub(super) struct OpenSegment {
    pub(super) segment: Segment,
    keeper: StateKeeper<NaiveDateTime>,
}

impl OpenSegment {
    pub(super) fn new(metadata: SegmentMetadata, choice: SegmentChoice<'_>) -> Self {
        // Without a known time system the file is refused.
        let kept = match time_system_of_name(&metadata.time_system) {
            Ok(system) => choice(&metadata).map(|at| system.stamp(at)),
            Err(_) => KeptStates::All,
        };
        Self {
            keeper: StateKeeper::new(kept),
            segment: Segment {
                metadata,
                comments: Vec::new(),
                states: Vec::new(),
            },
        }
    }

    /// Adds a line that follows the rules.
    pub(super) fn push(&mut self, line: StateLine) {
        self.keeper.push(&mut self.segment.states, line.epoch, line);
    }
}

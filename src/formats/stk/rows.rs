//! The rows of a table while they are read: what is checked of all of them, and those that are kept.

use super::{is_boundary, segment_end};
use crate::ephemeris::derivative::velocity_fault;
use crate::formats::kept_states::{KeptStates, StateKeeper};
use crate::frames::{Frame, State};
use crate::time::Epoch;

/// Shortest time between rows, s: instants are held, and written, to a nanosecond.
const LEAST_STEP_S: f64 = 1e-9;

/// Number of rows, the first ones, whose velocities are compared with the derivative of the positions.
const PROBED: usize = 512;

/// A row: seconds since the scenario epoch, and the state.
type StkRow = (f64, State<Frame>);

/// The rows so far.
pub(super) struct StkRows {
    keeper: StateKeeper<f64>,
    kept: Vec<StkRow>,
    count: usize,
    /// The time of the last row, and whether the row before has the same.
    last_s: Option<(f64, bool)>,
    probe: Vec<StkRow>,
    segments: Vec<StkSegment>,
    /// The segment that the last row belongs to.
    open: Option<StkSegment>,
}

/// A run of rows across which nothing ends.
#[derive(Debug, Clone, Copy)]
pub(super) struct StkSegment {
    /// Times of the first and the last row, s.
    pub(super) span_s: (f64, f64),
    /// Number of rows.
    pub(super) rows: usize,
}

impl StkRows {
    pub(super) fn new(kept: KeptStates<f64>) -> Self {
        Self {
            keeper: StateKeeper::new(kept),
            kept: Vec::new(),
            count: 0,
            last_s: None,
            probe: Vec::new(),
            segments: Vec::new(),
            open: None,
        }
    }

    /// Whether a row may have this time: it is after that of the row before, also as an instant, or the same once, at a
    /// boundary.
    pub(super) fn may_be_at(
        &self,
        elapsed_s: f64,
        epoch: Option<Epoch>,
        boundaries_s: &[f64],
    ) -> bool {
        let Some((last_s, is_repeated)) = self.last_s else {
            return true;
        };
        if elapsed_s == last_s {
            return !is_repeated && is_boundary(boundaries_s, elapsed_s);
        }
        // Instants end some hundred thousand years away.
        let is_other = |epoch: Epoch| epoch.plus_seconds(elapsed_s) > epoch.plus_seconds(last_s);
        elapsed_s - last_s >= LEAST_STEP_S && epoch.is_none_or(is_other)
    }

    /// Adds a row that may follow.
    pub(super) fn push(&mut self, (elapsed_s, state): StkRow, boundaries_s: &[f64]) {
        self.settle(Some(elapsed_s), boundaries_s);
        let is_repeated = self.last_s.is_some_and(|(last_s, _)| last_s == elapsed_s);
        self.last_s = Some((elapsed_s, is_repeated));
        let open = self.open.get_or_insert(StkSegment {
            span_s: (elapsed_s, elapsed_s),
            rows: 0,
        });
        open.span_s.1 = elapsed_s;
        open.rows += 1;
        self.count += 1;
        if self.probe.len() < PROBED {
            self.probe.push((elapsed_s, state));
        }
        self.keeper
            .push(&mut self.kept, elapsed_s, (elapsed_s, state));
    }

    /// Ends the segment of the last row, once the time of the next one is known, if it ends there.
    fn settle(&mut self, next_s: Option<f64>, boundaries_s: &[f64]) {
        let (Some((last_s, _)), Some(open)) = (self.last_s, self.open) else {
            return;
        };
        let shared = match next_s {
            Some(next_s) => segment_end(boundaries_s, last_s, next_s, open.rows == 1),
            None => Some(false),
        };
        if let Some(is_shared) = shared {
            self.segments.push(open);
            self.open = is_shared.then_some(StkSegment {
                span_s: (last_s, last_s),
                rows: 1,
            });
        }
    }

    /// Number of rows.
    pub(super) fn count(&self) -> usize {
        self.count
    }

    /// How the velocities differ from the derivative of the positions, if they do.
    pub(super) fn velocity_fault(&self, epoch: Epoch) -> Option<String> {
        velocity_fault(self.probe.len(), |place| {
            let (elapsed_s, state) = self.probe[place];
            let at = epoch.plus_seconds(elapsed_s);
            (at, state.position_km, state.velocity_km_s)
        })
    }

    /// The segments, and the rows that are kept.
    pub(super) fn finish(mut self) -> (Vec<StkSegment>, Vec<StkRow>) {
        self.settle(None, &[]);
        (self.segments, self.kept)
    }
}

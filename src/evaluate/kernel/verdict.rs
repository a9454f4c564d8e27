//! What f32 says of the samples of a tile, and where it does not decide.

use super::lanes::{LANES, Lanes, Sums};
use super::limits::Limits;
use super::normal::{FixedTile, NormalLanes, ZERO};
use super::sample::{POSITION_STATES, UNSOLVED};
use super::weighting::Weighting;

/// The LEO satellites at the points of a tile.
pub(super) struct LeoLanes<'a> {
    /// Those that are visible, and that may be.
    pub(super) count: &'a Lanes<u32>,
    pub(super) possible: &'a Lanes<u32>,
    /// [`Sums::rounded`].
    pub(super) rounded: &'a Lanes<f32>,
}

/// What is summed at the points of a tile where the satellites have several clocks.
pub(super) struct ClockSums {
    pub(super) system: NormalLanes<f32>,
    count: Lanes<u32>,
    possible: Lanes<u32>,
    rounded: Lanes<f32>,
}

impl ClockSums {
    /// The GNSS part alone.
    #[inline(always)]
    pub(super) fn of_fixed(fixed: &FixedTile<'_>) -> Self {
        Self {
            system: NormalLanes::of_fixed(fixed),
            count: Lanes([0; LANES]),
            possible: Lanes([0; LANES]),
            rounded: ZERO,
        }
    }

    /// Adds the satellites of one of several clocks.
    #[inline(always)]
    pub(super) fn add_clock<W: Weighting>(&mut self, sums: &Sums<f32>) {
        self.system.add_clock::<W>(sums);
        for l in 0..LANES {
            self.count.0[l] += sums.count.0[l];
            self.possible.0[l] += sums.possible.0[l];
            self.rounded.0[l] += sums.rounded::<W>(l);
        }
    }

    #[inline(always)]
    pub(super) fn leo(&self) -> LeoLanes<'_> {
        LeoLanes {
            count: &self.count,
            possible: &self.possible,
            rounded: &self.rounded,
        }
    }
}

/// The outcome in f32 at the points of a tile; flags are 0 or 1.
pub(super) struct LaneVerdict {
    pub(super) pdop: Lanes<f32>,
    /// Too close to the mask for f32.
    pub(super) doubtful: Lanes<u32>,
    /// PDOP too large for f32, or too close to a threshold.
    pub(super) coarse: Lanes<u32>,
}

impl LaneVerdict {
    #[inline(always)]
    pub(super) fn new(system: &NormalLanes<f32>, leo: &LeoLanes<'_>, limits: &Limits) -> Self {
        let single = system.pdop();
        let zero = Lanes([0; LANES]);
        let mut verdict = Self {
            pdop: Lanes([UNSOLVED; LANES]),
            doubtful: zero,
            coarse: zero,
        };
        for l in 0..LANES {
            let pdop = single.0[l];
            let sure = u32::from(leo.possible.0[l] == leo.count.0[l]);
            let counted = u32::from(system.surplus.0[l] >= POSITION_STATES);
            let condition = Limits::condition(pdop, leo.rounded.0[l], system.trace(l));
            let fine = u32::from(limits.holds_in_single(pdop, condition));
            verdict.pdop.0[l] = if counted != 0 { pdop } else { UNSOLVED };
            verdict.doubtful.0[l] = 1 - sure;
            verdict.coarse.0[l] = counted & (1 - fine) & sure;
        }
        verdict
    }
}

//! What the samples that stay solved come to without each set of satellites, where the samples themselves are not wanted.
//!
//! A satellite that is lost makes PDOP no smaller. So the largest PDOP and the weight of the samples that are no longer
//! available tell the worst, and neither needs a root or a list. The others, which few are, are kept as they are.

use super::downdate::LossLimits;
use super::{LANES, Lanes, WholeSample, joined, lanes_of};

/// What some samples come to that stay solved without a set of satellites.
#[derive(Debug, Clone)]
pub(in crate::evaluate) struct LossTally {
    /// Weight of those that are no longer available.
    pub(in crate::evaluate) unavailable: u64,
    largest_square: Lanes<f64>,
}

impl LossTally {
    pub(in crate::evaluate) const NOTHING: Self = Self {
        unavailable: 0,
        largest_square: Lanes([0.0; LANES]),
    };

    /// The largest PDOP; 0 if there is none.
    pub(in crate::evaluate) fn largest(&self) -> f64 {
        self.largest_square.0.into_iter().fold(0.0, f64::max).sqrt()
    }
}

/// A tile of which the samples with all satellites are known.
pub(super) struct BegunTile {
    pub(super) number: usize,
    /// Place of its first sample within the piece.
    pub(super) first: u32,
    /// A bit for each point whose satellites in view are known.
    pub(super) sure: u32,
    /// The same bit in the lanes of those of these that are solved, and for those that are available.
    known: Lanes<u32>,
    available: u32,
    weights: Lanes<u64>,
}

impl BegunTile {
    #[inline(always)]
    pub(super) fn new(number: usize, first: u32, sure: u32, weights: Lanes<u64>) -> Self {
        Self {
            number,
            first,
            sure,
            known: Lanes([0; LANES]),
            available: 0,
            weights,
        }
    }

    /// Takes note of the samples with all satellites, of which those that are not yet decided are NaN.
    #[inline(always)]
    pub(super) fn know(&mut self, whole: &[WholeSample], limits: &LossLimits) {
        for l in lanes_of(self.sure) {
            let pdop = whole[l].pdop;
            let is_solved = pdop < f64::INFINITY;
            self.known.0[l] = u32::from(is_solved) << l;
            self.available |= u32::from(is_solved & limits.is_available(pdop * pdop)) << l;
        }
    }
}

impl LossTally {
    /// Takes the points of a tile that are solved with the set and without it, and returns them.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        squares: &Lanes<f64>,
        seen: u32,
        begun: &BegunTile,
        limits: &LossLimits,
    ) -> u32 {
        let (mut solved, mut available) = (Lanes([0; LANES]), Lanes([0; LANES]));
        for l in 0..LANES {
            let known = begun.known.0[l] & seen;
            let square = if known != 0 { squares.0[l] } else { 0.0 };
            let is_solved = square > 0.0;
            solved.0[l] = if is_solved { known } else { 0 };
            available.0[l] = if is_solved & limits.is_available(square) {
                known
            } else {
                0
            };
            let largest = self.largest_square.0[l];
            self.largest_square.0[l] = if square > largest { square } else { largest };
        }
        let (solved, available) = (joined(&solved), joined(&available));
        for l in lanes_of(solved & begun.available & !available) {
            self.unavailable += begun.weights.0[l];
        }
        solved
    }
}

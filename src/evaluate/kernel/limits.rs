//! The thresholds of PDOP, and where the lanes decide about them.

use super::super::counts::Threshold;
use super::weighting::{UnitWeights, Weighting};
use crate::dop::pivot_floor;

/// The thresholds of PDOP, and how close to them f32 and f64 can decide.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Where f32 is trusted.
    pub(super) single: SingleLimits,
    /// PDOP above which a sample is unsolved.
    pub(super) cap: f64,
    /// PDOP up to which a sample is available.
    pub(super) available: Threshold,
    /// Maximum number of clock states.
    pub(super) clocks: u32,
}

/// Where f32 is trusted; PDOP that none of these admits is recomputed in f64.
#[derive(Debug, Clone, Copy)]
pub(super) struct SingleLimits {
    /// PDOP up to which it is, however many satellites there are.
    pub(super) below: f32,
    /// Condition up to which it is above that ([`Limits::condition`]).
    pub(super) condition: f32,
    /// PDOP up to which it is at all.
    pub(super) largest: f32,
}

impl SingleLimits {
    /// Nowhere.
    pub(super) const NONE: Self = Self {
        below: 0.0,
        condition: 0.0,
        largest: 0.0,
    };

    /// As far as the weights allow, and where a sample is surely solved.
    pub(super) fn new<W: Weighting>(cap: f64) -> Self {
        Self {
            below: W::SINGLE_BELOW,
            condition: W::SINGLE_CONDITION,
            largest: cap as f32 * 0.999,
        }
    }
}

impl Limits {
    /// Relative distance from a threshold within which f32 does not decide.
    const BAND: f32 = 1e-5;

    /// Relative distance from a threshold within which f64 lanes do not decide, in addition to the
    /// change of PDOP if the normal matrix is off by one pivot floor.
    const DOUBLE_BAND: f64 = 1e-6;

    /// PDOP up to which f32 is trusted, with unit weights and lines of sight that are short of nothing.
    const WELL_ABOVE: f32 = UnitWeights::SINGLE_BELOW;

    /// Where lines of sight allow f32 up to a PDOP, and in this proportion for any condition.
    #[inline(always)]
    pub(super) fn capped(self, single_below: f32) -> Self {
        let share = (single_below / Self::WELL_ABOVE).min(1.0);
        let single = SingleLimits {
            below: self.single.below.min(single_below),
            condition: self.single.condition * (share * share),
            ..self.single
        };
        Self { single, ..self }
    }

    /// How much a rounding of the sums, and of what comes of them, may change the square of PDOP: A is rounded in what was
    /// summed and in itself, and tr A⁻¹ changes by at most tr A⁻¹ times that.
    #[inline(always)]
    pub(super) fn condition(pdop: f32, rounded: f32, trace: f32) -> f32 {
        (rounded + 0.5 * trace) * (pdop * pdop)
    }

    #[inline(always)]
    pub(super) fn holds_in_single(&self, pdop: f32, condition: f32) -> bool {
        let (single, available) = (&self.single, self.available.single());
        let is_fine = (pdop <= single.below) | (condition <= single.condition);
        is_fine & (pdop <= single.largest) & ((pdop - available).abs() > available * Self::BAND)
    }

    /// Whether the sums of the lanes, or others of the same accuracy, decide a sample with this finite
    /// PDOP. Otherwise the sums of the plain path do, so that all paths decide alike.
    #[inline(always)]
    pub(super) fn decides(&self, pdop: f64, satellites: u32) -> bool {
        let floor = pivot_floor(f64::from(satellites));
        let is_apart = |threshold: f64| {
            let band = Self::DOUBLE_BAND + floor * threshold * threshold;
            (pdop - threshold).abs() > threshold * band
        };
        is_apart(self.cap) && is_apart(self.available.0)
    }
}

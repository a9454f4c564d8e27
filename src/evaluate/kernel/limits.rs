//! The thresholds of PDOP, and where the lanes decide about them.

use super::super::counts::Threshold;
use super::lanes::Weighting;
use crate::dop::pivot_floor;

/// The thresholds of PDOP, and how close to them f32 and f64 can decide.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// PDOP above this is recomputed in f64.
    pub(super) single_below: f32,
    /// PDOP above which a sample is unsolved.
    pub(super) cap: f64,
    /// PDOP up to which a sample is available.
    pub(super) available: Threshold,
    /// Maximum number of clock states.
    pub(super) clocks: u32,
}

impl Limits {
    /// Relative distance from a threshold within which f32 does not decide.
    const BAND: f32 = 1e-5;

    /// Relative distance from a threshold within which f64 lanes do not decide, in addition to the
    /// change of PDOP if the normal matrix is off by one pivot floor.
    const DOUBLE_BAND: f64 = 1e-6;

    #[inline(always)]
    pub(super) fn capped<W: Weighting>(self, single_below: f32) -> Self {
        Self {
            single_below: self.single_below.min(single_below) * W::SINGLE_SHARE,
            ..self
        }
    }

    #[inline(always)]
    pub(super) fn holds_in_single(&self, pdop: f32) -> bool {
        let available = self.available.single();
        (pdop <= self.single_below) & ((pdop - available).abs() > available * Self::BAND)
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

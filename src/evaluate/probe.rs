//! A part of the samples of a constellation, for a search that ends an evaluation as soon as it knows enough.

use super::{Evaluator, SampleTile, SampleTiles, fixed};
use crate::ephemeris::{Ephemeris, EphemerisError};
use std::ops::ControlFlow;

impl Evaluator {
    /// How the fast path divides the samples; `None` for a setup that only the plain path supports, which knows no
    /// tiles.
    #[must_use]
    pub fn sample_tiles(&self) -> Option<SampleTiles> {
        Some(self.kernel.sample_tiles())
    }

    /// Passes the samples of some tiles (in ascending order) at each of some instants to `see` until it breaks.
    /// They are those of an evaluation of all samples, bit for bit.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn probe<'t>(
        &self,
        ephemeris: &Ephemeris,
        instants: impl Iterator<Item = (usize, &'t [u32])>,
        see: impl FnMut(SampleTile<'_>) -> ControlFlow<()>,
    ) -> Result<(), EphemerisError> {
        self.kernel.probe(ephemeris, instants, see)
    }

    /// GNSS satellites of the setup, in view or not.
    #[must_use]
    pub fn gnss_satellites(&self) -> usize {
        let systems = fixed::systems(&self.setup);
        systems.iter().map(|system| system.satellites().len()).sum()
    }
}

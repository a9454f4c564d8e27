//! The LEO satellites at one instant, by the clocks that they share.

use super::Setup;
use super::fixed::PlainPositions;
use crate::dop::{Clocks, LeoClocks};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::frames::EarthRotation;

impl Setup {
    /// What is computed sample by sample by the plain path beside or in place of the lanes, in a sentence; `None` if
    /// nothing is.
    #[must_use]
    pub fn plain_path_note(&self) -> Option<String> {
        let parts = [
            (
                self.window_s.is_some(),
                "the PDOP of windows (metrics.window-min)",
            ),
            (
                self.may_have_several_leo_clocks(),
                "several LEO clocks (gnss.leo-clocks)",
            ),
        ];
        let slow = parts.into_iter().filter(|(is_asked, _)| *is_asked);
        let slow: Vec<&str> = slow.map(|(_, what)| what).collect();
        (!slow.is_empty()).then(|| {
            format!(
                "note: computed sample by sample, which takes longer: {}",
                slow.join(", ")
            )
        })
    }

    /// Whether a constellation of several parts has several LEO clocks.
    pub(super) fn may_have_several_leo_clocks(&self) -> bool {
        self.leo_clocks == LeoClocks::PerPart && self.clocks == Clocks::PerSystem
    }

    /// Whether the satellites have more than one LEO clock. With one clock for all systems they have none of
    /// their own.
    #[must_use]
    pub fn has_several_leo_clocks(&self, ephemeris: &Ephemeris) -> bool {
        self.may_have_several_leo_clocks() && ephemeris.part_count() > 1
    }
}

/// Fills `clocks` with the Earth-fixed positions of the satellites that have one at an instant, clock by clock. There is
/// always one clock, even of no satellites.
pub(super) fn positions(
    setup: &Setup,
    ephemeris: &Ephemeris,
    elapsed_s: f64,
    rotation: EarthRotation,
    clocks: &mut Vec<PlainPositions>,
) -> Result<(), EphemerisError> {
    let several = setup.has_several_leo_clocks(ephemeris);
    let count = if several { ephemeris.part_count() } else { 1 };
    clocks.resize_with(count, Vec::new);
    clocks.iter_mut().for_each(Vec::clear);
    for (satellite, &part) in ephemeris.satellites().iter().zip(ephemeris.parts()) {
        if let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? {
            let clock = if several { part } else { 0 };
            clocks[clock].push(rotation.to_earth_fixed(state.position_km));
        }
    }
    Ok(())
}

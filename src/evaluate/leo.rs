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
        let parts = [(
            self.may_have_several_leo_clocks() && self.metrics.asks_for_n1,
            "the loss of satellites with several LEO clocks (gnss.leo-clocks)",
        )];
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

/// How many clocks the satellites have: at least one, even of no satellites.
pub(super) fn clock_count(setup: &Setup, ephemeris: &Ephemeris) -> usize {
    if setup.has_several_leo_clocks(ephemeris) {
        ephemeris.part_count()
    } else {
        1
    }
}

/// No position yet of any clock.
pub(super) fn no_positions(setup: &Setup, ephemeris: &Ephemeris) -> Vec<PlainPositions> {
    vec![Vec::new(); clock_count(setup, ephemeris)]
}

/// Fills `clocks` with the Earth-fixed positions of the satellites that have one at an instant, clock by clock.
pub(super) fn positions(
    setup: &Setup,
    ephemeris: &Ephemeris,
    elapsed_s: f64,
    rotation: EarthRotation,
    clocks: &mut Vec<PlainPositions>,
) -> Result<(), EphemerisError> {
    let several = setup.has_several_leo_clocks(ephemeris);
    clocks.resize_with(clock_count(setup, ephemeris), Vec::new);
    clocks.iter_mut().for_each(Vec::clear);
    for (satellite, &part) in ephemeris.satellites().iter().zip(ephemeris.parts()) {
        if let Some(state) = ephemeris.state_or_gap(satellite, elapsed_s)? {
            let clock = if several { part } else { 0 };
            clocks[clock].push(rotation.to_earth_fixed(state.position_km));
        }
    }
    Ok(())
}

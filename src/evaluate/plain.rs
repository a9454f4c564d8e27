//! The plain path: one sample after the other, in f64, by the definitions.

use super::Evaluator;
use crate::dop::ClockGroup;
use crate::ephemeris::{Ephemeris, EphemerisError};

/// What an evaluation leaves for the statistics.
pub(super) struct Samples {
    /// Visible LEO satellites, summed over all samples.
    pub(super) visible: u64,
    /// Points times times.
    pub(super) count: usize,
    /// PDOP of the solved samples, in no particular order.
    pub(super) pdop: Vec<f64>,
}

pub(super) fn evaluate(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
) -> Result<Samples, EphemerisError> {
    let setup = evaluator.setup();
    let count = setup.sample_count();
    let mut samples = Samples {
        visible: 0,
        count,
        pdop: Vec::with_capacity(count),
    };
    let mut positions = Vec::with_capacity(ephemeris.satellites().len());
    for (k, elapsed_s) in setup.grid.iter().enumerate() {
        positions.clear();
        for satellite in ephemeris.satellites() {
            let state = ephemeris.state(satellite, elapsed_s)?;
            positions.push(evaluator.rotations[k].to_earth_fixed(state.position_km));
        }
        for (site, fixed) in setup.sites.iter().zip(evaluator.fixed.at(k)) {
            let mut leo = ClockGroup::default();
            for &position in &positions {
                if let Some(unit) = setup.mask.line_of_sight(&site.local, position) {
                    leo.add(unit);
                }
            }
            samples.visible += u64::from(leo.count());
            leo += fixed.shared_clock;
            let mut geometry = fixed.own_clocks;
            geometry.add(&leo);
            samples.pdop.extend(geometry.pdop(setup.pdop_cap));
        }
    }
    Ok(samples)
}

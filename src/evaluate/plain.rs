//! The plain path: one sample after the other, in f64, by the definitions. It is the reference
//! that the kernel is tested against.

use super::fixed::FixedGeometry;
use super::metrics::Evaluated;
use super::{Evaluator, Setup};
use crate::dop::ClockGroup;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::stats::summarize;

pub(super) fn evaluate(
    evaluator: &Evaluator,
    ephemeris: &Ephemeris,
) -> Result<Evaluated, EphemerisError> {
    let setup = evaluator.setup();
    let fixed = FixedGeometry::new(setup, &evaluator.rotations)?;
    let mut visible = 0;
    let mut pdop = Vec::with_capacity(setup.sample_count());
    let mut positions = Vec::with_capacity(ephemeris.satellites().len());
    for (k, elapsed_s) in setup.grid.iter().enumerate() {
        positions.clear();
        for satellite in ephemeris.satellites() {
            let state = ephemeris.state(satellite, elapsed_s)?;
            positions.push(evaluator.rotations[k].to_earth_fixed(state.position_km));
        }
        for (site, fixed) in setup.sites.iter().zip(fixed.at(k)) {
            let mut leo = ClockGroup::default();
            for &position in &positions {
                if let Some(unit) = setup.mask.line_of_sight(&site.local, position) {
                    leo.add(unit);
                }
            }
            visible += u64::from(leo.count());
            leo += fixed.shared_clock;
            let mut geometry = fixed.own_clocks;
            geometry.add(&leo);
            pdop.extend(geometry.pdop(setup.pdop_cap));
        }
    }
    Ok(evaluated(setup, visible, &mut pdop))
}

fn evaluated(setup: &Setup, visible: u64, pdop: &mut [f64]) -> Evaluated {
    let options = setup.metrics;
    let available = |pdop: &&f64| **pdop <= options.availability_pdop;
    Evaluated {
        samples: setup.sample_count(),
        visible,
        solved: pdop.len() as u64,
        available: pdop.iter().filter(available).count() as u64,
        summary: summarize(pdop, options.cvar_level),
    }
}

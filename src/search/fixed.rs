//! Satellites that every design of a search has beside its own, such as those of a file.

use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::frames::{State, Teme};
use crate::orbit::{PropagationError, Propagator};
use crate::time::TimeGrid;
use std::sync::Arc;

/// Satellites with their states at the samples, so that their theory works once and not for each design.
#[derive(Default)]
pub(super) struct FixedSatellites {
    /// `None` if there are no satellites.
    grid: Option<TimeGrid>,
    satellites: Vec<(String, Arc<FixedStates>)>,
}

/// The states of one satellite; `None` where its file has a gap.
struct FixedStates {
    step_s: f64,
    states: Vec<Option<State<Teme>>>,
}

/// The propagation of a satellite at the samples alone.
struct FixedTrajectory(Arc<FixedStates>);

impl Propagator for FixedTrajectory {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let place = (elapsed_s / self.0.step_s).round();
        let is_sample = place >= 0.0 && place * self.0.step_s == elapsed_s;
        let state = self.0.states.get(place as usize).copied().flatten();
        let state = state.filter(|_| is_sample);
        state.ok_or(PropagationError::NotSampled { elapsed_s })
    }
}

impl FixedSatellites {
    /// Propagates satellites to every sample of their grid.
    pub(super) fn new(ephemeris: &Ephemeris) -> Result<Self, EphemerisError> {
        let grid = ephemeris.grid();
        let sampled = |satellite: &EphemerisSatellite| {
            let states = grid.iter().map(|at| ephemeris.state_or_gap(satellite, at));
            let samples = FixedStates {
                step_s: grid.step_s(),
                states: states.collect::<Result<_, _>>()?,
            };
            Ok((satellite.name.clone(), Arc::new(samples)))
        };
        let satellites = ephemeris.satellites().iter().map(sampled);
        Ok(Self {
            grid: Some(grid),
            satellites: satellites.collect::<Result<_, _>>()?,
        })
    }

    pub(super) fn is_empty(&self) -> bool {
        self.satellites.is_empty()
    }

    pub(super) fn len(&self) -> usize {
        self.satellites.len()
    }

    /// The satellites; `None` if there are none.
    pub(super) fn ephemeris(&self) -> Option<Ephemeris> {
        let grid = self.grid?;
        let copy = |(name, samples): &(String, Arc<FixedStates>)| EphemerisSatellite {
            name: name.clone(),
            slot: None,
            propagator: Box::new(FixedTrajectory(Arc::clone(samples))),
        };
        let satellites = self.satellites.iter().map(copy).collect();
        Some(Ephemeris::new(grid, satellites))
    }
}

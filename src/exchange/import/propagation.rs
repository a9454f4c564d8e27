//! From the satellites of a file to an ephemeris on the grid of a study.

use super::Fleet;
use crate::constellation::gnss::{ElementSetError, ElementSets};
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, FromTeme, State, Teme};
use crate::orbit::{Model, PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};
use std::collections::HashSet;
use thiserror::Error;

/// Time within which a sample belongs to an instant, s: 7 mm along a low orbit, and more than the
/// 10 ns of SP3 and the microseconds of some writers.
const SAME_INSTANT_S: f64 = 1e-6;

/// Why the satellites of a file do not propagate a study.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FleetError {
    /// No satellites.
    #[error("no satellites")]
    Empty,
    /// Element sets that do not form a constellation.
    #[error(transparent)]
    Sets(#[from] ElementSetError),
    /// A model that rejects the elements.
    #[error(transparent)]
    Propagation(#[from] EphemerisError),
    /// Two satellites with the same name.
    #[error("satellite {0} appears twice")]
    Repeated(String),
    /// A satellite without a sample at an instant of the study.
    #[error(
        "{name} has no state at {missing}; its {samples} states run from {first} to {last}: \
         change time.epoch, time.duration-h or time.step-s"
    )]
    NotCovered {
        /// The satellite.
        name: String,
        /// First instant without a state.
        missing: Epoch,
        /// Number of its states.
        samples: usize,
        /// The first of them.
        first: Epoch,
        /// The last.
        last: Epoch,
    },
}

/// States at the instants of a grid.
struct Samples {
    step_s: f64,
    states: Vec<State<Teme>>,
}

impl Propagator for Samples {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let k = (elapsed_s / self.step_s).round();
        let missing = PropagationError::NotSampled { elapsed_s };
        if !(k >= 0.0 && (elapsed_s - k * self.step_s).abs() <= SAME_INSTANT_S) {
            return Err(missing);
        }
        self.states.get(k as usize).copied().ok_or(missing)
    }
}

/// A propagator whose elements hold at another instant than the epoch of the study.
struct Shifted {
    propagator: Box<dyn Propagator>,
    /// Seconds from the epoch of the elements to that of the study.
    ahead_s: f64,
}

impl Propagator for Shifted {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        self.propagator.state_at(elapsed_s + self.ahead_s)
    }
}

impl Fleet {
    /// The satellites on the grid of a study; `model` propagates mean elements.
    ///
    /// # Errors
    /// If there are no satellites, one appears twice, a theory rejects one, or samples do not cover
    /// the grid.
    pub fn propagate(&self, grid: TimeGrid, model: Model) -> Result<Ephemeris, FleetError> {
        if self.is_empty() {
            return Err(FleetError::Empty);
        }
        let satellites = match self {
            Self::Sets(sets) => {
                let sets = ElementSets::new("element sets", sets)?;
                return Ok(Ephemeris::of_gnss(sets.satellites(grid.epoch()), grid));
            }
            Self::Elements(rows) => {
                let propagate = |row: &super::ElementsRow| {
                    let propagator = model.propagator(&row.elements, row.epoch);
                    let propagator = propagator.map_err(|source| EphemerisError {
                        name: row.name.clone(),
                        source,
                    })?;
                    let ahead_s = grid.epoch().seconds_since(row.epoch);
                    let shifted = Shifted {
                        propagator,
                        ahead_s,
                    };
                    Ok(propagated(&row.name, shifted))
                };
                rows.iter()
                    .map(propagate)
                    .collect::<Result<Vec<_>, FleetError>>()?
            }
            Self::Sampled(trajectories) => sampled(trajectories, grid)?,
            Self::Tracks(tracks) => {
                let instants = || grid.iter().map(|t| grid.epoch().plus_seconds(t));
                let states = tracks.iter().map(|track| track.trajectory(instants()));
                sampled(&states.collect::<Vec<_>>(), grid)?
            }
        };
        let mut names = HashSet::new();
        match satellites.iter().find(|one| !names.insert(&one.name)) {
            Some(twice) => Err(FleetError::Repeated(twice.name.clone())),
            None => Ok(Ephemeris::new(grid, satellites)),
        }
    }
}

fn propagated(name: &str, propagator: impl Propagator + 'static) -> EphemerisSatellite {
    EphemerisSatellite {
        name: name.to_owned(),
        slot: None,
        propagator: Box::new(propagator),
    }
}

/// Satellites of one file share its frame, so its rotations are reused from one to the next.
fn sampled(
    trajectories: &[Trajectory],
    grid: TimeGrid,
) -> Result<Vec<EphemerisSatellite>, FleetError> {
    let mut rotations: Vec<FromTeme<Frame>> = Vec::new();
    let mut frame = None;
    let mut satellites = Vec::with_capacity(trajectories.len());
    for trajectory in trajectories {
        if frame != Some(trajectory.frame) {
            let rotation = |t| FromTeme::to(trajectory.frame, grid.epoch(), t);
            rotations = grid.iter().map(rotation).collect();
            frame = Some(trajectory.frame);
        }
        let states = grid
            .iter()
            .zip(&rotations)
            .map(|(elapsed_s, rotation)| {
                Ok(rotation.undo(state_at(trajectory, grid.epoch(), elapsed_s)?))
            })
            .collect::<Result<_, FleetError>>()?;
        let samples = Samples {
            step_s: grid.step_s(),
            states,
        };
        satellites.push(propagated(&trajectory.name, samples));
    }
    Ok(satellites)
}

/// The sample of an instant, in the frame of the file.
fn state_at(
    trajectory: &Trajectory,
    epoch: Epoch,
    elapsed_s: f64,
) -> Result<State<Frame>, FleetError> {
    let states = &trajectory.states;
    let (Some((first, _)), Some((last, _))) = (states.first(), states.last()) else {
        return Err(FleetError::Empty);
    };
    let after = |at: &Epoch| at.seconds_since(epoch) - elapsed_s;
    let next = states.partition_point(|(at, _)| after(at) < -SAME_INSTANT_S);
    match states.get(next) {
        Some((at, state)) if after(at) <= SAME_INSTANT_S => Ok(*state),
        _ => Err(FleetError::NotCovered {
            name: trajectory.name.clone(),
            missing: epoch.plus_seconds(elapsed_s),
            samples: states.len(),
            first: *first,
            last: *last,
        }),
    }
}

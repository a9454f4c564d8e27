//! From the satellites of a file to an ephemeris on the grid of a study.

use super::Fleet;
use crate::constellation::gnss::{ElementSetError, ElementSets, StaleElements};
use crate::constellation::identity::{ObjectIdentity, first_repeated, unique_labels};
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::formats::trajectory::Trajectory;
use crate::frames::{Frame, FromTeme, State, Teme};
use crate::orbit::earth_orbit::{check_inertial, check_state};
use crate::orbit::{Model, PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};
use thiserror::Error;

/// Time within which a sample is that of an instant, s: 7 mm along a low orbit, and above the
/// 10 ns of SP3 and the microseconds of some writers.
const SAME_INSTANT_S: f64 = 1e-6;

/// Why the satellites of a file do not propagate a study.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum FleetError {
    /// No satellite.
    #[error("no satellites")]
    Empty,
    /// Element sets that make no constellation.
    #[error(transparent)]
    Sets(#[from] ElementSetError),
    /// A model that refuses the elements.
    #[error(transparent)]
    Propagation(#[from] EphemerisError),
    /// A satellite that is given twice, by the rule of [`crate::constellation::identity`].
    #[error("satellite {0} is given twice, at the same instants or as element sets; keep one")]
    Repeated(String),
    /// The same by its catalogue number or designator, under two names.
    #[error("{0} and {1} are one object by catalogue number or OBJECT_ID; keep one")]
    TwoNames(String, String),
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
    /// Epoch of the study.
    epoch: Epoch,
    /// Seconds from the epoch of the elements to that of the study.
    ahead_s: f64,
}

impl Propagator for Shifted {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let state = self.propagator.state_at(elapsed_s + self.ahead_s)?;
        let implausible = |problem| PropagationError::Implausible {
            at: self.epoch.plus_seconds(elapsed_s),
            problem,
        };
        check_inertial(&state.position_km.km(), &state.velocity_km_s).map_err(implausible)?;
        Ok(state)
    }
}

impl Fleet {
    /// The satellites on the grid of a study; `model` propagates mean elements.
    ///
    /// # Errors
    /// When no satellites or one twice, a theory refuses one, or its samples do not cover
    /// the grid.
    pub fn propagate(&self, grid: TimeGrid, model: Model) -> Result<Ephemeris, FleetError> {
        if self.is_empty() {
            return Err(FleetError::Empty);
        }
        let identities = self.identities();
        if let Some((first, second)) = first_repeated(&identities) {
            let label = |place: usize| identities[place].label().unwrap_or_default();
            return Err(
                if identities[first].is_named_otherwise(&identities[second]) {
                    FleetError::TwoNames(label(first), label(second))
                } else {
                    FleetError::Repeated(label(second))
                },
            );
        }
        let satellites = self.satellites(&unique_labels(&identities), grid, model)?;
        Ok(Ephemeris::new(grid, satellites))
    }

    /// The satellites under the names `labels`.
    fn satellites(
        &self,
        labels: &[String],
        grid: TimeGrid,
        model: Model,
    ) -> Result<Vec<EphemerisSatellite>, FleetError> {
        match self {
            Self::Sets(sets) => {
                let sets = ElementSets::new("element sets", sets)?;
                let ephemeris = Ephemeris::of_gnss(sets.satellites(grid.epoch()), grid);
                let mut satellites = ephemeris.into_satellites();
                for (satellite, label) in satellites.iter_mut().zip(labels) {
                    satellite.name.clone_from(label);
                }
                Ok(satellites)
            }
            Self::Elements(rows) => {
                let propagate = |(row, label): (&super::ElementsRow, &String)| {
                    let propagator = model.propagator(&row.elements, row.epoch);
                    let propagator = propagator.map_err(|source| EphemerisError {
                        name: label.clone(),
                        source,
                    })?;
                    let shifted = Shifted {
                        propagator,
                        epoch: grid.epoch(),
                        ahead_s: grid.epoch().seconds_since(row.epoch),
                    };
                    Ok(propagated(label, shifted))
                };
                rows.iter().zip(labels).map(propagate).collect()
            }
            Self::Sampled(trajectories) => sampled(trajectories, labels, grid),
            Self::Tracks(tracks) => {
                let instants = || grid.iter().map(|t| grid.epoch().plus_seconds(t));
                let states = tracks.iter().map(|track| track.trajectory(instants()));
                sampled(&states.collect::<Vec<_>>(), labels, grid)
            }
            Self::Mixed(parts) => {
                let mut satellites = Vec::with_capacity(labels.len());
                for part in parts {
                    let done = satellites.len();
                    let own = &labels[done..done + part.len()];
                    satellites.extend(part.satellites(own, grid, model)?);
                }
                Ok(satellites)
            }
        }
    }

    /// The element set, of those of the files called `name`, that is farthest from an instant of
    /// `grid`, if it is old, or not yet valid; as for GNSS.
    #[must_use]
    pub fn stale(&self, name: &str, grid: TimeGrid) -> Option<StaleElements> {
        match self {
            Self::Sets(sets) => {
                let identities: Vec<_> = sets.iter().map(ObjectIdentity::of_set).collect();
                let epochs = sets
                    .iter()
                    .map(|set| Epoch::from_utc(set.datetime.and_utc()));
                let labelled = unique_labels(&identities).into_iter().zip(epochs);
                StaleElements::among(name, labelled, grid)
            }
            Self::Mixed(parts) => {
                let stale = parts.iter().filter_map(|part| part.stale(name, grid));
                stale.max_by(|a, b| a.age_days.total_cmp(&b.age_days))
            }
            Self::Elements(_) | Self::Sampled(_) | Self::Tracks(_) => None,
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

/// Satellites of one file share its frame, so that its rotations are kept from one to the next.
fn sampled(
    trajectories: &[Trajectory],
    labels: &[String],
    grid: TimeGrid,
) -> Result<Vec<EphemerisSatellite>, FleetError> {
    let mut rotations: Vec<FromTeme<Frame>> = Vec::new();
    let mut frame = None;
    let mut satellites = Vec::with_capacity(trajectories.len());
    for (trajectory, label) in trajectories.iter().zip(labels) {
        if frame != Some(trajectory.frame) {
            let rotation = |t| FromTeme::to(trajectory.frame, grid.epoch(), t);
            rotations = grid.iter().map(rotation).collect();
            frame = Some(trajectory.frame);
        }
        let states = grid
            .iter()
            .zip(&rotations)
            .map(|(elapsed_s, rotation)| {
                let state = state_at(trajectory, label, grid.epoch(), elapsed_s)?;
                check_state(trajectory.frame, &state).map_err(|problem| EphemerisError {
                    name: label.clone(),
                    source: PropagationError::Implausible {
                        at: grid.epoch().plus_seconds(elapsed_s),
                        problem,
                    },
                })?;
                Ok(rotation.undo(state))
            })
            .collect::<Result<_, FleetError>>()?;
        let samples = Samples {
            step_s: grid.step_s(),
            states,
        };
        satellites.push(propagated(label, samples));
    }
    Ok(satellites)
}

/// The sample of an instant, in the frame of the file.
fn state_at(
    trajectory: &Trajectory,
    label: &str,
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
            name: label.to_owned(),
            missing: epoch.plus_seconds(elapsed_s),
            samples: states.len(),
            first: *first,
            last: *last,
        }),
    }
}

//! From the satellites of a file to an ephemeris on the grid of a study.

use super::Fleet;
use crate::constellation::gnss::{ElementSetError, ElementSets, StaleElements};
use crate::constellation::identity::{ObjectIdentity, first_repeated, unique_labels};
use crate::ephemeris::arc::SAME_INSTANT_S;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::formats::trajectory::Trajectory;
use crate::formats::yuma::{Almanac, AlmanacOrbit};
use crate::frames::{Frame, FromTeme, State, Teme};
use crate::orbit::earth_orbit::{check_inertial, check_state};
use crate::orbit::{Model, PropagationError, Propagator};
use crate::time::{Epoch, TimeGrid};
use thiserror::Error;

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
    /// A satellite that appears twice, by the rule of [`crate::constellation::identity`].
    #[error("satellite {0} appears twice, at the same instants or as element sets; keep one")]
    Repeated(String),
    /// The same by its catalogue number or designator, under two names.
    #[error("{0} and {1} are one object by catalogue number or OBJECT_ID; keep one")]
    TwoNames(String, String),
    /// Satellites without a state at an instant of the study.
    #[error(
        "{name} has no state at {missing}; its states {} at {edge}: \
         change time.epoch, time.duration-h or time.step-s",
        if *is_first { "begin" } else { "end" }
    )]
    NotCovered {
        /// The satellite.
        name: String,
        /// First instant without a state.
        missing: Epoch,
        /// The first of its states, if they begin later, or else the last.
        edge: Epoch,
        /// Whether it is the first.
        is_first: bool,
    },
}

/// States at the instants of a grid; none in a gap of the file.
struct Samples {
    step_s: f64,
    states: Vec<Option<State<Teme>>>,
}

impl Propagator for Samples {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let k = (elapsed_s / self.step_s).round();
        let missing = PropagationError::NotSampled { elapsed_s };
        if !(k >= 0.0 && (elapsed_s - k * self.step_s).abs() <= SAME_INSTANT_S) {
            return Err(missing);
        }
        self.states
            .get(k as usize)
            .copied()
            .flatten()
            .ok_or(missing)
    }
}

/// A satellite's states at any instant that its file covers.
struct Interpolated {
    trajectory: Trajectory,
    /// Epoch of the study.
    epoch: Epoch,
}

impl Propagator for Interpolated {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        let at = self.epoch.plus_seconds(elapsed_s);
        let found = self
            .trajectory
            .arc_at(at)
            .and_then(|arc| Some((arc.frame, arc.state(at)?.0)));
        let (frame, state) = found.ok_or(PropagationError::NotSampled { elapsed_s })?;
        check_state(frame, &state)
            .map_err(|problem| PropagationError::Implausible { at, problem })?;
        Ok(FromTeme::to(frame, self.epoch, elapsed_s).undo(state))
    }
}

/// States that are kept at the samples of a grid, and interpolated at other instants.
struct Continuous {
    kept: Box<dyn Propagator>,
    between: Interpolated,
}

impl Propagator for Continuous {
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        match self.kept.state_at(elapsed_s) {
            Err(PropagationError::NotSampled { .. }) => self.between.state_at(elapsed_s),
            found => found,
        }
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
    /// If there are no satellites, one appears twice, a theory rejects one, or samples do not cover
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

    /// The same, in which satellites with sampled states also have states between the samples of the grid, as far as
    /// their file covers them.
    ///
    /// # Errors
    /// As of [`Self::propagate`].
    pub fn propagate_continuously(
        &self,
        grid: TimeGrid,
        model: Model,
    ) -> Result<Ephemeris, FleetError> {
        let satellites = self.propagate(grid, model)?.into_satellites().into_iter();
        let continuous = |(satellite, trajectory): (EphemerisSatellite, Option<&Trajectory>)| {
            let Some(trajectory) = trajectory else {
                return satellite;
            };
            let between = Interpolated {
                trajectory: trajectory.clone(),
                epoch: grid.epoch(),
            };
            EphemerisSatellite {
                propagator: Box::new(Continuous {
                    kept: satellite.propagator,
                    between,
                }),
                ..satellite
            }
        };
        let satellites = satellites
            .zip(self.trajectories())
            .map(continuous)
            .collect();
        Ok(Ephemeris::new(grid, satellites))
    }

    /// The sampled states of each satellite, where it has such.
    pub(super) fn trajectories(&self) -> Vec<Option<&Trajectory>> {
        match self {
            Self::Sampled(trajectories) => trajectories.iter().map(Some).collect(),
            Self::Mixed(parts) => parts.iter().flat_map(Self::trajectories).collect(),
            other => vec![None; other.len()],
        }
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
            Self::Almanacs(almanacs) => {
                let orbit = |(almanac, label): (&Almanac, &String)| {
                    propagated(label, AlmanacOrbit::new(*almanac, grid.epoch()))
                };
                Ok(almanacs.iter().zip(labels).map(orbit).collect())
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
            Self::Almanacs(almanacs) => {
                let epochs = almanacs
                    .iter()
                    .map(|almanac| almanac.applicability(grid.epoch()));
                StaleElements::among(name, self.labels().into_iter().zip(epochs), grid)
            }
            Self::Elements(_) | Self::Sampled(_) => None,
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

/// The states of satellites at the instants of a grid. An instant outside the spans of all satellites is an error; one
/// in a gap, or outside the span of its own satellite only, has no state.
fn sampled(
    trajectories: &[Trajectory],
    labels: &[String],
    grid: TimeGrid,
) -> Result<Vec<EphemerisSatellite>, FleetError> {
    check_span(trajectories, labels, grid)?;
    let mut frames = RotationsByFrame::new(grid);
    let mut satellites = Vec::with_capacity(trajectories.len());
    for (trajectory, label) in trajectories.iter().zip(labels) {
        let mut states = Vec::with_capacity(grid.len());
        for (k, elapsed_s) in grid.iter().enumerate() {
            let at = grid.epoch().plus_seconds(elapsed_s);
            let found = trajectory
                .arc_at(at)
                .and_then(|arc| Some((arc.frame, arc.state(at)?.0)));
            let Some((frame, state)) = found else {
                states.push(None);
                continue;
            };
            check_state(frame, &state).map_err(|problem| EphemerisError {
                name: label.clone(),
                source: PropagationError::Implausible { at, problem },
            })?;
            states.push(Some(frames.rotation(frame, k).undo(state)));
        }
        let samples = Samples {
            step_s: grid.step_s(),
            states,
        };
        satellites.push(propagated(label, samples));
    }
    Ok(satellites)
}

/// Refuses a grid that reaches beyond the states of all satellites.
fn check_span(
    trajectories: &[Trajectory],
    labels: &[String],
    grid: TimeGrid,
) -> Result<(), FleetError> {
    let spans = trajectories.iter().zip(labels);
    let spans = spans.filter_map(|(one, label)| Some((one, label, one.span()?)));
    let Some((_, label, (first, last))) = spans.reduce(|one, other| {
        let length_s = |(first, last): (Epoch, Epoch)| last.seconds_since(first);
        if length_s(other.2) > length_s(one.2) {
            other
        } else {
            one
        }
    }) else {
        return Err(FleetError::Empty);
    };
    let held = |at: Epoch| {
        trajectories
            .iter()
            .filter_map(Trajectory::span)
            .any(|(first, last)| {
                at.seconds_since(first) >= -SAME_INSTANT_S
                    && last.seconds_since(at) >= -SAME_INSTANT_S
            })
    };
    let mut instants = grid
        .iter()
        .map(|elapsed_s| grid.epoch().plus_seconds(elapsed_s));
    match instants.find(|at| !held(*at)) {
        None => Ok(()),
        Some(missing) => Err(FleetError::NotCovered {
            name: label.clone(),
            missing,
            edge: if missing < first { first } else { last },
            is_first: missing < first,
        }),
    }
}

/// The rotations of a grid, made for each frame when it is first met.
struct RotationsByFrame {
    grid: TimeGrid,
    made: Vec<(Frame, Vec<FromTeme<Frame>>)>,
}

impl RotationsByFrame {
    fn new(grid: TimeGrid) -> Self {
        let made = Vec::new();
        Self { grid, made }
    }

    fn rotation(&mut self, frame: Frame, k: usize) -> FromTeme<Frame> {
        let known = self.made.iter().position(|(known, _)| *known == frame);
        let at = known.unwrap_or_else(|| {
            let rotation = |t| FromTeme::to(frame, self.grid.epoch(), t);
            self.made
                .push((frame, self.grid.iter().map(rotation).collect()));
            self.made.len() - 1
        });
        self.made[at].1[k]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::csv::write_states;

    /// States every minute in a study of two-minute steps: at its samples as they are, between them interpolated, and none
    /// beyond the file.
    #[test]
    fn states_are_continuous_as_far_as_the_file_goes() {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = |step_s: f64| TimeGrid::new(epoch, 3_600.0, step_s).unwrap();
        let design = "delta:55:2/1/0@925".parse().unwrap();
        let truth = Ephemeris::of_design(&design, Model::J2, grid(60.0)).unwrap();
        let mut table = Vec::new();
        write_states(&mut table, &truth).unwrap();
        let fleet = Fleet::read(table.as_slice(), None, Some("states.csv")).unwrap();
        let sampled = fleet.fleet.propagate(grid(120.0), Model::J2).unwrap();
        let continuous = fleet.fleet.propagate_continuously(grid(120.0), Model::J2);
        let continuous = continuous.unwrap();
        let at = |of: &Ephemeris, elapsed_s: f64| {
            let state = of.state_or_gap(&of.satellites()[1], elapsed_s).unwrap();
            state.map(|state| state.position_km)
        };
        for elapsed_s in [0.0, 120.0, 180.0, 1_234.5, 3_540.0] {
            let apart = at(&continuous, elapsed_s).unwrap() - at(&truth, elapsed_s).unwrap();
            // Nine decimals of a kilometre, and polynomials of degree 7 a minute apart.
            assert!(apart.norm() < 1e-7, "{elapsed_s}: {}", apart.norm());
        }
        assert_eq!(at(&sampled, 120.0), at(&continuous, 120.0));
        assert_eq!(at(&sampled, 180.0), None);
        assert_eq!(at(&continuous, 3_541.0), None);
    }
}

//! The objects of files as TEME states in the time scale of the study.

use super::read::{Comparand, FileError};
use super::reference::ReferenceConstellation;
use crate::ephemeris::hermite::hermite_position;
use crate::frames::{State, Teme, to_teme};
use crate::orbit::sgp4::Sgp4Orbit;
use crate::orbit::{PropagationError, Propagator};
use crate::validate::ValidateError;
use nalgebra::Vector3;

/// Samples used on either side of an interpolated instant.
const NODES: usize = 8;

/// Widest gap between states that is interpolated, revolutions: Hermite's polynomial through eight
/// states is then accurate to metres.
const WIDEST_GAP_TURNS: f64 = 0.1;

/// Maximum number of samples of an object that are compared.
const MOST_SAMPLES: usize = 2_000;

/// An object: states by the seconds since the epoch of the study.
#[derive(Debug, Clone)]
pub(super) struct Track {
    pub(super) name: String,
    /// States in the span of the study, at most [`MOST_SAMPLES`], for comparing.
    pub(super) states: Vec<(f64, State<Teme>)>,
    /// All states in or next to the span, for interpolating.
    all: Vec<(f64, State<Teme>)>,
    propagated: Option<Sgp4Orbit>,
}

/// The objects in the span of the study.
///
/// # Errors
/// If no object has a state in the span, or SGP4 rejects an element set.
pub(super) fn tracks(
    reference: &ReferenceConstellation<'_>,
    comparands: &[Comparand],
) -> Result<Vec<Track>, ValidateError> {
    let mut tracks = Vec::with_capacity(comparands.len());
    for comparand in comparands {
        tracks.push(match comparand {
            Comparand::States(trajectory) => sampled(reference, trajectory),
            Comparand::Elements(set) => of_elements(reference, set)?,
        });
    }
    if tracks.iter().all(|track| track.states.is_empty()) {
        return Err(another_epoch(reference, comparands).into());
    }
    Ok(tracks)
}

fn sampled(
    reference: &ReferenceConstellation<'_>,
    trajectory: &crate::formats::trajectory::Trajectory,
) -> Track {
    let epoch = reference.epoch();
    let last_s = last_s(reference);
    let all: Vec<(f64, State<Teme>)> = trajectory
        .samples()
        .into_iter()
        .map(|(at, frame, state)| {
            let elapsed_s = at.seconds_since(epoch);
            (elapsed_s, to_teme(state, frame, epoch, elapsed_s))
        })
        .collect();
    let within: Vec<(f64, State<Teme>)> = all
        .iter()
        .filter(|(t, _)| (-1e-6..=last_s + 1e-6).contains(t))
        .copied()
        .collect();
    let stride = within.len().div_ceil(MOST_SAMPLES).max(1);
    Track {
        name: trajectory.name.clone(),
        states: within.into_iter().step_by(stride).collect(),
        all,
        propagated: None,
    }
}

fn of_elements(
    reference: &ReferenceConstellation<'_>,
    set: &::sgp4::Elements,
) -> Result<Track, ValidateError> {
    let name = set
        .object_name
        .clone()
        .unwrap_or_else(|| set.norad_id.to_string());
    let failed = |source: PropagationError| FileError::ElementSet {
        object: name.clone(),
        source,
    };
    let propagated = Sgp4Orbit::from_element_set(set, reference.epoch()).map_err(failed)?;
    let grid = reference.grid();
    let stride = grid.len().div_ceil(MOST_SAMPLES);
    let mut states = Vec::new();
    for elapsed_s in grid.iter().step_by(stride) {
        states.push((elapsed_s, propagated.state_at(elapsed_s).map_err(failed)?));
    }
    Ok(Track {
        name,
        states,
        all: Vec::new(),
        propagated: Some(propagated),
    })
}

fn last_s(reference: &ReferenceConstellation<'_>) -> f64 {
    reference.grid().elapsed_s(reference.grid().len() - 1)
}

fn another_epoch(reference: &ReferenceConstellation<'_>, comparands: &[Comparand]) -> FileError {
    let at = |elapsed_s: f64| reference.epoch().plus_seconds(elapsed_s).to_string();
    let instants = comparands.iter().find_map(|comparand| match comparand {
        Comparand::States(trajectory) => {
            let (first, last) = trajectory.span()?;
            Some((first.to_string(), last.to_string()))
        }
        Comparand::Elements(_) => None,
    });
    let (first, last) = instants.unwrap_or_else(|| ("no state".to_owned(), "none".to_owned()));
    FileError::AnotherEpoch {
        objects: comparands.len(),
        from: at(0.0),
        to: at(last_s(reference)),
        first,
        last,
    }
}

impl Track {
    /// Fraction of the study's time span that the states cover without a gap too wide to
    /// interpolate.
    pub(super) fn covered_share(&self, reference: &ReferenceConstellation<'_>) -> f64 {
        let last_s = last_s(reference);
        if self.propagated.is_some() {
            return 1.0;
        }
        if last_s <= 0.0 {
            return if self.states.is_empty() { 0.0 } else { 1.0 };
        }
        let most_s = WIDEST_GAP_TURNS * reference.shortest_period_s;
        let steps = self.all.windows(2).map(|pair| (pair[0].0, pair[1].0));
        let covered_s: f64 = steps
            .filter(|(from, to)| to - from <= most_s)
            .map(|(from, to)| (to.min(last_s) - from.max(0.0)).max(0.0))
            .sum();
        (covered_s / last_s).clamp(0.0, 1.0)
    }

    /// Whether the states cover the full span and can be interpolated.
    pub(super) fn covers(&self, reference: &ReferenceConstellation<'_>) -> bool {
        let has_velocity = |(_, state): &(f64, State<Teme>)| state.velocity_km_s.norm() > 0.0;
        self.covered_share(reference) > 1.0 - 1e-9
            && (self.propagated.is_some() || self.all.iter().all(has_velocity))
    }

    /// The state of the sample nearest to an instant.
    pub(super) fn at(&self, elapsed_s: f64) -> Option<(f64, State<Teme>)> {
        let apart = |(t, _): &&(f64, State<Teme>)| (t - elapsed_s).abs();
        self.states
            .iter()
            .min_by(|a, b| apart(a).total_cmp(&apart(b)))
            .copied()
    }
}

impl Propagator for Track {
    /// The interpolated state (Hermite), or that of the sample itself; only within the span.
    fn state_at(&self, elapsed_s: f64) -> Result<State<Teme>, PropagationError> {
        if let Some(propagated) = &self.propagated {
            return propagated.state_at(elapsed_s);
        }
        let behind = self.all.partition_point(|(t, _)| *t < elapsed_s);
        let nodes = NODES.min(self.all.len());
        let start = behind.saturating_sub(nodes / 2).min(self.all.len() - nodes);
        let table = &self.all[start..start + nodes];
        let exact = table.iter().find(|(t, _)| (t - elapsed_s).abs() < 1e-9);
        if let Some((_, state)) = exact {
            return Ok(*state);
        }
        let position = |at: f64| hermite_position(table, at);
        let velocity_km_s: Vector3<f64> =
            (position(elapsed_s + 0.5) - position(elapsed_s - 0.5)) / 1.0;
        Ok(State {
            position_km: position(elapsed_s),
            velocity_km_s,
        })
    }
}

//! What a file is compared with: a constellation in a study.

use super::matching::apart_km;
use crate::constellation::Design;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::evaluate::Evaluator;
use crate::frames::{State, Teme};
use crate::orbit::kepler;
use crate::time::{Epoch, TimeGrid};
use crate::validate::Subject;
use std::f64::consts::TAU;

/// Largest distance of an object from its slot, km.
const MOST_REACH_KM: f64 = 1_500.0;

/// A constellation propagated on the grid of a study.
pub struct ReferenceConstellation<'a> {
    pub(super) evaluator: &'a Evaluator,
    pub(super) ephemeris: Ephemeris,
    /// The shells of a design, on which conventions are tried; empty for satellites from files.
    pub(super) shells: Vec<Subject<'a>>,
    /// Of each satellite: how far from it an object may be to be matched with it, km.
    pub(super) reach_km: Vec<f64>,
    /// The shortest orbital period, seconds.
    pub(super) shortest_period_s: f64,
    /// The first satellite that has no state at a sample, and that instant.
    pub(super) first_gap: Option<(String, Epoch)>,
}

impl<'a> ReferenceConstellation<'a> {
    /// A design by the model of the study.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn of_design(design: &Design, evaluator: &'a Evaluator) -> Result<Self, EphemerisError> {
        let shells = Subject::of_shells(design, evaluator);
        Self::of_shells(shells, evaluator)
    }

    /// The shells of a design, each with the parts that propagate it.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn of_shells(
        shells: Vec<Subject<'a>>,
        evaluator: &'a Evaluator,
    ) -> Result<Self, EphemerisError> {
        let mut ephemeris = Ephemeris::new(evaluator.setup().grid, Vec::new());
        let mut reach_km = Vec::new();
        for shell in &shells {
            ephemeris = ephemeris.joined(shell.propagate_model()?);
            let spacing_km =
                TAU * shell.orbit().semi_major_axis_km / shell.shell.satellites_per_plane() as f64;
            // A third of the distance to the next satellite of the plane.
            let reach = (spacing_km / 3.0).min(MOST_REACH_KM);
            reach_km.resize(ephemeris.satellites().len(), reach);
        }
        let orbits = shells.iter().map(Subject::orbit);
        let periods = orbits.map(|orbit| TAU / orbit.kepler_mean_motion_rad_s());
        Ok(Self {
            evaluator,
            ephemeris,
            reach_km,
            shortest_period_s: periods.fold(f64::INFINITY, f64::min),
            shells,
            first_gap: None,
        })
    }

    /// Any satellites on the grid of the study, such as those of a file. No conventions are tried on them.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn of_satellites(
        ephemeris: Ephemeris,
        evaluator: &'a Evaluator,
    ) -> Result<Self, EphemerisError> {
        let mut states = Vec::new();
        let mut first_gap = None;
        for satellite in ephemeris.satellites() {
            let first = FirstSamples::of(&ephemeris, satellite)?;
            let gap = first.gap.map(|at| (satellite.name.clone(), at));
            first_gap = first_gap.or(gap);
            states.push(first.state);
        }
        let periods = states.iter().flatten().filter_map(kepler::period_s);
        let shortest_period_s = periods.fold(f64::INFINITY, f64::min);
        Ok(Self {
            evaluator,
            reach_km: thirds_of_nearest_km(&states),
            ephemeris,
            shells: Vec::new(),
            shortest_period_s,
            first_gap,
        })
    }

    pub(super) fn grid(&self) -> TimeGrid {
        self.ephemeris.grid()
    }

    pub(super) fn epoch(&self) -> Epoch {
        self.grid().epoch()
    }
}

/// The first state of a satellite on the grid, and the first sample without one.
#[derive(Default)]
struct FirstSamples {
    state: Option<State<Teme>>,
    gap: Option<Epoch>,
}

impl FirstSamples {
    fn of(ephemeris: &Ephemeris, satellite: &EphemerisSatellite) -> Result<Self, EphemerisError> {
        let mut first = Self::default();
        for elapsed_s in ephemeris.grid().iter() {
            match ephemeris.state_or_gap(satellite, elapsed_s)? {
                None => {
                    let at = || ephemeris.grid().epoch().plus_seconds(elapsed_s);
                    first.gap = first.gap.or_else(|| Some(at()));
                }
                found => first.state = first.state.or(found),
            }
        }
        Ok(first)
    }
}

/// For each satellite, a third of the distance to the nearest other one, which may cross it on another course.
fn thirds_of_nearest_km(states: &[Option<State<Teme>>]) -> Vec<f64> {
    let nearest = |(n, state): (usize, &Option<State<Teme>>)| {
        let Some(state) = state else { return 0.0 };
        let others = states.iter().enumerate().filter(|(other, _)| *other != n);
        let distances = others.filter_map(|(_, other)| Some(apart_km(other.as_ref()?, state)));
        (distances.fold(f64::INFINITY, f64::min) / 3.0).min(MOST_REACH_KM)
    };
    states.iter().enumerate().map(nearest).collect()
}

//! Satellites on a time grid: what the evaluator, the file formats and the validators consume.

pub mod arc;
pub mod coincidence;
pub(crate) mod derivative;
pub mod hermite;
pub mod meetings;
pub mod outages;
pub mod sampled;

use crate::constellation::gnss::GnssSatellite;
use crate::constellation::{Design, Shell, Slot};
use crate::frames::{State, Teme};
use crate::orbit::{Model, PropagationError, Propagator};
use crate::time::TimeGrid;
use std::ops::Range;
use thiserror::Error;

/// A satellite with a state at any instant of its span.
pub struct EphemerisSatellite {
    /// Name, unique in the ephemeris.
    pub name: String,
    /// Place in the pattern, for a design.
    pub slot: Option<Slot>,
    /// TEME states from the epoch of the grid.
    pub propagator: Box<dyn Propagator>,
}

/// A satellite whose propagation fails.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{name}: {source}")]
pub struct EphemerisError {
    /// The satellite.
    pub name: String,
    /// Why it has no state.
    pub source: PropagationError,
}

/// A whole shell among the satellites of an ephemeris.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShellSpan {
    /// The shell.
    pub shell: Shell,
    /// The theory that propagates it.
    pub model: Model,
    /// Place of its first satellite; the others follow, plane by plane.
    pub first: usize,
}

impl ShellSpan {
    /// Places of its satellites.
    #[must_use]
    pub fn places(&self) -> Range<usize> {
        self.first..self.first + self.shell.satellite_count()
    }
}

/// Satellites and the instants at which they are sampled.
///
/// States are computed on demand, so that a product can stream ten thousand satellites.
pub struct Ephemeris {
    grid: TimeGrid,
    satellites: Vec<EphemerisSatellite>,
    shells: Vec<ShellSpan>,
    /// The part of the constellation to which each satellite belongs.
    parts: Vec<usize>,
}

impl Ephemeris {
    /// Any satellites on a grid, all of one part.
    #[must_use]
    pub fn new(grid: TimeGrid, satellites: Vec<EphemerisSatellite>) -> Self {
        Self {
            grid,
            parts: vec![0; satellites.len()],
            satellites,
            shells: Vec::new(),
        }
    }

    /// The same satellites divided into parts, numbered from 0: one number for each satellite.
    ///
    /// # Panics
    /// If there are more or fewer numbers than satellites.
    #[must_use]
    pub fn with_parts(self, parts: Vec<usize>) -> Self {
        assert_eq!(parts.len(), self.satellites.len(), "a part of each");
        Self { parts, ..self }
    }

    /// A design propagated by `model` from the epoch of the grid.
    ///
    /// # Errors
    /// If the model refuses the orbit of a satellite.
    pub fn of_design(
        design: &Design,
        model: Model,
        grid: TimeGrid,
    ) -> Result<Self, EphemerisError> {
        let propagate = |satellite: &crate::constellation::Satellite| {
            let name = object_name(satellite.slot);
            match model.propagator(&satellite.elements, grid.epoch()) {
                Ok(propagator) => Ok(EphemerisSatellite {
                    name,
                    slot: Some(satellite.slot),
                    propagator,
                }),
                Err(source) => Err(EphemerisError { name, source }),
            }
        };
        let satellites = design
            .satellites()
            .iter()
            .map(propagate)
            .collect::<Result<_, _>>()?;
        let mut first = 0;
        let span = |shell: &Shell| {
            let span = ShellSpan {
                shell: *shell,
                model,
                first,
            };
            first += shell.satellite_count();
            span
        };
        let shells: Vec<ShellSpan> = design.shells().iter().map(span).collect();
        let parts = shells.iter().enumerate();
        let parts = parts.flat_map(|(part, span)| span.places().map(move |_| part));
        Ok(Self {
            grid,
            satellites,
            parts: parts.collect(),
            shells,
        })
    }

    /// The same satellites and those of another ephemeris on the same grid after them, in parts of their own.
    #[must_use]
    pub fn joined(mut self, other: Self) -> Self {
        let first = self.satellites.len();
        let parts = self.part_count();
        let others = other.parts.iter().map(|part| parts + part);
        self.parts.extend(others);
        let moved = |span: ShellSpan| ShellSpan {
            first: first + span.first,
            ..span
        };
        self.shells.extend(other.shells.into_iter().map(moved));
        self.satellites.extend(other.satellites);
        self
    }

    /// The satellites of a GNSS constellation.
    #[must_use]
    pub fn of_gnss(satellites: Vec<GnssSatellite>, grid: TimeGrid) -> Self {
        let propagate = |satellite: GnssSatellite| EphemerisSatellite {
            name: satellite.name,
            slot: None,
            propagator: Box::new(satellite.orbit),
        };
        Self::new(grid, satellites.into_iter().map(propagate).collect())
    }

    /// The instants.
    #[must_use]
    pub fn grid(&self) -> TimeGrid {
        self.grid
    }

    /// The satellites.
    #[must_use]
    pub fn satellites(&self) -> &[EphemerisSatellite] {
        &self.satellites
    }

    /// The satellites, to give them other names or other states of the same orbits.
    pub(crate) fn satellites_mut(&mut self) -> &mut [EphemerisSatellite] {
        &mut self.satellites
    }

    /// The whole shells among the satellites, in their order.
    #[must_use]
    pub fn shells(&self) -> &[ShellSpan] {
        &self.shells
    }

    /// Places of the satellites that are in none of the shells, in their order.
    #[must_use]
    pub fn outside_shells(&self) -> Vec<usize> {
        let mut is_inside = vec![false; self.satellites.len()];
        for shell in &self.shells {
            is_inside[shell.places()].fill(true);
        }
        let places = 0..is_inside.len();
        places.filter(|place| !is_inside[*place]).collect()
    }

    /// The part of the constellation to which each satellite belongs, from 0: its shell, or the satellites from files.
    #[must_use]
    pub fn parts(&self) -> &[usize] {
        &self.parts
    }

    /// Number of parts.
    #[must_use]
    pub fn part_count(&self) -> usize {
        self.parts.iter().max().map_or(0, |last| last + 1)
    }

    /// The satellites, without the grid.
    #[must_use]
    pub fn into_satellites(self) -> Vec<EphemerisSatellite> {
        self.satellites
    }

    /// The TEME state of a satellite `elapsed_s` after the epoch of the grid.
    ///
    /// # Errors
    /// Names the satellite whose propagation fails.
    pub fn state(
        &self,
        satellite: &EphemerisSatellite,
        elapsed_s: f64,
    ) -> Result<State<Teme>, EphemerisError> {
        satellite
            .propagator
            .state_at(elapsed_s)
            .map_err(|source| EphemerisError {
                name: satellite.name.clone(),
                source,
            })
    }

    /// The state of a satellite that may have none, as in a gap of its file: then it is nowhere in view.
    ///
    /// # Errors
    /// Names the satellite whose propagation fails.
    pub fn state_or_gap(
        &self,
        satellite: &EphemerisSatellite,
        elapsed_s: f64,
    ) -> Result<Option<State<Teme>>, EphemerisError> {
        match self.state(satellite, elapsed_s) {
            Ok(state) => Ok(Some(state)),
            Err(EphemerisError {
                source: PropagationError::NotSampled { .. },
                ..
            }) => Ok(None),
            Err(error) => Err(error),
        }
    }

    /// The states of one satellite at every instant of the grid, with the seconds since its epoch.
    pub fn states<'a>(
        &'a self,
        satellite: &'a EphemerisSatellite,
    ) -> impl ExactSizeIterator<Item = Result<(f64, State<Teme>), EphemerisError>> + use<'a> {
        self.grid
            .iter()
            .map(|elapsed_s| Ok((elapsed_s, self.state(satellite, elapsed_s)?)))
    }
}

/// What the names of a design's satellites begin with unless a scenario says otherwise.
pub const NAME_PREFIX: &str = "NW";

/// The name of the satellite in a slot of a design: `NW-P01-S01`, and `NW-A-P01-S01` in one of several shells.
#[must_use]
pub fn object_name(slot: Slot) -> String {
    format!("{NAME_PREFIX}-{slot}")
}

#[cfg(test)]
pub(crate) mod testing {
    use super::*;
    use crate::time::Epoch;

    /// Two satellites outside shells, at 700 km, before a shell of four at 1200 km and after one of two at 925 km.
    pub(crate) fn files_between_shells() -> Ephemeris {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 7_200.0, 300.0).unwrap();
        let of = |text: &str| {
            let design = text.parse().unwrap();
            Ephemeris::of_design(&design, Model::J2, grid).unwrap()
        };
        let mut files = of("delta:55:2/1/0@700").into_satellites();
        for (n, satellite) in files.iter_mut().enumerate() {
            satellite.name = format!("FILE {n}");
            satellite.slot = None;
        }
        let files = Ephemeris::new(grid, files);
        let low = of("delta:55:2/1/0@925");
        low.joined(files).joined(of("star:90:4/2/1@1200"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::Epoch;

    #[test]
    fn satellites_outside_shells_may_be_before_them() {
        let mixed = testing::files_between_shells();
        assert_eq!(mixed.outside_shells(), [2, 3]);
        let names = mixed.outside_shells().into_iter();
        let names: Vec<&str> = names
            .map(|place| mixed.satellites()[place].name.as_str())
            .collect();
        assert_eq!(names, ["FILE 0", "FILE 1"]);
        assert_eq!(mixed.shells()[1].places(), 4..8);
    }

    #[test]
    fn a_design_propagates_on_the_grid() {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let design: Design = "delta:55:4/2/1@925".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        let names: Vec<_> = ephemeris
            .satellites()
            .iter()
            .map(|s| s.name.as_str())
            .collect();
        assert_eq!(
            names,
            ["NW-P01-S01", "NW-P01-S02", "NW-P02-S01", "NW-P02-S02"]
        );
        let states: Result<Vec<_>, _> = ephemeris.states(&ephemeris.satellites()[0]).collect();
        let states = states.unwrap();
        assert_eq!(states.len(), 10);
        assert_eq!(states[9].0, 540.0);
        // First satellite: on the x axis of TEME at the epoch.
        assert!((states[0].1.position_km.km().x - 7303.137).abs() < 1e-9);
    }
}

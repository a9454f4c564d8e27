//! A constellation: the shells of a design, satellites from files, or both.
//!
//! It is what every command works on. All satellites of a constellation share one clock state, unless a setup gives
//! each shell its own, and one to the satellites from files.

mod name;

pub(crate) use name::NAME_CHARACTERS;
pub use name::{GNSS_ONLY, LONGEST_NAME, accepted_name, is_name, similar_name};

use crate::constellation::Design;
use crate::constellation::identity::{NUMBERED, UniqueTexts};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::exchange::import::{Fleet, FleetError};
use crate::exchange::lint::Format;
use crate::orbit::Model;
use crate::search::CountedSatellites;
use crate::time::TimeGrid;
use thiserror::Error;

/// A named constellation, with at least one satellite.
#[derive(Debug, Clone, PartialEq)]
pub struct Constellation {
    /// Its name in results, unique among those that are compared.
    pub name: String,
    /// The shells.
    pub design: Option<Design>,
    /// The satellites from files.
    pub files: Option<FileSatellites>,
}

/// The satellites of one or more files.
#[derive(Debug, Clone, PartialEq)]
pub struct FileSatellites {
    /// Names of the files or directories, without their paths.
    pub names: Vec<String>,
    /// The formats found, each once.
    pub formats: Vec<Format>,
    /// The satellites.
    pub fleet: Fleet,
}

/// Why a constellation cannot be propagated.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ConstellationError {
    /// A satellite of its shells.
    #[error(transparent)]
    Design(#[from] EphemerisError),
    /// The satellites of its files.
    #[error(transparent)]
    Fleet(#[from] FleetError),
}

impl FileSatellites {
    /// The formats as results name them: `tle+sp3`.
    #[must_use]
    pub fn format(&self) -> String {
        let names: Vec<String> = self.formats.iter().map(Format::to_string).collect();
        names.join("+")
    }
}

impl Constellation {
    /// The shells of a design, named by their notation.
    #[must_use]
    pub fn of_design(design: Design) -> Self {
        Self {
            name: design.to_string(),
            design: Some(design),
            files: None,
        }
    }

    /// Satellites from files, named by these.
    #[must_use]
    pub fn of_files(files: FileSatellites) -> Self {
        Self {
            name: files.names.join("+"),
            design: None,
            files: Some(files),
        }
    }

    /// The shells of a design and satellites from files, named by what there is; `None` if there is neither.
    #[must_use]
    pub fn of_parts(design: Option<Design>, files: Option<FileSatellites>) -> Option<Self> {
        match design {
            Some(design) => Some(Self {
                files,
                ..Self::of_design(design)
            }),
            None => files.map(Self::of_files),
        }
    }

    /// Its satellites as the quantities of a search count them, beside what is fixed there.
    #[must_use]
    pub fn counted(&self, fixed: Option<&FileSatellites>) -> CountedSatellites<'_> {
        let files = self.files.as_ref();
        let has_fixed =
            |fixed: &FileSatellites| files.is_some_and(|files| files.fleet.includes(&fixed.fleet));
        CountedSatellites {
            shells: self.design.as_ref(),
            from_files: files.map_or(0, |files| files.fleet.len()),
            has_fixed_files: fixed.is_some_and(has_fixed),
        }
    }

    /// The same constellation under another name.
    #[must_use]
    pub fn named(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// The design, if the constellation has no other satellites.
    #[must_use]
    pub fn only_design(&self) -> Option<&Design> {
        match &self.files {
            None => self.design.as_ref(),
            Some(_) => None,
        }
    }

    /// What its satellites are: the notation, the files, or both.
    #[must_use]
    pub fn made_of(&self) -> String {
        let mut parts: Vec<String> = self.design.iter().map(Design::to_string).collect();
        parts.extend(self.files.iter().flat_map(|files| files.names.clone()));
        parts.join("+")
    }

    /// Number of satellites.
    #[must_use]
    pub fn satellite_count(&self) -> usize {
        let shells = self.design.as_ref().map_or(0, Design::satellite_count);
        let files = self.files.as_ref().map_or(0, |files| files.fleet.len());
        shells + files
    }

    /// The satellites on the grid of a study: those of the shells by `model`, then those of the files by the
    /// theory that their file implies. A name that is already taken gets a number.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn ephemeris(&self, grid: TimeGrid, model: Model) -> Result<Ephemeris, ConstellationError> {
        self.with_files(grid, model, |fleet| fleet.propagate(grid, model))
    }

    /// The same, in which satellites with sampled states also have states between the samples of the grid.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn continuous_ephemeris(
        &self,
        grid: TimeGrid,
        model: Model,
    ) -> Result<Ephemeris, ConstellationError> {
        self.with_files(grid, model, |fleet| {
            fleet.propagate_continuously(grid, model)
        })
    }

    fn with_files(
        &self,
        grid: TimeGrid,
        model: Model,
        propagate: impl Fn(&Fleet) -> Result<Ephemeris, FleetError>,
    ) -> Result<Ephemeris, ConstellationError> {
        let fleet = self.files.as_ref().map(|files| &files.fleet);
        let of_files = fleet.map(propagate).transpose()?;
        let Some(design) = &self.design else {
            return Ok(of_files.unwrap_or_else(|| Ephemeris::new(grid, Vec::new())));
        };
        let shells = Ephemeris::of_design(design, model, grid)?;
        let Some(of_files) = of_files else {
            return Ok(shells);
        };
        let mut names = UniqueTexts::default();
        for satellite in shells.satellites() {
            names.take(satellite.name.clone(), NUMBERED);
        }
        let mut added = of_files.into_satellites();
        for satellite in &mut added {
            satellite.name = names.take(std::mem::take(&mut satellite.name), NUMBERED);
        }
        Ok(shells.joined(Ephemeris::new(grid, added)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time::Epoch;

    const TWO_SATELLITES: &str = "object,epoch_utc,semi_major_axis_km,eccentricity,inclination_deg,raan_deg,arg_perigee_deg,mean_anomaly_deg\n\
        NW-P01-S01,2025-01-01T00:00:00Z,7300,0,50,0,0,0\n\
        OTHER,2025-01-01T00:00:00Z,7300,0,50,0,0,180\n";

    fn grid() -> TimeGrid {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        TimeGrid::new(epoch, 600.0, 60.0).unwrap()
    }

    fn of_files() -> FileSatellites {
        let imported = Fleet::read(TWO_SATELLITES.as_bytes(), None, Some("two.csv")).unwrap();
        FileSatellites {
            names: vec!["two.csv".to_owned()],
            formats: vec![imported.format],
            fleet: imported.fleet,
        }
    }

    #[test]
    fn shells_and_files_propagate_together_under_unique_names() {
        let design: Design = "delta:55:2/1/0@925".parse().unwrap();
        let mixed = Constellation {
            files: Some(of_files()),
            ..Constellation::of_design(design)
        };
        assert_eq!(mixed.satellite_count(), 4);
        assert!(mixed.only_design().is_none());
        let ephemeris = mixed.ephemeris(grid(), Model::J2).unwrap();
        let names = ephemeris.satellites().iter().map(|one| one.name.as_str());
        let names: Vec<&str> = names.collect();
        assert_eq!(
            names,
            ["NW-P01-S01", "NW-P01-S02", "NW-P01-S01 #2", "OTHER"]
        );
        assert_eq!(ephemeris.shells().len(), 1);
        assert_eq!(ephemeris.parts(), [0, 0, 1, 1]);
        let alone = Constellation::of_files(of_files());
        assert_eq!(
            (alone.name.as_str(), alone.satellite_count()),
            ("two.csv", 2)
        );
        let ephemeris = alone.ephemeris(grid(), Model::J2).unwrap();
        assert_eq!(ephemeris.satellites().len(), 2);
    }
}

//! A constellation: the shells of a design, satellites from files, or both.
//!
//! It is what every command works on. All satellites of a constellation share one clock state, unless a setup gives
//! each shell and each file its own.

mod name;

pub(crate) use name::NAME_CHARACTERS;
pub use name::{GNSS_ONLY, LONGEST_NAME, accepted_name, is_name, similar_name};

use crate::constellation::Design;
use crate::constellation::identity::{NUMBERED, UniqueTexts};
use crate::ephemeris::outages::OutageError;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Setup;
use crate::exchange::import::{
    Fleet, FleetError, Imported, Merged, NoSuchSatellite, SatelliteFilter,
};
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
    /// A number for each satellite, the same for those of one file.
    pub origins: Vec<usize>,
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
    /// Its satellites that are out of service.
    #[error(transparent)]
    Outage(#[from] OutageError),
}

impl FileSatellites {
    /// The satellites of files of these names that `filter` selects.
    ///
    /// # Errors
    /// If a pattern matches none, or no satellite is left.
    pub fn new(
        names: Vec<String>,
        merged: Merged,
        filter: &SatelliteFilter,
    ) -> Result<Self, NoSuchSatellite> {
        let Merged {
            formats,
            mut fleet,
            origins,
        } = merged;
        let kept = fleet.choose(filter)?.into_iter();
        let origins = origins.into_iter().zip(kept);
        Ok(Self {
            names,
            formats,
            fleet,
            origins: origins.filter(|(_, kept)| *kept).map(|(n, _)| n).collect(),
        })
    }

    /// The satellites of one file.
    #[must_use]
    pub fn of_file(name: String, imported: Imported) -> Self {
        Self {
            names: vec![name],
            formats: vec![imported.format],
            origins: vec![0; imported.fleet.len()],
            fleet: imported.fleet,
        }
    }

    /// The files as parts of an ephemeris, numbered without gaps.
    fn parts(&self) -> Vec<usize> {
        let mut known = Vec::new();
        let part = |origin: &usize| {
            let place = known.iter().position(|one| one == origin);
            place.unwrap_or_else(|| {
                known.push(*origin);
                known.len() - 1
            })
        };
        self.origins.iter().map(part).collect()
    }

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

    /// The satellites on the grid of a setup that are in service at some time.
    ///
    /// # Errors
    /// If a satellite cannot be propagated, or an outage is of none.
    pub fn in_service(&self, setup: &Setup) -> Result<Ephemeris, ConstellationError> {
        let all = self.ephemeris(setup.grid, setup.model)?;
        Ok(setup.in_service(&self.name, all)?)
    }

    /// Places of the satellites that are out of service throughout.
    ///
    /// # Errors
    /// As [`Constellation::in_service`].
    pub fn places_down(&self, setup: &Setup) -> Result<Vec<usize>, ConstellationError> {
        let all = self.ephemeris(setup.grid, setup.model)?;
        Ok(setup.places_down(&self.name, all)?)
    }

    /// The satellites on a grid, in which those with sampled states also have states between the samples of the grid.
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
        let by_file = |files: &FileSatellites| {
            let propagated = propagate(&files.fleet)?;
            Ok::<_, FleetError>(propagated.with_parts(files.parts()))
        };
        let of_files = self.files.as_ref().map(by_file).transpose()?;
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
        let parts = of_files.parts().to_vec();
        let mut added = of_files.into_satellites();
        for satellite in &mut added {
            satellite.name = names.take(std::mem::take(&mut satellite.name), NUMBERED);
        }
        Ok(shells.joined(Ephemeris::new(grid, added).with_parts(parts)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exchange::import::MergedFiles;
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
        FileSatellites::of_file("two.csv".to_owned(), imported)
    }

    /// The two satellites in two files, one of them taken by the selection.
    fn of_two_files(filter: &SatelliteFilter) -> Constellation {
        let mut merged = MergedFiles::default();
        let (head, rows) = TWO_SATELLITES.split_once('\n').unwrap();
        for row in rows.lines() {
            let text = format!("{head}\n{row}\n");
            merged.add(Fleet::read(text.as_bytes(), None, Some("one.csv")).unwrap());
        }
        let names = vec!["pair".to_owned()];
        let files = FileSatellites::new(names, merged.finish().unwrap(), filter);
        Constellation::of_files(files.unwrap())
    }

    /// Each file is a part, beside the shells and alone; a file of which nothing is selected is none.
    #[test]
    fn files_are_parts() {
        let all = SatelliteFilter::default();
        let only = SatelliteFilter {
            only: vec!["OTHER".to_owned()],
            ..all.clone()
        };
        let parts = |one: Constellation| one.ephemeris(grid(), Model::J2).unwrap().parts().to_vec();
        assert_eq!(parts(of_two_files(&all)), [0, 1]);
        assert_eq!(parts(of_two_files(&only)), [0]);
        let mixed = Constellation {
            design: Some("delta:55:2/1/0@925".parse().unwrap()),
            ..of_two_files(&all)
        };
        let continuous = mixed.continuous_ephemeris(grid(), Model::J2).unwrap();
        assert_eq!(continuous.parts(), [0, 0, 1, 2]);
        assert_eq!(parts(mixed), [0, 0, 1, 2]);
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

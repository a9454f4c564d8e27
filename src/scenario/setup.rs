//! From a validated scenario to the input of the evaluator, the search and the optimisers.

use super::constellations::{ConstellationFileError, NoDesign};
use super::gnss_file::GnssFiles;
use super::keys::{KeyPath, key};
use super::values::RegionKeys;
use super::{
    Algorithm, GnssSetup, Objectives, Region, RegionTerrain, RegionWeightGrid, SatelliteOutages,
    Scenario, TimeSpan, Visibility,
};
use crate::constellation::Design;
use crate::constellation::gnss::{ElementSetError, System};
use crate::ephemeris::outages::OutageError;
use crate::evaluate::{MetricOptions, Setup};
use crate::exchange::import::{FleetError, ReadFleetError};
use crate::formats::terrain::RasterFileError;
use crate::ground::GroundError;
use crate::optimize::{ExhaustiveConfig, Method, MopsoConfig, Nsga2Config, RandomConfig};
use crate::search::{DesignSpace, Goals, Quantity};
use crate::stats::{Level, LevelError};
use crate::time::{Epoch, TimeError, TimeGrid};
use crate::units::SECONDS_PER_HOUR;
use crate::visibility::{Mask, MaskError, MaskTable, MaskTableError};
use std::io;
use thiserror::Error;

/// Designs between two checkpoints of a sweep, a fraction of a second of work.
const SWEEP_BATCH: usize = 256;

/// Why a scenario cannot be set up although each of its values is in range.
/// [`Scenario::setup_problem`] adds the place in the scenario.
#[derive(Debug, Error)]
pub enum SetupError {
    /// A GNSS file does not give a system.
    #[error("gnss.files: {file}: {source}")]
    GnssFile {
        /// The path as written.
        file: String,
        /// What is wrong with it; boxed, since it is much larger than the others.
        source: Box<GnssFileError>,
    },
    /// The points file or the polygons cannot be read.
    #[error("region.{key}: cannot read {file}: {source}")]
    RegionFile {
        /// The key: `points`, `polygon`, `weight-grid` or `terrain`.
        key: &'static str,
        /// The path as written.
        file: String,
        /// The message of the operating system.
        source: io::Error,
    },
    /// The polygons are not an area, or no point lies inside.
    #[error("region.polygon: {file}: {source}")]
    Polygon {
        /// The path as written.
        file: String,
        /// What is wrong with it.
        source: GroundError,
    },
    /// The points file is not a list of points.
    #[error("region.points: {file}: {source}")]
    Points {
        /// The path as written.
        file: String,
        /// What is wrong with it.
        source: GroundError,
    },
    /// The file is not a terrain, or the points do not stand on it.
    #[error("region.terrain: {file}: {source}")]
    Terrain {
        /// The path as written.
        file: String,
        /// What is wrong with it.
        source: RasterFileError,
    },
    /// The file does not weight the points.
    #[error("region.weight-grid: {file}: {source}")]
    WeightGrid {
        /// The path as written.
        file: String,
        /// What is wrong with it.
        source: RasterFileError,
    },
    /// The grid or the countries have no points.
    #[error("region: {0}")]
    Region(#[from] GroundError),
    /// The span has no samples.
    #[error("time: {0}")]
    Time(#[from] TimeError),
    /// A mask out of range.
    #[error("visibility: {0}")]
    Mask(#[from] MaskError),
    /// A mask table with gaps.
    #[error("visibility.mask-table: {0}")]
    MaskTable(#[from] MaskTableError),
    /// A tail level out of range.
    #[error("objectives.cvar-level: {0}")]
    Level(#[from] LevelError),
    /// The reference design is not a design.
    #[error("reference-design: {0}")]
    ReferenceDesign(#[from] NoDesign),
    /// A file of outages cannot be read, or an interval is wrong.
    #[error("outages.file: {file}: {reason}")]
    OutageFile {
        /// The path as written.
        file: String,
        /// What is wrong with it.
        reason: String,
    },
    /// The satellites out of service.
    #[error(transparent)]
    Outage(#[from] OutageError),
    /// The files of a constellation do not give its satellites.
    #[error("constellations.{name}: {file}: {source}")]
    Constellation {
        /// The name of the constellation.
        name: String,
        /// The path as written, or several.
        file: String,
        /// What is wrong; boxed, since it is much larger than the others.
        source: Box<ConstellationFileError>,
    },
}

impl SetupError {
    /// The keys that may have caused it, most likely first.
    pub(super) fn keys(&self) -> Vec<KeyPath> {
        match self {
            Self::GnssFile { .. } => vec![key!(GnssSetup.files)],
            Self::RegionFile {
                key: "weight-grid", ..
            }
            | Self::WeightGrid { .. } => {
                vec![key!(RegionWeightGrid.weight_grid)]
            }
            Self::RegionFile { key: "terrain", .. } | Self::Terrain { .. } => {
                vec![key!(RegionTerrain.terrain)]
            }
            Self::RegionFile { key: "points", .. } | Self::Points { .. } => {
                vec![key!(RegionKeys.points)]
            }
            Self::Polygon {
                source: GroundError::Area(_),
                ..
            }
            | Self::RegionFile { .. } => vec![key!(RegionKeys.polygon)],
            Self::Region(GroundError::Latitudes(..)) => vec![key!(RegionKeys.latitude_deg)],
            Self::Region(GroundError::Longitudes(..)) => vec![key!(RegionKeys.longitude_deg)],
            Self::Region(_) | Self::Polygon { .. } => vec![
                key!(RegionKeys.spacing_km),
                key!(RegionKeys.step_deg),
                key!(RegionKeys.polygon),
                key!(RegionKeys.country),
                key!(RegionKeys.latitude_deg),
                key!(RegionKeys.longitude_deg),
            ],
            Self::Time(_) => vec![
                key!(TimeSpan.step_s),
                key!(TimeSpan.duration_h),
                key!(TimeSpan.epoch),
            ],
            Self::Mask(_) => vec![key!(Visibility.mask_deg), key!(Visibility.gnss_mask_deg)],
            Self::MaskTable(_) => vec![key!(Visibility.mask_table)],
            Self::Level(_) => vec![key!(Objectives.cvar_level)],
            Self::ReferenceDesign(_) => vec![key!(Scenario.reference_design)],
            Self::OutageFile { .. } => vec![key!(SatelliteOutages.file)],
            Self::Outage(_) => vec![
                key!(SatelliteOutages.satellites),
                key!(SatelliteOutages.file),
            ],
            Self::Constellation { .. } => vec![key!(Scenario.constellations)],
        }
    }

    /// The problem, without the key.
    pub(super) fn reason(&self) -> String {
        match self {
            Self::GnssFile { file, source } => format!("{file}: {source}"),
            Self::RegionFile { file, source, .. } => format!("cannot read {file}: {source}"),
            Self::Points { file, source } | Self::Polygon { file, source } => {
                format!("{file}: {source}")
            }
            Self::Terrain { file, source } | Self::WeightGrid { file, source } => {
                format!("{file}: {source}")
            }
            Self::Region(source) => source.to_string(),
            Self::Time(source) => source.to_string(),
            Self::Mask(source) => source.to_string(),
            Self::MaskTable(source) => source.to_string(),
            Self::Level(source) => source.to_string(),
            Self::ReferenceDesign(source) => source.to_string(),
            Self::OutageFile { file, reason } => format!("{file}: {reason}"),
            Self::Outage(source) => source.to_string(),
            Self::Constellation { file, source, .. } => format!("{file}: {source}"),
        }
    }
}

/// Why a file gives no navigation system.
#[derive(Debug, Error)]
pub enum GnssFileError {
    /// It cannot be read.
    #[error("cannot read it: {0}")]
    Io(#[from] io::Error),
    /// A line of it is wrong.
    #[error(transparent)]
    Format(#[from] ReadFleetError),
    /// It holds nothing that moves by itself.
    #[error("the file contains {content}; element sets, almanacs or states are needed")]
    NoSets {
        /// Its content.
        content: String,
    },
    /// Its sets do not form a system.
    #[error(transparent)]
    Sets(#[from] ElementSetError),
    /// Its satellites do not cover the study.
    #[error(transparent)]
    Fleet(#[from] FleetError),
}

impl Scenario {
    /// The samples in time.
    ///
    /// # Errors
    /// If the span has no sample or too many.
    pub fn time_grid(&self) -> Result<TimeGrid, TimeError> {
        let epoch = Epoch::from_utc(self.time.epoch);
        TimeGrid::new(
            epoch,
            self.time.duration_h * SECONDS_PER_HOUR,
            self.time.step_s,
        )
    }

    /// The design to validate if none is given.
    ///
    /// # Errors
    /// If it is neither a notation nor the name of a constellation that is a design.
    pub fn reference_design(&self) -> Result<Design, SetupError> {
        Ok(self.design(&self.reference_design)?)
    }

    /// The setup of an evaluation. `read` returns the bytes of a file that the scenario names, by the path
    /// as written.
    ///
    /// # Errors
    /// If a file cannot be read, or the values together leave no point or sample.
    pub fn setup(&self, read: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<Setup, SetupError> {
        Ok(self.setup_with_notes(read)?.0)
    }

    /// The same, with notes on the GNSS files (age, gaps, interpolation, skipped parts) and on range errors that are not
    /// used.
    ///
    /// # Errors
    /// If a file cannot be read, or the values together leave no point or sample.
    pub fn setup_with_notes(
        &self,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<(Setup, Vec<String>), SetupError> {
        let visibility = &self.visibility;
        let (mut sites, mut map) = self.region(read)?;
        let weight_note = self.weigh(&mut sites, &mut map, read)?;
        let terrain_note = self.stand_on_terrain(&mut sites, read)?;
        let setup = Setup::new(self.time_grid()?, sites)
            .with_map(map)
            .with_mask(Mask::from_degrees(visibility.mask_deg)?)
            .with_gnss_mask(Mask::from_degrees(visibility.gnss_mask_deg)?);
        let setup = match self.skyline()? {
            Some(skyline) => setup.with_skyline(skyline),
            None => setup,
        };
        let (systems, mut notes) = self.systems(setup.grid, read)?;
        notes.extend(self.unused_range_errors());
        notes.extend(weight_note);
        notes.extend(terrain_note);
        let presets = &self.gnss.constellations;
        let setup = Setup {
            accuracy: self
                .accuracy
                .accuracy(presets, systems.len() - presets.len()),
            window_s: self.metrics.window_min.map(|window| 60.0 * window),
            ..setup
        };
        let setup = setup
            .with_gnss(systems)
            .with_clocks(self.gnss.clocks)
            .with_leo_clocks(self.gnss.leo_clocks)
            .with_observation_weights(visibility.weighting)
            .with_pdop_cap(visibility.pdop_cap)
            .with_model(self.propagation.model)
            .with_metrics(MetricOptions {
                cvar_weight: self.objectives.cvar_weight,
                cvar_level: Level::new(self.objectives.cvar_level)?,
                availability_pdop: self.objectives.availability_pdop,
                asks_for_hdop: self.asks_for(Quantity::is_of_dops),
                asks_for_n1: self.asks_for(Quantity::is_of_one_lost),
                asks_for_n1_tail: self.asks_for(|goal| goal == Quantity::N1CvarPdop),
                expects_up: self
                    .reliability
                    .satellite_availability()
                    .filter(|_| self.asks_for(|goal| goal == Quantity::ExpectedAvailability)),
            });
        let outages = self.satellite_outages(setup.grid, read)?;
        Ok((setup.with_outages(outages)?, notes))
    }

    /// Notes on range errors of systems that the study does not have.
    fn unused_range_errors(&self) -> Vec<String> {
        let note = |key: KeyPath| {
            let key = key.to_string();
            let why = match key.starts_with("accuracy.files") {
                true => "`gnss.files` is empty",
                false => "`gnss.constellations` does not have the system",
            };
            format!("{key} is not used: {why}")
        };
        let unused = self.accuracy.unused(&self.gnss);
        unused.into_iter().map(note).collect()
    }

    /// Whether an objective or a constraint is of a kind.
    fn asks_for(&self, kind: impl Fn(Quantity) -> bool) -> bool {
        let constraints = self.objectives.constraints.iter();
        let bounded = constraints.map(|constraint| constraint.quantity);
        let mut goals = self.objectives.minimize.iter().copied().chain(bounded);
        goals.any(kind)
    }

    /// The error of a file, among [`Scenario::files`], that cannot be read.
    #[must_use]
    pub fn unreadable(&self, file: &str, source: io::Error) -> SetupError {
        let is_region = self
            .region
            .file()
            .is_some_and(|of_region| of_region == file);
        // A file that is both is told as that of the points.
        let is_weighting = !is_region && self.weighting.weight_grid.as_deref() == Some(file);
        let is_terrain =
            !is_region && !is_weighting && self.terrain.terrain.as_deref() == Some(file);
        let is_gnss = self.gnss.files.iter().any(|gnss| gnss == file);
        let of_outages = self.outages.file.iter().any(|known| known == file);
        let named = self.constellations.iter();
        let mut named = named.filter(|one| one.parts.files.iter().any(|known| known == file));
        let file = file.to_owned();
        if is_region || is_weighting || is_terrain {
            let key = match self.region {
                _ if is_weighting => "weight-grid",
                _ if is_terrain => "terrain",
                Region::Points { .. } => "points",
                _ => "polygon",
            };
            SetupError::RegionFile { key, file, source }
        } else if of_outages && !is_gnss {
            let reason = format!("cannot read it: {source}");
            SetupError::OutageFile { file, reason }
        } else if let Some(named) = named.next().filter(|_| !is_gnss) {
            named.error(&file, source.into())
        } else {
            let source = Box::new(GnssFileError::Io(source));
            SetupError::GnssFile { file, source }
        }
    }

    /// The presets, and then those of each file: one system named by the file, or, of a file with several, one for
    /// each.
    fn systems(
        &self,
        grid: TimeGrid,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<(Vec<System>, Vec<String>), SetupError> {
        let mut systems: Vec<System> = self
            .gnss
            .constellations
            .iter()
            .copied()
            .map(System::from)
            .collect();
        let mut files = GnssFiles::default();
        for file in &self.gnss.files {
            let error = |source| SetupError::GnssFile {
                file: file.clone(),
                source: Box::new(source),
            };
            let bytes = read(file).map_err(|source| self.unreadable(file, source))?;
            files.add(file, &bytes, grid).map_err(error)?;
        }
        let found = files.finish(grid).map_err(|source| SetupError::GnssFile {
            file: self.gnss.files.join(", "),
            source: Box::new(source),
        })?;
        systems.extend(found.systems);
        Ok((systems, found.notes))
    }

    fn skyline(&self) -> Result<Option<MaskTable>, MaskTableError> {
        let vertices: Vec<(f64, f64)> = self
            .visibility
            .mask_table
            .iter()
            .map(|point| (point.azimuth_deg, point.mask_deg))
            .collect();
        if vertices.is_empty() {
            Ok(None)
        } else {
            MaskTable::new(vertices).map(Some)
        }
    }

    /// The goals of the search; satellites from files that are fixed are counted where they are read.
    #[must_use]
    pub fn goals(&self) -> Goals {
        Goals {
            objectives: self.objectives.minimize.clone(),
            constraints: self.objectives.constraints.clone(),
            launch_cost: self.objectives.launch_cost,
            fixed: self.fixed_shells(),
            fixed_from_files: 0,
        }
    }

    /// The space of the search, with the shells that are fixed.
    #[must_use]
    pub fn design_space(&self) -> DesignSpace {
        DesignSpace {
            shells: self.search.shells.as_slice().to_vec(),
            fixed: self.fixed_shells(),
        }
    }

    /// The hypervolume reference for the optimisers, with every objective minimised.
    #[must_use]
    pub fn minimised_reference(&self) -> Option<Vec<f64>> {
        let reference = self.objectives.hypervolume_reference.as_ref()?;
        let objectives = self.objectives.minimize.iter();
        Some(
            objectives
                .zip(reference)
                .map(|(objective, &x)| objective.minimised(x))
                .collect(),
        )
    }

    /// The settings of NSGA-II, whatever the method of the search.
    #[must_use]
    pub fn nsga2(&self) -> Nsga2Config {
        let settings = &self.optimizer;
        Nsga2Config {
            population: settings.population as usize,
            generations: settings.generations as usize,
            crossover_probability: settings.crossover_probability,
            mutation_probability: settings.mutation_probability,
            crossover_index: settings.crossover_index,
            mutation_index: settings.mutation_index,
            hypervolume_reference: self.minimised_reference(),
        }
    }

    /// The method of the search and its budget.
    #[must_use]
    pub fn method(&self) -> Method {
        let settings = &self.optimizer;
        let (population, generations) =
            (settings.population as usize, settings.generations as usize);
        let hypervolume_reference = self.minimised_reference();
        match settings.algorithm {
            Algorithm::Nsga2 => Method::Nsga2(self.nsga2()),
            Algorithm::Mopso => Method::Mopso(MopsoConfig {
                particles: population,
                iterations: generations,
                archive: population,
                hypervolume_reference,
            }),
            Algorithm::Random => Method::Random(RandomConfig {
                evaluations: population * generations,
                batch: population,
                hypervolume_reference,
            }),
            Algorithm::Exhaustive => Method::Exhaustive(ExhaustiveConfig {
                steps: self.design_space().steps(),
                batch: SWEEP_BATCH,
                hypervolume_reference,
            }),
        }
    }
}

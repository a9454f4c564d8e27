//! The validated scenario: every default filled in, every range checked. The keys of a scenario
//! file are declared here, each with its field.

mod accuracy;
mod constellations;
mod objectives;
mod optimizer;
mod outages;
mod region;
mod reliability;
mod search;
mod setting;
mod shell;
mod terrain;
mod weight_grid;

pub use crate::ground::Grid;
pub use accuracy::{FurtherMetrics, RangeErrors};
pub use constellations::{ConstellationParts, NamedConstellation};
pub use objectives::Objectives;
pub use optimizer::Optimizer;
pub use outages::SatelliteOutages;
#[cfg(test)]
pub(super) use region::points;
pub use region::{AreaSource, Region};
pub(super) use region::{RegionKeys, rivals};
pub use reliability::Reliability;
pub(super) use search::SHELLS;
pub use search::{SearchShells, SearchSpace};
pub use setting::{Earth, GnssSetup, MaskPoint, Propagation, TimeSpan, Visibility};
pub(super) use shell::INTERVALS;
pub use terrain::RegionTerrain;
pub use weight_grid::RegionWeightGrid;

use chrono::{DateTime, Utc};

use super::Algorithm;
use super::keys::{key, section};
use super::problem::Fault;
use super::reader::Reader;
use super::rule::{Constellations, Integer, Text, UtcInstant};
use crate::ephemeris::NAME_PREFIX;
use crate::formats::metadata::CatalogNumber;
use crate::ground::{AreaPoints, PointWeights};
use crate::search::{ShellSpace, SweepSteps};

/// Lets a duration that is an integer number of steps, up to rounding, end before
/// its last instant, and a grid that is an integer number of steps include its last
/// row. The same tolerance for both, in steps.
const STEP_SLACK: f64 = 1e-9;

/// Maximum designs of an exhaustive search: weeks of computing.
const MAX_DESIGNS: u64 = 1_000_000_000;

/// Midnight at the beginning of 2025, UTC.
const JANUARY_2025: DateTime<Utc> = DateTime::from_timestamp_nanos(1_735_689_600_000_000_000);

section! {
    /// A study: region, time, models and goals.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Scenario in "", finish finish_scenario {
        /// Name of the study, also part of the default output directory.
        pub name: String = Text::Name, default "scenario".to_owned();
        /// Design to validate if none is given, in Walker notation
        /// pattern:inclination:T/P/F@altitude or by its name in `constellations`.
        pub reference_design: String = Text::Any, default "delta:55:182/13/1@925".to_owned();
        /// Constellations by name (letters, digits, - and _), also written as a section `[constellations]`:
        /// `--design` takes the name in place of a notation, and the front of a search is compared with them.
        pub constellations: Vec<NamedConstellation> = Constellations,
            follows "none", example NamedConstellation::examples();
        /// The sampled time span.
        pub time: TimeSpan;
        /// The surface of the Earth.
        pub earth: Earth;
        /// The propagation of the LEO design.
        pub propagation: Propagation;
        /// The points where the receivers are.
        pub region: Region;
        /// What they count for, from a grid of values.
        pub weighting: RegionWeightGrid;
        /// The terrain on which they stand.
        pub terrain: RegionTerrain;
        /// Visibility.
        pub visibility: Visibility;
        /// The GNSS to augment.
        pub gnss: GnssSetup;
        /// The satellites out of service.
        pub outages: SatelliteOutages;
        /// How reliable the satellites are.
        pub reliability: Reliability;
        /// The range errors of the systems.
        pub accuracy: RangeErrors;
        /// Metrics on demand.
        pub metrics: FurtherMetrics;
        /// The objectives and constraints.
        pub objectives: Objectives;
        /// The search space.
        pub search: SearchSpace;
        /// The algorithm of the search and its settings.
        pub optimizer: Optimizer;
        /// The origin stated in exported files.
        pub export: Export;
    }
}

section! {
    /// The origin stated in exported files, and what their satellites are called.
    #[derive(Debug, Clone, PartialEq, Eq)]
    pub struct Export in "export" {
        /// Originator of exported files (CCSDS ORIGINATOR).
        pub originator: String = Text::Ascii, default "NAVWALKER".to_owned();
        /// Creation date of exported files (CCSDS CREATION_DATE); never the wall clock, so that the
        /// same run gives the same bytes.
        pub creation_date: DateTime<Utc> = UtcInstant, follows "time.epoch", example JANUARY_2025;
        /// Beginning of the names of a design's satellites, as in `NW-P01-S01`; with another prefix and other
        /// catalogue numbers, two exports can be read together.
        pub name_prefix: String = Text::Prefix, default NAME_PREFIX.to_owned();
        /// Catalogue number of the first satellite that has none of its own; the others follow.
        pub first_catalog_number: u32 = Integer { low: 1, high: CatalogNumber::LAST },
            default CatalogNumber::FIRST_OF_DESIGNS;
    }
}

/// Defaults and limits that involve several sections.
fn finish_scenario(scenario: &mut Scenario, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(Export.creation_date)) {
        scenario.export.creation_date = scenario.time.epoch;
    }
    if !reader.is_given(key!(Scenario.constellations)) {
        scenario.constellations = Vec::new();
    }
    check_fixed(scenario, reader);
    if scenario.terrain.terrain.is_some() && !scenario.visibility.mask_table.is_empty() {
        let other = key!(RegionTerrain.terrain).to_string();
        reader.refuse(&[key!(Visibility.mask_table)], Fault::Excluded { other });
    }
    check_weighting(scenario, reader);
    if reader.is_sound() {
        check_designs(scenario, reader);
        accuracy::check(scenario, reader);
    }
}

/// A grid of weights is instead of those of the region, and needs cells to count in.
fn check_weighting(scenario: &Scenario, reader: &mut Reader<'_>) {
    let grid = key!(RegionWeightGrid.weight_grid);
    if !reader.is_given(grid) {
        return;
    }
    let weights = match &scenario.region {
        Region::Grid(grid) => grid.weights,
        Region::Area {
            points: AreaPoints::Lattice { weights, .. },
            ..
        } => *weights,
        Region::Area { .. } | Region::Cells(_) | Region::Points { .. } => PointWeights::Equal,
    };
    let rival = match &scenario.region {
        Region::Points { .. } => key!(RegionKeys.points),
        _ if weights != PointWeights::Equal => key!(RegionKeys.weights),
        _ => return,
    };
    let other = rival.to_string();
    reader.refuse(&[grid], Fault::Excluded { other });
}

/// What is fixed is a notation or the name of a constellation.
fn check_fixed(scenario: &Scenario, reader: &mut Reader<'_>) {
    // The constellations are not known if one of them is wrong.
    let known = [key!(SearchSpace.fixed), key!(Scenario.constellations)];
    if let Err(error) = scenario.fixed() {
        let reason = error.to_string();
        reader.refuse(&known, Fault::SetUp { reason });
    }
}

fn check_designs(scenario: &Scenario, reader: &mut Reader<'_>) {
    if scenario.optimizer.algorithm != Algorithm::Exhaustive {
        return;
    }
    let keys = [
        SHELLS,
        key!(SweepSteps.inclination_step_deg),
        key!(SweepSteps.altitude_step_km),
        key!(ShellSpace.phasing),
        key!(ShellSpace.planes),
        key!(ShellSpace.satellites_per_plane),
        key!(Optimizer.algorithm),
    ];
    let count = scenario.search.design_count();
    reader.at_most(MAX_DESIGNS, count, "designs in an exhaustive search", &keys);
}

impl Scenario {
    /// The designs of a sweep over the grid of the search space, if they exceed the limit of an exhaustive
    /// search: their number and the limit.
    #[must_use]
    pub fn excess_of_sweep(&self) -> Option<(f64, u64)> {
        let count = self.search.design_count();
        (count > MAX_DESIGNS as f64).then_some((count, MAX_DESIGNS))
    }
}

/// Number of values from the low limit to the high one.
fn count([low, high]: [f64; 2], step: f64) -> f64 {
    ((high - low) / step + STEP_SLACK).floor() + 1.0
}

//! The validated scenario: every default filled in, every range checked. The keys of a scenario
//! file are declared here, each with its field.

mod objectives;
mod region;
mod search;
mod setting;

pub use crate::ground::Grid;
pub use objectives::Objectives;
pub(super) use region::PointsFile;
pub use region::Region;
#[cfg(test)]
pub(super) use region::points;
pub use search::{Optimizer, SearchSpace};
pub use setting::{Earth, GnssSetup, MaskPoint, Propagation, TimeSpan, Visibility};

use chrono::{DateTime, Utc};

use super::Algorithm;
use super::keys::{key, section};
use super::reader::Reader;
use super::rule::{Text, UtcInstant};
use crate::search::DesignSpace;

/// Lets a duration that is a whole number of steps up to rounding end before
/// its closing sample, and a grid that is a whole number of steps keep its
/// closing row. The same slack for both, in steps.
const STEP_SLACK: f64 = 1e-9;

/// Points times samples: beyond, one evaluation takes gigabytes.
const MAX_POINT_SAMPLES: u64 = 1_000_000_000;
/// Designs of an exhaustive search: weeks of a machine.
const MAX_DESIGNS: u64 = 1_000_000_000;

/// Midnight at the beginning of 2025, UTC.
const JANUARY_2025: DateTime<Utc> = DateTime::from_timestamp_nanos(1_735_689_600_000_000_000);

section! {
    /// A study: where, when, with which models, to which ends.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Scenario in "", finish finish_scenario {
        /// Name of the study, also part of the default output directory.
        pub name: String = Text::Name, default "scenario".to_owned();
        /// Design that is validated when none is named, in Walker notation
        /// pattern:inclination:T/P/F@altitude.
        pub reference_design: String = Text::Any, default "delta:55:182/13/1@925".to_owned();
        /// The sampled span of time.
        pub time: TimeSpan;
        /// The surface of the Earth.
        pub earth: Earth;
        /// The motion of the LEO design.
        pub propagation: Propagation;
        /// The points where the receivers are.
        pub region: Region;
        /// What a receiver sees.
        pub visibility: Visibility;
        /// The GNSS that is augmented.
        pub gnss: GnssSetup;
        /// What is minimized, and under which constraints.
        pub objectives: Objectives;
        /// The designs among which is searched.
        pub search: SearchSpace;
        /// How it is searched.
        pub optimizer: Optimizer;
        /// What exported files say about their origin.
        pub export: Export;
    }
}

section! {
    /// What exported files say about their origin.
    #[derive(Debug, Clone, PartialEq, Eq)]
    pub struct Export in "export" {
        /// Who made an exported file (CCSDS ORIGINATOR).
        pub originator: String = Text::Ascii, default "NAVWALKER".to_owned();
        /// When an exported file was made (CCSDS CREATION_DATE); never the wall clock, so that the
        /// same run gives the same bytes.
        pub creation_date: DateTime<Utc> = UtcInstant, follows "time.epoch", example JANUARY_2025;
    }
}

/// What follows from, or is bounded by, several sections together.
fn finish_scenario(scenario: &mut Scenario, reader: &mut Reader<'_>) {
    if !reader.is_given(key!(Export.creation_date)) {
        scenario.export.creation_date = scenario.time.epoch;
    }
    if reader.is_sound() {
        check_point_samples(scenario, reader);
        check_designs(scenario, reader);
    }
}

fn check_point_samples(scenario: &Scenario, reader: &mut Reader<'_>) {
    let Region::Grid(grid) = &scenario.region else {
        return;
    };
    let count = region::points(grid) * scenario.time.steps();
    let keys = [
        key!(TimeSpan.step_s),
        key!(TimeSpan.duration_h),
        key!(Grid.step_deg),
    ];
    reader.at_most(MAX_POINT_SAMPLES, count, "points times samples", &keys);
}

fn check_designs(scenario: &Scenario, reader: &mut Reader<'_>) {
    if scenario.optimizer.algorithm != Algorithm::Exhaustive {
        return;
    }
    let keys = [
        key!(SearchSpace.inclination_step_deg),
        key!(SearchSpace.altitude_step_km),
        key!(DesignSpace.phasing),
        key!(DesignSpace.planes),
        key!(DesignSpace.satellites_per_plane),
        key!(Optimizer.algorithm),
    ];
    let count = scenario.search.design_count();
    reader.at_most(MAX_DESIGNS, count, "designs in an exhaustive search", &keys);
}

/// Number of values from the low limit to the high one.
fn count([low, high]: [f64; 2], step: f64) -> f64 {
    ((high - low) / step + STEP_SLACK).floor() + 1.0
}

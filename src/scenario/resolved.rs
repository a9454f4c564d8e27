//! The validated scenario: every default filled in, every range checked.

use chrono::{DateTime, Utc};

use super::Constraint;
use super::{
    Algorithm, Clocks, LaunchCost, Model, ObservationWeights, Pattern, PointWeights, Preset,
    Quantity, Surface,
};

/// Lets a duration that is a whole number of steps up to rounding end before
/// its closing sample, and a grid that is a whole number of steps keep its
/// closing row. The same slack for both, in steps.
pub(super) const STEP_SLACK: f64 = 1e-9;

/// A study: where, when, with which models, to which ends.
#[derive(Debug, Clone, PartialEq)]
pub struct Scenario {
    /// Name of the study; also part of the default output directory.
    pub name: String,
    /// Walker notation of the design that is validated when none is named.
    pub reference_design: String,
    /// The sampled span of time.
    pub time: TimeSpan,
    /// The surface of the Earth.
    pub earth: Earth,
    /// The motion of the LEO design.
    pub propagation: Propagation,
    /// The points where the receivers are.
    pub region: Region,
    /// What a receiver sees.
    pub visibility: Visibility,
    /// The GNSS that is augmented.
    pub gnss: GnssSetup,
    /// What is minimized, and under which constraints.
    pub objectives: Objectives,
    /// The designs among which is searched.
    pub search: SearchSpace,
    /// How it is searched.
    pub optimizer: Optimizer,
    /// What exported files say about their origin.
    pub export: Export,
}

/// Samples at `epoch + k step_s` for every k from 0 with `k step_s < duration_h`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeSpan {
    /// The first sample, UTC.
    pub epoch: DateTime<Utc>,
    /// Length, hours.
    pub duration_h: f64,
    /// Interval between samples, seconds.
    pub step_s: f64,
}

impl TimeSpan {
    /// Number of samples, at least 1.
    #[must_use]
    pub fn samples(&self) -> usize {
        // Both are bounded on validation; a cast from a float saturates.
        (self.steps() - STEP_SLACK).ceil().max(1.0) as usize
    }

    pub(super) fn steps(&self) -> f64 {
        self.duration_h * 3600.0 / self.step_s
    }
}

/// The Earth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Earth {
    /// Where ground points lie.
    pub surface: Surface,
}

/// The motion of the LEO design.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Propagation {
    /// The model of the motion.
    pub model: Model,
}

/// The points where the receivers are.
#[derive(Debug, Clone, PartialEq)]
pub enum Region {
    /// A grid in latitude and longitude.
    Grid(Grid),
    /// The points of a CSV file.
    Points {
        /// The path as written; relative to the scenario file.
        file: String,
    },
}

/// `floor((high - low)/step + 1e-9) + 1` latitudes from the south by as many longitudes from the west.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Southern and northern limit, degrees, -90 to 90.
    pub latitude_deg: [f64; 2],
    /// Western and eastern limit, degrees; the second is never below the
    /// first and at most 360 above it.
    pub longitude_deg: [f64; 2],
    /// Step in latitude and in longitude, degrees.
    pub step_deg: [f64; 2],
    /// How the points count in a mean.
    pub weights: PointWeights,
}

impl Grid {
    /// Number of points, before a closing meridian is dropped.
    pub(super) fn points(&self) -> f64 {
        count(self.latitude_deg, self.step_deg[0]) * count(self.longitude_deg, self.step_deg[1])
    }

    /// Whether every latitude of the grid is a pole.
    pub(super) fn only_poles(&self) -> bool {
        let step = self.step_deg[0];
        let one_row = count(self.latitude_deg, step) < 2.0;
        self.latitude_deg[0].abs() == 90.0 && (one_row || step >= 180.0)
    }
}

/// Number of values from the low limit to the high one.
fn count([low, high]: [f64; 2], step: f64) -> f64 {
    ((high - low) / step + STEP_SLACK).floor() + 1.0
}

/// What a receiver sees, and when it has a solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Visibility {
    /// Lowest elevation of a visible LEO satellite, degrees.
    pub mask_deg: f64,
    /// Lowest elevation of a visible GNSS satellite, degrees.
    pub gnss_mask_deg: f64,
    /// Skyline by azimuth rising from 0 to 360, or empty: linear between its points; where it is
    /// higher than a mask it counts instead.
    pub mask_table: Vec<MaskPoint>,
    /// How a line of sight counts in the solution.
    pub weighting: ObservationWeights,
    /// A PDOP above this is no solution.
    pub pdop_cap: f64,
}

/// One point of a skyline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MaskPoint {
    /// Azimuth from north over east, degrees, 0 to 360.
    pub azimuth_deg: f64,
    /// Lowest elevation of a visible satellite there, degrees.
    pub mask_deg: f64,
}

/// The GNSS that is augmented.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GnssSetup {
    /// Built-in constellations, no one twice; may be empty.
    pub constellations: Vec<Preset>,
    /// TLE or OMM files, paths as written, relative to the scenario file.
    pub files: Vec<String>,
    /// The receiver clocks.
    pub clocks: Clocks,
}

/// What is minimized, and under which constraints.
#[derive(Debug, Clone, PartialEq)]
pub struct Objectives {
    /// One or more, no one twice; those that are [`Quantity::maximized`] are maximized.
    pub minimize: Vec<Quantity>,
    /// Weight of the tail in `j-pos`, at least 0.
    pub cvar_weight: f64,
    /// Level of the tail, strictly between 0 and 1.
    pub cvar_level: f64,
    /// What a feasible design keeps.
    pub constraints: Vec<Constraint>,
    /// The PDOP up to which a sample counts as available.
    pub availability_pdop: f64,
    /// Parameters of `launch-cost`.
    pub launch_cost: LaunchCost,
    /// One number for each objective, in its own unit. `None` when it was not given and the
    /// objectives have no usual one.
    pub hypervolume_reference: Option<Vec<f64>>,
}

/// The designs among which is searched; every interval includes its limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SearchSpace {
    /// The pattern of all designs.
    pub pattern: Pattern,
    /// Number of planes, lowest and highest.
    pub planes: [u32; 2],
    /// Number of satellites in a plane, lowest and highest.
    pub satellites_per_plane: [u32; 2],
    /// Inclination, degrees.
    pub inclination_deg: [f64; 2],
    /// Altitude over the equatorial radius, km.
    pub altitude_km: [f64; 2],
    /// Walker's F (for a lattice N_c) before it is cut; see [`SearchSpace::phasing_for`].
    pub phasing: [u32; 2],
    /// Eccentricity, lowest and highest.
    pub eccentricity: [f64; 2],
    /// Argument of perigee, degrees.
    pub arg_perigee_deg: [f64; 2],
    /// Step of an exhaustive search in inclination, degrees.
    pub inclination_step_deg: f64,
    /// Step of an exhaustive search in altitude, km.
    pub altitude_step_km: f64,
    /// Step of an exhaustive search in eccentricity.
    pub eccentricity_step: f64,
    /// Step of an exhaustive search in argument of perigee, degrees.
    pub arg_perigee_step_deg: f64,
}

impl SearchSpace {
    /// The phasing allowed with `planes` planes: both limits cut at `planes - 1`.
    #[must_use]
    pub fn phasing_for(&self, planes: u32) -> [u32; 2] {
        self.phasing
            .map(|limit| limit.min(planes.saturating_sub(1)))
    }

    /// At most so many designs has an exhaustive search.
    pub(super) fn designs(&self) -> f64 {
        let whole = |limits: [u32; 2]| count(limits.map(f64::from), 1.0);
        whole(self.planes)
            * whole(self.satellites_per_plane)
            * whole(self.phasing)
            * count(self.inclination_deg, self.inclination_step_deg)
            * count(self.altitude_km, self.altitude_step_km)
            * count(self.eccentricity, self.eccentricity_step)
            * count(self.arg_perigee_deg, self.arg_perigee_step_deg)
    }
}

/// How it is searched.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Optimizer {
    /// The strategy.
    pub algorithm: Algorithm,
    /// Designs in a generation.
    pub population: u32,
    /// Number of generations.
    pub generations: u32,
    /// Probability that two parents are crossed.
    pub crossover_probability: f64,
    /// Probability that a variable is mutated.
    pub mutation_probability: f64,
    /// Distribution index of simulated binary crossover.
    pub crossover_index: f64,
    /// Distribution index of polynomial mutation.
    pub mutation_index: f64,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// What exported files say about their origin.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Export {
    /// Who made the file (CCSDS `ORIGINATOR`).
    pub originator: String,
    /// When (CCSDS `CREATION_DATE`); the epoch of the study unless given, for a result holds no wall time.
    pub creation_date: DateTime<Utc>,
}

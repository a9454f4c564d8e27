//! The keys themselves, in the order in which they are written.

use chrono::DateTime;

use super::{AnyKey, Key, Otherwise};
use crate::scenario::resolved::{Grid, Region, Scenario};
use crate::scenario::rule::{
    Constraints, Eastward, Instant, Integer, Interval, Number, Numbers, OneOf, Paths, Skyline,
    SomeOf, Steps, Text,
};
use crate::scenario::{
    Algorithm, Clocks, Model, Pattern, PointWeights, Preset, Quantity, Surface, Weighting,
};

/// The most satellites of one design.
pub(in crate::scenario) const MOST_SATELLITES: u32 = 100_000;

/// Every key, by section.
pub(in crate::scenario) static KEYS: &[&dyn AnyKey] = &[
    &NAME,
    &REFERENCE_DESIGN,
    &EPOCH,
    &DURATION_H,
    &STEP_S,
    &SURFACE,
    &MODEL,
    &LATITUDE_DEG,
    &LONGITUDE_DEG,
    &STEP_DEG,
    &WEIGHTS,
    &POINTS,
    &MASK_DEG,
    &GNSS_MASK_DEG,
    &MASK_TABLE,
    &WEIGHTING,
    &PDOP_CAP,
    &CONSTELLATIONS,
    &FILES,
    &CLOCKS,
    &MINIMIZE,
    &CVAR_WEIGHT,
    &CVAR_LEVEL,
    &CONSTRAINTS,
    &AVAILABILITY_PDOP,
    &HYPERVOLUME_REFERENCE,
    &PATTERN,
    &PLANES,
    &SATELLITES_PER_PLANE,
    &INCLINATION_DEG,
    &ALTITUDE_KM,
    &PHASING,
    &INCLINATION_STEP_DEG,
    &ALTITUDE_STEP_KM,
    &ALGORITHM,
    &POPULATION,
    &GENERATIONS,
    &CROSSOVER_PROBABILITY,
    &MUTATION_PROBABILITY,
    &SEED,
    &ORIGINATOR,
    &CREATION_DATE,
];

pub(in crate::scenario) static NAME: Key<Text> = Key {
    section: "",
    name: "name",
    unit: "",
    meaning: "Name of the study, also part of the default output directory",
    rule: Text::Name,
    otherwise: Otherwise::Value(|| "scenario".to_owned()),
    of: |s| Some(s.name.clone()),
};

pub(in crate::scenario) static REFERENCE_DESIGN: Key<Text> = Key {
    section: "",
    name: "reference-design",
    unit: "",
    meaning: "Design that is validated when none is named, in Walker notation pattern:inclination:T/P/F@altitude",
    rule: Text::Any,
    otherwise: Otherwise::Value(|| "delta:55:182/13/1@925".to_owned()),
    of: |s| Some(s.reference_design.clone()),
};

pub(in crate::scenario) static EPOCH: Key<Instant> = Key {
    section: "time",
    name: "epoch",
    unit: "",
    meaning: "First sample, UTC; the first satellite of a design is at its node then",
    rule: Instant,
    otherwise: Otherwise::Value(|| DateTime::from_timestamp_nanos(1_735_689_600_000_000_000)),
    of: |s| Some(s.time.epoch),
};

pub(in crate::scenario) static DURATION_H: Key<Number> = Key {
    section: "time",
    name: "duration-h",
    unit: "h",
    meaning: "Length of the study; the closing instant is no sample",
    rule: Number::above_to(0.0, 366.0 * 24.0),
    otherwise: Otherwise::Value(|| 24.0),
    of: |s| Some(s.time.duration_h),
};

pub(in crate::scenario) static STEP_S: Key<Number> = Key {
    section: "time",
    name: "step-s",
    unit: "s",
    meaning: "Interval between samples",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 60.0),
    of: |s| Some(s.time.step_s),
};

pub(in crate::scenario) static SURFACE: Key<OneOf<Surface>> = Key {
    section: "earth",
    name: "surface",
    unit: "",
    meaning: "Surface on which ground points lie and to which their verticals belong",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Surface::Wgs84),
    of: |s| Some(s.earth.surface),
};

pub(in crate::scenario) static MODEL: Key<OneOf<Model>> = Key {
    section: "propagation",
    name: "model",
    unit: "",
    meaning: "Motion of the LEO design; GNSS constellations are always flown as they are defined",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Model::J2),
    of: |s| Some(s.propagation.model),
};

pub(in crate::scenario) static LATITUDE_DEG: Key<Interval<Number>> = Key {
    section: "region",
    name: "latitude-deg",
    unit: "deg",
    meaning: "Southern and northern limit of the grid",
    rule: Interval {
        of: Number::from_to(-90.0, 90.0),
        or_single: false,
    },
    otherwise: Otherwise::Value(|| [3.0, 54.0]),
    of: |s| grid(s).map(|grid| grid.latitude_deg),
};

pub(in crate::scenario) static LONGITUDE_DEG: Key<Eastward> = Key {
    section: "region",
    name: "longitude-deg",
    unit: "deg",
    meaning: "Western and eastern limit of the grid; [160, -155] runs over the date line",
    rule: Eastward,
    otherwise: Otherwise::Value(|| [73.0, 136.0]),
    of: |s| grid(s).map(|grid| grid.longitude_deg),
};

pub(in crate::scenario) static STEP_DEG: Key<Steps> = Key {
    section: "region",
    name: "step-deg",
    unit: "deg",
    meaning: "Step of the grid from its south-western corner",
    rule: Steps(Number::above_to(0.0, 360.0)),
    otherwise: Otherwise::Value(|| [5.0, 5.0]),
    of: |s| grid(s).map(|grid| grid.step_deg),
};

pub(in crate::scenario) static WEIGHTS: Key<OneOf<PointWeights>> = Key {
    section: "region",
    name: "weights",
    unit: "",
    meaning: "How the points of the grid count in a mean",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| PointWeights::Equal),
    of: |s| grid(s).map(|grid| grid.weights),
};

pub(in crate::scenario) static POINTS: Key<Text> = Key {
    section: "region",
    name: "points",
    unit: "",
    meaning: "CSV file latitude_deg,longitude_deg[,weight] in place of the grid, path relative to this file",
    rule: Text::Any,
    otherwise: Otherwise::Follows {
        what: "the grid",
        example: || "points.csv".to_owned(),
    },
    of: points_file,
};

pub(in crate::scenario) static MASK_DEG: Key<Number> = Key {
    section: "visibility",
    name: "mask-deg",
    unit: "deg",
    meaning: "Lowest elevation of a visible LEO satellite",
    rule: Number::from_below(0.0, 90.0),
    otherwise: Otherwise::Value(|| 7.0),
    of: |s| Some(s.visibility.mask_deg),
};

pub(in crate::scenario) static GNSS_MASK_DEG: Key<Number> = Key {
    section: "visibility",
    name: "gnss-mask-deg",
    unit: "deg",
    meaning: "Lowest elevation of a visible GNSS satellite",
    rule: Number::from_below(0.0, 90.0),
    otherwise: Otherwise::Follows {
        what: "mask-deg",
        example: || 7.0,
    },
    of: |s| Some(s.visibility.gnss_mask_deg),
};

pub(in crate::scenario) static MASK_TABLE: Key<Skyline> = Key {
    section: "visibility",
    name: "mask-table",
    unit: "deg",
    meaning: "Skyline [[azimuth, mask], ...], linear between its points and across north; counts where it is higher than a mask",
    rule: Skyline,
    otherwise: Otherwise::Value(|| Vec::new()),
    of: |s| Some(s.visibility.mask_table.clone()),
};

pub(in crate::scenario) static WEIGHTING: Key<OneOf<Weighting>> = Key {
    section: "visibility",
    name: "weighting",
    unit: "",
    meaning: "How a line of sight counts in the least-squares solution",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Weighting::Unit),
    of: |s| Some(s.visibility.weighting),
};

pub(in crate::scenario) static PDOP_CAP: Key<Number> = Key {
    section: "visibility",
    name: "pdop-cap",
    unit: "",
    meaning: "PDOP above which a sample has no solution",
    rule: Number::above(1.0),
    otherwise: Otherwise::Value(|| 100.0),
    of: |s| Some(s.visibility.pdop_cap),
};

pub(in crate::scenario) static CONSTELLATIONS: Key<SomeOf<Preset>> = Key {
    section: "gnss",
    name: "constellations",
    unit: "",
    meaning: "Built-in GNSS constellations that the design augments",
    rule: SomeOf::at_least(0),
    otherwise: Otherwise::Value(|| vec![Preset::Beidou3]),
    of: |s| Some(s.gnss.constellations.clone()),
};

pub(in crate::scenario) static FILES: Key<Paths> = Key {
    section: "gnss",
    name: "files",
    unit: "",
    meaning: "TLE or OMM files of GNSS satellites, paths relative to this file",
    rule: Paths,
    otherwise: Otherwise::Value(|| Vec::new()),
    of: |s| Some(s.gnss.files.clone()),
};

pub(in crate::scenario) static CLOCKS: Key<OneOf<Clocks>> = Key {
    section: "gnss",
    name: "clocks",
    unit: "",
    meaning: "Receiver clocks solved for beside the position",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Clocks::PerSystem),
    of: |s| Some(s.gnss.clocks),
};

pub(in crate::scenario) static MINIMIZE: Key<SomeOf<Quantity>> = Key {
    section: "objectives",
    name: "minimize",
    unit: "",
    meaning: "Objectives; a name carries its direction, so mean-visible and availability are maximized",
    rule: SomeOf::at_least(1),
    otherwise: Otherwise::Value(|| vec![Quantity::JPos, Quantity::JCost]),
    of: |s| Some(s.objectives.minimize.clone()),
};

pub(in crate::scenario) static CVAR_WEIGHT: Key<Number> = Key {
    section: "objectives",
    name: "cvar-weight",
    unit: "",
    meaning: "Weight of the tail in j-pos, the mean PDOP plus weight times CVaR",
    rule: Number::at_least(0.0),
    otherwise: Otherwise::Value(|| 0.5),
    of: |s| Some(s.objectives.cvar_weight),
};

pub(in crate::scenario) static CVAR_LEVEL: Key<Number> = Key {
    section: "objectives",
    name: "cvar-level",
    unit: "",
    meaning: "Level of the tail; 0.95 is the mean of the worst twentieth",
    rule: Number::between(0.0, 1.0),
    otherwise: Otherwise::Value(|| 0.95),
    of: |s| Some(s.objectives.cvar_level),
};

pub(in crate::scenario) static CONSTRAINTS: Key<Constraints> = Key {
    section: "objectives",
    name: "constraints",
    unit: "",
    meaning: "What a feasible design keeps, of the same quantities as the objectives",
    rule: Constraints,
    otherwise: Otherwise::Value(|| Vec::new()),
    of: |s| Some(s.objectives.constraints.clone()),
};

pub(in crate::scenario) static AVAILABILITY_PDOP: Key<Number> = Key {
    section: "objectives",
    name: "availability-pdop",
    unit: "",
    meaning: "PDOP up to which a sample counts as available",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 6.0),
    of: |s| Some(s.objectives.availability_pdop),
};

pub(in crate::scenario) static HYPERVOLUME_REFERENCE: Key<Numbers> = Key {
    section: "objectives",
    name: "hypervolume-reference",
    unit: "",
    meaning: "Reference point of the hypervolume, one number for each objective",
    rule: Numbers,
    otherwise: Otherwise::Follows {
        what: "2 for j-pos, 22 for j-cost, none with other objectives",
        example: || vec![2.0, 22.0],
    },
    of: |s| s.objectives.hypervolume_reference.clone(),
};

pub(in crate::scenario) static PATTERN: Key<OneOf<Pattern>> = Key {
    section: "search",
    name: "pattern",
    unit: "",
    meaning: "Pattern of the designs",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Pattern::Delta),
    of: |s| Some(s.search.pattern),
};

pub(in crate::scenario) static PLANES: Key<Interval<Integer<u32>>> = Key {
    section: "search",
    name: "planes",
    unit: "",
    meaning: "Number of planes",
    rule: count(1, MOST_SATELLITES),
    otherwise: Otherwise::Value(|| [11, 15]),
    of: |s| Some(s.search.planes),
};

pub(in crate::scenario) static SATELLITES_PER_PLANE: Key<Interval<Integer<u32>>> = Key {
    section: "search",
    name: "satellites-per-plane",
    unit: "",
    meaning: "Number of satellites in a plane",
    rule: count(1, MOST_SATELLITES),
    otherwise: Otherwise::Value(|| [11, 15]),
    of: |s| Some(s.search.satellites_per_plane),
};

pub(in crate::scenario) static INCLINATION_DEG: Key<Interval<Number>> = Key {
    section: "search",
    name: "inclination-deg",
    unit: "deg",
    meaning: "Inclination",
    rule: Interval {
        of: Number::from_to(0.0, 180.0),
        or_single: true,
    },
    otherwise: Otherwise::Value(|| [40.0, 60.0]),
    of: |s| Some(s.search.inclination_deg),
};

pub(in crate::scenario) static ALTITUDE_KM: Key<Interval<Number>> = Key {
    section: "search",
    name: "altitude-km",
    unit: "km",
    meaning: "Altitude over the equatorial radius",
    rule: Interval {
        of: Number::above_to(0.0, 100_000.0),
        or_single: true,
    },
    otherwise: Otherwise::Value(|| [400.0, 1000.0]),
    of: |s| Some(s.search.altitude_km),
};

pub(in crate::scenario) static PHASING: Key<Interval<Integer<u32>>> = Key {
    section: "search",
    name: "phasing",
    unit: "",
    meaning: "Walker's F, or N_c of a lattice, cut at the number of planes less one",
    rule: count(0, MOST_SATELLITES),
    otherwise: Otherwise::Value(|| [1, 1]),
    of: |s| Some(s.search.phasing),
};

pub(in crate::scenario) static INCLINATION_STEP_DEG: Key<Number> = Key {
    section: "search",
    name: "inclination-step-deg",
    unit: "deg",
    meaning: "Step of an exhaustive search in inclination",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 0.5),
    of: |s| Some(s.search.inclination_step_deg),
};

pub(in crate::scenario) static ALTITUDE_STEP_KM: Key<Number> = Key {
    section: "search",
    name: "altitude-step-km",
    unit: "km",
    meaning: "Step of an exhaustive search in altitude",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 50.0),
    of: |s| Some(s.search.altitude_step_km),
};

pub(in crate::scenario) static ALGORITHM: Key<OneOf<Algorithm>> = Key {
    section: "optimizer",
    name: "algorithm",
    unit: "",
    meaning: "Strategy of the search",
    rule: OneOf::new(),
    otherwise: Otherwise::Value(|| Algorithm::Nsga2),
    of: |s| Some(s.optimizer.algorithm),
};

pub(in crate::scenario) static POPULATION: Key<Integer<u32>> = Key {
    section: "optimizer",
    name: "population",
    unit: "",
    meaning: "Designs in a generation",
    rule: Integer {
        low: 4,
        high: 10_000,
    },
    otherwise: Otherwise::Value(|| 30),
    of: |s| Some(s.optimizer.population),
};

pub(in crate::scenario) static GENERATIONS: Key<Integer<u32>> = Key {
    section: "optimizer",
    name: "generations",
    unit: "",
    meaning: "Number of generations",
    rule: Integer {
        low: 1,
        high: 1_000_000,
    },
    otherwise: Otherwise::Value(|| 30),
    of: |s| Some(s.optimizer.generations),
};

pub(in crate::scenario) static CROSSOVER_PROBABILITY: Key<Number> = Key {
    section: "optimizer",
    name: "crossover-probability",
    unit: "",
    meaning: "Probability that two parents are crossed",
    rule: Number::from_to(0.0, 1.0),
    otherwise: Otherwise::Value(|| 0.8),
    of: |s| Some(s.optimizer.crossover_probability),
};

pub(in crate::scenario) static MUTATION_PROBABILITY: Key<Number> = Key {
    section: "optimizer",
    name: "mutation-probability",
    unit: "",
    meaning: "Probability that a variable is mutated",
    rule: Number::from_to(0.0, 1.0),
    otherwise: Otherwise::Value(|| 0.1),
    of: |s| Some(s.optimizer.mutation_probability),
};

pub(in crate::scenario) static SEED: Key<Integer<u64>> = Key {
    section: "optimizer",
    name: "seed",
    unit: "",
    meaning: "Seed of the random numbers; the same seed gives the same result",
    rule: Integer {
        low: 0,
        high: u64::MAX,
    },
    otherwise: Otherwise::Value(|| 1),
    of: |s| Some(s.optimizer.seed),
};

pub(in crate::scenario) static ORIGINATOR: Key<Text> = Key {
    section: "export",
    name: "originator",
    unit: "",
    meaning: "Who made an exported file (CCSDS ORIGINATOR)",
    rule: Text::Ascii,
    otherwise: Otherwise::Value(|| "NAVWALKER".to_owned()),
    of: |s| Some(s.export.originator.clone()),
};

pub(in crate::scenario) static CREATION_DATE: Key<Instant> = Key {
    section: "export",
    name: "creation-date",
    unit: "",
    meaning: "When an exported file was made (CCSDS CREATION_DATE); never the wall clock, so that the same run gives the same bytes",
    rule: Instant,
    otherwise: Otherwise::Follows {
        what: "time.epoch",
        example: || DateTime::from_timestamp_nanos(1_735_689_600_000_000_000),
    },
    of: |s| Some(s.export.creation_date),
};

const fn count(low: u32, high: u32) -> Interval<Integer<u32>> {
    Interval {
        of: Integer { low, high },
        or_single: true,
    }
}

fn grid(scenario: &Scenario) -> Option<&Grid> {
    match &scenario.region {
        Region::Grid(grid) => Some(grid),
        Region::Points { .. } => None,
    }
}

fn points_file(scenario: &Scenario) -> Option<String> {
    match &scenario.region {
        Region::Grid(_) => None,
        Region::Points { file } => Some(file.clone()),
    }
}

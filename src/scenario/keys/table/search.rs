//! The keys of the search and of what leaves it: objectives, designs, optimizer, export.

use chrono::DateTime;

use crate::scenario::keys::{Key, Otherwise};
use crate::scenario::rule::{
    Constraints, Instant, Integer, Interval, Number, Numbers, OneOf, SomeOf, Text,
};
use crate::scenario::{Algorithm, Pattern, Quantity};

/// The most satellites of one design.
pub(in crate::scenario) const MOST_SATELLITES: u32 = 100_000;

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
    otherwise: Otherwise::Value(Vec::new),
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

pub(in crate::scenario) static LAUNCH_COST_PER_SATELLITE: Key<Number> = Key {
    section: "objectives",
    name: "launch-cost-per-satellite",
    unit: "",
    meaning: "Part of launch-cost: one satellite, before its altitude counts; the unit of the cost is yours",
    rule: Number::from_to(0.0, 1e12),
    otherwise: Otherwise::Value(|| 1.0),
    of: |s| Some(s.objectives.launch_cost.per_satellite),
};

pub(in crate::scenario) static LAUNCH_COST_PER_PLANE: Key<Number> = Key {
    section: "objectives",
    name: "launch-cost-per-plane",
    unit: "",
    meaning: "Part of launch-cost: opening one plane, in the same unit",
    rule: Number::from_to(0.0, 1e12),
    otherwise: Otherwise::Value(|| 5.0),
    of: |s| Some(s.objectives.launch_cost.per_plane),
};

pub(in crate::scenario) static LAUNCH_COST_PER_1000_KM: Key<Number> = Key {
    section: "objectives",
    name: "launch-cost-per-1000-km",
    unit: "",
    meaning: "Part of launch-cost: the share that a satellite costs more for each 1000 km of altitude",
    rule: Number::from_to(0.0, 1e12),
    otherwise: Otherwise::Value(|| 0.2),
    of: |s| Some(s.objectives.launch_cost.per_1000_km),
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

pub(in crate::scenario) static ECCENTRICITY: Key<Interval<Number>> = Key {
    section: "search",
    name: "eccentricity",
    unit: "",
    meaning: "Eccentricity; a variable of the search where the limits differ",
    rule: Interval {
        of: Number::from_below(0.0, 0.9),
        or_single: true,
    },
    otherwise: Otherwise::Value(|| [0.0, 0.0]),
    of: |s| Some(s.search.eccentricity),
};

pub(in crate::scenario) static ARG_PERIGEE_DEG: Key<Interval<Number>> = Key {
    section: "search",
    name: "arg-perigee-deg",
    unit: "deg",
    meaning: "Argument of perigee; a variable of the search where the limits differ",
    rule: Interval {
        of: Number::from_to(0.0, 360.0),
        or_single: true,
    },
    otherwise: Otherwise::Value(|| [0.0, 0.0]),
    of: |s| Some(s.search.arg_perigee_deg),
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

pub(in crate::scenario) static ECCENTRICITY_STEP: Key<Number> = Key {
    section: "search",
    name: "eccentricity-step",
    unit: "",
    meaning: "Step of an exhaustive search in eccentricity",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 0.005),
    of: |s| Some(s.search.eccentricity_step),
};

pub(in crate::scenario) static ARG_PERIGEE_STEP_DEG: Key<Number> = Key {
    section: "search",
    name: "arg-perigee-step-deg",
    unit: "deg",
    meaning: "Step of an exhaustive search in argument of perigee",
    rule: Number::above(0.0),
    otherwise: Otherwise::Value(|| 30.0),
    of: |s| Some(s.search.arg_perigee_step_deg),
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

pub(in crate::scenario) static CROSSOVER_INDEX: Key<Number> = Key {
    section: "optimizer",
    name: "crossover-index",
    unit: "",
    meaning: "Distribution index of simulated binary crossover; larger keeps children closer to their parents",
    rule: Number::at_least(0.0),
    otherwise: Otherwise::Value(|| 5.0),
    of: |s| Some(s.optimizer.crossover_index),
};

pub(in crate::scenario) static MUTATION_INDEX: Key<Number> = Key {
    section: "optimizer",
    name: "mutation-index",
    unit: "",
    meaning: "Distribution index of polynomial mutation; larger makes smaller steps",
    rule: Number::at_least(0.0),
    otherwise: Otherwise::Value(|| 10.0),
    of: |s| Some(s.optimizer.mutation_index),
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

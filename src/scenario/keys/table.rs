//! The keys themselves, in the order in which they are written.

mod search;
mod setting;

pub(in crate::scenario) use search::*;
pub(in crate::scenario) use setting::*;

use super::AnyKey;

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
    &LAUNCH_COST_PER_SATELLITE,
    &LAUNCH_COST_PER_PLANE,
    &LAUNCH_COST_PER_1000_KM,
    &HYPERVOLUME_REFERENCE,
    &PATTERN,
    &PLANES,
    &SATELLITES_PER_PLANE,
    &INCLINATION_DEG,
    &ALTITUDE_KM,
    &PHASING,
    &ECCENTRICITY,
    &ARG_PERIGEE_DEG,
    &INCLINATION_STEP_DEG,
    &ALTITUDE_STEP_KM,
    &ECCENTRICITY_STEP,
    &ARG_PERIGEE_STEP_DEG,
    &ALGORITHM,
    &POPULATION,
    &GENERATIONS,
    &CROSSOVER_PROBABILITY,
    &MUTATION_PROBABILITY,
    &CROSSOVER_INDEX,
    &MUTATION_INDEX,
    &SEED,
    &ORIGINATOR,
    &CREATION_DATE,
];

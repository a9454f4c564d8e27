//! The search space and the settings of the search.

use super::count;
use crate::earth::RADIUS_KM;
use crate::scenario::keys::{key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Integer, Interval, Number, OneOf};
use crate::scenario::{Algorithm, Pattern};
use crate::search::DesignSpace;

/// Maximum number of satellites of a design.
const MAX_SATELLITES: u32 = 100_000;

section! {
    /// The search space.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct SearchSpace in "search" {
        /// The designs; every interval includes its limits.
        pub designs: DesignSpace;
        /// Step of an exhaustive search in inclination.
        pub inclination_step_deg: f64 = Number::above(0.0), unit "deg", default 0.5;
        /// Step of an exhaustive search in altitude.
        pub altitude_step_km: f64 = Number::above(0.0), unit "km", default 50.0;
        /// Step of an exhaustive search in eccentricity.
        pub eccentricity_step: f64 = Number::above(0.0), default 0.005;
        /// Step of an exhaustive search in argument of perigee.
        pub arg_perigee_step_deg: f64 = Number::above(0.0), unit "deg", default 30.0;
    }
}

section! {
    impl DesignSpace in "search", finish finish_designs {
        /// Pattern of the designs.
        pattern = OneOf::new(), default Pattern::Delta;
        /// Number of planes.
        planes = integers(1, MAX_SATELLITES), default [11, 15];
        /// Number of satellites per plane.
        satellites_per_plane = integers(1, MAX_SATELLITES), default [11, 15];
        /// Inclination.
        inclination_deg = numbers(Number::from_to(0.0, 180.0)), unit "deg", default [40.0, 60.0];
        /// Altitude over the equatorial radius.
        altitude_km = numbers(Number::above_to(0.0, 100_000.0)), unit "km",
            default [400.0, 1000.0];
        /// Walker's F, or N_c of a lattice, capped at the number of planes minus one.
        phasing = integers(0, MAX_SATELLITES), default [1, 1];
        /// Eccentricity; a variable of the search if the limits differ.
        eccentricity = numbers(Number::from_below(0.0, 0.9)), default [0.0, 0.0];
        /// Argument of perigee; a variable of the search if the limits differ.
        arg_perigee_deg = numbers(Number::from_to(0.0, 360.0)), unit "deg", default [0.0, 0.0];
    }
}

impl SearchSpace {
    /// The phasing allowed with `planes` planes: both limits capped at `planes - 1`.
    #[must_use]
    pub fn phasing_for(&self, planes: u32) -> [u32; 2] {
        self.designs
            .phasing
            .map(|limit| limit.min(planes.saturating_sub(1)))
    }

    /// Upper bound on the number of designs of an exhaustive search.
    pub(super) fn design_count(&self) -> f64 {
        let whole = |limits: [u32; 2]| count(limits.map(f64::from), 1.0);
        let designs = &self.designs;
        whole(designs.planes)
            * whole(designs.satellites_per_plane)
            * whole(designs.phasing)
            * count(designs.inclination_deg, self.inclination_step_deg)
            * count(designs.altitude_km, self.altitude_step_km)
            * count(designs.eccentricity, self.eccentricity_step)
            * count(designs.arg_perigee_deg, self.arg_perigee_step_deg)
    }
}

const fn integers(low: u32, high: u32) -> Interval<Integer<u32>> {
    Interval {
        of: Integer { low, high },
        or_single: true,
    }
}

const fn numbers(of: Number) -> Interval<Number> {
    Interval {
        of,
        or_single: true,
    }
}

fn finish_designs(designs: &mut DesignSpace, reader: &mut Reader<'_>) {
    finish_phasing(designs, reader);
    let [planes, per_plane] = [designs.planes[1], designs.satellites_per_plane[1]].map(f64::from);
    let keys = [
        key!(DesignSpace.planes),
        key!(DesignSpace.satellites_per_plane),
    ];
    let most = MAX_SATELLITES.into();
    reader.at_most(most, planes * per_plane, "satellites in a design", &keys);
    check_above_ground(designs, reader);
}

/// The default phasing is capped for a search with a single plane, where only 0 exists.
fn finish_phasing(designs: &mut DesignSpace, reader: &mut Reader<'_>) {
    let key = key!(DesignSpace.phasing);
    let planes = designs.planes[1];
    let highest = planes - 1;
    if !reader.is_given(key) {
        designs.phasing = designs.phasing.map(|limit| limit.min(highest));
    }
    let lowest = designs.phasing[0];
    if lowest > highest && !reader.is_wrong(key!(DesignSpace.planes)) {
        reader.refuse(&[key], Fault::PhasingAbovePlanes { lowest, planes });
    }
}

/// At least the roundest and highest design of a search has its perigee above ground.
fn check_above_ground(designs: &DesignSpace, reader: &mut Reader<'_>) {
    let (eccentricity, altitude_km) = (designs.eccentricity[0], designs.altitude_km[1]);
    let perigee_km = (RADIUS_KM + altitude_km) * (1.0 - eccentricity) - RADIUS_KM;
    if perigee_km <= 0.0 {
        let keys = [
            key!(DesignSpace.eccentricity),
            key!(DesignSpace.altitude_km),
        ];
        let fault = Fault::Underground {
            eccentricity,
            altitude_km,
            perigee_km,
        };
        reader.refuse(&keys, fault);
    }
}

section! {
    /// The algorithm of the search and its settings.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Optimizer in "optimizer" {
        /// Strategy of the search.
        pub algorithm: Algorithm = OneOf::new(), default Algorithm::Nsga2;
        /// Designs per generation.
        pub population: u32 = Integer { low: 4, high: 10_000 }, default 30;
        /// Number of generations.
        pub generations: u32 = Integer { low: 1, high: 1_000_000 }, default 30;
        /// Probability that two parents are crossed.
        pub crossover_probability: f64 = Number::from_to(0.0, 1.0), default 0.8;
        /// Probability that a variable is mutated.
        pub mutation_probability: f64 = Number::from_to(0.0, 1.0), default 0.1;
        /// Distribution index of simulated binary crossover; larger keeps children closer to their
        /// parents.
        pub crossover_index: f64 = Number::at_least(0.0), default 5.0;
        /// Distribution index of polynomial mutation; larger makes smaller steps.
        pub mutation_index: f64 = Number::at_least(0.0), default 10.0;
        /// Seed of the random numbers; the same seed gives the same result.
        pub seed: u64 = Integer { low: 0, high: u64::MAX }, default 1;
    }
}

//! The objectives and constraints of the search.

use crate::scenario::keys::{key, section};
use crate::scenario::problem::Fault;
use crate::scenario::reader::Reader;
use crate::scenario::rule::{Constraints, Number, Numbers, Optional, SomeOf};
use crate::scenario::{Constraint, LaunchCost, Quantity};

section! {
    /// What is minimized, and under which constraints.
    #[derive(Debug, Clone, PartialEq)]
    pub struct Objectives in "objectives", finish finish_reference {
        /// Objectives; a name carries its direction, so mean-visible and availability are maximized.
        pub minimize: Vec<Quantity> = SomeOf::at_least(1),
            default vec![Quantity::JPos, Quantity::JCost];
        /// Weight of the tail in j-pos, the mean PDOP plus weight times CVaR.
        pub cvar_weight: f64 = Number::at_least(0.0), default 0.5;
        /// Level of CVaR; 0.95 means the mean of the worst 5 %.
        pub cvar_level: f64 = Number::between(0.0, 1.0), default 0.95;
        /// Bounds that a feasible design must meet, on the same quantities as the objectives.
        pub constraints: Vec<Constraint> = Constraints, default Vec::new();
        /// PDOP up to which a sample counts as available.
        pub availability_pdop: f64 = Number::above(0.0), default 6.0;
        /// Parameters of `launch-cost`.
        pub launch_cost: LaunchCost;
        /// Reference point of the hypervolume, one number for each objective; if no design of the
        /// front dominates it, the run chooses its own.
        pub hypervolume_reference: Option<Vec<f64>> = Optional(Numbers),
            follows "2 for j-pos, 22 for j-cost, chosen from the run with other objectives",
            example Some(vec![2.0, 22.0]);
    }
}

section! {
    impl LaunchCost in "objectives", prefix "launch-cost-" {
        /// Part of launch-cost: one satellite at zero altitude, in any unit of cost.
        per_satellite = Number::from_to(0.0, 1e12), default 1.0;
        /// Part of launch-cost: one plane, in the same unit.
        per_plane = Number::from_to(0.0, 1e12), default 5.0;
        /// Part of launch-cost: fraction by which a satellite costs more for each 1000 km of altitude.
        per_1000_km = Number::from_to(0.0, 1e12), default 0.2;
    }
}

/// The reference point as given, or the default of the objectives if they have one.
fn finish_reference(objectives: &mut Objectives, reader: &mut Reader<'_>) {
    let key = key!(Objectives.hypervolume_reference);
    if !reader.is_given(key) {
        let quantities = objectives.minimize.iter();
        objectives.hypervolume_reference = quantities
            .map(|quantity| quantity.default_reference())
            .collect();
        return;
    }
    let found = objectives
        .hypervolume_reference
        .as_ref()
        .map_or(0, Vec::len);
    let expected = objectives.minimize.len();
    if found != expected && !reader.is_wrong(key!(Objectives.minimize)) {
        reader.refuse(&[key], Fault::Length { found, expected });
    }
}

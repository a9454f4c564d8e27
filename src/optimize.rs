//! Multi-objective optimisation that knows nothing of satellites.
//!
//! A [`Problem`] has variables with bounds, objectives that are all minimised, and
//! one constraint violation; a [`Strategy`] sends it batches of genomes, one batch
//! a step, and keeps everything that the next step needs in a state that can be
//! written and read back.

mod archive;
mod decision;
mod error;
mod exhaustive;
mod generator;
mod hypervolume;
mod method;
mod mopso;
mod nsga2;
mod problem;
mod random;
mod sorting;
mod strategy;
#[cfg(test)]
mod test_problems;
mod variation;

pub use decision::{DecisionError, Memberships, best, fuzzy, knee, topsis};
pub use error::OptimizeError;
pub use exhaustive::{Exhaustive, ExhaustiveConfig};
pub use hypervolume::hypervolume;
pub use method::{Method, Search};
pub use mopso::{Mopso, MopsoConfig};
pub use nsga2::{Nsga2, Nsga2Config};
pub use problem::{Evaluation, Individual, Kind, Problem, Space, Variable};
pub use random::{RandomConfig, RandomSearch};
pub use sorting::{
    constraint_dominates, crowding_distance, dominates, feasible_front, non_dominated_sort,
    prune_one_by_one,
};
pub use strategy::{Progress, Record, Strategy};

//! Multi-objective optimisation, independent of satellites.
//!
//! A [`Problem`] has variables with bounds, objectives that are all minimised, and
//! one constraint violation; a [`Strategy`] sends it batches of genomes, one batch
//! per step, and is itself the checkpoint from which it can resume.
//!
//! ```
//! use navwalker::optimize::{
//!     Evaluation, VariableKind, Method, Nsga2Config, OptimizeError, Problem, Space, Strategy, Variable,
//! };
//!
//! struct TwoGoals(Space, [String; 2]);
//!
//! impl Problem for TwoGoals {
//!     fn space(&self) -> &Space {
//!         &self.0
//!     }
//!     fn objective_names(&self) -> &[String] {
//!         &self.1
//!     }
//!     fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
//!         let evaluate = |x: &Vec<f64>| Evaluation {
//!             objectives: vec![x[0].powi(2), (x[0] - 2.0).powi(2)],
//!             violation: 0.0,
//!         };
//!         batch.iter().map(evaluate).collect()
//!     }
//! }
//!
//! let x = Variable { name: "x".to_owned(), kind: VariableKind::Real { lo: -9.0, hi: 9.0 } };
//! let goals = ["near 0".to_owned(), "near 2".to_owned()];
//! let problem = TwoGoals(Space::new(vec![x])?, goals);
//! let mut search = Method::Nsga2(Nsga2Config::default()).start(&problem, 1)?;
//! while !search.is_done() {
//!     search.step(&problem)?;
//! }
//! assert!(search.front().iter().all(|best| (-0.1..2.1).contains(&best.genome[0])));
//! # Ok::<(), OptimizeError>(())
//! ```

mod archive;
mod decision;
mod error;
mod exhaustive;
pub(crate) mod generator;
mod grid;
mod history;
mod hypervolume;
mod method;
mod mopso;
mod near;
mod nsga2;
mod pick;
mod problem;
mod random;
mod sorting;
mod strategy;
#[cfg(test)]
mod test_problems;
mod variation;

pub use archive::front_of;
pub use decision::{DecisionError, Memberships, best, fuzzy, knee, topsis};
pub use error::OptimizeError;
pub use exhaustive::{Exhaustive, ExhaustiveConfig};
pub use generator::drawn;
pub use grid::SweepGrid;
pub use hypervolume::hypervolume;
pub use method::{Method, Search};
pub use mopso::{Mopso, MopsoConfig};
pub use nsga2::{Nsga2, Nsga2Config};
pub use pick::{Pick, Picked, UnknownPick};
pub use problem::{Evaluation, Individual, Problem, Space, Variable, VariableKind};
pub use random::{RandomConfig, RandomSearch};
pub use sorting::{
    constraint_dominates, crowding_distance, dominates, feasible_front, non_dominated_sort,
    prune_one_by_one,
};
pub use strategy::{Progress, Record, Strategy};

//! The fewest satellites that keep the constraints of a search, exactly for its samples and its grid.
//!
//! The designs of the grid are taken by rising number of satellites. Each is evaluated sample by sample, those samples
//! first in which the designs before it failed, until a rule proves that it violates a constraint. What is
//! left is evaluated in full, so that the answer is that of a sweep that evaluates everything.
//!
//! The order of the samples is learnt between batches of designs, which do not depend on the threads, and so neither
//! does any proof. It is learnt anew in each part of the walk, so that parts can be tried anywhere and in any order.

mod bound;
mod closest;
mod counts;
mod level;
mod order;
mod parts;
mod problem;
mod refine;
mod rules;
mod tail;
#[cfg(test)]
mod tests;
mod trial;
mod walk;
mod witness;

pub use closest::ClosestDesign;
pub use level::{KeptDesign, LevelSummary, RuleSaving};
pub use problem::SizeProblem;
pub use refine::RefinedDesign;
pub use walk::SizeSearch;
pub use witness::{PointWitness, RejectionBasis, Witness};

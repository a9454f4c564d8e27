//! The fewest satellites that keep the constraints of a search, exactly for its samples and its grid.
//!
//! The designs of the grid are taken by rising number of satellites. Each is evaluated sample by sample, those samples
//! first in which the designs before it failed, until a rule proves that it violates a constraint. What is
//! left is evaluated in full, so that the answer is that of a sweep that evaluates everything.
//!
//! The order of the samples is learnt between batches of designs, which do not depend on the threads, and so neither
//! does any proof.

mod bound;
mod closest;
mod counts;
mod order;
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
pub use problem::SizeProblem;
pub use refine::RefinedDesign;
pub use walk::{KeptDesign, LevelSummary, RuleSaving, SizeSearch};
pub use witness::{PointWitness, RejectionBasis, Witness};

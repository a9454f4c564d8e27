//! Published studies, reproduced: their numbers next to ours, with a computed verdict on each statement.

mod judge;
pub mod published;

pub use judge::{Expected, Statement, Verdict};

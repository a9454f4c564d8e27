//! Published studies, reproduced: their tables next to ours, with a computed verdict on each statement.

pub mod paper;

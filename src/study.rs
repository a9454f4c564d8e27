//! Published studies, repeated: their tables beside ours, each statement judged by a rule.

pub mod paper;

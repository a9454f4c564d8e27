//! What text formats share: lines with their places, findings, JSON with places, timestamps.

pub mod finding;
pub(crate) mod json;
pub(crate) mod lines;
pub(crate) mod number;
pub mod timestamp;

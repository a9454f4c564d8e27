//! Shared by the text formats: lines and JSON with their places in the file, numbers read and written, timestamps, findings.

pub mod finding;
pub(crate) mod fixed;
pub(crate) mod json;
pub(crate) mod lines;
pub(crate) mod number;
pub mod timestamp;

//! CZML: a scenario that CesiumJS shows in a browser.
//!
//! Source: *CZML Guide* (github.com/AnalyticalGraphicsInc/czml-writer/wiki): "CZML Structure",
//! "CZML Content" and "Packet". The first packet is the document; a sampled position is
//! `[seconds, x, y, z, …]` in metres, read between the samples by a Lagrange polynomial. Positions are
//! Earth-fixed, because a viewer turns INERTIAL ones without data on the Earth's orientation.
//!
//! Samples lie further apart than those of the study, as far as the polynomial stays within a metre, and
//! reach beyond both ends so that it has nodes on both sides everywhere.

mod packet;
mod read;
mod spacing;
mod value;
mod write;

pub use read::{parse, parse_kept, read};
pub use write::write;

/// Version of the format.
pub const FORMAT_VERSION: &str = "1.0";

/// Degree of the polynomials that are written: eight samples.
const DEGREE: usize = 7;

/// Error that the spacing of the samples is chosen for, km.
pub const TARGET_KM: f64 = 1e-3;

#[cfg(test)]
mod tests;

//! The files that other tools read, and what is read from theirs.
//!
//! A writer takes an `impl Write`, a reader an `impl BufRead`; no function here knows a path.
//! What a file says of itself comes from [`metadata`]; what a reader objects to is a
//! [`finding::Finding`] with the line, the column and the rule of the standard.

pub mod csv;
pub mod czml;
mod derivative;
mod element_set;
pub mod export;
pub mod finding;
pub mod fit;
pub mod fleet;
pub mod geojson;
pub mod gmat;
pub mod interpolation;
mod json;
pub mod kml;
mod kvn;
mod lines;
pub mod lint;
pub mod manifest;
pub mod metadata;
pub mod oem;
pub mod omm;
pub mod opm;
pub mod recheck;
pub mod sampled;
pub mod scene;
mod shapes;
pub mod sp3;
mod spread;
pub mod stamp;
pub mod stk;
pub mod tle;
pub mod tracks;
pub mod trajectory;
mod xml;
pub mod yuma;

pub use element_set::element_set;
pub use kvn::{Header as CcsdsHeader, Version as CcsdsVersion};
pub use spread::Spread;

use crate::ephemeris::EphemerisError;
use std::io;
use thiserror::Error;

/// Why a file is not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// The destination does not take the bytes.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A satellite has no state at an instant of the file.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// An element does not fit the columns of a TLE.
    #[error(transparent)]
    Tle(#[from] tle::TleFieldError),
    /// SP3 does not hold the satellites.
    #[error(transparent)]
    Sp3(#[from] sp3::Sp3Error),
    /// A product that shows a scenario, without one.
    #[error("{0} shows the whole scenario; it needs the region and the GNSS")]
    NoScene(&'static str),
    /// Something of the scenario that the format has no words for.
    #[error("{product} cannot say {what}; {instead}")]
    CannotSay {
        /// The product.
        product: &'static str,
        /// What it cannot say.
        what: String,
        /// What to do.
        instead: &'static str,
    },
    /// More ground points than a viewer loads.
    #[error(
        "{points} ground points are more than a viewer loads ({} for {product}); use a coarser \
         region.step-deg, or --as geojson for a GIS",
        scene::MAX_SHOWN_POINTS
    )]
    TooManyPoints {
        /// The product.
        product: &'static str,
        /// Points of the region.
        points: usize,
    },
    /// There is no name for a satellite.
    #[error(transparent)]
    Identity(#[from] metadata::IdentityError),
}

/// Why a file is not read.
#[derive(Debug, Error)]
pub enum ReadError {
    /// The source does not give the bytes.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The text breaks a rule of its format.
    #[error(transparent)]
    Rule(#[from] finding::Finding),
}

#[cfg(test)]
mod tests;

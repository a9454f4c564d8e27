//! The files that other tools read, and what is read from theirs.
//!
//! A writer takes an `impl Write`, a reader an `impl BufRead`; no function here knows a path.
//! The metadata of a file come from [`metadata`]; what a reader objects to is a
//! [`finding::Finding`] with the line, the column and the rule of the standard.

pub mod ccsds;
pub mod csv;
pub mod deployment;
mod element_set;
pub mod gmat;
pub mod kept_states;
pub mod maps;
pub mod metadata;
pub mod outages;
pub mod sem;
pub mod skies;
pub mod sp3;
pub mod stk;
pub mod terrain;
pub mod text;
pub mod tle;
pub mod trajectory;
pub mod yuma;

pub use element_set::element_set;

use crate::ephemeris::EphemerisError;
use std::io;
use text::finding;
use thiserror::Error;

/// Why a file is not written.
#[derive(Debug, Error)]
pub enum WriteError {
    /// Writing failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// A satellite has no state at an instant of the file.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// An element exceeds the columns of a TLE.
    #[error(transparent)]
    Tle(#[from] tle::TleFieldError),
    /// SP3 does not hold the satellites.
    #[error(transparent)]
    Sp3(#[from] sp3::Sp3Error),
    /// A product that shows a scenario, without one.
    #[error("{0} shows the complete scenario; it needs the region and the GNSS")]
    NoScene(&'static str),
    /// Something of the scenario that the format has no words for.
    #[error("{product} cannot hold {what}; {instead}")]
    CannotSay {
        /// The product.
        product: &'static str,
        /// What it cannot hold.
        what: String,
        /// What to do.
        instead: &'static str,
    },
    /// More ground points than a viewer loads.
    #[error(
        "{points} ground points are too many for a viewer ({} for {product}); use a coarser \
         region.step-deg, or --as geojson for a GIS",
        maps::scene::MAX_SHOWN_POINTS
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
    /// Reading failed.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The text breaks a rule of its format.
    #[error(transparent)]
    Rule(#[from] finding::Finding),
}

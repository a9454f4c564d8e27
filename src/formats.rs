//! The files that other tools read, and what is read from theirs.
//!
//! A writer takes an `impl Write`, a reader an `impl BufRead`; no function here knows a path.
//! What a file says of itself comes from [`metadata`]; what a reader objects to is a
//! [`finding::Finding`] with the line, the column and the rule of the standard.

pub mod csv;
mod derivative;
mod element_set;
pub mod export;
pub mod finding;
pub mod fit;
pub mod fleet;
pub mod interpolation;
mod json;
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
pub mod sp3;
mod spread;
pub mod stamp;
pub mod stk;
pub mod tle;
pub mod trajectory;
mod xml;

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

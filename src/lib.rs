//! Design, evaluation, export and validation of low-Earth-orbit Walker
//! constellations that augment a GNSS.
//!
//! The library does the science and talks to nobody: it opens no path, reads no
//! clock or environment and prints nothing. `ARCHITECTURE.md` has the map of the
//! modules and the direction of their imports; `docs/models.md` numbers the
//! equations that the code cites.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

#[cfg(feature = "cli")]
pub mod cli;
pub mod constellation;
pub mod dop;
pub mod earth;
pub mod ephemeris;
pub mod evaluate;
pub mod exchange;
pub mod formats;
pub mod frames;
pub mod ground;
pub mod keyword;
#[doc = include_str!("../docs/models.md")]
pub mod models {}
pub mod optimize;
pub mod orbit;
pub mod report;
pub mod run;
pub mod scenario;
pub mod search;
pub mod stats;
pub mod study;
pub mod time;
pub mod units;
#[cfg(feature = "validate")]
pub mod validate;
pub mod visibility;

//! LEO designs and GNSS constellations, with the identity of each slot.

pub mod gnss;
pub mod identity;
mod notation;
mod shell;

pub use notation::NotationError;
pub use shell::{Design, DesignError, DesignParameters, Pattern};

use crate::orbit::MeanElements;
use std::fmt;

/// The place of a satellite in a pattern: plane and place in the plane, both from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Slot {
    /// Plane, from 0.
    pub plane: usize,
    /// Place in the plane, from 0.
    pub index: usize,
}

impl fmt::Display for Slot {
    /// `P01-S01`, counted from 1, as in exported object names.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "P{:02}-S{:02}", self.plane + 1, self.index + 1)
    }
}

/// A satellite of a design.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Satellite {
    /// Where in the pattern.
    pub slot: Slot,
    /// Mean elements at the epoch, TEME.
    pub elements: MeanElements,
}

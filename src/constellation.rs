//! LEO designs and GNSS constellations, with the identity of each slot.

mod coverage_radius;
mod design;
pub mod gnss;
pub mod identity;
mod notation;
pub mod relative_nodes;
pub mod separation;
mod shell;

pub use coverage_radius::{
    COVERAGE_RADIUS_TOLERANCE_DEG, MOST_COVERING_SATELLITES, coverage_radius_deg,
};
pub use design::Design;
pub use notation::NotationError;
pub use shell::{DesignError, Orientation, Pattern, Shell, ShellParameters};

use crate::orbit::MeanElements;
use std::fmt;

/// The place of a satellite in a design: shell, plane and place in the plane, all from 0.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Slot {
    /// Shell, from 0, in a design of several.
    pub shell: Option<usize>,
    /// Plane, from 0.
    pub plane: usize,
    /// Place in the plane, from 0.
    pub index: usize,
}

impl Slot {
    /// The first place of the first plane of a single shell.
    pub const FIRST: Self = Self::new(0, 0);

    /// A place in a single shell.
    #[must_use]
    pub const fn new(plane: usize, index: usize) -> Self {
        Self {
            shell: None,
            plane,
            index,
        }
    }
}

impl fmt::Display for Slot {
    /// `P01-S01`, and `A-P01-S01` among several shells, as in the names of satellites.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(shell) = self.shell {
            write!(formatter, "{}-", shell_letters(shell))?;
        }
        write!(formatter, "P{:02}-S{:02}", self.plane + 1, self.index + 1)
    }
}

/// The letters of a shell of several: A to Z, then AA, AB, ….
#[must_use]
pub fn shell_letters(shell: usize) -> String {
    const LETTERS: usize = 26;
    let last = char::from(b'A' + (shell % LETTERS) as u8);
    match (shell / LETTERS).checked_sub(1) {
        Some(before) => format!("{}{last}", shell_letters(before)),
        None => last.to_string(),
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

//! A constellation that a page or a figure shows: its satellites and its place among the objectives.

use super::Baseline;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::search::DesignProblem;

/// A constellation that is compared with a front or with others.
pub struct Compared {
    /// The constellation.
    pub constellation: Constellation,
    /// Its satellites, on the grid of the study.
    pub ephemeris: Ephemeris,
    /// Its metrics and objectives.
    pub baseline: Baseline,
}

impl Compared {
    /// Evaluates a constellation whose satellites are propagated, beside a search that has satellites from files
    /// fixed.
    ///
    /// # Errors
    /// If one of them has no state at an instant.
    pub fn new(
        constellation: Constellation,
        ephemeris: Ephemeris,
        problem: &DesignProblem<'_>,
        fixed: Option<&FileSatellites>,
    ) -> Result<Self, EphemerisError> {
        let baseline = Baseline::of_constellation(&constellation, &ephemeris, problem, fixed)?;
        Ok(Self {
            constellation,
            ephemeris,
            baseline,
        })
    }
}

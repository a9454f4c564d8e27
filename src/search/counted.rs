//! The satellites of a constellation as the quantities of a search count them: which of them are new.

use super::Goals;
use crate::constellation::{Design, Shell};

/// The satellites of a constellation.
#[derive(Debug, Clone, Copy, Default)]
pub struct CountedSatellites<'a> {
    /// Its shells, if it has any.
    pub shells: Option<&'a Design>,
    /// Number of its satellites from files.
    pub from_files: usize,
    /// Whether all satellites from files that are fixed in the search are among those.
    pub has_fixed_files: bool,
}

/// The part of a constellation that is not fixed.
pub(super) struct NewSatellites<'a> {
    pub(super) shells: Vec<&'a Shell>,
    /// Number of satellites from files, whose planes are not known.
    pub(super) from_files: usize,
}

impl<'a> CountedSatellites<'a> {
    /// Those of a design.
    #[must_use]
    pub fn of_design(design: &'a Design) -> Self {
        Self {
            shells: Some(design),
            ..Self::default()
        }
    }

    /// Number of satellites.
    #[must_use]
    pub fn count(&self) -> usize {
        self.shells.map_or(0, Design::satellite_count) + self.from_files
    }

    /// What is new: the satellites that are not fixed, or all of them if a shell or the files that are fixed are
    /// not among them.
    pub(super) fn without_fixed(self, goals: &Goals) -> NewSatellites<'a> {
        let own = self.shells.map_or(&[][..], Design::shells);
        let all = || NewSatellites {
            shells: own.iter().collect(),
            from_files: self.from_files,
        };
        if goals.fixed_from_files > 0 && !self.has_fixed_files {
            return all();
        }
        let mut missing: Vec<&Shell> = goals.fixed.iter().flat_map(Design::shells).collect();
        let is_new = |shell: &&Shell| match missing.iter().position(|one| one == shell) {
            Some(place) => {
                missing.swap_remove(place);
                false
            }
            None => true,
        };
        let shells = own.iter().filter(is_new).collect();
        if !missing.is_empty() {
            return all();
        }
        NewSatellites {
            shells,
            from_files: self.from_files.saturating_sub(goals.fixed_from_files),
        }
    }
}

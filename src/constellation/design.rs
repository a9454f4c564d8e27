//! A design: one shell, or several that work together.

use super::shell::check_count;
use super::{DesignError, Satellite, Shell, Slot};
use crate::orbit::MeanElements;

/// A LEO constellation design: its shells, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Design {
    /// At least one.
    shells: Vec<Shell>,
}

impl From<Shell> for Design {
    fn from(shell: Shell) -> Self {
        Self {
            shells: vec![shell],
        }
    }
}

impl Design {
    /// Maximum number of satellites of a design.
    pub const MAX_SATELLITES: usize = 100_000;

    /// A design of some shells.
    ///
    /// # Errors
    /// If there is none, or their satellites exceed [`Design::MAX_SATELLITES`].
    pub fn new(shells: Vec<Shell>) -> Result<Self, DesignError> {
        if shells.is_empty() {
            return Err(DesignError::NoShell);
        }
        let counts = shells.iter().map(Shell::satellite_count);
        check_count(counts.fold(0, usize::saturating_add))?;
        Ok(Self { shells })
    }

    /// The shells.
    #[must_use]
    pub fn shells(&self) -> &[Shell] {
        &self.shells
    }

    /// The shell of a design of one.
    #[must_use]
    pub fn only_shell(&self) -> Option<&Shell> {
        match self.shells.as_slice() {
            [shell] => Some(shell),
            _ => None,
        }
    }

    /// What all shells have in common; `None` where they differ.
    #[must_use]
    pub fn common<T: PartialEq>(&self, of: impl Fn(&Shell) -> T) -> Option<T> {
        let first = of(&self.shells[0]);
        let same = self.shells.iter().all(|shell| of(shell) == first);
        same.then_some(first)
    }

    /// Satellites in all shells.
    #[must_use]
    pub fn satellite_count(&self) -> usize {
        self.shells.iter().map(Shell::satellite_count).sum()
    }

    /// Planes of all shells.
    #[must_use]
    pub fn planes(&self) -> usize {
        self.shells.iter().map(Shell::planes).sum()
    }

    /// The largest altitude of a shell over the equatorial radius, km.
    #[must_use]
    pub fn highest_altitude_km(&self) -> f64 {
        let altitudes = self.shells.iter().map(Shell::altitude_km);
        altitudes.fold(0.0, f64::max)
    }

    /// The slots, shell by shell and plane by plane.
    pub fn slots(&self) -> impl Iterator<Item = Slot> + '_ {
        let among_several = self.shells.len() > 1;
        self.shells.iter().enumerate().flat_map(move |(n, shell)| {
            shell.slots().map(move |slot| Slot {
                shell: among_several.then_some(n),
                ..slot
            })
        })
    }

    /// The satellites at the epoch, shell by shell and plane by plane.
    #[must_use]
    pub fn satellites(&self) -> Vec<Satellite> {
        let satellite = |slot| Satellite {
            slot,
            elements: self.elements(slot),
        };
        self.slots().map(satellite).collect()
    }

    /// The shell of a slot.
    ///
    /// # Panics
    /// If the slot is none of this design.
    #[must_use]
    pub fn shell_of(&self, slot: Slot) -> &Shell {
        &self.shells[slot.shell.unwrap_or(0)]
    }

    /// Mean elements of a slot at the epoch.
    ///
    /// # Panics
    /// If the slot is none of this design.
    #[must_use]
    pub fn elements(&self, slot: Slot) -> MeanElements {
        self.shell_of(slot).elements(slot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slots_of_several_shells_have_letters() {
        let hybrid: Design = "delta:53:4/2/1@1000+star:90:3/1/0@1100".parse().unwrap();
        let names: Vec<String> = hybrid.slots().map(|slot| slot.to_string()).collect();
        assert_eq!(
            names,
            [
                "A-P01-S01",
                "A-P01-S02",
                "A-P02-S01",
                "A-P02-S02",
                "B-P01-S01",
                "B-P01-S02",
                "B-P01-S03",
            ]
        );
        assert_eq!((hybrid.satellite_count(), hybrid.planes()), (7, 3));
        assert_eq!(hybrid.highest_altitude_km(), 1100.0);
        let parts = hybrid.shells().iter().flat_map(Shell::satellites);
        let elements: Vec<_> = parts.map(|satellite| satellite.elements).collect();
        let of_hybrid = hybrid.satellites();
        assert!(of_hybrid.iter().map(|s| s.elements).eq(elements));
    }

    #[test]
    fn letters_go_on_after_z() {
        let letters = [0, 25, 26, 51, 52, 701, 702].map(crate::constellation::shell_letters);
        assert_eq!(letters, ["A", "Z", "AA", "AZ", "BA", "ZZ", "AAA"]);
    }

    #[test]
    fn what_shells_share_is_told() {
        let design: Design = "delta:53:4/2/1@1000+star:90:4/2/0@1000".parse().unwrap();
        assert_eq!(design.common(Shell::altitude_km), Some(1000.0));
        assert_eq!(design.common(Shell::inclination_deg), None);
        assert!(design.only_shell().is_none());
        assert_eq!(Design::new(Vec::new()), Err(DesignError::NoShell));
    }

    #[test]
    fn the_limit_counts_all_shells() {
        let most: Shell = "delta:53:60000/100/1@1000".parse().unwrap();
        assert!(matches!(
            Design::new(vec![most; 2]),
            Err(DesignError::TooMany {
                satellites: 120_000,
                ..
            })
        ));
    }
}

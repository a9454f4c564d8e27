//! Which satellites share a colour: those of a plane in a single shell, otherwise those of a shell, and those of
//! no shell.

use super::scene::group_colour;
use crate::constellation::{Slot, shell_letters};
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite, ShellSpan};
use crate::orbit::kepler;
use std::f64::consts::TAU;

/// The groups of a constellation.
pub(crate) struct Palette {
    /// Planes of a single shell that is all there is.
    planes: Option<usize>,
    shells: usize,
    has_others: bool,
}

impl Palette {
    pub(crate) fn of(ephemeris: &Ephemeris) -> Self {
        // By slots: a shell without one of its satellites is still a group.
        let slots = || ephemeris.satellites().iter().map(|one| one.slot);
        let has_others = slots().any(|slot| slot.is_none());
        let counted = |of: fn(Slot) -> usize| slots().flatten().map(|slot| of(slot) + 1).max();
        let shells = counted(|slot| slot.shell.unwrap_or(0)).unwrap_or(0);
        let shells = shells.max(ephemeris.shells().len());
        let planes = counted(|slot| slot.plane);
        Self {
            planes: planes.filter(|_| shells == 1 && !has_others),
            shells,
            has_others,
        }
    }

    /// Identifiers and colours of the groups.
    pub(crate) fn groups(&self) -> Vec<(String, [u8; 3])> {
        let shell = |n: usize| match n < self.shells {
            true => format!("shell{}", shell_letters(n)),
            false => "others".to_owned(),
        };
        let name = |n: usize| match self.planes {
            Some(_) => format!("plane{}", n + 1),
            None => shell(n),
        };
        let count = self.count();
        (0..count)
            .map(|n| (name(n), group_colour(n, count)))
            .collect()
    }

    fn count(&self) -> usize {
        self.planes
            .unwrap_or(self.shells + usize::from(self.has_others))
    }

    /// The group of a satellite, by its place in [`Palette::groups`].
    pub(crate) fn group(&self, slot: Option<Slot>) -> usize {
        match (slot, self.planes) {
            (Some(slot), Some(_)) => slot.plane,
            (Some(slot), None) => slot.shell.unwrap_or(0),
            (None, _) => self.count().saturating_sub(1),
        }
    }

    /// The colour of a satellite.
    pub(crate) fn colour(&self, slot: Option<Slot>) -> [u8; 3] {
        group_colour(self.group(slot), self.count())
    }
}

/// The place of a satellite in words: `shell A, plane 1, place 1`.
pub(crate) fn place_text(slot: Slot) -> String {
    let shell = slot
        .shell
        .map(|shell| format!("shell {}, ", shell_letters(shell)));
    format!(
        "{}plane {}, place {}",
        shell.unwrap_or_default(),
        slot.plane + 1,
        slot.index + 1
    )
}

/// The period of a satellite without perturbations, s: of its shell, or of its state at the epoch; none if it is not
/// on a closed orbit.
pub(crate) fn period_s(
    ephemeris: &Ephemeris,
    satellite: &EphemerisSatellite,
) -> Result<Option<f64>, EphemerisError> {
    let is_of = |span: &&ShellSpan, slot: Slot| {
        let first = ephemeris.satellites()[span.first].slot;
        first.is_some_and(|first| first.shell == slot.shell)
    };
    let shells = || ephemeris.shells().iter();
    if let Some(slot) = satellite.slot
        && let Some(span) = shells().find(|span| is_of(span, slot))
    {
        let elements = span.shell.elements(slot);
        return Ok(Some(TAU / elements.kepler_mean_motion_rad_s()));
    }
    Ok(kepler::period_s(&ephemeris.state(satellite, 0.0)?))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ephemeris::testing::files_between_shells;
    use crate::orbit::Model;
    use crate::time::{Epoch, TimeGrid};

    fn palette(design: &str) -> Palette {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        Palette::of(&Ephemeris::of_design(&design.parse().unwrap(), Model::J2, grid).unwrap())
    }

    #[test]
    fn satellites_outside_shells_are_a_group_wherever_they_are() {
        let palette = Palette::of(&files_between_shells());
        let names: Vec<String> = palette.groups().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["shellA", "shellB", "others"]);
        assert_eq!(palette.colour(None), palette.groups()[2].1);
    }

    /// What is lost leaves the groups and the periods of the others as they are.
    #[test]
    fn a_shell_without_a_satellite_is_still_a_group() {
        let of = |design: &str, down: usize| {
            let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
            let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
            let all = Ephemeris::of_design(&design.parse().unwrap(), Model::J2, grid);
            all.unwrap().without(&[down])
        };
        let one = Palette::of(&of("delta:55:6/3/1@925", 3));
        assert_eq!(one.groups(), palette("delta:55:6/3/1@925").groups());
        let design = "delta:53:6/3/1@1000+star:90:4/2/1@20000";
        let left = of(design, 0);
        assert_eq!(Palette::of(&left).groups(), palette(design).groups());
        let minutes = |place: usize| {
            let satellite = &left.satellites()[place];
            period_s(&left, satellite).unwrap().unwrap() / 60.0
        };
        assert!((100.0..110.0).contains(&minutes(0)), "{}", minutes(0));
        assert!((700.0..720.0).contains(&minutes(8)), "{}", minutes(8));
    }

    #[test]
    fn one_shell_is_coloured_by_plane_and_several_by_shell() {
        let names = |palette: &Palette| -> Vec<String> {
            palette.groups().into_iter().map(|(name, _)| name).collect()
        };
        let one = palette("delta:55:6/3/1@925");
        assert_eq!(names(&one), ["plane1", "plane2", "plane3"]);
        let second_plane = Slot::new(1, 0);
        assert_eq!(one.colour(Some(second_plane)), one.groups()[1].1);
        let two = palette("delta:53:6/3/1@1000+star:90:4/2/1@1100");
        assert_eq!(names(&two), ["shellA", "shellB"]);
        let of_b = Slot {
            shell: Some(1),
            ..Slot::FIRST
        };
        assert_eq!(two.colour(Some(of_b)), two.groups()[1].1);
        assert_ne!(two.groups()[0].1, two.groups()[1].1);
    }
}

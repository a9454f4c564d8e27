//! The variables of a search, shell by shell, for the parallel coordinates and the colours of a front.

use crate::constellation::shell_letters;
use crate::report::page::pack::short;
use crate::run::{DesignSummary, FrontMember};
use crate::scenario::Scenario;
use crate::search::{DesignSpace, IntervalOr, ShellSpace};

/// A variable with its heading: its value in each design, and its bounds in the search if it has some.
pub(super) type VariableColumn = (String, Vec<Option<f64>>, Option<[f64; 2]>);

/// A variable of one shell: its name, its value, and its bounds.
struct ShellVariable {
    name: &'static str,
    value: fn(&DesignSummary) -> Option<f64>,
    bounds: fn(&ShellSpace) -> Option<[f64; 2]>,
}

const OF_ALL: [ShellVariable; 2] = [
    ShellVariable {
        name: "satellites",
        value: |d| Some(d.satellites as f64),
        bounds: |space| {
            let [planes, each] = [space.planes, space.satellites_per_plane];
            Some([0, 1].map(|end| f64::from(planes[end]) * f64::from(each[end])))
        },
    },
    ShellVariable {
        name: "planes",
        value: |d| Some(d.planes as f64),
        bounds: |space| {
            let [least, most] = space.planes.map(f64::from);
            Some([if space.may_be_empty() { 0.0 } else { least }, most])
        },
    },
];

const OF_A_SHELL: [ShellVariable; 4] = [
    ShellVariable {
        name: "per plane",
        value: |d| Some(d.satellites_per_plane? as f64),
        bounds: |space| Some(space.satellites_per_plane.map(f64::from)),
    },
    ShellVariable {
        name: "phasing",
        value: |d| Some(d.phasing? as f64),
        // F is below the number of planes.
        bounds: |space| {
            let most = space.planes[1].saturating_sub(1);
            Some(space.phasing.map(|phasing| f64::from(phasing.min(most))))
        },
    },
    ShellVariable {
        name: "inclination (\u{b0})",
        value: |d| d.inclination_deg,
        bounds: |space| between(&space.inclination_deg),
    },
    ShellVariable {
        name: "altitude (km)",
        value: |d| d.altitude_km,
        bounds: |space| between(&space.altitude_km),
    },
];

/// The limits of a variable that does not follow from another.
fn between<F>(interval: &IntervalOr<F>) -> Option<[f64; 2]> {
    match interval {
        IntervalOr::Between(limits) => Some(*limits),
        IntervalOr::Following(_) => None,
    }
}

/// The number of shells of the search.
fn shells(members: &[FrontMember]) -> usize {
    let counts = members.iter().map(|member| member.shells.len());
    counts.max().unwrap_or(0)
}

/// Satellites and planes of each member, and then the variables of each shell.
pub(super) fn all(members: &[FrontMember], scenario: Option<&Scenario>) -> Vec<VariableColumn> {
    let space = scenario.map(Scenario::design_space);
    let space = space.as_ref();
    let mut columns: Vec<VariableColumn> = Vec::new();
    let design = |member: &FrontMember| member.design.clone();
    for variable in &OF_ALL {
        let bounds = space.and_then(|space| bounds_of_all(space, variable));
        columns.push(column(members, variable, ("", bounds), design));
    }
    let of_shell = |place: usize| space.and_then(|space| space.shells.get(place));
    match shells(members) {
        0 => {
            for variable in &OF_A_SHELL {
                let bounds = of_shell(0).and_then(variable.bounds);
                columns.push(column(members, variable, ("", bounds), design));
            }
        }
        count => {
            for place in 0..count {
                let letters = format!("{} ", shell_letters(place));
                let own = |member: &FrontMember| member.shell(place).cloned();
                for variable in OF_ALL.iter().chain(&OF_A_SHELL) {
                    let bounds = of_shell(place).and_then(variable.bounds);
                    columns.push(column(members, variable, (&letters, bounds), own));
                }
            }
        }
    }
    columns
}

/// The bounds of what all shells add to, those that are fixed included.
fn bounds_of_all(space: &DesignSpace, variable: &ShellVariable) -> Option<[f64; 2]> {
    let fixed = space.fixed.as_ref().map(DesignSummary::from);
    let fixed = fixed
        .and_then(|design| (variable.value)(&design))
        .unwrap_or(0.0);
    let shells = space.shells.iter();
    shells
        .map(variable.bounds)
        .try_fold([fixed; 2], |sum, bounds| {
            let [low, high] = bounds?;
            Some([sum[0] + low, sum[1] + high])
        })
}

fn column(
    members: &[FrontMember],
    variable: &ShellVariable,
    (prefix, bounds): (&str, Option<[f64; 2]>),
    of: impl Fn(&FrontMember) -> Option<DesignSummary>,
) -> VariableColumn {
    let value = |member: &FrontMember| (variable.value)(&of(member)?).map(short);
    let values = members.iter().map(value);
    let bounds = bounds.map(|ends| ends.map(short));
    (
        format!("{prefix}{}", variable.name),
        values.collect(),
        bounds,
    )
}

/// Satellites of each shell of the search, by its letter.
pub(super) fn satellites_by_shell(members: &[FrontMember]) -> Vec<(String, Vec<usize>)> {
    let of_shell = |place: usize| {
        let count = |member: &FrontMember| member.shell(place).map_or(0, |shell| shell.satellites);
        (shell_letters(place), members.iter().map(count).collect())
    };
    (0..shells(members)).map(of_shell).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Shell;
    use crate::run::testing;

    fn member(design: &str, shells: &[Option<&str>]) -> FrontMember {
        let shell = |notation: &Option<&str>| {
            let shell: Shell = (*notation)?.parse().unwrap();
            Some(DesignSummary::from(&shell))
        };
        FrontMember {
            shells: shells.iter().map(shell).collect(),
            ..testing::member(1, design)
        }
    }

    fn named<'c>(columns: &'c [VariableColumn], name: &str) -> &'c [Option<f64>] {
        let column = columns.iter().find(|(heading, ..)| heading == name);
        &column.unwrap().1
    }

    #[test]
    fn each_shell_has_its_variables() {
        let (low, polar) = ("delta:53:24/4/1@800", "star:90:12/3/1@1100");
        let members = [
            member(&format!("{low}+{polar}"), &[Some(low), Some(polar)]),
            member(polar, &[None, Some(polar)]),
        ];
        let columns = all(&members, None);
        assert_eq!(named(&columns, "satellites"), [Some(36.0), Some(12.0)]);
        assert_eq!(named(&columns, "A satellites"), [Some(24.0), None]);
        assert_eq!(
            named(&columns, "A inclination (\u{b0})"),
            [Some(53.0), None]
        );
        assert_eq!(named(&columns, "B planes"), [Some(3.0), Some(3.0)]);
        assert_eq!(columns.len(), 2 + 2 * 6);
        let counts = satellites_by_shell(&members);
        assert_eq!(
            counts,
            [
                ("A".to_owned(), vec![24, 0]),
                ("B".to_owned(), vec![12, 12])
            ]
        );
    }

    #[test]
    fn one_shell_needs_no_letter() {
        let members = [member("delta:53:24/4/1@800", &[])];
        let columns = all(&members, None);
        assert_eq!(named(&columns, "altitude (km)"), [Some(800.0)]);
        assert_eq!(columns.len(), 6);
        assert!(satellites_by_shell(&members).is_empty());
    }

    /// Each variable is between the bounds of the search, and the sums between those of all shells.
    #[test]
    fn variables_have_the_bounds_of_the_search() {
        let toml = "[[search.shells]]\nplanes = [3, 6]\nsatellites-per-plane = [4, 8]\ninclination-deg = [45, 60]\n\
                    [[search.shells]]\nplanes = [2, 4]\nsatellites-per-plane = [0, 6]\ninclination-deg = 90\n";
        let scenario = Scenario::parse("two", toml.as_bytes(), &[] as &[&str]).unwrap();
        let (low, polar) = ("delta:53:24/4/1@800", "star:90:12/3/1@1100");
        let members = [member(&format!("{low}+{polar}"), &[Some(low), Some(polar)])];
        let columns = all(&members, Some(&scenario));
        let bounds = |name: &str| {
            columns
                .iter()
                .find(|(heading, ..)| heading == name)
                .unwrap()
                .2
        };
        assert_eq!(bounds("satellites"), Some([12.0, 48.0 + 24.0]));
        assert_eq!(bounds("planes"), Some([3.0, 10.0]));
        assert_eq!(bounds("A inclination (\u{b0})"), Some([45.0, 60.0]));
        assert_eq!(bounds("B inclination (\u{b0})"), Some([90.0, 90.0]));
        assert_eq!(bounds("B per plane"), Some([0.0, 6.0]));
        assert_eq!(bounds("B planes"), Some([0.0, 4.0]));
    }
}

//! The variables of a search, shell by shell, for the parallel coordinates and the colours of a front.

use crate::constellation::shell_letters;
use crate::report::page::pack::short;
use crate::run::{DesignSummary, FrontMember};

/// A column with its heading.
type Column = (String, Vec<Option<f64>>);

/// The variables of one shell.
type ShellVariable = (&'static str, fn(&DesignSummary) -> Option<f64>);

const OF_ALL: [ShellVariable; 2] = [
    ("satellites", |d| Some(d.satellites as f64)),
    ("planes", |d| Some(d.planes as f64)),
];

const OF_A_SHELL: [ShellVariable; 4] = [
    ("per plane", |d| Some(d.satellites_per_plane? as f64)),
    ("phasing", |d| Some(d.phasing? as f64)),
    ("inclination (\u{b0})", |d| d.inclination_deg),
    ("altitude (km)", |d| d.altitude_km),
];

/// The number of shells of the search.
fn shells(members: &[FrontMember]) -> usize {
    let counts = members.iter().map(|member| member.shells.len());
    counts.max().unwrap_or(0)
}

/// Satellites and planes of each member, and then the variables of each shell.
pub(super) fn all(members: &[FrontMember]) -> Vec<Column> {
    let mut columns: Vec<Column> = Vec::new();
    let design = |member: &FrontMember| member.design.clone();
    columns.extend(
        OF_ALL
            .iter()
            .map(|variable| column(members, variable, "", design)),
    );
    match shells(members) {
        0 => {
            let of_design = OF_A_SHELL
                .iter()
                .map(|one| column(members, one, "", design));
            columns.extend(of_design);
        }
        count => {
            for place in 0..count {
                let letters = format!("{} ", shell_letters(place));
                let of_shell = |member: &FrontMember| member.shell(place).cloned();
                let variables = OF_ALL.iter().chain(&OF_A_SHELL);
                columns.extend(variables.map(|one| column(members, one, &letters, of_shell)));
            }
        }
    }
    columns
}

fn column(
    members: &[FrontMember],
    (name, value): &ShellVariable,
    prefix: &str,
    of: impl Fn(&FrontMember) -> Option<DesignSummary>,
) -> Column {
    let values = members.iter().map(|member| value(&of(member)?).map(short));
    (format!("{prefix}{name}"), values.collect())
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

    fn named<'c>(columns: &'c [Column], name: &str) -> &'c [Option<f64>] {
        let column = columns.iter().find(|(heading, _)| heading == name);
        &column.unwrap().1
    }

    #[test]
    fn each_shell_has_its_variables() {
        let (low, polar) = ("delta:53:24/4/1@800", "star:90:12/3/1@1100");
        let members = [
            member(&format!("{low}+{polar}"), &[Some(low), Some(polar)]),
            member(polar, &[None, Some(polar)]),
        ];
        let columns = all(&members);
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
        let columns = all(&members);
        assert_eq!(named(&columns, "altitude (km)"), [Some(800.0)]);
        assert_eq!(columns.len(), 6);
        assert!(satellites_by_shell(&members).is_empty());
    }
}

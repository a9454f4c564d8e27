//! The members of a front as a table for a terminal.

use super::{Align, Table, shown};
use crate::run::{DesignSummary, FrontMember};

/// Quantities that have a column in every table of a front.
const ALWAYS: [&str; 7] = [
    "satellites",
    "mean-visible",
    "mean-pdop",
    "cvar-pdop",
    "max-pdop",
    "j-pos",
    "j-cost",
];

/// One row per member, with its label under `heading`. Objectives and constrained quantities outside
/// [`ALWAYS`] get extra columns.
#[must_use]
pub(crate) fn front_table<'a>(
    heading: &str,
    members: impl Iterator<Item = (String, &'a FrontMember)>,
) -> Table {
    let right = Align::Right;
    let members: Vec<_> = members.collect();
    let further = members.first().map_or_else(Vec::new, |(_, m)| further(m));
    let mut columns = vec![
        ("", Align::Left),
        (heading, right),
        ("design", Align::Left),
        ("T", right),
        ("i (deg)", right),
        ("h (km)", right),
        ("mean visible", right),
        ("mean PDOP", right),
        ("CVaR of PDOP", right),
        ("maximum PDOP", right),
        ("J_pos", right),
        ("J_cost", right),
    ];
    columns.extend(further.iter().map(|name| (name.as_str(), right)));
    columns.push(("membership", right));
    let mut table = Table::new(&columns);
    for (label, member) in &members {
        table.row(row(label, member, &further));
    }
    table
}

/// Objectives and constrained quantities that are not always shown.
fn further(member: &FrontMember) -> Vec<String> {
    let objectives = member.objectives.iter().map(|(name, _)| name);
    let names = objectives.chain(member.constraints.iter().map(|(name, _)| name));
    names
        .filter(|name| !ALWAYS.contains(&name.as_str()))
        .cloned()
        .collect()
}

fn row(label: &str, member: &FrontMember, further: &[String]) -> Vec<String> {
    let (design, metrics) = (member.design.as_ref(), &member.metrics);
    let shells = design.filter(|_| member.files.is_none());
    let by_shell = |text: fn(&DesignSummary) -> Option<String>| {
        shells.map_or_else(String::new, |design| design.by_shell(text))
    };
    let mut cells = vec![
        if member.chosen { "*" } else { "" }.to_owned(),
        label.to_owned(),
        member.made_of(),
        member.satellites().to_string(),
        by_shell(|shell| Some(format!("{:.2}", shell.inclination_deg?))),
        by_shell(|shell| Some(format!("{:.1}", shell.altitude_km?))),
        shown::named("mean-visible", Some(metrics.mean_visible)),
    ];
    let pdops = [
        metrics.mean_pdop,
        metrics.cvar_pdop,
        metrics.max_pdop,
        metrics.j_pos,
        metrics.j_cost,
    ];
    cells.extend(pdops.map(shown::pdop));
    let values = further.iter().map(|name| (name, member.quantity(name)));
    cells.extend(values.map(|(name, value)| shown::named(name, value)));
    cells.push(shown::membership(member.membership));
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing;

    #[test]
    fn what_is_sought_or_bound_has_a_column() {
        let member = FrontMember {
            objectives: vec![
                ("satellites".to_owned(), 225.0),
                ("planes".to_owned(), 15.0),
            ],
            constraints: vec![
                ("max-pdop".to_owned(), None),
                ("launch-cost".to_owned(), Some(345.678)),
                ("availability".to_owned(), Some(0.999_99)),
            ],
            ..testing::member(3, "delta:45:225/15/1@1000")
        };
        let text = front_table("#", [("3".to_owned(), &member)].into_iter()).to_text();
        let heading = text.lines().next().unwrap();
        assert!(
            heading.ends_with("J_cost  planes  launch-cost  availability  membership"),
            "{heading}"
        );
        assert_eq!(heading.matches("PDOP").count(), 3, "{heading}");
        assert!(text.contains("15       345.68       0.99999"), "{text}");
    }
}

//! What lies between the steps of the grid, as text.

use super::{section, value};
use crate::report::section::ReportSection;
use crate::report::{Align, Table};
use crate::run::size::{Refinement, SizeResult};

/// A table of the designs between the steps, and what follows from them.
pub(super) fn section_of(result: &SizeResult) -> Option<ReportSection> {
    let first = result.refinement.first()?;
    let right = Align::Right;
    let mut columns = vec![
        ("T", right),
        ("of the grid", Align::Left),
        ("best between the steps", Align::Left),
        ("kept", right),
    ];
    let constraints = first.constraints.iter();
    columns.extend(constraints.map(|one| (one.constraint.as_str(), right)));
    columns.push(("evaluated", right));
    let mut table = Table::new(&columns);
    for one in &result.refinement {
        let mut row = vec![
            one.satellites.to_string(),
            one.from.clone(),
            one.design.notation.clone(),
            if one.kept { "yes" } else { "no" }.to_owned(),
        ];
        row.extend(one.constraints.iter().map(value));
        row.push(one.evaluations.to_string());
        table.row(row);
    }
    let caption = "Between the steps, around the closest rejected and the best designs: evidence, not a proof";
    Some(ReportSection {
        remarks: vec![verdict(result)],
        ..section("Between the steps", caption, table)
    })
}

/// Whether fewer satellites were found.
fn verdict(result: &SizeResult) -> String {
    let is_fewer =
        |one: &&Refinement| one.kept && result.fewest.is_none_or(|fewest| one.satellites < fewest);
    let fewer = result.refinement.iter().filter(is_fewer);
    match fewer.min_by_key(|one| one.satellites) {
        Some(one) => format!(
            "{} satellites keep the constraints between the steps: {}; smaller steps of the search may find still fewer",
            one.satellites, one.design.notation
        ),
        None => match result.fewest {
            Some(fewest) => {
                format!("no design with fewer than {fewest} satellites was found between the steps")
            }
            None => "no design that keeps the constraints was found between the steps".to_owned(),
        },
    }
}

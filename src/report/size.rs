//! The result of a search for the fewest satellites, as text and as the sections of a page.

mod refinement;

use super::section::ReportSection;
use super::{Align, Table, shown};
use crate::run::size::{
    BestReached, KeptConstraint, LevelAbove, RejectedLevel, RobustnessRow, SizeFront, SizeResult,
    SizedDesign, basis_word,
};
use crate::search::Constraint;
use crate::search::size::{RejectionBasis, Witness};
use crate::units::counted;
use std::fmt::Write;

/// Designs that are shown.
const DESIGNS: usize = 20;

/// Numbers of satellites below the fewest that are shown.
const LEVELS: usize = 10;

/// The result for a terminal.
#[must_use]
pub fn size_text(result: &SizeResult) -> String {
    let mut text = answer(result) + "\n";
    for constraint in constraints(result) {
        let _ = writeln!(text, "  {constraint}");
    }
    let _ = writeln!(text, "{}", scope(result));
    for section in sections(result) {
        text.push('\n');
        if !section.caption.is_empty() {
            let _ = writeln!(text, "{}", section.caption);
        }
        if section.table.headings().next().is_some() {
            text += &section.table.to_text();
        }
        for remark in section.remarks {
            let _ = writeln!(text, "{remark}");
        }
    }
    text
}

/// What was found.
pub(super) fn answer(result: &SizeResult) -> String {
    let scenario = &result.scenario.name;
    match result.fewest {
        Some(fewest) => format!(
            "Fewest satellites of scenario {scenario}: {fewest}, with {} that {} the constraints",
            counted(result.designs.len(), "design"),
            if result.designs.len() == 1 {
                "keeps"
            } else {
                "keep"
            },
        ),
        None => format!("No design of scenario {scenario} keeps the constraints"),
    }
}

/// The constraints, with what they depend on.
pub(super) fn constraints(result: &SizeResult) -> Vec<String> {
    let told = |constraint: &String| match constraint.parse::<Constraint>() {
        Ok(one) if is_about_availability(&one) => format!(
            "{constraint}, available up to a PDOP of {}",
            result.availability_pdop
        ),
        _ => constraint.clone(),
    };
    result.constraints.iter().map(told).collect()
}

/// What the answer is exact for.
pub(super) fn scope(result: &SizeResult) -> String {
    format!(
        "exact for the {} samples of the scenario and the grid of its search steps: {} tried",
        result.samples,
        designs_of(result.designs_tried)
    )
}

/// The parts that a result has.
pub(super) fn sections(result: &SizeResult) -> Vec<ReportSection> {
    let mut sections = Vec::new();
    if !result.designs.is_empty() {
        sections.push(designs(result));
    }
    sections.extend(result.front.as_ref().map(front));
    sections.extend(reached(&result.best_reached));
    sections.extend(refinement::section_of(result));
    sections.extend(robustness(&result.robustness));
    sections.push(below(&result.rejected));
    sections.push(cost(result));
    sections
}

fn section(title: &str, caption: impl Into<String>, table: Table) -> ReportSection {
    ReportSection {
        title: title.to_owned(),
        caption: caption.into(),
        table,
        remarks: Vec::new(),
    }
}

fn is_about_availability(constraint: &Constraint) -> bool {
    let name = constraint.quantity.to_string();
    name.contains("availability") || name.contains("outage")
}

fn designs_of(count: u64) -> String {
    counted(usize::try_from(count).unwrap_or(usize::MAX), "design")
}

/// The designs with the fewest satellites, and the next number of satellites.
fn designs(result: &SizeResult) -> ReportSection {
    let all = &result.designs;
    let mut remarks = Vec::new();
    if let Some(more @ 1..) = all.len().checked_sub(DESIGNS) {
        remarks.push(format!("and {more} more in size.csv"));
    }
    remarks.push(
        "ranked by the least margin, relative to its bound (absolute for bounds below 1), then by fewer planes"
            .to_owned(),
    );
    remarks.extend(result.above.first().map(above));
    ReportSection {
        remarks,
        ..section("Designs", "", designs_table(all))
    }
}

/// The designs with the value of each constrained quantity.
fn designs_table(all: &[SizedDesign]) -> Table {
    let right = Align::Right;
    let mut columns = vec![
        ("#", right),
        ("design", Align::Left),
        ("T", right),
        ("planes", right),
    ];
    let constraints = all.first().map_or(&[][..], |first| &first.constraints);
    columns.extend(
        constraints
            .iter()
            .map(|one| (one.constraint.as_str(), right)),
    );
    columns.extend([
        ("margin", right),
        ("mean PDOP", right),
        ("maximum PDOP", right),
    ]);
    let mut table = Table::new(&columns);
    for one in all.iter().take(DESIGNS) {
        let mut row = vec![
            one.rank.to_string(),
            one.design.notation.clone(),
            one.design.satellites.to_string(),
            one.design.planes.to_string(),
        ];
        row.extend(one.constraints.iter().map(value));
        row.push(format!("{:.6}", one.margin));
        row.push(shown::pdop(one.metrics.mean_pdop));
        row.push(shown::pdop(one.metrics.max_pdop));
        table.row(row);
    }
    table
}

/// The value of a constrained quantity.
fn value(one: &KeptConstraint) -> String {
    shown_value(&one.constraint, one.value)
}

fn shown_value(constraint: &str, value: Option<f64>) -> String {
    match constraint.parse::<Constraint>() {
        Ok(constraint) => shown::quantity(constraint.quantity, value),
        Err(_) => value.map_or_else(String::new, |value| value.to_string()),
    }
}

fn above(level: &LevelAbove) -> String {
    let best = match level.best.first() {
        Some(best) => format!(
            "; the best is {} with a margin of {:.6}",
            best.design.notation, best.margin
        ),
        None => String::new(),
    };
    format!(
        "with {} satellites, the next number that occurs, {} of {} keep them{best}",
        level.satellites,
        level.kept,
        designs_of(level.designs)
    )
}

fn front(front: &SizeFront) -> ReportSection {
    let objective = front.objective.as_str();
    let right = Align::Right;
    let mut table = Table::new(&[("T", right), (objective, right), ("design", Align::Left)]);
    for member in &front.members {
        table.row([
            member.satellites.to_string(),
            shown::named(objective, Some(member.value)),
            member.design.notation.clone(),
        ]);
    }
    let caption = format!(
        "Front of satellites against {objective}, exact up to {} satellites",
        front.up_to
    );
    section("Front", caption, table)
}

fn reached(all: &[BestReached]) -> Option<ReportSection> {
    let first = all.first()?;
    let right = Align::Right;
    let mut columns = vec![("T", right), ("design", Align::Left)];
    columns.extend(
        first
            .constraints
            .iter()
            .map(|one| (one.constraint.as_str(), right)),
    );
    let mut table = Table::new(&columns);
    let skipped = all.len().saturating_sub(LEVELS);
    for one in &all[skipped..] {
        let mut row = vec![one.satellites.to_string(), one.design.notation.clone()];
        row.extend(one.constraints.iter().map(value));
        table.row(row);
    }
    let caption = format!(
        "Best that was reached with each number of satellites: the least violation of all designs{}",
        skipped_text(skipped)
    );
    Some(section("Closest designs", caption, table))
}

/// Each design with the samples under which it keeps the constraints and the worst value of each quantity.
fn robustness(rows: &[RobustnessRow]) -> Option<ReportSection> {
    let first = rows.first()?;
    let right = Align::Right;
    let mut columns = vec![("design", Align::Left), ("T", right), ("kept", right)];
    columns.extend(
        first
            .constraints
            .iter()
            .map(|one| (one.constraint.as_str(), right)),
    );
    columns.push(("fails with", Align::Left));
    let mut table = Table::new(&columns);
    for of_design in rows.chunk_by(|a, b| a.design == b.design) {
        let kept = of_design.iter().filter(|row| row.kept).count();
        let mut row = vec![
            of_design[0].design.clone(),
            of_design[0].satellites.to_string(),
            format!("{kept}/{}", of_design.len()),
        ];
        row.extend((0..first.constraints.len()).map(|place| {
            let all = of_design
                .iter()
                .filter_map(|row| row.constraints.get(place));
            worst(all).map_or_else(String::new, value)
        }));
        let failing = of_design.iter().filter(|row| !row.kept);
        let failing: Vec<&str> = failing.map(|row| row.samples.as_str()).collect();
        row.push(failing.join(", "));
        table.row(row);
    }
    let caption = "Under other samples (half step, half grid, eight phases of the GNSS): how many keep the \
                   constraints, and the worst values";
    Some(section("Other samples", caption, table))
}

/// The value with the least margin; one without a value is the worst.
fn worst<'a>(all: impl Iterator<Item = &'a KeptConstraint>) -> Option<&'a KeptConstraint> {
    let margin = |one: &KeptConstraint| one.margin.unwrap_or(f64::NEG_INFINITY);
    all.min_by(|a, b| margin(a).total_cmp(&margin(b)))
}

fn skipped_text(skipped: usize) -> String {
    match skipped {
        0 => String::new(),
        1 => " (one more before these in size.json)".to_owned(),
        _ => format!(" ({skipped} more before these in size.json)"),
    }
}

fn below(all: &[RejectedLevel]) -> ReportSection {
    let title = "Fewer satellites";
    if all.is_empty() {
        let none = "no design of the search space has fewer satellites";
        return section(title, none, Table::new(&[]));
    }
    let right = Align::Right;
    let mut table = Table::new(&[
        ("T", right),
        ("designs", right),
        ("rejected", right),
        ("closest", Align::Left),
        ("rejected by", Align::Left),
        ("samples", right),
    ]);
    let skipped = all.len().saturating_sub(LEVELS);
    for level in &all[skipped..] {
        let mut row = vec![
            level.satellites.to_string(),
            level.designs.to_string(),
            level.designs.to_string(),
        ];
        if let Some(witness) = level.witnesses.first() {
            row.push(witness.design.clone());
            row.push(reason(witness));
            row.push(format!("{:.1} %", 100.0 * witness.samples_share));
        }
        table.row(row);
    }
    let caption = format!(
        "Rejected with fewer satellites, and the proof for the design that took the most samples{}",
        skipped_text(skipped)
    );
    section(title, caption, table)
}

/// A proof in words.
fn reason(witness: &Witness) -> String {
    let constraint = &witness.constraint;
    let value = witness.value_at_rejection;
    let shown = value.map(|value| shown_value(constraint, Some(value)));
    match (witness.basis, witness.point, witness.elapsed_s) {
        (_, Some(point), Some(elapsed_s)) => format!(
            "{constraint}: {} at point {} ({:.2}° N, {:.2}° E) after {elapsed_s:.0} s",
            shown.unwrap_or_else(|| "unsolved".to_owned()),
            point.number,
            point.latitude_deg,
            point.longitude_deg
        ),
        (RejectionBasis::Geometry, ..) => {
            format!("{constraint}: no geometry of so many satellites has it")
        }
        (RejectionBasis::Samples, ..) => match (witness.share_at_rejection, shown) {
            (Some(share), _) => format!("{constraint}: bad samples reach a share of {share:.6}"),
            (None, Some(shown)) => format!("{constraint}: {shown} at best"),
            (None, None) => constraint.clone(),
        },
        _ => match shown {
            Some(shown) => format!("{constraint}: it is {shown}"),
            None => constraint.clone(),
        },
    }
}

/// What was evaluated, and what each rule saved.
fn cost(result: &SizeResult) -> ReportSection {
    let evaluations = &result.evaluations;
    let right = Align::Right;
    let mut table = Table::new(&[
        ("rejected by", Align::Left),
        ("from", Align::Left),
        ("designs", right),
        ("samples saved", right),
    ]);
    for rule in &result.rules {
        table.row([
            rule.constraint.clone(),
            basis_word(rule.basis).to_owned(),
            rule.designs.to_string(),
            format!("{:.2} %", 100.0 * rule.samples_saved),
        ]);
    }
    let evaluated = format!(
        "evaluated: {} begun, {} in full, {:.3} % of the samples of a sweep",
        evaluations.begun,
        evaluations.finished,
        100.0 * evaluations.samples_share
    );
    ReportSection {
        remarks: vec![evaluated],
        ..section("What was evaluated", "", table)
    }
}

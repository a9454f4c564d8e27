//! The result as text.

mod refinement;

use crate::report::{Align, Table, shown};
use crate::run::size::{
    BestReached, KeptConstraint, LevelAbove, RejectedLevel, RobustnessRow, SizeFront, SizeResult,
    SizedDesign, basis_word,
};
use crate::search::Constraint;
use crate::search::size::{RejectionBasis, Witness};
use crate::units::counted;

/// Designs that are shown.
const DESIGNS: usize = 20;

/// Numbers of satellites below the fewest that are shown.
const LEVELS: usize = 10;

pub(super) fn of(result: &SizeResult) -> String {
    let mut text = head(result);
    if !result.designs.is_empty() {
        text += &format!("\n{}", designs(&result.designs));
        text += "ranked by the least margin, relative to its bound (absolute for bounds below 1), then by fewer planes\n";
    }
    for level in result.above.iter().take(1) {
        text += &above(level);
    }
    if let Some(front) = &result.front {
        text += &front_text(front);
    }
    text += &reached(&result.best_reached);
    text += &refinement::text(result);
    text += &robustness(&result.robustness);
    text += &below(&result.rejected);
    text + &cost(result)
}

fn head(result: &SizeResult) -> String {
    let found = match result.fewest {
        Some(fewest) => format!(
            "Fewest satellites of scenario {}: {fewest}, with {} that {} the constraints\n",
            result.scenario.name,
            counted(result.designs.len(), "design"),
            if result.designs.len() == 1 {
                "keeps"
            } else {
                "keep"
            },
        ),
        None => format!(
            "No design of scenario {} keeps the constraints\n",
            result.scenario.name
        ),
    };
    let constraint = |constraint: &String| {
        let note = match constraint.parse::<Constraint>() {
            Ok(one) if is_about_availability(&one) => {
                format!(", available up to a PDOP of {}", result.availability_pdop)
            }
            _ => String::new(),
        };
        format!("  {constraint}{note}\n")
    };
    let constraints: String = result.constraints.iter().map(constraint).collect();
    format!(
        "{found}{constraints}exact for the {} samples of the scenario and the grid of its search steps: {} tried\n",
        result.samples,
        designs_of(result.designs_tried)
    )
}

fn is_about_availability(constraint: &Constraint) -> bool {
    let name = constraint.quantity.to_string();
    name.contains("availability") || name.contains("outage")
}

fn designs_of(count: u64) -> String {
    counted(usize::try_from(count).unwrap_or(usize::MAX), "design")
}

/// The designs with the value of each constrained quantity.
fn designs(all: &[SizedDesign]) -> String {
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
    let more = match all.len().saturating_sub(DESIGNS) {
        0 => String::new(),
        more => format!("and {more} more in size.csv\n"),
    };
    table.to_text() + &more
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
        "with {} satellites, the next number that occurs, {} of {} keep them{best}\n",
        level.satellites,
        level.kept,
        designs_of(level.designs)
    )
}

fn front_text(front: &SizeFront) -> String {
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
    format!(
        "\nFront of satellites against {objective}, exact up to {} satellites\n{}",
        front.up_to,
        table.to_text()
    )
}

fn reached(all: &[BestReached]) -> String {
    let Some(first) = all.first() else {
        return String::new();
    };
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
    format!(
        "\nBest that was reached with each number of satellites: the least violation of all designs{}\n{}",
        skipped_text(skipped),
        table.to_text()
    )
}

/// Each design with the samples under which it keeps the constraints and the worst value of each quantity.
fn robustness(rows: &[RobustnessRow]) -> String {
    let Some(first) = rows.first() else {
        return String::new();
    };
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
    format!(
        "\nUnder other samples (half step, half grid, eight phases of the GNSS): how many keep the constraints, and the \
         worst values\n{}",
        table.to_text()
    )
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

fn below(all: &[RejectedLevel]) -> String {
    if all.is_empty() {
        return "\nno design of the search space has fewer satellites\n".to_owned();
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
    format!(
        "\nRejected with fewer satellites, and the proof for the design that took the most samples{}\n{}",
        skipped_text(skipped),
        table.to_text()
    )
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
fn cost(result: &SizeResult) -> String {
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
    format!(
        "\n{}evaluated: {} begun, {} in full, {:.3} % of the samples of a sweep\n",
        table.to_text(),
        evaluations.begun,
        evaluations.finished,
        100.0 * evaluations.samples_share
    )
}

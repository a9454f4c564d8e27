//! The figures of a search for the fewest satellites.

use super::{
    Axis, AxisScale, Chart, Layer, MeasureAxis, PlaneChart, RowChart, Style, quantity_label,
};
use crate::run::size::{KeptConstraint, SizeFront, SizeResult, basis_word};
use crate::search::Constraint;

/// Designs that keep the constraints, and those that do not: apart in colour and in form.
const KEPT: Style = Style::Marks(1);
const REJECTED: Style = Style::Dots(1);

/// Caption and chart of each figure that the result has numbers for.
pub(crate) fn size_figures(result: &SizeResult) -> Vec<(String, Chart)> {
    let mut figures = Vec::new();
    figures.extend(designs(result).map(|chart| {
        let caption = "Designs of the grid by number of satellites. With fewer than the fewest, every one is rejected.";
        (caption.to_owned(), Chart::Plane(chart))
    }));
    let values = result.constraints.iter().enumerate();
    figures.extend(
        values.filter_map(|(place, text)| Some((constraint(result, place, text)?, text))).map(
            |(chart, text)| {
                let caption = format!(
                    "{text}: the best designs with each number of satellites, the samples of the scenario and others."
                );
                (caption, Chart::Plane(chart))
            },
        ),
    );
    let of = result.front.iter().filter(|of| !of.members.is_empty());
    figures.extend(of.map(|of| {
        let caption = format!("The front is exact up to {} satellites.", of.up_to);
        (caption, Chart::Plane(front(of)))
    }));
    figures.extend(rules(result).map(|chart| {
        let caption = "Designs that each rule rejected; what no rule rejects is evaluated in full.";
        (caption.to_owned(), Chart::Rows(chart))
    }));
    figures
}

fn layer(name: &str, style: Style, points: Vec<(f64, f64)>) -> Option<Layer> {
    (!points.is_empty()).then(|| Layer {
        name: name.to_owned(),
        points,
        style,
    })
}

fn plane(title: String, y: Axis, layers: Vec<Layer>) -> Option<PlaneChart> {
    let x = Axis {
        is_whole: true,
        ..Axis::new("satellites")
    };
    (!layers.is_empty()).then_some(PlaneChart {
        title,
        x,
        y,
        measure: MeasureAxis::Neither,
        layers,
    })
}

/// How many designs are rejected and how many keep the constraints, by number of satellites.
fn designs(result: &SizeResult) -> Option<PlaneChart> {
    let count = |satellites: usize, designs: u64| {
        (designs > 0).then_some((satellites as f64, designs as f64))
    };
    let below = result.rejected.iter();
    let below = below.filter_map(|level| count(level.satellites, level.designs));
    let above = result.above.iter();
    let also = above
        .clone()
        .filter_map(|level| count(level.satellites, level.designs.saturating_sub(level.kept)));
    let fewest = result.fewest.into_iter();
    let kept = fewest
        .filter_map(|fewest| count(fewest, result.designs.len() as u64))
        .chain(above.filter_map(|level| count(level.satellites, level.kept)));
    let layers = [
        layer("rejected", REJECTED, below.chain(also).collect()),
        layer("keep the constraints", KEPT, kept.collect()),
    ];
    let y = Axis {
        scale: AxisScale::Log,
        ..Axis::new("designs")
    };
    let title = "Designs by number of satellites".to_owned();
    plane(title, y, layers.into_iter().flatten().collect())
}

/// The value of a constrained quantity by number of satellites, for the constraint at a place of the list.
fn constraint(result: &SizeResult, place: usize, text: &str) -> Option<PlaneChart> {
    let parsed: Constraint = text.parse().ok()?;
    let at = |satellites: usize, of: &[KeptConstraint]| {
        let value = of.get(place)?.value.filter(|value| value.is_finite())?;
        Some((satellites as f64, value))
    };
    let best = result.designs.iter();
    let next = result.above.iter().flat_map(|level| &level.best);
    let kept = best
        .chain(next)
        .filter_map(|one| at(one.design.satellites, &one.constraints));
    let closest = result.best_reached.iter();
    let closest = closest.filter_map(|one| at(one.satellites, &one.constraints));
    let rows = |is_scenario: bool| {
        let rows = result.robustness.iter();
        rows.filter(move |row| (row.samples == "scenario") == is_scenario)
    };
    let rejected = rows(true).filter(|row| !row.kept);
    let rejected = rejected.filter_map(|row| at(row.satellites, &row.constraints));
    let others = rows(false).filter_map(|row| at(row.satellites, &row.constraints));
    let between = result.refinement.iter();
    let between = between.filter_map(|one| at(one.satellites, &one.constraints));
    let mut layers: Vec<Layer> = [
        layer("other samples", Style::Faint, others.collect()),
        layer("rejected", REJECTED, closest.chain(rejected).collect()),
        layer("keep the constraints", KEPT, kept.collect()),
        layer("between the steps", Style::Marks(2), between.collect()),
    ]
    .into_iter()
    .flatten()
    .collect();
    let all = layers.iter().flat_map(|layer| &layer.points);
    let ends = all.fold(None, |ends: Option<[f64; 2]>, (x, _)| {
        let [low, high] = ends.unwrap_or([*x, *x]);
        Some([low.min(*x), high.max(*x)])
    });
    let [low, high] = ends?;
    let bound = vec![(low - 0.5, parsed.bound), (high + 0.5, parsed.bound)];
    layers.extend(layer("bound", Style::Rule, bound));
    let y = Axis::new(quantity_label(&parsed.quantity.to_string()));
    plane(text.to_owned(), y, layers)
}

fn front(front: &SizeFront) -> PlaneChart {
    let members = front.members.iter();
    let points = members.map(|member| (member.satellites as f64, member.value));
    let objective = quantity_label(&front.objective);
    PlaneChart {
        title: format!("Satellites against {objective}"),
        x: Axis {
            is_whole: true,
            ..Axis::new("satellites")
        },
        y: Axis::new(objective),
        measure: MeasureAxis::Neither,
        layers: vec![Layer {
            name: String::new(),
            points: points.collect(),
            style: Style::Dots(0),
        }],
    }
}

fn rules(result: &SizeResult) -> Option<RowChart> {
    let row = |constraint: &str, basis: &str, designs: u64| {
        (format!("{constraint}, by {basis}"), vec![designs as f64])
    };
    let rules = result.rules.iter().filter(|rule| rule.designs > 0);
    let rows: Vec<_> = rules
        .map(|rule| row(&rule.constraint, basis_word(rule.basis), rule.designs))
        .collect();
    (!rows.is_empty()).then(|| RowChart {
        title: "Designs rejected by each rule".to_owned(),
        x: "designs".to_owned(),
        marks: vec!["designs".to_owned()],
        rows,
    })
}

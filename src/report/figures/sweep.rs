//! The figures of a sweep: how the main metrics go with the variables of the designs.

use super::{
    Axis, AxisScale, Better, Chart, Layer, MeasureAxis, PlaneChart, Style, quantity_label,
};
use crate::report::sweep_summary::{MEASURES, SweepSummary, VARIABLES, ValueGroup};

/// From this quotient of the ends an axis is logarithmic.
const WIDE: f64 = 20.0;

/// Up to so many groups each has a dot.
const FEW: usize = 40;

/// The charts; none of what is the same for all designs.
pub(in crate::report) fn sweep_figures(summary: &SweepSummary) -> Vec<Chart> {
    let mut figures = Vec::new();
    for (variable, groups) in VARIABLES.iter().zip(&summary.variables) {
        let groups: Vec<&ValueGroup> = groups.groups().collect();
        for (place, (measure, better)) in MEASURES.iter().enumerate() {
            let (measure, variable) = (quantity(measure), label(variable));
            let chart = against(&groups, (&measure, place, *better), &variable);
            figures.extend(chart.map(Chart::Plane));
        }
    }
    figures
}

fn quantity(column: &str) -> String {
    quantity_label(&column.replace('_', "-"))
}

fn label(variable: &str) -> String {
    match variable {
        "inclination_deg" => "inclination (deg)".to_owned(),
        "altitude_km" => "altitude (km)".to_owned(),
        other => other.to_owned(),
    }
}

/// A measure against a variable: from the least to the greatest, and the best.
fn against(
    groups: &[&ValueGroup],
    (measure, place, better): (&str, usize, Better),
    variable: &str,
) -> Option<PlaneChart> {
    let found = groups.iter().filter_map(|group| {
        let x = f64::midpoint(group.ends[0], group.ends[1]);
        Some((x, group.ranges[place].as_ref()?))
    });
    let found: Vec<_> = found.collect();
    if found.len() < 2 {
        return None;
    }
    let low = found.iter().map(|(x, range)| (*x, range.least.0));
    let high = found.iter().map(|(x, range)| (*x, range.greatest.0));
    let ends = |values: &mut dyn Iterator<Item = f64>| values.fold(None, widened);
    let [least, greatest] = ends(&mut low.clone().chain(high.clone()).map(|point| point.1))?;
    if least >= greatest {
        return None;
    }
    let best: Vec<(f64, f64)> = (found.iter())
        .map(|(x, range)| (*x, range.best(better).0))
        .collect();
    let dots = if best.len() > FEW {
        Vec::new()
    } else {
        best.clone()
    };
    let layer = |name: &str, style, points| Layer {
        name: name.to_owned(),
        points,
        style,
    };
    let mut layers = vec![
        layer(
            "all designs",
            Style::Band(0),
            low.chain(high.rev()).collect(),
        ),
        layer("best design", Style::Line(0), best),
        layer("", Style::Dots(0), dots),
    ];
    layers.retain(|layer| !layer.points.is_empty());
    let is_wide = least > 0.0 && greatest / least > WIDE;
    Some(PlaneChart {
        title: format!("{measure} by {variable}"),
        x: Axis {
            is_whole: !variable.contains('('),
            ..Axis::new(variable)
        },
        y: Axis {
            scale: match is_wide {
                true => AxisScale::Log,
                false => AxisScale::Linear,
            },
            ..Axis::new(measure)
        },
        measure: MeasureAxis::Neither,
        layers,
    })
}

fn widened(ends: Option<[f64; 2]>, value: f64) -> Option<[f64; 2]> {
    let [low, high] = ends.unwrap_or([value; 2]);
    Some([low.min(value), high.max(value)])
}

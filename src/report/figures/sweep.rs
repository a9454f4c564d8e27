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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::typed_columns::TypedColumns;

    fn figures(csv: &str) -> Vec<PlaneChart> {
        let mut summary = SweepSummary::default();
        summary.add(&TypedColumns::of_csv(csv).unwrap());
        let plane = |chart| match chart {
            Chart::Plane(plane) => plane,
            other => panic!("{other:?}"),
        };
        sweep_figures(&summary).into_iter().map(plane).collect()
    }

    #[test]
    fn what_is_the_same_for_all_designs_has_no_figure() {
        let found = figures(
            "notation,satellites,planes,mean_pdop,availability,mean_visible\n\
             a,24,6,2,1,3\nb,24,6,50,1,4\nc,30,6,1.5,1,5\nd,36,6,,1,0\n",
        );
        // The planes are the same, and so is availability; CVaR is missing.
        let titles: Vec<&str> = found.iter().map(|one| one.title.as_str()).collect();
        let visible = "mean visible LEO satellites by satellites";
        assert_eq!(titles, ["mean PDOP by satellites", visible]);
        let best = |chart: &PlaneChart| chart.layers[1].points.clone();
        assert_eq!(best(&found[0]), [(24.0, 2.0), (30.0, 1.5)]);
        assert_eq!(best(&found[1]), [(24.0, 4.0), (30.0, 5.0), (36.0, 0.0)]);
        // PDOP spans more than a factor of 20, and satellites in view begin at 0.
        let scales = [found[0].y.scale, found[1].y.scale];
        assert_eq!(scales, [AxisScale::Log, AxisScale::Linear]);
        assert!(figures("notation,satellites,mean_pdop\na,24,2\n").is_empty());
        assert!(figures("notation,satellites,mean_pdop\na,24,\nb,30,\n").is_empty());
    }
}

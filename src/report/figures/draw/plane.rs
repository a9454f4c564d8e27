//! Points and lines in a plane.

use super::{
    Area, COLOURS, Drawn, GRID, INK, PlaneChart, decimals, fine, font, line, padded, signed,
};
use crate::report::figures::{Layer, Style};
use plotters::coord::CoordTranslate;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

type Context<'a, 'b> =
    ChartContext<'a, SVGBackend<'b>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

/// Number of points above which a line is drawn thin.
const DENSE: usize = 400;

const FAINT: RGBColor = RGBColor(200, 204, 210);
const RULE: RGBColor = RGBColor(110, 110, 110);

pub(super) fn draw(root: &Area<'_>, chart: &PlaneChart) -> Drawn {
    let points = || chart.layers.iter().flat_map(|layer| &layer.points);
    let x = padded(points().map(|p| p.0));
    let mut y = padded(points().map(|p| p.1));
    let named = chart
        .layers
        .iter()
        .filter(|layer| !layer.name.is_empty())
        .count();
    let (corner, is_free) = corner(points(), &x, &y);
    if named > 0 && !is_free {
        y.end += 0.06 * (named as f64 + 1.0) * (y.end - y.start);
    }
    let (x_decimals, y_decimals) = (decimals(&x), decimals(&y));
    let mut context = ChartBuilder::on(root)
        .caption(&chart.title, font(17))
        .margin(fine(12))
        .x_label_area_size(fine(48))
        .y_label_area_size(fine(64))
        .build_cartesian_2d(x, y)?;
    context
        .configure_mesh()
        .x_desc(&chart.x)
        .y_desc(&chart.y)
        .x_labels(8)
        .y_labels(8)
        .x_label_formatter(&|x| format!("{x:.x_decimals$}"))
        .y_label_formatter(&|y| format!("{y:.y_decimals$}"))
        .set_all_tick_mark_size(fine(4))
        .axis_style(line(INK, 1))
        .bold_line_style(line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .label_style(font(12))
        .axis_desc_style(font(14))
        .draw()?;
    for layer in &chart.layers {
        draw_layer(&mut context, layer)?;
    }
    if named > 0 {
        legend(&mut context, corner)?;
    }
    Ok(())
}

/// The corner with the fewest points, and whether it has none; the upper right if equal.
fn corner<'a>(
    points: impl Iterator<Item = &'a (f64, f64)>,
    x: &std::ops::Range<f64>,
    y: &std::ops::Range<f64>,
) -> (SeriesLabelPosition, bool) {
    let corners = [
        (SeriesLabelPosition::UpperRight, [true, true]),
        (SeriesLabelPosition::LowerRight, [true, false]),
        (SeriesLabelPosition::UpperLeft, [false, true]),
        (SeriesLabelPosition::LowerLeft, [false, false]),
    ];
    let mut counts = [0_usize; 4];
    for (px, py) in points {
        let across = (px - x.start) / (x.end - x.start);
        let up = (py - y.start) / (y.end - y.start);
        for (count, (_, [right, upper])) in counts.iter_mut().zip(&corners) {
            let near = |share: f64, end: bool| if end { share > 0.6 } else { share < 0.4 };
            *count += usize::from(near(across, *right) && near(up, *upper));
        }
    }
    let least = (0..4).min_by_key(|&n| counts[n]).unwrap_or(0);
    if counts[least] == 0 {
        (corners[least].0.clone(), true)
    } else {
        (SeriesLabelPosition::UpperRight, false)
    }
}

fn draw_layer<'a, 'b: 'a>(context: &mut Context<'a, 'b>, layer: &Layer) -> Drawn {
    let points = layer.points.iter().copied();
    match layer.style {
        Style::Line(n) => {
            // A bold line through many points would fill the plane.
            let width = if layer.points.len() > DENSE { 1 } else { 2 };
            let style = line(colour(n), width);
            let drawn = context.draw_series(LineSeries::new(points, style))?;
            if !layer.name.is_empty() {
                drawn
                    .label(&layer.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + signed(18), y)], style));
            }
        }
        Style::Rule => {
            let style = line(RULE, 1);
            let line = DashedLineSeries::new(points, fine(6), fine(4), style);
            context
                .draw_series(line)?
                .label(&layer.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + signed(18), y)], style));
        }
        Style::Faint => dots(context, layer, (FAINT, 2))?,
        Style::Dots(n) => dots(context, layer, (colour(n), 4))?,
        Style::Marks(n) => marks(context, layer, n)?,
    }
    Ok(())
}

fn dots(context: &mut Context<'_, '_>, layer: &Layer, (colour, radius): (RGBColor, i32)) -> Drawn {
    let dot = move |at| Circle::new(at, signed(radius), colour.filled());
    let drawn = context.draw_series(layer.points.iter().copied().map(dot))?;
    drawn
        .label(&layer.name)
        .legend(move |(x, y)| Circle::new((x + signed(9), y), signed(radius), colour.filled()));
    Ok(())
}

/// Large marks: rings for the first set, then triangles, crosses, squares and diamonds in turn, so that no two of
/// twelve sets have both colour and form.
fn marks<'a, 'b: 'a>(context: &mut Context<'a, 'b>, layer: &Layer, n: usize) -> Drawn {
    let style = line(colour(n + 1), 2);
    let (size, half) = (signed(7), signed(9));
    let points = layer.points.iter().copied();
    match n.checked_sub(1).map(|n| n % 4) {
        None => {
            let ring = points.map(|at| Circle::new(at, size, style));
            let drawn = context.draw_series(ring)?.label(&layer.name);
            drawn.legend(move |(x, y)| Circle::new((x + half, y), size, style));
        }
        Some(0) => {
            let triangle = points.map(|at| TriangleMarker::new(at, size, style.filled()));
            let drawn = context.draw_series(triangle)?.label(&layer.name);
            drawn.legend(move |(x, y)| TriangleMarker::new((x + half, y), size, style.filled()));
        }
        Some(1) => {
            let cross = points.map(|at| Cross::new(at, size, style));
            let drawn = context.draw_series(cross)?.label(&layer.name);
            drawn.legend(move |(x, y)| Cross::new((x + half, y), size, style));
        }
        Some(form) => {
            let corners = if form == 2 {
                square(size)
            } else {
                diamond(size)
            };
            let mark = points
                .map(|at| EmptyElement::at(at) + Polygon::new(corners.to_vec(), style.filled()));
            let drawn = context.draw_series(mark)?.label(&layer.name);
            drawn.legend(move |(x, y)| {
                EmptyElement::at((x + half, y)) + Polygon::new(corners.to_vec(), style.filled())
            });
        }
    }
    Ok(())
}

fn square(size: i32) -> [(i32, i32); 4] {
    let side = size * 4 / 5;
    [(-side, -side), (side, -side), (side, side), (-side, side)]
}

fn diamond(size: i32) -> [(i32, i32); 4] {
    [(0, -size), (size, 0), (0, size), (-size, 0)]
}

fn colour(n: usize) -> RGBColor {
    COLOURS[n % COLOURS.len()]
}

/// The legend in a corner.
pub(super) fn legend<'a, 'b: 'a, C: CoordTranslate>(
    context: &mut ChartContext<'a, SVGBackend<'b>, C>,
    corner: SeriesLabelPosition,
) -> Drawn {
    context
        .configure_series_labels()
        .position(corner)
        .margin(fine(8))
        .legend_area_size(fine(22))
        .background_style(WHITE.mix(0.85))
        .border_style(line(GRID, 1))
        .label_font(font(12))
        .draw()
}

//! Points and lines in a plane.

use super::{Area, COLOURS, Drawn, GRID, INK, PlaneChart, Scale, padded};
use crate::report::figures::{Layer, Style};
use plotters::coord::CoordTranslate;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

type Context<'a, DB> = ChartContext<'a, DB, Cartesian2d<RangedCoordf64, RangedCoordf64>>;

const FAINT: RGBColor = RGBColor(200, 204, 210);
const RULE: RGBColor = RGBColor(110, 110, 110);

pub(super) fn draw<'a, DB: DrawingBackend + 'a>(
    root: &'a Area<DB>,
    chart: &PlaneChart,
    scale: Scale,
) -> Drawn<DB> {
    let points = || chart.layers.iter().flat_map(|layer| &layer.points);
    let mut context = ChartBuilder::on(root)
        .caption(&chart.title, scale.font(17.0))
        .margin(scale.of(12))
        .x_label_area_size(scale.of(48))
        .y_label_area_size(scale.of(64))
        .build_cartesian_2d(padded(points().map(|p| p.0)), padded(points().map(|p| p.1)))?;
    context
        .configure_mesh()
        .x_desc(&chart.x)
        .y_desc(&chart.y)
        .x_labels(8)
        .y_labels(8)
        .axis_style(scale.line(INK, 1))
        .bold_line_style(scale.line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .label_style(scale.font(12.0))
        .axis_desc_style(scale.font(14.0))
        .draw()?;
    for layer in &chart.layers {
        draw_layer(&mut context, layer, scale)?;
    }
    if chart.layers.iter().any(|layer| !layer.name.is_empty()) {
        legend(&mut context, scale)?;
    }
    Ok(())
}

fn draw_layer<'a, DB: DrawingBackend + 'a>(
    context: &mut Context<'a, DB>,
    layer: &Layer,
    scale: Scale,
) -> Drawn<DB> {
    let points = layer.points.iter().copied();
    match layer.style {
        Style::Line(n) => {
            let style = scale.line(colour(n), 2);
            let drawn = context.draw_series(LineSeries::new(points, style))?;
            if !layer.name.is_empty() {
                drawn.label(&layer.name).legend(move |(x, y)| {
                    PathElement::new([(x, y), (x + scale.signed(18), y)], style)
                });
            }
        }
        Style::Rule => {
            let style = scale.line(RULE, 1);
            let line = DashedLineSeries::new(points, scale.of(6), scale.of(4), style);
            context.draw_series(line)?.label(&layer.name).legend(move |(x, y)| {
                PathElement::new([(x, y), (x + scale.signed(18), y)], style)
            });
        }
        Style::Faint => dots(context, layer, (FAINT, 2), scale)?,
        Style::Dots(n) => dots(context, layer, (colour(n), 4), scale)?,
        Style::Marks(n) => marks(context, layer, n, scale)?,
    }
    Ok(())
}

fn dots<'a, DB: DrawingBackend + 'a>(
    context: &mut Context<'a, DB>,
    layer: &Layer,
    (colour, radius): (RGBColor, i32),
    scale: Scale,
) -> Drawn<DB> {
    let dot = move |at| Circle::new(at, scale.signed(radius), colour.filled());
    let drawn = context.draw_series(layer.points.iter().copied().map(dot))?;
    drawn.label(&layer.name).legend(move |(x, y)| {
        Circle::new((x + scale.signed(9), y), scale.signed(radius), colour.filled())
    });
    Ok(())
}

/// Large marks: rings for the first set, then triangles and crosses in turn.
fn marks<'a, DB: DrawingBackend + 'a>(
    context: &mut Context<'a, DB>,
    layer: &Layer,
    n: usize,
    scale: Scale,
) -> Drawn<DB> {
    let style = scale.line(colour(n + 1), 2);
    let (size, half) = (scale.signed(7), scale.signed(9));
    let points = layer.points.iter().copied();
    if n == 0 {
        let ring = points.map(|at| Circle::new(at, size, style));
        let drawn = context.draw_series(ring)?.label(&layer.name);
        drawn.legend(move |(x, y)| Circle::new((x + half, y), size, style));
    } else if n % 2 == 1 {
        let triangle = points.map(|at| TriangleMarker::new(at, size, style.filled()));
        let drawn = context.draw_series(triangle)?.label(&layer.name);
        drawn.legend(move |(x, y)| TriangleMarker::new((x + half, y), size, style.filled()));
    } else {
        let cross = points.map(|at| Cross::new(at, size, style));
        let drawn = context.draw_series(cross)?.label(&layer.name);
        drawn.legend(move |(x, y)| Cross::new((x + half, y), size, style));
    }
    Ok(())
}

fn colour(n: usize) -> RGBColor {
    COLOURS[n % COLOURS.len()]
}

/// The legend in the corner that is least in the way.
pub(super) fn legend<'a, DB: DrawingBackend + 'a, C: CoordTranslate>(
    context: &mut ChartContext<'a, DB, C>,
    scale: Scale,
) -> Drawn<DB> {
    context
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .margin(scale.of(8))
        .legend_area_size(scale.of(22))
        .background_style(WHITE.mix(0.85))
        .border_style(scale.line(GRID, 1))
        .label_font(scale.font(12.0))
        .draw()
}

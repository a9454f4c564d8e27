//! Dots on rows, in units of a tolerance.

use super::{Area, COLOURS, DeviationChart, Drawn, GRID, INK, fine, font, line, signed};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Height of a row.
const ROW: u32 = 18;

/// Height of everything but the rows.
const AROUND: u32 = 110;

/// Width of the names of the rows.
const NAMES: u32 = 300;

/// Half of the axis, in tolerances.
const REACH: f64 = 3.0;

/// Where a dot beyond the axis is drawn.
const EDGE: f64 = 2.9;

const BAND: RGBColor = RGBColor(232, 240, 246);

pub(super) fn height(chart: &DeviationChart) -> u32 {
    AROUND + ROW * chart.rows.len() as u32
}

pub(super) fn draw(root: &Area<'_>, chart: &DeviationChart) -> Drawn {
    let rows = chart.rows.len() as f64;
    let mut context = ChartBuilder::on(root)
        .caption(&chart.title, font(17))
        .margin(fine(12))
        .x_label_area_size(fine(48))
        .y_label_area_size(fine(NAMES))
        .build_cartesian_2d(-REACH..REACH, 0.0..rows)?;
    let band = Rectangle::new([(-1.0, 0.0), (1.0, rows)], BAND.filled());
    context.draw_series(std::iter::once(band))?;
    context
        .configure_mesh()
        .disable_y_mesh()
        .y_labels(0)
        .x_desc(&chart.x)
        .x_labels(7)
        .set_all_tick_mark_size(fine(4))
        .axis_style(line(INK, 1))
        .bold_line_style(line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .label_style(font(12))
        .axis_desc_style(font(14))
        .draw()?;
    // The first row is on top.
    let middle = |n: usize| rows - 0.5 - n as f64;
    for (n, row) in chart.rows.iter().enumerate() {
        let style = COLOURS[row.colour % COLOURS.len()].filled();
        let at = (row.tolerances.clamp(-EDGE, EDGE), middle(n));
        if row.tolerances.abs() <= EDGE {
            let dot = Circle::new(at, signed(4), style);
            context.draw_series(std::iter::once(dot))?;
        } else {
            // An arrow to where the dot would be.
            let side = signed(if row.tolerances > 0.0 { 6 } else { -6 });
            let arrow = vec![(side, 0), (-side, -side), (-side, side)];
            let mark = EmptyElement::at(at) + Polygon::new(arrow, style);
            context.draw_series(std::iter::once(mark))?;
        }
    }
    let area = context.plotting_area();
    let left = area.get_x_axis_pixel_range().start;
    for (n, row) in chart.rows.iter().enumerate() {
        let (_, y) = area.map_coordinate(&(-REACH, middle(n)));
        let style = font(12).pos(Pos::new(HPos::Right, VPos::Center));
        root.draw(&Text::new(row.name.clone(), (left - signed(8), y), style))?;
    }
    Ok(())
}

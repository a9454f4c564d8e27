//! Rows of bars over time.

use super::{Area, COLOURS, Drawn, GRID, INK, TimelineChart, fine, font, line, signed};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Height of a row.
const ROW: u32 = 16;

/// Height of everything but the rows.
const AROUND: u32 = 110;

/// Width of the names of the rows.
const NAMES: u32 = 150;

/// Most characters of a name.
const NAME_CHARACTERS: usize = 24;

pub(super) fn height(chart: &TimelineChart) -> u32 {
    AROUND + ROW * chart.rows.len().max(1) as u32
}

pub(super) fn draw(root: &Area<'_>, chart: &TimelineChart) -> Drawn {
    // Without an outage there is an empty row, and of a single instant some time, so that there are axes.
    let rows = chart.rows.len().max(1) as f64;
    let [start, end] = chart.span;
    let end = if end > start { end } else { start + 1.0 };
    let mut context = ChartBuilder::on(root)
        .caption(&chart.title, font(17))
        .margin(fine(12))
        .x_label_area_size(fine(48))
        .y_label_area_size(fine(NAMES))
        .build_cartesian_2d(start..end, 0.0..rows)?;
    context
        .configure_mesh()
        .disable_y_mesh()
        .y_labels(0)
        .x_desc(&chart.x)
        .x_labels(8)
        .set_all_tick_mark_size(fine(4))
        .axis_style(line(INK, 1))
        .bold_line_style(line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .label_style(font(12))
        .axis_desc_style(font(14))
        .draw()?;
    // The first row is on top.
    let base = |n: usize| rows - 1.0 - n as f64;
    for (n, (_, bars)) in chart.rows.iter().enumerate() {
        let bar = |&[from, to]: &[f64; 2]| {
            let corners = [(from, base(n) + 0.15), (to, base(n) + 0.85)];
            Rectangle::new(corners, COLOURS[1].filled())
        };
        context.draw_series(bars.iter().map(bar))?;
    }
    let area = context.plotting_area();
    let left = area.get_x_axis_pixel_range().start;
    for (n, (name, _)) in chart.rows.iter().enumerate() {
        let (_, y) = area.map_coordinate(&(start, base(n) + 0.5));
        let style = font(12).pos(Pos::new(HPos::Right, VPos::Center));
        let name: String = name.chars().take(NAME_CHARACTERS).collect();
        root.draw(&Text::new(name, (left - signed(8), y), style))?;
    }
    Ok(())
}

//! Rows of bars over time.

use super::frame::{NamedRows, x_labels_height};
use super::heading::Heading;
use super::palette::colour;
use super::ruler::Ruler;
use super::sheet::Sheet;
use super::{Area, Drawn};
use crate::report::figures::{Axis, TimelineChart};
use plotters::prelude::*;

/// Height of a row in heights of the text.
const ROW: f64 = 1.5;

/// Most of the width that names take.
const NAMES: f64 = 0.35;

fn heading(chart: &TimelineChart) -> Heading<'_> {
    Heading {
        title: &chart.title,
        entries: Vec::new(),
    }
}

pub(super) fn height(chart: &TimelineChart, sheet: Sheet) -> u32 {
    let rows = sheet.em(ROW * chart.rows.len().max(2) as f64);
    (heading(chart).height(sheet) + rows + x_labels_height(sheet)) as u32
}

pub(super) fn draw(area: &Area<'_>, chart: &TimelineChart, sheet: Sheet) -> Drawn {
    let heading = heading(chart);
    heading.draw(area, sheet)?;
    let names = chart.rows.iter().map(|(name, _)| name.as_str());
    let rows = NamedRows::new(area, sheet, heading.height(sheet), names, NAMES);
    let frame = &rows.frame;
    let axis = Axis {
        range: Some(chart.span),
        ..Axis::default()
    };
    let ticks = ((frame.right - frame.left) / sheet.em(4.5)).clamp(2, 9) as usize;
    let ruler = Ruler::new(&axis, std::iter::empty(), ticks, true);
    frame.draw_grid(area, &ruler, true)?;
    for (n, (_, bars)) in chart.rows.iter().enumerate() {
        for [from, to] in bars {
            let across = [*from, *to].map(|time| frame.across(ruler.share(time).clamp(0.0, 1.0)));
            let corners = [(across[0], rows.y(n, 0.2)), (across[1], rows.y(n, 0.8))];
            area.draw(&Rectangle::new(corners, colour(1).filled()))?;
        }
        rows.draw_name(area, sheet, n)?;
    }
    frame.draw_box(area)?;
    frame.draw_x(area, &ruler, &chart.x, sheet)
}

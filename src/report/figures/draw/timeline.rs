//! Rows of bars over time.

use super::frame::{PlotFrame, x_labels_height};
use super::heading::Heading;
use super::palette::colour;
use super::ruler::Ruler;
use super::sheet::Sheet;
use super::{Area, Drawn};
use crate::report::figures::{Axis, TimelineChart};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

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
    let (width, height) = area.dim_in_pixel();
    let most = (NAMES * f64::from(width)) as i32;
    let names = chart
        .rows
        .iter()
        .map(|(name, _)| sheet.fitted(name, 1.0, most));
    let names: Vec<String> = names.collect();
    let widest = names
        .iter()
        .map(|name| sheet.text_width(name, 1.0))
        .max()
        .unwrap_or(0);
    let frame = PlotFrame {
        left: widest + sheet.em(1.4),
        right: width as i32 - sheet.em(1.2),
        top: heading.height(sheet),
        bottom: height as i32 - x_labels_height(sheet),
    };
    let axis = Axis {
        range: Some(chart.span),
        ..Axis::default()
    };
    let ticks = ((frame.right - frame.left) / sheet.em(4.5)).clamp(2, 9) as usize;
    let ruler = Ruler::new(&axis, std::iter::empty(), ticks, true);
    frame.draw_grid(area, &ruler, true)?;
    // Without an outage there is an empty row.
    let count = chart.rows.len().max(1) as f64;
    let side = Pos::new(HPos::Right, VPos::Center);
    for (n, ((_, bars), name)) in chart.rows.iter().zip(names).enumerate() {
        let at = |share: f64| frame.up(1.0 - (n as f64 + share) / count);
        for [from, to] in bars {
            let across = [*from, *to].map(|time| frame.across(ruler.share(time).clamp(0.0, 1.0)));
            let corners = [(across[0], at(0.2)), (across[1], at(0.8))];
            area.draw(&Rectangle::new(corners, colour(1).filled()))?;
        }
        let at = (frame.left - sheet.em(0.6), at(0.5));
        area.draw(&Text::new(name, at, sheet.font().pos(side)))?;
    }
    frame.draw_box(area)?;
    frame.draw_x(area, &ruler, &chart.x, sheet)
}

//! Dots on rows, in units of a tolerance.

use super::frame::{PlotFrame, x_labels_height};
use super::heading::Heading;
use super::palette::colour;
use super::ruler::Ruler;
use super::sheet::Sheet;
use super::{Area, Drawn};
use crate::report::figures::{Axis, DeviationChart};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Height of a row in heights of the text.
const ROW: f64 = 1.5;

/// Most of the width that names take.
const NAMES: f64 = 0.5;

/// Half of the axis, in tolerances.
const REACH: f64 = 3.0;

/// Where a dot beyond the axis is drawn.
const EDGE: f64 = 2.9;

const BAND: RGBColor = RGBColor(229, 238, 245);

fn heading(chart: &DeviationChart) -> Heading<'_> {
    Heading {
        title: &chart.title,
        entries: Vec::new(),
    }
}

pub(super) fn height(chart: &DeviationChart, sheet: Sheet) -> u32 {
    let rows = sheet.em(ROW * chart.rows.len().max(2) as f64);
    (heading(chart).height(sheet) + rows + x_labels_height(sheet)) as u32
}

pub(super) fn draw(area: &Area<'_>, chart: &DeviationChart, sheet: Sheet) -> Drawn {
    let heading = heading(chart);
    heading.draw(area, sheet)?;
    let (width, height) = area.dim_in_pixel();
    let most = (NAMES * f64::from(width)) as i32;
    let names = chart
        .rows
        .iter()
        .map(|row| sheet.fitted(&row.name, 1.0, most));
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
        range: Some([-REACH, REACH]),
        ..Axis::default()
    };
    let ruler = Ruler::new(&axis, std::iter::empty(), 6, true);
    let within = [-1.0, 1.0].map(|x| frame.across(ruler.share(x)));
    let band = [(within[0], frame.top), (within[1], frame.bottom)];
    area.draw(&Rectangle::new(band, BAND.filled()))?;
    frame.draw_grid(area, &ruler, true)?;
    let count = chart.rows.len().max(1) as f64;
    let side = Pos::new(HPos::Right, VPos::Center);
    for (n, (row, name)) in chart.rows.iter().zip(names).enumerate() {
        let y = frame.up(1.0 - (n as f64 + 0.5) / count);
        let x = frame.across(ruler.share(row.tolerances.clamp(-EDGE, EDGE)));
        let style = colour(row.colour).filled();
        if row.tolerances.abs() <= EDGE {
            area.draw(&Circle::new((x, y), sheet.em(0.3), style))?;
        } else {
            // An arrow to where the dot would be.
            let side = sheet.em(if row.tolerances > 0.0 { 0.4 } else { -0.4 });
            let arrow = vec![(x + side, y), (x - side, y - side), (x - side, y + side)];
            area.draw(&Polygon::new(arrow, style))?;
        }
        let at = (frame.left - sheet.em(0.6), y);
        area.draw(&Text::new(name, at, sheet.font().pos(side)))?;
    }
    frame.draw_box(area)?;
    frame.draw_x(area, &ruler, &chart.x, sheet)
}

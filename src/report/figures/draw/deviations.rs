//! Dots on rows, in units of a tolerance.

use super::frame::{NamedRows, x_labels_height};
use super::heading::Heading;
use super::palette::colour;
use super::ruler::Ruler;
use super::sheet::Sheet;
use super::{Area, Drawn};
use crate::report::figures::{Axis, DeviationChart};
use plotters::prelude::*;

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
    let names = chart.rows.iter().map(|row| row.name.as_str());
    let rows = NamedRows::new(area, sheet, heading.height(sheet), names, NAMES);
    let frame = &rows.frame;
    let axis = Axis {
        range: Some([-REACH, REACH]),
        ..Axis::default()
    };
    let ruler = Ruler::new(&axis, std::iter::empty(), 6, true);
    let within = [-1.0, 1.0].map(|x| frame.across(ruler.share(x)));
    let band = [(within[0], frame.top), (within[1], frame.bottom)];
    area.draw(&Rectangle::new(band, BAND.filled()))?;
    frame.draw_grid(area, &ruler, true)?;
    for (n, row) in chart.rows.iter().enumerate() {
        let y = rows.y(n, 0.5);
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
        rows.draw_name(area, sheet, n)?;
    }
    frame.draw_box(area)?;
    frame.draw_x(area, &ruler, &chart.x, sheet)
}

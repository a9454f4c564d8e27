//! Marks on rows along a logarithmic axis.

use super::frame::{NamedRows, x_labels_height};
use super::heading::Heading;
use super::marks::{self, Mark};
use super::ruler::Ruler;
use super::sheet::{Sheet, line};
use super::{Area, Drawn, GRID};
use crate::report::figures::{Axis, AxisScale, RowChart};
use plotters::prelude::*;

/// Height of a row in heights of the text.
const ROW: f64 = 2.0;

/// Most of the width that names take.
const NAMES: f64 = 0.4;

pub(super) fn height(chart: &RowChart, sheet: Sheet) -> u32 {
    let rows = sheet.em(ROW * chart.rows.len().max(1) as f64);
    (heading(chart).height(sheet) + rows + x_labels_height(sheet)) as u32
}

fn heading(chart: &RowChart) -> Heading<'_> {
    let marks = chart.marks.iter().enumerate();
    Heading {
        title: &chart.title,
        entries: marks.map(|(n, name)| (mark(n), name.clone())).collect(),
    }
}

/// The first mark is a dot.
fn mark(n: usize) -> Mark {
    match n {
        0 => Mark::Dot(0),
        _ => Mark::Form(n),
    }
}

/// Whole powers of ten around the sizes.
fn ruler(chart: &RowChart, most_ticks: usize) -> Ruler {
    let sizes = chart.rows.iter().flat_map(|(_, sizes)| sizes);
    let sizes: Vec<f64> = sizes
        .copied()
        .filter(|x| *x > 0.0 && x.is_finite())
        .collect();
    let least = sizes.iter().copied().fold(f64::INFINITY, f64::min);
    let most = sizes.iter().copied().fold(0.0, f64::max);
    let decades = match sizes.is_empty() {
        true => [0.0, 1.0],
        false => [least.log10().floor(), (most.log10() + 1e-9).ceil()],
    };
    let [low, high] = decades;
    let axis = Axis {
        scale: AxisScale::Log,
        range: Some([10_f64.powf(low), 10_f64.powf(high.max(low + 1.0))]),
        ..Axis::default()
    };
    Ruler::new(&axis, std::iter::empty(), most_ticks, true)
}

pub(super) fn draw(area: &Area<'_>, chart: &RowChart, sheet: Sheet) -> Drawn {
    let heading = heading(chart);
    heading.draw(area, sheet)?;
    let names = chart.rows.iter().map(|(name, _)| name.as_str());
    let rows = NamedRows::new(area, sheet, heading.height(sheet), names, NAMES);
    let frame = &rows.frame;
    let ruler = ruler(
        chart,
        ((frame.right - frame.left) / sheet.em(4.0)).clamp(2, 12) as usize,
    );
    frame.draw_grid(area, &ruler, true)?;
    for (n, (_, sizes)) in chart.rows.iter().enumerate() {
        let y = rows.y(n, 0.5);
        let across = vec![(frame.left, y), (frame.right, y)];
        area.draw(&PathElement::new(across, line(GRID, 0.4)))?;
        rows.draw_name(area, sheet, n)?;
        for (m, size) in sizes.iter().enumerate().filter(|(_, size)| **size > 0.0) {
            let place = (frame.across(ruler.share(*size)), y);
            marks::draw(area, place, mark(m), sheet)?;
        }
    }
    frame.draw_box(area)?;
    frame.draw_x(area, &ruler, &chart.x, sheet)
}

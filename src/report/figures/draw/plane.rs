//! Points and lines in a plane.

use super::frame::{PlotFrame, clipped, x_labels_height, y_label_width, y_labels_width};
use super::heading::Heading;
use super::marks::{self, Mark, draw_line};
use super::palette::colour;
use super::ruler::Ruler;
use super::sheet::Sheet;
use super::{Area, Drawn};
use crate::report::figures::{Layer, PlaneChart, Style};
use plotters::prelude::*;

/// Height of the data by the width of the sheet: of one column of a journal, and of more.
const NARROW: (f64, u32) = (0.62, 110);
const WIDE: f64 = 0.42;

/// Share of its colour in a band, over white.
const TINT: f64 = 0.3;

pub(super) fn height(chart: &PlaneChart, sheet: Sheet) -> u32 {
    let width = f64::from(sheet.width());
    let (share, widest_mm) = NARROW;
    let is_narrow = width <= f64::from(super::sheet::mm(widest_mm));
    let data = width * if is_narrow { share } else { WIDE };
    // Large text leaves less room for the data.
    let data = (data as i32).max(sheet.em(12.0));
    (heading(chart).height(sheet) + data + x_labels_height(sheet)) as u32
}

/// Title and legend: lines and dots by their number, then marks, then the rest.
fn heading(chart: &PlaneChart) -> Heading<'_> {
    let order = |style: Style| match style {
        Style::Line(n) | Style::Dots(n) => n,
        Style::Marks(n) => 1000 + n,
        Style::Rule => 2000,
        Style::Band(_) | Style::Faint => 3000,
    };
    let mut named: Vec<&Layer> = chart
        .layers
        .iter()
        .filter(|one| !one.name.is_empty())
        .collect();
    named.sort_by_key(|layer| order(layer.style));
    let entry = |layer: &Layer| (mark(layer.style), layer.name.clone());
    Heading {
        title: &chart.title,
        entries: named.into_iter().map(entry).collect(),
    }
}

fn mark(style: Style) -> Mark {
    match style {
        Style::Line(n) => Mark::Line(n),
        Style::Band(n) => Mark::Patch(tint(n)),
        Style::Rule => Mark::Rule,
        Style::Dots(n) => Mark::Dot(n),
        Style::Faint => Mark::Faint,
        Style::Marks(n) => Mark::Form(n),
    }
}

fn tint(n: usize) -> RGBColor {
    let RGBColor(r, g, b) = colour(n);
    let [r, g, b] = [r, g, b].map(|x| (255.0 - TINT * (255.0 - f64::from(x))).round() as u8);
    RGBColor(r, g, b)
}

pub(super) fn draw(area: &Area<'_>, chart: &PlaneChart, sheet: Sheet) -> Drawn {
    let heading = heading(chart);
    heading.draw(area, sheet)?;
    let (width, height) = area.dim_in_pixel();
    let points = || chart.layers.iter().flat_map(|layer| &layer.points);
    let data_height = height as i32 - heading.height(sheet) - x_labels_height(sheet);
    let most = |length: i32, each: f64| (length / sheet.em(each)).clamp(2, 9) as usize;
    let y = Ruler::new(
        &chart.y,
        points().map(|p| p.1),
        most(data_height, 2.2),
        false,
    );
    let left = y_labels_width(&y, sheet) + y_label_width(sheet) + sheet.em(0.3);
    let right = width as i32 - sheet.em(1.2);
    let x = Ruler::new(
        &chart.x,
        points().map(|p| p.0),
        most(right - left, 4.5),
        false,
    );
    let frame = PlotFrame {
        left,
        right,
        top: heading.height(sheet),
        bottom: height as i32 - x_labels_height(sheet),
    };
    frame.draw_grid(area, &x, true)?;
    frame.draw_grid(area, &y, false)?;
    for layer in &chart.layers {
        let shares = layer.points.iter().map(|p| (x.share(p.0), y.share(p.1)));
        draw_layer(area, (&frame, sheet), layer.style, shares)?;
    }
    frame.draw_box(area)?;
    frame.draw_x(area, &x, &chart.x.label, sheet)?;
    frame.draw_y(area, &y, (&chart.y.label, true), sheet)
}

/// A layer of places given as shares of the frame; what is outside is not drawn.
fn draw_layer(
    area: &Area<'_>,
    (frame, sheet): (&PlotFrame, Sheet),
    style: Style,
    shares: impl Iterator<Item = (f64, f64)>,
) -> Drawn {
    let at = |(x, y): (f64, f64)| (frame.across(x), frame.up(y));
    match style {
        Style::Line(_) | Style::Rule => {
            for part in clipped(shares) {
                let through: Vec<_> = part.into_iter().map(at).collect();
                draw_line(area, &through, mark(style))?;
            }
            Ok(())
        }
        Style::Band(n) => {
            let inside = shares.map(|(x, y)| at((x.clamp(0.0, 1.0), y.clamp(0.0, 1.0))));
            area.draw(&Polygon::new(
                inside.collect::<Vec<_>>(),
                tint(n).mix(0.8).filled(),
            ))
        }
        Style::Dots(_) | Style::Faint | Style::Marks(_) => {
            let inside = |p: &(f64, f64)| (0.0..=1.0).contains(&p.0) && (0.0..=1.0).contains(&p.1);
            for place in shares.filter(inside) {
                marks::draw(area, at(place), mark(style), sheet)?;
            }
            Ok(())
        }
    }
}

//! Marks at a place of the drawing.

use super::palette::{colour, dash};
use super::sheet::{Sheet, line, points};
use super::{Area, Drawn, INK};
use plotters::element::DashedPathElement;
use plotters::prelude::*;

/// Colour of a line that is not of a constellation.
pub(super) const RULE: RGBColor = RGBColor(90, 90, 90);

/// Colour of dots behind the others.
pub(super) const FAINT: RGBColor = RGBColor(190, 195, 202);

/// What stands for a set of data, also in the legend.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Mark {
    /// A line in the n-th colour and dash.
    Line(usize),
    /// A dotted grey line.
    Rule,
    /// A border on a map.
    Border,
    /// A dot in the n-th colour.
    Dot(usize),
    /// A pale dot.
    Faint,
    /// A large mark in the n-th colour, of the n-th form.
    Form(usize),
    /// A patch of a colour.
    Patch(RGBColor),
}

/// A line through places of the drawing, in its dash.
pub(super) fn draw_line(area: &Area<'_>, through: &[(i32, i32)], mark: Mark) -> Drawn {
    let (style, dash) = match mark {
        Mark::Line(n) => (line(colour(n), 1.0), dash(n)),
        Mark::Border => (line(INK, 1.2), None),
        _ => (line(RULE, 0.8), Some((0.8, 1.6))),
    };
    match dash {
        None => area.draw(&PathElement::new(through.to_vec(), style)),
        Some((dash, gap)) => {
            let dashed = DashedPathElement::new(through.to_vec(), points(dash), points(gap), style);
            area.draw(&dashed)
        }
    }
}

/// One mark, of a data point or in the legend.
pub(super) fn draw(area: &Area<'_>, (x, y): (i32, i32), mark: Mark, sheet: Sheet) -> Drawn {
    let half = sheet.em(1.0);
    match mark {
        Mark::Line(_) | Mark::Rule | Mark::Border => {
            draw_line(area, &[(x - half, y), (x + half, y)], mark)
        }
        Mark::Dot(n) => area.draw(&Circle::new((x, y), sheet.em(0.26), colour(n).filled())),
        Mark::Faint => area.draw(&Circle::new((x, y), sheet.em(0.16), FAINT.filled())),
        Mark::Patch(of) => {
            let (across, up) = (sheet.em(0.6), sheet.em(0.35));
            let corners = [(x - across, y - up), (x + across, y + up)];
            area.draw(&Rectangle::new(corners, of.filled()))
        }
        Mark::Form(n) => form(area, (x, y), n, sheet),
    }
}

/// A ring for the first set, then triangles, crosses, squares and diamonds in turn, so that no two of
/// twelve sets have both colour and form.
fn form(area: &Area<'_>, at: (i32, i32), n: usize, sheet: Sheet) -> Drawn {
    let size = sheet.em(0.42);
    let stroke = line(colour(n + 1), 1.1);
    let fill = colour(n + 1).filled();
    let polygon = |corners: &[(i32, i32)]| {
        let corners = corners.iter().map(|(x, y)| (at.0 + x, at.1 + y));
        area.draw(&Polygon::new(corners.collect::<Vec<_>>(), fill))
    };
    let side = size * 4 / 5;
    match n.checked_sub(1).map(|n| n % 4) {
        None => area.draw(&Circle::new(at, size + size / 4, stroke)),
        Some(0) => polygon(&[(0, -size), (size, side), (-size, side)]),
        Some(1) => area.draw(&Cross::new(at, side, stroke)),
        Some(2) => polygon(&[(-side, -side), (side, -side), (side, side), (-side, side)]),
        Some(_) => polygon(&[(0, -size), (size, 0), (0, size), (-size, 0)]),
    }
}

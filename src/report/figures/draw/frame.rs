//! A plotting area with its axes.

use super::ruler::Ruler;
use super::sheet::{Sheet, line, points};
use super::{Area, Drawn, GRID, INK};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Length of a labelled tick and of another, points.
const TICK: f64 = 3.0;
const MINOR: f64 = 1.6;

/// Height of a line of a name, and of a row with two, in heights of the text.
const LINE: f64 = 1.0;
const TWO_LINES: f64 = 1.95;

/// Width of the frame and of the grid, points.
const AXIS: f64 = 0.6;
const FINE: f64 = 0.4;

/// Where data are drawn.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct PlotFrame {
    pub(super) left: i32,
    pub(super) right: i32,
    pub(super) top: i32,
    pub(super) bottom: i32,
}

impl PlotFrame {
    /// The horizontal place of a share of the width.
    pub(super) fn across(&self, share: f64) -> i32 {
        self.left + (share * f64::from(self.right - self.left)).round() as i32
    }

    /// The vertical place of a share of the height, from the bottom.
    pub(super) fn up(&self, share: f64) -> i32 {
        self.bottom - (share * f64::from(self.bottom - self.top)).round() as i32
    }

    /// The box around the data.
    pub(super) fn draw_box(&self, area: &Area<'_>) -> Drawn {
        let corners = [
            (self.left, self.top),
            (self.right, self.top),
            (self.right, self.bottom),
            (self.left, self.bottom),
            (self.left, self.top),
        ];
        area.draw(&PathElement::new(corners.to_vec(), line(INK, AXIS)))
    }

    /// Grid lines at the ticks of the horizontal axis, or of the vertical one.
    pub(super) fn draw_grid(&self, area: &Area<'_>, ruler: &Ruler, is_across: bool) -> Drawn {
        for tick in &ruler.ticks {
            let share = (tick - ruler.low) / (ruler.high - ruler.low);
            let ends = match is_across {
                true => [self.top, self.bottom].map(|y| (self.across(share), y)),
                false => [self.left, self.right].map(|x| (x, self.up(share))),
            };
            area.draw(&PathElement::new(ends.to_vec(), line(GRID, FINE)))?;
        }
        Ok(())
    }

    /// Ticks, numbers and label of the horizontal axis. Numbers that would touch the one before are left out.
    pub(super) fn draw_x(
        &self,
        area: &Area<'_>,
        ruler: &Ruler,
        label: &str,
        sheet: Sheet,
    ) -> Drawn {
        let share = |place: f64| (place - ruler.low) / (ruler.high - ruler.low);
        for minor in &ruler.minor {
            self.x_tick(area, self.across(share(*minor)), MINOR)?;
        }
        let below = Pos::new(HPos::Center, VPos::Top);
        let mut end = i32::MIN;
        for tick in &ruler.ticks {
            let x = self.across(share(*tick));
            self.x_tick(area, x, TICK)?;
            let text = ruler.label(*tick);
            let half = sheet.text_width(&plain(&text), 1.0) / 2;
            if x - half > end {
                let at = (x, self.bottom + points(TICK) + sheet.em(0.3));
                area.draw(&Text::new(text, at, sheet.font().pos(below)))?;
                end = x + half + sheet.em(0.5);
            }
        }
        // The label is under the middle of the axis, but for one that would leave the sheet.
        let most = sheet.width() as i32 - 2 * sheet.em(0.5);
        let label = sheet.fitted(label, 1.0, most);
        let half = sheet.text_width(&plain(&label), 1.0) / 2 + sheet.em(0.5);
        let middle = ((self.left + self.right) / 2)
            .min(sheet.width() as i32 - half)
            .max(half);
        let at = (middle, self.bottom + points(TICK) + sheet.em(1.7));
        area.draw(&Text::new(label, at, sheet.font().pos(below)))
    }

    fn x_tick(&self, area: &Area<'_>, x: i32, length: f64) -> Drawn {
        let ends = vec![(x, self.bottom), (x, self.bottom + points(length))];
        area.draw(&PathElement::new(ends, line(INK, AXIS)))
    }

    /// Ticks, numbers and label of a vertical axis: the left one, or one to the right of the frame.
    pub(super) fn draw_y(
        &self,
        area: &Area<'_>,
        ruler: &Ruler,
        (label, is_left): (&str, bool),
        sheet: Sheet,
    ) -> Drawn {
        let share = |place: f64| (place - ruler.low) / (ruler.high - ruler.low);
        let sign = if is_left { -1 } else { 1 };
        let edge = if is_left { self.left } else { self.right };
        let tick_to = |length: f64| edge + sign * points(length);
        for minor in &ruler.minor {
            let y = self.up(share(*minor));
            let ends = vec![(edge, y), (tick_to(MINOR), y)];
            area.draw(&PathElement::new(ends, line(INK, AXIS)))?;
        }
        let side = Pos::new(if is_left { HPos::Right } else { HPos::Left }, VPos::Center);
        for tick in &ruler.ticks {
            let y = self.up(share(*tick));
            let ends = vec![(edge, y), (tick_to(TICK), y)];
            area.draw(&PathElement::new(ends, line(INK, AXIS)))?;
            let at = (tick_to(TICK) + sign * sheet.em(0.3), y);
            area.draw(&Text::new(ruler.label(*tick), at, sheet.font().pos(side)))?;
        }
        let away = y_labels_width(ruler, sheet) + sheet.em(0.4);
        self.draw_upright(area, edge + sign * away, label, sheet)
    }

    /// A label along a vertical axis, turned.
    fn draw_upright(&self, area: &Area<'_>, x: i32, label: &str, sheet: Sheet) -> Drawn {
        let (mut middle, height) = ((self.top + self.bottom) / 2, self.bottom - self.top);
        let room = area.dim_in_pixel().1 as i32 - 2 * sheet.em(0.4);
        let label = sheet.fitted(label, 1.0, room);
        if sheet.text_width(&plain(&label), 1.0) > height {
            middle = sheet.em(0.4) + room / 2;
        }
        let centred = Pos::new(HPos::Center, VPos::Center);
        let turned = sheet.font().transform(FontTransform::Rotate270);
        area.draw(&Text::new(label, (x, middle), turned.pos(centred)))
    }
}

/// Width of the ticks and numbers beside a vertical axis, without its label.
pub(super) fn y_labels_width(ruler: &Ruler, sheet: Sheet) -> i32 {
    let width = |tick: &f64| sheet.text_width(&plain(&ruler.label(*tick)), 1.0);
    let widest = ruler.ticks.iter().map(width).max().unwrap_or(0);
    points(TICK) + widest + sheet.em(0.8)
}

/// Height of ticks, numbers and label under a horizontal axis.
pub(super) fn x_labels_height(sheet: Sheet) -> i32 {
    points(TICK) + sheet.em(3.1)
}

/// Width of the label along a vertical axis.
pub(super) fn y_label_width(sheet: Sheet) -> i32 {
    sheet.em(1.2)
}

/// A text without the marks of its subscripts and powers, to be measured.
fn plain(text: &str) -> String {
    text.replace(['{', '}', '^', '_'], "")
}

/// The parts of a line within some bounds; places between 0 and 1 in both directions.
pub(super) fn clipped(line: impl Iterator<Item = (f64, f64)>) -> Vec<Vec<(f64, f64)>> {
    let mut parts: Vec<Vec<(f64, f64)>> = Vec::new();
    let mut before: Option<(f64, f64)> = None;
    let mut is_open = false;
    for to in line {
        let from = before.replace(to).unwrap_or(to);
        let Some([start, end]) = segment(from, to) else {
            is_open = false;
            continue;
        };
        match parts.last_mut().filter(|_| is_open) {
            Some(part) => part.push(end),
            None => parts.push(vec![start, end]),
        }
        is_open = end == to;
    }
    parts
}

/// The part of a segment in the unit square: Liang and Barsky (1984).
fn segment(from: (f64, f64), to: (f64, f64)) -> Option<[(f64, f64); 2]> {
    let (dx, dy) = (to.0 - from.0, to.1 - from.1);
    let sides = [
        (-dx, from.0),
        (dx, 1.0 - from.0),
        (-dy, from.1),
        (dy, 1.0 - from.1),
    ];
    let (mut enters, mut leaves) = (0.0_f64, 1.0_f64);
    for (towards, room) in sides {
        if towards == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if towards < 0.0 {
            enters = enters.max(room / towards);
        } else {
            leaves = leaves.min(room / towards);
        }
    }
    let at = |share: f64| match share {
        0.0 => from,
        1.0 => to,
        _ => (from.0 + share * dx, from.1 + share * dy),
    };
    (enters <= leaves).then(|| [at(enters), at(leaves)])
}

/// A frame with the name of each of its rows on the left.
pub(super) struct NamedRows {
    pub(super) frame: PlotFrame,
    /// The lines of each name.
    names: Vec<Vec<String>>,
}

impl NamedRows {
    /// Rows below `top`; names take at most a share of the width, and two lines where rows have the room.
    pub(super) fn new<'n>(
        area: &Area<'_>,
        sheet: Sheet,
        top: i32,
        names: impl ExactSizeIterator<Item = &'n str>,
        share: f64,
    ) -> Self {
        let (width, height) = area.dim_in_pixel();
        let bottom = height as i32 - x_labels_height(sheet);
        let row_height = (bottom - top) / i32::try_from(names.len().max(1)).unwrap_or(i32::MAX);
        let most_lines = if row_height >= sheet.em(TWO_LINES) {
            2
        } else {
            1
        };
        let most = (share * f64::from(width)) as i32;
        let names: Vec<Vec<String>> = names
            .map(|name| lines(name, sheet, most, most_lines))
            .collect();
        let widths = names
            .iter()
            .flatten()
            .map(|line| sheet.text_width(line, 1.0));
        let frame = PlotFrame {
            left: widths.max().unwrap_or(0) + sheet.em(1.4),
            right: width as i32 - sheet.em(1.2),
            top,
            bottom,
        };
        Self { frame, names }
    }

    /// The vertical place of a share of a row, from its top.
    pub(super) fn y(&self, row: usize, share: f64) -> i32 {
        let count = self.names.len().max(1) as f64;
        self.frame.up(1.0 - (row as f64 + share) / count)
    }

    /// The name of a row.
    pub(super) fn draw_name(&self, area: &Area<'_>, sheet: Sheet, row: usize) -> Drawn {
        let side = Pos::new(HPos::Right, VPos::Center);
        let lines = &self.names[row];
        for (n, text) in lines.iter().enumerate() {
            let below = n as f64 - 0.5 * (lines.len() as f64 - 1.0);
            let y = self.y(row, 0.5) + (below * f64::from(sheet.em(LINE))).round() as i32;
            let at = (self.frame.left - sheet.em(0.6), y);
            area.draw(&Text::new(text.clone(), at, sheet.font().pos(side)))?;
        }
        Ok(())
    }
}

/// A name in one line, or in two that are as even as its words allow; what is too long ends in an ellipsis.
fn lines(name: &str, sheet: Sheet, most: i32, most_lines: usize) -> Vec<String> {
    let width = |text: &str| sheet.text_width(text, 1.0);
    let halves = name
        .match_indices(' ')
        .map(|(at, _)| (&name[..at], &name[at + 1..]));
    let best = halves.min_by_key(|(one, other)| width(one).max(width(other)));
    match best {
        Some((one, other)) if most_lines > 1 && width(name) > most => [one, other]
            .map(|line| sheet.fitted(line, 1.0, most))
            .to_vec(),
        _ => vec![sheet.fitted(name, 1.0, most)],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_frame() {
        let line = [(0.5, 0.5), (1.5, 0.5), (1.5, 0.0), (0.0, 1.5)];
        let parts = clipped(line.into_iter());
        assert_eq!(parts.len(), 2);
        assert_eq!(parts[0], [(0.5, 0.5), (0.5, 0.5), (1.0, 0.5)]);
        let [first, last] = [parts[1][0], parts[1][1]];
        assert!(
            (first.0 - 1.0).abs() < 1e-12 && (first.1 - 0.5).abs() < 1e-12,
            "{first:?}"
        );
        assert!(
            (last.0 - 0.5).abs() < 1e-12 && (last.1 - 1.0).abs() < 1e-12,
            "{last:?}"
        );
    }
}

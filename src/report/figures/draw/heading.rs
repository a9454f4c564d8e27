//! Title and legend, above the data and never over them.

use super::marks::{self, Mark};
use super::sheet::Sheet;
use super::{Area, Drawn};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Heights in heights of the text.
const MARGIN: f64 = 0.7;
const TITLE: f64 = 1.9;
const ROW: f64 = 1.5;
const BELOW: f64 = 0.4;

/// Size of the title.
const TITLE_SIZE: f64 = 1.15;

/// Width of a mark in the legend, and the gap after an entry.
const MARK: f64 = 2.6;
const GAP: f64 = 1.4;

/// What is above the data.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Heading<'a> {
    pub(super) title: &'a str,
    /// Mark and name of each entry of the legend, in reading order.
    pub(super) entries: Vec<(Mark, String)>,
}

impl Heading<'_> {
    /// Height in units of the drawing.
    pub(super) fn height(&self, sheet: Sheet) -> i32 {
        let title = if self.title.is_empty() { 0.0 } else { TITLE };
        let rows = self.rows(sheet).len() as f64;
        sheet.em(MARGIN + title + ROW * rows + BELOW)
    }

    /// Entries of each row of the legend, with the left end of each.
    fn rows(&self, sheet: Sheet) -> Vec<Vec<(i32, Mark, String)>> {
        let (left, right) = (sheet.em(MARGIN), sheet.width() as i32 - sheet.em(MARGIN));
        let mut rows: Vec<Vec<(i32, Mark, String)>> = Vec::new();
        let mut x = right;
        for (mark, name) in &self.entries {
            let most = right - left - sheet.em(MARK);
            let name = sheet.fitted(name, 1.0, most);
            let width = sheet.em(MARK) + sheet.text_width(&name, 1.0);
            if rows.is_empty() || x + width > right {
                rows.push(Vec::new());
                x = left;
            }
            if let Some(row) = rows.last_mut() {
                row.push((x, *mark, name));
            }
            x += width + sheet.em(GAP);
        }
        rows
    }

    pub(super) fn draw(&self, area: &Area<'_>, sheet: Sheet) -> Drawn {
        let left = sheet.em(MARGIN);
        let mut y = sheet.em(MARGIN);
        let across = Pos::new(HPos::Left, VPos::Center);
        if !self.title.is_empty() {
            let most = sheet.width() as i32 - 2 * left;
            let title = sheet.fitted(self.title, TITLE_SIZE, most);
            let at = (left, y + sheet.em(0.5 * TITLE - 0.2));
            area.draw(&Text::new(title, at, sheet.font_of(TITLE_SIZE).pos(across)))?;
            y += sheet.em(TITLE);
        }
        for row in self.rows(sheet) {
            let middle = y + sheet.em(0.5 * ROW);
            for (x, mark, name) in row {
                marks::draw(area, (x + sheet.em(0.5 * MARK - 0.2), middle), mark, sheet)?;
                let at = (x + sheet.em(MARK), middle);
                area.draw(&Text::new(name, at, sheet.font().pos(across)))?;
            }
            y += sheet.em(ROW);
        }
        Ok(())
    }
}

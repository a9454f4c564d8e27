//! One table in several notations.

use crate::printable::{markdown, printable};
use std::fmt::Write;

/// The side to which the cells of a column are aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// A table of text cells, with a heading (and its unit) for each column; a heading may have several
/// lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    columns: Vec<(String, Align)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table; headings include their units.
    #[must_use]
    pub fn new(columns: &[(&str, Align)]) -> Self {
        let columns = columns
            .iter()
            .map(|(name, align)| ((*name).to_owned(), *align))
            .collect();
        Self {
            columns,
            rows: Vec::new(),
        }
    }

    /// Adds a row; missing cells stay empty, surplus ones are dropped. A cell has one line and no markup.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let shown = |cell: String| printable(&cell).into_owned();
        let cells = cells.into_iter().take(self.columns.len());
        let mut row: Vec<_> = cells.map(shown).collect();
        row.resize(self.columns.len(), String::new());
        self.rows.push(row);
    }

    /// The heading of each column.
    pub fn headings(&self) -> impl Iterator<Item = &str> {
        self.columns.iter().map(|(name, _)| name.as_str())
    }

    /// Whether the cells of each column are numbers.
    pub fn are_numbers(&self) -> impl Iterator<Item = bool> {
        self.columns.iter().map(|(_, align)| *align == Align::Right)
    }

    /// The cells, row by row.
    pub fn cells(&self) -> impl Iterator<Item = &[String]> {
        self.rows.iter().map(Vec::as_slice)
    }

    /// Aligned columns for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let mut widths = vec![0; self.columns.len()];
        self.heading_text(&mut widths) + &self.rows_text(&mut widths)
    }

    /// The heading alone. `widths` are those of the columns, which grow with the cells, so that a table can be
    /// printed row by row.
    #[must_use]
    pub fn heading_text(&self, widths: &mut [usize]) -> String {
        let cells = self.rows.iter().flat_map(|row| row.iter().enumerate());
        let names = self.columns.iter().enumerate();
        let names = names.flat_map(|(c, (name, _))| name.lines().map(move |line| (c, line)));
        for (c, cell) in cells.map(|(c, cell)| (c, cell.as_str())).chain(names) {
            widths[c] = widths[c].max(cell.chars().count());
        }
        let names = || self.columns.iter().map(|(name, _)| name);
        let height = names().map(|name| name.lines().count()).max().unwrap_or(0);
        let mut text = String::new();
        for above in (0..height.max(1)).rev() {
            // Headings end on the same line.
            let cells = names().map(|name| name.lines().rev().nth(above).unwrap_or(""));
            self.line(&mut text, &cells.collect::<Vec<_>>(), widths);
        }
        text
    }

    /// The rows alone, below a heading of these widths.
    #[must_use]
    pub fn rows_text(&self, widths: &mut [usize]) -> String {
        for row in &self.rows {
            for (width, cell) in widths.iter_mut().zip(row) {
                *width = (*width).max(cell.chars().count());
            }
        }
        let mut text = String::new();
        for row in &self.rows {
            let cells: Vec<&str> = row.iter().map(String::as_str).collect();
            self.line(&mut text, &cells, widths);
        }
        text
    }

    fn line(&self, text: &mut String, cells: &[&str], widths: &[usize]) {
        let mut out = String::new();
        for (c, cell) in cells.iter().enumerate() {
            let pad = " ".repeat(widths[c].saturating_sub(cell.chars().count()));
            let (before, after) = match self.columns[c].1 {
                Align::Left => ("", pad.as_str()),
                Align::Right => (pad.as_str(), ""),
            };
            let between = if c == 0 { "" } else { "  " };
            let _ = write!(out, "{between}{before}{cell}{after}");
        }
        text.push_str(out.trim_end());
        text.push('\n');
    }

    /// GitHub's Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let escape = |cell: &String| markdown(cell).into_owned();
        let heading = |(name, _): &(String, Align)| escape(&name.replace('\n', " "));
        let mut text = line(self.columns.iter().map(heading).collect());
        let rule = |(_, align): &(String, Align)| match align {
            Align::Left => "---".to_owned(),
            Align::Right => "---:".to_owned(),
        };
        text += &line(self.columns.iter().map(rule).collect());
        for row in &self.rows {
            text += &line(row.iter().map(escape).collect());
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new(&[("name", Align::Left), ("h (km)", Align::Right)]);
        table.row(["short".to_owned(), "925".to_owned()]);
        table.row(["a|longer one".to_owned(), "1000.5".to_owned()]);
        table.row(["N̄".to_owned()]);
        table
    }

    #[test]
    fn text_is_aligned() {
        let expected = "name          h (km)\nshort            925\na|longer one  1000.5\nN̄\n";
        assert_eq!(table().to_text(), expected);
    }

    #[test]
    fn a_heading_may_have_several_lines() {
        let mut table = Table::new(&[("design", Align::Left), ("mean\nvisible", Align::Right)]);
        table.row(["a".to_owned(), "7.84".to_owned()]);
        assert_eq!(
            table.to_text(),
            "           mean\ndesign  visible\na          7.84\n"
        );
        assert!(
            table
                .to_markdown()
                .starts_with("| design | mean visible |\n")
        );
    }

    #[test]
    fn markdown_escapes_bars() {
        let text = table().to_markdown();
        assert!(text.starts_with("| name | h (km) |\n| --- | ---: |\n| short | 925 |\n"));
        assert!(text.contains("| a\\|longer one | 1000.5 |"));
    }
}

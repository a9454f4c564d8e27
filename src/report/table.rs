//! One table, several dialects.

use std::fmt::Write;

/// On which side the cells of a column stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
}

/// A table of text cells, with a heading (and its unit) for each column.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    columns: Vec<(String, Align)>,
    rows: Vec<Vec<String>>,
}

impl Table {
    /// An empty table; headings carry their units.
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

    /// Adds a row; missing cells stay empty, surplus ones are dropped.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let mut row: Vec<_> = cells.into_iter().take(self.columns.len()).collect();
        row.resize(self.columns.len(), String::new());
        self.rows.push(row);
    }

    /// Aligned columns for a terminal.
    #[must_use]
    pub fn to_text(&self) -> String {
        let length = |cell: &str| cell.chars().count();
        let widths: Vec<usize> = self
            .columns
            .iter()
            .enumerate()
            .map(|(c, (name, _))| {
                self.rows
                    .iter()
                    .map(|row| length(&row[c]))
                    .fold(length(name), usize::max)
            })
            .collect();
        let mut text = String::new();
        let mut line = |cells: &[&str]| {
            let mut out = String::new();
            for (c, cell) in cells.iter().enumerate() {
                let pad = " ".repeat(widths[c].saturating_sub(length(cell)));
                let (before, after) = match self.columns[c].1 {
                    Align::Left => ("", pad.as_str()),
                    Align::Right => (pad.as_str(), ""),
                };
                let _ = write!(
                    out,
                    "{}{before}{cell}{after}",
                    if c == 0 { "" } else { "  " }
                );
            }
            text.push_str(out.trim_end());
            text.push('\n');
        };
        line(
            &self
                .columns
                .iter()
                .map(|(name, _)| name.as_str())
                .collect::<Vec<_>>(),
        );
        for row in &self.rows {
            line(&row.iter().map(String::as_str).collect::<Vec<_>>());
        }
        text
    }

    /// GitHub's Markdown.
    #[must_use]
    pub fn to_markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let escape = |cell: &String| cell.replace('|', "\\|");
        let mut text = line(self.columns.iter().map(|(name, _)| escape(name)).collect());
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
    fn markdown_escapes_bars() {
        let text = table().to_markdown();
        assert!(text.starts_with("| name | h (km) |\n| --- | ---: |\n| short | 925 |\n"));
        assert!(text.contains("| a\\|longer one | 1000.5 |"));
    }
}

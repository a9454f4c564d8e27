//! Skylines of sites: files that a table of points names, read into its cells.

use super::GroundError;
use super::points::{BYTE_ORDER_MARK, line_of, reader};
use crate::printable::printable;
use crate::visibility::{MaskTable, is_pairs};
use csv::{QuoteStyle, StringRecord, WriterBuilder};
use std::io;

/// The column of a table of points with the skyline of each.
pub(super) const SKYLINE: &str = "skyline";

/// The skyline of a cell.
pub(super) fn skyline(cell: &str) -> Result<MaskTable, String> {
    if !is_pairs(cell) {
        let cell = printable(cell);
        return Err(format!(
            "skyline: found \"{cell}\", expected pairs azimuth:elevation in degrees"
        ));
    }
    MaskTable::from_pairs(cell).map_err(|error| format!("skyline: {error}"))
}

/// A table of points with the skylines that it names by file (column `skyline`) replaced by their pairs
/// `azimuth:elevation`, so that it stands alone; `read` returns the bytes of a file by its path in the table. Lines keep
/// their numbers; `None` if the table names no file.
///
/// # Errors
/// If a file cannot be read or is not a skyline, with the line of the table and that of the file.
pub fn with_inline_skylines(
    table: &[u8],
    read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Option<Vec<u8>>, GroundError> {
    let text = table.strip_prefix(BYTE_ORDER_MARK).unwrap_or(table);
    let mut rows = reader(text);
    let Some(column) = rows.headers().ok().and_then(|header| {
        let mut columns = header.iter();
        columns.position(|name| name == SKYLINE)
    }) else {
        return Ok(None);
    };
    let mut copy = Copied::default();
    if let Ok(header) = rows.headers() {
        copy.add(header, text);
    }
    let mut is_changed = false;
    for row in rows.records() {
        // What is wrong with the table is told when it is read.
        let Ok(row) = row else { return Ok(None) };
        let cell = row.get(column).unwrap_or_default();
        if cell.is_empty() || is_pairs(cell) {
            copy.add(&row, text);
            continue;
        }
        let pairs = from_file(cell, read).map_err(|reason| GroundError::Line {
            line: row.position().map_or(1, |position| line_of(position, text)),
            reason: format!("skyline: {}: {reason}", printable(cell)),
        })?;
        let mut inline = StringRecord::new();
        for (at, field) in row.iter().enumerate() {
            inline.push_field(if at == column { &pairs } else { field });
        }
        inline.set_position(row.position().cloned());
        copy.add(&inline, text);
        is_changed = true;
    }
    Ok(is_changed.then_some(copy.bytes))
}

/// The pairs of a skyline in a file.
fn from_file(path: &str, read: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<String, String> {
    let bytes = read(path).map_err(|error| format!("cannot read it: {error}"))?;
    let skyline = MaskTable::from_csv(&bytes).map_err(|error| error.to_string())?;
    Ok(skyline.to_pairs())
}

/// A table as it is written again.
#[derive(Default)]
struct Copied {
    bytes: Vec<u8>,
    /// Lines written.
    lines: u64,
}

impl Copied {
    /// Adds a row in its line.
    fn add(&mut self, row: &StringRecord, text: &[u8]) {
        let line = row.position().map_or(1, |position| line_of(position, text));
        while self.lines + 1 < line {
            self.bytes.push(b'\n');
            self.lines += 1;
        }
        let begun = self.bytes.len();
        let mut writer = WriterBuilder::new()
            .flexible(true)
            .quote_style(QuoteStyle::Necessary)
            .from_writer(&mut self.bytes);
        // Writing to memory does not fail.
        let _ = writer.write_record(row);
        drop(writer);
        let added = self.bytes[begun..].iter();
        self.lines += added.filter(|byte| **byte == b'\n').count() as u64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;
    use crate::ground::sites_from_csv;

    const WALL: &str = "azimuth_deg,elevation_deg\n0,5\n30,5\n60,20\n90,40\n120,20\n150,5\n180,5\n210,5\n240,5\n270,5\n300,5\n330,5\n";

    fn read(path: &str) -> io::Result<Vec<u8>> {
        match path {
            "wall, east.csv" => Ok(WALL.into()),
            "short.csv" => Ok(WALL[..60].into()),
            _ => Err(io::ErrorKind::NotFound.into()),
        }
    }

    /// The table stands alone, and what is wrong further down keeps its line.
    #[test]
    fn files_become_pairs() {
        let table = "\u{feff}latitude_deg,longitude_deg,skyline,name\n\n1,2,\"wall, east.csv\",\"A, b\"\r\n3,4,,open\n\n5,6,0:1 30:1 60:1 90:1 120:1 150:1 180:1 210:1 240:1 270:1 300:1 330:1,low\n";
        let inline = with_inline_skylines(table.as_bytes(), &read)
            .unwrap()
            .unwrap();
        let sites = sites_from_csv(inline.as_slice(), Surface::Wgs84).unwrap();
        let highest = |n: usize| {
            sites[n]
                .skyline
                .as_ref()
                .map(|skyline| skyline.highest_deg())
        };
        assert_eq!([0, 1, 2].map(highest), [Some(40.0), None, Some(1.0)]);
        assert_eq!(sites[0].name.as_deref(), Some("A, b"));
        let again = with_inline_skylines(&inline, &read);
        assert_eq!(again, Ok(None), "a table without paths is as it was");

        let wrong = format!("{table}\n95,0,,\n");
        let inline = with_inline_skylines(wrong.as_bytes(), &read)
            .unwrap()
            .unwrap();
        for text in [wrong.replace("\"wall, east.csv\"", "").as_bytes(), &inline] {
            let error = sites_from_csv(text, Surface::Wgs84)
                .unwrap_err()
                .to_string();
            assert!(error.starts_with("line 8: latitude 95"), "{error}");
        }
    }

    #[test]
    fn files_that_are_no_skyline_are_told() {
        let error = |cell: &str| {
            let table = format!("latitude_deg,longitude_deg,skyline\n1,2,\n3,4,{cell}\n");
            let inline = with_inline_skylines(table.as_bytes(), &read);
            match inline {
                Err(error) => error.to_string(),
                Ok(inline) => {
                    let table = inline.unwrap_or(table.into_bytes());
                    sites_from_csv(table.as_slice(), Surface::Wgs84)
                        .unwrap_err()
                        .to_string()
                }
            }
        };
        assert_eq!(
            error("short.csv"),
            "line 3: skyline: short.csv: there is a gap from azimuth 120 to 0 degrees; azimuths are at most 30 degrees apart, all around"
        );
        assert_eq!(
            error("none.csv"),
            "line 3: skyline: none.csv: cannot read it: entity not found"
        );
        assert_eq!(
            error("0:1 20:3"),
            "line 3: skyline: there is a gap from azimuth 20 to 0 degrees; azimuths are at most 30 degrees apart, all around"
        );
        let unread = sites_from_csv(
            "latitude_deg,longitude_deg,skyline\n1,2,a.csv\n".as_bytes(),
            Surface::Wgs84,
        );
        assert_eq!(
            unread.unwrap_err().to_string(),
            "line 2: skyline: found \"a.csv\", expected pairs azimuth:elevation in degrees"
        );
    }
}

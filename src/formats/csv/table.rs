//! Rows of a table, each of bounded length.

use crate::formats::text::finding::FindingList;
use std::io::{self, BufRead, Read};

/// Longest row, in bytes, line feeds within quotes included; the reader's buffer is extra.
const MAX_ROW: usize = 1 << 16;

/// Refuses to give more bytes for one row than it may have, and ends every line with a line feed,
/// so that lines are counted as in every other format.
struct Bounded<R> {
    input: R,
    since_row: usize,
    after_carriage_return: bool,
}

impl<R> Bounded<R> {
    /// Turns CR and CR LF into LF; returns how many bytes are left.
    fn unify_line_ends(&mut self, bytes: &mut [u8]) -> usize {
        let mut kept = 0;
        for at in 0..bytes.len() {
            let byte = bytes[at];
            let is_second = std::mem::replace(&mut self.after_carriage_return, byte == b'\r');
            if !(is_second && byte == b'\n') {
                bytes[kept] = if byte == b'\r' { b'\n' } else { byte };
                kept += 1;
            }
        }
        kept
    }
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.since_row > MAX_ROW {
            return Err(io::ErrorKind::InvalidData.into());
        }
        loop {
            let count = self.input.read(buffer)?;
            let kept = self.unify_line_ends(&mut buffer[..count]);
            self.since_row += kept;
            // Nothing left of something read is not an end of the input.
            if kept > 0 || count == 0 {
                return Ok(kept);
            }
        }
    }
}

/// A table whose first row is the header; blanks around fields do not matter.
pub(in crate::formats) struct CsvTable<R> {
    rows: ::csv::Reader<Bounded<R>>,
}

impl<R: BufRead> CsvTable<R> {
    pub(in crate::formats) fn new(input: R) -> Self {
        let bounded = Bounded {
            input,
            since_row: 0,
            after_carriage_return: false,
        };
        Self {
            rows: ::csv::ReaderBuilder::new()
                .trim(::csv::Trim::All)
                .from_reader(bounded),
        }
    }

    /// The names of the columns, without a byte order mark; none after a finding.
    pub(in crate::formats) fn header(
        &mut self,
        findings: &mut FindingList,
    ) -> io::Result<Option<::csv::StringRecord>> {
        match self.rows.headers() {
            Ok(header) => Ok(Some(
                header
                    .iter()
                    .map(|name| name.trim_start_matches('\u{feff}'))
                    .collect(),
            )),
            Err(error) => self.report(error, findings).map(|()| None),
        }
    }

    /// The next row and the line on which it begins; none at the end, or after a finding.
    pub(in crate::formats) fn next(
        &mut self,
        row: &mut ::csv::StringRecord,
        findings: &mut FindingList,
    ) -> io::Result<Option<usize>> {
        self.rows.get_mut().since_row = 0;
        match self.rows.read_record(row) {
            Ok(true) => Ok(Some(row.position().map_or(1, |at| at.line() as usize))),
            Ok(false) => Ok(None),
            Err(error) => self.report(error, findings).map(|()| None),
        }
    }

    /// Turns a row that cannot be read into a finding.
    fn report(&self, error: ::csv::Error, findings: &mut FindingList) -> io::Result<()> {
        let at = error.position().unwrap_or(self.rows.position());
        let place = (at.line() as usize, 1);
        match error.into_kind() {
            ::csv::ErrorKind::Io(error) if error.kind() == io::ErrorKind::InvalidData => {
                let message = format!("the row is longer than {MAX_ROW} bytes");
                findings.error(place, "csv-row-length", message);
            }
            ::csv::ErrorKind::Io(error) => return Err(error),
            ::csv::ErrorKind::UnequalLengths {
                expected_len, len, ..
            } => {
                let message = format!("the row has {len} fields; the header has {expected_len}");
                findings.error(place, "csv-fields", message);
            }
            ::csv::ErrorKind::Utf8 { .. } => {
                findings.error(place, "character", "the row is not UTF-8");
            }
            other => findings.error(place, "csv-syntax", format!("{other:?}")),
        }
        Ok(())
    }
}

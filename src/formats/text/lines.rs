//! Lines of a text file, with checks of their length and encoding.

use crate::formats::text::finding::FindingList;
use std::io::{self, BufRead};

/// Maximum length of a line, in bytes; no supported format allows more than 254.
const MAX_LINE: usize = 4096;

/// Maximum number of comments kept of a header or section: nothing is computed from them, and a file may have any number.
const MOST_COMMENTS: usize = 10_000;

/// Keeps a comment, unless there are very many already.
pub(crate) fn keep_comment(kept: &mut Vec<String>, text: &str) {
    if kept.len() < MOST_COMMENTS {
        kept.push(text.to_owned());
    }
}

const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";

/// A line without its terminator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Line {
    /// Number, from 1.
    pub(crate) number: usize,
    /// Text: printable ASCII, except in comments and names.
    pub(crate) text: String,
}

/// Reads lines that end in LF, CR or CR LF.
pub(crate) struct Lines<R> {
    input: R,
    number: usize,
    after_carriage_return: bool,
    /// Whether tabs count as spaces; CCSDS messages and TLE have none.
    takes_tabs: bool,
    /// Whether a line is a comment or a name, which may contain any characters.
    is_comment: fn(&[u8]) -> bool,
}

/// The outcome of reading the bytes of a line.
enum Taken {
    Nothing,
    Line,
    TooLong,
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(input: R) -> Self {
        Self {
            input,
            number: 0,
            after_carriage_return: false,
            takes_tabs: false,
            is_comment: |_| false,
        }
    }

    /// Allows more than printable ASCII in the lines for which `is_comment` is true, given their bytes: comments
    /// and names.
    pub(crate) fn with_comments(self, is_comment: fn(&[u8]) -> bool) -> Self {
        Self { is_comment, ..self }
    }

    /// Reads a format whose words may also be separated by tabs.
    pub(crate) fn with_tabs(input: R) -> Self {
        Self {
            takes_tabs: true,
            ..Self::new(input)
        }
    }

    /// Number of the last line that was read.
    pub(crate) fn number(&self) -> usize {
        self.number
    }

    /// The next line of text; lines that are skipped are reported in `findings`.
    pub(crate) fn next(&mut self, findings: &mut FindingList) -> io::Result<Option<Line>> {
        while !findings.is_full() {
            let mut bytes = Vec::new();
            let taken = self.take_bytes(&mut bytes)?;
            if matches!(taken, Taken::Nothing) {
                return Ok(None);
            }
            self.number += 1;
            if matches!(taken, Taken::TooLong) {
                let message = format!("the line is longer than {MAX_LINE} bytes");
                let place = (self.number, MAX_LINE + 1);
                if !(self.is_comment)(&bytes) {
                    findings.error(place, "line-length", message);
                    continue;
                }
                findings.warning(place, "line-length", message);
            }
            if self.number == 1 && bytes.starts_with(BYTE_ORDER_MARK) {
                bytes.drain(..BYTE_ORDER_MARK.len());
            }
            self.replace_tabs(&mut bytes, findings);
            match bytes.iter().position(|byte| !is_text(*byte)) {
                None => return Ok(Some(self.line(&bytes))),
                Some(at) => {
                    let message = format!("byte 0x{:02X} is not printable ASCII", bytes[at]);
                    let place = (self.number, at + 1);
                    let has_control = bytes.iter().any(|b| b.is_ascii_control());
                    if (self.is_comment)(&bytes) && !has_control {
                        findings.warning(place, "character", message);
                        return Ok(Some(self.line(&bytes)));
                    }
                    findings.error(place, "character", message);
                }
            }
        }
        Ok(None)
    }

    fn line(&self, bytes: &[u8]) -> Line {
        Line {
            number: self.number,
            text: String::from_utf8_lossy(bytes).into_owned(),
        }
    }

    fn replace_tabs(&self, bytes: &mut [u8], findings: &mut FindingList) {
        for (at, byte) in bytes.iter_mut().enumerate() {
            if *byte == b'\t' {
                *byte = b' ';
                if !self.takes_tabs {
                    let message = "expected a space, found a tab";
                    findings.warning((self.number, at + 1), "tab", message);
                }
            }
        }
    }

    /// Consumes the input up to the end of the line, and keeps its first [`MAX_LINE`] bytes.
    fn take_bytes(&mut self, kept: &mut Vec<u8>) -> io::Result<Taken> {
        let mut any = false;
        let mut too_long = false;
        loop {
            let available = match self.input.fill_buf() {
                Ok(available) => available,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
                Err(error) => return Err(error),
            };
            if available.is_empty() {
                return Ok(Self::taken(any, too_long));
            }
            if std::mem::take(&mut self.after_carriage_return) && available[0] == b'\n' {
                self.input.consume(1);
                continue;
            }
            any = true;
            let end = available.iter().position(|b| matches!(b, b'\n' | b'\r'));
            let length = end.unwrap_or(available.len());
            let room = MAX_LINE - kept.len();
            too_long |= length > room;
            kept.extend_from_slice(&available[..length.min(room)]);
            self.after_carriage_return = end.is_some_and(|at| available[at] == b'\r');
            self.input.consume(end.map_or(length, |at| at + 1));
            if end.is_some() {
                return Ok(Self::taken(any, too_long));
            }
        }
    }

    fn taken(any: bool, too_long: bool) -> Taken {
        match (any, too_long) {
            (false, _) => Taken::Nothing,
            (true, false) => Taken::Line,
            (true, true) => Taken::TooLong,
        }
    }
}

fn is_text(byte: u8) -> bool {
    (b' '..=b'~').contains(&byte)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::formats::text::finding::Severity;

    fn lines(
        bytes: &[u8],
    ) -> (
        Vec<(usize, String)>,
        Vec<crate::formats::text::finding::Finding>,
    ) {
        let mut findings = FindingList::of_linter(10);
        let mut reader = Lines::new(bytes);
        let mut found = Vec::new();
        while let Some(line) = reader.next(&mut findings).unwrap() {
            found.push((line.number, line.text));
        }
        (found, findings.into_vec())
    }

    #[test]
    fn every_line_end_counts_once() {
        let (found, findings) = lines(b"\xef\xbb\xbfa\r\nb\rc\n\nd");
        let expected = [(1, "a"), (2, "b"), (3, "c"), (4, ""), (5, "d")];
        assert_eq!(
            found,
            expected.map(|(number, text)| (number, text.to_owned()))
        );
        assert!(findings.is_empty());
        assert!(lines(b"").0.is_empty());
    }

    #[test]
    fn bytes_that_are_no_text_are_reported() {
        let (found, findings) = lines(b"ok\na\tb\n\xff\xfe\na\0\nlast");
        let texts: Vec<_> = found.iter().map(|(_, text)| text.as_str()).collect();
        assert_eq!(texts, ["ok", "a b", "last"]);
        let places: Vec<_> = findings.iter().map(|f| (f.line, f.column)).collect();
        assert_eq!(places, [(2, 2), (3, 1), (4, 2)]);
        assert_eq!(findings[0].rule, "tab");
        assert_eq!(findings[0].severity, Severity::Warning);
    }

    #[test]
    fn comments_may_hold_any_text() {
        let bytes = "COMMENT \u{d6}BB\nX = \u{d6}\n".as_bytes();
        let latin_1 = b"COMMENT \xd6BB\nCOMMENT \0\n";
        let bytes = [bytes, latin_1].concat();
        let mut findings = FindingList::of_linter(10);
        let mut reader = Lines::new(&bytes[..]).with_comments(|line| line.starts_with(b"COMMENT"));
        let mut texts = Vec::new();
        while let Some(line) = reader.next(&mut findings).unwrap() {
            texts.push(line.text);
        }
        assert_eq!(texts, ["COMMENT \u{d6}BB", "COMMENT \u{fffd}BB"]);
        let found: Vec<_> = findings
            .into_vec()
            .iter()
            .map(|f| (f.line, f.severity))
            .collect();
        let (warning, error) = (Severity::Warning, Severity::Error);
        assert_eq!(found, [(1, warning), (2, error), (3, warning), (4, error)]);
    }

    #[test]
    fn a_long_line_is_passed_over_without_being_kept() {
        let mut bytes = vec![b'x'; 3 * MAX_LINE];
        bytes.extend_from_slice(b"\nnext\n");
        let (found, findings) = lines(&bytes);
        assert_eq!(found, [(2, "next".to_owned())]);
        assert_eq!(findings[0].rule, "line-length");
    }
}

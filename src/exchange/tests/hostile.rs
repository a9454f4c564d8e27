//! Every reader with every kind of bad input: no panic, always a position, bounded memory.

use super::samples;
use crate::exchange::import::Fleet;
use crate::exchange::lint::{Format, lint};
use crate::formats::ccsds::omm::{self, OmmSyntax};
use crate::formats::ccsds::{oem, opm};
use crate::formats::text::finding::{Finding, Severity};
use crate::formats::{sp3, stk};
use crate::keyword::Keyword;
use std::io::{self, BufRead, Read};

/// The linter's findings, all positioned in the file or on its next line; the reader rejects a file
/// with an error.
fn findings(format: Format, bytes: &[u8]) -> Vec<Finding> {
    let report = lint(bytes, Some(format), None, 1000).unwrap();
    let lines = 1 + bytes.iter().filter(|b| matches!(b, b'\n' | b'\r')).count();
    for finding in &report.findings {
        let inside = (1..=lines + 1).contains(&finding.line) && finding.column > 0;
        assert!(inside, "{format}: {finding} in {lines} lines");
        assert!(!finding.rule.is_empty() && !finding.message.is_empty());
    }
    let mut errors = report.findings.iter();
    let first = errors.find(|finding| finding.severity == Severity::Error);
    if let Some(first) = first {
        let refused = Fleet::read(bytes, Some(format), None);
        let refused = refused.map(|_| ()).unwrap_err().to_string();
        // A reader stops at its first error; a linter may find an earlier line wrong later on.
        assert!(refused.starts_with("line "), "{format}: {first}; {refused}");
    }
    if report.findings.is_empty() {
        let read = Fleet::read(bytes, Some(format), None);
        assert!(
            read.is_ok(),
            "{format}: refused, and lint finds nothing: {read:?}"
        );
    }
    report.findings
}

fn has_error(found: &[Finding]) -> bool {
    found
        .iter()
        .any(|finding| finding.severity == Severity::Error)
}

#[test]
fn what_is_no_text_is_refused_by_all() {
    let bytes: Vec<u8> = (0..=255).collect();
    for format in Format::ALL {
        for bad in [
            &b""[..],
            b"\n\n\n",
            &bytes,
            &[0; 5000],
            b"\xef\xbb\xbf",
            b"\xff\xfe<\0",
        ] {
            assert!(has_error(&findings(*format, bad)), "{format}: {bad:?}");
        }
    }
}

/// A truncated file is rejected or has a warning, unless the rest is a complete file.
#[test]
fn files_cut_at_any_byte_are_told() {
    for (format, text) in samples() {
        assert_eq!(findings(format, text.as_bytes()), [], "{format}");
        let mut silent = Vec::new();
        for at in 0..text.trim_end().len() {
            if findings(format, &text.as_bytes()[..at]).is_empty() {
                silent.push(at);
            }
        }
        for at in silent {
            let rest = &text[at..];
            let ends_a_row = rest.starts_with('\n') || text[..at].ends_with('\n');
            let whole = match format {
                // Sets and rows are independent, and the last number of a row may lose digits.
                Format::Tle => ends_a_row,
                Format::OmmCsv | Format::ElementsCsv | Format::StatesCsv => !rest.contains("\n\n"),
                // What follows the state and the elements may be omitted.
                Format::Opm => text[..at].contains("\nZ_DOT = "),
                Format::Omm => text[..at].contains("MEAN_ANOMALY"),
                // Numbers at the end may lose digits, and a block of an almanac is complete by itself.
                Format::Yuma => {
                    let last = text[..at].lines().last().unwrap_or_default();
                    ends_a_row || last.starts_with("week: ") || last.starts_with('*')
                }
                Format::Sem => {
                    text[..at].trim_end().lines().count() == text.trim_end().lines().count()
                }
                // The last number of the last line may lose digits.
                Format::Oem => text[..at].lines().count() == text.lines().count(),
                _ => false,
            };
            assert!(
                whole,
                "{format} cut before {:?}",
                &rest[..rest.len().min(30)]
            );
        }
    }
}

/// Yields a beginning and then one byte endlessly, in blocks.
struct Endless {
    beginning: Vec<u8>,
    block: Vec<u8>,
    at: usize,
    given: usize,
    most: usize,
}

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let available = self.fill_buf()?;
        let count = available.len().min(buffer.len());
        buffer[..count].copy_from_slice(&available[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Endless {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at < self.beginning.len() {
            return Ok(&self.beginning[self.at..]);
        }
        let left = self.most.saturating_sub(self.given);
        Ok(&self.block[..self.block.len().min(left)])
    }

    fn consume(&mut self, count: usize) {
        if self.at < self.beginning.len() {
            self.at += count;
        } else {
            self.given += count;
        }
    }
}

/// One line of 64 MB after the first line of a file, or in place of it.
#[test]
fn a_line_of_64_mb_is_refused() {
    for (format, text) in samples() {
        let first = text.lines().next().unwrap().as_bytes();
        for (beginning, byte) in [(first, b'x'), (b"", b'x'), (b"", b' '), (b"\"", b',')] {
            let input = Endless {
                beginning: beginning.to_vec(),
                block: vec![byte; 1 << 16],
                at: 0,
                given: 0,
                most: 64 << 20,
            };
            let report = lint(input, Some(format), None, 100).unwrap();
            assert!(has_error(&report.findings), "{format}");
        }
    }
}

/// Any number of comments is read, and a bounded number of them kept: a compressed file may hold very many.
#[test]
fn comments_do_not_fill_memory() {
    const MANY: usize = 30_000;
    let mut tried = 0;
    for (format, text) in samples() {
        let (before, comment) = match format {
            Format::Oem | Format::Omm | Format::Opm => ("CREATION_DATE", "COMMENT more\n"),
            Format::OemXml | Format::OmmXml | Format::OpmXml => {
                ("<CREATION_DATE", "<COMMENT>more</COMMENT>\n")
            }
            // Names are in the first comments.
            Format::Sp3 => ("*  2025", "/* more\n"),
            Format::Stk => ("BEGIN Ephemeris", "# more\n"),
            _ => continue,
        };
        tried += 1;
        let at = text.find(before).unwrap();
        let long = format!("{}{}{}", &text[..at], comment.repeat(MANY), &text[at..]);
        let expected = Fleet::read(text.as_bytes(), Some(format), None).unwrap();
        let found = Fleet::read(long.as_bytes(), Some(format), None).unwrap();
        assert_eq!(found, expected, "{format}");
        let kept = match format {
            Format::Oem => oem::read(long.as_bytes()).unwrap().header.comments,
            Format::OemXml => {
                oem::read_xml(long.as_bytes())
                    .unwrap()
                    .remove(0)
                    .header
                    .comments
            }
            Format::Opm => opm::read(long.as_bytes()).unwrap().header.comments,
            Format::OpmXml => {
                opm::read_xml(long.as_bytes())
                    .unwrap()
                    .remove(0)
                    .header
                    .comments
            }
            Format::Sp3 => sp3::read(long.as_bytes()).unwrap().comments,
            Format::Stk => stk::read(long.as_bytes()).unwrap().comments,
            _ => {
                let notation = match format {
                    Format::OmmXml => OmmSyntax::Xml,
                    _ => OmmSyntax::Kvn,
                };
                let mut messages = omm::read(long.as_bytes(), notation).unwrap();
                messages.remove(0).header.unwrap().comments
            }
        };
        assert!(
            (1000..MANY / 2).contains(&kept.len()),
            "{format}: {}",
            kept.len()
        );
    }
    assert_eq!(tried, 8);
}

/// The text with the first `from` after `after` replaced by `to`.
fn replaced(text: &str, after: &str, from: &str, to: &str) -> String {
    let at = text.find(after).unwrap() + after.len();
    let at = at + text[at..].find(from).unwrap();
    format!("{}{to}{}", &text[..at], &text[at + from.len()..])
}

/// The first number of a state or set: the text before it, and its first digits.
fn first_number(format: Format) -> (&'static str, &'static str) {
    match format {
        Format::Tle => ("\n2 90001 ", "55"),
        Format::Oem => ("META_STOP\n\n2025-01-01T00:00:00.000 ", "6"),
        Format::OemXml | Format::OpmXml => ("<X>", "6"),
        Format::Omm => ("INCLINATION = ", "55"),
        Format::OmmXml => ("<INCLINATION>", "55"),
        Format::OmmJson => ("\"INCLINATION\":", "55"),
        Format::OmmCsv => ("2025-01-01T00:00:00.000,", "13"),
        Format::Opm => ("\nX = ", "6"),
        Format::Sp3 => ("\nPL01    ", "852"),
        Format::Stk => ("\n0 ", "6"),
        Format::ElementsCsv => ("2025-01-01T00:00:00.000,", "7"),
        Format::Czml => ("\"cartesian\":[-", "0"),
        Format::StatesCsv => (",0,", "6"),
        Format::Yuma => ("Orbital Inclination(rad):   ", "0"),
        Format::Sem => ("\n 299 ", "258048"),
    }
}

#[test]
fn numbers_that_are_none_are_refused_with_their_place() {
    for (format, text) in samples() {
        let (after, digits) = first_number(format);
        let at = text.find(after).unwrap() + after.len();
        let line = 1 + text[..at].matches('\n').count();
        for bad in ["NaN", "inf", "-Infinity", "1e999", "0x10", "1_0", "1,0"] {
            let damaged = replaced(&text, after, digits, bad);
            let found = findings(format, damaged.as_bytes());
            let mut errors = found.iter().filter(|f| f.severity == Severity::Error);
            let told = errors.any(|finding| finding.line == line);
            assert!(told, "{format} {bad}: {found:?}, expected line {line}");
        }
    }
}

#[test]
fn instants_that_come_twice_are_told() {
    for (format, text) in samples() {
        let (from, to, rule) = match format {
            Format::Oem | Format::Stk => (
                "\n2025-01-01T00:01:30.000 ",
                "\n2025-01-01T00:00:00.000 ",
                "oem-time-order",
            ),
            Format::OemXml => (
                "<EPOCH>2025-01-01T00:01:30.000<",
                "<EPOCH>2025-01-01T00:00:00.000<",
                "oem-time-order",
            ),
            Format::Sp3 => (
                "\n*  2025  1  1  0  1 48.0",
                "\n*  2025  1  1  0  0 18.0",
                "sp3-time-order",
            ),
            Format::StatesCsv => (
                "\nNW-P01-S01,2025-01-01T00:01:30.000",
                "\nNW-P01-S01,2025-01-01T00:00:00.000",
                "csv-time-order",
            ),
            _ => continue,
        };
        let (from, to, rule) = match format {
            Format::Stk => ("\n90 ", "\n0 ", "stk-time-order"),
            _ => (from, to, rule),
        };
        let damaged = text.replacen(from, to, 1);
        assert_ne!(damaged, text, "{format}");
        let found = findings(format, damaged.as_bytes());
        assert!(
            found.iter().any(|finding| finding.rule == rule),
            "{format}: {found:?}"
        );
    }
    let (_, tle) = samples()
        .into_iter()
        .find(|(format, _)| *format == Format::Tle)
        .unwrap();
    assert_eq!(
        findings(Format::Tle, tle.repeat(2).as_bytes())[0].rule,
        "tle-repeated"
    );
}

/// Line ends of other systems, a leading byte order mark and trailing blank lines change nothing.
#[test]
fn harmless_differences_are_taken() {
    for (format, text) in samples() {
        let expected = Fleet::read(text.as_bytes(), Some(format), None).unwrap();
        for other in [
            text.replace('\n', "\r\n"),
            format!("\u{feff}{text}"),
            format!("\u{feff}{}\r\n\r\n", text.replace('\n', "\r\n")),
            text.trim_end().to_owned(),
        ] {
            assert_eq!(findings(format, other.as_bytes()), [], "{format}");
            let found = Fleet::read(other.as_bytes(), None, None).unwrap();
            assert_eq!(found, expected, "{format}");
        }
    }
}

/// A tab is not allowed in CCSDS and TLE, where it is reported and read as a blank; STK and XML allow it.
#[test]
fn tabs_are_read_as_blanks() {
    for (format, text) in samples() {
        let other = match format {
            Format::Tle => text.replacen("1 9", "1\t9", 1),
            Format::Oem | Format::Omm | Format::Opm => text.replace(" = ", "\t=\t"),
            Format::OemXml | Format::OmmXml | Format::OpmXml => text.replace("\n<", "\n\t<"),
            Format::OmmJson | Format::Czml => text.replace("\n{", "\n\t{"),
            Format::Stk => text.replace(" J2000", "\t\t J2000"),
            Format::Yuma => text.replace(": ", ":\t"),
            Format::Sem => text.replace(" 5.", "\t5."),
            Format::Sp3 | Format::OmmCsv | Format::ElementsCsv | Format::StatesCsv => continue,
        };
        assert_ne!(text, other, "{format}");
        let found = findings(format, other.as_bytes());
        let expected = Fleet::read(text.as_bytes(), Some(format), None).unwrap();
        assert_eq!(
            Fleet::read(other.as_bytes(), Some(format), None).unwrap(),
            expected,
            "{format}"
        );
        let is_told = matches!(
            format,
            Format::Tle | Format::Oem | Format::Omm | Format::Opm
        );
        assert_eq!(!found.is_empty(), is_told, "{format}: {found:?}");
        assert!(
            found.iter().all(|finding| finding.rule == "tab"),
            "{format}: {found:?}"
        );
    }
}

/// CCSDS keywords are capitals: others are accepted, or rejected with their position.
#[test]
fn keywords_in_another_case_are_read_or_named() {
    for (format, text) in samples() {
        let other = text
            .replace("MEAN", "Mean")
            .replace("REF_FRAME", "Ref_Frame")
            .replace("BEGIN", "Begin")
            .replace("object", "Object");
        if other == text {
            continue;
        }
        let found = findings(format, other.as_bytes());
        match Fleet::read(other.as_bytes(), Some(format), None) {
            Ok(read) => assert_eq!(
                read,
                Fleet::read(text.as_bytes(), Some(format), None).unwrap(),
                "{format}"
            ),
            Err(error) => assert!(
                error.to_string().starts_with("line "),
                "{format}: {error}, {found:?}"
            ),
        }
    }
}

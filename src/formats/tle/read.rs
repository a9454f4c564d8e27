//! Reads element sets strictly: every column has to hold what the format says.

use super::{EPOCH_STEP_NS, LINE, NAME, checksum, since_midnight_ns};
use crate::formats::ReadError;
use crate::formats::metadata::CatalogNumber;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::{Line, Lines};
use chrono::{Datelike, NaiveDate, TimeDelta};
use std::io::{self, BufRead};

/// An element set and the line that it starts on.
#[derive(Debug, Clone, PartialEq)]
pub struct TleRecord {
    /// The element set.
    pub set: sgp4::Elements,
    /// Number of its first element line.
    pub line: usize,
}

/// Reads all element sets; the first broken rule ends it.
///
/// # Errors
/// The first finding, or a failure of the input.
pub fn read(input: impl BufRead) -> Result<Vec<sgp4::Elements>, ReadError> {
    let mut findings = FindingList::of_reader();
    let mut sets = Vec::new();
    parse(input, &mut findings, |record| sets.push(record.set))?;
    findings.unless_error(sets)
}

/// Passes every valid element set to `take`, until the list of findings is full.
///
/// # Errors
/// A failure of the input.
pub fn parse(
    input: impl BufRead,
    findings: &mut FindingList,
    mut take: impl FnMut(TleRecord),
) -> io::Result<()> {
    let mut lines = Lines::new(input).with_comments(is_name);
    let mut name: Option<Line> = None;
    let mut first: Option<Line> = None;
    let mut any = false;
    while let Some(line) = lines.next(findings)? {
        let text = line.text.trim_end();
        if text.is_empty() {
            continue;
        }
        any = true;
        match Role::of(text) {
            Role::Name => {
                report_unpaired(first.take(), findings);
                if let Some(lonely) = name.replace(line) {
                    missing_lines(&lonely, findings);
                }
            }
            Role::First => {
                report_unpaired(first.replace(line), findings);
            }
            Role::Second => match first.take() {
                Some(first) => {
                    let title = name.take();
                    if let Some(record) = record(title, &first, &line, findings) {
                        take(record);
                    }
                }
                None => {
                    let place = (line.number, 1);
                    findings.error(place, "tle-pair", "line 2 without a line 1 before it");
                }
            },
        }
    }
    report_unpaired(first, findings);
    if let Some(lonely) = name {
        missing_lines(&lonely, findings);
    } else if !any {
        findings.error(
            (lines.number().max(1), 1),
            "tle-empty",
            "the file has no element sets",
        );
    }
    Ok(())
}

/// Whether bytes are not of an element line, but of a name, which may hold any text.
fn is_name(line: &[u8]) -> bool {
    !line.starts_with(b"1 ") && !line.starts_with(b"2 ")
}

/// What a line is, by its beginning and its length.
enum Role {
    Name,
    First,
    Second,
}

impl Role {
    fn of(text: &str) -> Self {
        match text.as_bytes() {
            // A name may begin with a number too, but it is short.
            [b'1', b' ', ..] if text.len() > NAME => Self::First,
            [b'2', b' ', ..] if text.len() > NAME => Self::Second,
            _ => Self::Name,
        }
    }
}

fn report_unpaired(first: Option<Line>, findings: &mut FindingList) {
    if let Some(line) = first {
        findings.error(
            (line.number, 1),
            "tle-pair",
            "line 1 without a line 2 after it",
        );
    }
}

fn missing_lines(name: &Line, findings: &mut FindingList) {
    let message = "expected line 1 or 2 of an element set, or a name before line 1";
    findings.error((name.number, 1), "tle-line", message);
}

/// Columns of line 1, from the first; see [`column_fits`].
const FIRST: &[u8; LINE] = b"1 A____U _____LLL ##__#.######## +.######## +#####-# +#####-# # ___##";

/// Columns of line 2.
const SECOND: &[u8; LINE] =
    b"2 A____ __#.#### __#.#### ####### __#.#### __#.#### _#.########____##";

/// Whether a byte is allowed in a column, and what is allowed there.
fn column_fits(class: u8, byte: u8) -> Result<(), &'static str> {
    let (fits, expected) = match class {
        b'#' => (byte.is_ascii_digit(), "a digit"),
        b'_' => (byte.is_ascii_digit() || byte == b' ', "a digit or a blank"),
        b'A' => (
            byte == b' ' || byte.is_ascii_digit() || is_alpha5(byte),
            "a digit, a blank or an Alpha-5 letter",
        ),
        b'L' => (
            byte.is_ascii_uppercase() || byte == b' ',
            "a capital letter or a blank",
        ),
        b'U' => (matches!(byte, b'U' | b'C' | b'S'), "U, C or S"),
        b'+' => (matches!(byte, b' ' | b'+' | b'-'), "a blank, + or -"),
        b'-' => (matches!(byte, b'+' | b'-'), "+ or -"),
        b' ' => (byte == b' ', "a blank"),
        b'.' => (byte == b'.', "a decimal point"),
        _ => (byte == class, "the line number"),
    };
    if fits { Ok(()) } else { Err(expected) }
}

fn is_alpha5(byte: u8) -> bool {
    byte.is_ascii_uppercase() && !matches!(byte, b'I' | b'O')
}

/// Checks length, columns and checksum of a line.
fn line_fits(line: &Line, columns: &[u8; LINE], findings: &mut FindingList) -> bool {
    let text = line.text.trim_end().as_bytes();
    if text.len() != LINE {
        let message = format!("the line has {} columns; it needs {LINE}", text.len());
        let column = text.len().min(LINE) + 1;
        findings.error((line.number, column), "tle-length", message);
        return false;
    }
    for (at, (class, byte)) in columns.iter().zip(text).enumerate() {
        if let Err(expected) = column_fits(*class, *byte) {
            let message = format!("expected {expected}, found '{}'", char::from(*byte));
            findings.error((line.number, at + 1), "tle-column", message);
            return false;
        }
    }
    let sum = checksum(&text[..LINE - 1]);
    if u32::from(text[LINE - 1] - b'0') != sum {
        let message = format!(
            "the checksum is {}, but the line sums to {sum}",
            char::from(text[LINE - 1])
        );
        findings.error((line.number, LINE), "tle-checksum", message);
        return false;
    }
    true
}

/// The element set of two valid lines.
fn record(
    name: Option<Line>,
    first: &Line,
    second: &Line,
    findings: &mut FindingList,
) -> Option<TleRecord> {
    // Both lines are checked before giving up, so that a linter reports the problems of each.
    let first_fits = line_fits(first, FIRST, findings);
    let second_fits = line_fits(second, SECOND, findings);
    if !(first_fits && second_fits) {
        return None;
    }
    let (one, two) = (first.text.trim_end(), second.text.trim_end());
    if one[2..7] != two[2..7] {
        let message = format!(
            "catalogue numbers '{}' and '{}' differ",
            &one[2..7],
            &two[2..7]
        );
        findings.error((second.number, 3), "tle-catalogue-number", message);
        return None;
    }
    if let Err(error) = one[2..7].parse::<CatalogNumber>() {
        findings.error((first.number, 3), "tle-catalogue-number", error.to_string());
        return None;
    }
    let name = name.map(|line| checked_name(&line, findings));
    if !is_for_sgp4(first, findings) || !ranges_fit(first, second, findings) {
        return None;
    }
    match set_of_lines(name, [one, two]) {
        Ok(mut set) => {
            let line = first.number;
            if !is_designator(&one[9..17]) {
                let message = format!("'{}' is not a year, launch and piece", &one[9..17]);
                findings.warning((line, 10), "tle-designator", message);
                set.international_designator = None;
            }
            Some(TleRecord { set, line })
        }
        Err(error) => {
            findings.error((first.number, 1), "tle-field", error.to_string());
            None
        }
    }
}

/// The element set of two lines whose columns have been checked.
pub(super) fn set_of_lines(
    name: Option<String>,
    [one, two]: [&str; 2],
) -> Result<sgp4::Elements, sgp4::TleError> {
    let mut set = sgp4::Elements::from_tle(name, one.as_bytes(), two.as_bytes())?;
    // Decimal days in doubles are some nanoseconds off the step that is written.
    set.datetime = snapped(set.datetime);
    for angle in [
        &mut set.right_ascension,
        &mut set.argument_of_perigee,
        &mut set.mean_anomaly,
    ] {
        *angle %= 360.0;
    }
    Ok(set)
}

/// Whether columns hold the year, the launch and the piece, as `98067A  `, or are left blank.
fn is_designator(columns: &str) -> bool {
    let (launch, piece) = columns.split_at(5);
    let piece = piece.trim_end();
    let is_named = launch.bytes().all(|byte| byte.is_ascii_digit())
        && !piece.is_empty()
        && piece.bytes().all(|byte| byte.is_ascii_uppercase());
    is_named || columns.trim().is_empty()
}

/// The name, which catalogues give with any number of characters.
fn checked_name(line: &Line, findings: &mut FindingList) -> String {
    let text = line.text.trim();
    let name = text.strip_prefix("0 ").unwrap_or(text).trim_start();
    let length = name.chars().count();
    if length > NAME {
        let message = format!("the name has {length} characters; the limit is {NAME}");
        findings.warning((line.number, NAME + 1), "tle-name", message);
    }
    name.to_owned()
}

/// Column of the ephemeris type, from 0.
const TYPE: usize = 62;

/// Whether a set is for SGP4: catalogues write type 0; type 2 is SGP4's own number.
fn is_for_sgp4(first: &Line, findings: &mut FindingList) -> bool {
    let kind = first.text.as_bytes()[TYPE];
    let name = match kind {
        b'0' | b'2' => return true,
        b'4' => ", SGP4-XP,",
        _ => "",
    };
    let message = format!(
        "ephemeris type {}{name} is not 0 or 2: SGP4 cannot propagate it",
        char::from(kind)
    );
    findings.error((first.number, TYPE + 1), "tle-type", message);
    false
}

/// Checks the values that the columns alone do not bound.
fn ranges_fit(first: &Line, second: &Line, findings: &mut FindingList) -> bool {
    let number = |line: &Line, from: usize, to: usize| line.text[from..to].trim().parse::<f64>();
    let mut fits = true;
    let mut check = |line: &Line, (from, to): (usize, usize), name: &str, most: f64| {
        let value = number(line, from, to);
        if !matches!(value, Ok(value) if (0.0..=most).contains(&value)) {
            let message = format!("{name} '{}' is outside 0 to {most}", &line.text[from..to]);
            findings.error((line.number, from + 1), "tle-range", message);
            fits = false;
        }
    };
    check(second, (8, 16), "inclination", 180.0);
    check(second, (17, 25), "right ascension", 360.0);
    check(second, (34, 42), "argument of perigee", 360.0);
    check(second, (43, 51), "mean anomaly", 360.0);
    check(second, (52, 63), "mean motion", 20.0);
    if fits && matches!(number(second, 52, 63), Ok(0.0)) {
        findings.error((second.number, 53), "tle-range", "the mean motion is 0");
        fits = false;
    }
    let days = days_of_year(&first.text[18..20]);
    let day = number(first, 20, 32);
    if !matches!(day, Ok(day) if (1.0..days + 1.0).contains(&day)) {
        let message = format!(
            "day '{}' is not in a year of {days} days",
            &first.text[20..32]
        );
        findings.error((first.number, 21), "tle-range", message);
        fits = false;
    }
    fits
}

/// Days in a year of two digits: 57 to 99 are of the twentieth century.
fn days_of_year(year: &str) -> f64 {
    let year: i32 = year.parse().unwrap_or(0);
    let year = if year < 57 { year + 2000 } else { year + 1900 };
    NaiveDate::from_ymd_opt(year, 12, 31).map_or(365.0, |last| f64::from(last.ordinal()))
}

/// The nearest step of 1e-8 day.
fn snapped(stamp: chrono::NaiveDateTime) -> chrono::NaiveDateTime {
    let since_midnight = since_midnight_ns(stamp);
    let step = (since_midnight + EPOCH_STEP_NS / 2).div_euclid(EPOCH_STEP_NS);
    let move_ns = step * EPOCH_STEP_NS - since_midnight;
    stamp
        .checked_add_signed(TimeDelta::nanoseconds(move_ns))
        .unwrap_or(stamp)
}

//! Intervals in which satellites are out of service: tables in CSV, and interval lists of STK (`.int`).
//!
//! Source of the latter: AGI/Ansys, *STK Help*, "Interval List File Format (*.int)": `stk.v.N`, `BEGIN IntervalList`,
//! `DateUnitAbrv UTCG` (or `ISO-YMD`) for dates in quotation marks, or `ScenarioEpoch` for seconds; then pairs of start and
//! end, each with an optional path of an object, whose last part is the satellite: `Satellite/NW-P01-S03`.

use super::stk::parse_calendar_date;
use super::text::timestamp::{self, TimeSystem};
use crate::printable::printable;
use crate::time::Epoch;
use chrono::NaiveDateTime;
use thiserror::Error;

/// An interval in which a satellite is out of service.
#[derive(Debug, Clone, PartialEq)]
pub struct OutageInterval {
    /// The satellite; `None` in a list that does not say of which.
    pub satellite: Option<String>,
    /// Its start.
    pub start: Epoch,
    /// Its end, excluded.
    pub end: Epoch,
    /// The line, from 1.
    pub line: u64,
}

/// What is wrong with a file of intervals.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("line {line}: {reason}")]
pub struct OutageFileError {
    /// The line, from 1.
    pub line: u64,
    /// What was found, and what is expected.
    pub reason: String,
}

const COLUMNS: [&str; 3] = ["satellite", "start_utc", "end_utc"];

/// Reads a file in either format; an interval list of STK begins with `stk.v`.
///
/// # Errors
/// If a line is wrong, or there is no interval.
pub fn read(bytes: &[u8]) -> Result<Vec<OutageInterval>, OutageFileError> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let text = std::str::from_utf8(bytes).map_err(|_| at(1, "not UTF-8"))?;
    let is_stk = text.trim_start().to_ascii_lowercase().starts_with("stk.v");
    let intervals = if is_stk { of_stk(text)? } else { of_csv(text)? };
    if intervals.is_empty() {
        return Err(at(1, "the file contains no interval"));
    }
    Ok(intervals)
}

fn at(line: u64, reason: impl Into<String>) -> OutageFileError {
    OutageFileError {
        line,
        reason: reason.into(),
    }
}

impl OutageInterval {
    fn new(
        satellite: Option<&str>,
        [start, end]: [Epoch; 2],
        line: u64,
    ) -> Result<Self, OutageFileError> {
        if end.seconds_since(start) <= 0.0 {
            return Err(at(
                line,
                format!("the end {end} is not after the start {start}"),
            ));
        }
        Ok(Self {
            satellite: satellite.map(str::to_owned),
            start,
            end,
            line,
        })
    }
}

fn utc(text: &str, line: u64) -> Result<Epoch, OutageFileError> {
    let stamp = timestamp::parse_with_offset(text).ok_or_else(|| {
        let found = printable(text);
        at(
            line,
            format!("'{found}' is not a UTC instant such as 2025-01-01T06:00:00Z"),
        )
    })?;
    Ok(TimeSystem::Utc.epoch(stamp))
}

fn of_csv(text: &str) -> Result<Vec<OutageInterval>, OutageFileError> {
    let mut reader = csv::ReaderBuilder::new()
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let unreadable = |error: csv::Error| {
        let line = error.position().map_or(1, csv::Position::line);
        at(line, error.to_string())
    };
    let header = reader.headers().map_err(unreadable)?.clone();
    let mut columns = [0; 3];
    for (column, name) in columns.iter_mut().zip(COLUMNS) {
        *column = header.iter().position(|one| one == name).ok_or_else(|| {
            let found: Vec<String> = header
                .iter()
                .map(|one| printable(one).to_string())
                .collect();
            at(
                1,
                format!(
                    "no column {name} (found: {}); expected {}",
                    found.join(", "),
                    COLUMNS.join(", ")
                ),
            )
        })?;
    }
    let mut intervals = Vec::new();
    for row in reader.records() {
        let row = row.map_err(unreadable)?;
        let line = row.position().map_or(1, |position| line_of(position, text));
        let [satellite, start, end] = columns.map(|column| row.get(column).unwrap_or_default());
        if satellite.is_empty() {
            return Err(at(line, "no satellite"));
        }
        let span = [utc(start, line)?, utc(end, line)?];
        intervals.push(OutageInterval::new(Some(satellite), span, line)?);
    }
    Ok(intervals)
}

/// The line of a record. The reader reports the position of blank lines and comments before it.
pub(super) fn line_of(position: &csv::Position, text: &str) -> u64 {
    let from = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let rest = text.get(from..).unwrap_or_default();
    let is_passed_over = |line: &&str| line.trim().is_empty() || line.starts_with('#');
    position.line() + rest.lines().take_while(is_passed_over).count() as u64
}

/// How the instants of a list are written.
#[derive(Default)]
struct StkTimes {
    /// Origin of instants in seconds.
    epoch: Option<NaiveDateTime>,
    /// The unit of dates.
    dates: Option<String>,
}

impl StkTimes {
    fn instant(&self, text: &str, line: u64) -> Result<Epoch, OutageFileError> {
        let found = printable(text);
        let date = match self.dates.as_deref() {
            Some("iso-ymd") => timestamp::parse(text),
            Some(_) => parse_calendar_date(text),
            None => None,
        };
        if let Some(stamp) = date {
            return Ok(TimeSystem::Utc.epoch(stamp));
        }
        let seconds = text
            .parse::<f64>()
            .ok()
            .filter(|seconds| seconds.is_finite());
        if let (Some(epoch), Some(seconds)) = (self.epoch, seconds) {
            return Ok(TimeSystem::Utc.epoch(epoch).plus_seconds(seconds));
        }
        let expected = match (&self.dates, self.epoch) {
            (Some(unit), _) => format!("a date in {}", unit.to_uppercase()),
            (None, Some(_)) => "seconds since ScenarioEpoch".to_owned(),
            (None, None) => "DateUnitAbrv or ScenarioEpoch before it".to_owned(),
        };
        Err(at(
            line,
            format!("'{found}' is no instant, expected {expected}"),
        ))
    }
}

fn of_stk(text: &str) -> Result<Vec<OutageInterval>, OutageFileError> {
    let mut times = StkTimes::default();
    let mut intervals = Vec::new();
    let mut is_ended = false;
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.trim();
        let lower = content.to_ascii_lowercase();
        let words: Vec<&str> = lower.split_whitespace().collect();
        match words.as_slice() {
            [] => {}
            ["begin", "intervallist" | "intervals"] | ["end", "intervals"] => {}
            [first, ..] if first.starts_with('#') || first.starts_with("stk.v") => {}
            ["end", "intervallist"] | ["endintervallist"] => is_ended = true,
            ["scenarioepoch", ..] => {
                let value = content["scenarioepoch".len()..].trim().trim_matches('"');
                let epoch = parse_calendar_date(value);
                times.epoch = Some(epoch.ok_or_else(|| {
                    at(
                        line,
                        format!(
                            "ScenarioEpoch '{}' is not a date such as 1 Jan 2025 00:00:00.000",
                            printable(value)
                        ),
                    )
                })?);
            }
            ["dateunitabrv", unit @ ("utcg" | "iso-ymd")] => times.dates = Some((*unit).to_owned()),
            ["dateunitabrv", ..] => {
                return Err(at(
                    line,
                    format!(
                        "'{}': dates are read in UTCG and ISO-YMD",
                        printable(content)
                    ),
                ));
            }
            _ if is_ended => return Err(at(line, "text after END IntervalList")),
            _ => intervals.push(stk_row(content, &times, line)?),
        }
    }
    let last = text.lines().count().max(1) as u64;
    if is_ended {
        Ok(intervals)
    } else {
        Err(at(last, "END IntervalList is missing"))
    }
}

fn stk_row(row: &str, times: &StkTimes, line: u64) -> Result<OutageInterval, OutageFileError> {
    let (start, rest) = token(row);
    let (end, rest) = token(rest);
    if end.is_empty() {
        return Err(at(
            line,
            format!("'{}' is neither a keyword nor an interval", printable(row)),
        ));
    }
    let object = rest.trim().trim_matches('"');
    let satellite = object.rsplit('/').next().filter(|name| !name.is_empty());
    let span = [times.instant(start, line)?, times.instant(end, line)?];
    OutageInterval::new(satellite, span, line)
}

/// The first word of a text, which may be in quotation marks, and the rest.
fn token(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    match text.strip_prefix('"') {
        Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
        None => text.split_once(char::is_whitespace).unwrap_or((text, "")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(text: &str) -> Vec<(Option<String>, String, String, u64)> {
        let read = read(text.as_bytes()).unwrap().into_iter();
        let row = |one: OutageInterval| {
            (
                one.satellite,
                one.start.to_string(),
                one.end.to_string(),
                one.line,
            )
        };
        read.map(row).collect()
    }

    fn expected(
        satellite: Option<&str>,
        start: &str,
        end: &str,
        line: u64,
    ) -> (Option<String>, String, String, u64) {
        (
            satellite.map(str::to_owned),
            start.to_owned(),
            end.to_owned(),
            line,
        )
    }

    #[test]
    fn csv_has_named_columns_in_any_order() {
        let text = "\u{feff}end_utc,satellite,note,start_utc\n# maintenance\n2025-01-01T06:30:00Z,NW-P01-S03,x,2025-01-01T06:00:00Z\n\
            2025-01-01T10:00:00+02:00,gps:A3,,2025-01-01T07:00:00Z\n";
        assert_eq!(
            rows(text),
            [
                expected(
                    Some("NW-P01-S03"),
                    "2025-01-01T06:00:00Z",
                    "2025-01-01T06:30:00Z",
                    3
                ),
                expected(
                    Some("gps:A3"),
                    "2025-01-01T07:00:00Z",
                    "2025-01-01T08:00:00Z",
                    4
                ),
            ]
        );
    }

    /// The forms of the examples of STK Help: dates or seconds, with and without `Intervals`, with and without an object.
    #[test]
    fn validate_interval_lists_of_stk() {
        let dates = "stk.v.4.3\nBEGIN IntervalList\n  DATEUNITABRV UTCG\nBEGIN Intervals\n\
            \"1 Jun 2003 12:00:00.00\" \"1 Jun 2003 12:05:16.39\" Satellite/Sat1\n\
            \"1 Jun 2003 13:32:24.43\" \"1 Jun 2003 13:41:28.74\"\nEND Intervals\nEND IntervalList\n";
        let found = read(dates.as_bytes()).unwrap();
        assert_eq!(found[0].satellite.as_deref(), Some("Sat1"));
        assert_eq!((found[1].satellite.as_deref(), found[1].line), (None, 6));
        assert!((found[0].end.seconds_since(found[0].start) - 316.39).abs() < 1e-6);
        let seconds = "stk.v.4.2.1\nBEGIN IntervalList\n\tScenarioEpoch 1 Jul 2000 00:00:00.00\n-2200.0 -1600.0\n0.0 1200.0\nENDIntervalList\n";
        let found = rows(seconds);
        assert_eq!(
            found[0],
            expected(None, "2000-06-30T23:23:20Z", "2000-06-30T23:33:20Z", 4)
        );
        assert_eq!(
            found[1],
            expected(None, "2000-07-01T00:00:00Z", "2000-07-01T00:20:00Z", 5)
        );
    }

    #[test]
    fn what_is_wrong_is_named_with_its_line() {
        let list = |row: &str| {
            format!("stk.v.4.3\nBEGIN IntervalList\nDateUnitAbrv UTCG\n{row}\nEND IntervalList\n")
        };
        for (text, expected) in [
            (
                "satellite,start_utc\nA,2025-01-01T00:00:00Z\n".to_owned(),
                "line 1: no column end_utc (found: satellite, start_utc); expected satellite, start_utc, end_utc",
            ),
            (
                "satellite,start_utc,end_utc\n".to_owned(),
                "line 1: the file contains no interval",
            ),
            (
                "satellite,start_utc,end_utc\n,2025-01-01T00:00:00Z,2025-01-01T01:00:00Z\n"
                    .to_owned(),
                "line 2: no satellite",
            ),
            (
                "satellite,start_utc,end_utc\nA,noon,2025-01-01T01:00:00Z\n".to_owned(),
                "line 2: 'noon' is not a UTC instant such as 2025-01-01T06:00:00Z",
            ),
            (
                "satellite,start_utc,end_utc\nA,2025-01-01T01:00:00Z,2025-01-01T01:00:00Z\n"
                    .to_owned(),
                "line 2: the end 2025-01-01T01:00:00Z is not after the start 2025-01-01T01:00:00Z",
            ),
            (
                list("\"1 Jux 2025 00:00:00\" \"1 Jan 2025 01:00:00\""),
                "line 4: '1 Jux 2025 00:00:00' is no instant, expected a date in UTCG",
            ),
            (
                list("hello"),
                "line 4: 'hello' is neither a keyword nor an interval",
            ),
            (
                list("").replace("UTCG", "TAIG"),
                "line 3: 'DateUnitAbrv TAIG': dates are read in UTCG and ISO-YMD",
            ),
            (
                list("").replace("END IntervalList\n", ""),
                "line 4: END IntervalList is missing",
            ),
        ] {
            assert_eq!(read(text.as_bytes()).unwrap_err().to_string(), expected);
        }
        assert_eq!(read(b"\xff").unwrap_err().reason, "not UTF-8");
    }
}

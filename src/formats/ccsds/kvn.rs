//! Keyword = value notation of the CCSDS Orbit Data Messages (502.0-B-3, section 7), and the values read for a
//! table of keywords.

use super::keywords::{KvnKeyword, Need, ValueKind};
use crate::formats::metadata::Metadata;
use crate::formats::text::finding::FindingList;
use crate::formats::text::lines::{Line, Lines};
use crate::formats::text::number;
use crate::formats::text::timestamp::{self, SecondDigits, calendar};
use crate::keyword::{Keyword, keywords};
use chrono::NaiveDateTime;
use std::io::{self, BufRead, Write};

/// Maximum length of a line (7.3.2).
const LINE: usize = 254;

/// Maximum number of digits (7.5.6, 7.5.7).
const DIGITS: usize = 16;

keywords! {
    /// A version of the Orbit Data Messages.
    CcsdsVersion {
        /// CCSDS 502.0-B-2, which most readers support.
        V2 = "2.0",
        /// CCSDS 502.0-B-3.
        V3 = "3.0",
    }
}

/// The header of a message (tables 3-1, 4-1 and 5-2, which agree).
#[derive(Debug, Clone, PartialEq)]
pub struct CcsdsHeader {
    /// Version of the message.
    pub version: CcsdsVersion,
    /// Comments after the version.
    pub comments: Vec<String>,
    /// Classification (version 3).
    pub classification: Option<String>,
    /// Creation time of the message, UTC.
    pub creation_date: NaiveDateTime,
    /// Its originator.
    pub originator: String,
    /// Identifier of the message (version 3).
    pub message_id: Option<String>,
}

impl CcsdsHeader {
    /// The header of a file that `metadata` describes.
    ///
    /// `MESSAGE_ID` is left out even in version 3: it is optional, and some readers refuse it.
    pub(crate) fn new(version: CcsdsVersion, metadata: &Metadata) -> Self {
        Self {
            version,
            comments: metadata.comments(),
            classification: None,
            creation_date: metadata.creation.utc().naive_utc(),
            originator: metadata.originator.clone(),
            message_id: None,
        }
    }

    /// Writes the header, whose first keyword is `version_key`.
    pub(crate) fn write(&self, out: &mut impl Write, version_key: &str) -> io::Result<()> {
        writeln!(out, "{version_key} = {}", self.version)?;
        write_comments(out, &self.comments)?;
        for (key, value) in self.pairs() {
            writeln!(out, "{key} = {value}")?;
        }
        Ok(())
    }

    /// The keywords after the comments.
    pub(crate) fn pairs(&self) -> impl Iterator<Item = (&'static str, String)> {
        let digits = SecondDigits::of_stamp(self.creation_date);
        [
            ("CLASSIFICATION", self.classification.clone()),
            ("CREATION_DATE", Some(calendar(self.creation_date, digits))),
            ("ORIGINATOR", Some(self.originator.clone())),
            ("MESSAGE_ID", self.message_id.clone()),
        ]
        .into_iter()
        .filter_map(|(key, value)| Some((key, value?)))
    }

    /// The header from its keywords; `block` holds the version under `version_key`.
    pub(crate) fn read(
        block: &KvnBlock,
        version_key: &str,
        findings: &mut FindingList,
    ) -> Option<Self> {
        let text = block.text(version_key)?;
        // Nothing that is read here differs between versions 1.0 and 2.0.
        let known = if text == "1.0" { "2.0" } else { &text };
        let Ok(version) = CcsdsVersion::from_keyword(known) else {
            let message = format!("version '{text}' is not 1.0, 2.0 or 3.0");
            findings.error(block.place(version_key), "ccsds-version", message);
            return None;
        };
        Some(Self {
            version,
            comments: block.comments.clone(),
            classification: block.text("CLASSIFICATION"),
            creation_date: block.stamp("CREATION_DATE", findings)?,
            originator: block.text("ORIGINATOR")?,
            message_id: block.text("MESSAGE_ID"),
        })
    }
}

/// Writes comment lines.
pub(crate) fn write_comments(out: &mut impl Write, comments: &[String]) -> io::Result<()> {
    comments
        .iter()
        .try_for_each(|comment| writeln!(out, "COMMENT {comment}"))
}

/// A keyword and its value, as written.
pub(crate) struct Pair<'a> {
    pub(crate) key: &'a str,
    pub(crate) value: &'a str,
    /// The unit, which in XML is an attribute.
    pub(crate) unit: Option<&'a str>,
    pub(crate) key_place: (usize, usize),
    pub(crate) value_place: (usize, usize),
}

/// The lines of a message, whose comments may contain any characters.
pub(crate) fn lines<R: BufRead>(input: R) -> Lines<R> {
    Lines::new(input).with_comments(|line| line.trim_ascii_start().starts_with(b"COMMENT"))
}

/// The content of one line of a message.
pub(crate) enum Item<'a> {
    Blank,
    Comment(&'a str),
    Pair(Pair<'a>),
    /// Anything without an equals sign: a `_START`, a `_STOP`, a line of numbers.
    Other(&'a str),
}

/// Parses a line.
pub(crate) fn item<'a>(line: &'a Line, findings: &mut FindingList) -> Item<'a> {
    if line.text.len() > LINE {
        let message = format!(
            "the line has {} characters; the limit is {LINE}",
            line.text.len()
        );
        findings.warning((line.number, LINE + 1), "ccsds-line-length", message);
    }
    let text = line.text.trim();
    if text.is_empty() {
        return Item::Blank;
    }
    if let Some(comment) = text.strip_prefix("COMMENT")
        && (comment.is_empty() || comment.starts_with(' '))
    {
        return Item::Comment(comment.strip_prefix(' ').unwrap_or(comment));
    }
    let Some((key, value)) = line.text.split_once('=') else {
        return Item::Other(text);
    };
    let column = |part: &str| part.len() - part.trim_start().len() + 1;
    Item::Pair(Pair {
        key: key.trim(),
        value: value.trim(),
        unit: None,
        key_place: (line.number, column(key)),
        value_place: (line.number, key.len() + 1 + column(value)),
    })
}

/// A value with its place in the file.
#[derive(Debug, Clone)]
struct PlacedValue {
    text: String,
    /// Its numerical value, if the keyword takes a number.
    number: Option<f64>,
    place: (usize, usize),
}

/// The values of one table of keywords, in the order read.
pub(crate) struct KvnBlock {
    table: Vec<&'static KvnKeyword>,
    values: Vec<Option<PlacedValue>>,
    /// Which keywords have been read, with or without a value.
    seen: Vec<bool>,
    last: Option<usize>,
    /// Whether the standard's rules on order and numbers apply: to messages, but not to the objects and rows of
    /// a catalogue.
    is_message: bool,
    /// Comments among the keywords.
    pub(crate) comments: Vec<String>,
}

impl KvnBlock {
    /// A block of a message, with its keywords in the order of the tables.
    pub(crate) fn new(tables: &[&'static [KvnKeyword]]) -> Self {
        let table: Vec<_> = tables.iter().copied().flatten().collect();
        Self {
            values: table.iter().map(|_| None).collect(),
            seen: vec![false; table.len()],
            table,
            last: None,
            is_message: true,
            comments: Vec::new(),
        }
    }

    /// A block for an object or a row of a catalogue: the keywords of a message, in any order.
    pub(crate) fn of_record(tables: &[&'static [KvnKeyword]]) -> Self {
        Self {
            is_message: false,
            ..Self::new(tables)
        }
    }

    fn index(&self, key: &str) -> Option<usize> {
        self.table.iter().position(|keyword| keyword.name == key)
    }

    /// Whether a keyword belongs to the table.
    pub(crate) fn knows(&self, key: &str) -> bool {
        self.index(key).is_some()
    }

    /// Whether the block belongs to a message rather than to a record of a catalogue.
    pub(crate) fn is_message(&self) -> bool {
        self.is_message
    }

    /// Whether no keyword has been read yet.
    pub(crate) fn is_empty(&self) -> bool {
        self.last.is_none()
    }

    /// Adds a keyword of the table.
    pub(crate) fn accept(&mut self, pair: &Pair<'_>, findings: &mut FindingList) {
        let Some(index) = self.index(pair.key) else {
            let message = format!("keyword {} is not allowed here", pair.key);
            findings.error(pair.key_place, "ccsds-keyword", message);
            return;
        };
        if std::mem::replace(&mut self.seen[index], true) {
            let message = format!("{} appears twice", pair.key);
            findings.error(pair.key_place, "ccsds-repeated", message);
            return;
        }
        if let Some(last) = self.last.filter(|last| self.is_message && *last > index) {
            let message = format!("{} must come before {}", pair.key, self.table[last].name);
            findings.warning(pair.key_place, "ccsds-order", message);
        }
        self.last = self.last.max(Some(index));
        if pair.value.is_empty() {
            let message = format!("{} has no value", pair.key);
            match self.table[index].need {
                Need::Mandatory => findings.error(pair.value_place, "ccsds-empty", message),
                _ => findings.warning(pair.value_place, "ccsds-empty", message),
            }
            return;
        }
        let number = match self.table[index].kind {
            ValueKind::Text if pair.unit.is_none() => None,
            ValueKind::Text => {
                let message = format!("{} has no unit", pair.key);
                findings.error(pair.value_place, "ccsds-unit", message);
                return;
            }
            ValueKind::Number(unit) => match self.read_quantity(pair, unit, findings) {
                None => return,
                number => number,
            },
        };
        self.values[index] = Some(PlacedValue {
            text: pair.value.to_owned(),
            number,
            place: pair.value_place,
        });
    }

    /// The number of a keyword; its unit, if displayed, must be that of the table (7.7.1.1).
    fn read_quantity(
        &self,
        pair: &Pair<'_>,
        unit: Option<&'static str>,
        findings: &mut FindingList,
    ) -> Option<f64> {
        let place = pair.value_place;
        if !self.is_message {
            return number::read(pair.value, place, "omm-number", findings);
        }
        let (text, shown) = match pair.value.split_once('[') {
            Some((text, rest)) if rest.ends_with(']') => {
                (text.trim_end(), rest.strip_suffix(']').map(str::trim))
            }
            _ => (pair.value, None),
        };
        for shown in shown.into_iter().chain(pair.unit) {
            check_unit(pair.key, shown, unit, place, findings)?;
        }
        read_number(text, place, findings)
    }

    /// Adds a keyword of the table whose key and value have the same position, as in XML.
    pub(crate) fn accept_at(
        &mut self,
        (key, value): (&str, &str),
        unit: Option<&str>,
        place: (usize, usize),
        findings: &mut FindingList,
    ) {
        let pair = Pair {
            key,
            value,
            unit,
            key_place: place,
            value_place: place,
        };
        self.accept(&pair, findings);
    }

    /// Reports the mandatory keywords that are missing.
    pub(crate) fn finish(&self, place: (usize, usize), findings: &mut FindingList) {
        for (keyword, seen) in self.table.iter().zip(&self.seen) {
            let message = || format!("{} is mandatory and missing", keyword.name);
            match keyword.need {
                Need::Mandatory | Need::Named if !seen => {
                    findings.error(place, "ccsds-missing", message())
                }
                Need::Expected if !seen => findings.warning(place, "ccsds-missing", message()),
                _ => {}
            }
        }
    }

    fn placed(&self, key: &str) -> Option<&PlacedValue> {
        self.values[self.index(key)?].as_ref()
    }

    /// Line and column of the value of a keyword.
    pub(crate) fn place(&self, key: &str) -> (usize, usize) {
        self.placed(key).map_or((1, 1), |value| value.place)
    }

    /// A text value.
    pub(crate) fn text(&self, key: &str) -> Option<String> {
        self.placed(key).map(|value| value.text.clone())
    }

    /// A text value, or the standard's placeholder for a missing one.
    pub(crate) fn text_or_unknown(&self, key: &str) -> String {
        self.text(key).unwrap_or_else(|| "UNKNOWN".to_owned())
    }

    /// A time; a finding if it is invalid.
    pub(crate) fn stamp(&self, key: &str, findings: &mut FindingList) -> Option<NaiveDateTime> {
        let value = self.placed(key)?;
        read_stamp(&value.text, value.place, findings)
    }

    /// A number.
    pub(crate) fn number(&self, key: &str) -> Option<f64> {
        self.placed(key)?.number
    }

    /// A count; a finding if it is invalid.
    pub(crate) fn count(&self, key: &str, findings: &mut FindingList) -> Option<u64> {
        let value = self.placed(key)?;
        let parsed = value.text.parse().ok();
        if parsed.is_none() {
            let message = format!("'{}' is not a count", value.text);
            findings.error(value.place, "ccsds-number", message);
        }
        parsed
    }
}

/// Reads a time of 7.5.10; a finding if it is invalid.
pub(crate) fn read_stamp(
    text: &str,
    place: (usize, usize),
    findings: &mut FindingList,
) -> Option<NaiveDateTime> {
    let stamp = timestamp::parse(text);
    if stamp.is_none() {
        let message = format!("'{text}' is not a time such as 2025-01-01T00:00:00.000");
        findings.error(place, "ccsds-time", message);
    }
    stamp
}

/// Checks a displayed unit against the table; a difference only in case is a warning.
fn check_unit(
    key: &str,
    shown: &str,
    unit: Option<&'static str>,
    place: (usize, usize),
    findings: &mut FindingList,
) -> Option<()> {
    let Some(unit) = unit else {
        let message = format!("{key} has no unit, but is written with [{shown}]");
        findings.error(place, "ccsds-unit", message);
        return None;
    };
    if shown == unit {
        return Some(());
    }
    let message = format!("{key} is in [{unit}], but is written with [{shown}] (7.7.1.1)");
    if shown.eq_ignore_ascii_case(unit) {
        findings.warning(place, "ccsds-unit", message);
        return Some(());
    }
    findings.error(place, "ccsds-unit", message);
    None
}

/// Reads a number of 7.5.4 to 7.5.7; a finding if it is invalid.
pub(crate) fn read_number(
    text: &str,
    place: (usize, usize),
    findings: &mut FindingList,
) -> Option<f64> {
    // Fortran notation is not allowed here.
    if text.contains(['d', 'D']) {
        findings.error(place, "ccsds-number", format!("'{text}' is not a number"));
        return None;
    }
    let value = number::read(text, place, "ccsds-number", findings)?;
    let mantissa = text.split(['e', 'E']).next().unwrap_or_default();
    let unsigned = mantissa.strip_prefix(['+', '-']).unwrap_or(mantissa);
    let (whole, decimals) = unsigned.split_once('.').unwrap_or((unsigned, "0"));
    if whole.is_empty() || decimals.is_empty() {
        let message = format!("'{text}' needs a digit on both sides of the decimal point (7.5.6)");
        findings.warning(place, "ccsds-point", message);
    }
    let digits = unsigned.bytes().filter(u8::is_ascii_digit).count();
    if digits > DIGITS {
        let message = format!("the number has {digits} digits; the limit is {DIGITS}");
        findings.warning(place, "ccsds-digits", message);
    }
    Some(value)
}

/// The words of a line with their columns, from 1.
pub(crate) fn words(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut at = 0;
    std::iter::from_fn(move || {
        at += text[at..].len() - text[at..].trim_start().len();
        let word = text[at..]
            .split(' ')
            .next()
            .filter(|word| !word.is_empty())?;
        let column = at + 1;
        at += word.len();
        Some((column, word))
    })
}

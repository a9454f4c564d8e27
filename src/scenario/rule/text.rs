//! Rules for texts and instants.

use chrono::{DateTime, Datelike, SecondsFormat, Timelike, Utc};
use serde_json::{Value as Json, json};
use toml::de::DeValue;

use super::{Node, Reading, Rule};
use crate::scenario::number::toml_text;
use crate::time::{FIRST_YEAR, ends_with_leap_second};

/// A text of a certain kind, never empty and without control characters.
pub(in crate::scenario) enum Text {
    /// Something that is safe as part of a file name everywhere.
    Name,
    /// What satellites' names begin with, in every format.
    Prefix,
    /// Printable ASCII.
    Ascii,
    /// Anything.
    Any,
}

impl Text {
    /// Longest text in bytes. A name becomes part of a directory name, where 255 is the usual
    /// limit; a prefix leaves room for shell, plane and slot in the 24 columns of a TLE's name; ASCII text follows its keyword on a line of a CCSDS message, which has at most 254
    /// characters (502.0-B-3, 7.3.2); 4096 is the usual limit of a path.
    fn longest(&self) -> usize {
        match self {
            Self::Name => 100,
            Self::Prefix => 8,
            Self::Ascii => 200,
            Self::Any => 4096,
        }
    }

    fn accepts(&self, text: &str) -> bool {
        let right_kind = match self {
            Self::Name => {
                text.starts_with(|c: char| c.is_ascii_alphanumeric())
                    && text
                        .chars()
                        .all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c))
            }
            Self::Prefix => {
                text.starts_with(|c: char| c.is_ascii_alphabetic())
                    && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
            }
            Self::Ascii => text.is_ascii(),
            Self::Any => true,
        };
        let filled = !text.trim().is_empty() && text.len() <= self.longest();
        filled && right_kind && !text.contains(char::is_control)
    }
}

impl Rule for Text {
    type Value = String;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<String> {
        let text = node.get_ref().as_str().filter(|text| self.accepts(text));
        if text.is_none() {
            reading.refuse(node);
        }
        text.map(str::to_owned)
    }

    fn accepted(&self) -> String {
        let kind = match self {
            Self::Name => {
                "a text of letters, digits, '-', '_' and '.' that begins with a letter or digit"
            }
            Self::Prefix => "a text of letters, digits and '-' that begins with a letter",
            Self::Ascii => "a text of printable ASCII",
            Self::Any => "a text without control characters",
        };
        format!("{kind}, 1 to {} bytes", self.longest())
    }

    fn schema(&self) -> Json {
        let pattern = match self {
            Self::Name => "^[A-Za-z0-9][A-Za-z0-9._-]*$",
            Self::Prefix => "^[A-Za-z][A-Za-z0-9-]*$",
            Self::Ascii => "^[ -~]*[!-~][ -~]*$",
            Self::Any => r"^[^\u0000-\u001F\u007F-\u009F]+$",
        };
        json!({ "type": "string", "minLength": 1, "maxLength": self.longest(), "pattern": pattern })
    }

    fn write(&self, value: &String) -> String {
        toml_text(value)
    }
}

/// A UTC instant: RFC 3339 in a text, or a TOML date-time, both with `Z`.
pub(in crate::scenario) struct UtcInstant;

impl UtcInstant {
    /// UTC has leap seconds since 1972; precession and nutation are those of the century around us.
    const YEARS: std::ops::RangeInclusive<i32> = FIRST_YEAR..=2100;

    fn parse(text: &str) -> Option<DateTime<Utc>> {
        let instant = DateTime::parse_from_rfc3339(text).ok()?;
        let in_utc = instant.offset().local_minus_utc() == 0;
        let instant = instant.to_utc();
        // chrono writes second 60 of any minute as second 59 with 1e9 nanoseconds or more.
        let of_day = instant.num_seconds_from_midnight();
        let exists = instant.nanosecond() < 1_000_000_000
            || (of_day == 86_399 && ends_with_leap_second(instant.date_naive()));
        (in_utc && exists && Self::YEARS.contains(&instant.year())).then_some(instant)
    }
}

impl Rule for UtcInstant {
    type Value = DateTime<Utc>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<DateTime<Utc>> {
        let instant = match node.get_ref() {
            DeValue::String(text) => Self::parse(text),
            DeValue::Datetime(datetime) => Self::parse(&datetime.to_string()),
            _ => None,
        };
        if instant.is_none() {
            reading.refuse(node);
        }
        instant
    }

    fn accepted(&self) -> String {
        let (first, last) = (Self::YEARS.start(), Self::YEARS.end());
        format!(
            "a UTC instant such as \"2025-01-01T00:00:00Z\", years {first} to {last}, with 23:59:60 \
             only on days that end with a leap second"
        )
    }

    fn schema(&self) -> Json {
        json!({ "type": "string", "format": "date-time", "pattern": "Z$" })
    }

    fn write(&self, value: &DateTime<Utc>) -> String {
        toml_text(&value.to_rfc3339_opts(SecondsFormat::AutoSi, true))
    }
}

//! Rules for numbers that may follow from others.

use std::fmt::Display;
use std::str::FromStr;

use serde_json::{Value as Json, json};

use super::{Interval, Node, Number, Reading, Rule};
use crate::orbit::relations::{RepeatRatio, SunSynchronous};
use crate::scenario::number::toml_text;
use crate::search::IntervalOr;

/// A text that says what a number follows from, or an interval.
pub(in crate::scenario) struct FollowingOr<F> {
    interval: Interval<Number>,
    /// The text in words.
    told: &'static str,
    /// The text as a regular expression.
    pattern: &'static str,
    parse: fn(&str) -> Option<F>,
}

impl FollowingOr<SunSynchronous> {
    pub(in crate::scenario) const fn sun_synchronous(interval: Interval<Number>) -> Self {
        Self {
            interval,
            told: "\"sun-synchronous\"",
            pattern: "^sun-synchronous$",
            parse: parsed,
        }
    }
}

impl FollowingOr<RepeatRatio> {
    pub(in crate::scenario) const fn repeat(interval: Interval<Number>) -> Self {
        Self {
            interval,
            told: "\"repeat:REVOLUTIONS/DAYS\" such as \"repeat:15/1\"",
            pattern: RepeatRatio::PATTERN,
            parse: parsed,
        }
    }
}

fn parsed<F: FromStr>(text: &str) -> Option<F> {
    text.parse().ok()
}

impl<F: Display> Rule for FollowingOr<F> {
    type Value = IntervalOr<F>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        let Some(text) = node.get_ref().as_str() else {
            return self.interval.read(node, reading).map(IntervalOr::Between);
        };
        let found = (self.parse)(text);
        if found.is_none() {
            reading.refuse(node);
        }
        found.map(IntervalOr::Following)
    }

    fn accepted(&self) -> String {
        format!("{}, or {}", self.told, self.interval.accepted())
    }

    fn schema(&self) -> Json {
        let text = json!({ "type": "string", "pattern": self.pattern });
        json!({ "anyOf": [text, self.interval.schema()] })
    }

    fn write(&self, value: &Self::Value) -> String {
        match value {
            IntervalOr::Between(limits) => self.interval.write(limits),
            IntervalOr::Following(of) => toml_text(&of.to_string()),
        }
    }
}

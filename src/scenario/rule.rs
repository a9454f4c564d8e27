//! Rules: which values a key accepts, and how they are read, written and described.

mod constellations;
mod country;
mod following;
mod list;
mod number;
mod table;
mod text;

pub(super) use constellations::{Constellations, Notation, parts_without_paths};
pub(super) use country::Countries;
pub(super) use following::FollowingOr;
pub(super) use list::{
    Constraints, ListOf, Numbers, OneOf, OneOrMore, Skyline, SomeOf, TextOrTexts, Texts,
};
pub(super) use number::{Eastward, Integer, Interval, Number, Steps, TwoNumbers};
pub(super) use table::SectionTable;
pub(super) use text::{Text, UtcInstant};

use std::ops::Range;

use serde_json::Value as Json;
use toml::Spanned;
use toml::de::DeValue;

use super::keys::path;
use super::problem::{Fault, ProblemList};
use super::source::{Source, TableSources};

/// A value with its span in its source.
pub(super) type Node<'a> = Spanned<DeValue<'a>>;

/// The values that a key accepts.
pub(super) trait Rule {
    /// The validated value.
    type Value;

    /// Reads a value, or reports why not and gives `None`.
    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value>;

    /// The accepted type and range in words, to follow "expected".
    fn accepted(&self) -> String;

    /// The JSON schema of the value.
    fn schema(&self) -> Json;

    /// Whether there is nothing to write.
    fn is_absent(&self, _: &Self::Value) -> bool {
        false
    }

    /// The value as canonical TOML, which [`Rule::read`] reads back as the same value.
    fn write(&self, value: &Self::Value) -> String;
}

/// An optional value.
pub(super) struct Optional<R>(pub(super) R);

impl<R: Rule> Rule for Optional<R> {
    type Value = Option<R::Value>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        self.0.read(node, reading).map(Some)
    }

    fn accepted(&self) -> String {
        self.0.accepted()
    }

    fn schema(&self) -> Json {
        self.0.schema()
    }

    fn is_absent(&self, value: &Self::Value) -> bool {
        value.is_none()
    }

    fn write(&self, value: &Self::Value) -> String {
        value
            .as_ref()
            .map_or_else(String::new, |value| self.0.write(value))
    }
}

/// One value being read, and its problems.
pub(super) struct Reading<'r> {
    pub(super) source: &'r Source<'r>,
    pub(super) parts: &'r TableSources<'r>,
    pub(super) key: String,
    pub(super) accepted: String,
    pub(super) report: &'r mut ProblemList,
}

impl<'r> Reading<'r> {
    /// The reading of the value with this name in a table.
    pub(super) fn within(&mut self, name: &str, accepted: String) -> Reading<'_> {
        Reading {
            source: self.source_of(name),
            parts: self.parts,
            key: path(&self.key, name),
            accepted,
            report: self.report,
        }
    }

    /// Whether the value with this name in a table is from elsewhere than the table.
    pub(super) fn is_set(&self, name: &str) -> bool {
        self.parts.contains_key(&path(&self.key, name))
    }

    /// The source of the value with this name in a table.
    pub(super) fn source_of(&self, name: &str) -> &'r Source<'r> {
        let part = self.parts.get(&path(&self.key, name));
        part.map_or(self.source, |source| source)
    }

    pub(super) fn report(&mut self, span: Range<usize>, fault: impl Into<Fault>) {
        self.report.add(self.source, span, &self.key, fault);
    }

    /// Reports that the value is of another type or outside its range.
    pub(super) fn refuse(&mut self, node: &Node<'_>) {
        let fault = Fault::NotAccepted {
            found: self.written(node),
            accepted: self.accepted.clone(),
        };
        self.report(node.span(), fault);
    }

    /// The value as written; a table has no text of its own if its keys are dotted.
    pub(super) fn written(&self, node: &Node<'_>) -> String {
        if node.get_ref().is_table() {
            "a table".to_owned()
        } else {
            self.source.written(node.span())
        }
    }
}

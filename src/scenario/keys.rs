//! The keys of a scenario file, and the walk over all of them.
//!
//! A key is declared once, as a field of a [`section!`](declare). Reading, suggestions for unknown
//! keys, the template, the JSON schema, the documentation and the canonical form are walks over
//! these declarations.

mod declare;

pub(super) use declare::{kebab_bytes, kebab_case, key, section};

use std::fmt;
use std::sync::LazyLock;

use serde_json::Value as Json;

use super::Scenario;
use super::reader::Reader;
use super::rule::Rule;

/// Which key of a file is meant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct KeyPath {
    /// The section, empty at the top.
    pub(super) section: &'static str,
    /// The name within the section.
    pub(super) name: &'static str,
}

impl fmt::Display for KeyPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&path(self.section, self.name))
    }
}

/// `section.name`, or the name alone at the top.
pub(super) fn path(section: &str, name: &str) -> String {
    if section.is_empty() {
        name.to_owned()
    } else {
        format!("{section}.{name}")
    }
}

/// The declaration of a key.
pub(super) struct Key<R: Rule> {
    pub(super) path: KeyPath,
    /// What it means, as the documentation of its field: one sentence with its full stop.
    pub(super) documentation: &'static str,
    /// The unit of its numbers, empty if they have none.
    pub(super) unit: &'static str,
    /// What it accepts.
    pub(super) rule: R,
    /// The default; an example if the default depends on other keys.
    pub(super) default: R::Value,
    /// What the default depends on, in words, if the `finish` of a section fills it in.
    pub(super) follows: Option<&'static str>,
}

impl<R: Rule> Key<R> {
    /// The accepted type, range and unit in words.
    pub(super) fn accepted(&self) -> String {
        let accepted = self.rule.accepted();
        if self.unit.is_empty() {
            accepted
        } else {
            format!("{accepted}, in {}", self.unit)
        }
    }

    fn describe(&self) -> KeyDescription {
        KeyDescription {
            section: self.path.section,
            name: self.path.name,
            unit: self.unit,
            meaning: self.documentation.trim().trim_end_matches('.'),
            accepted: self.rule.accepted(),
            shown: self.rule.write(&self.default),
            follows: self.follows,
        }
    }

    fn schema(&self) -> Json {
        let description = self.describe();
        let mut schema = self.rule.schema();
        schema["description"] = Json::from(description.meaning);
        if self.follows.is_none() {
            // Every default is a TOML value that is also JSON.
            schema["default"] = serde_json::from_str(&description.shown).unwrap_or(Json::Null);
        }
        schema
    }
}

/// Fields, each of which is a key or a subsection.
pub(super) trait Section: Sized {
    /// The section of its keys, empty at the top.
    const SECTION: &'static str;

    /// Visits every key in the order of the file, with its value in `values`, and gathers what the
    /// walk gives for each.
    fn walk(walk: &mut impl Walk, values: Option<&Self>) -> Self;
}

/// An operation on every key.
pub(super) trait Walk {
    /// Visits a key with its value, if it has one, and returns the value that it is to have.
    fn key<R: Rule>(&mut self, key: Key<R>, value: Option<&R::Value>) -> R::Value;

    /// Completes what was gathered: only a reader has defaults that follow other keys to fill in,
    /// and checks between keys to make.
    fn finish<S>(&mut self, gathered: S, _: impl FnOnce(&mut S, &mut Reader<'_>)) -> S {
        gathered
    }
}

/// A key without the type of its value.
pub(super) struct Listed {
    pub(super) path: KeyPath,
    pub(super) description: KeyDescription,
    pub(super) schema: Json,
}

impl Walk for Vec<Listed> {
    fn key<R: Rule>(&mut self, key: Key<R>, _: Option<&R::Value>) -> R::Value {
        self.push(Listed {
            path: key.path,
            description: key.describe(),
            schema: key.schema(),
        });
        key.default
    }
}

/// The keys of a section in their order.
pub(super) fn list<S: Section>() -> Vec<Listed> {
    let mut keys = Vec::new();
    S::walk(&mut keys, None);
    keys
}

/// The paths of the keys of a section.
pub(super) fn paths<S: Section>() -> Vec<KeyPath> {
    list::<S>().iter().map(|key| key.path).collect()
}

/// Every key of a scenario in the order of the file.
pub(super) fn all() -> &'static [Listed] {
    static ALL: LazyLock<Vec<Listed>> = LazyLock::new(list::<Scenario>);
    &ALL
}

/// A key of a scenario file, described for a reader.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyDescription {
    /// The section, empty at the top.
    pub section: &'static str,
    /// The name within the section.
    pub name: &'static str,
    /// The unit, empty if it has none.
    pub unit: &'static str,
    /// What it means.
    pub meaning: &'static str,
    /// The accepted type and range.
    pub accepted: String,
    /// The default as TOML, or an example where the default depends on other keys.
    pub shown: String,
    /// What the default depends on, if it does.
    pub follows: Option<&'static str>,
}

/// The sections in the order of the file.
pub(super) fn sections() -> Vec<&'static str> {
    let mut sections: Vec<&'static str> = all().iter().map(|key| key.path.section).collect();
    sections.dedup();
    sections.retain(|section| !section.is_empty());
    sections
}

/// The names of the keys of a section.
pub(super) fn names(section: &str) -> Vec<&'static str> {
    let keys = all().iter().filter(|key| key.path.section == section);
    keys.map(|key| key.path.name).collect()
}

/// Every key in the order of the file, described for a reader.
#[must_use]
pub fn describe_keys() -> Vec<KeyDescription> {
    all().iter().map(|key| key.description.clone()).collect()
}

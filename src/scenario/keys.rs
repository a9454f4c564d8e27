//! The one table of keys. Parsing, unknown-key suggestions, the template, the JSON schema, the
//! documentation and the canonical form all come from it.

pub(super) mod table;

use serde_json::Value as Json;

use super::resolved::Scenario;
use super::rule::Rule;

/// A key of a scenario file.
pub(super) struct Key<R: Rule> {
    /// The section, empty at the top.
    pub(super) section: &'static str,
    /// The name within the section.
    pub(super) name: &'static str,
    /// The unit of its numbers, empty if they have none.
    pub(super) unit: &'static str,
    /// What it means, one sentence without a full stop.
    pub(super) meaning: &'static str,
    /// What it accepts.
    pub(super) rule: R,
    /// What holds when it is not given.
    pub(super) otherwise: Otherwise<R::Value>,
    /// Its value in a scenario; `None` where it has none.
    pub(super) of: fn(&Scenario) -> Option<R::Value>,
}

/// What holds when a key is not given.
pub(super) enum Otherwise<T> {
    /// A fixed value.
    Value(fn() -> T),
    /// Something that depends on other keys.
    Follows {
        /// What, in words.
        what: &'static str,
        /// A value to show in the template.
        example: fn() -> T,
    },
}

impl<T> Otherwise<T> {
    /// The fixed value, or the example of one that follows.
    pub(super) fn value(&self) -> T {
        match self {
            Self::Value(value) | Self::Follows { example: value, .. } => value(),
        }
    }
}

/// A key without the type of its value.
pub(super) trait AnyKey: Sync {
    fn section(&self) -> &'static str;
    fn name(&self) -> &'static str;
    /// The value of the key in `scenario` as canonical TOML.
    fn written(&self, scenario: &Scenario) -> Option<String>;
    fn schema(&self) -> Json;
    /// The key for a reader.
    fn describe(&self) -> KeyDescription;

    fn path(&self) -> String {
        path(self.section(), self.name())
    }
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
}

impl<R: Rule> AnyKey for Key<R> {
    fn section(&self) -> &'static str {
        self.section
    }

    fn name(&self) -> &'static str {
        self.name
    }

    fn written(&self, scenario: &Scenario) -> Option<String> {
        (self.of)(scenario).map(|value| self.rule.write(&value))
    }

    fn schema(&self) -> Json {
        let mut schema = self.rule.schema();
        schema["description"] = Json::from(self.meaning);
        if let Otherwise::Value(default) = self.otherwise {
            let default = self.rule.write(&default());
            // Every default is a TOML value that is also JSON.
            schema["default"] = serde_json::from_str(&default).unwrap_or(Json::Null);
        }
        schema
    }

    fn describe(&self) -> KeyDescription {
        let follows = match self.otherwise {
            Otherwise::Value(_) => None,
            Otherwise::Follows { what, .. } => Some(what),
        };
        KeyDescription {
            section: self.section,
            name: self.name,
            unit: self.unit,
            meaning: self.meaning,
            accepted: self.rule.accepted(),
            shown: self.rule.write(&self.otherwise.value()),
            follows,
        }
    }
}

/// The sections in the order in which they are written.
pub(super) fn sections() -> Vec<&'static str> {
    let mut sections: Vec<&'static str> = table::KEYS.iter().map(|key| key.section()).collect();
    sections.dedup();
    sections.retain(|section| !section.is_empty());
    sections
}

/// The names of the keys of a section.
pub(super) fn names(section: &str) -> Vec<&'static str> {
    let keys = table::KEYS.iter().filter(|key| key.section() == section);
    keys.map(|key| key.name()).collect()
}

/// `section.name`, or the name alone at the top.
pub(super) fn path(section: &str, name: &str) -> String {
    if section.is_empty() {
        name.to_owned()
    } else {
        format!("{section}.{name}")
    }
}

/// Every key in the order in which they are written, described for a reader.
#[must_use]
pub fn describe_keys() -> Vec<KeyDescription> {
    table::KEYS.iter().map(|key| key.describe()).collect()
}

//! The rules for designs and named constellations.

use serde_json::{Value as Json, json};

use super::{Node, Reading, Rule, SectionTable};
use crate::constellation::{Design, NotationError};
use crate::exchange::constellation::{
    GNSS_ONLY, LONGEST_NAME, NAME_CHARACTERS, accepted_name, is_name,
};
use crate::scenario::number::toml_text;
use crate::scenario::problem::Fault;
use crate::scenario::source::blanked;
use crate::scenario::values::{ConstellationParts, NamedConstellation};

/// A design in Walker notation.
pub(in crate::scenario) struct Notation;

impl Rule for Notation {
    type Value = Design;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Design> {
        let Some(text) = node.get_ref().as_str() else {
            reading.refuse(node);
            return None;
        };
        text.parse()
            .map_err(|error: NotationError| reading.report(node.span(), error))
            .ok()
    }

    fn accepted(&self) -> String {
        "a design in Walker notation, with `+` between shells".to_owned()
    }

    fn schema(&self) -> Json {
        json!({ "type": "string", "pattern": "^[^:]+:[^:]+:[^@]+@.+$" })
    }

    fn write(&self, value: &Design) -> String {
        toml_text(&value.to_string())
    }
}

/// A table of constellations by name, in the order as written.
pub(in crate::scenario) struct Constellations;

impl Constellations {
    const TABLE: SectionTable<ConstellationParts> = SectionTable::new();

    /// What stands behind a name.
    fn accepted_parts() -> String {
        format!("{}, or {}", Notation.accepted(), Self::TABLE.accepted())
    }
}

impl Rule for Constellations {
    type Value = Vec<NamedConstellation>;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<Self::Value> {
        let Some(table) = node.get_ref().as_table() else {
            reading.refuse(node);
            return None;
        };
        let read = |(name, node): (&toml::Spanned<_>, &Node<'_>)| {
            let name: &std::borrow::Cow<'_, str> = name.get_ref();
            let mut reading = reading.within(name, Self::accepted_parts());
            let is_accepted = check_name(name, node, &mut reading);
            let parts = read_parts(node, &mut reading)?;
            let name = name.to_string();
            is_accepted.then_some(NamedConstellation { name, parts })
        };
        // All of them, so that all problems are reported.
        let each: Vec<Option<NamedConstellation>> = table.iter().map(read).collect();
        each.into_iter().collect()
    }

    fn accepted(&self) -> String {
        format!("a table of names, each with {}", Self::accepted_parts())
    }

    fn schema(&self) -> Json {
        let mut table = Self::TABLE.schema();
        table["anyOf"] = json!([{ "required": ["design"] }, { "required": ["files"] }]);
        let needs_files = json!(["files"]);
        table["dependentRequired"] = FILE_KEYS
            .iter()
            .map(|key| ((*key).to_owned(), needs_files.clone()))
            .collect();
        json!({
            "type": "object",
            "propertyNames": {
                "pattern": format!("^[{NAME_CHARACTERS}]+$"),
                "maxLength": LONGEST_NAME,
                "not": { "const": GNSS_ONLY },
            },
            "additionalProperties": { "anyOf": [Notation.schema(), table] },
        })
    }

    fn write(&self, value: &Self::Value) -> String {
        if value.is_empty() {
            return "{}".to_owned();
        }
        let each: Vec<String> = value
            .iter()
            .map(|one| format!("{} = {}", one.name, write_parts(&one.parts)))
            .collect();
        format!("{{ {} }}", each.join(", "))
    }
}

/// The keys that say how files are read.
const FILE_KEYS: [&str; 3] = ["input-format", "only", "exclude"];

fn check_name(name: &str, node: &Node<'_>, reading: &mut Reading<'_>) -> bool {
    let is_accepted = is_name(name) && name != GNSS_ONLY;
    if !is_accepted {
        let found: String = blanked(name).take(LONGEST_NAME).collect();
        let fault = match name {
            GNSS_ONLY => Fault::ReservedName { name: GNSS_ONLY },
            _ => Fault::NotAccepted {
                found: format!("the name {found:?}"),
                accepted: accepted_name(),
            },
        };
        reading.report(node.span(), fault);
    }
    is_accepted
}

fn read_parts(node: &Node<'_>, reading: &mut Reading<'_>) -> Option<ConstellationParts> {
    let Some(table) = node.get_ref().as_table() else {
        let design = Notation.read(node, reading)?;
        return Some(ConstellationParts::of_design(design));
    };
    let parts = Constellations::TABLE.read(node, reading)?;
    if !parts.files.is_empty() {
        return Some(parts);
    }
    let about_files = FILE_KEYS
        .iter()
        .find_map(|key| Some((key, table.get(*key)?)));
    if let Some((key, node)) = about_files {
        let mut reading = reading.within(key, String::new());
        reading.report(node.span(), Fault::NoFiles);
        return None;
    }
    if parts.design.is_none() {
        reading.report(node.span(), Fault::NoSatellites);
        return None;
    }
    Some(parts)
}

/// What a constellation consists of as canonical TOML, but for the paths of its files.
pub(in crate::scenario) fn parts_without_paths(parts: &ConstellationParts) -> String {
    Constellations::TABLE.write(&ConstellationParts {
        files: Vec::new(),
        ..parts.clone()
    })
}

fn write_parts(parts: &ConstellationParts) -> String {
    match &parts.design {
        Some(design) if parts.files.is_empty() => Notation.write(design),
        _ => Constellations::TABLE.write(parts),
    }
}

//! The keys for readers: a commented file to start from, and a JSON schema for editors.

use serde_json::{Map, Value as Json, json};

use super::keys::{all, describe_keys, sections};

/// A commented scenario file with every key, its default, unit, range and meaning. It parses to the
/// defaults; keys whose default depends on others are commented out.
#[must_use]
pub fn template() -> String {
    let mut text = String::from(
        "# A navwalker scenario. Every key is shown with its default: \
         keep what you change, delete the rest.\n",
    );
    let mut section = "";
    for key in describe_keys() {
        if key.section != section {
            section = key.section;
            text.push_str(&format!("\n[{section}]\n"));
        }
        let unit = if key.unit.is_empty() {
            String::new()
        } else {
            format!(", in {}", key.unit)
        };
        text.push_str(&format!(
            "\n# {}.\n# Accepts {}{unit}.\n",
            key.meaning, key.accepted
        ));
        let (name, shown) = (key.name, key.shown);
        text.push_str(&match key.follows {
            None => format!("{name} = {shown}\n"),
            Some(what) => format!("# Default: {what}.\n# {name} = {shown}\n"),
        });
    }
    text
}

/// The JSON schema (draft 2020-12) of a scenario file.
#[must_use]
pub fn json_schema() -> Json {
    let mut properties = section_properties("");
    for section in sections() {
        let schema = json!({
            "type": "object",
            "additionalProperties": false,
            "properties": section_properties(section),
        });
        properties.insert(section.to_owned(), schema);
    }
    json!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "navwalker scenario",
        "type": "object",
        "additionalProperties": false,
        "properties": properties,
    })
}

fn section_properties(section: &str) -> Map<String, Json> {
    let keys = all().iter().filter(|key| key.path.section == section);
    keys.map(|key| (key.path.name.to_owned(), key.schema.clone()))
        .collect()
}

/// The reference of all keys as Markdown, one table for each section.
#[must_use]
pub fn reference_markdown() -> String {
    let mut text = String::new();
    let mut section = None;
    for key in describe_keys() {
        if section != Some(key.section) {
            section = Some(key.section);
            let heading = match key.section {
                "" => "At the top".to_owned(),
                section => format!("`[{section}]`"),
            };
            text.push_str(&format!(
                "\n## {heading}\n\n| key | unit | default | accepts | meaning |\n"
            ));
            text.push_str("|---|---|---|---|---|\n");
        }
        let default = key
            .follows
            .map_or_else(|| format!("`{}`", key.shown), str::to_owned);
        let accepted = key.accepted.replace('|', "\\|");
        let (name, unit, meaning) = (key.name, key.unit, key.meaning);
        text.push_str(&format!(
            "| `{name}` | {unit} | {default} | {accepted} | {meaning} |\n"
        ));
    }
    text
}

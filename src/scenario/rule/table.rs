//! The rule for a table whose keys are those of a section.

use std::collections::BTreeMap;
use std::marker::PhantomData;

use serde_json::{Map, Value as Json, json};

use super::{Node, Reading, Rule};
use crate::keyword::nearest;
use crate::scenario::keys::{Key, Section, Walk, list, paths};
use crate::scenario::problem::Fault;
use crate::scenario::reader::{Given, Reader};

/// A table with the keys of a section, on one line as canonical TOML.
pub(in crate::scenario) struct SectionTable<S>(PhantomData<fn() -> S>);

impl<S> SectionTable<S> {
    pub(in crate::scenario) const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<S: Section> Rule for SectionTable<S> {
    type Value = S;

    fn read(&self, node: &Node<'_>, reading: &mut Reading<'_>) -> Option<S> {
        let Some(table) = node.get_ref().as_table() else {
            reading.refuse(node);
            return None;
        };
        let paths = paths::<S>();
        let known: Vec<&str> = paths.iter().map(|path| path.name).collect();
        let mut given = BTreeMap::new();
        for (name, node) in table.iter() {
            let path = paths.iter().find(|path| path.name == name.get_ref());
            if let Some(path) = path {
                let one = Given {
                    source: reading.source_of(name.get_ref()),
                    parts: reading.parts,
                    node,
                };
                given.insert(*path, one);
            } else {
                let nearest = nearest(name.get_ref(), &known).map(str::to_owned);
                let known = known.clone();
                let mut reading = reading.within(name.get_ref(), String::new());
                reading.report(name.span(), Fault::UnknownKey { nearest, known });
            }
        }
        let all_known = given.len() == table.len();
        let reader = Reader::new(given, reading.source, reading.report);
        let section = reader.of_table(&reading.key).read();
        section.filter(|_| all_known)
    }

    fn accepted(&self) -> String {
        let names: Vec<&str> = paths::<S>().iter().map(|path| path.name).collect();
        format!("a table of {}", names.join(", "))
    }

    fn schema(&self) -> Json {
        let keys = list::<S>().into_iter();
        let properties: Map<String, Json> = keys
            .map(|key| (key.path.name.to_owned(), key.schema))
            .collect();
        json!({ "type": "object", "additionalProperties": false, "properties": properties })
    }

    fn write(&self, value: &S) -> String {
        let mut inline = Inline(Vec::new());
        S::walk(&mut inline, Some(value));
        format!("{{ {} }}", inline.0.join(", "))
    }
}

/// The walk that writes a table on one line.
struct Inline(Vec<String>);

impl Walk for Inline {
    fn key<R: Rule>(&mut self, key: Key<R>, value: Option<&R::Value>) -> R::Value {
        if let Some(value) = value.filter(|value| !key.rule.is_absent(value)) {
            let value = key.rule.write(value);
            self.0.push(format!("{} = {value}", key.path.name));
        }
        key.default
    }
}

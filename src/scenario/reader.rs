//! The second stage: from the document to values, or a list of problems.

use std::collections::{BTreeMap, BTreeSet};

use super::keys::{Key, KeyPath, Section, Walk, path};
use super::problem::{Fault, ProblemList};
use super::rule::{Node, Reading, Rule};
use super::source::{Source, TableSources};

/// The value of a key as written.
#[derive(Clone, Copy)]
pub(super) struct Given<'r> {
    pub(super) source: &'r Source<'r>,
    pub(super) parts: &'r TableSources<'r>,
    pub(super) node: &'r Node<'r>,
}

/// The walk that reads: each key gets the given value, checked, or its default.
pub(super) struct Reader<'r> {
    given: BTreeMap<KeyPath, Given<'r>>,
    /// Where a problem without a given key is reported.
    file: &'r Source<'r>,
    /// The key of the table that is read, if it is not the whole scenario.
    table: Option<String>,
    /// The keys whose values were rejected; they have their defaults.
    wrong: BTreeSet<KeyPath>,
    is_sound: bool,
    report: &'r mut ProblemList,
}

impl<'r> Reader<'r> {
    pub(super) fn new(
        given: BTreeMap<KeyPath, Given<'r>>,
        file: &'r Source<'r>,
        report: &'r mut ProblemList,
    ) -> Self {
        Self {
            given,
            file,
            table: None,
            wrong: BTreeSet::new(),
            is_sound: true,
            report,
        }
    }

    /// The same reader for the keys of a table, which is the value of `key`.
    pub(super) fn of_table(self, key: &str) -> Self {
        Self {
            table: Some(key.to_owned()),
            ..self
        }
    }

    /// The values, unless there are problems, which are then in the report.
    pub(super) fn read<S: Section>(mut self) -> Option<S> {
        let values = S::walk(&mut self, None);
        self.is_sound.then_some(values)
    }

    /// A key as named in a problem.
    fn label(&self, key: KeyPath) -> String {
        match &self.table {
            Some(table) => path(table, key.name),
            None => key.to_string(),
        }
    }

    /// Whether a key was given, valid or not.
    pub(super) fn is_given(&self, key: KeyPath) -> bool {
        self.given.contains_key(&key)
    }

    /// Whether the table at a place of a list lacks a key.
    pub(super) fn is_absent_in(&self, list: KeyPath, place: usize, key: KeyPath) -> bool {
        let given = self.given.get(&list);
        let tables = given.and_then(|given| given.node.get_ref().as_array());
        let table = tables.and_then(|tables| tables.get(place)?.get_ref().as_table());
        table.is_none_or(|table| !table.contains_key(key.name))
    }

    /// Whether a key has its default because its value was rejected.
    pub(super) fn is_wrong(&self, key: KeyPath) -> bool {
        self.wrong.contains(&key)
    }

    /// Whether there are no problems so far.
    pub(super) fn is_sound(&self) -> bool {
        self.is_sound
    }

    /// Reports a problem between several keys: at the first one given by a `--set` argument, else at the
    /// first one given in the file. Not if one of them has a problem of its own.
    pub(super) fn refuse(&mut self, keys: &[KeyPath], fault: Fault) {
        if keys.iter().any(|key| self.is_wrong(*key)) {
            return;
        }
        self.is_sound = false;
        let given = || {
            keys.iter()
                .filter_map(|key| Some((*key, *self.given.get(key)?)))
        };
        let argument = given().find(|(_, given)| !given.source.is_file());
        match argument.or_else(|| given().next()) {
            Some((key, Given { source, node, .. })) => {
                let key = self.label(key);
                self.report.add(source, node.span(), &key, fault);
            }
            None => {
                let key = keys.first().map(|key| self.label(*key)).unwrap_or_default();
                self.report.add(self.file, 0..0, &key, fault);
            }
        }
    }

    /// Reports a problem of one element of a list: at that element if the list is given.
    pub(super) fn refuse_element(&mut self, list: KeyPath, place: usize, fault: Fault) {
        let element = |given: &Given<'r>| {
            Some((
                given.source,
                given.node.get_ref().as_array()?.get(place)?.span(),
            ))
        };
        match self.given.get(&list).and_then(element) {
            Some((source, span)) if !self.is_wrong(list) => {
                self.is_sound = false;
                let key = self.label(list);
                self.report.add(source, span, &key, fault);
            }
            _ => self.refuse(&[list], fault),
        }
    }

    /// Rejects more than `most` of something.
    pub(super) fn at_most(&mut self, most: u64, count: f64, what: &'static str, keys: &[KeyPath]) {
        // A count that overflowed to infinity is too many as well.
        if count > most as f64 {
            self.refuse(keys, Fault::TooMany { what, count, most });
        }
    }
}

impl Walk for Reader<'_> {
    fn key<R: Rule>(&mut self, key: Key<R>, _: Option<&R::Value>) -> R::Value {
        let Some(given) = self.given.get(&key.path).copied() else {
            return key.default;
        };
        let Given {
            source,
            parts,
            node,
        } = given;
        let mut reading = Reading {
            source,
            parts,
            key: self.label(key.path),
            accepted: key.accepted(),
            report: self.report,
        };
        let value = key.rule.read(node, &mut reading);
        value.unwrap_or_else(|| {
            self.is_sound = false;
            self.wrong.insert(key.path);
            key.default
        })
    }

    fn finish<S>(&mut self, mut gathered: S, finish: impl FnOnce(&mut S, &mut Reader<'_>)) -> S {
        finish(&mut gathered, self);
        gathered
    }
}

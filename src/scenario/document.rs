//! The first stage: the document, that is, keys and values as written in a file and then in `--set`
//! arguments.

use std::collections::BTreeMap;
use std::ops::Range;
use std::rc::Rc;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::Scenario;
use super::keys::{KeyPath, all, key, names, path, sections};
use super::problem::{Fault, ProblemList};
use super::reader::{Given, Reader};
use super::rule::Node;
use super::source::{Source, TableSources};
use super::values::{ConstellationParts, INTERVALS, Objectives, SHELLS, rivals};
use crate::keyword::nearest;

/// The known keys that were given; the last of several.
pub(super) struct Document<'a> {
    file: Rc<Source<'a>>,
    entries: BTreeMap<KeyPath, Entry<'a>>,
}

/// One key as written.
struct Entry<'a> {
    source: Rc<Source<'a>>,
    /// What arguments set within a table.
    parts: TableSources<'a>,
    value: Node<'a>,
}

/// The position of a key, while it is being looked up.
struct KeySite<'s, 'a> {
    source: &'s Rc<Source<'a>>,
    span: Range<usize>,
}

impl<'a> Document<'a> {
    /// Reads a file. `None` if it is not TOML; unknown keys are skipped, so that the rest can still be
    /// checked.
    pub(super) fn read(label: &'a str, text: &'a str, report: &mut ProblemList) -> Option<Self> {
        let file = Rc::new(Source::file(label, text));
        let (table, errors) = DeTable::parse_recoverable(text);
        for error in &errors {
            let message = error.message().to_owned();
            let span = error.span().unwrap_or_default();
            report.add(&file, span, "", Fault::Syntax { message });
        }
        if !errors.is_empty() {
            return None;
        }
        let mut document = Self {
            file: Rc::clone(&file),
            entries: BTreeMap::new(),
        };
        for (key, value) in table.into_inner() {
            let site = KeySite {
                source: &file,
                span: key.span(),
            };
            document.enter_top(key.get_ref(), value, &site, report);
        }
        Some(document)
    }

    /// Enters a key at the top of the file, which may be a section.
    fn enter_top(
        &mut self,
        name: &str,
        value: Node<'a>,
        site: &KeySite<'_, 'a>,
        report: &mut ProblemList,
    ) {
        let Some(section) = sections().into_iter().find(|section| *section == name) else {
            return self.enter("", name, value, site, report);
        };
        let DeValue::Table(keys) = value.into_inner() else {
            let known = names(section);
            return site.report(report, name, Fault::NotASection { section, known });
        };
        for (key, value) in keys {
            let site = KeySite {
                source: site.source,
                span: key.span(),
            };
            self.enter(section, key.get_ref(), value, &site, report);
        }
    }

    fn enter(
        &mut self,
        section: &str,
        name: &str,
        value: Node<'a>,
        site: &KeySite<'_, 'a>,
        report: &mut ProblemList,
    ) {
        let Some(key) = find(section, name) else {
            return site.report(report, &path(section, name), unknown(section, name));
        };
        if key == key!(Scenario.constellations) && !site.source.is_file() {
            return self.add_constellations(value, site.source);
        }
        if !site.source.is_file() {
            let rivals = superseded_by(key);
            self.entries
                .retain(|key, entry| !(entry.source.is_file() && rivals.contains(key)));
        }
        self.entries.insert(key, Entry::new(site.source, value));
    }

    /// Adds the constellations of an argument to those given before; one of the same name replaces it.
    fn add_constellations(&mut self, value: Node<'a>, source: &Rc<Source<'a>>) {
        let key = key!(Scenario.constellations);
        let span = value.span();
        match value.into_inner() {
            DeValue::Table(named) => {
                for (name, value) in named {
                    self.add_constellation(name.get_ref(), value, source);
                }
            }
            other => {
                let entry = Entry::new(source, Spanned::new(span, other));
                self.entries.insert(key, entry);
            }
        }
    }

    /// Sets a constellation by its name, or a key of it by `name.key`.
    fn add_constellation(&mut self, path: &str, value: Node<'a>, source: &Rc<Source<'a>>) {
        let key = key!(Scenario.constellations);
        let nothing = || Entry::new(source, Spanned::new(0..0, DeValue::Table(DeTable::new())));
        let entry = self.entries.entry(key).or_insert_with(nothing);
        entry.set(key.name, path, value, source);
    }

    /// Applies the `index`-th `--set` argument.
    pub(super) fn override_with(
        &mut self,
        index: usize,
        argument: &'a str,
        report: &mut ProblemList,
    ) {
        let (key, text) = argument.split_once('=').unwrap_or((argument, ""));
        let text = text.trim();
        let source = Rc::new(Source::argument(index, argument, text));
        let site = KeySite {
            source: &source,
            span: 0..text.len(),
        };
        let key = key.trim();
        if !argument.contains('=') {
            return site.report(report, key, Fault::NotAnAssignment);
        }
        let value = match value(text) {
            Ok(value) => value,
            Err(fault) => return site.report(report, key, fault),
        };
        let Some((section, name)) = key.split_once('.') else {
            return self.enter_top(key, value, &site, report);
        };
        if section == key!(Scenario.constellations).name {
            return self.add_constellation(name, value, &source);
        }
        if let Some((list, place)) = name.split_once('.')
            && let Some(key) = find(section, list).filter(|key| is_list_of_tables(*key))
        {
            return self.set_in_list(key, place, value, &site, report);
        }
        self.enter(section, name, value, &site, report);
    }

    /// Sets a table of a list by its number from 1, or a key of it by `number.key`.
    fn set_in_list(
        &mut self,
        key: KeyPath,
        names: &str,
        value: Node<'a>,
        site: &KeySite<'_, 'a>,
        report: &mut ProblemList,
    ) {
        let (number, name) = match names.split_once('.') {
            Some((number, name)) => (number, Some(name)),
            None => (names, None),
        };
        let not_there = |count| Fault::NoSuchTable {
            found: number.to_owned(),
            count,
        };
        let Some(Entry {
            value: list, parts, ..
        }) = self.entries.get_mut(&key)
        else {
            return site.report(report, &key.to_string(), not_there(0));
        };
        // Anything else was wrong before, and is reported when it is read.
        let DeValue::Array(tables) = list.get_mut() else {
            return;
        };
        let count = tables.len();
        let number = number.parse().unwrap_or(0_usize);
        let place = number.checked_sub(1);
        let Some(table) = place.and_then(|place| tables.get_mut(place)) else {
            return site.report(report, &key.to_string(), not_there(count));
        };
        let place = path(&key.to_string(), &number.to_string());
        let Some(name) = name else {
            let within = format!("{place}.");
            parts.retain(|part, _| !part.starts_with(&within));
            parts.insert(place, Rc::clone(site.source));
            *table = value;
            return;
        };
        if let DeValue::Table(keys) = table.get_mut() {
            parts.insert(path(&place, name), Rc::clone(site.source));
            keys.insert(Spanned::new(0..0, name.to_owned().into()), value);
        }
    }

    /// Checks everything that was written and adds problems to `report`.
    ///
    /// `None` only if something is wrong.
    pub(super) fn read_scenario(&self, report: &mut ProblemList) -> Option<Scenario> {
        self.reader(report).read()
    }

    /// Adds to `report` what is wrong with some keys together, at the place of the first that was
    /// given.
    pub(super) fn refuse(&self, keys: &[KeyPath], fault: Fault, report: &mut ProblemList) {
        self.reader(report).refuse(keys, fault);
    }

    /// Adds to `report` what is wrong with the value that is found by `names` within the table of a key.
    pub(super) fn refuse_within(
        &self,
        key: KeyPath,
        names: &[&str],
        fault: Fault,
        report: &mut ProblemList,
    ) {
        let Some(entry) = self.entries.get(&key) else {
            return self.refuse(&[key], fault, report);
        };
        let mut place = key.to_string();
        let (mut source, mut node) = (&entry.source, &entry.value);
        for name in names {
            let table = node.get_ref().as_table();
            let Some(inner) = table.and_then(|table| table.get(*name)) else {
                break;
            };
            place = path(&place, name);
            source = entry.parts.get(&place).unwrap_or(source);
            node = inner;
        }
        report.add(source, node.span(), &place, fault);
    }

    fn reader<'r>(&'r self, report: &'r mut ProblemList) -> Reader<'r> {
        let given = self.entries.iter();
        let given = given.map(|(path, entry)| (*path, entry.given())).collect();
        Reader::new(given, &self.file, report)
    }
}

impl<'a> Entry<'a> {
    fn new(source: &Rc<Source<'a>>, value: Node<'a>) -> Self {
        Self {
            source: Rc::clone(source),
            parts: TableSources::new(),
            value,
        }
    }

    /// Sets the value at a dotted path within the table of `key`, whose other values stay.
    fn set(&mut self, key: &str, names: &str, value: Node<'a>, source: &Rc<Source<'a>>) {
        let mut place = key.to_owned();
        let mut node = &mut self.value;
        for (depth, name) in names.split('.').enumerate() {
            // A text behind a name is a design.
            if depth > 0 && node.get_ref().is_str() {
                *node = as_table_of_design(node);
            }
            let DeValue::Table(table) = node.get_mut() else {
                // What was given before is wrong, and is reported when it is read.
                return;
            };
            place = path(&place, name);
            let found = table.contains_key(name);
            let name = Spanned::new(0..0, name.to_owned().into());
            let nothing = || Spanned::new(0..0, DeValue::Table(DeTable::new()));
            node = table.entry(name).or_insert_with(nothing);
            if !found {
                self.parts.insert(place.clone(), Rc::clone(source));
            }
        }
        *node = value;
        let within = format!("{place}.");
        self.parts.retain(|part, _| !part.starts_with(&within));
        self.parts.insert(place, Rc::clone(source));
    }

    fn given(&self) -> Given<'_> {
        Given {
            source: &self.source,
            parts: &self.parts,
            node: &self.value,
        }
    }
}

impl KeySite<'_, '_> {
    fn report(&self, report: &mut ProblemList, key: &str, fault: Fault) {
        report.add(self.source, self.span.clone(), key, fault);
    }
}

/// The keys of a file that a `--set` of another key replaces: those of a region that exclude each other,
/// a reference point, which belongs to its list of objectives, and the intervals of one shell by a list of shells.
fn superseded_by(path: KeyPath) -> Vec<KeyPath> {
    if path == key!(Objectives.minimize) {
        vec![key!(Objectives.hypervolume_reference)]
    } else if path == SHELLS {
        INTERVALS.to_vec()
    } else {
        rivals(path)
    }
}

/// The table of a constellation with this design.
fn as_table_of_design<'a>(design: &Node<'a>) -> Node<'a> {
    let name = key!(ConstellationParts.design).name;
    let mut table = DeTable::new();
    table.insert(Spanned::new(0..0, name.into()), design.clone());
    Spanned::new(design.span(), DeValue::Table(table))
}

/// A TOML value, or the text itself if it does not look like one.
fn value(text: &str) -> Result<Node<'_>, Fault> {
    match DeValue::parse(text) {
        Ok(value) => Ok(value),
        Err(error) if text.starts_with(['[', '{', '"', '\'']) => {
            let message = format!("{} (words in a list are quoted)", error.message());
            Err(Fault::Syntax { message })
        }
        Err(_) => Ok(Spanned::new(0..text.len(), DeValue::String(text.into()))),
    }
}

/// Whether the value of a key is a list of tables.
fn is_list_of_tables(path: KeyPath) -> bool {
    let key = all().iter().find(|key| key.path == path);
    key.is_some_and(|key| key.schema["items"]["type"] == "object")
}

fn find(section: &str, name: &str) -> Option<KeyPath> {
    let mut paths = all().iter().map(|key| key.path);
    paths.find(|path| path.section == section && path.name == name)
}

/// The problem of an unknown key, with the key that was most likely meant: the same name in
/// another section, a similar name in this one, a similar name anywhere, or a similar section.
fn unknown(section: &str, name: &str) -> Fault {
    let mut known = names(section);
    if known.is_empty() || section.is_empty() {
        known.extend(sections());
    }
    let section_is_known = section.is_empty() || sections().contains(&section);
    let candidates = if section_is_known {
        known.clone()
    } else {
        Vec::new()
    };
    let elsewhere = |name: &str| {
        let mut paths = all().iter().map(|key| key.path);
        paths
            .find(|path| path.name == name)
            .map(|path| path.to_string())
    };
    let everywhere: Vec<&str> = all().iter().map(|key| key.path.name).collect();
    let nearest = elsewhere(name)
        .or_else(|| nearest(name, &candidates).map(|name| path(section, name)))
        .or_else(|| nearest(name, &everywhere).and_then(elsewhere))
        .or_else(|| {
            nearest(section, &sections())
                .filter(|_| !section_is_known)
                .map(str::to_owned)
        });
    Fault::UnknownKey { nearest, known }
}

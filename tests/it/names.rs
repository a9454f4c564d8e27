//! One name for one thing: no two types of the crate, the program included, share a name.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Names that several modules may declare, each with the reason.
const SHARED: &[(&str, &str)] = &[];

/// Words that the field does not use, with the one that it does.
const AVOIDED: &[(&str, &str)] = &[
    ("fly", "propagate"),
    ("flies", "propagates"),
    ("flown", "propagated"),
    ("flying", "propagating"),
    ("flight", "propagation"),
];

fn sources() -> Vec<(PathBuf, String)> {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut open = vec![src.clone()];
    let mut found = Vec::new();
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(directory).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let text = fs::read_to_string(&path).unwrap();
                found.push((path.strip_prefix(&src).unwrap().to_owned(), text));
            }
        }
    }
    found.sort();
    found
}

fn is_test(path: &Path) -> bool {
    let parts = ["tests", "tests.rs", "testing.rs"];
    path.components()
        .any(|part| parts.iter().any(|name| part.as_os_str() == *name))
}

/// The part of a source file before its own tests.
fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap()
}

/// The types that a source text declares, by keyword or by the `keywords!` macro; associated
/// types of traits are indented and do not count.
fn declared(text: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut in_keywords = false;
    for line in text.lines() {
        if line.starts_with("keywords! {") {
            in_keywords = true;
            continue;
        }
        if in_keywords && line.ends_with('{') {
            names.push(line.trim().trim_end_matches(" {").to_owned());
            in_keywords = false;
            continue;
        }
        let bare = match line.strip_prefix("pub") {
            Some(rest) if rest.starts_with('(') => rest.split_once(") ").map_or("", |(_, r)| r),
            Some(rest) => rest.trim_start(),
            None => line,
        };
        for keyword in ["struct ", "enum ", "trait ", "type "] {
            if let Some(rest) = bare.strip_prefix(keyword) {
                let end = rest.find(|c: char| !c.is_alphanumeric() && c != '_');
                names.push(rest[..end.unwrap_or(rest.len())].to_owned());
            }
        }
    }
    names
}

#[test]
fn every_type_has_a_name_of_its_own() {
    let mut places: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for (path, text) in sources().iter().filter(|(path, _)| !is_test(path)) {
        for name in declared(without_tests(text)) {
            places
                .entry(name)
                .or_default()
                .push(path.display().to_string());
        }
    }
    assert!(places.len() > 300, "only {} types were found", places.len());
    let shared: Vec<_> = places
        .iter()
        .filter(|(name, files)| files.len() > 1 && !SHARED.iter().any(|(known, _)| known == name))
        .collect();
    assert!(shared.is_empty(), "one name, several types: {shared:#?}");
    for (name, reason) in SHARED {
        let count = places.get(*name).map_or(0, Vec::len);
        assert!(
            count > 1 && !reason.is_empty(),
            "{name} is not an exception any longer"
        );
    }
}

#[test]
fn declarations_are_found_in_every_form() {
    let text = "pub struct A;\npub(super) enum B {\ntype C = u8;\nkeywords! {\n    /// Words.\n    D {\n    type Skipped;\npub(in crate::x) trait E {}\n";
    assert_eq!(declared(text), ["A", "B", "C", "D", "E"]);
}

#[test]
fn satellites_are_propagated() {
    for (path, text) in sources() {
        let words = text
            .split(|c: char| !c.is_ascii_alphabetic())
            .map(str::to_ascii_lowercase);
        for word in words {
            let avoided = AVOIDED.iter().find(|(avoided, _)| *avoided == word);
            assert!(
                avoided.is_none(),
                "{}: {word:?}: say {:?}",
                path.display(),
                avoided.map(|(_, better)| better)
            );
        }
    }
}

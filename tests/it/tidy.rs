//! The invariants of `ARCHITECTURE.md`, checked on the source text.

use sha2::{Digest, Sha256};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The modules of the library from the lowest level up; a module imports only from levels before
/// its own, or from its own module.
const LEVELS: &[&[&str]] = &[
    &["units", "keyword", "printable"],
    &["stats", "earth", "time"],
    &["frames"],
    &["orbit"],
    &["constellation"],
    &["ephemeris"],
    &["visibility", "dop"],
    &["ground"],
    &["evaluate"],
    &["optimize"],
    &["search"],
    &["formats"],
    &["exchange"],
    &["scenario"],
    &["study"],
    &["validate"],
    &["run"],
    &["report"],
    &["cli"],
];

/// Lines of a source file before its tests.
const MAX_LINES: usize = 500;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn files_below(directory: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files_below(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// A source file of the library: its module, its path from the root, and its text without tests.
struct Source {
    module: String,
    path: String,
    text: String,
}

fn library() -> Vec<Source> {
    let src = root().join("src");
    let is_test = |path: &Path| {
        path.components()
            .any(|c| c.as_os_str() == "tests" || c.as_os_str() == "tests.rs")
    };
    files_below(&src, "rs")
        .into_iter()
        .filter(|path| path != &src.join("main.rs") && !is_test(path.strip_prefix(&src).unwrap()))
        .map(|path| {
            let relative = path.strip_prefix(&src).unwrap();
            let first = relative
                .components()
                .next()
                .unwrap()
                .as_os_str()
                .to_string_lossy();
            let text = fs::read_to_string(&path).unwrap();
            Source {
                module: first.trim_end_matches(".rs").to_owned(),
                path: relative.display().to_string(),
                text: text
                    .split("#[cfg(test)]\nmod tests {")
                    .next()
                    .unwrap()
                    .to_owned(),
            }
        })
        .collect()
}

fn level(module: &str) -> usize {
    let found = LEVELS.iter().position(|modules| modules.contains(&module));
    found.unwrap_or_else(|| panic!("module {module} has no level in this table"))
}

/// The modules that a text names behind `crate::`, in `use` lists too.
fn imports(text: &str) -> BTreeSet<String> {
    let code: String = text
        .lines()
        .filter(|l| !l.trim_start().starts_with("//"))
        .collect::<Vec<_>>()
        .join("\n");
    let mut found = BTreeSet::new();
    for (at, _) in code.match_indices("crate::") {
        let rest = &code[at + "crate::".len()..];
        // `use crate::{a, b::c};` names several at once; anything else names one.
        let list = rest
            .strip_prefix('{')
            .map_or(rest, |list| &list[..list.find("};").unwrap_or(0)]);
        let names = if rest.starts_with('{') {
            list.split(',').collect()
        } else {
            vec![rest]
        };
        for name in names {
            let end = |c: char| !(c.is_ascii_lowercase() || c == '_' || c.is_ascii_digit());
            let name = name.trim();
            found.insert(name[..name.find(end).unwrap_or(name.len())].to_owned());
        }
    }
    found.remove("");
    found
}

#[test]
fn imports_go_to_lower_levels_only() {
    for source in library().iter().filter(|source| source.module != "lib") {
        let own = level(&source.module);
        for import in imports(&source.text) {
            let allowed = import == source.module || level(&import) < own;
            assert!(
                allowed,
                "{} imports {import}, which is not below it",
                source.path
            );
        }
    }
}

#[test]
fn every_module_has_a_level() {
    let modules: BTreeSet<String> = library()
        .into_iter()
        .map(|source| source.module)
        .filter(|module| module != "lib")
        .collect();
    let levels: BTreeSet<String> = LEVELS.concat().into_iter().map(str::to_owned).collect();
    assert_eq!(modules, levels);
}

#[test]
fn imports_are_found_in_every_spelling() {
    let text = "use crate::earth::J2;\nuse crate::{stats, time::Epoch};\nlet x = crate::orbit::f();\n// crate::report";
    let found: Vec<String> = imports(text).into_iter().collect();
    assert_eq!(found, ["earth", "orbit", "stats", "time"]);
}

#[test]
fn physical_constants_live_in_earth_alone() {
    for source in library().iter().filter(|source| source.module != "earth") {
        let code: Vec<&str> = source
            .text
            .lines()
            .filter(|l| !l.trim_start().starts_with("//"))
            .collect();
        for constant in [
            "6378", "6_378", "398600", "398_600", "7.2921", "7.292_1", "1.0826", "1.082_6",
        ] {
            let found = code.iter().find(|line| line.contains(constant));
            assert!(
                found.is_none(),
                "{} writes {constant}: {found:?}",
                source.path
            );
        }
    }
}

#[test]
fn files_stay_readable() {
    let src = root().join("src");
    for path in files_below(&src, "rs") {
        let text = fs::read_to_string(&path).unwrap();
        let lines = text
            .split("#[cfg(test)]\nmod tests {")
            .next()
            .unwrap()
            .lines()
            .count();
        assert!(
            lines <= MAX_LINES,
            "{} has {lines} lines before its tests",
            path.display()
        );
    }
}

#[derive(serde::Deserialize)]
struct Manifest {
    file: Vec<Entry>,
}

#[derive(serde::Deserialize)]
struct Entry {
    path: String,
    what: String,
    source: String,
    licence: String,
    sha256: String,
}

/// Data that the tests hold against us: nothing unlisted, nothing changed since it was recorded.
#[test]
fn validation_cases_are_listed_with_their_checksums() {
    check_manifest("validation", &["cases"]);
}

/// Data of others that the program and its examples carry.
#[test]
fn data_of_others_are_listed_with_their_checksums() {
    let folders = [
        "almanacs",
        "coastline",
        "countries",
        "earth-rotation",
        "atmosphere",
        "typeface",
    ];
    check_manifest("data", &folders);
}

/// Holds the files of folders against the manifest above them.
fn check_manifest(above: &str, folders: &[&str]) {
    let above = root().join(above);
    let text = fs::read_to_string(above.join("MANIFEST.toml")).unwrap();
    let manifest: Manifest = toml::from_str(&text).unwrap();
    let mut listed = BTreeSet::new();
    for entry in &manifest.file {
        let bytes = fs::read(above.join(&entry.path)).unwrap();
        let sum: String = Sha256::digest(&bytes)
            .iter()
            .map(|b| format!("{b:02x}"))
            .collect();
        assert_eq!(sum, entry.sha256, "{} is not what was recorded", entry.path);
        assert!(
            ![&entry.what, &entry.source, &entry.licence]
                .iter()
                .any(|text| text.is_empty())
        );
        listed.insert(above.join(&entry.path));
    }
    let mut present = BTreeSet::new();
    for folder in folders {
        collect(&above.join(folder), &mut present);
    }
    assert_eq!(present, listed);
}

fn collect(directory: &Path, found: &mut BTreeSet<PathBuf>) {
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, found);
        } else {
            found.insert(path);
        }
    }
}

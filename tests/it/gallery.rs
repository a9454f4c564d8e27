//! The committed gallery of exports is what the program writes today.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// The files below a directory by their paths, without the script that makes them.
fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut left = vec![directory.to_owned()];
    while let Some(next) = left.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                left.push(path);
            } else if path.extension().is_none_or(|extension| extension != "sh") {
                let name = path.strip_prefix(directory).unwrap();
                found.insert(name.display().to_string(), fs::read(&path).unwrap());
            }
        }
    }
    found
}

#[test]
fn regress_the_gallery_of_exports() {
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("validation/exports");
    let made = TempDir::new().unwrap();
    let script = Command::new("sh")
        .arg(gallery.join("make.sh"))
        .arg(assert_cmd::cargo::cargo_bin("navwalker"))
        .arg(made.path())
        .output()
        .unwrap();
    let stderr = String::from_utf8_lossy(&script.stderr);
    assert!(script.status.success(), "{stderr}");
    let (expected, found) = (files(&gallery), files(made.path()));
    let names = |of: &BTreeMap<String, Vec<u8>>| of.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&found), names(&expected));
    for (name, bytes) in &expected {
        let line = |bytes: &[u8]| {
            let text = String::from_utf8_lossy(bytes);
            text.lines().map(str::to_owned).collect::<Vec<_>>()
        };
        // The first line that differs says more than two files.
        for (at, (one, other)) in line(&found[name]).iter().zip(line(bytes)).enumerate() {
            assert_eq!(*one, other, "{name}, line {}", at + 1);
        }
        assert_eq!(found[name], *bytes, "{name}");
    }
    let size: usize = expected.values().map(Vec::len).sum();
    assert!(size < 400_000, "the gallery has {size} bytes");
}

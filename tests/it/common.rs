//! What several tests do: start the program without waiting for it, and look at all files that it leaves.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// Starts the program; both of its streams go to `streams`.
pub(crate) fn started(directory: &Path, arguments: &[&str], streams: fn() -> Stdio) -> Child {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("navwalker"));
    command.current_dir(directory).args(arguments);
    command.stdout(streams()).stderr(streams());
    command.spawn().unwrap()
}

/// Sends a signal, such as `INT`.
#[cfg(unix)]
pub(crate) fn signal(child: &Child, name: &str) {
    let kill = ["-s", name, &child.id().to_string()].map(str::to_owned);
    assert!(Command::new("kill").args(kill).status().unwrap().success());
}

/// All files below a directory with their contents, by their paths from it; what says by which command they were made is left
/// out.
pub(crate) fn contents(directory: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut waiting = vec![directory.to_owned()];
    while let Some(next) = waiting.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                waiting.push(path);
            } else if !path.ends_with("provenance.json") {
                let name = path.strip_prefix(directory).unwrap().to_owned();
                found.insert(name, fs::read(path).unwrap());
            }
        }
    }
    found
}

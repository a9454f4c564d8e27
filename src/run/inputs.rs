//! The inputs of a self-contained run: copies of the files that its scenario names, with checksums.

use super::checkpoint::{Identity, hex_sha256};
use super::{INPUTS, MANIFEST, PROVENANCE, SCENARIO};
use crate::printable::is_obeyed;
use crate::scenario::Scenario;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// The manifest `run.json`, written when a run starts.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunManifest {
    /// The study of the run.
    #[serde(flatten)]
    pub identity: Identity,
    /// The file beside it that says which build and command made the run; `None` for a run from before there was one.
    #[serde(default)]
    pub provenance: Option<String>,
    /// The copies of the scenario's files, in the order of [`Scenario::files`].
    pub inputs: Vec<InputCopy>,
}

/// A copy of a file that the scenario names.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputCopy {
    /// Path from the run directory, with `/`.
    pub path: String,
    /// SHA-256 of the contents, hex.
    pub sha256: String,
}

/// The reason why a file of a run is rejected.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum InputError {
    /// The contents differ from those used by the run.
    #[error("{path}: checksum mismatch: the file has changed since the run was made")]
    Changed {
        /// Path from the run directory.
        path: String,
    },
    /// A file missing from the manifest.
    #[error("{path}: {MANIFEST} does not list it, so it is not a file of this run")]
    Unlisted {
        /// Path as given in the scenario.
        path: String,
    },
}

impl RunManifest {
    /// Reads `run.json`.
    ///
    /// # Errors
    /// If the bytes are not a run manifest.
    pub fn read(bytes: &[u8]) -> serde_json::Result<Self> {
        serde_json::from_slice(bytes)
    }

    /// Checks the contents of a file that the run's scenario names.
    ///
    /// # Errors
    /// If the run has no such file, or its contents differ.
    pub fn check(&self, path: &str, contents: &[u8]) -> Result<(), InputError> {
        let path = path.to_owned();
        match self.inputs.iter().find(|input| input.path == path) {
            None => Err(InputError::Unlisted { path }),
            Some(input) if !input.is_of(contents) => Err(InputError::Changed { path }),
            Some(_) => Ok(()),
        }
    }
}

impl InputCopy {
    /// Whether the copy has these contents.
    #[must_use]
    pub fn is_of(&self, contents: &[u8]) -> bool {
        self.sha256 == hex_sha256(contents)
    }
}

/// Relative paths of the copies of `files` in a run: a folder for each, so that every file keeps its
/// name, which also names its GNSS.
#[must_use]
pub fn copy_paths(files: &[&str]) -> Vec<String> {
    let numbered = (1..).zip(files);
    numbered
        .map(|(n, file)| format!("{INPUTS}/{n}/{}", safe_name(file)))
        .collect()
}

/// The last part of a path, with characters that some file systems refuse replaced.
fn safe_name(path: &str) -> String {
    let name = path.rsplit('/').next().unwrap_or_default();
    let refused = |c: char| is_obeyed(c) || "\\:*?\"<>|".contains(c);
    let name = name.replace(refused, "_");
    let is_hidden_or_parent = name.trim_start_matches('.').is_empty();
    if is_hidden_or_parent {
        return "file".to_owned();
    }
    match name.strip_suffix(['.', ' ']) {
        Some(stem) => format!("{stem}_"),
        None => name,
    }
}

/// The files that a run begins with, by their paths in its directory: the copies of the scenario's
/// files, of which these are the `contents`; the scenario, which names the copies; the manifest.
///
/// # Errors
/// Never for contents in memory.
pub fn first_files(
    scenario: &Scenario,
    contents: &[Vec<u8>],
    identity: &Identity,
) -> serde_json::Result<Vec<(String, Vec<u8>)>> {
    let paths = copy_paths(&scenario.files());
    let copy = |(path, bytes): (&String, &Vec<u8>)| InputCopy {
        path: path.clone(),
        sha256: hex_sha256(bytes),
    };
    let manifest = RunManifest {
        identity: identity.clone(),
        provenance: Some(PROVENANCE.to_owned()),
        inputs: paths.iter().zip(contents).map(copy).collect(),
    };
    let manifest = crate::printable::json(&manifest)? + "\n";
    let toml = scenario.with_files(&paths).to_toml();
    let mut files: Vec<_> = paths.into_iter().zip(contents.iter().cloned()).collect();
    files.push((SCENARIO.to_owned(), toml.into_bytes()));
    files.push((MANIFEST.to_owned(), manifest.into_bytes()));
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn copies_keep_their_names_and_never_meet() {
        let files = [
            "/home/a/gps.tle",
            "b/gps.tle",
            "GPS.TLE",
            "..",
            "a:b.",
            "é x.csv",
        ];
        let expected = [
            "inputs/1/gps.tle",
            "inputs/2/gps.tle",
            "inputs/3/GPS.TLE",
            "inputs/4/file",
            "inputs/5/a_b_",
            "inputs/6/é x.csv",
        ];
        assert_eq!(copy_paths(&files), expected);
        // Copies of copies keep their paths.
        assert_eq!(copy_paths(&expected), expected);
    }

    #[test]
    fn a_changed_copy_and_a_file_from_elsewhere_are_refused() {
        let manifest = RunManifest {
            identity: Identity {
                scenario_hash: "h".to_owned(),
                seed: 1,
                version: "v".to_owned(),
                given: Vec::new(),
            },
            provenance: None,
            inputs: vec![InputCopy {
                path: "inputs/1/p.csv".to_owned(),
                sha256: hex_sha256(b"points"),
            }],
        };
        let text = serde_json::to_vec(&manifest).unwrap();
        let manifest = RunManifest::read(&text).unwrap();
        assert_eq!(manifest.check("inputs/1/p.csv", b"points"), Ok(()));
        let changed = manifest.check("inputs/1/p.csv", b"Points").unwrap_err();
        assert!(
            changed.to_string().contains("checksum mismatch"),
            "{changed}"
        );
        let path = "../p.csv".to_owned();
        let unlisted = manifest.check(&path, b"points");
        assert_eq!(unlisted, Err(InputError::Unlisted { path }));
    }
}

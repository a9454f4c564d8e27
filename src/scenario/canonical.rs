//! The canonical text of a scenario, and its hash.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::keys::{Key, KeyPath, Section, Walk, key};
use super::rule::Rule;
use super::values::{Export, GnssSetup, Optimizer, PointsFile, Region, Scenario};

impl Scenario {
    /// The scenario as TOML with every key, including defaults, in a fixed order and spelling. It parses back to the same scenario.
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.canonical(|_| true)
    }

    /// Identifies what is computed: SHA-256, in hex, of [`Scenario::to_toml`] and of the SHA-256 of
    /// each file that the scenario names, whose `contents` are in the order of [`Scenario::files`].
    ///
    /// Not included are names and labels (`name`, `[export]` and the paths of files), and
    /// `optimizer.generations`, because a search that continues is the same search.
    #[must_use]
    pub fn hash(&self, contents: &[&[u8]]) -> String {
        let mut hash = Sha256::new_with_prefix(self.canonical(is_computed));
        for content in contents {
            hash.update(Sha256::digest(content));
        }
        let mut hex = String::new();
        for byte in hash.finalize() {
            // Writing to a String does not fail.
            let _ = write!(hex, "{byte:02x}");
        }
        hex
    }

    /// The paths of the files that the scenario refers to, as written: the points, then the GNSS
    /// files in their order.
    #[must_use]
    pub fn files(&self) -> Vec<&str> {
        let points = match &self.region {
            Region::Grid(_) => None,
            Region::Points { file } => Some(file),
        };
        points
            .into_iter()
            .chain(&self.gnss.files)
            .map(String::as_str)
            .collect()
    }

    fn canonical(&self, wanted: fn(KeyPath) -> bool) -> String {
        let mut writer = Writer {
            wanted,
            section: "",
            text: String::new(),
        };
        Self::walk(&mut writer, Some(self));
        writer.text
    }
}

/// Whether results depend on the text of a key.
fn is_computed(path: KeyPath) -> bool {
    let left_out = [
        key!(Scenario.name),
        key!(PointsFile.points),
        key!(GnssSetup.files),
        key!(Optimizer.generations),
    ];
    path.section != Export::SECTION && !left_out.contains(&path)
}

/// The walk that writes the values.
struct Writer {
    wanted: fn(KeyPath) -> bool,
    /// The section of the last key.
    section: &'static str,
    text: String,
}

impl Walk for Writer {
    fn key<R: Rule>(&mut self, key: Key<R>, value: Option<&R::Value>) -> R::Value {
        let KeyPath { section, name } = key.path;
        let value = value.filter(|value| (self.wanted)(key.path) && !key.rule.is_absent(value));
        if let Some(value) = value {
            if section != self.section {
                self.section = section;
                self.text.push_str(&format!("\n[{section}]\n"));
            }
            let value = key.rule.write(value);
            self.text.push_str(&format!("{name} = {value}\n"));
        }
        key.default
    }
}

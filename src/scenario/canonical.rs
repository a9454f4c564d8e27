//! The canonical text of a scenario, and its hash.

use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::keys::{AnyKey, table::KEYS};
use super::resolved::{Region, Scenario};

impl Scenario {
    /// The scenario as TOML with every key that it has, defaults included, in a fixed order and
    /// spelling. It parses back to the same scenario.
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.canonical(|_| true)
    }

    /// Identifies what is computed: SHA-256, in hex, of [`Scenario::to_toml`] without the keys that
    /// only name and label (`name` and `[export]`). Seed and optimizer are part of it.
    ///
    /// The contents of the files that the scenario refers to are not; see
    /// [`Scenario::hash_with_files`].
    #[must_use]
    pub fn hash(&self) -> String {
        self.hash_with_files(&[])
    }

    /// As [`Scenario::hash`], and of the SHA-256 of every file's contents, in the order of
    /// [`Scenario::files`].
    #[must_use]
    pub fn hash_with_files(&self, contents: &[&[u8]]) -> String {
        let computed = |key: &dyn AnyKey| key.section() != "export" && key.path() != "name";
        let mut hash = Sha256::new_with_prefix(self.canonical(computed));
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

    fn canonical(&self, wanted: impl Fn(&dyn AnyKey) -> bool) -> String {
        let mut text = String::new();
        let mut section = "";
        for key in KEYS.iter().filter(|key| wanted(**key)) {
            let Some(value) = key.written(self) else {
                continue;
            };
            if key.section() != section {
                section = key.section();
                text.push_str(&format!("\n[{section}]\n"));
            }
            text.push_str(&format!("{} = {value}\n", key.name()));
        }
        text
    }
}

//! The canonical text of a scenario, and its hash.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use sha2::{Digest, Sha256};

use super::keys::{Key, KeyPath, Section, Walk, key};
use super::rule::{Rule, parts_without_paths};
use super::values::{
    AreaSource, Export, GnssSetup, NamedConstellation, Optimizer, Region, RegionKeys,
    RegionTerrain, RegionWeightGrid, SatelliteOutages, Scenario,
};
use crate::constellation::Design;

impl Scenario {
    /// The scenario as TOML with every key, including defaults, in a fixed order and spelling. It parses back to the same scenario.
    #[must_use]
    pub fn to_toml(&self) -> String {
        self.canonical(|_| true)
    }

    /// Identifies what is computed: SHA-256, in hex, of [`Scenario::to_toml`] and of the SHA-256 of
    /// each file that results depend on; `contents` are in the order of [`Scenario::files`].
    ///
    /// Not included are names and labels (`name`, `[export]` and the paths of files), `optimizer.generations`,
    /// because a search that continues is the same search, and `[constellations]` with its files, because what
    /// a front is compared with does not change it. A `reference-design` given by name counts as its design.
    #[must_use]
    pub fn hash(&self, contents: &[&[u8]]) -> String {
        let mut hash = Sha256::new_with_prefix(self.resolved().canonical(is_computed));
        for content in contents.iter().take(self.computed_files()) {
            hash.update(Sha256::digest(content));
        }
        let mut hex = String::new();
        for byte in hash.finalize() {
            // Writing to a String does not fail.
            let _ = write!(hex, "{byte:02x}");
        }
        hex
    }

    /// The paths of the files that the scenario refers to, as written: that of the region, its weights, the terrain, the GNSS files in
    /// their order, those of outages, then those of each constellation, the one that is fixed in the search before the others.
    #[must_use]
    pub fn files(&self) -> Vec<&str> {
        let (fixed, compared) = self
            .constellations
            .iter()
            .partition(|one| self.is_fixed(one));
        let named: [Vec<&NamedConstellation>; 2] = [fixed, compared];
        self.region
            .file()
            .into_iter()
            .chain(&self.weighting.weight_grid)
            .chain(&self.terrain.terrain)
            .chain(&self.gnss.files)
            .chain(&self.outages.file)
            .chain(named.into_iter().flatten().flat_map(|one| &one.parts.files))
            .map(String::as_str)
            .collect()
    }

    /// Whether a constellation is part of every design of the search.
    fn is_fixed(&self, one: &NamedConstellation) -> bool {
        self.search.fixed.as_ref() == Some(&one.name)
    }

    /// How many of [`Scenario::files`] results depend on: all but those of constellations that are not fixed in the
    /// search, which are the last.
    #[must_use]
    pub fn computed_files(&self) -> usize {
        let compared = self.constellations.iter().filter(|one| !self.is_fixed(one));
        let compared: usize = compared.map(|one| one.parts.files.len()).sum();
        self.files().len() - compared
    }

    /// The same scenario with other paths to its files, in the order of [`Scenario::files`]. Its
    /// hash is the same.
    #[must_use]
    pub fn with_files(&self, paths: &[String]) -> Self {
        let mut scenario = self.clone();
        let mut paths = paths.iter().cloned();
        let (fixed, compared) = scenario
            .constellations
            .iter_mut()
            .partition(|one| self.is_fixed(one));
        let named: [Vec<&mut NamedConstellation>; 2] = [fixed, compared];
        let constellations = named.into_iter().flatten();
        let named = scenario
            .region
            .file_mut()
            .into_iter()
            .chain(&mut scenario.weighting.weight_grid)
            .chain(&mut scenario.terrain.terrain)
            .chain(&mut scenario.gnss.files)
            .chain(&mut scenario.outages.file)
            .chain(constellations.flat_map(|one| &mut one.parts.files));
        for (file, path) in named.zip(&mut paths) {
            *file = path;
        }
        scenario
    }

    /// The computed keys whose values differ in `other`, paths of files left out.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<KeyDifference> {
        let values = |scenario: &Self| {
            let mut values = Values::default();
            Self::walk(&mut values, Some(&scenario.resolved()));
            values.0
        };
        let (ours, theirs) = (values(self), values(other));
        let keys: BTreeSet<KeyPath> = ours.keys().chain(theirs.keys()).copied().collect();
        keys.into_iter()
            .filter(|key| is_computed(*key) && ours.get(key) != theirs.get(key))
            .map(|key| KeyDifference {
                key: key.to_string(),
                value: ours.get(&key).cloned(),
                other: theirs.get(&key).cloned(),
            })
            .collect()
    }

    /// The same scenario with its reference design as a notation, if it is given by name, and with what is behind the
    /// name of what is fixed in the search, but for the paths of its files.
    fn resolved(&self) -> Self {
        let mut scenario = self.clone();
        let is_notation = self.reference_design.parse::<Design>().is_ok();
        if let (false, Ok(design)) = (is_notation, self.design(&self.reference_design)) {
            scenario.reference_design = design.to_string();
        }
        if let Ok(Some(fixed)) = self.fixed() {
            scenario.search.fixed = Some(match fixed.only_design() {
                Some(design) => design.to_string(),
                None => parts_without_paths(&fixed.parts),
            });
        }
        scenario
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

impl Region {
    /// The file that it is read from.
    pub(super) fn file(&self) -> Option<&String> {
        match self {
            Self::Points { file }
            | Self::Area {
                source: AreaSource::Polygon { file },
                ..
            } => Some(file),
            _ => None,
        }
    }

    fn file_mut(&mut self) -> Option<&mut String> {
        match self {
            Self::Points { file }
            | Self::Area {
                source: AreaSource::Polygon { file },
                ..
            } => Some(file),
            _ => None,
        }
    }
}

/// A key whose values differ between two scenarios.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyDifference {
    /// The key as `section.key`.
    pub key: String,
    /// Its value as TOML; `None` if it has none.
    pub value: Option<String>,
    /// Its value in the other scenario.
    pub other: Option<String>,
}

/// Whether results depend on the text of a key.
fn is_computed(path: KeyPath) -> bool {
    let left_out = [
        key!(Scenario.name),
        key!(Scenario.constellations),
        key!(RegionKeys.points),
        key!(RegionKeys.polygon),
        key!(RegionWeightGrid.weight_grid),
        key!(RegionTerrain.terrain),
        key!(GnssSetup.files),
        key!(SatelliteOutages.file),
        key!(Optimizer.generations),
    ];
    path.section != Export::SECTION && !left_out.contains(&path)
}

/// The walk that collects the values as TOML.
#[derive(Default)]
struct Values(BTreeMap<KeyPath, String>);

impl Walk for Values {
    fn key<R: Rule>(&mut self, key: Key<R>, value: Option<&R::Value>) -> R::Value {
        if let Some(value) = value.filter(|value| !key.rule.is_absent(value)) {
            self.0.insert(key.path, key.rule.write(value));
        }
        key.default
    }
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

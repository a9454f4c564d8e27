//! Constellations by name.

use crate::constellation::Design;
use crate::exchange::lint::Format;
use crate::scenario::keys::section;
use crate::scenario::rule::{Notation, OneOf, Optional, Texts};

/// A constellation that the scenario names.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedConstellation {
    /// Its name: letters, digits, `-` and `_`.
    pub name: String,
    /// What it consists of.
    pub parts: ConstellationParts,
}

section! {
    /// What a constellation consists of: the shells of a design, satellites from files, or both.
    #[derive(Debug, Clone, PartialEq)]
    pub struct ConstellationParts in "constellations" {
        /// Shells, in Walker notation.
        pub design: Option<Design> = Optional(Notation), follows "no shells", example None;
        /// Files, not directories, in any format that `evaluate --constellation` reads; paths relative to this file.
        pub files: Vec<String> = Texts::one_or_more("paths"), follows "no files", example Vec::new();
        /// Format of the files instead of the one that their content shows.
        pub input_format: Option<Format> = Optional(OneOf::new()), follows "by content", example None;
        /// Satellites of the files to keep: names, designators, catalogue numbers, or patterns with `*` and `?`.
        pub only: Vec<String> = Texts::one_or_more("satellites or patterns"), follows "all", example Vec::new();
        /// Satellites of the files to leave out, named as for only.
        pub exclude: Vec<String> = Texts::one_or_more("satellites or patterns"), follows "none", example Vec::new();
    }
}

impl NamedConstellation {
    /// The design, if the constellation has no other satellites.
    #[must_use]
    pub fn only_design(&self) -> Option<&Design> {
        let parts = &self.parts;
        parts.design.as_ref().filter(|_| parts.files.is_empty())
    }

    /// What the template of a scenario shows.
    pub(super) fn examples() -> Vec<Self> {
        let hybrid = "delta:53:160/10/1@1000+star:90:40/5/1@1100".parse();
        let hybrid = hybrid.ok().map(ConstellationParts::of_design);
        let iridium = ConstellationParts::of_files(vec!["iridium.tle".to_owned()]);
        let named = [("hybrid", hybrid), ("iridium", Some(iridium))];
        let example = |(name, parts): (&str, Option<ConstellationParts>)| {
            let name = name.to_owned();
            parts.map(|parts| Self { name, parts })
        };
        named.into_iter().filter_map(example).collect()
    }
}

impl ConstellationParts {
    /// The shells of a design.
    #[must_use]
    pub fn of_design(design: Design) -> Self {
        Self {
            design: Some(design),
            ..Self::of_files(Vec::new())
        }
    }

    /// All satellites of these files.
    #[must_use]
    pub fn of_files(files: Vec<String>) -> Self {
        Self {
            design: None,
            files,
            input_format: None,
            only: Vec::new(),
            exclude: Vec::new(),
        }
    }
}

//! Scenarios: a study as written in a TOML file, and as validated.
//!
//! [`Scenario::parse`] goes in two stages. The first keeps what was written, key by key with its
//! place, and merges `--set` arguments over it. The second checks types, ranges and what keys say
//! together, fills in the defaults, and gives a [`Scenario`] in which nothing is left open, or
//! all [`Problems`] at once. Each key is declared once, in `scenario/values/`, and that declaration
//! drives both, and the template, the JSON schema and the canonical form too.
//!
//! ```
//! use navwalker::scenario::{Scenario, builtin};
//!
//! let paper = builtin("paper")?;
//! let scenario = Scenario::parse("paper", paper.as_bytes(), &["visibility.mask-deg=10"])?;
//! assert_eq!(scenario.visibility.gnss_mask_deg, 10.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod algorithm;
mod builtin;
mod canonical;
mod constellations;
mod document;
mod gnss_file;
mod keys;
mod number;
mod outage_files;
mod places;
mod problem;
mod reader;
mod rule;
mod setup;
mod source;
mod template;
mod values;

#[cfg(test)]
mod tests;

pub use crate::constellation::Pattern;
pub use crate::constellation::gnss::Preset;
pub use crate::dop::{Clocks, LeoClocks, ObservationWeights};
pub use crate::earth::Surface;
pub use crate::ground::PointWeights;
pub use crate::keyword::{Keyword, UnknownKeyword};
pub use crate::orbit::Model;
pub use crate::search::{Constraint, ConstraintError, LaunchCost, Quantity, Relation};
pub use algorithm::Algorithm;
pub use builtin::{builtin, builtin_names};
pub use canonical::KeyDifference;
pub use constellations::{ConstellationFileError, NoDesign};
pub use keys::{KeyDescription, describe_keys};
pub use problem::{Fault, Problems, ScenarioProblem};
pub use setup::SetupError;
pub use source::{Excerpt, Place};
pub use template::{json_schema, reference_markdown, template};
pub use values::{
    AreaSource, ConstellationParts, Earth, Export, FurtherMetrics, GnssSetup, Grid, MaskPoint,
    NamedConstellation, Objectives, Optimizer, Propagation, RangeErrors, Region, RegionTerrain,
    RegionWeightGrid, Reliability, SatelliteOutages, Scenario, SearchShells, SearchSpace, TimeSpan,
    Visibility,
};

use document::Document;
use problem::ProblemList;
use source::Source;

impl Scenario {
    /// Parses and validates the bytes of a scenario file, with `--set` arguments
    /// (`key.path=value`) merged over it in their order. `label` names the file in problems.
    ///
    /// The value of an argument is TOML, or else a bare text. An argument that gives a region of another kind, or a list
    /// of objectives, replaces that region, or the reference point, of the file.
    ///
    /// # Errors
    /// Everything that is wrong (the first thousand), each with its place, key, what was found and what is accepted. Text
    /// that is not TOML hides what is wrong beyond its syntax.
    pub fn parse<S: AsRef<str>>(
        label: &str,
        bytes: &[u8],
        overrides: &[S],
    ) -> Result<Self, Problems> {
        let mut report = ProblemList::default();
        let document = document(label, bytes, overrides, &mut report);
        match document.and_then(|document| document.read_scenario(&mut report)) {
            Some(scenario) if report.is_empty() => Ok(scenario),
            _ => Err(report.into()),
        }
    }

    /// What `error` means in the text of this scenario: the problem at the key that is behind it.
    /// The arguments are those of [`Scenario::parse`].
    pub fn setup_problem<S: AsRef<str>>(
        label: &str,
        bytes: &[u8],
        overrides: &[S],
        error: &SetupError,
    ) -> Problems {
        let mut report = ProblemList::default();
        if let Some(document) = document(label, bytes, overrides, &mut report) {
            let fault = Fault::SetUp {
                reason: error.reason(),
            };
            match error {
                SetupError::Constellation { name, .. } => {
                    let key = keys::key!(Scenario.constellations);
                    document.refuse_within(key, &[name, "files"], fault, &mut report);
                }
                _ => document.refuse(&error.keys(), fault, &mut report),
            }
        }
        report.into()
    }
}

/// The keys of a file with those of `--set` arguments over them.
fn document<'a, S: AsRef<str>>(
    label: &'a str,
    bytes: &'a [u8],
    overrides: &'a [S],
    report: &mut ProblemList,
) -> Option<Document<'a>> {
    let text = decode(label, bytes, report)?;
    let mut document = Document::read(label, text, report)?;
    for (index, argument) in overrides.iter().enumerate() {
        document.override_with(index, argument.as_ref(), report);
    }
    Some(document)
}

fn decode<'a>(label: &str, bytes: &'a [u8], report: &mut ProblemList) -> Option<&'a str> {
    let error = match std::str::from_utf8(bytes) {
        Ok(text) => return Some(text),
        Err(error) => error,
    };
    let valid = bytes.split_at(error.valid_up_to()).0;
    let text = std::str::from_utf8(valid).unwrap_or_default();
    let end = text.len()..text.len();
    report.add(&Source::file(label, text), end, "", Fault::NotUtf8);
    None
}

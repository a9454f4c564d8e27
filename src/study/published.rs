//! Published numbers as data: a study in TOML, computed and judged statement by statement.
//!
//! A study says under which scenario which constellations have which values, with the source of each. What it does
//! not say of the scenario has the default of every scenario. `docs/studies.md` describes the form.

mod builtin;
mod measured;
mod metric;
mod parse;
mod run;
mod sky;

pub use builtin::{builtin_studies, builtin_study};
pub use metric::{
    DilutionKind, OrbitQuantity, SampleStatistic, SpreadQuantity, StudyMetric, UnknownMetric,
};
pub use parse::StudyFileError;
pub use run::{JudgedStatement, JudgedStudy, StudyRunError};
use sky::StudySky;

use super::judge::{Expected, Provenance};

/// A published study.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedStudy {
    /// Its name, as given to `reproduce`.
    pub name: String,
    /// What it is, in a line.
    pub title: String,
    /// Where the numbers are from.
    pub source: String,
    /// What is known about the numbers and the assumptions, in sentences.
    pub notes: Vec<String>,
    /// The file as named in messages, or the name of a built-in study.
    label: String,
    /// The keys of its scenario that are not the defaults.
    scenario: StudyKeys,
    /// Skies that statements are about.
    skies: Vec<StudySky>,
    /// What else may be assumed where the source does not say.
    assumptions: Vec<StudyAssumption>,
    /// The statements, at least one.
    pub statements: Vec<PublishedStatement>,
}

/// Keys of a scenario in a study, as for `--set`.
#[derive(Debug, Clone, PartialEq, Default)]
struct StudyKeys {
    keys: Vec<String>,
    /// Line where they begin, from 1.
    line: usize,
}

/// A scenario with something changed, under which a statement may be met.
#[derive(Debug, Clone, PartialEq)]
struct StudyAssumption {
    /// What is changed, to follow "under the assumption".
    name: String,
    /// The keys that are changed.
    scenario: StudyKeys,
}

/// A published number.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedStatement {
    /// What it is, as in "GPS HDOP p95".
    pub name: String,
    /// The constellation: a notation, a name in the scenario of the study, or `gnss-only`; or a sky of the study.
    pub of: String,
    /// The satellite whose elements are meant; otherwise the first.
    satellite: Option<String>,
    /// What is computed.
    pub metric: StudyMetric,
    /// The number.
    pub expected: Expected,
    /// The place in the source.
    pub source: String,
    /// How the study came by what it is judged with.
    provenance: Provenance,
    /// Whether the number was found in the source, or where it was quoted; `false` for one from memory, which gates
    /// nothing.
    pub is_confirmed: bool,
    /// What is known of a disagreement.
    pub disagreement: Option<String>,
    /// Keys of the scenario for this statement alone.
    scenario: StudyKeys,
    /// Line where it begins, from 1.
    line: usize,
}

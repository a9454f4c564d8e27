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
mod steps;

pub use builtin::{builtin_studies, builtin_study};
pub use metric::{
    DilutionKind, OrbitQuantity, PlaneQuantity, SampleStatistic, SetComparison, SpreadQuantity,
    StudyMetric, UnknownMetric,
};
pub use parse::StudyFileError;
pub use run::{
    ComputedValue, Curve, FigureData, FittedRow, FoundFigure, FoundFit, FoundMember, FoundSet,
    JudgedRow, JudgedStatement, JudgedStudy, MeasuredColumn, MeasuredRow, MeasuredTable,
    PlacedDesign, RowAtFit, RowsUnder, StudyRunError,
};
use sky::StudySky;
use steps::{AssumedChange, Replaced, StudyFigure, StudyFit, StudySearch, StudyTable, StudyValue};
pub use steps::{DesignElement, StudyPlot};

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
    /// The built-in scenario that its keys change; without it the defaults of every scenario.
    base: Option<String>,
    /// The keys of its scenario that are not the defaults.
    scenario: StudyKeys,
    /// Skies that statements are about.
    skies: Vec<StudySky>,
    /// What else may be assumed where the source does not say.
    assumptions: Vec<StudyAssumption>,
    /// What follows from the numbers of tables.
    fits: Vec<StudyFit>,
    /// The searches, in the order in which they run.
    searches: Vec<StudySearch>,
    /// Tables, whose numbers are among the statements.
    tables: Vec<StudyTable>,
    /// Numbers that are computed and not judged.
    values: Vec<StudyValue>,
    /// Figures beside that of the deviations.
    figures: Vec<StudyFigure>,
    /// The statements in the order of the file, at least one.
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
    /// What else is changed.
    change: AssumedChange,
    /// What stands for what.
    instead: Replaced,
}

/// A published number.
#[derive(Debug, Clone, PartialEq)]
pub struct PublishedStatement {
    /// What it is, as in "GPS HDOP p95".
    pub name: String,
    /// The constellation: a notation, a name in the scenario of the study, or `gnss-only`; or a sky, a row or a step of
    /// the study.
    pub of: String,
    /// What it is compared with.
    comparison: Option<StatementComparison>,
    /// The satellite whose elements are meant; otherwise the first.
    satellite: Option<String>,
    /// What is computed.
    pub metric: StudyMetric,
    /// The number.
    pub expected: PublishedNumber,
    /// The place in the source.
    pub source: String,
    /// How the study came by what it is judged with.
    provenance: Provenance,
    /// Whether the number was found in the source, or where it was quoted; `false` for one from memory, which gates
    /// nothing.
    pub is_confirmed: bool,
    /// What is known of a disagreement.
    pub disagreement: Option<String>,
    /// The assumptions under which it is tried; `None` for all that apply.
    tried: Option<Vec<String>>,
    /// Keys of the scenario for this statement alone.
    scenario: StudyKeys,
    /// Line where it begins, from 1.
    line: usize,
}

/// What a source says, or implies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PublishedNumber {
    /// A number or a bound.
    Stated(Expected),
    /// The median of a fit.
    OfFit {
        /// The largest difference.
        tolerance: f64,
    },
}

/// What a statement compares its number with.
#[derive(Debug, Clone, PartialEq)]
enum StatementComparison {
    /// By how much it is above that of another, percent.
    PercentAbove(String),
    /// By how much it is below that of another, percent.
    PercentBelow(String),
    /// A set of designs, or curves.
    Against(String),
}

impl StatementComparison {
    /// The other.
    fn with(&self) -> &str {
        match self {
            Self::PercentAbove(other) | Self::PercentBelow(other) | Self::Against(other) => other,
        }
    }
}

impl PublishedStatement {
    /// All that it refers to.
    fn references(&self) -> impl Iterator<Item = &str> {
        let other = self.comparison.as_ref().map(StatementComparison::with);
        std::iter::once(self.of.as_str()).chain(other)
    }
}

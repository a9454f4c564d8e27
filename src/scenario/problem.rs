//! The problems of a scenario, all at once.

use std::fmt;
use std::ops::Range;

use super::source::{Place, Source, blanked};
use crate::constellation::NotationError;
use crate::ground::UnknownCountry;
use crate::keyword::UnknownKeyword;
use crate::orbit::relations::RelationError;
use crate::search::ConstraintError;

/// Characters of an unknown key repeated in a message.
const LONGEST_KEY: usize = 60;

/// All problems of a scenario, in the order of the file and then of the `--set` arguments.
#[derive(Debug, Clone, PartialEq)]
pub struct Problems(Vec<ScenarioProblem>);

/// One problem of a scenario.
#[derive(Debug, Clone, PartialEq)]
pub struct ScenarioProblem {
    /// Where.
    pub place: Place,
    /// The key as `section.key`; empty if the text is not TOML.
    pub key: String,
    /// What.
    pub fault: Fault,
}

/// A problem of a key or its value.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// The file is not UTF-8.
    #[error("the file is not UTF-8 text")]
    NotUtf8,
    /// The text is not TOML.
    #[error("not TOML: {message}")]
    Syntax {
        /// The message of the TOML parser.
        message: String,
    },
    /// A `--set` argument without `=`.
    #[error("expected key.path=value")]
    NotAnAssignment,
    /// The key does not exist.
    #[error("unknown key{} (choices: {})", did_you_mean(.nearest.as_deref()), .known.join(", "))]
    UnknownKey {
        /// The path of the key that was most likely meant.
        nearest: Option<String>,
        /// The keys of the same section, or the sections and keys at the top.
        known: Vec<&'static str>,
    },
    /// A section is given a value, or `--set` names a section.
    #[error("[{section}] is a section; set one of its keys: {}", .known.join(", "))]
    NotASection {
        /// The section.
        section: &'static str,
        /// Its keys.
        known: Vec<&'static str>,
    },
    /// The value is of another type, or outside its range.
    #[error("found {found}, expected {accepted}")]
    NotAccepted {
        /// The value as written.
        found: String,
        /// The accepted type, range and unit.
        accepted: String,
    },
    /// The word is not one of the choices.
    #[error(transparent)]
    UnknownKeyword(#[from] UnknownKeyword),
    /// The name is not that of a country.
    #[error(transparent)]
    UnknownCountry(#[from] UnknownCountry),
    /// The text is not a constraint.
    #[error(transparent)]
    Constraint(#[from] ConstraintError),
    /// The text is not a design.
    #[error(transparent)]
    Notation(#[from] NotationError),
    /// A constellation of nothing.
    #[error("the constellation has no satellites: give `design`, `files` or both")]
    NoSatellites,
    /// A constellation with the name of the GNSS alone.
    #[error("the name {name} is that of the GNSS alone in tables; choose another")]
    ReservedName {
        /// The name.
        name: &'static str,
    },
    /// A key about files where there are none.
    #[error("this is about satellites from files, but `files` is not given")]
    NoFiles,
    /// An element appears twice in a list.
    #[error("{found} appears more than once")]
    Repeated {
        /// The element as written.
        found: String,
    },
    /// An interval's limits are in the wrong order.
    #[error("found {found}, but the low limit is above the high limit")]
    Reversed {
        /// The interval as written.
        found: String,
    },
    /// Longitudes that are not an interval eastwards.
    #[error(
        "found {found}, expected a span eastwards of 0 to 360 degrees \
         ([160, -155] is [160, 205])"
    )]
    NotEastwards {
        /// The interval as written.
        found: String,
    },
    /// An interval of one shell beside a list of shells.
    #[error(
        "`search.shells` lists the shells: give this key in each [[search.shells]] instead, or leave out `search.shells`"
    )]
    OfOneShell,
    /// A list of shells without one.
    #[error("found an empty list, expected at least one shell")]
    NoShells,
    /// A shell without satellites.
    #[error(
        "the shell never has a satellite; expected at least 1 satellite per plane as the high limit"
    )]
    AlwaysEmpty,
    /// A search in which all shells may be empty.
    #[error(
        "every shell can be empty, so that a design could have no satellite; let `satellites-per-plane` of one of them \
         begin at 1, or give `search.fixed`"
    )]
    AllEmpty,
    /// A step between nodes for a pattern that has none.
    #[error(
        "node-step-deg does not apply to lattice: its phases follow from nodes 360/P degrees apart; give lattice a shell \
         of its own"
    )]
    NodeStepOfLattice,
    /// Two keys that exclude each other.
    #[error("excluded by `{other}`; give one of them")]
    Excluded {
        /// The other key.
        other: String,
    },
    /// Clocks for each part where all systems share one.
    #[error(
        "\"per-part\" needs `{other}` = \"per-system\": with \"shared\" there is one clock for all satellites"
    )]
    OneClock {
        /// The key of the clocks.
        other: String,
    },
    /// The elevation part of a range error that is not given.
    #[error("this is about a range error that is not given; set `{other}`")]
    NoRangeError {
        /// The key of the range error.
        other: String,
    },
    /// A range error of zero.
    #[error("a and b are both 0: the range error would be 0")]
    NoError,
    /// A system in use without a range error, where others have one.
    #[error("every system in use needs a range error; `{key}` is missing")]
    MissingRangeError {
        /// The key of its range error.
        key: String,
    },
    /// A window that does not fit into the span.
    #[error("a window of {window_min} min is longer than the span of {span_min} min")]
    WindowTooLong {
        /// The window, minutes.
        window_min: f64,
        /// The span, minutes.
        span_min: f64,
    },
    /// A window that holds one instant.
    #[error(
        "a window of {window_min} min holds one instant, since the step is {step_min} min; expected more than the step"
    )]
    WindowTooShort {
        /// The window, minutes.
        window_min: f64,
        /// The step, minutes.
        step_min: f64,
    },
    /// A quantity that the scenario does not compute.
    #[error("{quantity} needs {needs}")]
    Needs {
        /// The quantity.
        quantity: String,
        /// What is missing.
        needs: String,
    },
    /// More of something than a run allows.
    #[error("{count:.0} {what}, expected at most {most}")]
    TooMany {
        /// What exceeds its limit.
        what: &'static str,
        /// How many there would be.
        count: f64,
        /// The bound.
        most: u64,
    },
    /// The number of a table that a list does not have.
    #[error("{}", no_such_table(.found, *.count))]
    NoSuchTable {
        /// The number as given.
        found: String,
        /// Number of tables.
        count: usize,
    },
    /// A list that must be as long as another.
    #[error("found {found} numbers for {expected} objectives, expected one for each")]
    Length {
        /// Numbers given.
        found: usize,
        /// Objectives.
        expected: usize,
    },
    /// Two bounds on one quantity that together exclude everything.
    #[error("{lower} and {upper} exclude every design")]
    Contradiction {
        /// The bound below, as written.
        lower: String,
        /// The bound above, as written.
        upper: String,
    },
    /// Ellipses that all go below the ground.
    #[error(
        "with an eccentricity of {eccentricity} at {altitude_km} km the perigee height is {perigee_km:.1} km, and no other design of the search space is higher"
    )]
    Underground {
        /// The least eccentricity.
        eccentricity: f64,
        /// The greatest altitude, km.
        altitude_km: f64,
        /// Height of the perigee over the Earth's radius, km.
        perigee_km: f64,
    },
    /// An altitude or an inclination that follows, and that no orbit has.
    #[error(transparent)]
    NoSuchOrbit {
        /// Why not.
        source: RelationError,
    },
    /// A phasing that no design of the search can have.
    #[error("the lowest phasing is {lowest}, but with at most {planes} planes it is at most {}", .planes.saturating_sub(1))]
    PhasingAbovePlanes {
        /// The lowest phasing.
        lowest: u32,
        /// The highest number of planes.
        planes: u32,
    },
    /// Values that are in range but cannot be set up.
    #[error("{reason}")]
    SetUp {
        /// The reason.
        reason: String,
    },
    /// A grid of poles only, which all have zero weight.
    #[error("every point is a pole and has zero weight with \"cos-latitude\"")]
    Weightless,
}

fn no_such_table(found: &str, count: usize) -> String {
    match count {
        0 => format!("there is no table {found}: the scenario has no such list"),
        count => format!("there is no table {found}, expected a number from 1 to {count}"),
    }
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or_else(String::new, |name| format!(", did you mean `{name}`?"))
}

/// Maximum number of problems to report, since a file of nonsense has millions.
const MAX_PROBLEMS: usize = 1000;

/// The problems found so far.
#[derive(Debug, Default)]
pub(super) struct ProblemList(Vec<ScenarioProblem>);

impl ProblemList {
    pub(super) fn add(
        &mut self,
        source: &Source<'_>,
        span: Range<usize>,
        key: &str,
        fault: impl Into<Fault>,
    ) {
        if self.0.len() < MAX_PROBLEMS {
            self.0.push(ScenarioProblem {
                place: source.place(span),
                key: blanked(key).take(LONGEST_KEY).collect(),
                fault: fault.into(),
            });
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl From<ProblemList> for Problems {
    fn from(ProblemList(mut problems): ProblemList) -> Self {
        problems.sort_by(|a, b| a.place.cmp(&b.place));
        Self(problems)
    }
}

impl Problems {
    /// The problems, at least one.
    #[must_use]
    pub fn as_slice(&self) -> &[ScenarioProblem] {
        &self.0
    }
}

impl fmt::Display for ScenarioProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: ", self.place)?;
        if !self.key.is_empty() {
            write!(f, "{}: ", self.key)?;
        }
        write!(f, "{}", self.fault)
    }
}

impl fmt::Display for Problems {
    /// One line for each problem, followed by the source line with the relevant part underlined.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let lines = self.0.iter().map(|problem| match problem.place {
            Place::File { line, .. } => line,
            Place::Argument { .. } => 0,
        });
        let width = lines.max().unwrap_or(0).to_string().len();
        for (index, problem) in self.0.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{problem}")?;
            if let Place::File { line, excerpt, .. } = &problem.place {
                let (text, offset) = (&excerpt.text, excerpt.offset);
                let underline = "^".repeat(excerpt.length);
                write!(f, "\n  {line:>width$} | {text}")?;
                write!(f, "\n  {:>width$} | {:offset$}{underline}", "", "")?;
            }
        }
        Ok(())
    }
}

impl std::error::Error for ScenarioProblem {}
impl std::error::Error for Problems {}

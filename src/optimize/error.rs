//! What can be wrong with a search: its space, its settings, its problem's
//! answers or the checkpoint that it is resumed from.

use thiserror::Error;

/// Why a search cannot start, continue or resume.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum OptimizeError {
    /// A space needs at least one variable.
    #[error("the search space has no variable")]
    NoVariable,
    /// A bound is NaN or infinite, or the bounds are too far apart for an `f64` width.
    #[error("the bounds of {name} must be finite, found {lo} to {hi}")]
    BoundNotFinite {
        /// The variable's name.
        name: String,
        /// The lower bound as given.
        lo: f64,
        /// The upper bound as given.
        hi: f64,
    },
    /// The lower bound is above the upper one.
    #[error("the bounds of {name} are reversed: {lo} is above {hi}")]
    BoundsReversed {
        /// The variable's name.
        name: String,
        /// The lower bound as given.
        lo: f64,
        /// The upper bound as given.
        hi: f64,
    },
    /// An integer bound that an `f64` genome cannot hold exactly.
    #[error("the integer bound {value} of {name} is beyond 2^53")]
    IntegerTooLarge {
        /// The variable's name.
        name: String,
        /// The offending bound.
        value: i64,
    },
    /// Two variables with the same name cannot be distinguished.
    #[error("the search space has two variables named {name}")]
    DuplicateVariable {
        /// The repeated name.
        name: String,
    },
    /// A problem needs at least one objective.
    #[error("the problem has no objective")]
    NoObjective,
    /// A setting is outside its range.
    #[error("{setting} must be {expected}, found {value}")]
    Setting {
        /// The setting's name.
        setting: &'static str,
        /// The value found.
        value: f64,
        /// The accepted range.
        expected: &'static str,
    },
    /// The hypervolume's reference point has the wrong number of coordinates.
    #[error("the hypervolume reference has {found} coordinates for {expected} objectives")]
    ReferenceLength {
        /// Coordinates given.
        found: usize,
        /// Objectives of the problem.
        expected: usize,
    },
    /// An exhaustive search needs one grid step per variable.
    #[error("there are {found} grid steps for {expected} variables")]
    StepCount {
        /// Steps given.
        found: usize,
        /// Variables of the space.
        expected: usize,
    },
    /// A grid with more points than could be counted, let alone evaluated.
    #[error("the grid has {points:e} points, more than 2^53")]
    GridTooLarge {
        /// The number of points.
        points: f64,
    },
    /// The problem answered a batch with the wrong number of evaluations.
    #[error("the problem returned {found} evaluations for a batch of {expected}")]
    BatchLength {
        /// Evaluations returned.
        found: usize,
        /// Genomes sent.
        expected: usize,
    },
    /// An evaluation has the wrong number of objectives.
    #[error("an evaluation has {found} objectives instead of {expected}")]
    ObjectiveCount {
        /// Objectives returned.
        found: usize,
        /// Objectives of the problem.
        expected: usize,
    },
    /// An objective is NaN or minus infinity, or infinite at a feasible point.
    #[error("objective {name} is {value} at a point with constraint violation {violation}")]
    Objective {
        /// The objective's name.
        name: String,
        /// The value returned.
        value: f64,
        /// The violation returned with it.
        violation: f64,
    },
    /// A constraint violation is NaN, infinite or negative.
    #[error("a constraint violation must be finite and not negative, found {value}")]
    Violation {
        /// The violation returned.
        value: f64,
    },
    /// A genome has the wrong length or a value outside its variable, whether
    /// from the problem's own repair or from a damaged checkpoint.
    #[error("{value} is not a value of variable {name}")]
    OutsideSpace {
        /// The variable's name.
        name: String,
        /// The offending value.
        value: f64,
    },
    /// A genome does not have one value per variable.
    #[error("a genome has {found} values for {expected} variables")]
    GenomeLength {
        /// Values found.
        found: usize,
        /// Variables of the space.
        expected: usize,
    },
    /// A checkpoint contradicts its own settings or the problem.
    #[error("the checkpoint does not match: {quantity} is {found}, expected {expected}")]
    Checkpoint {
        /// What was compared.
        quantity: &'static str,
        /// The value in the checkpoint.
        found: u64,
        /// The value (or bound) that fits.
        expected: u64,
    },
}

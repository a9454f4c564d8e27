//! What a strategy knows about a problem: variables with bounds, and a batch
//! evaluation that returns objectives to minimise and a constraint violation.

use serde::{Deserialize, Serialize};

use super::error::OptimizeError;
use super::generator::Generator;

/// The largest integer up to which every integer is an `f64`.
const LARGEST_INTEGER: i64 = 1 << 53;

/// The values that a variable can take, both bounds included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum VariableKind {
    /// Integers, stored in a genome as `f64`.
    Integer {
        /// The least value.
        lo: i64,
        /// The greatest value.
        hi: i64,
    },
    /// Real numbers.
    Real {
        /// The least value.
        lo: f64,
        /// The greatest value.
        hi: f64,
    },
    /// One of some choices without an order, stored as its number from 0.
    Category {
        /// How many choices there are.
        count: u32,
    },
}

impl VariableKind {
    /// The bounds as `f64`, exact for a variable of a [`Space`].
    #[must_use]
    pub fn bounds(&self) -> (f64, f64) {
        match *self {
            Self::Integer { lo, hi } => (lo as f64, hi as f64),
            Self::Real { lo, hi } => (lo, hi),
            Self::Category { count } => (0.0, f64::from(count) - 1.0),
        }
    }

    /// The nearest value of the variable: rounded unless it is real, then
    /// clamped. A NaN becomes the lower bound, a negative zero a positive one.
    #[must_use]
    pub fn nearest(&self, value: f64) -> f64 {
        let (lo, hi) = self.bounds();
        let whole = match self {
            Self::Integer { .. } | Self::Category { .. } => value.round(),
            Self::Real { .. } => value,
        };
        whole.max(lo).min(hi) + 0.0
    }
}

/// One dimension of a search space.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// The name used in errors and tables.
    pub name: String,
    /// The values that it can take.
    pub kind: VariableKind,
}

impl Variable {
    fn check(&self) -> Result<(), OptimizeError> {
        if let VariableKind::Integer { lo, hi } = self.kind
            && let Some(value) = [lo, hi]
                .into_iter()
                .find(|bound| bound.unsigned_abs() > LARGEST_INTEGER as u64)
        {
            let name = self.name.clone();
            return Err(OptimizeError::IntegerTooLarge { name, value });
        }
        let (lo, hi) = self.kind.bounds();
        let name = self.name.clone();
        if !(hi - lo).is_finite() {
            return Err(OptimizeError::BoundNotFinite { name, lo, hi });
        }
        if lo > hi {
            return Err(OptimizeError::BoundsReversed { name, lo, hi });
        }
        Ok(())
    }
}

/// The box that a strategy searches: at least one variable, every bound finite
/// and in order. A variable whose bounds are equal is a constant.
#[derive(Debug, Clone, PartialEq)]
pub struct Space {
    variables: Vec<Variable>,
}

impl Space {
    /// Checks the variables and keeps their order: a genome lists their values.
    ///
    /// # Errors
    ///
    /// No variable, a repeated name, a bound that is not finite or (for an
    /// integer) beyond 2^53, or bounds that are reversed.
    pub fn new(variables: Vec<Variable>) -> Result<Self, OptimizeError> {
        if variables.is_empty() {
            return Err(OptimizeError::NoVariable);
        }
        for (index, variable) in variables.iter().enumerate() {
            variable.check()?;
            if variables[..index].iter().any(|v| v.name == variable.name) {
                let name = variable.name.clone();
                return Err(OptimizeError::DuplicateVariable { name });
            }
        }
        Ok(Self { variables })
    }

    /// The variables in the order of a genome's values.
    #[must_use]
    pub fn variables(&self) -> &[Variable] {
        &self.variables
    }

    /// Moves every value to the nearest one that its variable can take.
    pub fn clamp(&self, genome: &mut [f64]) {
        for (value, variable) in genome.iter_mut().zip(&self.variables) {
            *value = variable.kind.nearest(*value);
        }
    }

    /// Checks that a genome has one value per variable, each one of its values.
    ///
    /// # Errors
    ///
    /// The genome's length, or the first value outside its variable.
    pub fn check(&self, genome: &[f64]) -> Result<(), OptimizeError> {
        self.check_length(genome)?;
        for (&value, variable) in genome.iter().zip(&self.variables) {
            if variable.kind.nearest(value) != value {
                let name = variable.name.clone();
                return Err(OptimizeError::OutsideSpace { name, value });
            }
        }
        Ok(())
    }

    fn check_length(&self, genome: &[f64]) -> Result<(), OptimizeError> {
        if genome.len() != self.variables.len() {
            return Err(OptimizeError::GenomeLength {
                found: genome.len(),
                expected: self.variables.len(),
            });
        }
        Ok(())
    }

    /// Like [`check`](Self::check), for integer variables with real values too.
    pub(super) fn check_confined(&self, values: &[f64]) -> Result<(), OptimizeError> {
        self.check_length(values)?;
        for (&value, variable) in values.iter().zip(&self.variables) {
            let (lo, hi) = variable.kind.bounds();
            if !(lo..=hi).contains(&value) {
                let name = variable.name.clone();
                return Err(OptimizeError::OutsideSpace { name, value });
            }
        }
        Ok(())
    }

    /// Moves every value between the bounds of its variable, without rounding.
    pub(super) fn confine(&self, values: &mut [f64]) {
        for (value, variable) in values.iter_mut().zip(&self.variables) {
            let (lo, hi) = variable.kind.bounds();
            *value = value.clamp(lo, hi);
        }
    }

    /// A genome drawn uniformly, every integer and every choice with the same probability.
    pub(super) fn draw(&self, generator: &mut Generator) -> Vec<f64> {
        let draw = |variable: &Variable| match variable.kind {
            VariableKind::Integer { .. } | VariableKind::Category { .. } => {
                let (lo, hi) = variable.kind.bounds();
                generator.between(lo, hi + 1.0).floor().min(hi)
            }
            VariableKind::Real { lo, hi } => variable.kind.nearest(generator.between(lo, hi)),
        };
        self.variables.iter().map(draw).collect()
    }
}

/// The answer to one genome.
#[derive(Debug, Clone, PartialEq)]
pub struct Evaluation {
    /// One value per objective, smaller is better. Never NaN; plus infinity only
    /// where the violation is positive, for an objective without a value there.
    pub objectives: Vec<f64>,
    /// How far the constraints are from being met: 0 when they all are, finite.
    pub violation: f64,
}

/// Something to optimise. Every objective is minimised.
pub trait Problem {
    /// The variables.
    fn space(&self) -> &Space;

    /// One name per objective; their number is the number of objectives.
    fn objective_names(&self) -> &[String];

    /// Makes dependent variables consistent, such as a phasing below the number
    /// of planes. Called with every value valid for its variable, which must
    /// remain so; a second call must change nothing.
    fn repair(&self, _genome: &mut [f64]) {}

    /// Gives all genomes of one design the same values, such as those of a part that is absent. Called with a
    /// repaired genome, which must remain one; a second call must change nothing.
    fn unify(&self, _genome: &mut [f64]) {}

    /// Evaluates genomes, one answer each in their order. All are inside the
    /// space and repaired. The same genome must always get the same answer.
    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation>;
}

/// A genome with its evaluation.
///
/// Serialises with an infinite objective as a missing value (JSON's `null`).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Individual {
    /// One value per variable.
    pub genome: Vec<f64>,
    /// One value per objective, smaller is better.
    #[serde(with = "infinity_as_none")]
    pub objectives: Vec<f64>,
    /// Constraint violation, 0 when feasible.
    pub violation: f64,
}

impl Individual {
    /// Whether every constraint is met.
    #[must_use]
    pub fn is_feasible(&self) -> bool {
        self.violation == 0.0
    }

    /// Checks an individual that comes from outside against a problem.
    pub(super) fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        problem.space().check(&self.genome)?;
        check_answer(problem.objective_names(), &self.objectives, self.violation)
    }
}

/// The genome inside the space with its dependent variables made consistent.
pub(super) fn repaired(
    problem: &dyn Problem,
    mut genome: Vec<f64>,
) -> Result<Vec<f64>, OptimizeError> {
    problem.space().clamp(&mut genome);
    problem.repair(&mut genome);
    problem.space().check(&genome)?;
    Ok(genome)
}

/// The one genome of the design that a genome stands for, inside the space.
pub(super) fn admit(problem: &dyn Problem, genome: Vec<f64>) -> Result<Vec<f64>, OptimizeError> {
    let mut genome = repaired(problem, genome)?;
    problem.unify(&mut genome);
    problem.space().check(&genome)?;
    Ok(genome)
}

/// Evaluates admitted genomes and rejects answers that cannot be compared. An
/// empty batch is not sent to the problem.
pub(super) fn evaluate(
    problem: &dyn Problem,
    genomes: Vec<Vec<f64>>,
) -> Result<Vec<Individual>, OptimizeError> {
    if genomes.is_empty() {
        return Ok(Vec::new());
    }
    let answers = problem.evaluate(&genomes);
    if answers.len() != genomes.len() {
        return Err(OptimizeError::BatchLength {
            found: answers.len(),
            expected: genomes.len(),
        });
    }
    let individual = |(genome, answer): (Vec<f64>, Evaluation)| {
        check_answer(
            problem.objective_names(),
            &answer.objectives,
            answer.violation,
        )?;
        Ok(Individual {
            genome,
            objectives: answer.objectives,
            violation: answer.violation,
        })
    };
    genomes.into_iter().zip(answers).map(individual).collect()
}

fn check_answer(names: &[String], objectives: &[f64], violation: f64) -> Result<(), OptimizeError> {
    if !violation.is_finite() || violation < 0.0 {
        return Err(OptimizeError::Violation { value: violation });
    }
    if objectives.len() != names.len() {
        return Err(OptimizeError::ObjectiveCount {
            found: objectives.len(),
            expected: names.len(),
        });
    }
    for (name, &value) in names.iter().zip(objectives) {
        let without_value = value == f64::INFINITY && violation > 0.0;
        if !value.is_finite() && !without_value {
            let name = name.clone();
            return Err(OptimizeError::Objective {
                name,
                value,
                violation,
            });
        }
    }
    Ok(())
}

/// JSON has no infinity: plus infinity is written as a missing value.
mod infinity_as_none {
    use serde::{Deserialize, Deserializer, Serializer};

    pub(super) fn serialize<S: Serializer>(values: &[f64], out: S) -> Result<S::Ok, S::Error> {
        out.collect_seq(
            values
                .iter()
                .map(|value| value.is_finite().then_some(value)),
        )
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(input: D) -> Result<Vec<f64>, D::Error> {
        let values = Vec::<Option<f64>>::deserialize(input)?;
        let infinity_if_missing = |value: Option<f64>| value.unwrap_or(f64::INFINITY);
        Ok(values.into_iter().map(infinity_if_missing).collect())
    }
}

#[cfg(test)]
mod tests;

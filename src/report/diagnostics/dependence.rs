//! Variables that objectives do not depend on, found by varying one variable at a time.

use super::listed;
use crate::optimize::{Individual, Problem};
use crate::run::Diagnostic;
use crate::search::{DesignProblem, Quantity};

/// Relative change of an objective over the full range of a variable below which it does not
/// depend on it in practice.
const NEGLIGIBLE: f64 = 1e-3;

/// One variable set to both ends of its range, with all others as in the chosen design.
struct Variation {
    variable: String,
    /// Relative change of each objective.
    changes: Vec<f64>,
}

/// Objectives that do not depend on some variables, and variables that no objective depends on.
pub(super) fn independent(problem: &DesignProblem<'_>, chosen: &Individual) -> Vec<Diagnostic> {
    let variations = variations(problem, chosen);
    let mut found = Vec::new();
    let idle = |v: &&Variation| v.changes.iter().all(|change| *change < NEGLIGIBLE);
    for variation in variations.iter().filter(idle) {
        let name = &variation.variable;
        found.push(Diagnostic::new(
            &format!("idle:{name}"),
            format!(
                "no objective depends on `{name}`: over its full range, with the other variables as in \
                 the chosen design, none changes by {} %",
                100.0 * NEGLIGIBLE
            ),
        ));
    }
    for (m, objective) in problem.goals().objectives.iter().enumerate() {
        // Counts, and quantities that use few variables by definition, are not worth reporting.
        if matches!(
            objective,
            Quantity::Satellites | Quantity::Planes | Quantity::LaunchCost
        ) {
            continue;
        }
        let still = variations
            .iter()
            .filter(|v| !idle(v) && v.changes[m] < NEGLIGIBLE);
        let names: Vec<&str> = still.map(|v| v.variable.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        found.push(Diagnostic::new(
            &format!("independent:{objective}"),
            format!(
                "`{objective}` does not depend on {}: over the full range of each, with the other \
                 variables as in the chosen design, it changes by less than {} %{}",
                listed(&names),
                100.0 * NEGLIGIBLE,
                free_satellites(*objective, &names)
            ),
        ));
    }
    found
}

/// The consequence of a cost that does not rise with the number of satellites.
fn free_satellites(objective: Quantity, names: &[&str]) -> &'static str {
    let sizes = ["planes", "satellites-per-plane"];
    if objective == Quantity::JCost && sizes.iter().any(|size| names.contains(size)) {
        "; it is one over the fraction of satellites in view, so additional satellites cost nothing; \
         minimise satellites, planes or launch-cost if they should"
    } else {
        ""
    }
}

fn variations(problem: &DesignProblem<'_>, chosen: &Individual) -> Vec<Variation> {
    let variables = problem.space().variables();
    let mut moved = Vec::new();
    for (k, variable) in variables.iter().enumerate() {
        let (lo, hi) = variable.kind.bounds();
        if lo < hi {
            moved.push((k, [lo, hi].map(|end| at(problem, chosen, k, end))));
        }
    }
    let batch: Vec<Vec<f64>> = moved.iter().flat_map(|(_, ends)| ends.clone()).collect();
    let answers = problem.evaluate(&batch);
    let pairs = answers.chunks_exact(2);
    let change = |ends: &[crate::optimize::Evaluation], m: usize| {
        let here = chosen.objectives[m];
        let values = ends.iter().map(|end| end.objectives[m]);
        let (least, greatest) = values.fold((here, here), |(a, b), x| (a.min(x), b.max(x)));
        // An objective of 0, or one without a value at an end, counts as changed.
        let relative = (greatest - least) / here.abs();
        if relative.is_finite() {
            relative
        } else {
            f64::INFINITY
        }
    };
    let objectives = chosen.objectives.len();
    let variation = |((k, _), ends): (&(usize, _), &[crate::optimize::Evaluation])| Variation {
        variable: variables[*k].name.clone(),
        changes: (0..objectives).map(|m| change(ends, m)).collect(),
    };
    moved.iter().zip(pairs).map(variation).collect()
}

/// The chosen genome with one value replaced, made consistent.
fn at(problem: &DesignProblem<'_>, chosen: &Individual, k: usize, value: f64) -> Vec<f64> {
    let mut genome = chosen.genome.clone();
    genome[k] = value;
    problem.repair(&mut genome);
    genome
}

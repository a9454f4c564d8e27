//! Variables that objectives do not depend on, found by varying one variable at a time.

use super::{listed, named};
use crate::optimize::{Individual, Problem};
use crate::run::Diagnostic;
use crate::search::{DesignProblem, Quantity};
use rayon::prelude::*;

/// Relative change of an objective over the full range of a variable below which it does not
/// depend on it in practice.
const NEGLIGIBLE: f64 = 1e-3;

/// One variable set to both ends and the middle of its range, with all others as in the chosen design.
struct Variation {
    variable: String,
    /// Relative change of each watched quantity.
    changes: Vec<f64>,
}

/// Objectives that do not depend on some variables, variables that only constraints depend on, and
/// variables that nothing depends on.
pub(super) fn independent(problem: &DesignProblem<'_>, chosen: &Individual) -> Vec<Diagnostic> {
    let goals = problem.goals();
    let constrained = goals.constrained();
    let watched = [goals.objectives.as_slice(), &constrained].concat();
    let variations = variations(problem, chosen, &watched);
    let mut found: Vec<Diagnostic> = variations
        .iter()
        .filter_map(|variation| without_objective(variation, goals.objectives.len(), &constrained))
        .collect();
    for (m, objective) in goals.objectives.iter().enumerate() {
        // Counts, and quantities that use few variables by definition, are not worth reporting.
        if matches!(
            objective,
            Quantity::Satellites
                | Quantity::Planes
                | Quantity::NewSatellites
                | Quantity::NewPlanes
                | Quantity::LaunchCost
        ) {
            continue;
        }
        let told = |v: &Variation| moved(&v.changes[..goals.objectives.len()]);
        let still = variations
            .iter()
            .filter(|v| told(v) && v.changes[m] < NEGLIGIBLE);
        let names: Vec<&str> = still.map(|v| v.variable.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        found.push(Diagnostic::new(
            &format!("independent:{objective}"),
            format!(
                "`{objective}` does not depend on {}: at both ends and in the middle of the range of each, \
                 with the other variables as in the chosen design, it changes by less than {} %{}",
                listed(&names),
                100.0 * NEGLIGIBLE,
                free_satellites(*objective, &names)
            ),
        ));
    }
    found
}

/// Whether one of the changes counts.
fn moved(changes: &[f64]) -> bool {
    changes.iter().any(|change| *change >= NEGLIGIBLE)
}

/// The diagnostic of a variable that no objective depends on; the changes are those of the objectives,
/// then those of the constrained quantities.
fn without_objective(
    variation: &Variation,
    objectives: usize,
    constrained: &[Quantity],
) -> Option<Diagnostic> {
    let (of_objectives, of_constraints) = variation.changes.split_at(objectives);
    if moved(of_objectives) {
        return None;
    }
    let name = &variation.variable;
    let percent = 100.0 * NEGLIGIBLE;
    let bound: Vec<String> = constrained
        .iter()
        .zip(of_constraints)
        .filter(|(_, change)| **change >= NEGLIGIBLE)
        .map(|(quantity, _)| quantity.to_string())
        .collect();
    if bound.is_empty() {
        let none = if constrained.is_empty() {
            "no objective depends"
        } else {
            "no objective and no constraint depends"
        };
        return Some(Diagnostic::new(
            &format!("idle:{name}"),
            format!(
                "{none} on {}: at both ends and in the middle of its range, with the other \
                 variables as in the chosen design, none changes by {percent} %",
                named(name)
            ),
        ));
    }
    let bound: Vec<&str> = bound.iter().map(String::as_str).collect();
    Some(Diagnostic::new(
        &format!("only-constrained:{name}"),
        format!(
            "of the objectives and constraints, {} affects only {}: at both ends and in the \
             middle of its range, with the other variables as in the chosen design, no objective changes by {percent} %, so \
             designs that differ only in it tie; add an objective that depends on it to choose \
             among them",
            named(name),
            listed(&bound)
        ),
    ))
}

/// The consequence of a cost that does not rise with the number of satellites.
fn free_satellites(objective: Quantity, names: &[&str]) -> &'static str {
    let is_size = |name: &&str| {
        let own = name.rsplit('.').next();
        matches!(own, Some("planes" | "satellites-per-plane"))
    };
    if objective == Quantity::JCost && names.iter().any(is_size) {
        "; it is one over the fraction of satellites in view, so additional satellites cost nothing; \
         minimise satellites, planes or launch-cost if they should"
    } else {
        ""
    }
}

/// Each variable that varies, with the relative changes of the watched quantities.
fn variations(
    problem: &DesignProblem<'_>,
    chosen: &Individual,
    watched: &[Quantity],
) -> Vec<Variation> {
    let variables = problem.space().variables().iter().enumerate();
    // The middle, since the ends of a full circle are one orbit.
    let varied: Vec<(usize, [f64; 3])> = variables
        .map(|(k, variable)| (k, variable.kind.bounds()))
        .filter(|(k, (lo, hi))| lo < hi && !problem.designs().is_idle(&chosen.genome, *k))
        .map(|(k, (lo, hi))| (k, [lo, 0.5 * (lo + hi), hi]))
        .collect();
    let points = varied
        .iter()
        .flat_map(|&(k, points)| points.map(|point| at(problem, chosen, k, point)));
    let genomes: Vec<Vec<f64>> = std::iter::once(chosen.genome.clone())
        .chain(points)
        .collect();
    let values: Vec<Vec<Option<f64>>> = genomes
        .par_iter()
        .map(|genome| quantities(problem, genome, watched))
        .collect();
    let Some((here, values)) = values.split_first() else {
        return Vec::new();
    };
    let variation = |(&(k, _), points): (&(usize, _), &[Vec<Option<f64>>])| Variation {
        variable: problem.space().variables()[k].name.clone(),
        changes: (0..watched.len())
            .map(|m| change(here[m], points.iter().map(|values| values[m])))
            .collect(),
    };
    varied
        .iter()
        .zip(values.chunks_exact(3))
        .map(variation)
        .collect()
}

/// The watched quantities of a vector; `None` for one without a value.
fn quantities(
    problem: &DesignProblem<'_>,
    genome: &[f64],
    watched: &[Quantity],
) -> Vec<Option<f64>> {
    let evaluated = problem.evaluated(genome);
    let value = |quantity: &Quantity| {
        let (design, metrics) = evaluated.as_ref()?;
        problem.value(*quantity, design.as_ref(), metrics)
    };
    watched.iter().map(value).collect()
}

/// Width of values relative to the first. A first value of 0, or a missing one, counts as a change.
fn change(here: Option<f64>, others: impl Iterator<Item = Option<f64>>) -> f64 {
    let (Some(here), Some(others)) = (here, others.collect::<Option<Vec<f64>>>()) else {
        return f64::INFINITY;
    };
    let highest = others.iter().copied().fold(here, f64::max);
    let lowest = others.iter().copied().fold(here, f64::min);
    let relative = (highest - lowest) / here.abs();
    if relative.is_finite() {
        relative
    } else {
        f64::INFINITY
    }
}

/// The chosen genome with one value replaced, made consistent.
fn at(problem: &DesignProblem<'_>, chosen: &Individual, k: usize, value: f64) -> Vec<f64> {
    let mut genome = chosen.genome.clone();
    genome[k] = value;
    problem.repair(&mut genome);
    genome
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two objectives, then maximum PDOP under a constraint.
    #[test]
    fn constraints_are_looked_at_too() {
        let told = |changes: [f64; 3], constrained: &[Quantity]| {
            let variation = Variation {
                variable: "altitude-km".to_owned(),
                changes: changes[..2 + constrained.len()].to_vec(),
            };
            without_objective(&variation, 2, constrained)
        };
        let bound = [Quantity::MaxPdop];
        assert_eq!(told([0.0, 0.1, 0.0], &bound), None);
        let found = told([0.0, 0.0, 0.1], &bound).unwrap();
        assert_eq!(found.code, "only-constrained:altitude-km");
        assert!(
            found.message.contains("affects only `max-pdop`"),
            "{}",
            found.message
        );
        let found = told([0.0, 0.0, 1e-4], &bound).unwrap();
        assert_eq!(found.code, "idle:altitude-km");
        assert!(found.message.contains("no constraint"), "{}", found.message);
        assert_eq!(told([0.0, 0.0, 0.0], &[]).unwrap().code, "idle:altitude-km");
    }

    #[test]
    fn a_change_is_relative_and_a_missing_value_is_one() {
        assert_eq!(change(Some(2.0), [Some(1.0), Some(4.0)].into_iter()), 1.5);
        assert_eq!(
            change(Some(2.0), [None, Some(2.0)].into_iter()),
            f64::INFINITY
        );
        assert_eq!(change(Some(0.0), [Some(0.0); 2].into_iter()), f64::INFINITY);
    }
}

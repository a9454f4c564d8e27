//! Diagnostics of a search: what its result implies beyond the numbers.

mod bounds;
mod conflict;
mod dependence;
mod progress;
mod rivals;

pub use bounds::at_bounds;
pub use rivals::{dominated_by, seed_spread};

use super::from_evaluations::EvaluationSource;
use crate::optimize::{Individual, Search, Strategy};
use crate::run::{Diagnostic, FrontMember};
use crate::search::DesignProblem;

/// All diagnostics of a search. The front and its individuals are in the same order. Evaluates
/// some variations of the chosen design.
#[must_use]
pub fn diagnose(
    problem: &DesignProblem<'_>,
    search: &Search,
    front: &[FrontMember],
    individuals: &[Individual],
) -> Vec<Diagnostic> {
    let source = EvaluationSource::Search;
    let mut found = diagnose_front(problem, front, individuals, source);
    let chosen = front.iter().position(|member| member.chosen);
    if let Some(chosen) = chosen.and_then(|n| individuals.get(n)) {
        found.extend(dependence::independent(problem, chosen));
    }
    // A sweep works through a grid, so how fast its front grows says nothing.
    if !matches!(search, Search::Exhaustive(_)) {
        let (history, objectives) = (search.history(), &problem.goals().objectives);
        found.extend(progress::of_history(history, objectives));
        found.extend(progress::lost_volume(history, objectives));
    }
    found
}

/// The diagnostics that follow from a front alone.
#[must_use]
pub(super) fn diagnose_front(
    problem: &DesignProblem<'_>,
    front: &[FrontMember],
    individuals: &[Individual],
    source: EvaluationSource,
) -> Vec<Diagnostic> {
    let mut found = match source {
        // The designs of a list have nothing to do with the bounds of the search.
        EvaluationSource::List => Vec::new(),
        _ => at_bounds(front, problem.designs()),
    };
    found.extend(conflict::without_conflict(
        individuals,
        &problem.goals().objectives,
    ));
    found
}

/// The names in a sentence, in backquotes: a, a and b, a, b and c.
fn listed(names: &[&str]) -> String {
    let names: Vec<String> = names.iter().map(|name| named(name)).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// A variable in a sentence: `planes`, and `planes` of shell B for that of a shell of several.
fn named(variable: &str) -> String {
    match variable.split_once('.') {
        Some((letters, name)) => format!("`{name}` of shell {letters}"),
        None => format!("`{variable}`"),
    }
}

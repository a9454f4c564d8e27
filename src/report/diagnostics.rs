//! What a search's result shows that its numbers alone do not say.

mod bounds;
mod conflict;
mod dependence;
mod progress;
mod rivals;

pub use bounds::at_bounds;
pub use rivals::{dominated_by, seed_spread};

use crate::optimize::{Individual, Search, Strategy};
use crate::run::{Diagnostic, FrontMember};
use crate::search::DesignProblem;

/// Everything that a search shows of itself. The front and the individuals behind it are in the
/// same order. Evaluates some variations of the chosen design.
#[must_use]
pub fn diagnose(
    problem: &DesignProblem<'_>,
    search: &Search,
    front: &[FrontMember],
    individuals: &[Individual],
) -> Vec<Diagnostic> {
    let mut found = at_bounds(front, problem.designs());
    found.extend(conflict::without_conflict(
        individuals,
        &problem.goals().objectives,
    ));
    let chosen = front.iter().position(|member| member.chosen);
    if let Some(chosen) = chosen.and_then(|n| individuals.get(n)) {
        found.extend(dependence::independent(problem, chosen));
    }
    // A sweep makes its way through a grid; how fast its front grows says nothing.
    if !matches!(search, Search::Exhaustive(_)) {
        found.extend(progress::of_history(
            search.history(),
            &problem.goals().objectives,
        ));
    }
    found
}

/// The names in a sentence: `a`, `a and b`, `a, b and c`.
fn listed(names: &[&str]) -> String {
    match names {
        [] => String::new(),
        [one] => (*one).to_owned(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

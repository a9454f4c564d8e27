//! A front compared with another search, and with the same search under other seeds.

use crate::optimize::dominates;
use crate::run::Diagnostic;

/// Relative standard deviation up to which seeds agree.
const STEADY: f64 = 0.005;

/// How many members of a front a grid sweep dominates, with all objectives minimised; `None` if
/// there is nothing to compare.
#[must_use]
pub fn dominated_by(front: &[Vec<f64>], sweep: &[Vec<f64>]) -> Option<Diagnostic> {
    if front.is_empty() || sweep.is_empty() {
        return None;
    }
    let beaten = |member: &&Vec<f64>| sweep.iter().any(|point| dominates(point, member));
    let count = front.iter().filter(beaten).count();
    let (code, consequence) = if count == 0 {
        (
            "not-dominated-by-sweep",
            "no design of the front is worse than one of the grid",
        )
    } else {
        (
            "dominated-by-sweep",
            "a larger population or more generations would find better designs",
        )
    };
    Some(Diagnostic::new(
        code,
        format!(
            "the grid sweep dominates {count} of {} designs of the front: {consequence}",
            front.len()
        ),
    ))
}

/// Whether several seeds agree, from the spread of their hypervolumes or of their best values of a
/// single objective.
#[must_use]
pub fn seed_spread(what: &str, mean: f64, std_dev: f64, seeds: usize) -> Option<Diagnostic> {
    if seeds < 2 || mean == 0.0 {
        return None;
    }
    let relative = std_dev / mean.abs();
    let (code, consequence) = if relative <= STEADY {
        ("seeds-agree", "any seed will do")
    } else {
        (
            "seeds-differ",
            "do not rely on a single run; use more generations or a larger population",
        )
    };
    Some(Diagnostic::new(
        code,
        format!(
            "over {seeds} seeds the standard deviation of the {what} is {:.2} % of its mean: \
             {consequence}",
            100.0 * relative
        ),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dominated_members_are_counted() {
        let front = [vec![1.0, 4.0], vec![2.0, 3.0], vec![4.0, 1.0]];
        let sweep = [vec![1.5, 3.0], vec![4.0, 1.0]];
        let found = dominated_by(&front, &sweep).unwrap();
        assert_eq!(found.code, "dominated-by-sweep");
        assert!(found.message.contains("1 of 3"), "{}", found.message);
        let code = dominated_by(&front, &[vec![5.0, 5.0]]).unwrap().code;
        assert_eq!(code, "not-dominated-by-sweep");
        assert_eq!(dominated_by(&front, &[]), None);
    }

    #[test]
    fn seeds_agree_or_differ() {
        let code = |mean, deviation, seeds| {
            seed_spread("hypervolume", mean, deviation, seeds).map(|d| d.code)
        };
        assert_eq!(code(1.0, 0.004, 9).as_deref(), Some("seeds-agree"));
        assert_eq!(code(1.0, 0.006, 9).as_deref(), Some("seeds-differ"));
        assert_eq!(code(1.0, 0.0, 1), None);
    }
}

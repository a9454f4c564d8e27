//! Objectives that do not conflict.

use crate::optimize::Individual;
use crate::run::Diagnostic;
use crate::search::Quantity;

/// Members of a front below which the absence of a trade-off is chance.
const FEWEST_MEMBERS: usize = 5;

/// Pairs of objectives that no two members of the front trade against each other: improving one
/// never worsens the other.
pub(super) fn without_conflict(front: &[Individual], objectives: &[Quantity]) -> Vec<Diagnostic> {
    if front.len() < FEWEST_MEMBERS {
        return Vec::new();
    }
    let mut found = Vec::new();
    for (m, a) in objectives.iter().enumerate() {
        for (n, b) in objectives.iter().enumerate().skip(m + 1) {
            if front
                .iter()
                .any(|x| front.iter().any(|y| opposed(x, y, [m, n])))
            {
                continue;
            }
            found.push(Diagnostic::new(
                &format!("no-conflict:{a}:{b}"),
                format!(
                    "`{a}` and `{b}` do not conflict: none of the {} designs of the front trades one for \
                     the other; consider dropping one of them or making it a constraint",
                    front.len()
                ),
            ));
        }
    }
    found
}

/// Whether `x` is better in the first objective and worse in the second.
fn opposed(x: &Individual, y: &Individual, [m, n]: [usize; 2]) -> bool {
    x.objectives[m] < y.objectives[m] && x.objectives[n] > y.objectives[n]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn front(points: &[[f64; 3]]) -> Vec<Individual> {
        let individual = |objectives: &[f64; 3]| Individual {
            genome: vec![],
            objectives: objectives.to_vec(),
            violation: 0.0,
        };
        points.iter().map(individual).collect()
    }

    #[test]
    fn only_what_never_trades_is_named() {
        let objectives = [Quantity::MeanPdop, Quantity::MaxPdop, Quantity::Satellites];
        let points: Vec<[f64; 3]> = (0..6_u8)
            .map(f64::from)
            .map(|x| [x, x * x, 10.0 - x])
            .collect();
        let codes = |points: &[[f64; 3]]| -> Vec<String> {
            let found = without_conflict(&front(points), &objectives);
            found.into_iter().map(|d| d.code).collect()
        };
        assert_eq!(codes(&points), ["no-conflict:mean-pdop:max-pdop"]);
        // A front of one or a few members shows nothing.
        assert!(codes(&points[..1]).is_empty());
        assert!(codes(&points[..3]).is_empty());
    }
}

//! The non-dominated set of everything seen so far.

use super::problem::Individual;
use super::sorting::{constraint_dominates, feasible_front};

/// Offers a candidate to an archive, which then contains every feasible candidate
/// that no other one dominates, each genome once.
///
/// Points with equal objectives are both kept: neither dominates the other, and
/// they are different designs. While nothing feasible is known the archive
/// contains the first point with the smallest violation instead, which a search
/// can follow and a user can learn from.
pub(super) fn offer(archive: &mut Vec<Individual>, candidate: &Individual) {
    let unneeded = |held: &Individual| {
        constraint_dominates(held, candidate)
            || held.genome == candidate.genome
            || (!candidate.is_feasible() && held.violation <= candidate.violation)
    };
    if archive.iter().any(unneeded) {
        return;
    }
    archive.retain(|held| !constraint_dominates(candidate, held));
    archive.push(candidate.clone());
}

/// The feasible candidates that no other one dominates, each genome once, sorted by their objectives and then by their
/// genomes.
#[must_use]
pub fn front_of(candidates: impl IntoIterator<Item = Individual>) -> Vec<Individual> {
    let mut archive = Vec::new();
    for candidate in candidates {
        offer(&mut archive, &candidate);
    }
    feasible_front(&archive)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn individual(genome: f64, objectives: [f64; 2], violation: f64) -> Individual {
        Individual {
            genome: vec![genome],
            objectives: objectives.to_vec(),
            violation,
        }
    }

    #[test]
    fn infeasible_points_wait_for_a_feasible_one() {
        let mut archive = Vec::new();
        for (genome, violation) in [(1.0, 2.0), (2.0, 1.0), (3.0, 1.0), (4.0, 3.0)] {
            offer(&mut archive, &individual(genome, [0.0, 0.0], violation));
        }
        assert_eq!(archive, [individual(2.0, [0.0, 0.0], 1.0)]);
        let feasible = individual(5.0, [9.0, 9.0], 0.0);
        offer(&mut archive, &feasible);
        offer(&mut archive, &individual(6.0, [0.0, 0.0], 0.5));
        offer(&mut archive, &feasible);
        assert_eq!(archive, [feasible]);
    }

    proptest! {
        // Coarse values make ties common; genomes are all different.
        #[test]
        fn holds_the_front_of_all_candidates(points in prop::collection::vec((0_u8..8, 0_u8..8, 0_u8..2), 1..60)) {
            let candidates: Vec<Individual> = (0_u8..)
                .zip(&points)
                .map(|(k, &(x, y, v))| individual(k.into(), [x.into(), y.into()], v.into()))
                .collect();
            let mut archive = Vec::new();
            for candidate in &candidates {
                offer(&mut archive, candidate);
            }
            prop_assert_eq!(feasible_front(&archive), feasible_front(&candidates));
            prop_assert_eq!(front_of(candidates.clone()), feasible_front(&candidates));
            let all_infeasible = candidates.iter().all(|a| !a.is_feasible());
            prop_assert_eq!(archive.len(), feasible_front(&candidates).len().max(all_infeasible.into()));
        }
    }
}

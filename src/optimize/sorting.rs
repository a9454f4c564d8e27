//! Constraint domination, the fast non-dominated sort and the crowding distance.
//!
//! Source: K. Deb, A. Pratap, S. Agarwal, T. Meyarivan, "A fast and elitist
//! multiobjective genetic algorithm: NSGA-II", IEEE Transactions on Evolutionary
//! Computation 6(2), 2002: the sort in section III-A, the crowding distance in
//! III-B, constraint domination in the section on constraint handling.

use super::problem::Individual;

/// Whether `a` dominates `b` in its objectives alone: no worse in any and better
/// in at least one.
#[must_use]
pub fn dominates(a: &[f64], b: &[f64]) -> bool {
    let no_worse = a.iter().zip(b).all(|(a, b)| a <= b);
    no_worse && a.iter().zip(b).any(|(a, b)| a < b)
}

/// Whether `a` constraint-dominates `b`: both are feasible and `a` dominates, or
/// the violation of `a` is the smaller one.
///
/// Two infeasible points of equal violation do not dominate each other, whatever
/// their objectives.
#[must_use]
pub fn constraint_dominates(a: &Individual, b: &Individual) -> bool {
    if a.is_feasible() && b.is_feasible() {
        dominates(&a.objectives, &b.objectives)
    } else {
        a.violation < b.violation
    }
}

/// Sorts into fronts by constraint domination: indices into `individuals`, best
/// front first, ascending within a front.
///
/// Every member of a front is dominated by a member of the front before it and by
/// none of its own. Takes O(M N²) comparisons for N individuals of M objectives.
#[must_use]
pub fn non_dominated_sort(individuals: &[Individual]) -> Vec<Vec<usize>> {
    let count = individuals.len();
    let mut dominated_by_me = vec![Vec::new(); count];
    let mut dominating_me = vec![0_usize; count];
    for a in 0..count {
        for b in a + 1..count {
            let (winner, loser) = if constraint_dominates(&individuals[a], &individuals[b]) {
                (a, b)
            } else if constraint_dominates(&individuals[b], &individuals[a]) {
                (b, a)
            } else {
                continue;
            };
            dominated_by_me[winner].push(loser);
            dominating_me[loser] += 1;
        }
    }
    let mut fronts = Vec::new();
    let mut front: Vec<usize> = (0..count).filter(|&i| dominating_me[i] == 0).collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for &loser in front.iter().flat_map(|&winner| &dominated_by_me[winner]) {
            dominating_me[loser] -= 1;
            if dominating_me[loser] == 0 {
                next.push(loser);
            }
        }
        next.sort_unstable();
        fronts.push(std::mem::replace(&mut front, next));
    }
    fronts
}

/// The feasible individuals that no other feasible one dominates, sorted by
/// their objectives from the first to the last and then by their genomes.
#[must_use]
pub fn feasible_front(individuals: &[Individual]) -> Vec<Individual> {
    let feasible = || individuals.iter().filter(|a| a.is_feasible());
    let mut front: Vec<Individual> = feasible()
        .filter(|a| !feasible().any(|b| dominates(&b.objectives, &a.objectives)))
        .cloned()
        .collect();
    let keys = |a: &Individual| a.objectives.clone().into_iter().chain(a.genome.clone());
    front.sort_by(|a, b| {
        keys(a)
            .zip(keys(b))
            .map(|(a, b)| a.total_cmp(&b))
            .find(|order| order.is_ne())
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    front
}

/// The crowding distance of each member of one front, in the order of `front`:
/// over the objectives, the sum of the gap between the two neighbours divided by
/// the range of the front, infinite at both ends of any objective.
///
/// An objective that is the same for the entire front, or that has no finite range
/// because some member has no value for it, says nothing about crowding and adds
/// nothing.
#[must_use]
pub fn crowding_distance(individuals: &[Individual], front: &[usize]) -> Vec<f64> {
    let mut crowd = Crowd::new(individuals, front);
    crowd.measure();
    crowd.distances
}

/// The `keep` least crowded members of a front, in ascending order, found by
/// removing the most crowded one and measuring again until enough are gone.
///
/// Removing several at once, as in Deb et al. 2002, can empty a whole
/// neighbourhood, since each of its members is crowded only while the others
/// stay. Source: S. Kukkonen, K. Deb, "Improved pruning of non-dominated
/// solutions based on crowding distance for bi-objective optimization problems",
/// IEEE Congress on Evolutionary Computation 2006. Among equally crowded members
/// the first goes, so that of a merged population the newer ones stay and a
/// search can drift along a plateau.
#[must_use]
pub fn prune_one_by_one(individuals: &[Individual], front: &[usize], keep: usize) -> Vec<usize> {
    let mut crowd = Crowd::new(individuals, front);
    let mut kept: Vec<usize> = (0..front.len()).collect();
    while kept.len() > keep {
        crowd.measure();
        let most_crowded = kept
            .iter()
            .copied()
            .min_by(|&a, &b| crowd.distances[a].total_cmp(&crowd.distances[b]));
        let Some(gone) = most_crowded else { break };
        kept.retain(|&member| member != gone);
        crowd.remove(gone);
    }
    kept.into_iter().map(|member| front[member]).collect()
}

/// A front sorted by each objective in which its members differ.
struct Crowd {
    distances: Vec<f64>,
    /// Per objective: its range, and (member, value) pairs by ascending value.
    orders: Vec<(f64, Vec<(usize, f64)>)>,
}

impl Crowd {
    fn new(individuals: &[Individual], front: &[usize]) -> Self {
        let objectives = front
            .first()
            .map_or(0, |&i| individuals[i].objectives.len());
        let order = |objective: usize| {
            let value =
                |(member, &i): (usize, &usize)| (member, individuals[i].objectives[objective]);
            let mut order: Vec<(usize, f64)> = front.iter().enumerate().map(value).collect();
            order.sort_by(|a, b| a.1.total_cmp(&b.1));
            let range = order.last()?.1 - order.first()?.1;
            (range.is_finite() && range > 0.0).then_some((range, order))
        };
        Self {
            distances: vec![0.0; front.len()],
            orders: (0..objectives).filter_map(order).collect(),
        }
    }

    fn measure(&mut self) {
        self.distances.fill(0.0);
        for (range, order) in &self.orders {
            for neighbours in order.windows(3) {
                let (member, gap) = (neighbours[1].0, neighbours[2].1 - neighbours[0].1);
                self.distances[member] += gap / range;
            }
            for (member, _) in order.first().into_iter().chain(order.last()) {
                self.distances[*member] = f64::INFINITY;
            }
        }
    }

    fn remove(&mut self, gone: usize) {
        for (_, order) in &mut self.orders {
            order.retain(|(member, _)| *member != gone);
        }
    }
}

#[cfg(test)]
mod tests;

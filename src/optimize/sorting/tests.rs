use super::*;
use proptest::prelude::*;

fn feasible(objectives: &[f64]) -> Individual {
    infeasible(objectives, 0.0)
}

fn infeasible(objectives: &[f64], violation: f64) -> Individual {
    Individual {
        genome: Vec::new(),
        objectives: objectives.to_vec(),
        violation,
    }
}

fn everyone(individuals: &[Individual]) -> Vec<usize> {
    (0..individuals.len()).collect()
}

#[test]
fn domination_needs_one_strict_improvement() {
    assert!(dominates(&[1.0, 2.0], &[1.0, 3.0]));
    assert!(!dominates(&[1.0, 2.0], &[1.0, 2.0]));
    assert!(!dominates(&[0.0, 3.0], &[1.0, 2.0]));
}

#[test]
fn constraints_come_before_objectives() {
    let good = feasible(&[9.0]);
    let near = infeasible(&[0.0], 0.1);
    let far = infeasible(&[f64::INFINITY], 0.2);
    assert!(constraint_dominates(&good, &near));
    assert!(constraint_dominates(&near, &far));
    assert!(!constraint_dominates(&far, &near));
    assert!(!constraint_dominates(&near, &infeasible(&[1.0], 0.1)));
    let fronts = non_dominated_sort(&[far, near.clone(), good, near]);
    assert_eq!(fronts, [vec![2], vec![1, 3], vec![0]]);
}

#[test]
fn feasible_front_is_sorted_and_leaves_infeasible_points_out() {
    let set = [
        feasible(&[2.0, 1.0]),
        infeasible(&[0.0, 0.0], 1.0),
        feasible(&[1.0, 3.0]),
        feasible(&[1.0, 2.0]),
        feasible(&[2.0, 1.0]),
    ];
    let front = feasible_front(&set);
    let objectives: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
    assert_eq!(objectives, [[1.0, 2.0], [2.0, 1.0], [2.0, 1.0]]);
    assert!(feasible_front(&set[1..2]).is_empty());
}

#[test]
fn crowding_of_an_evenly_spaced_line_is_two_steps_per_objective() {
    let line: Vec<Individual> = (0..5)
        .map(|k| feasible(&[f64::from(k), f64::from(4 - k)]))
        .collect();
    let distances = crowding_distance(&line, &everyone(&line));
    // Neighbours are two of four steps apart: 2/4 in each of the two objectives.
    let inner = 1.0;
    let ends = f64::INFINITY;
    assert_eq!(distances, [ends, inner, inner, inner, ends]);
}

#[test]
fn crowding_sums_the_gaps_of_the_neighbours() {
    // By hand: (7-0)/10 + (8-2)/8 = 1.45 and (10-3)/10 + (5-0)/8 = 1.325.
    let set: Vec<Individual> = [[0.0, 8.0], [3.0, 5.0], [7.0, 2.0], [10.0, 0.0]]
        .iter()
        .map(|point| feasible(point))
        .collect();
    let distances = crowding_distance(&set, &everyone(&set));
    assert!((distances[1] - 1.45).abs() < 1e-15, "{distances:?}");
    assert!((distances[2] - 1.325).abs() < 1e-15, "{distances:?}");
    // The result is in the order of the front.
    let turned = crowding_distance(&set, &[2, 0, 3, 1]);
    assert_eq!(
        turned,
        [distances[2], distances[0], distances[3], distances[1]]
    );
}

#[test]
fn crowding_ignores_what_cannot_tell_members_apart() {
    let constant: Vec<Individual> = (0..4).map(|k| feasible(&[f64::from(k), 5.0])).collect();
    let distances = crowding_distance(&constant, &everyone(&constant));
    assert_eq!(distances[1], 2.0 / 3.0);
    let unknown = [
        infeasible(&[f64::INFINITY], 1.0),
        infeasible(&[1.0], 1.0),
        infeasible(&[2.0], 1.0),
    ];
    assert_eq!(crowding_distance(&unknown, &[0, 1, 2]), [0.0; 3]);
    assert!(crowding_distance(&unknown, &[]).is_empty());
}

#[test]
fn pruning_thins_a_cluster_instead_of_emptying_it() {
    // The three in the middle are equally crowded. The first two to go by their
    // distances in the full front are neighbours; without the first, the second
    // is no longer crowded.
    let set: Vec<Individual> = [0.0, 2.0, 4.0, 4.5, 5.0, 5.5, 6.0, 8.0, 10.0]
        .iter()
        .map(|&x| feasible(&[x, 10.0 - x]))
        .collect();
    let all = everyone(&set);
    assert_eq!(prune_one_by_one(&set, &all, 7), [0, 1, 2, 4, 6, 7, 8]);
    assert_eq!(prune_one_by_one(&set, &all, 9), all);
    assert!(prune_one_by_one(&set, &all, 0).is_empty());
}

#[test]
fn pruning_equal_points_keeps_the_newest() {
    let set = [feasible(&[1.0]), feasible(&[1.0]), feasible(&[1.0])];
    assert_eq!(prune_one_by_one(&set, &[0, 1, 2], 1), [2]);
}

/// Repeatedly removes everything that nothing left dominates.
fn naive_sort(individuals: &[Individual]) -> Vec<Vec<usize>> {
    let mut left = everyone(individuals);
    let mut fronts = Vec::new();
    while !left.is_empty() {
        let dominated = |&i: &usize| {
            left.iter()
                .any(|&j| constraint_dominates(&individuals[j], &individuals[i]))
        };
        let (rest, front): (Vec<usize>, Vec<usize>) = left.iter().partition(|i| dominated(i));
        fronts.push(front);
        left = rest;
    }
    fronts
}

proptest! {
    // Coarse values make ties in objectives and violations common.
    #[test]
    fn fast_sort_equals_the_naive_one(
        points in prop::collection::vec((prop::collection::vec(0_u8..6, 3), 0_u8..4), 0..60)
    ) {
        let set: Vec<Individual> = points
            .iter()
            .map(|(objectives, violation)| {
                let objectives: Vec<f64> = objectives.iter().map(|&x| f64::from(x)).collect();
                infeasible(&objectives, f64::from(violation.saturating_sub(1)))
            })
            .collect();
        prop_assert_eq!(non_dominated_sort(&set), naive_sort(&set));
    }

    #[test]
    fn pruning_keeps_the_ends_of_two_objectives(
        points in prop::collection::vec((0.0..1.0_f64, 0.0..1.0_f64), 3..40)
    ) {
        let set: Vec<Individual> = points.iter().map(|&(x, y)| feasible(&[x, y])).collect();
        let front = non_dominated_sort(&set).swap_remove(0);
        let least = |of: &[usize], m: usize| {
            of.iter().map(|&i| set[i].objectives[m]).fold(f64::INFINITY, f64::min)
        };
        for keep in 2..=front.len() {
            let kept = prune_one_by_one(&set, &front, keep);
            prop_assert_eq!(kept.len(), keep);
            prop_assert_eq!(least(&kept, 0), least(&front, 0));
            prop_assert_eq!(least(&kept, 1), least(&front, 1));
        }
    }
}

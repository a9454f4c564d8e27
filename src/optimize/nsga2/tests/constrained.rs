//! What is kept beside the population of a constrained search.

use super::super::super::test_problems::{constr, islands};
use super::*;

/// The least product is feasible on two small islands far from those of the next one.
#[test]
fn a_small_island_is_reached_by_way_of_what_is_nearly_feasible() {
    let config = Nsga2Config {
        population: 60,
        generations: 60,
        ..Nsga2Config::default()
    };
    let best = |seed| {
        let search = run(&islands(), &config, seed);
        let front = search.front();
        (front[0].objectives[0], search.nearly_feasible.len())
    };
    let best: Vec<(f64, usize)> = (1..=20).map(best).collect();
    let reached = best.iter().filter(|(product, _)| *product == 180.0);
    assert!(reached.count() >= 18, "{best:?}");
    assert!(
        best.iter().all(|(_, beside)| (1..=12).contains(beside)),
        "{best:?}"
    );
}

/// What is kept beside the population is a part of the state.
#[test]
fn a_resumed_constrained_search_equals_an_unbroken_one() {
    for problem in [islands(), constr()] {
        let mut unbroken = Nsga2::start(&problem, Nsga2Config::default(), 3).unwrap();
        let mut broken = unbroken.clone();
        while !unbroken.is_done() {
            unbroken.step(&problem).unwrap();
            broken.step(&problem).unwrap();
            let text = serde_json::to_string(&broken).unwrap();
            broken = serde_json::from_str(&text).unwrap();
            assert_eq!(broken, unbroken);
        }
        assert!(!unbroken.nearly_feasible.is_empty());
        let mut damaged = unbroken.clone();
        damaged.nearly_feasible[0].genome.pop();
        assert!(damaged.check(&problem).is_err());
        let spare = unbroken.nearly_feasible[0].clone();
        unbroken.nearly_feasible = vec![spare; 7];
        let error = unbroken.check(&problem).unwrap_err().to_string();
        assert!(
            error.contains("nearly feasible designs is 7, expected"),
            "{error}"
        );
    }
}

//! Each rule alone, with a bound that is the very value of a design: a rule that rejects one sample too early, or expects
//! too much of the samples that are left, rejects that design, which the sweep keeps.

use super::*;

/// Compares with the sweep where the bound is reached exactly.
fn at_the_bound(evaluator: &Evaluator, quantity: &str, relation: &str, place: usize) {
    let bound = value_of_a_design(evaluator, quantity, place);
    let constraint = format!("{quantity} {relation} {bound}");
    let problem =
        DesignProblem::new(evaluator, space(false), goals(&[constraint.as_str()])).unwrap();
    let size = SizeProblem::new(&problem);
    assert!(size.without_rule().is_empty(), "{constraint}");
    let search = compare(&problem);
    assert!(search.fewest().is_some(), "{constraint}");
    let named = search
        .savings()
        .into_iter()
        .filter(|one| one.constraint == constraint);
    assert!(named.count() > 0, "{constraint} rejects nothing");
}

/// The value in this place among those of the designs of [`space`], the best first.
fn value_of_a_design(evaluator: &Evaluator, quantity: &str, place: usize) -> f64 {
    let quantity: Quantity = quantity.parse().unwrap();
    let problem = DesignProblem::new(evaluator, space(false), goals(&[])).unwrap();
    let grid = SweepGrid::new(problem.space(), &problem.designs().steps());
    let mut values: Vec<f64> = (0..grid.count().unwrap())
        .filter_map(|index| grid.admitted(&problem, grid.genome(index)).unwrap())
        .map(|genome| {
            let (design, metrics) = problem.evaluated(&genome).unwrap();
            quantity.minimised(problem.value(quantity, design.as_ref(), &metrics).unwrap())
        })
        .collect();
    values.sort_by(f64::total_cmp);
    quantity.minimised(values[place])
}

macro_rules! rules {
    ($($name:ident: $quantity:literal $relation:literal, $place:literal;)*) => {
        $(
            #[test]
            fn $name() {
                // 192 tiles: the tail is looked at for the last time when all have been seen.
                let evaluator = Evaluator::new(setup(30, 96, true, 1.6)).unwrap();
                at_the_bound(&evaluator, $quantity, $relation, $place);
            }
        )*
    };
}

rules! {
    the_rule_of_availability: "availability" ">=", 9;
    the_rule_of_coverage: "coverage-1" ">=", 9;
    the_rule_of_coverage_with_gnss: "coverage-total-9" ">=", 9;
    the_rule_of_the_mean: "mean-pdop" "<=", 9;
    the_rule_of_cvar: "cvar-pdop" "<=", 9;
    the_rule_of_the_maximum: "max-pdop" "<=", 0; // the tenth is one of the fewest satellites, so that none would be rejected
    the_rule_of_a_quantile: "p95-pdop" "<=", 9;
    the_rule_of_j_pos: "j-pos" "<=", 9;
    the_rule_of_outages: "longest-outage-s" "<=", 9;
}

/// Of one point and an hour, some designs always show a satellite.
#[test]
fn the_rule_of_least_visible() {
    let evaluator = Evaluator::new(setup(1, 4, true, 1.6)).unwrap();
    at_the_bound(&evaluator, "least-visible", ">=", 9);
}

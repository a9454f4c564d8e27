//! The closest rejected designs against a sweep, and what lies between the steps against its neighbours.

use super::*;
use crate::evaluate::Metrics;

/// The violations of all designs with so many satellites, in the order of the grid.
fn violations(size: &SizeProblem<'_>, satellites: usize) -> Vec<(f64, String)> {
    let designs = size.designs_of(satellites).map(Result::unwrap);
    let violation = |design: crate::constellation::Design| {
        let metrics = size.assessed(&design).unwrap();
        (violation(size, &design, &metrics), design.to_string())
    };
    designs.map(violation).collect()
}

fn violation(
    size: &SizeProblem<'_>,
    design: &crate::constellation::Design,
    metrics: &Metrics,
) -> f64 {
    let all = size.violations(design, metrics);
    all.map(|(.., violation)| violation).sum()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]

    /// The closest of each number of satellites are the first of the sweep by violation, whatever is constrained.
    #[test]
    fn the_closest_are_those_of_the_sweep(
        first in constraint(), second in constraint(), has_second in prop::bool::ANY,
        with_gnss in prop::bool::weighted(0.8), sites in 1..40_usize, available in 1.2..4.0_f64,
    ) {
        let evaluator = Evaluator::new(setup(sites, 24, with_gnss, available)).unwrap();
        let goals = goals(&[first.as_str(), second.as_str()]);
        let problem = DesignProblem::new(&evaluator, space(has_second), goals).unwrap();
        let size = SizeProblem::new(&problem);
        let (search, _) = found(&size, 0);
        let fewest = search.fewest().unwrap_or(usize::MAX);
        for level in search.levels().iter().filter(|level| level.satellites < fewest) {
            let mut swept = violations(&size, level.satellites);
            // Stable: equals stay in the order of the grid.
            swept.sort_by(|a, b| a.0.total_cmp(&b.0));
            swept.truncate(3);
            let closest = size.closest(&search, level, &|| false).unwrap().unwrap();
            let closest: Vec<(f64, String)> =
                closest.iter().map(|one| (one.violation, one.design.to_string())).collect();
            prop_assert_eq!(closest, swept);
        }
    }
}

/// The rules of a violation reject what the constraints reject by more, and not what they reject by less.
#[test]
fn the_bar_saves_evaluations() {
    let evaluator = Evaluator::new(setup(30, 48, true, 1.6)).unwrap();
    for (quantity, relation) in [
        ("availability", ">="),
        ("mean-pdop", "<="),
        ("max-pdop", "<="),
    ] {
        let bound = reached(&evaluator, quantity, 0.1);
        // None reaches twice as good a value.
        let bound = if relation == ">=" { 1.0 } else { 0.5 * bound };
        let constraint = format!("{quantity} {relation} {bound}");
        let problem = DesignProblem::new(&evaluator, space(false), goals(&[constraint.as_str()]));
        let problem = problem.unwrap();
        let size = SizeProblem::new(&problem);
        let rejects = |most: f64| size.rules_beyond(most).unwrap().rules.len();
        assert_eq!(
            (rejects(f64::INFINITY), rejects(0.1)),
            (0, 1),
            "{constraint}"
        );
    }
}

#[test]
fn a_stopped_search_for_the_closest_says_so() {
    let evaluator = Evaluator::new(setup(5, 10, true, 2.0)).unwrap();
    let problem = DesignProblem::new(&evaluator, space(false), goals(&["max-pdop <= 1"])).unwrap();
    let size = SizeProblem::new(&problem);
    let (search, _) = found(&size, 0);
    let stopped = size
        .closest(&search, &search.levels()[0], &|| true)
        .unwrap();
    assert_eq!(stopped, None);
}

/// A refined design is in the space, has the satellites of its start, and is as good as it and as its neighbours at a
/// sixteenth of the steps.
#[test]
fn nothing_close_is_better_than_what_was_refined() {
    let evaluator = Evaluator::new(setup(20, 24, true, 1.8)).unwrap();
    let problem =
        DesignProblem::new(&evaluator, space(true), goals(&["mean-pdop <= 1.2"])).unwrap();
    let size = SizeProblem::new(&problem);
    let (search, _) = found(&size, 0);
    let mut improved = 0;
    for level in &search.levels()[..4] {
        let closest = size.closest(&search, level, &|| false).unwrap().unwrap();
        for (start, one) in closest.iter().zip(size.refined_closest(&closest)) {
            assert_eq!(
                (one.satellites, &one.from),
                (level.satellites, &start.design.to_string())
            );
            assert!(one.violation <= start.violation && one.evaluations > 4);
            improved += u32::from(one.violation < start.violation);
            let shell = one.design.shells()[0];
            assert!((50.0..=70.0).contains(&shell.inclination_deg()));
            for (inclination, altitude) in [(1.25, 0.0), (-1.25, 0.0), (0.0, 37.5), (0.0, -37.5)] {
                let i = (shell.inclination_deg() + inclination).clamp(50.0, 70.0);
                let h = (shell.altitude_km() + altitude).clamp(900.0, 1500.0);
                let text = one.design.to_string();
                let (head, rest) = text.split_once(':').unwrap();
                let (_, counts) = rest.split_once(':').unwrap();
                let (counts, others) = match counts.split_once('+') {
                    Some((first, others)) => (first, format!("+{others}")),
                    None => (counts, String::new()),
                };
                let (counts, _) = counts.split_once('@').unwrap();
                let near = format!("{head}:{i}:{counts}@{h}{others}").parse().unwrap();
                let metrics = size.assessed(&near).unwrap();
                assert!(
                    violation(&size, &near, &metrics) >= one.violation,
                    "{near} {text}"
                );
            }
        }
    }
    assert!(improved > 4, "{improved}");
    let best = vec!["delta:50:4/2/1@900".parse().unwrap()];
    let refined = size.refined_designs(4, &best).unwrap();
    assert_eq!(refined[0].from, "delta:50:4/2/1@900");
}

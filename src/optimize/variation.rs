//! Crossover and mutation of genomes that mix real, integer and categorical variables.
//!
//! Simulated binary crossover (K. Deb, R. B. Agrawal, "Simulated binary crossover
//! for continuous search space", Complex Systems 9(2), 1995) and polynomial
//! mutation (K. Deb, M. Goyal, "A combined genetic adaptive search (GeneAS) for
//! engineering design", Computer Science and Informatics 26(4), 1996), with these
//! choices:
//!
//! - The distributions are not truncated at the bounds; a value outside is moved
//!   onto the bound. The best designs are often at a bound, which a truncated
//!   distribution approaches but never hits.
//! - Integers are crossed as reals and rounded, which mostly passes on the parents'
//!   values. They are changed by mutation, whose step is therefore rounded away
//!   from zero: rounded to the nearest, nine of ten steps in a range of five values
//!   would change nothing.
//! - Choices have no order, so nothing lies between two of them: crossover swaps
//!   those of the parents, and mutation draws one of the others, each with the same
//!   probability.

use super::generator::Generator;
use super::problem::{Space, VariableKind};

/// The chance that a variable takes part in a crossover, and that its values are
/// then swapped.
const EVEN: f64 = 0.5;

/// Two children of two genomes by simulated binary crossover, inside the space.
///
/// `index` is the distribution index, at least 0: the larger, the closer children
/// stay to their parents.
pub(super) fn cross(
    space: &Space,
    parents: [&[f64]; 2],
    index: f64,
    generator: &mut Generator,
) -> [Vec<f64>; 2] {
    let mut children = parents.map(<[f64]>::to_vec);
    for k in 0..space.variables().len() {
        let (a, b) = (parents[0][k], parents[1][k]);
        if a == b || !generator.chance(EVEN) {
            continue;
        }
        if let VariableKind::Category { .. } = space.variables()[k].kind {
            (children[0][k], children[1][k]) = (b, a);
            continue;
        }
        let (mean, half) = (0.5 * (a + b), 0.5 * (b - a));
        let reach = half * spread_factor(generator.unit(), index);
        let reach = if generator.chance(EVEN) {
            -reach
        } else {
            reach
        };
        children[0][k] = mean - reach;
        children[1][k] = mean + reach;
    }
    for child in &mut children {
        space.clamp(child);
    }
    children
}

/// The distance between two children in units of that of their parents, for a
/// uniform `draw`: its density is (η + 1)/2 β^η up to 1 and (η + 1)/2 β^-(η + 2)
/// above.
fn spread_factor(draw: f64, index: f64) -> f64 {
    let power = if draw <= 0.5 {
        2.0 * draw
    } else {
        0.5 / (1.0 - draw)
    };
    power.powf(1.0 / (index + 1.0))
}

/// Polynomial mutation: moves each variable with the given probability and leaves
/// the genome inside the space.
///
/// `index` is the distribution index, at least 0: the larger, the smaller the
/// steps, whose mean is the variable's range over `index + 2`.
pub(super) fn mutate(
    space: &Space,
    genome: &mut [f64],
    probability: f64,
    index: f64,
    generator: &mut Generator,
) {
    for (value, variable) in genome.iter_mut().zip(space.variables()) {
        if !generator.chance(probability) {
            continue;
        }
        let (lo, hi) = variable.kind.bounds();
        if let VariableKind::Category { count } = variable.kind {
            *value = another_choice(*value, count, generator);
            continue;
        }
        let size = (hi - lo) * step_size(generator.unit(), index);
        let size = match variable.kind {
            VariableKind::Integer { .. } => size.ceil().max(1.0),
            VariableKind::Real { .. } | VariableKind::Category { .. } => size,
        };
        *value += if generator.chance(EVEN) { -size } else { size };
    }
    space.clamp(genome);
}

/// A choice other than `value`, if there is one, each with the same probability.
fn another_choice(value: f64, count: u32, generator: &mut Generator) -> f64 {
    let drawn = generator.below(count.saturating_sub(1) as usize) as f64;
    if drawn >= value { drawn + 1.0 } else { drawn }
}

/// The step of polynomial mutation in units of the range, for a uniform `draw`:
/// its density is (η + 1)(1 - δ)^η.
fn step_size(draw: f64, index: f64) -> f64 {
    1.0 - (1.0 - draw).powf(1.0 / (index + 1.0))
}

#[cfg(test)]
mod tests {
    use super::super::problem::Variable;
    use super::*;

    const DRAWS: u32 = 40_000;
    /// Five standard deviations of a fraction of all draws, at most 1/2/sqrt(draws) each.
    const SHARE_ERROR: f64 = 0.0125;

    fn space(kinds: &[VariableKind]) -> Space {
        let variable = |(k, &kind): (usize, &VariableKind)| Variable {
            name: format!("x{k}"),
            kind,
        };
        Space::new(kinds.iter().enumerate().map(variable).collect()).unwrap()
    }

    fn share(event: impl FnMut(u32) -> bool) -> f64 {
        let mut event = event;
        f64::from((0..DRAWS).map(|k| u32::from(event(k))).sum::<u32>()) / f64::from(DRAWS)
    }

    fn assert_share(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() < SHARE_ERROR,
            "{found} is not {expected}"
        );
    }

    #[test]
    fn validate_spread_has_the_distribution_of_simulated_binary_crossover() {
        let mut generator = Generator::new(1, 0);
        for index in [0.0, 2.0, 15.0] {
            // Distribution function: β^(η+1)/2 up to 1, 1 - β^-(η+1)/2 above.
            let below = |limit: f64, generator: &mut Generator| {
                share(|_| spread_factor(generator.unit(), index) <= limit)
            };
            assert_share(below(0.9, &mut generator), 0.9_f64.powf(index + 1.0) / 2.0);
            assert_share(below(1.0, &mut generator), 0.5);
            let above = 1.1_f64.powf(-index - 1.0) / 2.0;
            assert_share(below(1.1, &mut generator), 1.0 - above);
        }
    }

    #[test]
    fn validate_steps_have_the_distribution_of_polynomial_mutation() {
        let mut generator = Generator::new(1, 1);
        for index in [0.0, 5.0, 20.0] {
            // Distribution function: 1 - (1 - δ)^(η+1); mean 1/(η+2).
            let near = share(|_| step_size(generator.unit(), index) <= 0.1);
            assert_share(near, 1.0 - 0.9_f64.powf(index + 1.0));
            let sum: f64 = (0..DRAWS).map(|_| step_size(generator.unit(), index)).sum();
            assert_share(sum / f64::from(DRAWS), 1.0 / (index + 2.0));
        }
    }

    #[test]
    fn children_lie_around_the_mean_of_their_parents() {
        let space = space(&[VariableKind::Real { lo: -1e6, hi: 1e6 }; 2]);
        let parents = [[3.0, 7.0], [4.0, 7.0]];
        let mut generator = Generator::new(1, 2);
        let (mut changed, mut swapped) = (0, 0);
        for _ in 0..DRAWS {
            let [a, b] = cross(&space, [&parents[0], &parents[1]], 2.0, &mut generator);
            // Rounding of numbers up to the widest spread, some 1e5.
            assert!((a[0] + b[0] - 7.0).abs() < 1e-9, "{a:?} {b:?}");
            assert_eq!((a[1], b[1]), (7.0, 7.0));
            changed += u32::from(a[0] != 3.0);
            swapped += u32::from(a[0] > b[0]);
        }
        // Half of the variables take part, and half of those are swapped.
        assert_share(f64::from(changed) / f64::from(DRAWS), 0.5);
        assert_share(f64::from(swapped) / f64::from(DRAWS), 0.25);
    }

    #[test]
    fn a_bound_is_hit_exactly() {
        let space = space(&[VariableKind::Real { lo: 0.0, hi: 1.0 }]);
        let mut generator = Generator::new(1, 3);
        let crossed = share(|_| {
            let [a, b] = cross(&space, [&[0.5], &[0.9]], 5.0, &mut generator);
            a[0] == 1.0 || b[0] == 1.0
        });
        // β >= 1.5, in the half of cases that cross: 1/2 * 1.5^-6/2.
        assert_share(crossed, 1.5_f64.powi(-6) / 4.0);
        let mutated = share(|_| {
            let mut genome = [0.9];
            mutate(&space, &mut genome, 1.0, 5.0, &mut generator);
            genome[0] == 1.0
        });
        // An upward step of at least 0.1: 1/2 * 0.9^6.
        assert_share(mutated, 0.9_f64.powi(6) / 2.0);
    }

    #[test]
    fn mutation_moves_an_integer_whenever_it_is_said_to() {
        let space = space(&[
            VariableKind::Integer { lo: 11, hi: 15 },
            VariableKind::Integer { lo: 4, hi: 4 },
        ]);
        let mut generator = Generator::new(1, 4);
        let mut distances = [0_u32; 3];
        for _ in 0..DRAWS {
            let mut genome = [13.0, 4.0];
            mutate(&space, &mut genome, 0.1, 10.0, &mut generator);
            assert_eq!(space.check(&genome), Ok(()));
            assert_eq!(genome[1], 4.0);
            distances[(genome[0] - 13.0).abs() as usize] += 1;
        }
        let shares = distances.map(|count| f64::from(count) / f64::from(DRAWS));
        assert_share(shares[0], 0.9);
        // Two units or more: a step above 1/4 of the range, 0.75^11 = 4 % of moves.
        assert_share(shares[2], 0.1 * 0.75_f64.powi(11));
        assert!(distances[2] > 0);
    }

    #[test]
    fn choices_are_swapped_and_drawn_again() {
        let space = space(&[
            VariableKind::Category { count: 4 },
            VariableKind::Category { count: 1 },
        ]);
        let mut generator = Generator::new(1, 6);
        let mut swapped = 0;
        for _ in 0..DRAWS {
            let [a, b] = cross(&space, [&[0.0, 0.0], &[3.0, 0.0]], 5.0, &mut generator);
            // Those of the parents, never one between them.
            assert!(
                matches!((a[0], b[0]), (0.0, 3.0) | (3.0, 0.0)),
                "{a:?} {b:?}"
            );
            swapped += u32::from(a[0] == 3.0);
        }
        assert_share(f64::from(swapped) / f64::from(DRAWS), 0.5);
        let mut counts = [0_u32; 4];
        for _ in 0..DRAWS {
            let mut genome = [2.0, 0.0];
            mutate(&space, &mut genome, 0.9, 10.0, &mut generator);
            assert_eq!(space.check(&genome), Ok(()));
            counts[genome[0] as usize] += 1;
        }
        for (choice, share) in [(0, 0.3), (1, 0.3), (2, 0.1), (3, 0.3)] {
            assert_share(f64::from(counts[choice]) / f64::from(DRAWS), share);
        }
    }

    #[test]
    fn integer_children_are_integers_between_the_bounds() {
        let space = space(&[VariableKind::Integer { lo: 0, hi: 9 }]);
        let mut generator = Generator::new(1, 5);
        let mut seen = [false; 10];
        for _ in 0..DRAWS {
            for child in cross(&space, [&[3.0], &[6.0]], 1.0, &mut generator) {
                assert_eq!(space.check(&child), Ok(()));
                seen[child[0] as usize] = true;
            }
        }
        assert_eq!(seen, [true; 10]);
    }
}

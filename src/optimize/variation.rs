//! Crossover and mutation of genomes that mix real and integer variables.
//!
//! Reals take simulated binary crossover (K. Deb, R. B. Agrawal, "Simulated binary
//! crossover for continuous search space", Complex Systems 9(2), 1995) and
//! polynomial mutation (K. Deb, M. Goyal, "A combined genetic adaptive search
//! (GeneAS) for engineering design", Computer Science and Informatics 26(4),
//! 1996), both with their distributions truncated so that a child lies between
//! the bounds.
//!
//! Integers take the same two laws and leave the lattice only in between:
//!
//! - A crossover's real child is rounded up or down at random with its distance
//!   to either as the probability. Rounding to the nearest would swallow almost
//!   every spread, since parents a few units apart have children within half a
//!   unit of them; this way the mean of the children stays that of the parents.
//! - A mutation's step is rounded away from zero. Rounded to the nearest, nine of
//!   ten steps in a range of five values would change nothing, and the mutation
//!   probability would not be one.

use super::generator::Generator;
use super::problem::{Kind, Space, Variable};

/// The chance that a variable takes part in a crossover (Deb and Agrawal 1995,
/// section 5), and that a child then follows the other parent.
const EVEN: f64 = 0.5;

/// Two children of two genomes by simulated binary crossover.
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
    for (k, variable) in space.variables().iter().enumerate() {
        let (low, high) = (
            parents[0][k].min(parents[1][k]),
            parents[0][k].max(parents[1][k]),
        );
        if low < high && generator.chance(EVEN) {
            let [below, above] = spread(variable, [low, high], index, generator);
            let first = usize::from(generator.chance(EVEN));
            children[first][k] = below;
            children[1 - first][k] = above;
        }
    }
    children
}

/// The two children of one variable's parents `low < high`.
fn spread(
    variable: &Variable,
    [low, high]: [f64; 2],
    index: f64,
    generator: &mut Generator,
) -> [f64; 2] {
    let (lo, hi) = variable.kind.bounds();
    let (mean, half) = (0.5 * (low + high), 0.5 * (high - low));
    let draw = generator.unit();
    let below = mean - half * spread_factor(draw, 1.0 + (low - lo) / half, index);
    let above = mean + half * spread_factor(draw, 1.0 + (hi - high) / half, index);
    match variable.kind {
        Kind::Integer { .. } => [below, above].map(|x| (x + generator.unit()).floor()),
        Kind::Real { .. } => [below, above],
    }
}

/// The spread factor of simulated binary crossover for a uniform `draw`, with
/// density (η + 1)/2 β^η up to 1 and (η + 1)/2 β^-(η + 2) above, truncated at
/// `limit`.
fn spread_factor(draw: f64, limit: f64, index: f64) -> f64 {
    let inside = 1.0 - 0.5 * limit.powf(-(index + 1.0));
    let draw = draw * inside;
    let power = if draw <= 0.5 {
        2.0 * draw
    } else {
        0.5 / (1.0 - draw)
    };
    power.powf(1.0 / (index + 1.0))
}

/// Polynomial mutation: moves each variable with the given probability.
///
/// `index` is the distribution index, at least 0: the larger, the smaller the
/// steps, whose mean is about the variable's range over `index + 2`.
pub(super) fn mutate(
    space: &Space,
    genome: &mut [f64],
    probability: f64,
    index: f64,
    generator: &mut Generator,
) {
    for (value, variable) in genome.iter_mut().zip(space.variables()) {
        if generator.chance(probability) {
            *value += step(variable, *value, index, generator);
        }
    }
}

/// One step of polynomial mutation from `value`.
fn step(variable: &Variable, value: f64, index: f64, generator: &mut Generator) -> f64 {
    let (lo, hi) = variable.kind.bounds();
    if lo == hi {
        return 0.0;
    }
    let (sign, room) = if generator.chance(EVEN) {
        (-1.0, value - lo)
    } else {
        (1.0, hi - value)
    };
    let size = (hi - lo) * step_size(generator.unit(), room / (hi - lo), index);
    match variable.kind {
        Kind::Integer { .. } => sign * size.ceil().max(1.0),
        Kind::Real { .. } => sign * size,
    }
}

/// The step of polynomial mutation for a uniform `draw`, in units of the range,
/// with density (η + 1)(1 - δ)^η truncated at `room`.
fn step_size(draw: f64, room: f64, index: f64) -> f64 {
    let beyond = (1.0 - room).powf(index + 1.0);
    1.0 - (1.0 - draw * (1.0 - beyond)).powf(1.0 / (index + 1.0))
}

//! The grid of a sweep: every variable from its lower bound upwards by its step.

use super::error::OptimizeError;
use super::problem::{Problem, Space, Variable, admit};

/// How far a range may fall short of an integer number of steps and still include
/// its upper end, as a fraction of a step: the rounding of a decimal step.
const SLACK: f64 = 1e-9;

/// One variable's values, from its lower bound upwards.
#[derive(Debug, Clone, PartialEq)]
struct GridAxis {
    lo: f64,
    hi: f64,
    step: f64,
    /// An integer.
    count: f64,
}

impl GridAxis {
    fn new(variable: &Variable, step: f64) -> Self {
        let (lo, hi) = variable.kind.bounds();
        let count = ((hi - lo) / step + SLACK).floor() + 1.0;
        Self {
            lo,
            hi,
            step,
            count,
        }
    }

    fn value(&self, index: f64) -> f64 {
        (self.lo + index * self.step).min(self.hi)
    }

    fn holds(&self, value: f64) -> bool {
        let index = ((value - self.lo) / self.step).round();
        index < self.count && self.value(index) == value
    }
}

/// The points of a grid over a space, the last variable changing fastest.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepGrid {
    /// Of the whole grid.
    axes: Vec<GridAxis>,
    /// The first index and the number of values that are taken of each axis.
    taken: Vec<(f64, f64)>,
}

impl SweepGrid {
    /// The grid with a step for each variable, finite and greater than 0.
    #[must_use]
    pub fn new(space: &Space, steps: &[f64]) -> Self {
        let pairs = space.variables().iter().zip(steps);
        let axes: Vec<GridAxis> = pairs.map(|(v, &step)| GridAxis::new(v, step)).collect();
        let taken = axes.iter().map(|axis| (0.0, axis.count)).collect();
        Self { axes, taken }
    }

    /// The points with one value of a variable, the one closest to `value`.
    #[must_use]
    pub fn pinned(mut self, variable: usize, value: f64) -> Self {
        let axis = &self.axes[variable];
        let index = ((value - axis.lo) / axis.step).round();
        self.taken[variable] = (index.clamp(0.0, axis.count - 1.0), 1.0);
        self
    }

    /// The number of points, exact as long as an `f64` can count it.
    ///
    /// # Errors
    ///
    /// If there are more than 2^53.
    pub fn count(&self) -> Result<u64, OptimizeError> {
        let points: f64 = self.taken.iter().map(|(_, count)| count).product();
        if points > (1_u64 << 53) as f64 {
            return Err(OptimizeError::GridTooLarge { points });
        }
        Ok(points as u64)
    }

    /// A point by its index, from 0.
    #[must_use]
    pub fn genome(&self, mut index: u64) -> Vec<f64> {
        let mut genome = vec![0.0; self.axes.len()];
        let axes = self.axes.iter().zip(&self.taken).rev();
        for (value, (axis, (first, count))) in genome.iter_mut().rev().zip(axes) {
            let count = *count as u64;
            *value = axis.value(first + (index % count) as f64);
            index /= count;
        }
        genome
    }

    /// The genome that stands for a point; `None` if repair turns it into another point of the grid, which has its
    /// own turn.
    ///
    /// # Errors
    ///
    /// If the problem repairs it to what is not in its space.
    pub fn admitted(
        &self,
        problem: &dyn Problem,
        point: Vec<f64>,
    ) -> Result<Option<Vec<f64>>, OptimizeError> {
        let genome = admit(problem, point.clone())?;
        Ok((genome == point || !self.holds(&genome)).then_some(genome))
    }

    fn holds(&self, genome: &[f64]) -> bool {
        let pairs = self.axes.iter().zip(genome);
        pairs.into_iter().all(|(axis, &value)| axis.holds(value))
    }
}

#[cfg(test)]
mod tests {
    use super::super::problem::VariableKind;
    use super::super::test_problems::{TestProblem, UNIT};
    use super::*;

    /// The parts with each value of a variable are the whole, in another order.
    #[test]
    fn pinned_parts_make_up_the_grid() {
        let kinds = [VariableKind::Integer { lo: 2, hi: 5 }, UNIT];
        let problem = TestProblem::new(&kinds, 1, |_| (vec![0.0], 0.0));
        let grid = SweepGrid::new(problem.space(), &[1.0, 0.25]);
        let points = |grid: &SweepGrid| -> Vec<Vec<f64>> {
            (0..grid.count().unwrap()).map(|n| grid.genome(n)).collect()
        };
        let all = points(&grid);
        assert_eq!(all.len(), 20);
        let parts = (2..=5).map(|p| points(&grid.clone().pinned(0, f64::from(p))));
        assert_eq!(parts.collect::<Vec<_>>().concat(), all);
        let one = grid.pinned(1, 0.5);
        assert_eq!(one.genome(2), [4.0, 0.5]);
    }
}

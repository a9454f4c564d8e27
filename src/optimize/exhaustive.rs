//! Exhaustive search: every point of a grid over the space, in a fixed order. Its
//! front is exact for that grid, which makes it the yardstick for the others.

use serde::{Deserialize, Serialize};

use super::archive::offer;
use super::error::OptimizeError;
use super::history::History;
use super::problem::{Individual, Problem, Variable, VariableKind, admit, evaluate};
use super::sorting::feasible_front;
use super::strategy::{
    Progress, Record, Strategy, check_at_most, check_count, check_equal, check_objectives,
    check_setting,
};

/// How far a range may fall short of an integer number of steps and still include
/// its upper end, as a fraction of a step: the rounding of a decimal step.
const SLACK: f64 = 1e-9;

/// The settings of exhaustive search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ExhaustiveConfig {
    /// The step of each variable, in the space's order and the variable's unit,
    /// from the lower bound upwards: finite and positive, an integer for an integer variable.
    pub steps: Vec<f64>,
    /// Designs in a step of the search, at least 1.
    pub batch: usize,
    /// Where the history measures hypervolume: one coordinate per objective.
    pub hypervolume_reference: Option<Vec<f64>>,
}

impl ExhaustiveConfig {
    fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        let variables = problem.space().variables();
        if self.steps.len() != variables.len() {
            return Err(OptimizeError::StepCount {
                found: self.steps.len(),
                expected: variables.len(),
            });
        }
        for (&step, variable) in self.steps.iter().zip(variables) {
            let positive = step.is_finite() && step > 0.0;
            check_setting(positive, "grid step", step, "finite and greater than 0")?;
            let whole = matches!(variable.kind, VariableKind::Real { .. }) || step.fract() == 0.0;
            check_setting(whole, "grid step", step, "whole for an integer or a choice")?;
        }
        check_count("batch", self.batch)?;
        check_objectives(problem, self.hypervolume_reference.as_deref())
    }
}

/// One variable's values, from its lower bound upwards.
struct Axis {
    lo: f64,
    hi: f64,
    step: f64,
    /// An integer.
    count: f64,
}

impl Axis {
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

/// The points of a grid, the last variable changing fastest.
struct GridPoints(Vec<Axis>);

impl GridPoints {
    fn new(problem: &dyn Problem, steps: &[f64]) -> Self {
        let variables = problem.space().variables().iter();
        Self(
            variables
                .zip(steps)
                .map(|(v, &step)| Axis::new(v, step))
                .collect(),
        )
    }

    /// The number of points, exact as long as an `f64` can count it.
    fn points(&self) -> Result<u64, OptimizeError> {
        let points: f64 = self.0.iter().map(|axis| axis.count).product();
        if points > (1_u64 << 53) as f64 {
            return Err(OptimizeError::GridTooLarge { points });
        }
        Ok(points as u64)
    }

    fn genome(&self, mut index: u64) -> Vec<f64> {
        let mut genome = vec![0.0; self.0.len()];
        for (value, axis) in genome.iter_mut().zip(&self.0).rev() {
            let count = axis.count as u64;
            *value = axis.value((index % count) as f64);
            index /= count;
        }
        genome
    }

    fn holds(&self, genome: &[f64]) -> bool {
        self.0
            .iter()
            .zip(genome)
            .all(|(axis, &value)| axis.holds(value))
    }
}

/// An exhaustive search, its own checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Exhaustive {
    config: ExhaustiveConfig,
    points: u64,
    step: u64,
    evaluations: u64,
    archive: Vec<Individual>,
    history: History,
}

impl Exhaustive {
    /// A search before its first step.
    ///
    /// # Errors
    ///
    /// A setting out of its range, a number of steps other than that of variables,
    /// a grid of more than 2^53 points, a problem without objectives, or a
    /// reference that does not fit them.
    pub fn start(problem: &dyn Problem, config: ExhaustiveConfig) -> Result<Self, OptimizeError> {
        config.check(problem)?;
        Ok(Self {
            points: GridPoints::new(problem, &config.steps).points()?,
            config,
            step: 0,
            evaluations: 0,
            archive: Vec::new(),
            history: History::default(),
        })
    }

    pub(super) fn history_mut(&mut self) -> &mut History {
        &mut self.history
    }

    pub(super) fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        self.config.check(problem)?;
        let points = GridPoints::new(problem, &self.config.steps).points()?;
        check_equal("grid points", self.points, points)?;
        self.history.check(problem, self.step)?;
        check_at_most("archive", self.archive.len() as u64, self.evaluations)?;
        check_at_most("evaluations", self.evaluations, self.passed(self.step))?;
        self.archive.iter().try_for_each(|a| a.check(problem))
    }

    /// Grid points that the search has passed after a number of steps.
    fn passed(&self, step: u64) -> u64 {
        self.points
            .min(step.saturating_mul(self.config.batch as u64))
    }

    /// Number of grid points still to be passed; some of them may be left out as equal designs.
    #[must_use]
    pub fn remaining(&self) -> u64 {
        self.points - self.passed(self.step)
    }

    /// At most `count` of the points still to be passed, evenly spaced, as they are evaluated.
    ///
    /// # Errors
    ///
    /// A problem whose repair leaves the space.
    pub fn sample(
        &self,
        problem: &dyn Problem,
        count: u64,
    ) -> Result<Vec<Vec<f64>>, OptimizeError> {
        let grid = GridPoints::new(problem, &self.config.steps);
        let count = count.min(self.remaining());
        let first = self.passed(self.step);
        let place = |n: u64| {
            let share = (n as f64 + 0.5) / count as f64;
            first + (share * self.remaining() as f64) as u64
        };
        (0..count)
            .map(|n| admit(problem, grid.genome(place(n))))
            .collect()
    }

    /// The points of the next step. A point that repair turns into another point of
    /// the grid is left out, since that one has its own turn.
    fn batch(&self, problem: &dyn Problem) -> Result<Vec<Vec<f64>>, OptimizeError> {
        let grid = GridPoints::new(problem, &self.config.steps);
        let mut batch = Vec::new();
        for index in self.passed(self.step)..self.passed(self.step + 1) {
            let point = grid.genome(index);
            let genome = admit(problem, point.clone())?;
            if genome == point || !grid.holds(&genome) {
                batch.push(genome);
            }
        }
        Ok(batch)
    }
}

impl Strategy for Exhaustive {
    fn step(&mut self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        if self.is_done() {
            return Ok(());
        }
        self.check(problem)?;
        let answers = evaluate(problem, self.batch(problem)?)?;
        self.evaluations += answers.len() as u64;
        self.step += 1;
        self.history.learn(&answers);
        for candidate in &answers {
            offer(&mut self.archive, candidate);
        }
        let reference = self.config.hypervolume_reference.as_deref();
        let progress = self.progress();
        self.history
            .record_archive(progress, &self.archive, reference);
        Ok(())
    }

    fn progress(&self) -> Progress {
        Progress {
            step: self.step,
            steps: self.points.div_ceil(self.config.batch.max(1) as u64),
            evaluations: self.evaluations,
        }
    }

    fn front(&self) -> Vec<Individual> {
        feasible_front(&self.archive)
    }

    fn history(&self) -> &[Record] {
        self.history.records()
    }

    fn chosen_reference(&self) -> Option<&[f64]> {
        self.history.chosen_reference()
    }
}

#[cfg(test)]
mod tests {
    use super::super::test_problems::{TestProblem, UNIT, mixed};
    use super::*;

    fn config(steps: &[f64], batch: usize) -> ExhaustiveConfig {
        ExhaustiveConfig {
            steps: steps.to_vec(),
            batch,
            hypervolume_reference: None,
        }
    }

    fn run(problem: &dyn Problem, config: ExhaustiveConfig) -> Exhaustive {
        let mut search = Exhaustive::start(problem, config).unwrap();
        while !search.is_done() {
            search.step(problem).unwrap();
        }
        search
    }

    #[test]
    fn every_point_is_visited_once_in_order() {
        let kinds = [
            VariableKind::Integer { lo: -1, hi: 1 },
            VariableKind::Real { lo: 0.0, hi: 0.3 },
        ];
        let problem = TestProblem::new(&kinds, 1, |_| (vec![0.0], 0.0));
        // 0.3 is not three times 0.1 in binary: the upper end is still a point, exactly.
        let search = run(&problem, config(&[2.0, 0.1], 3));
        let visited: Vec<Vec<f64>> = search.archive.iter().map(|a| a.genome.clone()).collect();
        let expected: Vec<Vec<f64>> = [-1.0, 1.0]
            .iter()
            .flat_map(|&n| [0.0, 0.1, 0.2, 0.3].map(|x| vec![n, x]))
            .collect();
        assert_eq!(visited, expected);
        let counts: Vec<u64> = search.history().iter().map(|r| r.evaluations).collect();
        assert_eq!(counts, [3, 6, 8]);
    }

    /// What is told before a sweep: the points that it has before it, and some of those.
    #[test]
    fn what_is_left_of_a_grid_is_known() {
        let kinds = [
            VariableKind::Integer { lo: 0, hi: 9 },
            VariableKind::Integer { lo: 0, hi: 3 },
        ];
        let problem = TestProblem::new(&kinds, 1, |_| (vec![0.0], 0.0));
        let mut search = Exhaustive::start(&problem, config(&[1.0, 1.0], 16)).unwrap();
        assert_eq!(search.remaining(), 40);
        let sample = search.sample(&problem, 4).unwrap();
        assert_eq!(sample, [[1.0, 1.0], [3.0, 3.0], [6.0, 1.0], [8.0, 3.0]]);
        search.step(&problem).unwrap();
        assert_eq!(search.remaining(), 24);
        let sample = search.sample(&problem, 100).unwrap();
        let all: Vec<[f64; 2]> = (16..40)
            .map(|n: i32| [f64::from(n / 4), f64::from(n % 4)])
            .collect();
        assert_eq!(sample, all);
        while !search.is_done() {
            search.step(&problem).unwrap();
        }
        assert_eq!(search.remaining(), 0);
        assert!(search.sample(&problem, 4).unwrap().is_empty());
    }

    #[test]
    fn validate_mixed_front_is_found_exactly() {
        let search = run(&mixed(), config(&[1.0, 1.0, 0.25, 0.1], 64));
        let front = search.front();
        assert_eq!(search.progress().evaluations, 13 * 5 * 5 * 11);
        assert_eq!(front.len(), 13);
        for (n, member) in (0_u8..).zip(&front) {
            let n = f64::from(n);
            // 0.3 on a grid of 0.1 is one rounding off.
            assert!((member.genome[3] - 0.3).abs() < 1e-15);
            assert_eq!(member.genome[..3], [n, 4.0, 1.0]);
        }
    }

    #[test]
    fn a_point_repaired_into_another_is_not_evaluated_twice() {
        let kinds = [
            VariableKind::Integer { lo: 2, hi: 4 },
            VariableKind::Integer { lo: 0, hi: 3 },
        ];
        let problem = TestProblem::new(&kinds, 1, |_| (vec![0.0], 0.0))
            .with_repair(|v| v[1] = v[1].min(v[0] - 1.0));
        let search = run(&problem, config(&[1.0, 1.0], 5));
        assert_eq!(search.progress().evaluations, 2 + 3 + 4);
        assert_eq!(search.front().len(), 9);
        // On a coarser grid the repaired point can be off it, and is needed then.
        let search = run(&problem, config(&[1.0, 3.0], 5));
        let genomes: Vec<Vec<f64>> = search.front().iter().map(|a| a.genome.clone()).collect();
        assert_eq!(
            genomes,
            [
                [2.0, 0.0],
                [2.0, 1.0],
                [3.0, 0.0],
                [3.0, 2.0],
                [4.0, 0.0],
                [4.0, 3.0]
            ]
        );
    }

    #[test]
    fn a_resumed_search_equals_an_unbroken_one() {
        let problem = mixed();
        let settings = config(&[1.0, 1.0, 0.5, 0.3], 50);
        let unbroken = run(&problem, settings.clone());
        let mut broken = Exhaustive::start(&problem, settings).unwrap();
        while !broken.is_done() {
            broken.step(&problem).unwrap();
            let text = serde_json::to_string(&broken).unwrap();
            broken = serde_json::from_str(&text).unwrap();
        }
        assert_eq!(broken, unbroken);
    }

    #[test]
    fn grids_that_make_no_sense_are_refused() {
        let kinds = [VariableKind::Integer { lo: 0, hi: 9 }, UNIT];
        let problem = TestProblem::new(&kinds, 1, |_| (vec![0.0], 0.0));
        let refused = |steps: &[f64], batch| {
            let refused = Exhaustive::start(&problem, config(steps, batch));
            refused.unwrap_err().to_string()
        };
        assert_eq!(refused(&[1.0], 1), "there are 1 grid steps for 2 variables");
        assert_eq!(refused(&[1.0, 0.1], 0), "batch must be at least 1, found 0");
        assert_eq!(
            refused(&[0.5, 0.1], 1),
            "grid step must be whole for an integer or a choice, found 0.5"
        );
        for step in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(refused(&[1.0, step], 1).contains("finite and greater than 0"));
        }
        assert!(matches!(
            Exhaustive::start(&problem, config(&[1.0, 1e-300], 1)),
            Err(OptimizeError::GridTooLarge { .. })
        ));
        let mut damaged = Exhaustive::start(&problem, config(&[1.0, 0.5], 4)).unwrap();
        damaged.points = 31;
        assert_eq!(
            damaged.step(&problem).unwrap_err().to_string(),
            "the checkpoint does not match: grid points is 31, expected 30"
        );
    }
}

//! Random search: the non-dominated ones of uniform draws. Any other strategy has
//! to beat it at the same number of evaluations.

use serde::{Deserialize, Serialize};

use super::archive::offer;
use super::error::OptimizeError;
use super::generator::Generator;
use super::history::History;
use super::problem::{Individual, Problem, admit, evaluate};
use super::sorting::feasible_front;
use super::strategy::{Progress, Record, Strategy, check_at_most, check_count, check_objectives};

/// The settings of random search.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RandomConfig {
    /// Designs to evaluate, at least 1.
    pub evaluations: usize,
    /// Designs in a step, at least 1. The result depends on it, because every step
    /// draws from its own stream.
    pub batch: usize,
    /// Where the history measures hypervolume: one coordinate per objective.
    pub hypervolume_reference: Option<Vec<f64>>,
}

impl Default for RandomConfig {
    /// The number of evaluations that NSGA-II makes by default.
    fn default() -> Self {
        Self {
            evaluations: 900,
            batch: 30,
            hypervolume_reference: None,
        }
    }
}

impl RandomConfig {
    fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        check_count("evaluations", self.evaluations)?;
        check_count("batch", self.batch)?;
        check_objectives(problem, self.hypervolume_reference.as_deref())
    }

    /// Designs evaluated after a number of steps.
    fn evaluated(&self, step: u64) -> u64 {
        (self.evaluations as u64).min(step.saturating_mul(self.batch as u64))
    }
}

/// A random search, its own checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RandomSearch {
    config: RandomConfig,
    seed: u64,
    step: u64,
    archive: Vec<Individual>,
    history: History,
}

impl RandomSearch {
    /// A search before its first step.
    ///
    /// # Errors
    ///
    /// A setting out of its range, a problem without objectives, or a reference
    /// that does not fit them.
    pub fn start(
        problem: &dyn Problem,
        config: RandomConfig,
        seed: u64,
    ) -> Result<Self, OptimizeError> {
        config.check(problem)?;
        Ok(Self {
            config,
            seed,
            step: 0,
            archive: Vec::new(),
            history: History::default(),
        })
    }

    /// Sets the total number of evaluations.
    pub(super) fn set_evaluations(&mut self, evaluations: usize) {
        self.config.evaluations = evaluations;
    }

    pub(super) fn history_mut(&mut self) -> &mut History {
        &mut self.history
    }

    pub(super) fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        self.config.check(problem)?;
        self.history.check(problem, self.step)?;
        let evaluations = self.config.evaluated(self.step);
        check_at_most("archive", self.archive.len() as u64, evaluations)?;
        self.archive.iter().try_for_each(|a| a.check(problem))
    }
}

impl Strategy for RandomSearch {
    fn step(&mut self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        if self.is_done() {
            return Ok(());
        }
        self.check(problem)?;
        let mut generator = Generator::new(self.seed, self.step);
        let (before, after) = (
            self.config.evaluated(self.step),
            self.config.evaluated(self.step + 1),
        );
        let draws = (before..after).map(|_| admit(problem, problem.space().draw(&mut generator)));
        let batch = draws.collect::<Result<_, _>>()?;
        let found = evaluate(problem, batch)?;
        self.history.learn(&found);
        for candidate in &found {
            offer(&mut self.archive, candidate);
        }
        self.step += 1;
        let reference = self.config.hypervolume_reference.as_deref();
        let progress = self.progress();
        self.history
            .record_archive(progress, &self.archive, reference);
        Ok(())
    }

    fn progress(&self) -> Progress {
        Progress {
            step: self.step,
            steps: self.config.evaluations.div_ceil(self.config.batch.max(1)) as u64,
            evaluations: self.config.evaluated(self.step),
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
    use super::super::test_problems::{TestProblem, UNIT, binh_korn, mixed};
    use super::*;

    fn run(problem: &dyn Problem, config: &RandomConfig, seed: u64) -> RandomSearch {
        let mut search = RandomSearch::start(problem, config.clone(), seed).unwrap();
        while !search.is_done() {
            search.step(problem).unwrap();
        }
        search
    }

    #[test]
    fn the_budget_is_met_exactly_and_the_front_only_improves() {
        let config = RandomConfig {
            evaluations: 100,
            batch: 30,
            hypervolume_reference: Some(vec![140.0, 50.0]),
        };
        let search = run(&binh_korn(), &config, 1);
        let counts: Vec<u64> = search.history().iter().map(|r| r.evaluations).collect();
        assert_eq!(counts, [30, 60, 90, 100]);
        let volumes: Vec<f64> = search
            .history()
            .iter()
            .filter_map(|r| r.hypervolume)
            .collect();
        assert!(
            volumes.windows(2).all(|pair| pair[0] <= pair[1]),
            "{volumes:?}"
        );
        assert_eq!(volumes.len(), 4);
        assert!(search.front().iter().all(Individual::is_feasible));
    }

    #[test]
    fn a_resumed_search_equals_an_unbroken_one() {
        let problem = mixed();
        let unbroken = run(&problem, &RandomConfig::default(), 2);
        let mut broken = RandomSearch::start(&problem, RandomConfig::default(), 2).unwrap();
        while !broken.is_done() {
            broken.step(&problem).unwrap();
            let text = serde_json::to_string(&broken).unwrap();
            broken = serde_json::from_str(&text).unwrap();
        }
        assert_eq!(broken, unbroken);
        assert_ne!(
            unbroken.front(),
            run(&problem, &RandomConfig::default(), 3).front()
        );
    }

    #[test]
    fn every_step_draws_anew() {
        // If all objectives are equal nothing dominates, so every draw is in the front.
        let flat = TestProblem::new(&[UNIT], 1, |_| (vec![0.0], 0.0));
        let search = run(&flat, &RandomConfig::default(), 1);
        assert_eq!(search.front().len(), 900);
    }

    #[test]
    fn nonsense_is_refused() {
        let problem = mixed();
        let config = |evaluations, batch| RandomConfig {
            evaluations,
            batch,
            hypervolume_reference: None,
        };
        for (evaluations, batch) in [(0, 1), (1, 0)] {
            assert!(RandomSearch::start(&problem, config(evaluations, batch), 1).is_err());
        }
        let mut damaged = RandomSearch::start(&problem, config(9, 3), 1).unwrap();
        damaged.step = 1;
        assert!(matches!(
            damaged.step(&problem),
            Err(OptimizeError::Checkpoint { .. })
        ));
    }
}

//! All strategies in one type that a caller chooses, runs and stores.

use serde::{Deserialize, Serialize};

use super::error::OptimizeError;
use super::exhaustive::{Exhaustive, ExhaustiveConfig};
use super::mopso::{Mopso, MopsoConfig};
use super::nsga2::{Nsga2, Nsga2Config};
use super::problem::{Individual, Problem};
use super::random::{RandomConfig, RandomSearch};
use super::strategy::{Progress, Record, Strategy};

/// A strategy and its settings.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The non-dominated sorting genetic algorithm.
    Nsga2(Nsga2Config),
    /// The particle swarm.
    Mopso(MopsoConfig),
    /// Uniform draws.
    Random(RandomConfig),
    /// Every point of a grid.
    Exhaustive(ExhaustiveConfig),
}

impl Method {
    /// A search before its first step; nothing is evaluated yet. An exhaustive
    /// search ignores the seed.
    ///
    /// # Errors
    ///
    /// As the strategy's own `start`.
    pub fn start(self, problem: &dyn Problem, seed: u64) -> Result<Search, OptimizeError> {
        Ok(match self {
            Self::Nsga2(config) => Search::Nsga2(Nsga2::start(problem, config, seed)?),
            Self::Mopso(config) => Search::Mopso(Mopso::start(problem, config, seed)?),
            Self::Random(config) => Search::Random(RandomSearch::start(problem, config, seed)?),
            Self::Exhaustive(config) => Search::Exhaustive(Exhaustive::start(problem, config)?),
        })
    }
}

/// A search in progress with any strategy; it is its own checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Search {
    /// The non-dominated sorting genetic algorithm.
    Nsga2(Nsga2),
    /// The particle swarm.
    Mopso(Mopso),
    /// Uniform draws.
    Random(RandomSearch),
    /// Every point of a grid.
    Exhaustive(Exhaustive),
}

impl Search {
    /// Gives the search the number of steps of `method`, to continue beyond the number that it was
    /// started with. A search does not depend on when it will stop, so the result equals that of one
    /// started with the larger number.
    pub fn set_budget(&mut self, method: &Method) {
        match (self, method) {
            (Self::Nsga2(search), Method::Nsga2(config)) => {
                search.set_generations(config.generations);
            }
            (Self::Mopso(search), Method::Mopso(config)) => {
                search.set_iterations(config.iterations);
            }
            (Self::Random(search), Method::Random(config)) => {
                search.set_evaluations(config.evaluations);
            }
            // The length of a grid is fixed, and another strategy's budget does not apply.
            _ => {}
        }
    }

    fn strategy(&self) -> &dyn Strategy {
        match self {
            Self::Nsga2(search) => search,
            Self::Mopso(search) => search,
            Self::Random(search) => search,
            Self::Exhaustive(search) => search,
        }
    }
}

impl Strategy for Search {
    fn step(&mut self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        match self {
            Self::Nsga2(search) => search.step(problem),
            Self::Mopso(search) => search.step(problem),
            Self::Random(search) => search.step(problem),
            Self::Exhaustive(search) => search.step(problem),
        }
    }

    fn progress(&self) -> Progress {
        self.strategy().progress()
    }

    fn front(&self) -> Vec<Individual> {
        self.strategy().front()
    }

    fn history(&self) -> &[Record] {
        self.strategy().history()
    }

    fn chosen_reference(&self) -> Option<&[f64]> {
        self.strategy().chosen_reference()
    }
}

#[cfg(test)]
mod tests {
    use super::super::hypervolume;
    use super::super::test_problems::mixed;
    use super::*;

    fn methods() -> [Method; 4] {
        let steps = vec![1.0, 1.0, 0.25, 0.3];
        let batch = 100;
        [
            Method::Nsga2(Nsga2Config::default()),
            Method::Mopso(MopsoConfig::default()),
            Method::Random(RandomConfig::default()),
            Method::Exhaustive(ExhaustiveConfig {
                steps,
                batch,
                hypervolume_reference: None,
            }),
        ]
    }

    #[test]
    fn a_search_that_goes_on_is_one_that_began_longer() {
        let problem = mixed();
        let methods = |steps: usize| {
            let (mut nsga2, mut mopso, mut random) = (
                Nsga2Config::default(),
                MopsoConfig::default(),
                RandomConfig::default(),
            );
            (nsga2.generations, mopso.iterations) = (steps, steps);
            random.evaluations = steps * random.batch;
            [
                Method::Nsga2(nsga2),
                Method::Mopso(mopso),
                Method::Random(random),
            ]
        };
        for (short, long) in methods(3).into_iter().zip(methods(5)) {
            let mut continued = short.start(&problem, 5).unwrap();
            let mut unbroken = long.clone().start(&problem, 5).unwrap();
            while !continued.is_done() {
                continued.step(&problem).unwrap();
            }
            continued.set_budget(&long);
            for search in [&mut continued, &mut unbroken] {
                while !search.is_done() {
                    search.step(&problem).unwrap();
                }
            }
            assert_eq!(continued, unbroken);
        }
    }

    #[test]
    fn one_loop_runs_every_strategy_from_checkpoint_to_checkpoint() {
        let problem = mixed();
        for method in methods() {
            let mut unbroken = method.clone().start(&problem, 5).unwrap();
            let mut broken = method.start(&problem, 5).unwrap();
            while !unbroken.is_done() {
                unbroken.step(&problem).unwrap();
                broken.step(&problem).unwrap();
                let text = serde_json::to_string(&broken).unwrap();
                broken = serde_json::from_str(&text).unwrap();
                assert_eq!(broken, unbroken);
            }
            let progress = unbroken.progress();
            assert_eq!(progress.step, progress.steps);
            assert_eq!(unbroken.history().len() as u64, progress.steps);
            let last = unbroken.history().last().unwrap();
            assert_eq!(last.evaluations, progress.evaluations);
            assert_eq!(last.front_size, unbroken.front().len());
        }
    }

    #[test]
    fn guided_strategies_beat_random_search_at_equal_evaluations() {
        let problem = mixed();
        let mean_volume = |method: &Method| {
            let volume = |seed| {
                let mut search = method.clone().start(&problem, seed).unwrap();
                while !search.is_done() {
                    search.step(&problem).unwrap();
                }
                assert_eq!(search.progress().evaluations, 900);
                let front = search.front();
                let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
                hypervolume(&points, &[13.0, 13.0])
            };
            (1..=5).map(volume).sum::<f64>() / 5.0
        };
        let [nsga2, mopso, random, _] = methods();
        let random = mean_volume(&random);
        assert!(mean_volume(&nsga2) > random);
        assert!(mean_volume(&mopso) > random);
    }
}

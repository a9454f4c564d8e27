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

    /// Checks a search that comes from outside, as from a checkpoint, against the problem: lengths,
    /// counts and bounds, so that no later call on it can fail.
    ///
    /// # Errors
    ///
    /// If the search is not one of this problem.
    pub fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        match self {
            Self::Nsga2(search) => search.check(problem),
            Self::Mopso(search) => search.check(problem),
            Self::Random(search) => search.check(problem),
            Self::Exhaustive(search) => search.check(problem),
        }
    }

    /// The records of the steps so far, which can be kept apart from the rest of the state, as in a
    /// checkpoint; a search continues only with all of them.
    pub fn records_mut(&mut self) -> &mut Vec<Record> {
        let history = match self {
            Self::Nsga2(search) => search.history_mut(),
            Self::Mopso(search) => search.history_mut(),
            Self::Random(search) => search.history_mut(),
            Self::Exhaustive(search) => search.history_mut(),
        };
        history.records_mut()
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
    use super::super::test_problems::{CATEGORICAL_AREA, categorical, mixed};
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

    /// The reference point that a search chooses is told, and is the one at which its last hypervolume was measured.
    #[test]
    fn the_reference_that_a_search_chooses_is_that_of_its_hypervolume() {
        let problem = mixed();
        for method in methods() {
            let mut search = method.start(&problem, 5).unwrap();
            assert_eq!(search.chosen_reference(), None);
            for _ in 0..3 {
                search.step(&problem).unwrap();
            }
            let front = search.front();
            let points: Vec<&[f64]> = front.iter().map(|one| one.objectives.as_slice()).collect();
            let volume = hypervolume(&points, search.chosen_reference().unwrap());
            let last = search.history().last().unwrap();
            assert!(volume > 0.0);
            assert_eq!(last.hypervolume, Some(volume));
        }
    }

    /// Every value of a search that is one shorter, or that is missing, is noticed or does no harm.
    #[test]
    fn a_search_of_other_lengths_is_refused() {
        let problem = mixed();
        for method in methods() {
            let mut search = method.start(&problem, 5).unwrap();
            for _ in 0..3 {
                search.step(&problem).unwrap();
            }
            search.check(&problem).unwrap();
            let value = serde_json::to_value(&search).unwrap();
            let mut paths = Vec::new();
            arrays(&value, String::new(), &mut paths);
            assert!(
                paths.iter().any(|path| path.ends_with("/ideal")),
                "{paths:?}"
            );
            for path in &paths {
                let mut spoiled = value.clone();
                spoiled
                    .pointer_mut(path)
                    .unwrap()
                    .as_array_mut()
                    .unwrap()
                    .pop();
                let Ok(spoiled) = serde_json::from_value::<Search>(spoiled) else {
                    continue;
                };
                // A set may have fewer members, and a record fewer points.
                let is_free = ["/archive", "/front", "/population", "/nearly_feasible"]
                    .iter()
                    .any(|end| path.ends_with(end));
                assert!(is_free || spoiled.check(&problem).is_err(), "{path}");
                if spoiled.check(&problem).is_ok() {
                    spoiled.front();
                }
            }
        }
    }

    /// The places of all lists in a value.
    fn arrays(value: &serde_json::Value, path: String, found: &mut Vec<String>) {
        let children: Vec<(String, &serde_json::Value)> = match value {
            serde_json::Value::Array(list) => {
                found.push(path.clone());
                let numbered = list.iter().enumerate();
                numbered.map(|(n, value)| (n.to_string(), value)).collect()
            }
            serde_json::Value::Object(map) => map
                .iter()
                .map(|(name, value)| (name.clone(), value))
                .collect(),
            _ => Vec::new(),
        };
        for (name, child) in children {
            arrays(child, format!("{path}/{name}"), found);
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

    /// The front of a problem with a choice, in its whole by a sweep and better by the guided strategies than by
    /// chance.
    #[test]
    fn every_strategy_makes_choices() {
        let problem = categorical();
        let share = |method: &Method| {
            let mut search = method.clone().start(&problem, 2).unwrap();
            while !search.is_done() {
                search.step(&problem).unwrap();
            }
            let front = search.front();
            let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
            hypervolume(&points, &[1.1, 1.1]) / CATEGORICAL_AREA
        };
        let [nsga2, mopso, random, _] = methods();
        let sweep = Method::Exhaustive(ExhaustiveConfig {
            steps: vec![1.0, 1.0, 0.25, 0.3],
            batch: 100,
            hypervolume_reference: None,
        });
        // Steps of 1/32 along the front: 32 triangles of 1/32 by 1/32 are lost.
        let lost = 32.0 * 0.5 / 32.0 / 32.0;
        let expected = 1.0 - lost / CATEGORICAL_AREA;
        assert!((share(&sweep) - expected).abs() < 1e-12);
        let random = share(&random);
        assert!(share(&nsga2) > random);
        assert!(share(&mopso) > random);
    }
}

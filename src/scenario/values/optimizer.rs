//! The settings of the search.

use crate::scenario::Algorithm;
use crate::scenario::keys::section;
use crate::scenario::rule::{Integer, Number, OneOf};

section! {
    /// The algorithm of the search and its settings.
    #[derive(Debug, Clone, Copy, PartialEq)]
    pub struct Optimizer in "optimizer" {
        /// Strategy of the search.
        pub algorithm: Algorithm = OneOf::new(), default Algorithm::Nsga2;
        /// Designs per generation.
        pub population: u32 = Integer { low: 4, high: 10_000 }, default 30;
        /// Number of generations.
        pub generations: u32 = Integer { low: 1, high: 1_000_000 }, default 30;
        /// Probability that two parents are crossed.
        pub crossover_probability: f64 = Number::from_to(0.0, 1.0), default 0.8;
        /// Probability that a variable is mutated.
        pub mutation_probability: f64 = Number::from_to(0.0, 1.0), default 0.1;
        /// Distribution index of simulated binary crossover; larger keeps children closer to their
        /// parents.
        pub crossover_index: f64 = Number::at_least(0.0), default 5.0;
        /// Distribution index of polynomial mutation; larger makes smaller steps.
        pub mutation_index: f64 = Number::at_least(0.0), default 10.0;
        /// Seed of the random numbers; the same seed gives the same result.
        pub seed: u64 = Integer { low: 0, high: u64::MAX }, default 1;
    }
}

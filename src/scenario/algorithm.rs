//! The strategies of the search, as named in a scenario.

use crate::keyword::keywords;

keywords! {
    /// The strategy of the search.
    Algorithm {
        /// NSGA-II.
        Nsga2 = "nsga2",
        /// Multi-objective particle swarm.
        Mopso = "mopso",
        /// Uniform random sampling.
        Random = "random",
        /// Every design on the grid of steps.
        Exhaustive = "exhaustive",
    }
}

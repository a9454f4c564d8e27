//! The strategies of the search, as a scenario names them.

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
        /// Every design of the lattice that the steps span.
        Exhaustive = "exhaustive",
    }
}

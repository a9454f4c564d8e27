//! NSGA-II, the elitist non-dominated sorting genetic algorithm.
//!
//! Source: K. Deb, A. Pratap, S. Agarwal, T. Meyarivan, "A fast and elitist
//! multiobjective genetic algorithm: NSGA-II", IEEE Transactions on Evolutionary
//! Computation 6(2), 2002. With one objective it is an elitist genetic algorithm.
//!
//! What differs from that paper, and why:
//!
//! - A last front with too many members is pruned one member at a time
//!   ([`prune_one_by_one`]), since removing several at once leaves holes.
//! - No two individuals are the same design: a child that repeats one is drawn
//!   again, because in a space with few values copies would fill the population.
//!   In a space with fewer points than the population all of them end up in it.
//! - Values without effect, such as those of an absent part, are kept and passed on
//!   (O. Abdelkhalik, "Hidden genes genetic optimization for variable-size design
//!   space problems", Journal of Optimization Theory and Applications 156, 2013): a
//!   part that comes back has the variety of its ancestors.
//! - Tournaments pick both contestants independently, which lets any number of
//!   children be drawn again, and compare crowding among the survivors.
//! - Some parents are nearly feasible designs that are kept beside the population (`near`): constraint
//!   domination alone loses a better design for the smallest violation.
//! - Children outside a bound are moved onto it, and integers are crossed as reals
//!   and mutated in integer steps, as `variation` explains.

use std::collections::HashSet;

use serde::{Deserialize, Serialize};

use super::error::OptimizeError;
use super::generator::Generator;
use super::history::History;
use super::near;
use super::problem::{Individual, Problem, admit, evaluate, repaired};
use super::sorting::{crowding_distance, feasible_front, non_dominated_sort, prune_one_by_one};
use super::strategy::{
    Progress, Record, Strategy, check_at_most, check_count, check_equal, check_objectives,
    check_probability, check_setting,
};
use super::variation::{cross, mutate};

/// Draws allowed per individual of the population before a batch is sent short: in
/// a space with few points left, new ones cannot always be found.
const DRAWS_PER_INDIVIDUAL: usize = 100;

/// The settings of NSGA-II; by default 30 individuals, 30 generations, and
/// crossover and mutation with probabilities 0.8 and 0.1.
///
/// The distribution indices are 5 and 10 by default, below the customary 15 to 20:
/// thirty generations are too few for small steps, and with the customary ones a
/// run occasionally ends several percent short of the achievable hypervolume.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nsga2Config {
    /// Individuals kept from one generation to the next, at least 1. An odd
    /// number is not a problem: of the last pair, one child is left out.
    pub population: usize,
    /// Generations, at least 1. The random initial population is the first, so
    /// that evaluations never exceed `population * generations`.
    pub generations: usize,
    /// The chance that a pair of parents is crossed rather than copied.
    pub crossover_probability: f64,
    /// The chance that a variable of a child is mutated.
    pub mutation_probability: f64,
    /// Distribution index of simulated binary crossover, at least 0.
    pub crossover_index: f64,
    /// Distribution index of polynomial mutation, at least 0.
    pub mutation_index: f64,
    /// Where the history measures hypervolume: one coordinate per objective.
    pub hypervolume_reference: Option<Vec<f64>>,
}

impl Default for Nsga2Config {
    fn default() -> Self {
        Self {
            population: 30,
            generations: 30,
            crossover_probability: 0.8,
            mutation_probability: 0.1,
            crossover_index: 5.0,
            mutation_index: 10.0,
            hypervolume_reference: None,
        }
    }
}

impl Nsga2Config {
    fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        let check_index = |setting, value: f64| {
            let valid = value.is_finite() && value >= 0.0;
            check_setting(valid, setting, value, "finite and at least 0")
        };
        check_count("population", self.population)?;
        check_count("generations", self.generations)?;
        check_probability("crossover probability", self.crossover_probability)?;
        check_probability("mutation probability", self.mutation_probability)?;
        check_index("crossover index", self.crossover_index)?;
        check_index("mutation index", self.mutation_index)?;
        check_objectives(problem, self.hypervolume_reference.as_deref())
    }
}

/// A run of NSGA-II, its own checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Nsga2 {
    config: Nsga2Config,
    seed: u64,
    generation: u64,
    evaluations: u64,
    population: Vec<Individual>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    nearly_feasible: Vec<Individual>,
    history: History,
}

impl Nsga2 {
    /// A run before its first generation; nothing is evaluated yet.
    ///
    /// # Errors
    ///
    /// A setting out of its range, a problem without objectives, or a reference
    /// that does not fit them.
    pub fn start(
        problem: &dyn Problem,
        config: Nsga2Config,
        seed: u64,
    ) -> Result<Self, OptimizeError> {
        config.check(problem)?;
        Ok(Self {
            config,
            seed,
            generation: 0,
            evaluations: 0,
            population: Vec::new(),
            nearly_feasible: Vec::new(),
            history: History::default(),
        })
    }

    /// Sets the total number of generations.
    pub(super) fn set_generations(&mut self, generations: usize) {
        self.config.generations = generations;
    }

    /// The settings with which the run was started.
    #[must_use]
    pub fn config(&self) -> &Nsga2Config {
        &self.config
    }

    /// The seed with which the run was started.
    #[must_use]
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The individuals of the current generation, feasible or not.
    #[must_use]
    pub fn population(&self) -> &[Individual] {
        &self.population
    }

    pub(super) fn history_mut(&mut self) -> &mut History {
        &mut self.history
    }

    /// A state can come from a file: nothing in it is taken for granted.
    pub(super) fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        self.config.check(problem)?;
        let held = self.population.len() as u64;
        check_at_most("population", held, self.config.population as u64)?;
        self.history.check(problem, self.generation)?;
        let evaluations = self
            .generation
            .saturating_mul(self.config.population as u64);
        check_at_most("evaluations", self.evaluations, evaluations)?;
        check_equal("population", u64::from(held > 0), self.generation.min(1))?;
        let beside = self.nearly_feasible.len() as u64;
        let most = near::most(self.config.population) as u64;
        check_at_most("nearly feasible designs", beside, most)?;
        let mut held = self.population.iter().chain(&self.nearly_feasible);
        held.try_for_each(|a| a.check(problem))
    }

    /// New genomes, of designs none of which is in the population or twice in the batch.
    fn offspring(&self, problem: &dyn Problem) -> Result<Vec<Vec<f64>>, OptimizeError> {
        let mut generator = Generator::new(self.seed, self.generation);
        let ranking = Ranking::new(&self.population);
        let size = self.config.population;
        let design = |genome: &Vec<f64>| Ok(bits(&admit(problem, genome.clone())?));
        let own = self.population.iter().map(|a| design(&a.genome));
        let mut known: HashSet<Vec<u64>> = own.collect::<Result<_, OptimizeError>>()?;
        let mut batch = Vec::new();
        for _ in 0..size.saturating_mul(DRAWS_PER_INDIVIDUAL) {
            for genome in self.draw(problem, &ranking, &mut generator) {
                let genome = repaired(problem, genome)?;
                if batch.len() < size && known.insert(design(&genome)?) {
                    batch.push(genome);
                }
            }
            if batch.len() == size {
                break;
            }
        }
        Ok(batch)
    }

    /// A pair of children, or of random genomes for the first generation.
    fn draw(
        &self,
        problem: &dyn Problem,
        ranking: &Ranking,
        generator: &mut Generator,
    ) -> [Vec<f64>; 2] {
        let space = problem.space();
        if self.population.is_empty() {
            return [space.draw(generator), space.draw(generator)];
        }
        // Until a design is feasible, the population itself has the least violated ones.
        let near = match self.population.iter().any(Individual::is_feasible) {
            true => self.nearly_feasible.as_slice(),
            false => &[],
        };
        let mut parent = || {
            let of_population = |generator| &self.population[ranking.tournament(generator)];
            match near::parent(near, generator) {
                Some(parent) => parent.genome.as_slice(),
                None => of_population(generator).genome.as_slice(),
            }
        };
        let parents = [parent(), parent()];
        let mut children = if generator.chance(self.config.crossover_probability) {
            cross(space, parents, self.config.crossover_index, generator)
        } else {
            parents.map(<[f64]>::to_vec)
        };
        let (probability, index) = (self.config.mutation_probability, self.config.mutation_index);
        for child in &mut children {
            mutate(space, child, probability, index, generator);
        }
        children
    }
}

impl Strategy for Nsga2 {
    fn step(&mut self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        if self.is_done() {
            return Ok(());
        }
        self.check(problem)?;
        let children = evaluate(problem, self.offspring(problem)?)?;
        self.evaluations += children.len() as u64;
        self.generation += 1;
        self.history.learn(&children);
        let infeasible = children.iter().filter(|a| !a.is_feasible());
        let infeasible: Vec<Individual> = infeasible.cloned().collect();
        self.population.extend(children);
        select(&mut self.population, self.config.population);
        let most = near::most(self.config.population);
        near::offer(
            &mut self.nearly_feasible,
            infeasible,
            &self.population,
            most,
        );
        let feasible = self.population.iter().filter(|a| a.is_feasible()).count();
        let (progress, front) = (self.progress(), self.front());
        let reference = self.config.hypervolume_reference.as_deref();
        self.history.record(progress, &front, feasible, reference);
        Ok(())
    }

    fn progress(&self) -> Progress {
        Progress {
            step: self.generation,
            steps: self.config.generations as u64,
            evaluations: self.evaluations,
        }
    }

    fn front(&self) -> Vec<Individual> {
        feasible_front(&self.population)
    }

    fn history(&self) -> &[Record] {
        self.history.records()
    }

    fn chosen_reference(&self) -> Option<&[f64]> {
        self.history.chosen_reference()
    }
}

/// Selects the `size` best of the merged parents and children, in their order:
/// complete fronts while there is room, then the least crowded of the next.
///
/// The merged set is what Deb et al. 2002 sort; a description of the algorithm
/// that sorts the children alone would lose the elite.
fn select(merged: &mut Vec<Individual>, size: usize) {
    let mut keep = vec![false; merged.len()];
    let mut room = size;
    for front in non_dominated_sort(merged) {
        if room == 0 {
            break;
        }
        for member in prune_one_by_one(merged, &front, room) {
            keep[member] = true;
            room -= 1;
        }
    }
    let mut keep = keep.into_iter();
    merged.retain(|_| keep.next().unwrap_or(false));
}

/// Front and crowding distance of every individual of a population.
struct Ranking {
    front: Vec<usize>,
    crowding: Vec<f64>,
}

impl Ranking {
    fn new(population: &[Individual]) -> Self {
        let mut ranking = Self {
            front: vec![0; population.len()],
            crowding: vec![0.0; population.len()],
        };
        for (rank, front) in non_dominated_sort(population).iter().enumerate() {
            let distances = crowding_distance(population, front);
            for (&member, distance) in front.iter().zip(distances) {
                ranking.front[member] = rank;
                ranking.crowding[member] = distance;
            }
        }
        ranking
    }

    /// The better of two random individuals: by front, then by crowding.
    fn tournament(&self, generator: &mut Generator) -> usize {
        let count = self.front.len();
        let (a, b) = (generator.below(count), generator.below(count));
        let earlier = self.front[b].cmp(&self.front[a]);
        let roomier = self.crowding[a].total_cmp(&self.crowding[b]);
        if earlier.then(roomier).is_lt() { b } else { a }
    }
}

/// A genome as a key; equal genomes have equal bits, since no value is a
/// negative zero.
fn bits(genome: &[f64]) -> Vec<u64> {
    genome.iter().map(|value| value.to_bits()).collect()
}

#[cfg(test)]
mod tests;

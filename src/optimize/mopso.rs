//! Multi-objective particle swarm optimisation.
//!
//! Particles propagate between their own best design and a leader from an archive of
//! non-dominated ones (C. A. Coello Coello, G. T. Pulido, M. S. Lechuga, "Handling
//! multiple objectives with particle swarm optimization", IEEE Transactions on
//! Evolutionary Computation 8(3), 2004) in the form of A. J. Nebro, J. J. Durillo,
//! J. García-Nieto, C. A. Coello Coello, F. Luna, E. Alba, "SMPSO: a new PSO-based
//! metaheuristic for multi-objective optimization", IEEE Symposium on Computational
//! Intelligence in Multicriteria Decision-Making 2009: the archive is limited and
//! leaders are drawn by crowding distance instead of an adaptive grid, speeds are
//! constricted and limited, and every sixth particle is mutated. The form of 2004
//! is too weak beyond a few variables: with its inertia of 0.4 a swarm of 100
//! reached less than half of ZDT1's hypervolume in 250 iterations.
//!
//! An integer variable moves like a real one, and its nearest integer is evaluated. A
//! choice has no direction: the particle keeps its own or takes that of its best or of
//! the leader, each with the same probability.

use serde::{Deserialize, Serialize};

use super::archive::offer;
use super::error::OptimizeError;
use super::generator::Generator;
use super::history::History;
use super::problem::{Individual, Problem, Space, VariableKind, admit, evaluate};
use super::sorting::{constraint_dominates, crowding_distance, feasible_front, prune_one_by_one};
use super::strategy::{
    Progress, Record, Strategy, check_at_most, check_count, check_equal, check_objectives,
    check_setting,
};
use super::variation::mutate;

/// The fraction of its velocity that a particle retains.
const INERTIA: f64 = 0.1;
/// The range from which both attractions are drawn for each particle.
const ATTRACTION: (f64, f64) = (1.5, 2.5);
/// The factor on the velocity after hitting a bound, including the reversal.
const REBOUND: f64 = -1.0;
/// Every particle whose number is a multiple of this one is mutated.
const MUTATED: usize = 6;
/// The distribution index of its polynomial mutation.
const MUTATION_INDEX: f64 = 20.0;

/// The settings of the particle swarm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MopsoConfig {
    /// Particles, at least 1.
    pub particles: usize,
    /// Iterations, at least 1. Placing the particles at random is the first, so
    /// that evaluations are `particles * iterations`.
    pub iterations: usize,
    /// Members of the archive, at least 1: the most that a front can have.
    pub archive: usize,
    /// Where the history measures hypervolume: one coordinate per objective.
    pub hypervolume_reference: Option<Vec<f64>>,
}

impl Default for MopsoConfig {
    /// The number of evaluations and the size of front of NSGA-II's default.
    fn default() -> Self {
        Self {
            particles: 30,
            iterations: 30,
            archive: 30,
            hypervolume_reference: None,
        }
    }
}

impl MopsoConfig {
    fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        check_count("particles", self.particles)?;
        check_count("iterations", self.iterations)?;
        check_count("archive", self.archive)?;
        check_objectives(problem, self.hypervolume_reference.as_deref())
    }
}

/// One particle; its position is real in every variable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Particle {
    position: Vec<f64>,
    velocity: Vec<f64>,
    best: Individual,
}

impl Particle {
    fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        let space = problem.space();
        space.check_confined(&self.position)?;
        check_equal(
            "velocity",
            self.velocity.len() as u64,
            self.position.len() as u64,
        )?;
        for &speed in &self.velocity {
            check_setting(speed.is_finite(), "velocity", speed, "finite")?;
        }
        self.best.check(problem)
    }

    /// The new position and velocity, attracted to the particle's own best and to a
    /// leader; at a bound it stops and reverses.
    fn propagate(
        &self,
        space: &Space,
        leader: &Individual,
        generator: &mut Generator,
    ) -> (Vec<f64>, Vec<f64>) {
        let (lo, hi) = ATTRACTION;
        let (own, shared) = (generator.between(lo, hi), generator.between(lo, hi));
        let constriction = constriction(own + shared);
        let (own, shared) = (own * generator.unit(), shared * generator.unit());
        let mut propagation = (self.position.clone(), self.velocity.clone());
        for (k, variable) in space.variables().iter().enumerate() {
            let (lo, hi) = variable.kind.bounds();
            let limit = 0.5 * (hi - lo);
            let position = self.position[k];
            if let VariableKind::Category { .. } = variable.kind {
                let choices = [position, self.best.genome[k], leader.genome[k]];
                propagation.0[k] = choices[generator.below(choices.len())];
                continue;
            }
            let pull =
                own * (self.best.genome[k] - position) + shared * (leader.genome[k] - position);
            let velocity = constriction * (INERTIA * self.velocity[k] + pull);
            let velocity = velocity.clamp(-limit, limit);
            let target = position + velocity;
            let inside = target.clamp(lo, hi);
            propagation.0[k] = inside;
            propagation.1[k] = if inside == target {
                velocity
            } else {
                REBOUND * velocity
            };
        }
        propagation
    }
}

/// The constriction of M. Clerc and J. Kennedy for attractions of sum φ:
/// 2/(2 - φ - √(φ² - 4 φ)) in size, none up to φ = 4.
fn constriction(sum: f64) -> f64 {
    if sum <= 4.0 {
        return 1.0;
    }
    2.0 / (sum - 2.0 + (sum * sum - 4.0 * sum).sqrt())
}

/// A run of the particle swarm, its own checkpoint.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Mopso {
    config: MopsoConfig,
    seed: u64,
    iteration: u64,
    swarm: Vec<Particle>,
    archive: Vec<Individual>,
    history: History,
}

impl Mopso {
    /// A run before its first iteration; nothing is evaluated yet.
    ///
    /// # Errors
    ///
    /// A setting out of its range, a problem without objectives, or a reference
    /// that does not fit them.
    pub fn start(
        problem: &dyn Problem,
        config: MopsoConfig,
        seed: u64,
    ) -> Result<Self, OptimizeError> {
        config.check(problem)?;
        Ok(Self {
            config,
            seed,
            iteration: 0,
            swarm: Vec::new(),
            archive: Vec::new(),
            history: History::default(),
        })
    }

    /// Sets the total number of iterations.
    pub(super) fn set_iterations(&mut self, iterations: usize) {
        self.config.iterations = iterations;
    }

    pub(super) fn history_mut(&mut self) -> &mut History {
        &mut self.history
    }

    pub(super) fn check(&self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        self.config.check(problem)?;
        let begun = self.iteration.min(1);
        let swarm = begun * self.config.particles as u64;
        check_equal("swarm", self.swarm.len() as u64, swarm)?;
        self.history.check(problem, self.iteration)?;
        let archive = self.archive.len() as u64;
        check_at_most("archive", archive, self.config.archive as u64)?;
        check_equal("archive", archive.min(1), begun)?;
        self.swarm.iter().try_for_each(|p| p.check(problem))?;
        self.archive.iter().try_for_each(|a| a.check(problem))
    }

    /// The next position and velocity of each particle.
    fn moves(&self, space: &Space, generator: &mut Generator) -> Vec<(Vec<f64>, Vec<f64>)> {
        if self.swarm.is_empty() {
            let still = vec![0.0; space.variables().len()];
            let place = |_| (space.draw(generator), still.clone());
            return (0..self.config.particles).map(place).collect();
        }
        let everyone: Vec<usize> = (0..self.archive.len()).collect();
        let crowding = crowding_distance(&self.archive, &everyone);
        let share = 1.0 / space.variables().len() as f64;
        let propagate = |(number, particle): (usize, &Particle)| {
            let leader = &self.archive[roomier(&crowding, generator)];
            let mut propagation = particle.propagate(space, leader, generator);
            if number % MUTATED == 0 {
                mutate(space, &mut propagation.0, share, MUTATION_INDEX, generator);
                space.confine(&mut propagation.0);
            }
            propagation
        };
        self.swarm.iter().enumerate().map(propagate).collect()
    }
}

/// The less crowded of two random members of the archive.
fn roomier(crowding: &[f64], generator: &mut Generator) -> usize {
    let (a, b) = (
        generator.below(crowding.len()),
        generator.below(crowding.len()),
    );
    if crowding[b] > crowding[a] { b } else { a }
}

impl Strategy for Mopso {
    fn step(&mut self, problem: &dyn Problem) -> Result<(), OptimizeError> {
        if self.is_done() {
            return Ok(());
        }
        self.check(problem)?;
        let mut generator = Generator::new(self.seed, self.iteration);
        let moves = self.moves(problem.space(), &mut generator);
        let genome = |(position, _): &(Vec<f64>, Vec<f64>)| admit(problem, position.clone());
        let batch = moves.iter().map(genome).collect::<Result<_, _>>()?;
        let found = evaluate(problem, batch)?;
        self.history.learn(&found);
        for candidate in &found {
            offer(&mut self.archive, candidate);
        }
        let everyone: Vec<usize> = (0..self.archive.len()).collect();
        let kept = prune_one_by_one(&self.archive, &everyone, self.config.archive);
        self.archive = kept.iter().map(|&k| self.archive[k].clone()).collect();
        let mut old = std::mem::take(&mut self.swarm).into_iter();
        for ((position, velocity), now) in moves.into_iter().zip(found) {
            let best = match old.next() {
                Some(particle) => better(particle.best, now, &mut generator),
                None => now,
            };
            self.swarm.push(Particle {
                position,
                velocity,
                best,
            });
        }
        self.iteration += 1;
        let reference = self.config.hypervolume_reference.as_deref();
        let progress = self.progress();
        self.history
            .record_archive(progress, &self.archive, reference);
        Ok(())
    }

    fn progress(&self) -> Progress {
        Progress {
            step: self.iteration,
            steps: self.config.iterations as u64,
            evaluations: self.iteration.saturating_mul(self.config.particles as u64),
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

/// The dominating one of a particle's best and present designs, either of them if
/// neither dominates.
fn better(best: Individual, now: Individual, generator: &mut Generator) -> Individual {
    let replace = if constraint_dominates(&now, &best) {
        true
    } else {
        !constraint_dominates(&best, &now) && generator.chance(0.5)
    };
    if replace { now } else { best }
}

#[cfg(test)]
mod tests {
    use super::super::hypervolume;
    use super::super::test_problems::{TestProblem, UNIT, binh_korn, constr, mixed, zdt1};
    use super::*;

    fn run(problem: &dyn Problem, config: &MopsoConfig, seed: u64) -> Mopso {
        let mut search = Mopso::start(problem, config.clone(), seed).unwrap();
        while !search.is_done() {
            search.step(problem).unwrap();
        }
        search
    }

    #[test]
    fn validate_binh_korn_hypervolume() {
        let config = MopsoConfig {
            particles: 60,
            iterations: 60,
            archive: 60,
            ..MopsoConfig::default()
        };
        let front = run(&binh_korn(), &config, 1).front();
        let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
        // The area above the true front: see the same test of NSGA-II, which has the
        // same tolerance for the gaps between sixty points.
        let area = 2232.0 + 2944.0 - 224.0 / 3.0 + 184.0;
        let share = hypervolume(&points, &[140.0, 50.0]) / area;
        assert!((0.985..1.0).contains(&share), "{share}");
    }

    #[test]
    fn validate_zdt1_comes_close() {
        let config = MopsoConfig {
            particles: 100,
            iterations: 250,
            archive: 100,
            ..MopsoConfig::default()
        };
        let front = run(&zdt1(), &config, 1).front();
        let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
        let share = hypervolume(&points, &[1.1, 1.1]) / (1.21 - 1.0 / 3.0);
        assert!((0.98..1.0).contains(&share), "{share}");
    }

    #[test]
    fn constraints_are_met_and_the_archive_keeps_its_size() {
        let config = MopsoConfig {
            archive: 7,
            ..MopsoConfig::default()
        };
        let search = run(&constr(), &config, 2);
        assert_eq!(search.archive.len(), 7);
        assert!(search.archive.iter().all(Individual::is_feasible));
        assert_eq!(search.progress().evaluations, 900);
    }

    #[test]
    fn positions_stay_between_the_bounds() {
        let problem = mixed();
        let mut search = Mopso::start(&problem, MopsoConfig::default(), 3).unwrap();
        while !search.is_done() {
            search.step(&problem).unwrap();
            for particle in &search.swarm {
                for (x, variable) in particle.position.iter().zip(problem.space().variables()) {
                    let (lo, hi) = variable.kind.bounds();
                    assert!((lo..=hi).contains(x), "{x} of {}", variable.name);
                }
            }
        }
    }

    #[test]
    fn a_particle_that_crosses_a_bound_is_turned_round() {
        let problem = mixed();
        let at = |genome: [f64; 4]| Individual {
            genome: genome.to_vec(),
            objectives: vec![0.0; 2],
            violation: 0.0,
        };
        let particle = Particle {
            position: vec![12.0, 1.0, 0.5, 0.0],
            velocity: vec![60.0, 0.0, 0.0, -1.0],
            best: at([12.0, 1.0, 0.5, 0.0]),
        };
        let mut generator = Generator::new(1, 1);
        let (position, velocity) =
            particle.propagate(problem.space(), &at([12.0, 1.0, 0.5, 0.0]), &mut generator);
        // Without attraction a tenth of the velocity remains, less if constricted.
        assert_eq!(position, [12.0, 1.0, 0.5, 0.0]);
        assert!((-6.0..-0.6).contains(&velocity[0]), "{velocity:?}");
        assert_eq!(velocity[1..3], [0.0, 0.0]);
        assert!((0.01..=0.1).contains(&velocity[3]), "{velocity:?}");
    }

    /// However fast it is, a particle goes no further in one step than half way between the bounds.
    #[test]
    fn a_step_is_at_most_half_of_the_range() {
        let problem = TestProblem::new(&[VariableKind::Real { lo: 10.0, hi: 14.0 }], 1, |_| {
            (vec![0.0], 0.0)
        });
        for (from, velocity, to, kept) in [(10.5, 1e6, 12.5, 2.0), (13.5, -1e6, 11.5, -2.0)] {
            let here = Individual {
                genome: vec![from],
                objectives: vec![0.0],
                violation: 0.0,
            };
            let particle = Particle {
                position: vec![from],
                velocity: vec![velocity],
                best: here.clone(),
            };
            let mut generator = Generator::new(1, 1);
            let moved = particle.propagate(problem.space(), &here, &mut generator);
            assert_eq!(moved, (vec![to], vec![kept]));
        }
    }

    /// Nothing lies between two choices: a particle has its own, that of its best or that of the leader.
    #[test]
    fn a_choice_is_taken_and_not_approached() {
        let kinds = [VariableKind::Category { count: 5 }, UNIT];
        let problem = TestProblem::new(&kinds, 1, |_| (vec![0.0], 0.0));
        let at = |choice: f64| Individual {
            genome: vec![choice, 0.5],
            objectives: vec![0.0],
            violation: 0.0,
        };
        let particle = Particle {
            position: vec![0.0, 0.5],
            velocity: vec![1.0, 0.0],
            best: at(4.0),
        };
        let mut generator = Generator::new(1, 1);
        let mut counts = [0_i32; 5];
        for _ in 0..3000 {
            let (position, velocity) =
                particle.propagate(problem.space(), &at(2.0), &mut generator);
            assert_eq!(position[0], position[0].round(), "{position:?}");
            assert_eq!(velocity[0], 1.0);
            counts[position[0] as usize] += 1;
        }
        assert_eq!((counts[1], counts[3]), (0, 0));
        // Five standard deviations of a third of 3000: 129.
        assert!(
            [0, 2, 4]
                .iter()
                .all(|choice| (counts[*choice] - 1000).abs() < 129),
            "{counts:?}"
        );
    }

    #[test]
    fn validate_constriction() {
        // Clerc and Kennedy's usual case: φ = 4.1 gives χ = 0.7298 (four digits).
        assert!((constriction(4.1) - 0.7298).abs() < 5e-5);
        assert_eq!(constriction(3.9), 1.0);
        assert!((constriction(4.0 + 1e-12) - 1.0).abs() < 1e-5);
    }

    #[test]
    fn a_particle_remembers_its_best_design() {
        let design = |x: f64, y: f64| Individual {
            genome: vec![x, y],
            objectives: vec![x, y],
            violation: 0.0,
        };
        let mut generator = Generator::new(1, 2);
        let (old, new, aside) = (design(2.0, 2.0), design(1.0, 2.0), design(0.0, 9.0));
        let mut choose =
            |best: &Individual, now: &Individual| better(best.clone(), now.clone(), &mut generator);
        assert_eq!(choose(&old, &new), new);
        assert_eq!(choose(&new, &old), new);
        // Neither dominates: a coin decides, fairly within five standard
        // deviations, 5 sqrt(1000/4) = 79.
        let kept = (0..1000).filter(|_| choose(&old, &aside) == old).count();
        assert!(kept.abs_diff(500) < 79, "{kept}");
        let problem = mixed();
        let mut search = Mopso::start(&problem, MopsoConfig::default(), 1).unwrap();
        search.step(&problem).unwrap();
        for _ in 1..30 {
            let before = search.swarm.clone();
            search.step(&problem).unwrap();
            for (before, after) in before.iter().zip(&search.swarm) {
                assert!(!constraint_dominates(&before.best, &after.best));
            }
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let problem = mixed();
        let refused = |change: fn(&mut MopsoConfig)| {
            let mut config = MopsoConfig::default();
            change(&mut config);
            Mopso::start(&problem, config, 1).unwrap_err().to_string()
        };
        assert!(refused(|c| c.particles = 0).starts_with("particles must"));
        assert!(refused(|c| c.iterations = 0).starts_with("iterations must"));
        assert!(refused(|c| c.archive = 0).starts_with("archive must"));
        let mut sound = Mopso::start(&problem, MopsoConfig::default(), 1).unwrap();
        sound.step(&problem).unwrap();
        let damaged = |damage: fn(&mut Mopso)| {
            let mut search = sound.clone();
            damage(&mut search);
            search.step(&problem).unwrap_err().to_string()
        };
        assert!(damaged(|s| s.swarm.truncate(29)).contains("swarm is 29, expected 30"));
        assert!(damaged(|s| s.archive.clear()).contains("archive is 0, expected 1"));
        assert!(damaged(|s| s.swarm[0].velocity[0] = f64::NAN).contains("velocity must be finite"));
        assert!(damaged(|s| s.swarm[0].position.clear()).contains("0 values for 4 variables"));
        assert!(damaged(|s| s.swarm[0].velocity.clear()).contains("velocity is 0, expected 4"));
        assert!(damaged(|s| s.swarm[0].position[2] = 2.0).contains("2 is not a value"));
    }
}

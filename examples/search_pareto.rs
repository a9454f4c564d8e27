//! Searches with a custom objective: launch mass, with more propellant for higher orbits.
//!
//! `cargo run --release --example search_pareto`

use navwalker::evaluate::Evaluator;
use navwalker::optimize::{Evaluation, Method, Nsga2Config, Problem, Space, Strategy};
use navwalker::scenario::{Scenario, builtin};
use navwalker::search::DesignProblem;
use std::error::Error;
use std::io::{self, Write};

/// Satellites of 150 kg, and 20 kg of propellant for each 1000 km of altitude.
fn launch_mass_kg(satellites: usize, altitude_km: f64) -> f64 {
    satellites as f64 * (150.0 + 20.0 * altitude_km / 1000.0)
}

/// The design space of a scenario with objectives of our own. Everything but the objectives is
/// delegated.
struct MassProblem<'a> {
    designs: DesignProblem<'a>,
    names: [String; 2],
}

impl MassProblem<'_> {
    fn objectives(&self, genome: &[f64]) -> Option<Vec<f64>> {
        let (design, metrics) = self.designs.evaluated(genome)?;
        let design = design?;
        let mass_kg = launch_mass_kg(design.satellite_count(), design.highest_altitude_km());
        Some(vec![metrics.mean_pdop?, mass_kg])
    }
}

impl Problem for MassProblem<'_> {
    fn space(&self) -> &Space {
        self.designs.space()
    }

    fn objective_names(&self) -> &[String] {
        &self.names
    }

    fn repair(&self, genome: &mut [f64]) {
        self.designs.repair(genome);
    }

    fn unify(&self, genome: &mut [f64]) {
        self.designs.unify(genome);
    }

    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        let evaluate = |genome: &Vec<f64>| match self.objectives(genome) {
            Some(objectives) => Evaluation {
                objectives,
                violation: 0.0,
            },
            // Infeasible: no such orbit, or no sample with a solution.
            None => Evaluation {
                objectives: vec![f64::INFINITY; 2],
                violation: 1.0,
            },
        };
        batch.iter().map(evaluate).collect()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let overrides = [
        "time.step-s=300",
        "search.planes=[3, 15]",
        "search.satellites-per-plane=[3, 15]",
    ];
    let scenario = Scenario::parse("paper", builtin("paper")?.as_bytes(), &overrides)?;
    let evaluator = Evaluator::new(scenario.setup(&|path| Err(io::Error::other(path)))?)?;
    let problem = MassProblem {
        designs: DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals())?,
        names: ["mean-pdop".to_owned(), "launch-mass-kg".to_owned()],
    };
    let mut search = Method::Nsga2(Nsga2Config::default()).start(&problem, 1)?;
    while !search.is_done() {
        search.step(&problem)?;
    }

    let mut out = io::stdout().lock();
    writeln!(out, "mean PDOP  mass (t)  design")?;
    for member in search.front() {
        let [pdop, mass_kg] = member.objectives[..] else {
            continue;
        };
        let Some(design) = problem.designs.designs().design(&member.genome)? else {
            continue;
        };
        writeln!(out, "{pdop:9.4}  {:8.1}  {design}", mass_kg / 1000.0)?;
    }
    Ok(())
}

//! Hypervolumes of NSGA-II and the particle swarm on ZDT1 to 4 and 6 and on DTLZ2, to hold beside
//! those of `pymoo_nsga2.py`: 25 000 evaluations, the last population alone, seeds 1 to 10.
//!
//! `cargo run --release --example test_functions`

use navwalker::optimize::{
    Evaluation, Method, MopsoConfig, Nsga2Config, OptimizeError, Problem, Space, Strategy,
    Variable, VariableKind, hypervolume,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::io::{self, Write};

const SEEDS: u64 = 10;
const POPULATION: usize = 100;
const GENERATIONS: usize = 250;

type Function = fn(&[f64]) -> Vec<f64>;

struct TestFunction {
    name: &'static str,
    space: Space,
    objectives: Vec<String>,
    function: Function,
}

impl TestFunction {
    /// `variables` of them in [0, 1], or the first there and all others in [-5, 5].
    fn new(
        name: &'static str,
        (variables, objectives): (usize, usize),
        wide: bool,
        function: Function,
    ) -> Result<Self, OptimizeError> {
        let kind = |k| match wide && k > 0 {
            true => VariableKind::Real { lo: -5.0, hi: 5.0 },
            false => VariableKind::Real { lo: 0.0, hi: 1.0 },
        };
        let variable = |k| Variable {
            name: format!("x{k}"),
            kind: kind(k),
        };
        Ok(Self {
            name,
            space: Space::new((0..variables).map(variable).collect())?,
            objectives: (0..objectives).map(|m| format!("f{m}")).collect(),
            function,
        })
    }
}

impl Problem for TestFunction {
    fn space(&self) -> &Space {
        &self.space
    }
    fn objective_names(&self) -> &[String] {
        &self.objectives
    }
    fn evaluate(&self, batch: &[Vec<f64>]) -> Vec<Evaluation> {
        let evaluate = |x: &Vec<f64>| Evaluation {
            objectives: (self.function)(x),
            violation: 0.0,
        };
        batch.iter().map(evaluate).collect()
    }
}

/// g of ZDT1 to 3 (Zitzler, Deb and Thiele, Evolutionary Computation 8(2), 2000).
fn g(x: &[f64]) -> f64 {
    1.0 + 9.0 * x[1..].iter().sum::<f64>() / (x.len() - 1) as f64
}

fn test_functions() -> Result<Vec<TestFunction>, OptimizeError> {
    Ok(vec![
        TestFunction::new("zdt1", (30, 2), false, |x| {
            vec![x[0], g(x) * (1.0 - (x[0] / g(x)).sqrt())]
        })?,
        TestFunction::new("zdt2", (30, 2), false, |x| {
            vec![x[0], g(x) * (1.0 - (x[0] / g(x)).powi(2))]
        })?,
        TestFunction::new("zdt3", (30, 2), false, |x| {
            let ratio = x[0] / g(x);
            let wave = ratio * (10.0 * PI * x[0]).sin();
            vec![x[0], g(x) * (1.0 - ratio.sqrt() - wave)]
        })?,
        TestFunction::new("zdt4", (10, 2), true, |x| {
            let rough = |x: &f64| x * x - 10.0 * (4.0 * PI * x).cos();
            let g = 1.0 + 10.0 * (x.len() - 1) as f64 + x[1..].iter().map(rough).sum::<f64>();
            vec![x[0], g * (1.0 - (x[0] / g).sqrt())]
        })?,
        TestFunction::new("zdt6", (10, 2), false, |x| {
            let mean = x[1..].iter().sum::<f64>() / (x.len() - 1) as f64;
            let g = 1.0 + 9.0 * mean.powf(0.25);
            let f = 1.0 - (-4.0 * x[0]).exp() * (6.0 * PI * x[0]).sin().powi(6);
            vec![f, g * (1.0 - (f / g).powi(2))]
        })?,
        // Deb, Thiele, Laumanns and Zitzler, IEEE Congress on Evolutionary Computation 2002; as in
        // pymoo with 10 variables.
        TestFunction::new("dtlz2", (10, 3), false, |x| {
            let g: f64 = x[2..].iter().map(|x| (x - 0.5).powi(2)).sum();
            let (a, b) = (x[0] * FRAC_PI_2, x[1] * FRAC_PI_2);
            let radius = 1.0 + g;
            vec![
                radius * a.cos() * b.cos(),
                radius * a.cos() * b.sin(),
                radius * a.sin(),
            ]
        })?,
    ])
}

fn methods(variables: usize) -> [(&'static str, Method); 3] {
    let nsga2 = Nsga2Config {
        population: POPULATION,
        generations: GENERATIONS,
        crossover_probability: 0.9,
        mutation_probability: 1.0 / variables as f64,
        ..Nsga2Config::default()
    };
    let customary = Nsga2Config {
        crossover_index: 15.0,
        mutation_index: 20.0,
        ..nsga2.clone()
    };
    let swarm = MopsoConfig {
        particles: POPULATION,
        iterations: GENERATIONS,
        archive: POPULATION,
        hypervolume_reference: None,
    };
    [
        ("nsga2", Method::Nsga2(nsga2)),
        ("nsga2, indices 15 and 20", Method::Nsga2(customary)),
        ("mopso", Method::Mopso(swarm)),
    ]
}

fn volume(problem: &TestFunction, method: Method, seed: u64) -> Result<f64, OptimizeError> {
    let mut search = method.start(problem, seed)?;
    while !search.is_done() {
        search.step(problem)?;
    }
    let front = search.front();
    let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
    Ok(hypervolume(&points, &vec![1.1; problem.objectives.len()]))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = io::stdout().lock();
    writeln!(out, "problem,method,mean,min,max,std_dev")?;
    for problem in test_functions()? {
        for (name, method) in methods(problem.space.variables().len()) {
            let volumes = (1..=SEEDS).map(|seed| volume(&problem, method.clone(), seed));
            let volumes = volumes.collect::<Result<Vec<f64>, _>>()?;
            let mean = volumes.iter().sum::<f64>() / SEEDS as f64;
            let squares: f64 = volumes.iter().map(|v| (v - mean).powi(2)).sum();
            let deviation = (squares / (SEEDS - 1) as f64).sqrt();
            let least = volumes.iter().copied().fold(f64::INFINITY, f64::min);
            let greatest = volumes.iter().copied().fold(0.0, f64::max);
            writeln!(
                out,
                "{},{name},{mean:.5},{least:.5},{greatest:.5},{deviation:.5}",
                problem.name
            )?;
        }
    }
    Ok(())
}

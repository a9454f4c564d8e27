//! Searches among hybrids of two shells, small enough to sweep whole.

use super::super::testing::shell;
use super::super::*;
use crate::constellation::Pattern;
use crate::constellation::gnss::Preset;
use crate::earth::Surface;
use crate::evaluate::Setup;
use crate::ground::Site;
use crate::optimize::{ExhaustiveConfig, Individual, Method, Nsga2Config, Strategy, hypervolume};
use crate::time::{Epoch, TimeGrid};

/// Four points from the equator to 70 degrees north, seven samples over three hours.
fn evaluator() -> Evaluator {
    let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
    let grid = TimeGrid::new(epoch, 10_800.0, 1600.0).unwrap();
    let site = |latitude| Site::new(Surface::Sphere, latitude, 100.0, 1.0).unwrap();
    let sites = [0.0, 25.0, 50.0, 70.0].map(site).to_vec();
    let setup = Setup::new(grid, sites).with_gnss(vec![Preset::Beidou3.into()]);
    Evaluator::new(setup).unwrap()
}

/// A shell at middle latitudes with a choice of two patterns, and a polar one that may be empty; on the steps of a
/// sweep the space has 3600 points.
fn two_shells() -> DesignSpace {
    let middle = ShellSpace {
        pattern: vec![Pattern::Delta, Pattern::Star],
        planes: [3, 7],
        satellites_per_plane: [3, 7],
        inclination_deg: [50.0, 50.0].into(),
        altitude_km: [1000.0, 1000.0].into(),
        phasing: [0, 2],
        ..shell()
    };
    let polar = ShellSpace {
        pattern: vec![Pattern::Star, Pattern::Delta],
        planes: [2, 4],
        satellites_per_plane: [0, 3],
        inclination_deg: [88.0, 88.0].into(),
        phasing: [1, 1],
        ..middle.clone()
    };
    DesignSpace {
        shells: vec![middle, polar],
        fixed: None,
    }
}

fn problem(evaluator: &Evaluator) -> DesignProblem<'_> {
    let goals = Goals {
        objectives: vec![Quantity::Satellites, Quantity::MeanPdop],
        ..super::goals(None)
    };
    DesignProblem::new(evaluator, two_shells(), goals).unwrap()
}

fn front(problem: &DesignProblem<'_>, method: Method, seed: u64) -> Vec<Individual> {
    let mut search = method.start(problem, seed).unwrap();
    while !search.is_done() {
        search.step(problem).unwrap();
    }
    search.front()
}

/// NSGA-II finds the front of the sweep within 0.5 % of its hypervolume in nine seeds of ten.
#[test]
fn validate_a_search_among_hybrids_finds_the_front_of_the_sweep() {
    let evaluator = evaluator();
    let problem = problem(&evaluator);
    let sweep = ExhaustiveConfig {
        steps: problem.designs().steps(),
        batch: 256,
        hypervolume_reference: None,
    };
    let exact = front(&problem, Method::Exhaustive(sweep), 1);
    let reference = [
        71.0,
        exact.iter().map(|a| a.objectives[1]).fold(0.0, f64::max) + 0.1,
    ];
    let volume = |front: &[Individual]| {
        let points: Vec<&[f64]> = front.iter().map(|a| a.objectives.as_slice()).collect();
        hypervolume(&points, &reference)
    };
    // The front has designs of one shell and of two, and both patterns, so that all of them must be found.
    let shells = exact
        .iter()
        .map(|a| problem.designs().design(&a.genome).unwrap().unwrap());
    let shells: Vec<Design> = shells.collect();
    assert!(shells.iter().any(|design| design.only_shell().is_some()));
    assert!(shells.iter().any(|design| design.only_shell().is_none()));
    let exact = volume(&exact);
    let share = |seed| {
        let config = Nsga2Config {
            population: 60,
            generations: 30,
            ..Nsga2Config::default()
        };
        volume(&front(&problem, Method::Nsga2(config), seed)) / exact
    };
    let shares: Vec<f64> = (1..=10).map(share).collect();
    assert!(
        shares.iter().all(|share| *share <= 1.0 + 1e-12),
        "{shares:?}"
    );
    let near = shares.iter().filter(|share| **share >= 0.995).count();
    assert!(near >= 9, "{shares:?}");
}

/// No two designs of a population are the same, whatever the hidden variables of their empty shells.
#[test]
fn a_population_has_no_design_twice() {
    let evaluator = evaluator();
    let problem = problem(&evaluator);
    let config = Nsga2Config {
        population: 40,
        generations: 12,
        mutation_probability: 0.5,
        ..Nsga2Config::default()
    };
    let mut search = crate::optimize::Nsga2::start(&problem, config, 3).unwrap();
    while !search.is_done() {
        search.step(&problem).unwrap();
        let genomes = search.population().iter().map(|a| &a.genome);
        let mut designs: Vec<String> = genomes
            .map(|genome| {
                problem
                    .designs()
                    .design(genome)
                    .unwrap()
                    .unwrap()
                    .to_string()
            })
            .collect();
        let count = designs.len();
        designs.sort();
        designs.dedup();
        assert_eq!(designs.len(), count);
    }
}

/// Satellites of a file beside each design: the same metrics as of all of them together.
#[test]
fn fixed_satellites_are_in_every_evaluation() {
    let evaluator = evaluator();
    let setup = evaluator.setup();
    let fixed: Design = "star:86.4:12/3/1@780".parse().unwrap();
    let satellites =
        |design: &Design| Ephemeris::of_design(design, setup.model, setup.grid).unwrap();
    let of_file = Ephemeris::new(setup.grid, satellites(&fixed).into_satellites());
    let problem = problem(&evaluator).with_satellites(&of_file).unwrap();
    let genome = [
        3.0, 4.0, 50.0, 1000.0, 1.0, 0.0, 2.0, 3.0, 88.0, 1000.0, 1.0, 0.0,
    ];
    let (design, metrics) = problem.evaluated(&genome).unwrap();
    let design = design.unwrap();
    assert_eq!(
        design.to_string(),
        "delta:50:12/3/1@1000+star:88:6/2/1@1000"
    );
    let together = satellites(&design).joined(satellites(&fixed));
    let expected = evaluator.evaluate_ephemeris(&together).unwrap();
    assert_eq!(metrics.j_cost, expected.j_cost);
    let (found, expected) = (metrics.mean_pdop.unwrap(), expected.mean_pdop.unwrap());
    // Two ways to the same positions.
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    let value = |quantity| problem.value(quantity, Some(&design), &metrics);
    assert_eq!(value(Quantity::Satellites), Some(30.0));
    assert_eq!(value(Quantity::NewSatellites), Some(18.0));
    assert_eq!(value(Quantity::NewPlanes), Some(5.0));
    assert!(problem.answer(&genome).objectives[0] == 30.0);
}

/// Where all shells are empty, what is evaluated is what is fixed; without anything there is nothing to evaluate.
#[test]
fn nothing_may_be_added_to_satellites_of_files() {
    let evaluator = evaluator();
    let setup = evaluator.setup();
    let fixed: Design = "star:86.4:12/3/1@780".parse().unwrap();
    let of_design = Ephemeris::of_design(&fixed, setup.model, setup.grid).unwrap();
    let of_file = Ephemeris::new(setup.grid, of_design.into_satellites());
    let space = || {
        let mut space = two_shells();
        space.shells[0].satellites_per_plane = [0, 7];
        space
    };
    let goals = || Goals {
        objectives: vec![Quantity::NewSatellites, Quantity::MeanPdop],
        ..super::goals(None)
    };
    let nothing = [
        3.0, 0.0, 50.0, 1000.0, 0.0, 0.0, 2.0, 0.0, 88.0, 1000.0, 1.0, 0.0,
    ];
    let alone = DesignProblem::new(&evaluator, space(), goals()).unwrap();
    assert!(alone.evaluated(&nothing).is_none());
    assert!(alone.answer(&nothing).violation > 0.0);
    let beside = alone.with_satellites(&of_file).unwrap();
    let (design, metrics) = beside.evaluated(&nothing).unwrap();
    assert_eq!(design, None);
    let expected = evaluator.evaluate(&fixed).unwrap();
    let (found, expected) = (metrics.mean_pdop.unwrap(), expected.mean_pdop.unwrap());
    // Two ways to the same positions.
    assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    assert_eq!(beside.answer(&nothing).objectives, [0.0, found]);
}

/// A vector lists the shells in the order of the search, each with its own limits: what is cut, empty or idle in one
/// is not in another.
#[test]
fn each_shell_has_its_own_part_of_a_vector() {
    let mut space = two_shells();
    space.shells[0].phasing = [0, 6];
    space.shells[1].phasing = [0, 3];
    let mut genome = vec![
        5.0, 4.0, 50.0, 1000.0, 6.0, 0.0, 3.0, 2.0, 88.0, 1000.0, 9.0, 1.0,
    ];
    space.repair(&mut genome);
    // P - 1 of each.
    assert_eq!((genome[4], genome[10]), (4.0, 2.0));
    let design = space.design(&genome).unwrap().unwrap();
    assert_eq!(
        design.to_string(),
        "delta:50:20/5/4@1000+delta:88:6/3/2@1000"
    );
    genome[7] = 0.0;
    let shells = space.shells_of(&genome).unwrap();
    assert_eq!(shells[0].unwrap().satellite_count(), 20);
    assert_eq!(shells[1], None);
    let idle: Vec<usize> = (0..12).filter(|k| space.is_idle(&genome, *k)).collect();
    assert_eq!(idle, [6, 8, 9, 10, 11]);
}

//! Designs, evaluates, exports and validates low-Earth-orbit Walker constellations that augment a
//! GNSS.
//!
//! The library does the science and no I/O: it opens no path, reads no clock or environment, and
//! prints nothing. From a scenario to a design and its element sets:
//!
//! ```
//! use navwalker::evaluate::Evaluator;
//! use navwalker::formats::{element_set, metadata::Object, tle};
//! use navwalker::optimize::{Strategy, best, fuzzy};
//! use navwalker::orbit::sgp4::MeanMotionSlot;
//! use navwalker::scenario::{Scenario, builtin};
//! use navwalker::search::DesignProblem;
//!
//! // The built-in study, made small by overriding a few keys. It names no files to read.
//! let small = ["time.step-s=900", "region.step-deg=20", "optimizer.population=8", "optimizer.generations=2"];
//! let scenario = Scenario::parse("paper", builtin("paper")?.as_bytes(), &small)?;
//! let evaluator = Evaluator::new(scenario.setup(&|path| Err(std::io::Error::other(path)))?)?;
//! let reference = evaluator.evaluate(&"delta:55:182/13/1@925".parse()?)?;
//! println!("mean visible {:.2}, mean PDOP {:?}", reference.mean_visible, reference.mean_pdop);
//!
//! // Search for the Pareto set and pick one design from it.
//! let problem = DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals())?;
//! let mut search = scenario.method().start(&problem, scenario.optimizer.seed)?;
//! while !search.is_done() {
//!     search.step(&problem)?;
//! }
//! let front = search.front();
//! let objectives: Vec<_> = front.iter().map(|member| &member.objectives[..]).collect();
//! let pick = best(&fuzzy(&objectives)?.minimum).expect("the front is not empty");
//! let (design, _) = problem.evaluated(&front[pick].genome).expect("front members are designs");
//! let design = design.expect("each has a shell, since none may be empty");
//!
//! // Export it as two-line element sets, here into memory.
//! let (epoch, mut file) = (scenario.time_grid()?.epoch(), Vec::new());
//! for (n, satellite) in design.satellites().iter().enumerate() {
//!     let object = Object::numbered(&format!("SAT-{n}"), n, epoch)?;
//!     tle::write(&mut file, &element_set(&satellite.elements, &object, epoch, MeanMotionSlot::Kozai))?;
//! }
//! assert_eq!(file.iter().filter(|byte| **byte == b'\n').count(), 3 * design.satellite_count());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! `examples/` has whole programs, [`models`] numbers the equations that the code cites, and
//! `ARCHITECTURE.md` is the map of the modules and the direction of their imports.

#![cfg_attr(not(test), warn(clippy::disallowed_methods, clippy::disallowed_types))]

#[cfg(feature = "cli")]
pub mod cli;
pub mod constellation;
pub mod dop;
pub mod earth;
pub mod ephemeris;
pub mod evaluate;
pub mod exchange;
pub mod formats;
pub mod frames;
pub mod ground;
pub mod keyword;
#[doc = include_str!("../docs/models.md")]
pub mod models {}
pub mod optimize;
pub mod orbit;
pub mod printable;
pub mod report;
pub mod run;
pub mod scenario;
pub mod search;
pub mod stats;
pub mod study;
pub mod time;
pub mod units;
#[cfg(feature = "validate")]
pub mod validate;
pub mod visibility;

/// The code blocks of the README, compiled as doctests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct Readme;

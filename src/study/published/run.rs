//! A study computed: each statement under its scenario and, if it is not met there, under the assumptions.

use super::measured::{MeasuredConstellation, of_orbit, of_sky};
use super::metric::{OrbitQuantity, StudyMetric};
use super::{PublishedStatement, PublishedStudy, StudyAssumption, StudyKeys, StudySky};
use crate::constellation::{Design, Slot};
use crate::dop::SkyView;
use crate::ephemeris::{Ephemeris, EphemerisError, object_name};
use crate::evaluate::Evaluator;
use crate::exchange::constellation::{Constellation, ConstellationError, GNSS_ONLY};
use crate::scenario::{NoDesign, Place, Problems, Scenario, SetupError};
use crate::study::judge::{OtherAssumption, Statement, Verdict, judge};
use std::io;
use thiserror::Error;

/// A study with a verdict on each statement.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedStudy {
    /// Its name.
    pub name: String,
    /// What it is.
    pub title: String,
    /// Where the numbers are from.
    pub source: String,
    /// What is known about the numbers and the assumptions.
    pub notes: Vec<String>,
    /// The statements.
    pub statements: Vec<JudgedStatement>,
}

/// A statement with its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedStatement {
    /// The statement, the number computed and the verdict.
    pub statement: Statement,
    /// The constellation.
    pub of: String,
    /// What was computed.
    pub metric: StudyMetric,
    /// What is known of a disagreement.
    pub disagreement: Option<String>,
}

impl JudgedStatement {
    /// Whether the study says of a number that disagrees that it does not know why, nor that it does.
    #[must_use]
    pub fn is_unexpected(&self) -> bool {
        self.statement.verdict == Verdict::NotMet && self.disagreement.is_none()
    }
}

/// Why a study cannot be computed.
#[derive(Debug, Error)]
pub enum StudyRunError {
    /// Its scenario, or an override of it, is wrong.
    #[error("{0}")]
    Scenario(String),
    /// Its scenario cannot be set up.
    #[error("{place}: {source}")]
    Setup {
        /// The study, and the line of a statement.
        place: String,
        /// Why.
        source: Box<SetupError>,
    },
    /// A statement names no constellation.
    #[error("{place}: {source}")]
    Constellation {
        /// The study, and the line of the statement.
        place: String,
        /// Why.
        source: Box<NoDesign>,
    },
    /// A statement that cannot be computed, for another reason.
    #[error("{place}: {reason}")]
    Statement {
        /// The study, and the line of the statement.
        place: String,
        /// Why.
        reason: String,
    },
    /// A satellite cannot be propagated.
    #[error(transparent)]
    Ephemeris(#[from] EphemerisError),
    /// A constellation cannot be propagated.
    #[error(transparent)]
    Propagation(Box<ConstellationError>),
}

/// A scenario that statements share.
struct StudyWorld {
    keys: Vec<String>,
    scenario: Scenario,
    evaluator: Option<Evaluator>,
    measured: Vec<(String, MeasuredConstellation)>,
}

/// A study that is being computed.
struct StudyRun<'r> {
    study: &'r PublishedStudy,
    overrides: &'r [String],
    read: &'r dyn Fn(&str) -> io::Result<Vec<u8>>,
    worlds: Vec<StudyWorld>,
    skies: Vec<SkyView>,
}

impl PublishedStudy {
    /// Computes the study, with `--set` arguments over its scenario. `read` gives the bytes of a file by its path as
    /// written.
    ///
    /// # Errors
    /// If its scenario is wrong with any of its assumptions, a statement names no constellation, a file cannot be read,
    /// or a satellite cannot be propagated.
    pub fn run(
        &self,
        overrides: &[String],
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<JudgedStudy, StudyRunError> {
        let skies = self.skies.iter().map(|sky| self.sky(sky, read));
        let mut run = StudyRun {
            study: self,
            overrides,
            read,
            worlds: Vec::new(),
            skies: skies.collect::<Result<_, _>>()?,
        };
        run.check_scenarios()?;
        let statements = self.statements.iter();
        let statements = statements.map(|statement| run.judged(statement));
        Ok(JudgedStudy {
            name: self.name.clone(),
            title: self.title.clone(),
            source: self.source.clone(),
            notes: self.notes.clone(),
            statements: statements.collect::<Result<_, _>>()?,
        })
    }

    fn sky(
        &self,
        sky: &StudySky,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<SkyView, StudyRunError> {
        sky.view(read).map_err(|reason| StudyRunError::Statement {
            place: self.at(sky.line),
            reason: format!("skies.{}: {reason}", sky.name),
        })
    }

    /// A line of the study.
    fn at(&self, line: usize) -> String {
        format!("{}:{line}", self.label)
    }
}

impl StudyRun<'_> {
    /// Fails if the scenario is wrong, alone or with any assumption, also one that no statement needs.
    fn check_scenarios(&mut self) -> Result<(), StudyRunError> {
        let study = self.study;
        let assumed = std::iter::once(None).chain(study.assumptions.iter().map(Some));
        for assumption in assumed {
            for statement in &study.statements {
                self.world(assumption, statement)?;
            }
        }
        Ok(())
    }

    fn judged(&mut self, statement: &PublishedStatement) -> Result<JudgedStatement, StudyRunError> {
        let ours = self.value(statement, None)?;
        let holds = ours.is_some_and(|ours| statement.expected.holds(ours));
        let mut others = Vec::new();
        if !holds {
            for assumption in &self.study.assumptions {
                let found = self.value(statement, Some(assumption))?;
                others.push(OtherAssumption {
                    assumption: &assumption.name,
                    found,
                });
            }
        }
        let texts = [
            statement.source.as_str(),
            statement.name.as_str(),
            statement.metric.unit(),
        ];
        let mut judged = judge(
            texts,
            statement.provenance,
            statement.expected,
            ours,
            &others,
        );
        if !statement.is_confirmed {
            judged.verdict = Verdict::Unconfirmed;
        }
        Ok(JudgedStatement {
            statement: judged,
            of: statement.of.clone(),
            metric: statement.metric,
            disagreement: statement.disagreement.clone(),
        })
    }

    /// The number of a statement under the scenario of the study, perhaps with an assumption; `None` if it has none.
    fn value(
        &mut self,
        statement: &PublishedStatement,
        assumption: Option<&StudyAssumption>,
    ) -> Result<Option<f64>, StudyRunError> {
        let place = self.world(assumption, statement)?;
        match statement.metric {
            StudyMetric::Orbit(quantity) => return self.of_orbit(place, statement, quantity),
            StudyMetric::Sky(dilution) => {
                let mut known = self.study.skies.iter().zip(&self.skies);
                let sky = known.find(|(sky, _)| sky.name == statement.of);
                return Ok(sky.and_then(|(_, sky)| of_sky(sky, dilution)));
            }
            _ => {}
        }
        let known = |world: &StudyWorld| {
            let mut measured = world.measured.iter();
            measured.position(|(of, _)| *of == statement.of)
        };
        let at = match known(&self.worlds[place]) {
            Some(at) => at,
            None => {
                let measured = self.measure(place, statement)?;
                let world = &mut self.worlds[place];
                world.measured.push((statement.of.clone(), measured));
                world.measured.len() - 1
            }
        };
        self.require_key(place, statement)?;
        let world = &self.worlds[place];
        let (Some((_, measured)), Some(evaluator)) = (world.measured.get(at), &world.evaluator)
        else {
            return Ok(None);
        };
        Ok(measured.value(evaluator, &world.scenario.goals(), statement.metric)?)
    }

    /// The place of the scenario of a statement, perhaps with an assumption.
    fn world(
        &mut self,
        assumption: Option<&StudyAssumption>,
        statement: &PublishedStatement,
    ) -> Result<usize, StudyRunError> {
        let parts = [
            Some(&self.study.scenario),
            assumption.map(|assumption| &assumption.scenario),
            Some(&statement.scenario),
        ];
        let parts: Vec<&StudyKeys> = parts.into_iter().flatten().collect();
        let keys: Vec<String> = parts.iter().flat_map(|part| part.keys.clone()).collect();
        if let Some(place) = self.worlds.iter().position(|world| world.keys == keys) {
            return Ok(place);
        }
        let all: Vec<&String> = keys.iter().chain(self.overrides).collect();
        let scenario = Scenario::parse(&self.study.name, b"", &all);
        let scenario = scenario.map_err(|problems| self.wrong(&problems, &parts))?;
        self.worlds.push(StudyWorld {
            keys,
            scenario,
            evaluator: None,
            measured: Vec::new(),
        });
        Ok(self.worlds.len() - 1)
    }

    /// The problems of a scenario: those of the study by line and key, those of an override as they are.
    fn wrong(&self, problems: &Problems, parts: &[&StudyKeys]) -> StudyRunError {
        let lines = parts
            .iter()
            .flat_map(|part| part.keys.iter().map(|_| part.line));
        let lines: Vec<usize> = lines.collect();
        let told = problems.as_slice().iter().map(|problem| {
            let line = match problem.place {
                Place::Argument { index, .. } => match lines.get(index) {
                    Some(line) => *line,
                    None => return problem.to_string(),
                },
                Place::File { .. } => self.study.scenario.line,
            };
            let place = self.study.at(line);
            format!("{place}: scenario.{}: {}", problem.key, problem.fault)
        });
        StudyRunError::Scenario(told.collect::<Vec<_>>().join("\n"))
    }

    fn measure(
        &mut self,
        place: usize,
        statement: &PublishedStatement,
    ) -> Result<MeasuredConstellation, StudyRunError> {
        let constellation = match statement.of.as_str() {
            GNSS_ONLY => None,
            of => Some(self.constellation(place, statement, of)?),
        };
        let at = self.study.at(statement.line);
        let failed = |source| StudyRunError::Setup {
            place: at,
            source: Box::new(source),
        };
        let world = &mut self.worlds[place];
        let evaluator = match world.evaluator.take() {
            Some(evaluator) => evaluator,
            None => Evaluator::new(world.scenario.setup(self.read).map_err(failed)?)?,
        };
        let setup = evaluator.setup();
        let ephemeris = match &constellation {
            Some(one) => {
                let ephemeris = one.ephemeris(setup.grid, setup.model);
                ephemeris.map_err(|error| StudyRunError::Propagation(Box::new(error)))?
            }
            None => Ephemeris::new(setup.grid, Vec::new()),
        };
        let metrics = evaluator.evaluate_ephemeris(&ephemeris)?;
        world.evaluator = Some(evaluator);
        Ok(MeasuredConstellation {
            constellation,
            ephemeris,
            metrics,
        })
    }

    /// Fails if the scenario lacks what the metric of a statement needs.
    fn require_key(
        &self,
        place: usize,
        statement: &PublishedStatement,
    ) -> Result<(), StudyRunError> {
        let setup = self.worlds[place].evaluator.as_ref().map(Evaluator::setup);
        let Some((setup, key)) = setup.zip(statement.metric.needed_key()) else {
            return Ok(());
        };
        let is_there = match key {
            "[accuracy]" => setup.accuracy.is_some(),
            _ => setup.window_s.is_some(),
        };
        if is_there {
            return Ok(());
        }
        let metric = statement.metric;
        Err(self.wrong_statement(statement, format!("{metric} needs {key} in the scenario")))
    }

    fn wrong_statement(&self, statement: &PublishedStatement, reason: String) -> StudyRunError {
        StudyRunError::Statement {
            place: self.study.at(statement.line),
            reason,
        }
    }

    fn constellation(
        &self,
        place: usize,
        statement: &PublishedStatement,
        of: &str,
    ) -> Result<Constellation, StudyRunError> {
        let scenario = &self.worlds[place].scenario;
        if let Some(named) = scenario.constellation(of) {
            let grid = scenario.time_grid().map_err(SetupError::from);
            let read = grid.and_then(|grid| named.read(self.read, grid));
            let (one, _) = read.map_err(|source| StudyRunError::Setup {
                place: self.study.at(statement.line),
                source: Box::new(source),
            })?;
            return Ok(one);
        }
        Ok(Constellation::of_design(self.design(place, statement)?))
    }

    fn design(
        &self,
        place: usize,
        statement: &PublishedStatement,
    ) -> Result<Design, StudyRunError> {
        let design = self.worlds[place].scenario.design(&statement.of);
        design.map_err(|source| StudyRunError::Constellation {
            place: self.study.at(statement.line),
            source: Box::new(source),
        })
    }

    fn of_orbit(
        &self,
        place: usize,
        statement: &PublishedStatement,
        quantity: OrbitQuantity,
    ) -> Result<Option<f64>, StudyRunError> {
        let design = self.design(place, statement)?;
        let Some(shell) = design.only_shell() else {
            let (metric, of) = (statement.metric, &statement.of);
            let reason = format!("{metric} is of one shell, and {of} has others");
            return Err(self.wrong_statement(statement, reason));
        };
        let Some(name) = &statement.satellite else {
            return Ok(of_orbit(shell, Slot::FIRST, quantity));
        };
        let names: Vec<(Slot, String)> = shell
            .slots()
            .map(|slot| (slot, object_name(slot)))
            .collect();
        if let Some((slot, _)) = names.iter().find(|(_, one)| one == name) {
            return Ok(of_orbit(shell, *slot, quantity));
        }
        let ends =
            [names.first(), names.last()].map(|end| end.map_or("", |(_, name)| name.as_str()));
        let [first, last] = ends;
        let reason = format!(
            "satellite: {} has no {name:?}, but {first} to {last}",
            statement.of
        );
        Err(self.wrong_statement(statement, reason))
    }
}

#[cfg(test)]
mod tests;

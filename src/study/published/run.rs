//! A study computed: each statement under its scenario and, if it is not met there, under the assumptions.

use super::metric::{DilutionKind, DilutionStatistic, OrbitQuantity, StudyMetric};
use super::{PublishedStatement, PublishedStudy};
use crate::constellation::{Design, Slot, coverage_radius_deg};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Metrics};
use crate::exchange::constellation::{Constellation, ConstellationError, GNSS_ONLY};
use crate::orbit::j2::SecularRates;
use crate::scenario::{NoDesign, Place, Problems, Scenario, SetupError};
use crate::search::CountedSatellites;
use crate::study::judge::{OtherAssumption, Statement, Verdict, judge};
use std::f64::consts::TAU;
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
    #[error("study {study}: {source}")]
    Setup {
        /// The study.
        study: String,
        /// Why.
        source: Box<SetupError>,
    },
    /// A statement names no constellation.
    #[error("study {study}, statement {statement:?}: {source}")]
    Constellation {
        /// The study.
        study: String,
        /// The statement.
        statement: String,
        /// Why.
        source: Box<NoDesign>,
    },
    /// A statement about the orbit of several shells.
    #[error(
        "study {study}, statement {statement:?}: {metric} is of one shell, and {of} has others"
    )]
    NotOneShell {
        /// The study.
        study: String,
        /// The statement.
        statement: String,
        /// What is asked.
        metric: String,
        /// The constellation.
        of: String,
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

/// What was computed of a constellation.
struct MeasuredConstellation {
    constellation: Option<Constellation>,
    ephemeris: Ephemeris,
    metrics: Metrics,
}

/// A study that is being computed.
struct StudyRun<'r> {
    study: &'r PublishedStudy,
    overrides: &'r [String],
    read: &'r dyn Fn(&str) -> io::Result<Vec<u8>>,
    worlds: Vec<StudyWorld>,
}

impl PublishedStudy {
    /// Computes the study, with `--set` arguments over its scenario. `read` gives the bytes of a file by its path as
    /// written.
    ///
    /// # Errors
    /// If its scenario is wrong, a statement names no constellation, or a satellite cannot be propagated.
    pub fn run(
        &self,
        overrides: &[String],
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<JudgedStudy, StudyRunError> {
        let mut run = StudyRun {
            study: self,
            overrides,
            read,
            worlds: Vec::new(),
        };
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
}

impl StudyRun<'_> {
    fn judged(&mut self, statement: &PublishedStatement) -> Result<JudgedStatement, StudyRunError> {
        let ours = self.value(statement, &[])?;
        let holds = ours.is_some_and(|ours| statement.expected.holds(ours));
        let mut others = Vec::new();
        if !holds {
            for assumption in &self.study.assumptions {
                let found = self.value(statement, &assumption.scenario)?;
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

    /// The number of a statement under the scenario of the study with further keys; `None` if it has none.
    fn value(
        &mut self,
        statement: &PublishedStatement,
        assumed: &[String],
    ) -> Result<Option<f64>, StudyRunError> {
        let mut keys = self.study.scenario.clone();
        keys.extend(assumed.iter().cloned());
        keys.extend(statement.scenario.iter().cloned());
        let place = self.world(keys)?;
        if let StudyMetric::Orbit(quantity) = statement.metric {
            return self.of_orbit(place, statement, quantity);
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
        self.worlds[place].value(at, statement.metric)
    }

    /// The place of the scenario with these keys.
    fn world(&mut self, keys: Vec<String>) -> Result<usize, StudyRunError> {
        if let Some(place) = self.worlds.iter().position(|world| world.keys == keys) {
            return Ok(place);
        }
        let all: Vec<&String> = keys.iter().chain(self.overrides).collect();
        let scenario = Scenario::parse(&self.study.name, b"", &all);
        let scenario = scenario.map_err(|problems| self.wrong(&problems, keys.len()))?;
        self.worlds.push(StudyWorld {
            keys,
            scenario,
            evaluator: None,
            measured: Vec::new(),
        });
        Ok(self.worlds.len() - 1)
    }

    /// The problems of a scenario: those of the study by its key, those of an override as they are.
    fn wrong(&self, problems: &Problems, own: usize) -> StudyRunError {
        let told = problems
            .as_slice()
            .iter()
            .map(|problem| match problem.place {
                Place::Argument { index, .. } if index >= own => problem.to_string(),
                _ => format!(
                    "study {}: scenario.{}: {}",
                    self.study.name, problem.key, problem.fault
                ),
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
        let failed = |source| StudyRunError::Setup {
            study: self.study.name.clone(),
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
                study: self.study.name.clone(),
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
            study: self.study.name.clone(),
            statement: statement.name.clone(),
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
        let shell = design
            .only_shell()
            .ok_or_else(|| StudyRunError::NotOneShell {
                study: self.study.name.clone(),
                statement: statement.name.clone(),
                metric: statement.metric.to_string(),
                of: statement.of.clone(),
            })?;
        let elements = shell.elements(Slot::FIRST);
        let rates = SecularRates::j2(&elements);
        let minutes = |rate_rad_s: f64| TAU / rate_rad_s / 60.0;
        Ok(Some(match quantity {
            OrbitQuantity::CoverageRadius => return Ok(coverage_radius_deg(shell)),
            OrbitQuantity::NodalRate => rates.raan_rad_s.to_degrees() * 86_400.0,
            OrbitQuantity::NodalPeriod => {
                minutes(rates.mean_anomaly_rad_s + rates.arg_perigee_rad_s)
            }
            OrbitQuantity::KeplerPeriod => minutes(elements.kepler_mean_motion_rad_s()),
        }))
    }
}

impl StudyWorld {
    /// A number of a constellation that was measured.
    fn value(&self, at: usize, metric: StudyMetric) -> Result<Option<f64>, StudyRunError> {
        let (Some((_, measured)), Some(evaluator)) = (self.measured.get(at), &self.evaluator)
        else {
            return Ok(None);
        };
        let metrics = &measured.metrics;
        Ok(match metric {
            // Of an orbit, and not of samples.
            StudyMetric::Orbit(_) => None,
            StudyMetric::MeanGnssVisible => Some(metrics.mean_gnss_visible),
            StudyMetric::Quantity(quantity) => {
                let satellites = match &measured.constellation {
                    Some(one) => one.counted(None),
                    None => CountedSatellites::default(),
                };
                self.scenario.goals().value(quantity, satellites, metrics)
            }
            StudyMetric::Dilution(statistic, dilution) => {
                dilution_of(evaluator, measured, statistic, dilution)?
            }
        })
    }
}

fn dilution_of(
    evaluator: &Evaluator,
    measured: &MeasuredConstellation,
    statistic: DilutionStatistic,
    dilution: DilutionKind,
) -> Result<Option<f64>, EphemerisError> {
    let dops = evaluator.dops_beside(&measured.metrics, &measured.ephemeris)?;
    let named = dops.named();
    let first = match dilution {
        DilutionKind::Gdop => 0,
        DilutionKind::Pdop => 1,
        DilutionKind::Hdop => 2,
        DilutionKind::Vdop => 3,
        // The first clock that has a value.
        DilutionKind::Tdop => match named.iter().skip(4).position(|(_, of)| of.is_some()) {
            Some(place) => 4 + place,
            None => return Ok(None),
        },
    };
    let Some((_, Some(summary))) = named.get(first) else {
        return Ok(None);
    };
    match (statistic.of_summary(summary), statistic) {
        (None, DilutionStatistic::Quantile(level)) => {
            let quantiles = evaluator.dop_quantiles(&measured.ephemeris, level)?;
            Ok(quantiles.get(first).copied().flatten())
        }
        (value, _) => Ok(value),
    }
}

#[cfg(test)]
mod tests;

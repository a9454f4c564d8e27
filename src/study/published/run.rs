//! A study computed: each statement under its scenario and, if it is not met there, under the assumptions.

mod figures;
mod fits;
mod gnss;
mod numbers;
mod searches;
mod sets;
mod tables;
mod worlds;

pub use figures::{Curve, FigureData, FoundFigure, PlacedDesign};
pub use fits::{FittedRow, FoundFit};
pub use searches::{FoundMember, FoundSet};
pub use tables::{
    ComputedValue, JudgedRow, MeasuredColumn, MeasuredRow, MeasuredTable, RowAtFit, RowsUnder,
};

use super::metric::StudyMetric;
use super::steps::StudyReference;
use super::{
    PublishedNumber, PublishedStatement, PublishedStudy, StudyAssumption, StudyKeys, StudySky,
};
use crate::dop::SkyView;
use crate::ephemeris::EphemerisError;
use crate::exchange::constellation::ConstellationError;
use crate::optimize::{DecisionError, OptimizeError};
use crate::scenario::{NoDesign, Scenario, SetupError, builtin};
use crate::study::judge::{Expected, OtherAssumption, Statement, Verdict, judge};
use fits::FitMoves;
use std::io;
use thiserror::Error;
use worlds::StudyWorld;

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
    /// The scenario, with the overrides.
    pub scenario: Scenario,
    /// The statements.
    pub statements: Vec<JudgedStatement>,
    /// What the numbers of tables imply.
    pub fits: Vec<FoundFit>,
    /// The tables that have a file.
    pub tables: Vec<MeasuredTable>,
    /// Numbers that are not judged.
    pub values: Vec<ComputedValue>,
    /// The searches.
    pub searches: Vec<FoundSet>,
    /// The data of the figures.
    pub figures: Vec<FoundFigure>,
}

/// A statement with its verdict.
#[derive(Debug, Clone, PartialEq)]
pub struct JudgedStatement {
    /// The statement, the number computed and the verdict.
    pub statement: Statement,
    /// The constellation.
    pub of: String,
    /// What it is compared with.
    pub compared_with: Option<String>,
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
    /// A search cannot run.
    #[error(transparent)]
    Search(#[from] OptimizeError),
    /// No design of a set can be picked.
    #[error(transparent)]
    Decision(#[from] DecisionError),
}

/// A study that is being computed.
struct StudyRun<'r> {
    study: &'r PublishedStudy,
    /// The scenario that `keys` change.
    base: &'r str,
    keys: &'r StudyKeys,
    overrides: &'r [String],
    read: &'r dyn Fn(&str) -> io::Result<Vec<u8>>,
    worlds: Vec<StudyWorld>,
    skies: Vec<SkyView>,
    fits: Vec<FoundFit>,
    /// The designs that each fit moves.
    moves: Vec<FitMoves>,
    searches: Vec<FoundSet>,
}

/// What a number is computed under.
#[derive(Clone, Copy)]
enum Under<'a> {
    /// The scenario.
    Scenario,
    /// The scenario with an assumption.
    Assumption(&'a StudyAssumption),
    /// The scenario, with the designs that the fit of this place moves.
    Fit(usize),
}

impl PublishedStudy {
    /// Computes the study, with `--set` arguments over its scenario. `read` gives the bytes of a file by its path as
    /// written.
    ///
    /// # Errors
    /// If its scenario is wrong with any of its assumptions, fits or searches, a statement names no constellation, a
    /// file cannot be read, or a satellite cannot be propagated.
    pub fn run(
        &self,
        overrides: &[String],
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<JudgedStudy, StudyRunError> {
        let mut run = self.begin(self.base_text(), &self.scenario, overrides, read)?;
        let own = &StudyKeys::default();
        let place = run.world(None, own)?;
        run.check_scenarios()?;
        run.fit()?;
        run.search()?;
        run.measure_rows()?;
        let statements = self.statements.iter();
        let statements = statements.map(|statement| run.judged(statement));
        let statements: Vec<Option<JudgedStatement>> = statements.collect::<Result<_, _>>()?;
        Ok(JudgedStudy {
            name: self.name.clone(),
            title: self.title.clone(),
            source: self.source.clone(),
            notes: self.notes.clone(),
            statements: statements.into_iter().flatten().collect(),
            tables: run.tables()?,
            values: run.values()?,
            figures: run.figures()?,
            scenario: run.worlds.swap_remove(place).scenario,
            fits: run.fits,
            searches: run.searches,
        })
    }

    /// The scenario of the study, with the overrides.
    ///
    /// # Errors
    /// If it is wrong.
    pub fn scenario(&self, overrides: &[String]) -> Result<Scenario, StudyRunError> {
        let no_file = |_: &str| Err(io::ErrorKind::NotFound.into());
        let mut run = StudyRun::new(self, self.base_text(), &self.scenario, overrides, &no_file);
        let place = run.world(None, &StudyKeys::default())?;
        Ok(run.worlds.swap_remove(place).scenario)
    }

    /// The stems of its tables and figures.
    #[must_use]
    pub fn stems(&self) -> Vec<String> {
        let tables = self.tables.iter().filter_map(|table| table.file.as_ref());
        let tables = tables.flat_map(|file| [file.clone(), format!("{file}-sensitivity")]);
        let figures = self.figures.iter().map(|figure| figure.name.clone());
        tables.chain(figures).collect()
    }

    /// Whether it has searches.
    #[must_use]
    pub fn has_searches(&self) -> bool {
        !self.searches.is_empty()
    }

    fn begin<'r>(
        &'r self,
        base: &'r str,
        keys: &'r StudyKeys,
        overrides: &'r [String],
        read: &'r dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<StudyRun<'r>, StudyRunError> {
        let mut run = StudyRun::new(self, base, keys, overrides, read);
        let skies = self.skies.iter().map(|sky| self.sky(sky, read));
        run.skies = skies.collect::<Result<_, _>>()?;
        Ok(run)
    }

    /// The text of the built-in scenario that it begins with.
    fn base_text(&self) -> &'static str {
        // The name is known since the study was read.
        self.base
            .as_deref()
            .and_then(|name| builtin(name).ok())
            .unwrap_or_default()
    }

    fn sky(
        &self,
        sky: &StudySky,
        read: &dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Result<SkyView, StudyRunError> {
        sky.view(read)
            .map_err(|reason| self.wrong_at(sky.line, format!("skies.{}: {reason}", sky.name)))
    }

    /// A line of the study.
    fn at(&self, line: usize) -> String {
        format!("{}:{line}", self.label)
    }

    fn wrong_at(&self, line: usize, reason: String) -> StudyRunError {
        StudyRunError::Statement {
            place: self.at(line),
            reason,
        }
    }
}

impl<'r> StudyRun<'r> {
    fn new(
        study: &'r PublishedStudy,
        base: &'r str,
        keys: &'r StudyKeys,
        overrides: &'r [String],
        read: &'r dyn Fn(&str) -> io::Result<Vec<u8>>,
    ) -> Self {
        Self {
            study,
            base,
            keys,
            overrides,
            read,
            worlds: Vec::new(),
            skies: Vec::new(),
            fits: Vec::new(),
            moves: Vec::new(),
            searches: Vec::new(),
        }
    }

    /// Fails if the scenario is wrong, alone or with any assumption, fit or search, also one that no statement needs.
    fn check_scenarios(&mut self) -> Result<(), StudyRunError> {
        let study = self.study;
        let assumed = std::iter::once(None).chain(study.assumptions.iter().map(Some));
        for assumption in assumed {
            for statement in &study.statements {
                self.world(assumption, &statement.scenario)?;
            }
        }
        for search in &study.searches {
            self.with_keys(&search.scenario)?;
        }
        for fit in &study.fits {
            fits::check(self, fit)?;
        }
        Ok(())
    }

    /// A statement with its verdict; `None` if it is of a fit that implies nothing.
    fn judged(
        &mut self,
        statement: &PublishedStatement,
    ) -> Result<Option<JudgedStatement>, StudyRunError> {
        let expected = match statement.expected {
            PublishedNumber::Stated(expected) => expected,
            PublishedNumber::OfFit { tolerance } => {
                let Some(value) = self.found_fit(&statement.of).and_then(|fit| fit.median) else {
                    return Ok(None);
                };
                Expected::Value { value, tolerance }
            }
        };
        let ours = self.value(statement, Under::Scenario)?;
        let holds = ours.is_some_and(|ours| expected.holds(ours));
        let mut others = Vec::new();
        if !holds {
            for under in self.others(statement)? {
                let name = self.name_of(under, statement);
                others.push((name, self.value(statement, under)?));
            }
        }
        let others = others.iter().map(|(assumption, found)| OtherAssumption {
            assumption,
            found: *found,
        });
        let texts = [
            statement.source.as_str(),
            statement.name.as_str(),
            self.unit(statement),
        ];
        let others: Vec<OtherAssumption<'_>> = others.collect();
        let mut judged = judge(texts, statement.provenance, expected, ours, &others);
        if !statement.is_confirmed {
            judged.verdict = Verdict::Unconfirmed;
        }
        Ok(Some(JudgedStatement {
            statement: judged,
            of: statement.of.clone(),
            compared_with: (statement.comparison.as_ref()).map(|other| other.with().to_owned()),
            metric: statement.metric,
            disagreement: statement.disagreement.clone(),
        }))
    }

    /// What a statement may be met under if it is not under the scenario: the fits, then the assumptions.
    fn others(&mut self, statement: &PublishedStatement) -> Result<Vec<Under<'r>>, StudyRunError> {
        let mut others = Vec::new();
        for (n, moves) in self.moves.iter().enumerate() {
            if moves.concern(&self.study.tables, statement) {
                others.push(Under::Fit(n));
            }
        }
        let mut references = statement.references();
        let is_searched =
            references.any(|text| matches!(StudyReference::of(text), StudyReference::Search(_)));
        for assumption in &self.study.assumptions {
            let applies = if assumption.instead.is_empty() {
                // What a search found belongs to its scenario.
                !is_searched
                    && statement.metric != StudyMetric::Implied
                    && self.is_changed(assumption, &statement.scenario)?
            } else {
                let mut references = statement.references();
                references.any(|text| assumption.instead.contains_key(text))
            };
            if applies {
                others.push(Under::Assumption(assumption));
            }
        }
        if let Some(tried) = &statement.tried {
            others.retain(|under| tried.iter().any(|name| name == self.words_of(*under)));
        }
        Ok(others)
    }

    /// An assumption in the words of the study.
    fn words_of<'a>(&'a self, under: Under<'a>) -> &'a str {
        match under {
            Under::Scenario => "as in the scenario",
            Under::Assumption(assumption) => &assumption.name,
            Under::Fit(n) => &self.moves[n].assumption,
        }
    }

    /// The same, and of a fit that concerns one row alone its value there.
    fn name_of(&self, under: Under<'_>, statement: &PublishedStatement) -> String {
        let of_one = match under {
            Under::Fit(n) if statement.comparison.is_none() => self.moves[n].of_row(&statement.of),
            _ => None,
        };
        of_one.unwrap_or_else(|| self.words_of(under).to_owned())
    }

    fn found_fit(&self, text: &str) -> Option<&FoundFit> {
        match StudyReference::of(text) {
            StudyReference::Fit(name) => self.fits.iter().find(|fit| fit.name == name),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests;

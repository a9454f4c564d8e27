//! The scenarios of a study: its own, and those with an assumption or keys of a statement.

use super::{StudyRun, StudyRunError};
use crate::constellation::Design;
use crate::ephemeris::Ephemeris;
use crate::evaluate::Evaluator;
use crate::exchange::constellation::{Constellation, GNSS_ONLY};
use crate::scenario::{Place, Problems, Scenario, SetupError};
use crate::study::published::measured::MeasuredConstellation;
use crate::study::published::steps::AssumedChange;
use crate::study::published::{StudyAssumption, StudyKeys};
use rayon::prelude::*;

/// A scenario that statements share.
pub(super) struct StudyWorld {
    keys: Vec<String>,
    /// What no key changes.
    change: AssumedChange,
    pub(super) scenario: Scenario,
    evaluator: Option<Evaluator>,
    measured: Vec<(String, MeasuredConstellation)>,
}

/// A key of a scenario as for `--set`, with its line in the study; `None` for an override.
type PlacedKey = (String, Option<usize>);

fn placed(keys: &StudyKeys) -> impl Iterator<Item = PlacedKey> {
    let line = keys.line;
    keys.keys.iter().map(move |key| (key.clone(), Some(line)))
}

/// The path of a key that is set.
fn path(key: &str) -> &str {
    key.split_once('=').map_or(key, |(path, _)| path)
}

impl StudyRun<'_> {
    /// The keys of the study, those of a statement over them, and the overrides over both.
    fn placed_keys(&self, own: &StudyKeys) -> Vec<PlacedKey> {
        let overrides = self.overrides.iter().map(|key| (key.clone(), None));
        placed(self.keys)
            .chain(placed(own))
            .chain(overrides)
            .collect()
    }

    /// The place of the scenario with the keys of a statement, perhaps with an assumption, which leaves these keys alone.
    pub(super) fn world(
        &mut self,
        assumption: Option<&StudyAssumption>,
        own: &StudyKeys,
    ) -> Result<usize, StudyRunError> {
        let mut keys = self.placed_keys(own);
        if let Some(assumption) = assumption {
            let is_own = |key: &str| own.keys.iter().any(|known| path(known) == path(key));
            keys.extend(placed(&assumption.scenario).filter(|(key, _)| !is_own(key)));
        }
        let change = assumption.map_or_else(AssumedChange::default, |one| one.change.clone());
        let texts = keys.iter().map(|(key, _)| key.as_str());
        let known = self.worlds.iter().position(|world| {
            world.change == change && world.keys.iter().map(String::as_str).eq(texts.clone())
        });
        if let Some(place) = known {
            return Ok(place);
        }
        self.worlds.push(StudyWorld {
            scenario: self.parsed(&keys)?,
            keys: keys.into_iter().map(|(key, _)| key).collect(),
            change,
            evaluator: None,
            measured: Vec::new(),
        });
        Ok(self.worlds.len() - 1)
    }

    /// The scenario of the study with further keys over the overrides.
    pub(super) fn with_keys(&self, further: &StudyKeys) -> Result<Scenario, StudyRunError> {
        let mut keys = self.placed_keys(&StudyKeys::default());
        keys.extend(placed(further));
        self.parsed(&keys)
    }

    /// Whether an assumption changes anything.
    pub(super) fn is_changed(
        &mut self,
        assumption: &StudyAssumption,
        own: &StudyKeys,
    ) -> Result<bool, StudyRunError> {
        let (plain, other) = (self.world(None, own)?, self.world(Some(assumption), own)?);
        let same = self.worlds[plain].scenario == self.worlds[other].scenario;
        Ok(!same || !assumption.change.is_none())
    }

    fn parsed(&self, keys: &[PlacedKey]) -> Result<Scenario, StudyRunError> {
        let texts: Vec<&String> = keys.iter().map(|(key, _)| key).collect();
        let scenario = Scenario::parse(&self.study.name, self.base.as_bytes(), &texts);
        scenario.map_err(|problems| self.wrong(&problems, keys))
    }

    /// The problems of a scenario: those of the study by line and key, those of an override as they are.
    fn wrong(&self, problems: &Problems, keys: &[PlacedKey]) -> StudyRunError {
        let told = problems.as_slice().iter().map(|problem| {
            let line = match problem.place {
                Place::Argument { index, .. } => match keys.get(index) {
                    Some((_, Some(line))) => *line,
                    _ => return problem.to_string(),
                },
                Place::File { .. } => self.keys.line,
            };
            let place = self.study.at(line);
            format!("{place}: scenario.{}: {}", problem.key, problem.fault)
        });
        StudyRunError::Scenario(told.collect::<Vec<_>>().join("\n"))
    }

    pub(super) fn not_set_up(&self, line: usize, source: SetupError) -> StudyRunError {
        StudyRunError::Setup {
            place: self.study.at(line),
            source: Box::new(source),
        }
    }

    /// The evaluator of a scenario; `line` is that of what needs it.
    pub(super) fn evaluator(
        &mut self,
        place: usize,
        line: usize,
    ) -> Result<&Evaluator, StudyRunError> {
        if self.worlds[place].evaluator.is_none() {
            let world = &self.worlds[place];
            let setup = world.scenario.setup(self.read);
            let setup = setup.map_err(|error| self.not_set_up(line, error))?;
            let setup = world.change.of_setup(setup);
            let setup = setup.map_err(|error| self.not_set_up(line, error.into()))?;
            self.worlds[place].evaluator = Some(Evaluator::new(setup)?);
        }
        match &self.worlds[place].evaluator {
            Some(evaluator) => Ok(evaluator),
            None => Err(self
                .study
                .wrong_at(line, "its scenario has no evaluator".to_owned())),
        }
    }

    /// What is measured of a constellation under a scenario.
    pub(super) fn measured(
        &mut self,
        place: usize,
        of: &str,
        line: usize,
    ) -> Result<(&Evaluator, &Scenario, &MeasuredConstellation), StudyRunError> {
        let known = |world: &StudyWorld| world.measured.iter().position(|(name, _)| name == of);
        if known(&self.worlds[place]).is_none() {
            let constellation = match of {
                GNSS_ONLY => None,
                of => Some(self.constellation(place, of, line)?),
            };
            let found = measure(self.evaluator(place, line)?, constellation)?;
            self.worlds[place].measured.push((of.to_owned(), found));
        }
        let world = &self.worlds[place];
        let measured = known(world).and_then(|at| world.measured.get(at));
        match (&world.evaluator, measured) {
            (Some(evaluator), Some((_, measured))) => Ok((evaluator, &world.scenario, measured)),
            _ => Err(self.study.wrong_at(line, format!("{of} was not evaluated"))),
        }
    }

    /// Measures designs that [`Self::measured`] will ask for, on all cores.
    pub(super) fn measure_all(
        &mut self,
        place: usize,
        designs: &[(String, Design)],
        line: usize,
    ) -> Result<(), StudyRunError> {
        let known = &self.worlds[place].measured;
        let is_new = |text: &String| known.iter().all(|(name, _)| name != text);
        let new: Vec<(String, Design)> = designs
            .iter()
            .filter(|(text, _)| is_new(text))
            .cloned()
            .collect();
        let evaluator = self.evaluator(place, line)?;
        let one = |(text, design): (String, Design)| {
            let found = measure(evaluator, Some(Constellation::of_design(design)))?;
            Ok::<_, StudyRunError>((text, found))
        };
        let found: Vec<_> = new.into_par_iter().map(one).collect::<Result<_, _>>()?;
        self.worlds[place].measured.extend(found);
        Ok(())
    }

    fn constellation(
        &self,
        place: usize,
        of: &str,
        line: usize,
    ) -> Result<Constellation, StudyRunError> {
        let scenario = &self.worlds[place].scenario;
        if let Some(named) = scenario.constellation(of) {
            let grid = scenario.time_grid().map_err(SetupError::from);
            let read = grid.and_then(|grid| named.read(self.read, grid));
            let (one, _) = read.map_err(|source| self.not_set_up(line, source))?;
            return Ok(one);
        }
        Ok(Constellation::of_design(self.design(place, of, line)?))
    }

    pub(super) fn design(
        &self,
        place: usize,
        of: &str,
        line: usize,
    ) -> Result<Design, StudyRunError> {
        let design = self.worlds[place].scenario.design(of);
        design.map_err(|source| StudyRunError::Constellation {
            place: self.study.at(line),
            source: Box::new(source),
        })
    }
}

/// What an evaluator gives for a constellation; for `None` the GNSS alone.
pub(super) fn measure(
    evaluator: &Evaluator,
    constellation: Option<Constellation>,
) -> Result<MeasuredConstellation, StudyRunError> {
    let setup = evaluator.setup();
    let ephemeris = match &constellation {
        Some(one) => {
            let ephemeris = one.ephemeris(setup.grid, setup.model);
            ephemeris.map_err(|error| StudyRunError::Propagation(Box::new(error)))?
        }
        None => Ephemeris::new(setup.grid, Vec::new()),
    };
    let metrics = evaluator.evaluate_ephemeris(&ephemeris)?;
    Ok(MeasuredConstellation {
        constellation,
        ephemeris,
        metrics,
    })
}

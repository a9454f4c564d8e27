//! The searches of a study, each under its scenario with the keys of the search.

use super::{StudyRun, StudyRunError};
use crate::constellation::Design;
use crate::evaluate::{Evaluator, Metrics};
use crate::optimize::{Individual, Strategy, best, fuzzy};
use crate::scenario::{Algorithm, Scenario};
use crate::search::{DesignProblem, IntervalOr, ShellSpace};
use crate::study::published::steps::StudySearch;
use serde::Serialize;

/// A design of a set, with its metrics.
#[derive(Debug, Clone, PartialEq)]
pub struct FoundMember {
    /// The design.
    pub design: Design,
    /// Its metrics.
    pub metrics: Metrics,
}

impl Serialize for FoundMember {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct ShownMember<'a> {
            design: String,
            satellites: usize,
            metrics: &'a Metrics,
        }
        ShownMember {
            design: self.design.to_string(),
            satellites: self.design.satellite_count(),
            metrics: &self.metrics,
        }
        .serialize(serializer)
    }
}

/// The non-dominated set of one search.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FoundSet {
    /// Name of the search.
    pub name: String,
    /// The design space, the objectives and the algorithm, in words.
    pub what: String,
    /// Designs evaluated.
    pub evaluations: u64,
    /// The set, by the first objective.
    pub members: Vec<FoundMember>,
    /// Index of the fuzzy pick in `members`.
    pub chosen: Option<usize>,
}

impl FoundSet {
    /// The fuzzy pick.
    #[must_use]
    pub fn pick(&self) -> Option<&FoundMember> {
        self.members.get(self.chosen?)
    }
}

impl StudyRun<'_> {
    /// Runs the searches of the study.
    pub(super) fn search(&mut self) -> Result<(), StudyRunError> {
        for search in &self.study.searches {
            let found = self.found(search)?;
            self.searches.push(found);
        }
        Ok(())
    }

    fn found(&self, search: &StudySearch) -> Result<FoundSet, StudyRunError> {
        let scenario = self.with_keys(&search.scenario)?;
        if scenario.search.fixed.is_some() {
            let reason = "search.fixed: a study searches whole constellations".to_owned();
            return Err(self.study.wrong_at(search.line, reason));
        }
        let setup = scenario.setup(self.read);
        let setup = setup.map_err(|error| self.not_set_up(search.line, error))?;
        let evaluator = Evaluator::new(setup)?;
        let problem = DesignProblem::new(&evaluator, scenario.design_space(), scenario.goals())?;
        let mut strategy = scenario.method().start(&problem, scenario.optimizer.seed)?;
        while !strategy.is_done() {
            strategy.step(&problem)?;
        }
        let front = strategy.front();
        let points: Vec<&[f64]> = front.iter().map(|one| one.objectives.as_slice()).collect();
        let chosen = match points.is_empty() {
            true => None,
            false => best(&fuzzy(&points)?.minimum),
        };
        let member = |one: &Individual| {
            let (design, metrics) = problem.evaluated(&one.genome)?;
            let design = design?;
            Some(FoundMember { design, metrics })
        };
        Ok(FoundSet {
            name: search.name.clone(),
            what: described(&scenario),
            evaluations: strategy.progress().evaluations,
            members: front.iter().filter_map(member).collect(),
            chosen,
        })
    }
}

fn described(scenario: &Scenario) -> String {
    let algorithm = match scenario.optimizer.algorithm {
        Algorithm::Nsga2 => "NSGA-II",
        Algorithm::Mopso => "MOPSO",
        Algorithm::Random => "random draws",
        Algorithm::Exhaustive => "a sweep",
    };
    let shells = scenario.search.shells.as_slice().iter().map(of_shell);
    let objectives = scenario.objectives.minimize.iter().map(ToString::to_string);
    format!(
        "{}, {} by {algorithm}",
        shells.collect::<Vec<_>>().join(" + "),
        objectives.collect::<Vec<_>>().join(" and ")
    )
}

fn of_shell(space: &ShellSpace) -> String {
    let patterns: Vec<String> = space.pattern.iter().map(ToString::to_string).collect();
    let inclinations = match space.inclination_deg {
        IntervalOr::Between([low, high]) => format!("{low}° to {high}°"),
        IntervalOr::Following(sun) => sun.to_string(),
    };
    format!("{} {inclinations}", patterns.join(" or "))
}

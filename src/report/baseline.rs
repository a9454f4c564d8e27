//! A constellation that is compared with a front or with others, and its place among the objectives.

use super::shown;
use crate::constellation::Design;
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::Metrics;
use crate::exchange::constellation::{Constellation, FileSatellites};
use crate::optimize::{Evaluation, dominates};
use crate::printable::printable;
use crate::run::{Diagnostic, FrontMember};
use crate::scenario::{NamedConstellation, Scenario};
#[cfg(feature = "figures")]
use crate::search::Goals;
use crate::search::{CountedSatellites, DesignProblem, Quantity};

/// A constellation that is compared, and its place among the objectives.
#[derive(Debug, Clone, PartialEq)]
pub struct Baseline {
    /// Name.
    pub name: String,
    /// What its satellites are: the notation, the files, or both.
    pub made_of: String,
    /// Number of satellites.
    pub satellites: usize,
    /// Its metrics.
    pub metrics: Metrics,
    /// The objectives of the study with their original signs; `None` for one without a value.
    pub objectives: Vec<Option<f64>>,
    /// Constrained quantities that are not objectives; `None` for one without a value.
    pub constraints: Vec<Option<f64>>,
    /// The objectives as minimised; `None` if it violates a constraint or lacks a value.
    pub(crate) feasible: Option<Vec<f64>>,
}

/// The designs that the front of a scenario is compared with, each with its name: the reference design, then the
/// constellations that are other designs.
#[must_use]
pub fn compared_designs(scenario: &Scenario) -> Vec<(String, Design)> {
    let reference = scenario.reference_design().ok();
    let named = scenario.constellations.iter();
    let design = |one: &NamedConstellation| Some((one.name.clone(), one.only_design()?.clone()));
    let named: Vec<(String, Design)> = named
        .filter_map(design)
        .filter(|(_, design)| Some(design) != reference.as_ref())
        .collect();
    let reference = reference.map(|design| (Baseline::REFERENCE.to_owned(), design));
    reference.into_iter().chain(named).collect()
}

impl Baseline {
    /// Name of the reference design of a scenario.
    pub const REFERENCE: &'static str = "reference design";

    /// Evaluates a design; `None` if it cannot be propagated.
    #[must_use]
    pub fn evaluate(name: &str, design: &Design, problem: &DesignProblem<'_>) -> Option<Self> {
        let judged = problem.judged(design)?;
        let named = Constellation::of_design(design.clone()).named(name.to_owned());
        Some(Self::judged(&named, named.counted(None), judged, problem))
    }

    /// Evaluates a constellation by its satellites, as it is: without what the search has fixed, unless it is among
    /// them.
    ///
    /// # Errors
    /// If one of them cannot be propagated.
    pub fn of_constellation(
        one: &Constellation,
        ephemeris: &Ephemeris,
        problem: &DesignProblem<'_>,
        fixed: Option<&FileSatellites>,
    ) -> Result<Self, EphemerisError> {
        let satellites = one.counted(fixed);
        let judged = problem.judged_ephemeris(ephemeris, satellites)?;
        Ok(Self::judged(one, satellites, judged, problem))
    }

    fn judged(
        one: &Constellation,
        satellites: CountedSatellites<'_>,
        (metrics, evaluation): (Metrics, Evaluation),
        problem: &DesignProblem<'_>,
    ) -> Self {
        let goals = problem.goals();
        let value = |quantity: &Quantity| goals.value(*quantity, satellites, &metrics);
        Self {
            name: printable(&one.name).into_owned(),
            made_of: printable(&one.made_of()).into_owned(),
            satellites: satellites.count(),
            objectives: goals.objectives.iter().map(value).collect(),
            constraints: goals.constrained().iter().map(value).collect(),
            feasible: (evaluation.violation == 0.0).then_some(evaluation.objectives),
            metrics,
        }
    }

    /// The value of an objective or of a constrained quantity of the goals that it was evaluated with; `None` for
    /// another quantity.
    #[cfg(feature = "figures")]
    pub(crate) fn sought(&self, quantity: Quantity, goals: &Goals) -> Option<Option<f64>> {
        let constrained = goals.constrained();
        let names = goals.objectives.iter().chain(&constrained);
        let mut pairs = names.zip(self.objectives.iter().chain(&self.constraints));
        let found = pairs.find(|(name, _)| **name == quantity);
        found.map(|(_, value)| *value)
    }

    /// Name and what it is made of, for use in a sentence; the latter alone if it is also the name.
    #[must_use]
    pub fn label(&self) -> String {
        let Self { name, made_of, .. } = self;
        if name == made_of {
            made_of.clone()
        } else if name == Self::REFERENCE {
            format!("the {name} {made_of}")
        } else {
            format!("the constellation {name} {made_of}")
        }
    }

    /// Whether it meets the constraints and dominates a member of the front: no worse in any
    /// objective and better in one.
    #[must_use]
    pub fn outdoes(&self, member: &FrontMember) -> bool {
        let own = self.feasible.as_ref();
        own.is_some_and(|own| dominates(own, &member.minimised()))
    }

    /// The diagnostic if it dominates the pick.
    #[must_use]
    pub fn diagnose(&self, pick: &FrontMember) -> Option<Diagnostic> {
        self.outdoes(pick).then(|| {
            let names = pick.objectives.iter().map(|(name, _)| name.as_str());
            let values = names.zip(self.objectives.iter().copied());
            Diagnostic::new(
                Self::DOMINATES,
                format!(
                    "{} ({}) dominates the pick {} ({}): take it, or give the search more generations, a \
                     larger population or wider bounds",
                    self.label(),
                    shown::pairs(values),
                    pick.made_of(),
                    shown::objectives(pick)
                ),
            )
        })
    }

    /// Code of the diagnostic for a pick dominated by a comparison design.
    pub const DOMINATES: &'static str = "pick-dominated";
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::testing;

    #[test]
    fn only_what_is_feasible_and_no_worse_outdoes_a_pick() {
        let pick = FrontMember {
            objectives: vec![
                ("max-pdop".to_owned(), 2.0),
                ("mean-visible".to_owned(), 8.0),
            ],
            ..testing::member(1, "delta:45:225/15/1@1000")
        };
        let beside = |feasible: Option<[f64; 2]>| Baseline {
            name: Baseline::REFERENCE.to_owned(),
            made_of: "delta:55:182/13/1@925".to_owned(),
            satellites: 182,
            metrics: pick.metrics,
            objectives: vec![Some(2.0), Some(9.0)],
            constraints: Vec::new(),
            feasible: feasible.map(|x| x.to_vec()),
        };
        // More in view is better: as it is minimised, -9 is better than -8.
        let found = beside(Some([2.0, -9.0])).diagnose(&pick).unwrap();
        assert_eq!(found.code, "pick-dominated");
        let told =
            "(max-pdop 2.0000, mean-visible 9.0000) dominates the pick delta:45:225/15/1@1000";
        assert!(found.message.contains(told), "{}", found.message);
        for other in [Some([2.0, -8.0]), Some([2.1, -9.0]), None] {
            assert_eq!(beside(other).diagnose(&pick), None);
        }
    }
}

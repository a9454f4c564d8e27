//! Which satellites of a constellation are in service in each phase of a build-up or a drawdown.

use crate::ephemeris::Ephemeris;
use crate::ephemeris::outages::OutageError;
use crate::formats::deployment::DeploymentStep;
use thiserror::Error;

/// A phase of a build-up or a drawdown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeploymentPhase {
    /// Its name.
    pub phase: String,
    /// The places of the satellites that are not in service.
    pub missing: Vec<usize>,
}

/// Why phases are not those of a constellation.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum DeploymentError {
    /// No satellite has a name.
    #[error(transparent)]
    Unknown(#[from] OutageError),
    /// A satellite that is in service is added.
    #[error("{origin}: {satellite} is added in phase {phase}, and it is in service already")]
    Added {
        /// File and line.
        origin: String,
        /// The satellite.
        satellite: String,
        /// The phase.
        phase: String,
    },
    /// A satellite that is not in service is removed.
    #[error("{origin}: {satellite} is removed in phase {phase}, and it is not in service")]
    Removed {
        /// File and line.
        origin: String,
        /// The satellite.
        satellite: String,
        /// The phase.
        phase: String,
    },
}

/// The phases of a constellation. A satellite of which the first thing said is that it is added is not in service before; all
/// others are from the start. In a phase satellites are removed before others are added.
///
/// # Errors
/// If a name is that of no satellite, plane or shell, or a satellite is added in service or removed out of it.
pub fn deployment_phases(
    constellation: &str,
    ephemeris: &Ephemeris,
    (file, steps): (&str, &[DeploymentStep]),
) -> Result<Vec<DeploymentPhase>, DeploymentError> {
    let origin = |step: &DeploymentStep| format!("{file}, line {}", step.line);
    let mut moves = Vec::new();
    for step in steps {
        let find_all = |names: &[String]| -> Result<Vec<usize>, OutageError> {
            let places = |name: &String| ephemeris.places_of(constellation, name, &origin(step));
            let places = names.iter().map(places);
            Ok(places.collect::<Result<Vec<_>, _>>()?.concat())
        };
        moves.push((step, find_all(&step.removed)?, find_all(&step.added)?));
    }
    let mut first_said = vec![None; ephemeris.satellites().len()];
    for (_, removed, added) in &moves {
        removed
            .iter()
            .for_each(|place| _ = first_said[*place].get_or_insert(true));
        added
            .iter()
            .for_each(|place| _ = first_said[*place].get_or_insert(false));
    }
    let mut is_up: Vec<bool> = first_said.iter().map(|said| said.unwrap_or(true)).collect();
    let mut phases = Vec::new();
    for (step, removed, added) in moves {
        let (origin, phase) = (origin(step), step.phase.clone());
        let name = |place: usize| ephemeris.satellites()[place].name.clone();
        for place in removed {
            if !std::mem::replace(&mut is_up[place], false) {
                let satellite = name(place);
                return Err(DeploymentError::Removed {
                    origin,
                    satellite,
                    phase,
                });
            }
        }
        for place in added {
            if std::mem::replace(&mut is_up[place], true) {
                let satellite = name(place);
                return Err(DeploymentError::Added {
                    origin,
                    satellite,
                    phase,
                });
            }
        }
        let missing = (0..is_up.len()).filter(|place| !is_up[*place]).collect();
        phases.push(DeploymentPhase { phase, missing });
    }
    Ok(phases)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::constellation::Design;
    use crate::formats::deployment::read;
    use crate::orbit::Model;
    use crate::time::{Epoch, TimeGrid};

    fn phases(table: &str) -> Result<Vec<DeploymentPhase>, String> {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 600.0, 60.0).unwrap();
        let design: Design = "delta:55:6/3/1@925".parse().unwrap();
        let ephemeris = Ephemeris::of_design(&design, Model::J2, grid).unwrap();
        let steps = read(table.as_bytes()).unwrap();
        deployment_phases("it", &ephemeris, ("p.csv", &steps)).map_err(|error| error.to_string())
    }

    fn missing(table: &str) -> Vec<Vec<usize>> {
        phases(table)
            .unwrap()
            .into_iter()
            .map(|one| one.missing)
            .collect()
    }

    /// What is added is missing before, what is removed is there before, and what is not named is always there.
    #[test]
    fn satellites_come_and_go() {
        let build_up = "phase,add\na,NW-P01\nb,NW-P03-S02 NW-P03-S01\n";
        assert_eq!(missing(build_up), [vec![4, 5], vec![]]);
        let drawdown = "phase,remove\na,NW-P02\nb,NW-P01-S01\n";
        assert_eq!(missing(drawdown), [vec![2, 3], vec![0, 2, 3]]);
        let both =
            "phase,add,remove\na,NW-P01,\nb,,NW-P01-S02\nc,NW-P01-S02,NW-P02\nd,,NW-P01 NW-P03\n";
        assert_eq!(
            missing(both),
            [vec![], vec![1], vec![2, 3], vec![0, 1, 2, 3, 4, 5]]
        );
        // Replaced within a phase.
        assert_eq!(
            missing("phase,add,remove\na,NW-P01-S01,NW-P01-S01\n"),
            [Vec::<usize>::new()]
        );
    }

    #[test]
    fn phases_that_cannot_be_are_told_with_the_line() {
        let error = |table: &str| phases(table).unwrap_err();
        let unknown = error("phase,add\na,NW-P01\nb,NW-P4\n");
        let expected =
            "p.csv, line 3: 'NW-P4' is not a satellite or plane of it, did you mean 'NW-P0";
        assert!(unknown.starts_with(expected), "{unknown}");
        assert_eq!(
            error("phase,add\na,NW-P01\nb,NW-P01-S02\n"),
            "p.csv, line 3: NW-P01-S02 is added in phase b, and it is in service already"
        );
        assert_eq!(
            error("phase,remove\na,NW-P01\nb,NW-P01-S02\n"),
            "p.csv, line 3: NW-P01-S02 is removed in phase b, and it is not in service"
        );
    }
}

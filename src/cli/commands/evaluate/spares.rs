//! What is expected over the life of a constellation, with and without spares.

use super::EvaluationContext;
use crate::cli::args::EvaluateArgs;
use crate::ephemeris::Ephemeris;
use crate::exchange::constellation::Constellation;
use crate::report::{ExpectedService, SpareService};
use crate::scenario::Scenario;
use crate::search::SparedPlanes;
use crate::units::counted;
use anyhow::{Result, bail};

/// Number of draws where none is given.
pub(super) const DRAWS: u32 = 200;

/// Refuses `--draws` where nothing is drawn.
pub(super) fn require_use_of_draws(args: &EvaluateArgs, scenario: &Scenario) -> Result<()> {
    let is_used = args.failures.is_some() || scenario.reliability.spares_per_plane.is_some();
    if args.draws.is_some() && !is_used {
        bail!("--draws: nothing is drawn without --failures or reliability.spares-per-plane");
    }
    Ok(())
}

/// The metrics expected by `[reliability]` of the scenario, if it has one.
pub(super) fn expected(
    work: &EvaluationContext<'_>,
    one: &Constellation,
    ephemeris: &Ephemeris,
) -> Result<Option<ExpectedService>> {
    let reliability = &work.scenario.reliability;
    let Some(up) = reliability.satellite_availability() else {
        return Ok(None);
    };
    let Some(spares) = reliability.spares_per_plane else {
        let metrics = work.evaluator.expected(ephemeris, up)?;
        return Ok(Some(ExpectedService {
            metrics,
            spares: None,
        }));
    };
    let planes: Vec<Vec<usize>> = ephemeris.planes().into_iter().map(|(_, of)| of).collect();
    let in_planes: usize = planes.iter().map(Vec::len).sum();
    let others = ephemeris.satellites().len() - in_planes;
    if others > 0 {
        bail!(
            "reliability.spares-per-plane: {} has {} of no plane, from files; spares are of the planes of designs",
            one.name,
            counted(others, "satellite")
        );
    }
    let spared = SparedPlanes { up, spares };
    let seed = work.scenario.optimizer.seed;
    let draws = spared.draws(&planes, work.args.draws.unwrap_or(DRAWS) as usize, seed);
    let metrics = work.evaluator.expected_over(ephemeris, up, &draws)?;
    let (mut vacancies, mut all_filled) = (0.0, 1.0);
    for plane in &planes {
        vacancies += spared.mean_vacancies(plane.len());
        all_filled *= spared.vacancy_probabilities(plane.len())[0];
    }
    let spares = SpareService {
        spares_per_plane: spares,
        planes: planes.len(),
        seed,
        mean_vacancies: vacancies,
        all_filled,
    };
    Ok(Some(ExpectedService {
        metrics,
        spares: Some(spares),
    }))
}

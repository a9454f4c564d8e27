//! The best designs and the closest rejected ones under other samples.

use crate::cli::study::Study;
use crate::constellation::Design;
use crate::evaluate::{Evaluator, Setup};
use crate::run::size::{RobustnessRow, robustness};
use crate::search::size::SizeProblem;
use anyhow::Result;

/// Phases of the GNSS, that of the scenario among them.
const PHASES: u32 = 8;

/// The designs at half the step, on half the grid and at the phases of the GNSS; what a scenario does not have is left
/// out.
pub(super) fn rows(study: &Study, setup: &Setup, designs: &[Design]) -> Result<Vec<RobustnessRow>> {
    let mut rows = at(study, setup.clone(), designs, "scenario")?;
    let mut finer = study.clone();
    finer.scenario.time.step_s /= 2.0;
    rows.extend(at(study, finer.setup()?, designs, "half step")?);
    if let Some(region) = study.scenario.region.with_half_distance() {
        let mut finer = study.clone();
        finer.scenario.region = region;
        rows.extend(at(study, finer.setup()?, designs, "half grid")?);
    }
    for phase in 1..PHASES {
        let share = f64::from(phase) / f64::from(PHASES);
        // Without GNSS, or with satellites from files, there is one phase.
        let Ok(setup) = setup.at_gnss_phase(share) else {
            break;
        };
        rows.extend(at(
            study,
            setup,
            designs,
            &format!("phase {phase}/{PHASES}"),
        )?);
    }
    rows.sort_by_key(|row| {
        let notation = row.design.as_str();
        designs.iter().position(|one| one.to_string() == notation)
    });
    Ok(rows)
}

fn at(
    study: &Study,
    setup: Setup,
    designs: &[Design],
    samples: &str,
) -> Result<Vec<RobustnessRow>> {
    let evaluator = Evaluator::new(setup)?;
    let problem = study.problem(&evaluator)?;
    Ok(robustness(&SizeProblem::new(&problem), designs, samples))
}

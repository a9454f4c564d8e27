//! A build-up or a drawdown, phase by phase.

use super::EvaluationContext;
use crate::cli::files;
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Evaluator, Metrics};
use crate::exchange::constellation::Constellation;
use crate::exchange::deployment::deployment_phases;
use crate::formats::deployment::{self, DeploymentStep};
use crate::report::{DeploymentSummary, PhaseService};
use crate::search::{Constraint, Quantity, Relation};
use anyhow::{Context, Result, bail};
use std::path::Path;

/// The table of `--phases`.
pub(super) struct DeploymentTable {
    name: String,
    steps: Vec<DeploymentStep>,
}

impl DeploymentTable {
    /// Reads the table, if one is given.
    pub(super) fn read(path: Option<&Path>) -> Result<Option<Self>> {
        let Some(path) = path else { return Ok(None) };
        let name = path.display().to_string();
        let bytes = files::read_whole(path).with_context(|| format!("cannot read {name}"))?;
        let steps = deployment::read(&bytes).with_context(|| format!("--phases {name}"))?;
        Ok(Some(Self { name, steps }))
    }

    /// Name, satellites in service and metrics of each phase of a constellation.
    fn phases(
        &self,
        evaluator: &Evaluator,
        one: &Constellation,
        ephemeris: &Ephemeris,
    ) -> Result<Vec<(String, usize, Metrics)>> {
        let phases = deployment_phases(&one.name, ephemeris, (&self.name, &self.steps))?;
        let mut found = Vec::with_capacity(phases.len());
        for phase in phases {
            let left = one.in_service(evaluator.setup())?.without(&phase.missing);
            let metrics = evaluator.evaluate_ephemeris(&left)?;
            found.push((phase.phase, left.satellites().len(), metrics));
        }
        Ok(found)
    }
}

/// What service requires: the constraints of the scenario, or else that all samples are available.
fn required(work: &EvaluationContext<'_>) -> Result<Vec<Constraint>> {
    let constraints = &work.goals.constraints;
    if let Some(other) = constraints.iter().find(|one| one.quantity.is_of_shells()) {
        bail!(
            "--phases: service is what the constraints of the scenario require, and {other} is not of its service; leave it out \
             with --set objectives.constraints=[…]"
        );
    }
    if !constraints.is_empty() {
        return Ok(constraints.clone());
    }
    Ok(vec![Constraint {
        quantity: Quantity::Availability,
        relation: Relation::AtLeast,
        bound: 1.0,
    }])
}

/// The phases of a constellation.
pub(super) fn summary(
    work: &EvaluationContext<'_>,
    one: &Constellation,
    ephemeris: &Ephemeris,
    table: &DeploymentTable,
) -> Result<DeploymentSummary> {
    let required = required(work)?;
    let alone = work.gnss_only.as_ref().map(|of| of.metrics);
    let phase = |(phase, satellites, metrics): (String, usize, Metrics)| {
        let metrics = alone.map_or(metrics, |alone| metrics.with_gain_over(&alone));
        let is_met = |constraint: &Constraint| {
            let quantity = constraint.quantity;
            let solved = quantity.solved_fraction(&metrics);
            constraint.violation(quantity.of_metrics(&metrics), solved) == 0.0
        };
        PhaseService {
            phase,
            satellites,
            serves: required.iter().all(is_met),
            metrics,
        }
    };
    let phases = table.phases(work.evaluator, one, ephemeris)?;
    let phases = phases.into_iter().map(phase).collect();
    let requires = required.iter().map(ToString::to_string).collect();
    Ok(DeploymentSummary::new(requires, phases))
}

//! The metrics over the relative nodes of a hybrid's shells.

use super::{EvaluationContext, evaluated};
use crate::cli::constellations;
use crate::constellation::relative_nodes::{after_days, longest_period_days};
use crate::exchange::constellation::Constellation;
use crate::report::{ConstellationEntry, NodeSpread, PhaseSpread};
use anyhow::{Context, Result, bail};

/// What `--relative-nodes` asks for.
const FLAG: &str = "--relative-nodes";

/// Each constellation at equally spaced relative nodes beside its own.
pub(super) struct RelativeNodeStudy {
    /// The period of each, days, and the constellation as it stands later.
    turned: Vec<(f64, Vec<Constellation>)>,
}

impl RelativeNodeStudy {
    /// `count` relative nodes of each constellation, if they are asked for.
    pub(super) fn new(count: Option<u32>, given: &[Constellation]) -> Result<Option<Self>> {
        let Some(count) = count else {
            return Ok(None);
        };
        let turned = given.iter().map(|one| turned(one, count));
        let turned = turned.collect::<Result<_>>()?;
        Ok(Some(Self { turned }))
    }

    /// Evaluates the constellations at each of the nodes and adds the spreads to what is known of them.
    pub(super) fn add(
        &self,
        work: &EvaluationContext<'_>,
        entries: &mut [ConstellationEntry],
    ) -> Result<()> {
        let alone = work.gnss_only.as_ref().map(|of| of.metrics);
        for (entry, (period_days, later)) in entries.iter_mut().zip(&self.turned) {
            let mut found = vec![entry.evaluated.metrics];
            for one in later {
                let setup = work.evaluator.setup();
                let ephemeris = constellations::propagate_member(one, setup)?;
                let metrics = evaluated(work.args, (work.evaluator, None), &ephemeris)?.0;
                found.push(alone.map_or(metrics, |alone| metrics.with_gain_over(&alone)));
            }
            if let Some(nodes) = &mut entry.evaluated.relative_nodes {
                nodes.spread = Some(NodeSpread::of(*period_days, PhaseSpread::of(&found)));
            }
        }
        Ok(())
    }
}

fn turned(one: &Constellation, count: u32) -> Result<(f64, Vec<Constellation>)> {
    let (Some(design), None) = (&one.design, &one.files) else {
        bail!(
            "{FLAG}: {} has satellites from files, which keep the places that these give",
            one.name
        );
    };
    let told = || format!("{FLAG}: {}", one.name);
    let period_days = longest_period_days(design).with_context(told)?;
    let later = (1..count).map(|k| {
        let days = period_days * f64::from(k) / f64::from(count);
        Ok(Constellation {
            design: Some(after_days(design, days).with_context(told)?),
            ..one.clone()
        })
    });
    Ok((period_days, later.collect::<Result<_>>()?))
}

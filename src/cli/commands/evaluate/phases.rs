//! The metrics over phases of the GNSS.

use super::{EvaluationContext, evaluated};
use crate::ephemeris::Ephemeris;
use crate::evaluate::{Evaluator, Metrics, Setup};
use crate::report::{ConstellationEntry, PhaseSpread};
use anyhow::{Context, Result};

/// The phases of the GNSS beside that of the scenario.
pub(super) struct GnssPhases {
    setups: Vec<Setup>,
}

impl GnssPhases {
    /// `count` equally spaced phases, if they are asked for.
    pub(super) fn new(count: Option<u32>, setup: &Setup) -> Result<Option<Self>> {
        let Some(count) = count else {
            return Ok(None);
        };
        let shares = (1..count).map(|k| f64::from(k) / f64::from(count));
        let setups = shares.map(|share| setup.at_gnss_phase(share));
        let setups = setups.collect::<Result<_, _>>().context("--gnss-phases")?;
        Ok(Some(Self { setups }))
    }

    /// Evaluates the constellations, and the GNSS alone, at each phase and adds the spreads to what is known of them.
    pub(super) fn add(
        &self,
        work: &mut EvaluationContext<'_>,
        entries: &mut [ConstellationEntry],
        ephemerides: &[Ephemeris],
    ) -> Result<()> {
        let none = Ephemeris::new(work.evaluator.setup().grid, Vec::new());
        let mut found: Vec<Vec<Metrics>> = entries
            .iter()
            .map(|entry| vec![entry.evaluated.metrics])
            .collect();
        let mut alone: Vec<Metrics> = work.gnss_only.iter().map(|of| of.metrics).collect();
        for setup in &self.setups {
            let evaluator = Evaluator::new(setup.clone())?;
            let gnss_only = evaluated(work.args, (&evaluator, None), &none)?.0;
            alone.push(gnss_only.with_gain_over(&gnss_only));
            for (found, ephemeris) in found.iter_mut().zip(ephemerides) {
                let metrics = evaluated(work.args, (&evaluator, None), ephemeris)?.0;
                found.push(metrics.with_gain_over(&gnss_only));
            }
        }
        for (entry, found) in entries.iter_mut().zip(&found) {
            entry.evaluated.gnss_phases = Some(PhaseSpread::of(found));
        }
        if let Some(gnss_only) = &mut work.gnss_only {
            gnss_only.gnss_phases = Some(PhaseSpread::of(&alone));
        }
        Ok(())
    }
}

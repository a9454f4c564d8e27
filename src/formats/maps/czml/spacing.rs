//! How far apart the samples of a satellite lie.

use super::{DEGREE, TARGET_KM};
use crate::ephemeris::arc::lagrange;
use crate::ephemeris::sampled::Sampled;
use crate::ephemeris::{Ephemeris, EphemerisError, EphemerisSatellite};
use crate::frames::{EarthFixed, State};
use rayon::prelude::*;

/// Spacings of samples that are tried, s.
const SPACINGS_S: [f64; 9] = [
    3600.0, 1800.0, 1200.0, 600.0, 300.0, 120.0, 60.0, 30.0, 10.0,
];

/// Maximum number of intervals between samples that are checked for the error of a spacing.
const INTERVALS: usize = 500;

/// Samples beyond each end.
const BEYOND: i64 = DEGREE as i64 / 2;

/// How far apart samples lie, and what that costs.
#[derive(Clone, Copy)]
pub(super) struct Spacing {
    pub(super) step_s: f64,
    pub(super) error_km: f64,
}

impl Spacing {
    /// Of nothing that was measured.
    const UNKNOWN: Self = Self {
        step_s: SPACINGS_S[0],
        error_km: f64::INFINITY,
    };
}

/// The span that is shown.
pub(super) struct ShownSpan {
    pub(super) start: String,
    pub(super) end: String,
    pub(super) span_s: f64,
}

impl ShownSpan {
    /// The spacing for each satellite. Those of a shell are propagated in the same way, so the first determines the
    /// spacing of all; for the others, of several heights, the spacing that suits the lowest suits all.
    pub(super) fn spacings(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        ephemeris: &Ephemeris,
    ) -> Result<Vec<Spacing>, EphemerisError> {
        let satellites = ephemeris.satellites();
        let mut spacings = vec![Spacing::UNKNOWN; satellites.len()];
        for span in ephemeris.shells() {
            spacings[span.places()].fill(self.spacing(sampled, &satellites[span.first])?);
        }
        let others = ephemeris.outside_shells();
        let found = others.par_iter();
        let found = found.map(|place| self.spacing(sampled, &satellites[*place]));
        let found: Vec<Spacing> = found.collect::<Result<_, _>>()?;
        let narrowest = found.into_iter().reduce(|one, other| {
            if other.step_s < one.step_s {
                other
            } else {
                one
            }
        });
        for (place, narrowest) in others.into_iter().zip(narrowest.into_iter().cycle()) {
            spacings[place] = narrowest;
        }
        Ok(spacings)
    }

    /// The widest spacing within the target, or the best one.
    fn spacing(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
    ) -> Result<Spacing, EphemerisError> {
        let mut best: Option<Spacing> = None;
        for step_s in SPACINGS_S {
            let error_km = self.error_km(sampled, propagated, step_s)?;
            if best.is_none_or(|best| error_km < best.error_km) {
                best = Some(Spacing { step_s, error_km });
            }
            if error_km <= TARGET_KM {
                break;
            }
        }
        Ok(best.unwrap_or(Spacing::UNKNOWN))
    }

    /// Largest distance between the polynomial and the model halfway between samples, km. Where states end at the
    /// ends of the span, the samples are those within, as in a viewer.
    fn error_km(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
        step_s: f64,
    ) -> Result<f64, EphemerisError> {
        let nodes = self.nodes(sampled, propagated, step_s)?;
        let count = nodes.len().min(DEGREE + 1);
        let intervals: Vec<usize> = (1..nodes.len())
            .filter(|k| nodes[*k].0 > 0.0 && nodes[k - 1].0 < self.span_s)
            .collect();
        let stride = intervals.len().div_ceil(INTERVALS).max(1);
        let mut worst_km = 0.0_f64;
        for k in intervals.into_iter().step_by(stride) {
            let first = k.saturating_sub(count / 2).min(nodes.len() - count);
            let middle_s = 0.5 * (nodes[k - 1].0 + nodes[k].0);
            let exact = sampled.state(propagated, middle_s)?.position_km.km();
            let found = lagrange(&nodes[first..first + count], middle_s).0;
            worst_km = worst_km.max((found - exact).norm());
        }
        Ok(worst_km)
    }

    /// Positions at whole multiples of a spacing from before the span to beyond it, Earth-fixed, km; of states
    /// that end before, as far as they go, to the last sample of the study.
    pub(super) fn nodes(
        &self,
        sampled: &Sampled<'_, EarthFixed>,
        propagated: &EphemerisSatellite,
        step_s: f64,
    ) -> Result<Vec<(f64, State<EarthFixed>)>, EphemerisError> {
        let intervals = (self.span_s / step_s).ceil() as i64;
        let mut nodes = Vec::new();
        for k in -BEYOND..=intervals + BEYOND {
            let t = k as f64 * step_s;
            nodes.extend(sampled.state_or_gap(propagated, t)?.map(|state| (t, state)));
        }
        let grid = sampled.grid();
        let last_s = grid.elapsed_s(grid.len() - 1);
        if nodes.last().is_none_or(|(t, _)| *t < last_s) {
            nodes.push((last_s, sampled.state(propagated, last_s)?));
        }
        Ok(nodes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ephemeris::testing::files_between_shells;

    /// Each satellite has the spacing of its own orbit, whatever is before it.
    #[test]
    fn spacings_are_those_of_the_own_orbit() {
        let mixed = files_between_shells();
        let sampled = Sampled::new(&mixed, EarthFixed);
        let span = ShownSpan {
            start: String::new(),
            end: String::new(),
            span_s: 7_200.0,
        };
        let found = span.spacings(&sampled, &mixed).unwrap();
        let errors: Vec<f64> = found.iter().map(|one| one.error_km).collect();
        let of = |place: usize| {
            let own = span.spacing(&sampled, &mixed.satellites()[place]);
            own.unwrap().error_km
        };
        let (low, file, high) = (of(0), errors[2], of(4));
        assert!(low != high && [2, 3].map(of).contains(&file));
        assert_eq!(errors, [low, low, file, file, high, high, high, high]);
    }
}

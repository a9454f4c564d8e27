//! The numbers of a constellation that was evaluated.

use super::metric::{DilutionKind, OrbitQuantity, SampleStatistic, SpreadQuantity, StudyMetric};
use crate::constellation::{Shell, Slot, coverage_radius_deg};
use crate::dop::{SkyRule, SkyView};
use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{Evaluator, Metrics};
use crate::exchange::constellation::Constellation;
use crate::orbit::ground_track::{GroundTrack, sun_synchronous_inclination_deg};
use crate::orbit::j2::SecularRates;
use crate::search::{CountedSatellites, Goals};
use crate::units::{SECONDS_PER_DAY, wrap_360};
use std::f64::consts::TAU;

/// Weight by which rounding may miss a quantile of a histogram.
const ROUNDING: f64 = 1e-9;

/// What was computed of a constellation.
pub(super) struct MeasuredConstellation {
    /// The constellation; `None` for the GNSS alone.
    pub(super) constellation: Option<Constellation>,
    /// Its satellites.
    pub(super) ephemeris: Ephemeris,
    /// Its metrics.
    pub(super) metrics: Metrics,
}

impl MeasuredConstellation {
    /// The number of a metric; `None` if it has none.
    pub(super) fn value(
        &self,
        evaluator: &Evaluator,
        goals: &Goals,
        metric: StudyMetric,
    ) -> Result<Option<f64>, EphemerisError> {
        match metric {
            // Not of samples.
            StudyMetric::Orbit(_)
            | StudyMetric::Sky(_)
            | StudyMetric::Plane(_)
            | StudyMetric::Sets(_)
            | StudyMetric::Implied => Ok(None),
            StudyMetric::Quantity(quantity) => {
                let satellites = match &self.constellation {
                    Some(one) => one.counted(None),
                    None => CountedSatellites::default(),
                };
                Ok(goals.value(quantity, satellites, &self.metrics))
            }
            StudyMetric::Dilution(statistic, dilution) => {
                self.dilution(evaluator, statistic, dilution)
            }
            StudyMetric::Spread(statistic, spread) => self.spread(evaluator, statistic, spread),
        }
    }

    fn dilution(
        &self,
        evaluator: &Evaluator,
        statistic: SampleStatistic,
        dilution: DilutionKind,
    ) -> Result<Option<f64>, EphemerisError> {
        // The metrics have PDOP; the other dilutions take several times as long.
        let known = self.metrics.pdop_summary();
        let known = known.and_then(|summary| statistic.of_summary(&summary));
        if let (DilutionKind::Pdop, Some(known)) = (dilution, known) {
            return Ok(Some(known));
        }
        let dops = evaluator.dops_beside(&self.metrics, &self.ephemeris)?;
        let named = dops.named();
        let first = match dilution {
            DilutionKind::Gdop => 0,
            DilutionKind::Pdop => 1,
            DilutionKind::Hdop => 2,
            DilutionKind::Vdop => 3,
            // The first clock that has a value.
            DilutionKind::Tdop => match named.iter().skip(4).position(|(_, of)| of.is_some()) {
                Some(place) => 4 + place,
                None => return Ok(None),
            },
        };
        let Some((_, Some(summary))) = named.get(first) else {
            return Ok(None);
        };
        match (statistic.of_summary(summary), statistic) {
            (None, SampleStatistic::Quantile(level)) => {
                let quantiles = evaluator.dop_quantiles(&self.ephemeris, level)?;
                Ok(quantiles.get(first).copied().flatten())
            }
            (value, _) => Ok(value),
        }
    }

    fn spread(
        &self,
        evaluator: &Evaluator,
        statistic: SampleStatistic,
        spread: SpreadQuantity,
    ) -> Result<Option<f64>, EphemerisError> {
        let sigma = |place: usize| {
            let samples = evaluator.sigma_samples(&self.ephemeris)?;
            Ok(samples.and_then(|mut of| statistic.of_samples(&mut of[place])))
        };
        match spread {
            SpreadQuantity::Sigma3dM => sigma(0),
            SpreadQuantity::SigmaHM => sigma(1),
            SpreadQuantity::SigmaVM => sigma(2),
            SpreadQuantity::InformationPdop => {
                let samples = evaluator.information_samples(&self.ephemeris)?;
                Ok(samples.and_then(|mut samples| statistic.of_samples(&mut samples)))
            }
            SpreadQuantity::Visible
            | SpreadQuantity::GnssVisible
            | SpreadQuantity::TotalVisible => {
                let (_, views) = evaluator.evaluate_views(&self.ephemeris)?;
                Ok(of_histogram(
                    statistic,
                    match spread {
                        SpreadQuantity::Visible => &views.leo,
                        SpreadQuantity::GnssVisible => &views.gnss,
                        _ => &views.all,
                    },
                ))
            }
        }
    }
}

/// A statistic of numbers of satellites, from the share of the samples that has each.
fn of_histogram(statistic: SampleStatistic, shares: &[f64]) -> Option<f64> {
    let numbered = shares.iter().enumerate();
    let mut filled = numbered.filter(|(_, share)| **share > 0.0);
    match statistic {
        SampleStatistic::Mean => Some(filled.map(|(n, share)| n as f64 * share).sum()),
        SampleStatistic::Max => filled.next_back().map(|(n, _)| n as f64),
        SampleStatistic::Quantile(level) => {
            let mut below = 0.0;
            let at = filled.find(|(_, share)| {
                below += **share;
                below >= level.get() - ROUNDING
            });
            at.map(|(n, _)| n as f64)
        }
    }
}

/// A quantity of the orbit of a slot.
pub(super) fn of_orbit(shell: &Shell, slot: Slot, quantity: OrbitQuantity) -> Option<f64> {
    let elements = shell.elements(slot);
    let rates = SecularRates::j2(&elements);
    let track = GroundTrack::of(&elements);
    let wrapped = |angle_rad: f64| wrap_360(angle_rad.to_degrees());
    Some(match quantity {
        OrbitQuantity::CoverageRadius => return coverage_radius_deg(shell),
        OrbitQuantity::SunSynchronousInclination => {
            return sun_synchronous_inclination_deg(&elements);
        }
        OrbitQuantity::NodalRate => rates.raan_rad_s.to_degrees() * SECONDS_PER_DAY,
        OrbitQuantity::NodalPeriod => track.nodal_period_s / 60.0,
        OrbitQuantity::KeplerPeriod => TAU / elements.kepler_mean_motion_rad_s() / 60.0,
        OrbitQuantity::RevolutionsPerNodalDay => track.revolutions_per_day(),
        OrbitQuantity::Raan => wrapped(elements.raan_rad),
        OrbitQuantity::ArgLatitude => wrapped(elements.mean_argument_of_latitude_rad()),
    })
}

/// A dilution of precision of a sky, of all satellites that are not below the horizon.
pub(super) fn of_sky(sky: &SkyView, dilution: DilutionKind) -> Option<f64> {
    let found = sky.dops(SkyRule::default());
    let tdop = found.tdop();
    let dops = found.dops?;
    match dilution {
        DilutionKind::Gdop => Some(dops.gdop),
        DilutionKind::Pdop => Some(dops.pdop),
        DilutionKind::Hdop => Some(dops.hdop),
        DilutionKind::Vdop => Some(dops.vdop),
        DilutionKind::Tdop => tdop,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four samples in view of 2, 2, 3 and 7 satellites.
    #[test]
    fn statistics_of_a_histogram() {
        let shares = [0.0, 0.0, 0.5, 0.25, 0.0, 0.0, 0.0, 0.25];
        let of = |text: &str| of_histogram(text.parse().unwrap(), &shares);
        assert_eq!(of("mean"), Some(3.5));
        assert_eq!(of("max"), Some(7.0));
        assert_eq!(
            ["p1", "p50", "p51", "p75", "p76"].map(of),
            [2.0, 2.0, 3.0, 3.0, 7.0].map(Some)
        );
        assert_eq!(of_histogram(SampleStatistic::Max, &[]), None);
    }
}

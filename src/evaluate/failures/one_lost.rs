//! The worst without any one of the satellites, as a search optimises and bounds it.

use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::on_demand::{self, OnDemand};
use crate::evaluate::{Evaluator, Metrics};
use serde::{Deserialize, Serialize};

/// The worst of each metric without any one of the satellites. It is that of all satellites if there are none.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OneLost {
    /// Largest maximum PDOP of the solved samples.
    pub max_pdop: Option<f64>,
    /// Largest CVaR of the PDOP of the solved samples, where it is asked for.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub cvar_pdop: OnDemand<f64>,
    /// Least availability.
    pub availability: f64,
    /// Least solved fraction.
    pub solved_fraction: f64,
}

impl OneLost {
    /// One case.
    fn of(metrics: &Metrics) -> Self {
        Self {
            max_pdop: metrics.max_pdop,
            cvar_pdop: Some(metrics.cvar_pdop),
            availability: metrics.availability,
            solved_fraction: metrics.solved_fraction,
        }
    }

    /// The worst of each metric; a case without solved samples has no PDOP, nor has the worst.
    fn worst(cases: &[Self]) -> Self {
        fn largest(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
            let values: Option<Vec<f64>> = values.collect();
            values?.into_iter().max_by(f64::total_cmp)
        }
        let tails: Option<Vec<_>> = cases.iter().map(|case| case.cvar_pdop).collect();
        let least = |of: fn(&Self) -> f64| cases.iter().map(of).fold(1.0, f64::min);
        Self {
            max_pdop: largest(cases.iter().map(|case| case.max_pdop)),
            cvar_pdop: tails.map(|tails| largest(tails.into_iter())),
            availability: least(|case| case.availability),
            solved_fraction: least(|case| case.solved_fraction),
        }
    }
}

impl Evaluator {
    /// The metrics with what failures do to them, where the setup asks for it.
    pub(in crate::evaluate) fn with_failures(
        &self,
        metrics: Metrics,
        ephemeris: &Ephemeris,
    ) -> Result<Metrics, EphemerisError> {
        let options = self.setup().metrics;
        let one_lost = || {
            let singles: Vec<Vec<usize>> = (0..ephemeris.satellites().len())
                .map(|place| vec![place])
                .collect();
            let cases = if singles.is_empty() {
                vec![OneLost::of(&metrics)]
            } else if options.asks_for_n1_tail {
                let cases = self.without_each(ephemeris, &singles)?;
                cases.iter().map(OneLost::of).collect()
            } else {
                self.worst_without_each(ephemeris, &singles)?
            };
            Ok(OneLost::worst(&cases))
        };
        let expected = |up: f64| Ok(self.expected_of_any(ephemeris, up)?.availability);
        Ok(Metrics {
            n1: options.asks_for_n1.then(one_lost).transpose()?,
            expected_availability: options.expects_up.map(expected).transpose()?,
            ..metrics
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::no_metrics;

    #[test]
    fn the_worst_is_of_each_metric_by_itself() {
        let case = |max_pdop, cvar_pdop, availability| Metrics {
            max_pdop,
            cvar_pdop: Some(cvar_pdop),
            availability,
            solved_fraction: 1.0,
            ..no_metrics()
        };
        let (one, other) = (case(Some(4.0), 2.0, 0.9), case(Some(3.0), 2.5, 0.8));
        let worst_of = |cases: &[Metrics]| {
            let cases: Vec<OneLost> = cases.iter().map(OneLost::of).collect();
            OneLost::worst(&cases)
        };
        let worst = worst_of(&[one, other]);
        assert_eq!(
            (worst.max_pdop, worst.cvar_pdop),
            (Some(4.0), Some(Some(2.5)))
        );
        assert_eq!((worst.availability, worst.solved_fraction), (0.8, 1.0));
        assert_eq!(worst_of(&[one, case(None, 1.0, 0.0)]).max_pdop, None);
    }
}

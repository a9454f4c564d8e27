//! What LEO satellites add to the GNSS ([M-30](crate::models#m-30)).

use super::histograms::ViewBins;
use super::on_demand::{self, OnDemand};
use super::{Evaluator, Metrics, Series, SigmaSpread};
use crate::ephemeris::{Ephemeris, EphemerisError};
use serde::{Deserialize, Serialize};

/// The gain over the GNSS alone: each metric of the GNSS alone minus that with the LEO satellites, so that a gain in PDOP,
/// outages or metres is positive and one in a fraction negative. `None` where one of the two has no value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// In mean PDOP, each over its own solved samples.
    pub mean_pdop: Option<f64>,
    /// In the CVaR of PDOP.
    pub cvar_pdop: Option<f64>,
    /// In the median PDOP.
    pub p50_pdop: Option<f64>,
    /// In the 95 % quantile of PDOP.
    pub p95_pdop: Option<f64>,
    /// In the 99 % quantile of PDOP.
    pub p99_pdop: Option<f64>,
    /// In the maximum PDOP.
    pub max_pdop: Option<f64>,
    /// In the fraction of solved samples.
    pub solved_fraction: f64,
    /// In availability.
    pub availability: f64,
    /// In the longest outage of any point, seconds.
    pub longest_outage_s: f64,
    /// In the 95 % quantile of HDOP, where it is asked for.
    pub p95_hdop: Option<f64>,
    /// In the 95 % quantile of VDOP, where it is asked for.
    pub p95_vdop: Option<f64>,
    /// In the mean PDOP of a window.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub information_pdop: OnDemand<f64>,
    /// In the mean standard deviation of the position, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub sigma_3d_m: OnDemand<f64>,
    /// In the mean standard deviation of the horizontal position, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub sigma_h_m: OnDemand<f64>,
    /// In the mean standard deviation of the height, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub sigma_v_m: OnDemand<f64>,
    /// In the 95 % error of the position, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub error95_3d_m: OnDemand<f64>,
    /// In the 95 % error of the horizontal position, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub error95_h_m: OnDemand<f64>,
    /// In the 95 % error of the height, metres.
    #[serde(
        default,
        skip_serializing_if = "Option::is_none",
        deserialize_with = "on_demand::given"
    )]
    pub error95_v_m: OnDemand<f64>,
}

impl Gain {
    fn new(alone: &Metrics, with_leo: &Metrics) -> Self {
        let between = |of: fn(&Metrics) -> Option<f64>| Some(of(alone)? - of(with_leo)?);
        let sigma = |of: fn(&Metrics) -> OnDemand<SigmaSpread>| {
            let mean = |one: &Metrics| of(one).map(|spread| spread.map(|of| of.mean));
            on_demand_between(mean(alone), mean(with_leo))
        };
        let error = |of: fn(&Metrics) -> OnDemand<f64>| on_demand_between(of(alone), of(with_leo));
        let window = |one: &Metrics| one.information_pdop.map(|of| of.mean);
        Self {
            mean_pdop: between(|of| of.mean_pdop),
            cvar_pdop: between(|of| of.cvar_pdop),
            p50_pdop: between(|of| of.p50_pdop),
            p95_pdop: between(|of| of.p95_pdop),
            p99_pdop: between(|of| of.p99_pdop),
            max_pdop: between(|of| of.max_pdop),
            solved_fraction: alone.solved_fraction - with_leo.solved_fraction,
            availability: alone.availability - with_leo.availability,
            longest_outage_s: alone.longest_outage_s - with_leo.longest_outage_s,
            p95_hdop: between(|of| of.p95_hdop),
            p95_vdop: between(|of| of.p95_vdop),
            information_pdop: on_demand_between(window(alone), window(with_leo)),
            sigma_3d_m: sigma(|of| of.sigma_3d_m),
            sigma_h_m: sigma(|of| of.sigma_h_m),
            sigma_v_m: sigma(|of| of.sigma_v_m),
            error95_3d_m: error(|of| of.error95_3d_m),
            error95_h_m: error(|of| of.error95_h_m),
            error95_v_m: error(|of| of.error95_v_m),
        }
    }

    /// The gain in each metric, by its name; those that are computed on demand only if they are.
    #[must_use]
    pub fn named(&self) -> Vec<(&'static str, Option<f64>)> {
        let always = [
            ("mean_pdop", self.mean_pdop),
            ("cvar_pdop", self.cvar_pdop),
            ("p50_pdop", self.p50_pdop),
            ("p95_pdop", self.p95_pdop),
            ("p99_pdop", self.p99_pdop),
            ("max_pdop", self.max_pdop),
            ("solved_fraction", Some(self.solved_fraction)),
            ("availability", Some(self.availability)),
            ("longest_outage_s", Some(self.longest_outage_s)),
            ("p95_hdop", self.p95_hdop),
            ("p95_vdop", self.p95_vdop),
        ];
        let asked = [
            ("information_pdop", self.information_pdop),
            ("sigma_3d_m", self.sigma_3d_m),
            ("sigma_h_m", self.sigma_h_m),
            ("sigma_v_m", self.sigma_v_m),
            ("error95_3d_m", self.error95_3d_m),
            ("error95_h_m", self.error95_h_m),
            ("error95_v_m", self.error95_v_m),
        ];
        let asked = asked
            .into_iter()
            .filter_map(|(name, gain)| Some((name, gain?)));
        always.into_iter().chain(asked).collect()
    }
}

/// The difference of two values, where both are asked for.
fn on_demand_between(alone: OnDemand<f64>, with_leo: OnDemand<f64>) -> OnDemand<f64> {
    let (alone, with_leo) = (alone?, with_leo?);
    Some(
        alone
            .zip(with_leo)
            .map(|(alone, with_leo)| alone - with_leo),
    )
}

impl Metrics {
    /// The same with the gain over these metrics of the GNSS alone.
    #[must_use]
    pub fn with_gain_over(self, gnss_only: &Self) -> Self {
        Self {
            gain: Some(Gain::new(gnss_only, &self)),
            ..self
        }
    }
}

impl Evaluator {
    /// The metrics of the GNSS alone, computed once; `None` without GNSS.
    ///
    /// # Errors
    /// If a satellite cannot be propagated.
    pub fn gnss_only(&self) -> Result<Option<&Metrics>, EphemerisError> {
        Ok(self.gnss_alone()?.map(|(metrics, _)| metrics))
    }

    /// The same with the GNSS satellites in view.
    pub(super) fn gnss_alone(&self) -> Result<Option<&(Metrics, ViewBins)>, EphemerisError> {
        if self.setup().gnss.is_empty() {
            return Ok(None);
        }
        if let Some(known) = self.gnss_only.get() {
            return Ok(Some(known));
        }
        let (metrics, _, bins) = self.counted(&self.no_satellites(), true)?;
        let [_, views] = bins.unwrap_or_default();
        let metrics = metrics.with_gain_over(&metrics);
        Ok(Some(self.gnss_only.get_or_init(|| (metrics, views))))
    }

    /// The series of the GNSS alone; `None` without GNSS.
    pub(super) fn gnss_series(&self) -> Result<Option<&Series>, EphemerisError> {
        if self.setup().gnss.is_empty() {
            return Ok(None);
        }
        if let Some(known) = self.gnss_series.get() {
            return Ok(Some(known));
        }
        let series = self.cuts(&self.no_satellites())?.without_samples();
        Ok(Some(self.gnss_series.get_or_init(|| series)))
    }

    fn no_satellites(&self) -> Ephemeris {
        Ephemeris::new(self.setup().grid, Vec::new())
    }

    /// Metrics of this evaluator with their gain over the GNSS alone; without GNSS as they are.
    ///
    /// # Errors
    /// If a GNSS satellite cannot be propagated.
    pub fn with_gain(&self, metrics: Metrics) -> Result<Metrics, EphemerisError> {
        let alone = self.gnss_only()?;
        Ok(alone.map_or(metrics, |alone| metrics.with_gain_over(alone)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth::Surface;
    use crate::evaluate::testing::{no_metrics, setup};
    use crate::ground::Site;
    use crate::time::{Epoch, TimeGrid};

    /// GNSS alone minus both, null where the GNSS alone has nothing, and absent where nothing was asked for.
    #[test]
    fn a_gain_is_alone_minus_combined() {
        let alone = Metrics {
            mean_pdop: Some(1.75),
            max_pdop: None,
            availability: 0.5,
            longest_outage_s: 600.0,
            error95_h_m: Some(Some(3.0)),
            error95_v_m: Some(None),
            ..no_metrics()
        };
        let both = Metrics {
            mean_pdop: Some(1.25),
            max_pdop: Some(2.0),
            availability: 0.75,
            longest_outage_s: 60.0,
            error95_h_m: Some(Some(1.0)),
            error95_v_m: Some(Some(1.0)),
            ..no_metrics()
        };
        let gain = both.with_gain_over(&alone).gain.unwrap();
        assert_eq!((gain.mean_pdop, gain.max_pdop), (Some(0.5), None));
        assert_eq!((gain.availability, gain.longest_outage_s), (-0.25, 540.0));
        assert_eq!(gain.error95_h_m, Some(Some(2.0)));
        assert_eq!((gain.error95_v_m, gain.sigma_h_m), (Some(None), None));
        let json = serde_json::to_value(gain).unwrap();
        assert!(json["max_pdop"].is_null() && json["error95_v_m"].is_null());
        assert!(json.get("sigma_h_m").is_none() && json.get("error95_v_m").is_some());
        assert_eq!(serde_json::from_value::<Gain>(json).unwrap(), gain);
        let names: Vec<&str> = gain.named().into_iter().map(|(name, _)| name).collect();
        assert_eq!(names[11..], ["error95_h_m", "error95_v_m"]);
    }

    /// By point and by instant too: GNSS alone minus both, which is a gain where LEO satellites are in view.
    #[test]
    fn gains_of_a_series_are_alone_minus_combined() {
        let epoch = Epoch::from_utc("2025-01-01T00:00:00Z".parse().unwrap());
        let grid = TimeGrid::new(epoch, 3600.0, 600.0).unwrap();
        let site = |latitude_deg| Site::new(Surface::Sphere, latitude_deg, 110.0, 1.0).unwrap();
        let evaluator = Evaluator::new(setup(grid, vec![site(5.0), site(40.0)], 7.0)).unwrap();
        let design = "delta:55:182/13/1@925".parse().unwrap();
        let model = evaluator.setup().model;
        let both = Ephemeris::of_design(&design, model, grid).unwrap();
        let both = evaluator.series(&both).unwrap();
        let alone = evaluator.cuts(&evaluator.no_satellites()).unwrap();
        let difference = |alone: Option<f64>, both: Option<f64>| alone.unwrap() - both.unwrap();
        for (both, alone) in both.points.iter().zip(&alone.points) {
            let gain = both.gain_mean_pdop.unwrap();
            assert_eq!(gain, difference(alone.mean_pdop, both.mean_pdop));
            assert!(gain > 0.1, "{gain}");
        }
        for (both, alone) in both.epochs.iter().zip(&alone.epochs) {
            let gain = difference(alone.mean_pdop, both.mean_pdop);
            assert_eq!(both.gain_mean_pdop, Some(gain));
        }
    }
}

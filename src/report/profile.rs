//! The data of one constellation for the figures below the front: its cuts through space and time, and the
//! distribution of PDOP.

use crate::ephemeris::{Ephemeris, EphemerisError};
use crate::evaluate::{
    EpochMetrics, Evaluator, Outage, PointMetrics, PointOneLost, Series, ViewHistograms,
};
use crate::exchange::constellation::{Constellation, ConstellationError};
use crate::stats::{Weighted, summarize_weighted, weighted_quantile};
use rayon::prelude::*;

/// One constellation under the setup of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// Instant by instant, over the points.
    pub epochs: Vec<EpochMetrics>,
    /// Point by point, over the instants.
    pub points: Vec<PointMetrics>,
    /// Quantiles of PDOP over all solved samples; empty if there are none.
    pub pdop: Vec<Quantile>,
    /// The tail of PDOP; `None` if no sample is solved.
    pub tail: Option<Tail>,
    /// Satellites in view over all samples.
    pub histograms: ViewHistograms,
    /// The outages of the points that are out longest, those first.
    pub outages: Vec<PointOutages>,
    /// The worst at each point without any one of the satellites, where asked for; otherwise empty.
    pub one_lost: Vec<PointOneLost>,
}

/// The outages of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct PointOutages {
    /// Number of the point.
    pub point: usize,
    /// Its outages in the order of time.
    pub outages: Vec<Outage>,
}

/// Most points whose outages are kept.
const MOST_OUT: usize = 24;

/// The outages of the points that are out longest; of equal ones the first. The points of a grid at a pole are one place.
fn longest_out(series: &Series) -> Vec<PointOutages> {
    let out_s = |&n: &usize| series.points[n].total_outage_s;
    let mut points: Vec<usize> = (0..series.points.len()).collect();
    let mut poles = Vec::new();
    points.retain(|n| {
        let point = &series.points[*n];
        if point.latitude_deg.abs() == 90.0 && point.name.is_none() {
            if poles.contains(&point.latitude_deg) {
                return false;
            }
            poles.push(point.latitude_deg);
        }
        out_s(n) > 0.0
    });
    points.sort_by(|a, b| out_s(b).total_cmp(&out_s(a)));
    points.truncate(MOST_OUT);
    let outages = points.into_iter().map(|point| PointOutages {
        point,
        outages: series.outages(point).collect(),
    });
    outages.collect()
}

/// One step of an empirical distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantile {
    /// Fraction of the samples at or below the value.
    pub level: f64,
    /// The value.
    pub value: f64,
}

/// The tail of PDOP.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tail {
    /// α.
    pub level: f64,
    /// The quantile of level α.
    pub value_at_risk: f64,
    /// The mean of the worst 1 - α.
    pub cvar: f64,
}

impl Profile {
    /// Evaluates one constellation.
    ///
    /// # Errors
    /// If one of its satellites cannot be propagated.
    pub fn of_constellation(
        evaluator: &Evaluator,
        one: &Constellation,
    ) -> Result<Self, ConstellationError> {
        let setup = evaluator.setup();
        let ephemeris = one.in_service(setup)?;
        Ok(Self::new(evaluator, &ephemeris)?)
    }

    /// Evaluates some satellites, on the grid of the setup.
    ///
    /// # Errors
    /// If one of them cannot be propagated.
    pub fn new(evaluator: &Evaluator, ephemeris: &Ephemeris) -> Result<Self, EphemerisError> {
        let setup = evaluator.setup();
        let series = evaluator.series(ephemeris)?;
        let mut rising = series.rising_pdop();
        let pdop = quantiles(&rising);
        let level = setup.metrics.cvar_level;
        let value_at_risk = weighted_quantile(&mut rising, level);
        let summary = summarize_weighted(&mut rising, level);
        let tail = summary.zip(value_at_risk).map(|(summary, at_risk)| Tail {
            level: level.get(),
            value_at_risk: at_risk,
            cvar: summary.cvar,
        });
        Ok(Self {
            outages: longest_out(&series),
            epochs: series.epochs,
            points: series.points,
            histograms: series.histograms,
            pdop,
            tail,
            one_lost: Vec::new(),
        })
    }

    /// The same with the worst at each point without any one of the satellites.
    ///
    /// # Errors
    /// If one of them cannot be propagated.
    pub fn with_one_lost(
        self,
        evaluator: &Evaluator,
        ephemeris: &Ephemeris,
    ) -> Result<Self, EphemerisError> {
        let one_lost = evaluator.one_lost_by_point(ephemeris)?;
        Ok(Self { one_lost, ..self })
    }

    /// Seconds between the instants; 0 if there is one.
    #[must_use]
    pub fn step_s(&self) -> f64 {
        match self.epochs.as_slice() {
            [first, second, ..] => second.elapsed_s - first.elapsed_s,
            _ => 0.0,
        }
    }

    /// The distribution over the points, by their weights, of a value that not every point has.
    #[must_use]
    pub fn over_points(&self, value: impl Fn(&PointMetrics) -> Option<f64>) -> Vec<Quantile> {
        let weighted = |point: &PointMetrics| {
            let weight = point.weight;
            value(point).map(|value| Weighted { value, weight })
        };
        let mut rising: Vec<Weighted> = self.points.iter().filter_map(weighted).collect();
        rising.sort_unstable_by(|a, b| a.value.total_cmp(&b.value));
        quantiles(&rising)
    }

    /// Evaluates several constellations, in parallel and in their order; `None` for one that cannot be
    /// propagated.
    #[must_use]
    pub fn of_constellations(evaluator: &Evaluator, all: &[Constellation]) -> Vec<Option<Self>> {
        let one = |one: &Constellation| Self::of_constellation(evaluator, one).ok();
        all.par_iter().map(one).collect()
    }
}

/// The levels of a drawn distribution: every half percent, and ten per decade of the tail down to
/// 1e-5.
#[must_use]
pub fn drawn_levels() -> Vec<f64> {
    let even = (0..=190).map(|n| f64::from(n) / 200.0);
    let tail = (1..=37).map(|n| 1.0 - 0.05 * 10_f64.powf(-f64::from(n) / 10.0));
    even.chain(tail).chain([1.0]).collect()
}

/// The quantiles of a sorted sample at the drawn levels: the first value whose cumulative weight,
/// including its own, reaches the level.
#[must_use]
pub fn quantiles(rising: &[Weighted]) -> Vec<Quantile> {
    let total: f64 = rising.iter().map(|x| x.weight).sum();
    let mut samples = rising.iter();
    let Some(mut current) = samples.next() else {
        return Vec::new();
    };
    let mut below = current.weight;
    let mut quantile = |level: f64| {
        // A fraction within rounding of the level counts as reached.
        while below < level * total * (1.0 - 1e-12) {
            let Some(next) = samples.next() else { break };
            current = next;
            below += next.weight;
        }
        Quantile {
            level,
            value: current.value,
        }
    };
    drawn_levels().into_iter().map(&mut quantile).collect()
}

/// The quantiles of equally weighted values.
#[must_use]
pub fn quantiles_of(values: impl Iterator<Item = f64>) -> Vec<Quantile> {
    let mut rising: Vec<_> = values
        .map(|value| Weighted { value, weight: 1.0 })
        .collect();
    rising.sort_unstable_by(|a, b| a.value.total_cmp(&b.value));
    quantiles(&rising)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_order_statistics() {
        let found = quantiles_of((1..=1000).rev().map(f64::from));
        let at = |level: f64| {
            let near = found.iter().find(|q| (q.level - level).abs() < 1e-12);
            near.unwrap().value
        };
        assert_eq!(
            (at(0.0), at(0.5), at(0.95), at(1.0)),
            (1.0, 500.0, 950.0, 1000.0)
        );
        assert!(
            found
                .windows(2)
                .all(|q| q[0].level < q[1].level && q[0].value <= q[1].value)
        );
        assert!(quantiles_of(std::iter::empty()).is_empty());
    }

    #[test]
    fn weights_shift_quantiles() {
        let sample = [(1.0, 3.0), (2.0, 1.0)].map(|(value, weight)| Weighted { value, weight });
        let found = quantiles(&sample);
        let reached = found.iter().filter(|q| q.value == 1.0).map(|q| q.level);
        assert_eq!(reached.fold(0.0, f64::max), 0.75);
    }

    #[test]
    fn the_tail_is_that_of_the_metrics() {
        let study = include_str!("../../data/scenarios/paper.toml");
        let overrides = ["region.step-deg=25", "time.step-s=3600"];
        let scenario =
            crate::scenario::Scenario::parse("paper", study.as_bytes(), &overrides).unwrap();
        let setup = scenario
            .setup(&|_| Err(std::io::ErrorKind::NotFound.into()))
            .unwrap();
        let evaluator = Evaluator::new(setup).unwrap();
        let design: crate::constellation::Design = "delta:55:42/7/1@925".parse().unwrap();
        let one = Constellation::of_design(design.clone());
        let profile = Profile::of_constellation(&evaluator, &one).unwrap();
        let metrics = evaluator.evaluate(&design).unwrap();
        let close = |a: f64, b: f64, within: f64| assert!((a / b - 1.0).abs() < within, "{a} {b}");
        // Means of values in f32.
        let tail = profile.tail.unwrap().cvar;
        close(tail, metrics.cvar_pdop.unwrap(), 1e-7);
        // One value of the lanes, which the metrics compute again in f64 (M-29).
        let largest = profile.pdop.last().unwrap().value;
        close(largest, metrics.max_pdop.unwrap(), 1e-6);
        // Sums in another order.
        let visible: f64 = profile.points.iter().map(|p| p.mean_visible).sum();
        let mean = visible / profile.points.len() as f64;
        close(mean, metrics.mean_visible, 1e-12);
    }
}

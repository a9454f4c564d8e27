//! What a statement of a study is about.

use crate::keyword::{Keyword, UnknownKeyword, keywords, nearest};
use crate::search::Quantity;
use crate::stats::{Level, Summary, Weighted, weighted_mean, weighted_quantile};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

keywords! {
    /// A dilution of precision.
    DilutionKind {
        /// Position and clocks.
        Gdop = "gdop",
        /// Position.
        Pdop = "pdop",
        /// Horizontal position.
        Hdop = "hdop",
        /// Height.
        Vdop = "vdop",
        /// The clock; of several the first that has a value.
        Tdop = "tdop",
    }
}

keywords! {
    /// A quantity of the orbits of a shell, by secular J2.
    OrbitQuantity {
        /// Rate of the node, degrees a day, positive to the east.
        NodalRate = "nodal-rate-deg-per-day",
        /// From one ascending node to the next, minutes.
        NodalPeriod = "nodal-period-min",
        /// Kepler's period, minutes.
        KeplerPeriod = "kepler-period-min",
        /// Revolutions, from node to node, in a turn of the Earth under the plane.
        RevolutionsPerNodalDay = "revolutions-per-nodal-day",
        /// Inclination at which an orbit of this size and shape is sun-synchronous, degrees.
        SunSynchronousInclination = "sun-synchronous-inclination-deg",
        /// Right ascension of the node of a satellite at the epoch, degrees from 0 to 360.
        Raan = "raan-deg",
        /// Mean argument of latitude of a satellite at the epoch, degrees from 0 to 360.
        ArgLatitude = "arg-latitude-deg",
        /// Largest distance of any place from the nearest sub-satellite point, over all time, degrees.
        CoverageRadius = "coverage-radius-deg",
    }
}

keywords! {
    /// A quantity other than a dilution of precision that each sample has.
    SpreadQuantity {
        /// Standard deviation of the position, metres.
        Sigma3dM = "sigma-3d-m",
        /// Standard deviation of the horizontal position, metres.
        SigmaHM = "sigma-h-m",
        /// Standard deviation of the height, metres.
        SigmaVM = "sigma-v-m",
        /// PDOP of all observations in a window.
        InformationPdop = "information-pdop",
        /// LEO satellites in view.
        Visible = "visible",
        /// GNSS satellites in view.
        GnssVisible = "gnss-visible",
        /// Satellites in view, LEO and GNSS.
        TotalVisible = "total-visible",
    }
}

keywords! {
    /// A quantity of the first of some GNSS satellites, at the epoch.
    PlaneQuantity {
        /// Inclination of the plane of its state, degrees.
        Inclination = "plane-inclination-deg",
        /// Height over the equatorial radius, km.
        Height = "height-km",
    }
}

keywords! {
    /// What is computed of two sets of designs.
    SetComparison {
        /// Percentage of the designs that one of the others dominates in the objectives of the scenario.
        Dominated = "dominated-percent",
        /// Percentage of the designs that none of the others dominates.
        Undominated = "undominated-percent",
        /// Highest worst-case fuzzy membership minus that of the others, over both sets together.
        MembershipLead = "membership-lead",
        /// Percentage of the quantiles, over the instants, at which its mean visible is above that of all others.
        MostVisible = "most-visible-percent",
        /// Percentage of the instants at which its maximum PDOP is below that of all others.
        LowestMaxPdop = "lowest-max-pdop-percent",
    }
}

/// A statistic over all samples, weighted by point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum SampleStatistic {
    /// `mean`
    Mean,
    /// `max`
    Max,
    /// `pNN`: the quantile of level NN %.
    Quantile(Level),
}

/// What is computed for a statement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StudyMetric {
    /// A statistic of a dilution of precision: `p95-hdop`, `max-vdop`.
    Dilution(SampleStatistic, DilutionKind),
    /// A quantity of a search: `mean-visible`, `coverage-4`.
    Quantity(Quantity),
    /// A statistic of another quantity of the samples: `p99-sigma-3d-m`, `p5-visible`.
    Spread(SampleStatistic, SpreadQuantity),
    /// A quantity of the orbits of the only shell.
    Orbit(OrbitQuantity),
    /// A dilution of precision of a sky: `pdop`.
    Sky(DilutionKind),
    /// A quantity of some GNSS satellites.
    Plane(PlaneQuantity),
    /// Of two sets of designs.
    Sets(SetComparison),
    /// What a fit implies.
    Implied,
}

/// The metric of statements about a fit.
const IMPLIED: &str = "implied";

/// Why a text is not a metric.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "unknown metric {found:?}{}; expected mean-, max- or pNN- (a quantile, as p95 or p99.9) before {}, {}; or one of {}, {}, {}, implied; \
     or a quantity of searches, as mean-visible or coverage-4; or, of a sky, one of gdop, pdop, hdop, vdop, tdop",
    .nearest.as_ref().map_or_else(String::new, |name| format!(", did you mean {name:?}?")),
    DilutionKind::choices().join(", "),
    SpreadQuantity::choices().join(", "),
    OrbitQuantity::choices().join(", "),
    PlaneQuantity::choices().join(", "),
    SetComparison::choices().join(", ")
)]
pub struct UnknownMetric {
    found: String,
    nearest: Option<String>,
}

impl UnknownMetric {
    fn new(found: &str) -> Self {
        let mut known = Quantity::choices();
        let is_offered = |name: &&str| Quantity::from_keyword(name).is_ok_and(is_computed);
        known.retain(is_offered);
        known.extend(OrbitQuantity::choices());
        known.extend(PlaneQuantity::choices());
        known.extend(SetComparison::choices());
        known.push(IMPLIED);
        let mut sampled = DilutionKind::choices();
        known.extend(&sampled);
        sampled.extend(SpreadQuantity::choices());
        // The statistic as it was written, if it is one.
        let own = found.split_once('-').map(|(statistic, _)| statistic);
        let own = own.filter(|statistic| statistic.parse::<SampleStatistic>().is_ok());
        let statistics = ["mean", "max", "p95"].into_iter().chain(own);
        let spelled: Vec<String> = statistics
            .flat_map(|statistic| {
                sampled
                    .iter()
                    .map(move |name| format!("{statistic}-{name}"))
            })
            .collect();
        known.extend(spelled.iter().map(String::as_str));
        Self {
            found: found.to_owned(),
            nearest: nearest(found, &known).map(str::to_owned),
        }
    }
}

/// Whether a study computes it; failures and gains belong to searches.
fn is_computed(quantity: Quantity) -> bool {
    let is_of_failures = quantity.is_of_one_lost() || quantity == Quantity::ExpectedAvailability;
    quantity.gain_in().is_none() && !is_of_failures
}

impl FromStr for StudyMetric {
    type Err = UnknownMetric;

    fn from_str(text: &str) -> Result<Self, UnknownMetric> {
        if let Ok(dilution) = DilutionKind::from_keyword(text) {
            return Ok(Self::Sky(dilution));
        }
        if let Ok(orbit) = OrbitQuantity::from_keyword(text) {
            return Ok(Self::Orbit(orbit));
        }
        if let Ok(plane) = PlaneQuantity::from_keyword(text) {
            return Ok(Self::Plane(plane));
        }
        if let Ok(sets) = SetComparison::from_keyword(text) {
            return Ok(Self::Sets(sets));
        }
        if text == IMPLIED {
            return Ok(Self::Implied);
        }
        if let Some((statistic, dilution)) = text.split_once('-')
            && let (Ok(statistic), Ok(dilution)) =
                (statistic.parse(), DilutionKind::from_keyword(dilution))
        {
            return Ok(Self::Dilution(statistic, dilution));
        }
        let quantity: Result<Quantity, UnknownKeyword> = Quantity::from_keyword(text);
        if let Ok(quantity) = quantity
            && is_computed(quantity)
        {
            return Ok(Self::Quantity(quantity));
        }
        if let Some((statistic, spread)) = text.split_once('-')
            && let (Ok(statistic), Ok(spread)) =
                (statistic.parse(), SpreadQuantity::from_keyword(spread))
        {
            return Ok(Self::Spread(statistic, spread));
        }
        Err(UnknownMetric::new(text))
    }
}

impl FromStr for SampleStatistic {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        match text {
            "mean" => return Ok(Self::Mean),
            "max" => return Ok(Self::Max),
            _ => {}
        }
        let percent: f64 = text.strip_prefix('p').ok_or(())?.parse().map_err(|_| ())?;
        let level = Level::new(percent / 100.0).map_err(|_| ())?;
        Ok(Self::Quantile(level))
    }
}

/// The unit of shares and changes.
pub(super) const PERCENT: &str = "%";

impl StudyMetric {
    /// The unit, in words; empty for a number without one.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Dilution(..) | Self::Sky(_) | Self::Implied => "",
            Self::Plane(PlaneQuantity::Inclination) => "deg",
            Self::Plane(PlaneQuantity::Height) => "km",
            Self::Sets(SetComparison::MembershipLead) => "",
            Self::Sets(_) => PERCENT,
            Self::Spread(_, spread) => match spread {
                SpreadQuantity::Sigma3dM | SpreadQuantity::SigmaHM | SpreadQuantity::SigmaVM => "m",
                SpreadQuantity::InformationPdop => "",
                SpreadQuantity::Visible
                | SpreadQuantity::GnssVisible
                | SpreadQuantity::TotalVisible => "satellites",
            },
            Self::Orbit(orbit) => match orbit {
                OrbitQuantity::NodalRate => "deg/day",
                OrbitQuantity::NodalPeriod | OrbitQuantity::KeplerPeriod => "min",
                OrbitQuantity::RevolutionsPerNodalDay => "",
                OrbitQuantity::CoverageRadius
                | OrbitQuantity::SunSynchronousInclination
                | OrbitQuantity::Raan
                | OrbitQuantity::ArgLatitude => "deg",
            },
            Self::Quantity(quantity) if quantity.is_in_metres() => "m",
            Self::Quantity(quantity) => match quantity {
                Quantity::Satellites
                | Quantity::MeanVisible
                | Quantity::LeastVisible
                | Quantity::MeanTotalVisible => "satellites",
                Quantity::LongestOutageS => "s",
                Quantity::Planes => "planes",
                _ => "",
            },
        }
    }
}

impl StudyMetric {
    /// The key that its scenario needs for it, if any.
    pub(super) fn needed_key(self) -> Option<&'static str> {
        const METRES: &str = "[accuracy]";
        const WINDOW: &str = "metrics.window-min";
        match self {
            Self::Quantity(quantity) if quantity.is_in_metres() => Some(METRES),
            Self::Quantity(quantity) if quantity.is_of_windows() => Some(WINDOW),
            Self::Spread(_, spread) => match spread {
                SpreadQuantity::Sigma3dM | SpreadQuantity::SigmaHM | SpreadQuantity::SigmaVM => {
                    Some(METRES)
                }
                SpreadQuantity::InformationPdop => Some(WINDOW),
                SpreadQuantity::Visible
                | SpreadQuantity::GnssVisible
                | SpreadQuantity::TotalVisible => None,
            },
            _ => None,
        }
    }
}

impl SampleStatistic {
    /// The statistic, if it is in a summary.
    pub(super) fn of_summary(self, summary: &Summary) -> Option<f64> {
        match self {
            Self::Mean => Some(summary.mean),
            Self::Max => Some(summary.max),
            Self::Quantile(level) => {
                let known = [
                    (0.50, summary.p50),
                    (0.95, summary.p95),
                    (0.99, summary.p99),
                ];
                let known = known.iter().find(|(of, _)| *of == level.get());
                known.map(|(_, value)| *value)
            }
        }
    }

    /// The statistic of some samples; `None` if there are none. Reorders them.
    pub(super) fn of_samples(self, samples: &mut [Weighted]) -> Option<f64> {
        match self {
            Self::Mean => weighted_mean(samples),
            Self::Max => samples.iter().map(|one| one.value).max_by(f64::total_cmp),
            Self::Quantile(level) => weighted_quantile(samples, level),
        }
    }
}

impl fmt::Display for StudyMetric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dilution(statistic, dilution) => write!(f, "{statistic}-{dilution}"),
            Self::Spread(statistic, spread) => write!(f, "{statistic}-{spread}"),
            Self::Quantity(quantity) => quantity.fmt(f),
            Self::Orbit(orbit) => orbit.fmt(f),
            Self::Sky(dilution) => dilution.fmt(f),
            Self::Plane(plane) => plane.fmt(f),
            Self::Sets(sets) => sets.fmt(f),
            Self::Implied => f.write_str(IMPLIED),
        }
    }
}

impl fmt::Display for SampleStatistic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mean => f.write_str("mean"),
            Self::Max => f.write_str("max"),
            Self::Quantile(level) => {
                let percent = crate::units::round_decimal(100.0 * level.get(), 9);
                write!(f, "p{percent}")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn metrics_are_read_as_they_are_written() {
        for text in [
            "p95-hdop",
            "p50-gdop",
            "p99.9-vdop",
            "max-pdop",
            "mean-tdop",
            "mean-visible",
            "coverage-total-4",
            "mean-gnss-visible",
            "p5-gnss-visible",
            "p99-sigma-3d-m",
            "max-information-pdop",
            "error95-h-m",
            "tdop",
            "height-km",
            "dominated-percent",
            "implied",
            "nodal-rate-deg-per-day",
        ] {
            let metric: StudyMetric = text.parse().unwrap();
            assert_eq!(metric.to_string(), text);
        }
    }

    #[test]
    fn unknown_metrics_are_told_with_the_nearest() {
        for (text, nearest) in [
            ("p95-hdopp", Some("p95-hdop")),
            ("mean-visable", Some("mean-visible")),
            ("p101-hdop", None),
            ("p-hdop", None),
            ("p99.5-sigma-3m", Some("p99.5-sigma-3d-m")),
            ("hdopp", Some("hdop")),
            ("lowest-max-pdop-percnt", Some("lowest-max-pdop-percent")),
            ("gain-mean-pdop", None),
            ("n1-max-pdop", None),
            ("", None),
        ] {
            let error = text.parse::<StudyMetric>().unwrap_err();
            assert!(error.to_string().contains("expected mean-, max- or pNN-"));
            if let Some(nearest) = nearest {
                let told = format!("did you mean \"{nearest}\"?");
                assert!(error.to_string().contains(&told), "{error}");
            }
        }
    }
}

//! What a statement of a study is about.

use crate::keyword::{Keyword, UnknownKeyword, keywords, nearest};
use crate::search::Quantity;
use crate::stats::{Level, Summary};
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
        /// Largest distance of any place from the nearest sub-satellite point, over all time, degrees.
        CoverageRadius = "coverage-radius-deg",
    }
}

/// A statistic over all samples, weighted by point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DilutionStatistic {
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
    Dilution(DilutionStatistic, DilutionKind),
    /// A quantity of a search: `mean-visible`, `coverage-4`.
    Quantity(Quantity),
    /// Mean visible GNSS satellites.
    MeanGnssVisible,
    /// A quantity of the orbits of the only shell.
    Orbit(OrbitQuantity),
}

/// The spelling of [`StudyMetric::MeanGnssVisible`].
const MEAN_GNSS_VISIBLE: &str = "mean-gnss-visible";

/// Why a text is not a metric.
#[derive(Debug, Clone, PartialEq, Error)]
#[error(
    "unknown metric {found:?}{}; expected mean-, max- or pNN- (a quantile, as p95 or p99.9) before {}; or one of {}, \
     {MEAN_GNSS_VISIBLE}; or a quantity of searches, as mean-visible or coverage-4",
    .nearest.as_ref().map_or_else(String::new, |name| format!(", did you mean {name:?}?")),
    DilutionKind::choices().join(", "),
    OrbitQuantity::choices().join(", ")
)]
pub struct UnknownMetric {
    found: String,
    nearest: Option<String>,
}

impl UnknownMetric {
    fn new(found: &str) -> Self {
        let mut known = Quantity::choices();
        let is_offered = |name: &&str| Quantity::from_keyword(name).is_ok_and(is_always_computed);
        known.retain(is_offered);
        known.extend(OrbitQuantity::choices());
        known.push(MEAN_GNSS_VISIBLE);
        let dilutions: Vec<String> = DilutionKind::choices()
            .iter()
            .flat_map(|name| ["mean", "max", "p95"].map(|statistic| format!("{statistic}-{name}")))
            .collect();
        known.extend(dilutions.iter().map(String::as_str));
        Self {
            found: found.to_owned(),
            nearest: nearest(found, &known).map(str::to_owned),
        }
    }
}

fn is_always_computed(quantity: Quantity) -> bool {
    let is_of_failures = quantity.is_of_one_lost() || quantity == Quantity::ExpectedAvailability;
    !quantity.is_on_demand() && !is_of_failures
}

impl FromStr for StudyMetric {
    type Err = UnknownMetric;

    fn from_str(text: &str) -> Result<Self, UnknownMetric> {
        if text == MEAN_GNSS_VISIBLE {
            return Ok(Self::MeanGnssVisible);
        }
        if let Ok(orbit) = OrbitQuantity::from_keyword(text) {
            return Ok(Self::Orbit(orbit));
        }
        if let Some((statistic, dilution)) = text.split_once('-')
            && let (Ok(statistic), Ok(dilution)) =
                (statistic.parse(), DilutionKind::from_keyword(dilution))
        {
            return Ok(Self::Dilution(statistic, dilution));
        }
        let quantity: Result<Quantity, UnknownKeyword> = Quantity::from_keyword(text);
        match quantity {
            // What is computed only where a scenario asks for it is not computed here.
            Ok(quantity) if is_always_computed(quantity) => Ok(Self::Quantity(quantity)),
            _ => Err(UnknownMetric::new(text)),
        }
    }
}

impl FromStr for DilutionStatistic {
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

impl StudyMetric {
    /// The unit, in words; empty for a number without one.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Dilution(..) => "",
            Self::MeanGnssVisible => "satellites",
            Self::Orbit(OrbitQuantity::NodalRate) => "deg/day",
            Self::Orbit(OrbitQuantity::CoverageRadius) => "deg",
            Self::Orbit(OrbitQuantity::NodalPeriod | OrbitQuantity::KeplerPeriod) => "min",
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

impl DilutionStatistic {
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
}

impl fmt::Display for StudyMetric {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Dilution(statistic, dilution) => match statistic {
                DilutionStatistic::Mean => write!(f, "mean-{dilution}"),
                DilutionStatistic::Max => write!(f, "max-{dilution}"),
                DilutionStatistic::Quantile(level) => {
                    let percent = crate::units::round_decimal(100.0 * level.get(), 9);
                    write!(f, "p{percent}-{dilution}")
                }
            },
            Self::Quantity(quantity) => quantity.fmt(f),
            Self::MeanGnssVisible => f.write_str(MEAN_GNSS_VISIBLE),
            Self::Orbit(orbit) => orbit.fmt(f),
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
            ("sigma-h-m", None),
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

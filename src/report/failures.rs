//! What failures of one, two or three satellites do to a constellation.

use super::phases::named;
use super::shown;
use super::{Align, Table};
use crate::evaluate::Metrics;
use crate::keyword::Keyword;
use crate::run::columns::{cells, metric_columns};
use crate::search::Quantity;
use crate::search::failures::Harm;
use crate::units::counted;
use serde::Serialize;
use serde_json::Value;
use std::cmp::Ordering;
use std::collections::BTreeMap;
use std::io;

/// A set of satellites that fail together, and the metrics without them.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureCase {
    /// The names of the satellites.
    pub without: Vec<String>,
    /// The metrics of the others.
    pub metrics: Metrics,
}

/// A satellite or a plane that is lost.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LostPart {
    /// Its name.
    pub name: String,
    /// Its satellites.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub satellites: Option<usize>,
    /// The metrics without it.
    pub metrics: Metrics,
}

/// The worst value of a metric.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WorstCase {
    /// Without these satellites.
    pub without: Vec<String>,
    /// The value; `None` where unsolved samples make it infinite.
    pub value: Option<f64>,
}

/// How a metric varies over the cases.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct CaseSpread {
    /// Minimum.
    pub min: f64,
    /// 5 % quantile.
    pub p05: f64,
    /// Median.
    pub p50: f64,
    /// 95 % quantile.
    pub p95: f64,
    /// Maximum.
    pub max: f64,
    /// Standard error of the mean as an estimate of that over all sets: 0 if these are all.
    pub standard_error: f64,
}

/// The metrics over failures of `k` satellites.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureSummary {
    /// Number of satellites that fail together.
    pub k: usize,
    /// Number of draws; `None` if all sets were evaluated.
    pub draws: Option<usize>,
    /// Number of sets whose mean and spread are given: all, or those that were drawn.
    pub cases: usize,
    /// Seed of the draws.
    pub seed: Option<u64>,
    /// Whether the worst sets are the worst of all, or those that were found.
    pub worst_is: WorstIs,
    /// The mean of each metric over the cases, `null` where one is infinite or missing.
    pub mean: Value,
    /// The spread of each metric over the cases, likewise.
    pub spread: BTreeMap<String, Option<CaseSpread>>,
    /// The worst value of each metric, and without which satellites.
    pub worst: BTreeMap<String, WorstCase>,
    /// The metrics without each satellite, for one failure.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_satellite: Option<Vec<LostPart>>,
    /// The metrics without each plane, for one failure: a launch that is lost.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub by_plane: Option<Vec<LostPart>>,
    /// The metrics with all satellites, for the text.
    #[serde(skip)]
    pub whole: Box<Metrics>,
    /// Kind and name of what is lost in each case, for CSV: the cases, then the planes.
    #[serde(skip)]
    pub rows: Vec<(&'static str, String, FailureCase)>,
}

/// What is known of the worst sets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum WorstIs {
    /// All sets were evaluated.
    Exact,
    /// The worst of the draws and of a greedy search with exchanges.
    FoundNotProved,
}

/// The cases of which a summary is made.
#[derive(Debug, Clone, PartialEq)]
pub struct FailureCases {
    /// Number of satellites that fail together.
    pub k: usize,
    /// All sets, or the draws.
    pub cases: Vec<FailureCase>,
    /// Further sets of the search for the worst.
    pub searched: Vec<FailureCase>,
    /// Number of draws and their seed; `None` if the cases are all sets.
    pub drawn: Option<(usize, u64)>,
    /// The planes that are lost, each with its name.
    pub planes: Vec<(String, FailureCase)>,
}

/// The quantity of a metric, whose direction it has. Those of no quantity are of no interest here.
fn quantity(name: &str) -> Option<Quantity> {
    let keyword = match name {
        // It counts as the statistic that bears as many unsolved samples.
        "solved_fraction" => "availability".to_owned(),
        name => name.trim_end_matches("_mean").replace('_', "-"),
    };
    Quantity::from_keyword(&keyword).ok()
}

/// The harm in each metric that has one.
fn harms(metrics: &Metrics) -> Vec<(String, Option<f64>, Harm)> {
    let of = |(name, value): (String, Option<f64>)| {
        let quantity = quantity(&name)?;
        let solved = quantity.solved_fraction(metrics);
        let harm = Harm::of(quantity, value, solved);
        Some((name, value, harm))
    };
    named(metrics).into_iter().filter_map(of).collect()
}

impl FailureSummary {
    /// The summary of some cases beside the metrics of the whole constellation.
    #[must_use]
    pub fn new(cases: &FailureCases, whole: &Metrics) -> Self {
        let lost = |name: &str, satellites, case: &FailureCase| LostPart {
            name: name.to_owned(),
            satellites,
            metrics: case.metrics,
        };
        let is_single = cases.k == 1;
        let by_satellite = cases
            .cases
            .iter()
            .map(|case| lost(&case.without[0], None, case));
        let by_plane = cases.planes.iter();
        let by_plane = by_plane.map(|(name, case)| lost(name, Some(case.without.len()), case));
        let all = cases.cases.iter().chain(&cases.searched);
        let kind = if is_single { "satellite" } else { "set" };
        let rows = cases.cases.iter();
        let rows = rows.map(|case| (kind, case.without.join("+"), case.clone()));
        let planes = cases.planes.iter();
        let planes = planes.map(|(name, case)| ("plane", name.clone(), case.clone()));
        Self {
            rows: rows.chain(planes).collect(),
            k: cases.k,
            draws: cases.drawn.map(|(draws, _)| draws),
            cases: cases.cases.len(),
            seed: cases.drawn.map(|(_, seed)| seed),
            worst_is: match cases.drawn {
                None => WorstIs::Exact,
                Some(_) => WorstIs::FoundNotProved,
            },
            mean: mean(&cases.cases),
            spread: spreads(&cases.cases, cases.drawn.is_some()),
            worst: worst(all),
            by_satellite: is_single.then(|| by_satellite.collect()),
            by_plane: (is_single && !cases.planes.is_empty()).then(|| by_plane.collect()),
            whole: Box::new(*whole),
        }
    }

    /// A table for reading.
    #[must_use]
    pub fn to_text(&self) -> String {
        let failures = counted(self.k, "satellite");
        let how = match self.draws {
            None => format!("all {} sets", self.cases),
            Some(draws) => format!(
                "{draws} draws, seed {}; the worst sets are found, not proved",
                self.seed.unwrap_or_default()
            ),
        };
        let right = Align::Right;
        let mut table = Table::new(&[
            ("metric", Align::Left),
            ("all up", right),
            ("mean", right),
            ("95 % of cases", right),
            ("worst", right),
            ("without", Align::Left),
        ]);
        let whole: BTreeMap<String, Option<f64>> = named(&self.whole).into_iter().collect();
        for (name, title) in SHOWN {
            let Some(worst) = self.worst.get(name) else {
                continue;
            };
            let spread = self.spread.get(name).copied().flatten();
            let is_maximised = quantity(name).is_some_and(Quantity::is_maximised);
            let bad = spread.map(|of| if is_maximised { of.p05 } else { of.p95 });
            let all_up = whole.get(name).copied().flatten();
            let shown = |value| match name {
                "availability" | "solved_fraction" => shown::share(value),
                "longest_outage_s" => shown::quantity(Quantity::LongestOutageS, value),
                _ => shown::pdop(value),
            };
            table.row([
                title.to_owned(),
                shown(all_up),
                shown(self.mean_of(name)),
                shown(bad),
                shown(worst.value),
                if worst.value == all_up {
                    String::new()
                } else {
                    worst.without.join(", ")
                },
            ]);
        }
        let planes = self
            .by_plane
            .as_ref()
            .map_or_else(String::new, |planes| planes_text(planes));
        format!(
            "\nfailures of {failures} ({how})\n{}{planes}",
            table.to_text()
        )
    }

    /// The mean of a metric over the cases.
    fn mean_of(&self, name: &str) -> Option<f64> {
        crate::run::columns::field(&self.mean, name).as_f64()
    }

    /// The cases as rows of CSV: the constellation, what fails (a satellite, a plane or a set of satellites), and the metrics
    /// without it.
    ///
    /// # Errors
    /// Never for a table in memory.
    pub fn to_csv(&self, constellation: &str, with_header: bool) -> io::Result<String> {
        let columns = metric_columns();
        let mut records = Vec::new();
        if with_header {
            let own = ["name", "lost", "without", "satellites_lost"];
            let names = own.iter().chain(&columns);
            records.push(names.map(|name| (*name).to_owned()).collect());
        }
        for (lost, name, case) in &self.rows {
            let count = case.without.len().to_string();
            let mut record = vec![
                constellation.to_owned(),
                (*lost).to_owned(),
                name.clone(),
                count,
            ];
            record.extend(cells(&case.metrics, &columns)?);
            records.push(record);
        }
        let mut out = Vec::new();
        crate::formats::csv::write_records(&mut out, &records)?;
        String::from_utf8(out).map_err(io::Error::other)
    }
}

/// The metrics of the text, and what they are called there.
const SHOWN: [(&str, &str); 9] = [
    ("mean_visible", "mean visible"),
    ("mean_pdop", "mean PDOP"),
    ("cvar_pdop", "CVaR of PDOP"),
    ("p95_pdop", "95 % quantile of PDOP"),
    ("p99_pdop", "99 % quantile of PDOP"),
    ("max_pdop", "maximum PDOP"),
    ("solved_fraction", "solved fraction"),
    ("availability", "availability"),
    ("longest_outage_s", "longest outage (s)"),
];

/// A mean, a tail or a maximum has no value where samples are unsolved, which count as infinite.
fn planes_text(planes: &[LostPart]) -> String {
    let right = Align::Right;
    let mut table = Table::new(&[
        ("plane lost", Align::Left),
        ("satellites", right),
        ("mean PDOP", right),
        ("CVaR of PDOP", right),
        ("maximum PDOP", right),
        ("solved fraction", right),
        ("availability", right),
    ]);
    for plane in planes {
        let metrics = &plane.metrics;
        let of_all = |pdop: Option<f64>| pdop.filter(|_| metrics.solved_fraction >= 1.0);
        table.row([
            plane.name.clone(),
            plane.satellites.unwrap_or_default().to_string(),
            shown::pdop(of_all(metrics.mean_pdop)),
            shown::pdop(of_all(metrics.cvar_pdop)),
            shown::pdop(of_all(metrics.max_pdop)),
            shown::share(Some(metrics.solved_fraction)),
            shown::share(Some(metrics.availability)),
        ]);
    }
    format!("\n{}", table.to_text())
}

/// The worst case in each metric.
fn worst<'a>(cases: impl Iterator<Item = &'a FailureCase>) -> BTreeMap<String, WorstCase> {
    let mut found: BTreeMap<String, (Harm, WorstCase)> = BTreeMap::new();
    for case in cases {
        for (name, value, harm) in harms(&case.metrics) {
            let is_worse =
                |(known, _): &(Harm, WorstCase)| harm.total_cmp(known) == Ordering::Greater;
            if found.get(&name).is_none_or(is_worse) {
                let worst = WorstCase {
                    without: case.without.clone(),
                    value: value.filter(|_| !harm.is_infinite()),
                };
                found.insert(name, (harm, worst));
            }
        }
    }
    let worst = found.into_iter().map(|(name, (_, worst))| (name, worst));
    worst.collect()
}

/// The values of each metric over the cases; `None` for one that is infinite or missing in some case.
fn values(cases: &[FailureCase]) -> BTreeMap<String, Option<Vec<f64>>> {
    let mut all: BTreeMap<String, Option<Vec<f64>>> = BTreeMap::new();
    for case in cases {
        let harms: BTreeMap<String, Harm> = harms(&case.metrics)
            .into_iter()
            .map(|(name, _, harm)| (name, harm))
            .collect();
        for (name, value) in named(&case.metrics) {
            let is_infinite = harms.get(&name).is_some_and(Harm::is_infinite);
            let value = value.filter(|_| !is_infinite);
            let known = all.entry(name).or_insert_with(|| Some(Vec::new()));
            match (known.as_mut(), value) {
                (Some(values), Some(value)) => values.push(value),
                _ => *known = None,
            }
        }
    }
    all
}

/// The mean metrics, shaped as metrics are.
fn mean(cases: &[FailureCase]) -> Value {
    let means: BTreeMap<String, Option<f64>> = values(cases)
        .into_iter()
        .map(|(name, values)| {
            let mean = values.map(|values| values.iter().sum::<f64>() / values.len() as f64);
            (name, mean)
        })
        .collect();
    let shape = cases.first().map(|case| serde_json::to_value(case.metrics));
    let mut shape = shape.and_then(Result::ok).unwrap_or_default();
    fill(&mut shape, "", &means);
    shape
}

/// Puts means in place of the numbers of an object; others keep their value.
fn fill(shape: &mut Value, name: &str, means: &BTreeMap<String, Option<f64>>) {
    match shape {
        Value::Object(fields) => {
            for (field, value) in fields {
                let name = match name {
                    "" => field.clone(),
                    of => format!("{of}_{field}"),
                };
                fill(value, &name, means);
            }
        }
        value => {
            if let Some(mean) = means.get(name) {
                *value = Value::from(*mean);
            }
        }
    }
}

fn spreads(cases: &[FailureCase], is_drawn: bool) -> BTreeMap<String, Option<CaseSpread>> {
    let of = |(name, values): (String, Option<Vec<f64>>)| {
        (
            name,
            values.and_then(|values| CaseSpread::of(values, is_drawn)),
        )
    };
    values(cases).into_iter().map(of).collect()
}

impl CaseSpread {
    fn of(mut values: Vec<f64>, is_drawn: bool) -> Option<Self> {
        values.sort_unstable_by(f64::total_cmp);
        let count = values.len();
        let at = |q: f64| values[crate::stats::quantile_rank(q, count) - 1];
        let (min, max) = (*values.first()?, *values.last()?);
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let variance = squares / (count.max(2) - 1) as f64;
        Some(Self {
            min,
            p05: at(0.05),
            p50: at(0.50),
            p95: at(0.95),
            max,
            standard_error: if is_drawn {
                (variance / count as f64).sqrt()
            } else {
                0.0
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evaluate::testing::no_metrics;

    fn case(name: &str, max_pdop: f64, solved_fraction: f64) -> FailureCase {
        FailureCase {
            without: vec![name.to_owned()],
            metrics: Metrics {
                max_pdop: Some(max_pdop),
                mean_visible: max_pdop,
                solved_fraction,
                ..no_metrics()
            },
        }
    }

    fn summary(cases: Vec<FailureCase>) -> FailureSummary {
        let cases = FailureCases {
            k: 1,
            cases,
            searched: Vec::new(),
            drawn: None,
            planes: Vec::new(),
        };
        FailureSummary::new(&cases, &no_metrics())
    }

    #[test]
    fn the_worst_and_the_mean_follow_the_direction_of_a_metric() {
        let of = summary(vec![
            case("A", 2.0, 1.0),
            case("B", 5.0, 1.0),
            case("C", 2.6, 1.0),
        ]);
        assert_eq!(of.worst["max_pdop"].without, ["B"]);
        assert_eq!(of.worst["max_pdop"].value, Some(5.0));
        assert_eq!(of.worst["mean_visible"].without, ["A"]);
        assert!((of.mean["max_pdop"].as_f64().unwrap() - 3.2).abs() < 1e-12);
        assert_eq!(of.spread["max_pdop"].unwrap().p50, 2.6);
        assert_eq!(of.spread["max_pdop"].unwrap().standard_error, 0.0);
        let text = of.to_text();
        assert!(
            text.contains("failures of 1 satellite (all 3 sets)"),
            "{text}"
        );
    }

    /// An unsolved sample is infinite: such a case is the worst, and there is no mean.
    #[test]
    fn unsolved_samples_are_infinite() {
        let of = summary(vec![case("A", 90.0, 1.0), case("B", 2.0, 0.999)]);
        let worst = &of.worst["max_pdop"];
        assert_eq!((worst.without[0].as_str(), worst.value), ("B", None));
        assert!(of.mean["max_pdop"].is_null() && of.spread["max_pdop"].is_none());
        assert_eq!(of.mean["mean_visible"].as_f64(), Some(46.0));
        let plane = |solved| {
            let metrics = case("A", 2.0, solved).metrics;
            let (name, satellites) = ("NW-P01".to_owned(), Some(4));
            planes_text(&[LostPart {
                name,
                satellites,
                metrics,
            }])
        };
        assert!(plane(1.0).contains("2.0000") && !plane(0.999).contains("2.0000"));
    }
}

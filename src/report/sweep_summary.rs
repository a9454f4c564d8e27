//! A sweep in few numbers, gathered chunk by chunk: the range of every metric, and how the main ones go with the
//! variables of the designs.

use super::figures::Better;
use crate::run::typed_columns::{ColumnValues, TypedColumns};
use std::collections::BTreeMap;

/// The metrics that are shown against the variables, and which end of each is good.
pub(super) const MEASURES: [(&str, Better); 4] = [
    ("mean_pdop", Better::Low),
    ("cvar_pdop", Better::Low),
    ("availability", Better::High),
    ("mean_visible", Better::High),
];

/// The variables of a design that metrics are shown against.
pub(super) const VARIABLES: [&str; 4] = ["satellites", "planes", "inclination_deg", "altitude_km"];

/// Most groups of a variable; neighbouring values share one where there are more.
const MOST_GROUPS: usize = 300;

/// The width of a group where each value has its own: below the digits of any notation.
const FINEST: f64 = 1e-6;

/// The least and the greatest of some values, and the designs that have them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ValueRange {
    pub(super) least: (f64, String),
    pub(super) greatest: (f64, String),
}

impl ValueRange {
    /// The good end.
    pub(super) fn best(&self, better: Better) -> &(f64, String) {
        match better {
            Better::Low => &self.least,
            Better::High => &self.greatest,
        }
    }

    /// Of equal values the first one counts.
    fn add(range: &mut Option<Self>, value: f64, design: &str) {
        let both = || (value, design.to_owned());
        match range {
            None => {
                *range = Some(Self {
                    least: both(),
                    greatest: both(),
                });
            }
            Some(range) if value < range.least.0 => range.least = both(),
            Some(range) if value > range.greatest.0 => range.greatest = both(),
            Some(_) => {}
        }
    }

    fn join(range: &mut Option<Self>, other: Option<Self>) {
        if let Some(Self { least, greatest }) = other {
            Self::add(range, least.0, &least.1);
            Self::add(range, greatest.0, &greatest.1);
        }
    }
}

/// Designs with about the same value of a variable.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct ValueGroup {
    /// The least and the greatest value of the variable.
    pub(super) ends: [f64; 2],
    /// The range of each of [`MEASURES`]; `None` if no design has a value.
    pub(super) ranges: [Option<ValueRange>; MEASURES.len()],
}

/// The groups of a variable.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ValueGroups {
    width: f64,
    groups: BTreeMap<i64, ValueGroup>,
}

impl ValueGroups {
    fn new() -> Self {
        Self {
            width: FINEST,
            groups: BTreeMap::new(),
        }
    }

    /// By rising value.
    pub(super) fn groups(&self) -> impl Iterator<Item = &ValueGroup> {
        self.groups.values()
    }

    fn key(&self, value: f64) -> i64 {
        (value / self.width).round() as i64
    }

    fn at(&mut self, value: f64) -> &mut ValueGroup {
        while !self.groups.contains_key(&self.key(value)) && self.groups.len() == MOST_GROUPS {
            self.widen();
        }
        let ends = [value, value];
        let new = || ValueGroup {
            ends,
            ..ValueGroup::default()
        };
        let group = self.groups.entry(self.key(value)).or_insert_with(new);
        let [low, high] = group.ends;
        group.ends = [low.min(value), high.max(value)];
        group
    }

    /// Doubles the width, so that pairs of neighbours become one.
    fn widen(&mut self) {
        self.width *= 2.0;
        for (_, group) in std::mem::take(&mut self.groups) {
            let middle = f64::midpoint(group.ends[0], group.ends[1]);
            match self.groups.entry((middle / self.width).round() as i64) {
                std::collections::btree_map::Entry::Vacant(place) => {
                    place.insert(group);
                }
                std::collections::btree_map::Entry::Occupied(mut place) => {
                    place.get_mut().join(group);
                }
            }
        }
    }
}

impl ValueGroup {
    fn join(&mut self, other: Self) {
        self.ends = [
            self.ends[0].min(other.ends[0]),
            self.ends[1].max(other.ends[1]),
        ];
        for (range, other) in self.ranges.iter_mut().zip(other.ranges) {
            ValueRange::join(range, other);
        }
    }
}

/// The range of a metric over all designs.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct MetricRange {
    pub(super) name: String,
    pub(super) range: Option<ValueRange>,
    /// Designs without a value.
    pub(super) without: u64,
}

/// What a sweep found, in few numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepSummary {
    pub(super) metrics: Vec<MetricRange>,
    pub(super) variables: [ValueGroups; VARIABLES.len()],
}

impl Default for SweepSummary {
    fn default() -> Self {
        Self {
            metrics: Vec::new(),
            variables: std::array::from_fn(|_| ValueGroups::new()),
        }
    }
}

impl SweepSummary {
    /// Adds the designs of a chunk.
    pub fn add(&mut self, table: &TypedColumns) {
        let Some(ColumnValues::Text(notations)) = table.get("notation") else {
            return;
        };
        let notation = |row: usize| notations[row].as_deref().unwrap_or_default();
        let metrics = crate::run::metric_columns();
        let shown = metrics.into_iter().filter(|name| *name != "cvar_level");
        for (place, name) in shown.enumerate() {
            if place == self.metrics.len() {
                self.metrics.push(MetricRange {
                    name: name.to_owned(),
                    range: None,
                    without: 0,
                });
            }
            let (metric, values) = (&mut self.metrics[place], table.get(name));
            for row in 0..table.rows() {
                match number(values, row) {
                    Some(value) => ValueRange::add(&mut metric.range, value, notation(row)),
                    None => metric.without += 1,
                }
            }
        }
        let measures = MEASURES.map(|(measure, _)| table.get(measure));
        for (variable, groups) in VARIABLES.iter().zip(&mut self.variables) {
            let values = table.get(variable);
            for row in 0..table.rows() {
                let Some(value) = number(values, row) else {
                    continue;
                };
                let group = groups.at(value);
                for (values, range) in measures.iter().zip(&mut group.ranges) {
                    if let Some(value) = number(*values, row) {
                        ValueRange::add(range, value, notation(row));
                    }
                }
            }
        }
    }
}

/// A finite number of a column.
fn number(column: Option<&ColumnValues>, row: usize) -> Option<f64> {
    let value = match column? {
        ColumnValues::Real(of) => of[row]?,
        ColumnValues::Integer(of) => of[row]? as f64,
        _ => return None,
    };
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fmt::Write;

    fn table(rows: impl Iterator<Item = (usize, f64, Option<f64>)>) -> TypedColumns {
        let mut csv = "notation,satellites,inclination_deg,mean_pdop\n".to_owned();
        for (satellites, inclination, pdop) in rows {
            let pdop = pdop.map_or_else(String::new, |x| x.to_string());
            let _ = writeln!(
                csv,
                "d{satellites}/{inclination},{satellites},{inclination},{pdop}"
            );
        }
        TypedColumns::of_csv(&csv).unwrap()
    }

    fn summary(tables: &[TypedColumns]) -> SweepSummary {
        let mut summary = SweepSummary::default();
        for table in tables {
            summary.add(table);
        }
        summary
    }

    #[test]
    fn ranges_have_their_designs_and_missing_values_are_counted() {
        let rows = [
            (24, 50.0, Some(2.0)),
            (24, 55.0, Some(1.5)),
            (30, 50.0, None),
            (30, 55.0, Some(1.5)),
        ];
        let found = summary(&[table(rows.into_iter())]);
        let pdop = found.metrics.iter().find(|one| one.name == "mean_pdop");
        let pdop = pdop.unwrap();
        let range = pdop.range.as_ref().unwrap();
        // Of two equal ones the first.
        assert_eq!(range.least, (1.5, "d24/55".to_owned()));
        assert_eq!(range.greatest, (2.0, "d24/50".to_owned()));
        assert_eq!(pdop.without, 1);
        let availability = found.metrics.iter().find(|one| one.name == "availability");
        assert_eq!(availability.unwrap().without, 4);
        let groups: Vec<&ValueGroup> = found.variables[0].groups().collect();
        assert_eq!([groups[0].ends, groups[1].ends], [[24.0; 2], [30.0; 2]]);
        let best = |group: &ValueGroup| group.ranges[0].clone().unwrap().least.1;
        assert_eq!([best(groups[0]), best(groups[1])], ["d24/55", "d30/55"]);
    }

    /// However many values a variable has, and in however many chunks they come, the groups are few and keep the ends.
    #[test]
    fn many_values_share_groups() {
        let at = |n: usize| 30.0 + 60.0 * ((n * 7919) % 5000) as f64 / 4999.0;
        let rows = |from: usize, to: usize| table((from..to).map(|n| (24, at(n), Some(at(n)))));
        let found = summary(&[rows(0, 10), rows(10, 3000), rows(3000, 5000)]);
        let groups: Vec<&ValueGroup> = found.variables[2].groups().collect();
        assert!(
            (MOST_GROUPS / 4..=MOST_GROUPS).contains(&groups.len()),
            "{}",
            groups.len()
        );
        assert_eq!(
            (groups[0].ends[0], groups[groups.len() - 1].ends[1]),
            (30.0, 90.0)
        );
        assert!(groups.is_sorted_by(|a, b| a.ends[0] <= b.ends[0]));
        let ends = groups.iter().map(|group| group.ranges[0].as_ref().unwrap());
        assert_eq!(ends.map(|range| range.greatest.0).fold(0.0, f64::max), 90.0);
    }
}

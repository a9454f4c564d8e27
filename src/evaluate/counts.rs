//! What is counted over the samples: satellites in view and outages ([M-30](crate::models#m-30)).

use serde::de::Error;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::collections::BTreeMap;

/// Numbers of satellites, from 1, of which a [`Coverage`] has the share.
pub const COVERAGE_LEVELS: usize = 12;

/// The columns of a coverage by LEO satellites in tables.
pub const COVERAGE_COLUMNS: [&str; COVERAGE_LEVELS] = [
    "coverage_1",
    "coverage_2",
    "coverage_3",
    "coverage_4",
    "coverage_5",
    "coverage_6",
    "coverage_7",
    "coverage_8",
    "coverage_9",
    "coverage_10",
    "coverage_11",
    "coverage_12",
];

/// The columns of a coverage by LEO and GNSS satellites in tables.
pub const COVERAGE_TOTAL_COLUMNS: [&str; COVERAGE_LEVELS] = [
    "coverage_total_1",
    "coverage_total_2",
    "coverage_total_3",
    "coverage_total_4",
    "coverage_total_5",
    "coverage_total_6",
    "coverage_total_7",
    "coverage_total_8",
    "coverage_total_9",
    "coverage_total_10",
    "coverage_total_11",
    "coverage_total_12",
];

/// The fraction of the samples, weighted by point, with at least 1, 2, … 12 satellites in view.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coverage([f64; COVERAGE_LEVELS]);

impl Coverage {
    /// The fraction of the samples with at least `satellites` in view; `None` beyond 1 to 12.
    #[must_use]
    pub fn of(&self, satellites: usize) -> Option<f64> {
        self.0.get(satellites.checked_sub(1)?).copied()
    }

    /// From the fractions for 1, 2, … 12 satellites.
    pub(super) fn from_shares(shares: [f64; COVERAGE_LEVELS]) -> Self {
        Self(shares)
    }

    /// The fractions for 1, 2, … 12 satellites.
    #[must_use]
    pub fn shares(&self) -> [f64; COVERAGE_LEVELS] {
        self.0
    }

    /// From the weight of the samples with 0, 1, … 11, and with 12 or more satellites, and of all.
    pub(super) fn of_bins(bins: &[f64; COVERAGE_LEVELS + 1], total: f64) -> Self {
        let mut coverage = Self::default();
        let mut at_least = 0.0;
        for (share, weight) in coverage.0.iter_mut().zip(&bins[1..]).rev() {
            at_least += weight;
            *share = at_least / total;
        }
        coverage
    }
}

/// A map from the number to the share: `{"1": 1.0, …, "12": 0.2}`.
impl Serialize for Coverage {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(COVERAGE_LEVELS))?;
        for (n, share) in (1..).zip(self.0) {
            map.serialize_entry(&n.to_string(), &share)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Coverage {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut shares = BTreeMap::<String, f64>::deserialize(deserializer)?;
        let mut coverage = Self::default();
        for (n, share) in (1..).zip(&mut coverage.0) {
            let given = shares.remove(&n.to_string());
            *share = given.ok_or_else(|| D::Error::custom(format!("there is no share of {n}")))?;
        }
        match shares.keys().next() {
            None => Ok(coverage),
            Some(name) => Err(D::Error::custom(format!("{name} is not 1 to 12"))),
        }
    }
}

/// Satellites in view over some samples, each with the weight of its point.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Views {
    /// Weight of the samples.
    total: u64,
    /// Number of satellites times weight.
    sum: u128,
    /// Weight of the samples with fewer than 1, 2, … 12 satellites.
    fewer: [u64; COVERAGE_LEVELS],
    least: Option<u32>,
}

/// Satellites in view of one point over some samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct PointViews {
    pub(super) samples: u32,
    /// Satellites of all samples together.
    pub(super) sum: u64,
    /// Samples with fewer than 1, 2, … 12 satellites.
    pub(super) fewer: [u32; COVERAGE_LEVELS],
    pub(super) least: u32,
}

impl Views {
    pub(super) fn add(&mut self, visible: u32, weight: u64) {
        self.total += weight;
        self.sum += u128::from(visible) * u128::from(weight);
        for fewer in self.fewer.iter_mut().skip(visible as usize) {
            *fewer += weight;
        }
        self.reach_down_to(visible);
    }

    pub(super) fn add_point(&mut self, point: &PointViews, weight: u64) {
        self.total += u64::from(point.samples) * weight;
        self.sum += u128::from(point.sum) * u128::from(weight);
        for (fewer, &samples) in self.fewer.iter_mut().zip(&point.fewer) {
            *fewer += u64::from(samples) * weight;
        }
        self.reach_down_to(point.least);
    }

    fn reach_down_to(&mut self, visible: u32) {
        self.least = Some(self.least.map_or(visible, |least| least.min(visible)));
    }

    /// Mean number.
    pub(super) fn mean(&self) -> f64 {
        self.sum as f64 / self.total as f64
    }

    /// How many more there are in the mean than in `part`, which is of the same samples.
    pub(super) fn mean_beyond(&self, part: &Self) -> f64 {
        (self.sum - part.sum) as f64 / self.total as f64
    }

    /// Least number, whatever the weight of the point.
    pub(super) fn least(&self) -> u32 {
        self.least.unwrap_or(0)
    }

    pub(super) fn coverage(&self) -> Coverage {
        let share = |fewer: u64| (self.total - fewer) as f64 / self.total as f64;
        Coverage(self.fewer.map(share))
    }
}

/// PDOP up to which a sample is available, and how values in f32 are compared with it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Threshold(pub(super) f64);

impl Threshold {
    /// The threshold with which stored values are compared; an infinite one is above it.
    #[inline(always)]
    pub(super) fn single(self) -> f32 {
        (self.0 as f32).min(f32::MAX)
    }

    /// A solved value as it is stored, on the same side of the threshold.
    #[inline(always)]
    pub(super) fn stored(self, pdop: f64) -> f32 {
        let (value, threshold) = (pdop as f32, self.single());
        if pdop > self.0 && value <= threshold {
            threshold.next_up()
        } else {
            value
        }
    }
}

/// The outages of one point: runs of samples that are unsolved or above the availability threshold.
/// Lengths are in samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Outages {
    pub(super) number: u32,
    pub(super) longest: u32,
    pub(super) total: u32,
    /// The one that the first sample is in, and the one that the last sample is in.
    pub(super) first: u32,
    pub(super) last: u32,
    /// Number of samples.
    pub(super) samples: u32,
}

impl Outages {
    /// From sample to sample.
    pub(super) fn of(is_out: impl Iterator<Item = bool>) -> Self {
        let mut outages = Self::default();
        is_out.for_each(|is_out| outages.add(is_out));
        outages
    }

    /// The next sample.
    pub(super) fn add(&mut self, is_out: bool) {
        if is_out {
            self.number += u32::from(self.last == 0);
            self.total += 1;
            self.last += 1;
            self.longest = self.longest.max(self.last);
            self.first += u32::from(self.first == self.samples);
        } else {
            self.last = 0;
        }
        self.samples += 1;
    }

    /// Whether an outage of the greatest length is cut by an end of the span.
    pub(super) fn is_longest_cut(&self) -> bool {
        self.longest > 0 && (self.longest == self.first || self.longest == self.last)
    }
}

/// One outage: samples in a row, from its first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct OutageRun {
    pub(super) first: u32,
    pub(super) samples: u32,
}

/// The longest outage of any point, in samples, and whether an end of the span cuts it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct LongestOutage {
    pub(super) samples: u32,
    pub(super) is_cut: bool,
}

impl LongestOutage {
    pub(super) fn of(points: impl Iterator<Item = Outages>) -> Self {
        points.fold(Self::default(), |longest, point| {
            let here = Self {
                samples: point.longest,
                is_cut: point.is_longest_cut(),
            };
            match here.samples.cmp(&longest.samples) {
                std::cmp::Ordering::Less => longest,
                std::cmp::Ordering::Greater => here,
                std::cmp::Ordering::Equal => Self {
                    is_cut: here.is_cut || longest.is_cut,
                    ..here
                },
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Weights 3, 1, 4 on 0, 2, 13 satellites: mean 54/8.
    #[test]
    fn validate_views_by_hand() {
        let mut views = Views::default();
        for (visible, weight) in [(2, 1), (0, 3), (13, 4)] {
            views.add(visible, weight);
        }
        assert_eq!((views.mean(), views.least()), (6.75, 0));
        let coverage = views.coverage();
        let expected = [0.625, 0.625, 0.5, 0.5];
        assert_eq!(coverage.shares()[..4], expected);
        assert_eq!(
            (coverage.of(12), coverage.of(13), coverage.of(0)),
            (Some(0.5), None, None)
        );
        let mut seen = Views::default();
        seen.add(4, 1);
        assert_eq!(
            (seen.least(), seen.coverage().of(4), seen.coverage().of(5)),
            (4, Some(1.0), Some(0.0))
        );
    }

    #[test]
    fn coverage_is_a_map_of_numbers() {
        let mut views = Views::default();
        views.add(1, 1);
        let json = serde_json::to_value(views.coverage()).unwrap();
        assert_eq!((&json["1"], &json["12"]), (&1.0.into(), &0.0.into()));
        let read = |json| serde_json::from_value::<Coverage>(json);
        assert_eq!(read(json.clone()).unwrap(), views.coverage());
        let mut more = json.clone();
        more["13"] = 0.5.into();
        assert!(
            read(more)
                .unwrap_err()
                .to_string()
                .contains("13 is not 1 to 12")
        );
        let mut fewer = json;
        fewer.as_object_mut().unwrap().remove("4");
        assert!(
            read(fewer)
                .unwrap_err()
                .to_string()
                .contains("no share of 4")
        );
    }

    /// A value is stored on its side of the threshold, however close.
    #[test]
    fn stored_values_keep_their_side() {
        for threshold in [6.0, 1.2, 2.5 + 1e-9, 0.1] {
            let available = Threshold(threshold);
            for (pdop, is_available) in [
                (threshold, true),
                (threshold.next_down(), true),
                (threshold.next_up(), false),
                (threshold * (1.0 + 1e-9), false),
            ] {
                let stored = available.stored(pdop);
                assert_eq!(stored <= available.single(), is_available, "{pdop}");
                assert!((f64::from(stored) / pdop - 1.0).abs() < 2e-7, "{pdop}");
            }
        }
        assert!(f32::INFINITY > Threshold(f64::INFINITY).single());
    }

    #[test]
    fn outages_are_runs() {
        let of = |text: &str| Outages::of(text.chars().map(|c| c == 'x'));
        let expected = Outages {
            number: 3,
            longest: 3,
            total: 6,
            first: 1,
            last: 2,
            samples: 9,
        };
        assert_eq!(of("x..xxx.xx"), expected);
        assert!(!expected.is_longest_cut());
        assert_eq!((of("...").number, of("...").total), (0, 0));
        let all = of("xxxx");
        assert_eq!((all.number, all.first, all.last), (1, 4, 4));
        assert!(all.is_longest_cut() && of(".x").is_longest_cut() && !of(".x.").is_longest_cut());
        // One of the two longest is cut.
        let longest = LongestOutage::of([".xx.", "..xx", "x..."].map(of).into_iter());
        assert_eq!((longest.samples, longest.is_cut), (2, true));
    }
}

//! How often so many satellites are in view ([M-30](crate::models#m-30)).

use super::counts::Views;
use serde::{Deserialize, Serialize};

/// The fraction of the samples, weighted by point, with exactly 0, 1, 2, … satellites in view, up to the greatest number.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ViewHistograms {
    /// LEO satellites.
    pub leo: Vec<f64>,
    /// GNSS satellites.
    pub gnss: Vec<f64>,
    /// LEO and GNSS satellites.
    pub all: Vec<f64>,
}

/// A row of the table of the histograms.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct HistogramRow {
    /// Number of satellites in view.
    pub satellites: usize,
    /// Fraction of the samples with as many LEO satellites.
    pub leo: f64,
    /// Fraction of the samples with as many GNSS satellites.
    pub gnss: f64,
    /// Fraction of the samples with as many satellites, LEO and GNSS.
    pub all: f64,
}

impl ViewHistograms {
    pub(super) fn new(leo: &ViewBins, gnss: &ViewBins, all: &ViewBins) -> Self {
        Self {
            leo: leo.shares(),
            gnss: gnss.shares(),
            all: all.shares(),
        }
    }

    /// The histograms side by side, from 0 satellites to the greatest number of any.
    #[must_use]
    pub fn rows(&self) -> Vec<HistogramRow> {
        let length = self.leo.len().max(self.gnss.len()).max(self.all.len());
        let share = |of: &[f64], n: usize| of.get(n).copied().unwrap_or(0.0);
        let row = |n| HistogramRow {
            satellites: n,
            leo: share(&self.leo, n),
            gnss: share(&self.gnss, n),
            all: share(&self.all, n),
        };
        (0..length).map(row).collect()
    }
}

/// The weight of the samples by their number of satellites in view.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub(super) struct ViewBins(Vec<u64>);

impl ViewBins {
    /// Samples without satellites.
    pub(super) fn of_none() -> Self {
        Self(vec![1])
    }

    #[inline]
    pub(super) fn add(&mut self, visible: u32, weight: u64) {
        let bin = visible as usize;
        if bin >= self.0.len() {
            self.0.resize(bin + 1, 0);
        }
        self.0[bin] += weight;
    }

    /// Moves the weight of samples from one number to a smaller one.
    pub(super) fn shift(&mut self, from: u32, to: u32, weight: u64) {
        self.0[from as usize] -= weight;
        self.0[to as usize] += weight;
    }

    pub(super) fn merge(&mut self, other: &Self) {
        if other.0.len() > self.0.len() {
            self.0.resize(other.0.len(), 0);
        }
        for (mine, theirs) in self.0.iter_mut().zip(&other.0) {
            // Those of files may be any numbers.
            *mine = mine.saturating_add(*theirs);
        }
    }

    /// The weight of all samples, and their satellites times weight; `None` if they are too many to be counted.
    pub(super) fn totals(&self) -> Option<(u64, u128)> {
        let mut totals = (0_u64, 0_u128);
        for (visible, &weight) in (0_u128..).zip(&self.0) {
            totals.0 = totals.0.checked_add(weight)?;
            totals.1 += visible * u128::from(weight);
        }
        Some(totals)
    }

    /// What the metrics give of them.
    pub(super) fn views(&self) -> Views {
        let mut views = Views::default();
        let bins = (0..).zip(&self.0).filter(|(_, weight)| **weight > 0);
        bins.for_each(|(visible, &weight)| views.add(visible, weight));
        views
    }

    /// The share of each number, up to the greatest.
    fn shares(&self) -> Vec<f64> {
        let total = self.0.iter().sum::<u64>() as f64;
        let end = self.0.iter().rposition(|weight| *weight > 0);
        let bins = &self.0[..end.map_or(0, |last| last + 1)];
        bins.iter().map(|&weight| weight as f64 / total).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::counts::{COVERAGE_LEVELS, Coverage};
    use super::*;

    /// 1, 2 and 5 of 8 samples see 0, 3 and 14 satellites.
    #[test]
    fn validate_histograms_and_bins_by_hand() {
        let mut seen = ViewBins::default();
        let mut bins = [0.0; COVERAGE_LEVELS + 1];
        for (visible, weight) in [(3_u32, 2), (0, 1), (14, 5)] {
            seen.add(visible, weight);
            bins[(visible as usize).min(COVERAGE_LEVELS)] += weight as f64;
        }
        assert_eq!(Coverage::of_bins(&bins, 8.0), seen.views().coverage());
        assert_eq!((seen.views().mean(), seen.views().least()), (9.5, 0));
        let histograms = ViewHistograms::new(&seen, &ViewBins::of_none(), &seen);
        assert_eq!(histograms.leo.len(), 15);
        assert_eq!((histograms.leo[3], histograms.leo[14]), (0.25, 0.625));
        assert_eq!(histograms.gnss, [1.0]);
        let rows = histograms.rows();
        assert_eq!((rows.len(), rows[14].all, rows[14].gnss), (15, 0.625, 0.0));
    }

    /// In two parts, and with satellites taken away, the bins are those of the samples.
    #[test]
    fn bins_merge_and_shift() {
        let (mut first, mut second) = (ViewBins::default(), ViewBins::default());
        first.add(2, 3);
        second.add(5, 1);
        second.add(2, 4);
        first.merge(&second);
        first.shift(5, 4, 1);
        let mut expected = ViewBins::default();
        expected.add(4, 1);
        expected.add(2, 7);
        assert_eq!(
            (first.views(), first.shares()),
            (expected.views(), expected.shares())
        );
    }
}

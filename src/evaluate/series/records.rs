//! The rows of a series, and their form in tables.

use crate::evaluate::counts::{
    COVERAGE_COLUMNS, COVERAGE_LEVELS, COVERAGE_TOTAL_COLUMNS, Coverage,
};
use crate::units::round_decimal;
use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// One instant, over all points with their weights ([M-31](crate::models#m-31)).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EpochMetrics {
    /// Seconds since the epoch of the grid.
    pub elapsed_s: f64,
    /// Mean visible LEO satellites, equation (22) of the paper.
    pub mean_visible: f64,
    /// Mean PDOP over the solved points, equation (24); `None` if no point is solved.
    pub mean_pdop: Option<f64>,
    /// Maximum PDOP of a solved point: its maximum over time is equation (23).
    pub max_pdop: Option<f64>,
    /// Fraction of the points that are solved.
    pub solved_fraction: f64,
    /// Fraction of the points that are solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Least number of visible LEO satellites at any point.
    pub least_visible: u32,
    /// Mean visible GNSS satellites.
    pub mean_gnss_visible: f64,
    /// Mean visible satellites, LEO and GNSS.
    pub mean_total_visible: f64,
    /// Gain in mean PDOP over the GNSS alone; `None` without GNSS, or if one of the two has none.
    pub gain_mean_pdop: Option<f64>,
    /// Fraction of the points with at least n visible LEO satellites.
    pub coverage: Coverage,
    /// The same with the GNSS.
    pub coverage_total: Coverage,
}

/// One point, over all instants.
#[derive(Debug, Clone, PartialEq)]
pub struct PointMetrics {
    /// Latitude of the surface model, degrees.
    pub latitude_deg: f64,
    /// East longitude, degrees, as given.
    pub longitude_deg: f64,
    /// Weight of the point in the metrics, as given.
    pub weight: f64,
    /// Mean visible LEO satellites.
    pub mean_visible: f64,
    /// Mean PDOP over the solved instants; `None` if there are none.
    pub mean_pdop: Option<f64>,
    /// 95 % quantile of PDOP over the solved instants.
    pub p95_pdop: Option<f64>,
    /// Maximum PDOP of a solved instant.
    pub max_pdop: Option<f64>,
    /// Fraction of the instants that are solved.
    pub solved_fraction: f64,
    /// Fraction of the instants that are solved with PDOP at most the availability threshold.
    pub availability: f64,
    /// Least number of visible LEO satellites at any instant.
    pub least_visible: u32,
    /// Mean visible GNSS satellites.
    pub mean_gnss_visible: f64,
    /// Mean visible satellites, LEO and GNSS.
    pub mean_total_visible: f64,
    /// Number of outages: runs of instants that are unsolved or above the availability threshold.
    pub outages: u32,
    /// Length of the longest outage, seconds: instants times the step.
    pub longest_outage_s: f64,
    /// Length of all outages together, seconds.
    pub total_outage_s: f64,
    /// Whether the start or the end of the span cuts an outage, which may be longer.
    pub outage_cut: bool,
    /// Gain in mean PDOP over the GNSS alone; `None` without GNSS, or if one of the two has none.
    pub gain_mean_pdop: Option<f64>,
    /// Fraction of the instants with at least n visible LEO satellites.
    pub coverage: Coverage,
    /// The same with the GNSS.
    pub coverage_total: Coverage,
    /// What the point is called, if anything.
    pub name: Option<Arc<str>>,
}

/// An outage of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Outage {
    /// Seconds from the epoch of the grid to its first instant.
    pub start_s: f64,
    /// Its length, seconds: instants times the step.
    pub length_s: f64,
    /// Whether the start or the end of the span cuts it.
    pub is_cut: bool,
}

/// A record of fields, each under its name.
macro_rules! record {
    ($serializer:expr, $row:expr, [$($field:ident),*], $coverages:expr, [$($last:ident: $value:expr),*]) => {{
        let names = [$(stringify!($field)),*];
        let more = 2 * COVERAGE_LEVELS + 1;
        let mut record = $serializer.serialize_struct("record", names.len() + more)?;
        $(record.serialize_field(stringify!($field), &$row.$field)?;)*
        let columns = [COVERAGE_COLUMNS, COVERAGE_TOTAL_COLUMNS];
        for (columns, coverage) in columns.iter().zip($coverages) {
            for (column, share) in columns.iter().zip(coverage.shares()) {
                record.serialize_field(column, &share)?;
            }
        }
        $(record.serialize_field(stringify!($last), $value)?;)*
        record.end()
    }};
}

/// Flat, with a column for each number of satellites.
impl Serialize for EpochMetrics {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        record!(
            serializer,
            self,
            [
                elapsed_s,
                mean_visible,
                mean_pdop,
                max_pdop,
                solved_fraction,
                availability,
                least_visible,
                mean_gnss_visible,
                mean_total_visible,
                gain_mean_pdop
            ],
            [self.coverage, self.coverage_total],
            []
        )
    }
}

/// Flat, with a column for each number of satellites; the name is last.
impl Serialize for PointMetrics {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        record!(
            serializer,
            self,
            [
                latitude_deg,
                longitude_deg,
                weight,
                mean_visible,
                mean_pdop,
                p95_pdop,
                max_pdop,
                solved_fraction,
                availability,
                least_visible,
                mean_gnss_visible,
                mean_total_visible,
                outages,
                longest_outage_s,
                total_outage_s,
                outage_cut,
                gain_mean_pdop
            ],
            [self.coverage, self.coverage_total],
            [name: &self.name.as_deref()]
        )
    }
}

impl PointMetrics {
    /// How the point is called where it is shown: by its name, or else by its place.
    #[must_use]
    pub fn label(&self) -> String {
        match &self.name {
            Some(name) => name.to_string(),
            None => place(self.latitude_deg, self.longitude_deg),
        }
    }
}

/// A place in degrees with the digits of the finest step, 0.0005°: middles of cells of equal area have many more.
fn place(latitude_deg: f64, longitude_deg: f64) -> String {
    let [latitude, longitude] = [latitude_deg, longitude_deg].map(|at| round_decimal(at, 4));
    format!("{latitude}°, {longitude}°")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_called_by_its_name_or_its_place() {
        let point = |name: Option<&str>| PointMetrics {
            latitude_deg: 48.123_456,
            longitude_deg: -11.5,
            weight: 1.0,
            mean_visible: 0.0,
            mean_pdop: None,
            p95_pdop: None,
            max_pdop: None,
            solved_fraction: 0.0,
            availability: 0.0,
            least_visible: 0,
            mean_gnss_visible: 0.0,
            mean_total_visible: 0.0,
            outages: 0,
            longest_outage_s: 0.0,
            total_outage_s: 0.0,
            outage_cut: false,
            gain_mean_pdop: None,
            coverage: Coverage::default(),
            coverage_total: Coverage::default(),
            name: name.map(Arc::from),
        };
        assert_eq!(point(Some("Munich")).label(), "Munich");
        assert_eq!(point(None).label(), "48.1235°, -11.5°");
    }

    #[test]
    fn places_have_the_digits_of_the_finest_step() {
        assert_eq!(place(80.951_259_296_161_82, -146.25), "80.9513°, -146.25°");
        assert_eq!(place(-3.0005, 136.0), "-3.0005°, 136°");
    }
}

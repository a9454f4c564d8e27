//! The figures of a run as data, and the table behind each.
//!
//! A [`Plate`] has a [`Chart`], which [`draw`] turns into SVG, PDF or PNG, and its CSV. The bytes depend
//! only on the plate: the typeface is part of the library and there are no timestamps.

mod budget;
mod chart;
mod choice;
mod course;
mod curves;
pub mod draw;
mod failures;
mod front;
mod histogram;
mod map;
mod outages;
mod phases;
mod residuals;
mod size;
mod study;
#[cfg(feature = "sweep")]
mod sweep;
mod table;

pub use super::Baseline;
pub use super::labels::quantity_label;
pub use budget::budget;
pub use chart::{
    Axis, AxisScale, Better, Chart, DeviationChart, DeviationRow, Layer, MapChart, MeasureAxis,
    PlaneChart, Projection, RowChart, Style, TimelineChart,
};
pub use choice::AxisChoice;
pub use curves::{NamedProfile, cdf, convergence, series};
pub use failures::{NamedLosses, failures};
pub use front::{NamedFront, pareto};
pub use histogram::histogram;
pub use map::map;
pub use outages::timeline;
pub use phases::{NamedPhases, phases};
pub(crate) use residuals::residual_figures;
pub(crate) use size::size_figures;
pub use study::{NamedChart, deviations_name, study_figures};
#[cfg(feature = "sweep")]
pub(in crate::report) use sweep::sweep_figures;

pub(in crate::report) use curves::at_epoch;
pub(in crate::report) use front::earlier;
pub(in crate::report) use map::at_point;

use crate::keyword::keywords;
use crate::scenario::Keyword;
use thiserror::Error;

keywords! {
    /// A figure of a run.
    Figure {
        /// The front in the plane of two objectives (figure 2 of the paper).
        Pareto = "pareto",
        /// A measure over the region.
        Map = "map",
        /// A distribution (figures 3a and 4a).
        Cdf = "cdf",
        /// A measure over time (figures 3b and 4b).
        Series = "series",
        /// The hypervolume over the generations.
        Convergence = "convergence",
        /// How often so many satellites are in view.
        Histogram = "histogram",
        /// The outages of the points that are out longest.
        Timeline = "timeline",
        /// The error budget of a validation.
        Budget = "budget",
        /// What the loss of each satellite does.
        Failures = "failures",
        /// A measure in each phase of a build-up or a drawdown.
        Phases = "phases",
    }
}

keywords! {
    /// The quantity shown by a map, a distribution or a series.
    Measure {
        /// Visible LEO satellites: of a point over time, or of an instant over the points.
        MeanVisible = "mean-visible",
        /// Mean PDOP, in the same way.
        MeanPdop = "mean-pdop",
        /// 95 % quantile of PDOP of a point.
        P95Pdop = "p95-pdop",
        /// Maximum PDOP of a point, or of an instant.
        MaxPdop = "max-pdop",
        /// Fraction of the time that a point is available.
        Availability = "availability",
        /// Longest outage of a point, seconds.
        LongestOutageS = "longest-outage-s",
        /// Gain in mean PDOP over the GNSS alone: of a point, or of an instant.
        GainMeanPdop = "gain-mean-pdop",
        /// Fraction with at least 1 visible LEO satellite: of the time at a point, or of the points at an instant.
        Coverage1 = "coverage-1",
        /// Fraction with at least 2 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage2 = "coverage-2",
        /// Fraction with at least 3 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage3 = "coverage-3",
        /// Fraction with at least 4 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage4 = "coverage-4",
        /// Fraction with at least 5 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage5 = "coverage-5",
        /// Fraction with at least 6 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage6 = "coverage-6",
        /// Fraction with at least 7 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage7 = "coverage-7",
        /// Fraction with at least 8 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage8 = "coverage-8",
        /// Fraction with at least 9 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage9 = "coverage-9",
        /// Fraction with at least 10 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage10 = "coverage-10",
        /// Fraction with at least 11 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage11 = "coverage-11",
        /// Fraction with at least 12 visible LEO satellites: of the time at a point, or of the points at an instant.
        Coverage12 = "coverage-12",
        /// Maximum PDOP of a point without any one of the satellites; of a map alone.
        OneLostMaxPdop = "n1-max-pdop",
        /// Fraction of the time that a point is available without any one of the satellites; of a map alone.
        OneLostAvailability = "n1-availability",
        /// PDOP of every point and instant, with its tail.
        Pdop = "pdop",
    }
}

impl Measure {
    /// The label of its axis.
    #[must_use]
    pub fn label(self) -> String {
        if let Some(least) = self.coverage_level() {
            return format!("fraction of the time with at least {least} LEO satellites");
        }
        let label = match self {
            Self::LongestOutageS => "longest outage (s)",
            Self::GainMeanPdop => "gain in mean PDOP over the GNSS alone",
            Self::MeanVisible => "mean visible LEO satellites",
            Self::MeanPdop => "mean PDOP",
            Self::P95Pdop => "95 % quantile of PDOP",
            Self::MaxPdop => "maximum PDOP",
            Self::Availability => "availability (fraction of the time)",
            Self::OneLostMaxPdop => "maximum PDOP without the worst one satellite",
            Self::OneLostAvailability => {
                "availability without the worst one satellite (fraction of the time)"
            }
            _ => "PDOP",
        };
        label.to_owned()
    }

    /// Which end of it is good.
    #[must_use]
    pub fn better(self) -> Better {
        match self {
            Self::MeanPdop
            | Self::P95Pdop
            | Self::MaxPdop
            | Self::LongestOutageS
            | Self::OneLostMaxPdop
            | Self::Pdop => Better::Low,
            _ => Better::High,
        }
    }

    /// Whether it is of what is left when any one satellite is lost.
    #[must_use]
    pub fn is_of_one_lost(self) -> bool {
        matches!(self, Self::OneLostMaxPdop | Self::OneLostAvailability)
    }

    /// For a coverage: the least number of satellites.
    pub(in crate::report) fn coverage_level(self) -> Option<usize> {
        self.keyword().strip_prefix("coverage-")?.parse().ok()
    }

    /// Its column in a table.
    fn column(self) -> String {
        self.keyword().replace('-', "_")
    }
}

/// Why a figure cannot be made.
#[derive(Debug, Error)]
pub enum FigureError {
    /// The run lacks the data of the figure.
    #[error("there is no {figure} figure: {reason}")]
    Nothing {
        /// The figure.
        figure: Figure,
        /// What is missing.
        reason: &'static str,
    },
    /// The figure does not show that measure.
    #[error("figure {figure} cannot show {measure}; it shows {choices}")]
    Measure {
        /// The figure.
        figure: Figure,
        /// The requested measure.
        measure: Measure,
        /// The possible measures.
        choices: String,
    },
    /// The axis asked for cannot be had.
    #[error("{0}")]
    Axis(String),
    /// The table cannot be written, which does not happen in memory.
    #[error("the figure's data: {0}")]
    Table(#[from] ::csv::Error),
}

impl FigureError {
    fn measure(figure: Figure, measure: Measure, choices: &[Measure]) -> Self {
        let words: Vec<_> = choices.iter().map(|choice| choice.keyword()).collect();
        Self::Measure {
            figure,
            measure,
            choices: words.join(", "),
        }
    }
}

/// Name and notation of a constellation.
fn title(named: &NamedProfile<'_>) -> String {
    if named.name == named.notation {
        return named.name.clone();
    }
    format!("{} ({})", named.name, named.notation)
}

/// A figure and the numbers behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// What is drawn.
    pub chart: Chart,
    /// The numbers, with the unit of each column in its header.
    pub csv: String,
}

//! The figures of a run as data, and the table behind each.
//!
//! A [`Plate`] has a [`Chart`], which [`draw`] turns into SVG or PNG, and its CSV. The bytes depend
//! only on the plate: the typeface is part of the library and there are no timestamps.

mod bars;
mod curves;
pub mod draw;
mod failures;
mod front;
mod map;
mod table;

pub use super::Baseline;
pub use bars::budget;
pub use curves::{NamedProfile, cdf, convergence, series};
pub use failures::{NamedLosses, failures};
pub use front::{NamedFront, pareto};
pub use map::map;

pub(in crate::report) use curves::at_epoch;
pub(in crate::report) use front::earlier;
pub(in crate::report) use map::at_point;

use crate::ground::RegionMap;
use crate::keyword::keywords;
use crate::scenario::{Keyword, Quantity};
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
        /// The error budget of a validation.
        Budget = "budget",
        /// What the loss of each satellite does.
        Failures = "failures",
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
        /// PDOP of every point and instant, with its tail.
        Pdop = "pdop",
    }
}

impl Measure {
    /// The label of its axis.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::MeanVisible => "mean visible LEO satellites",
            Self::MeanPdop => "mean PDOP",
            Self::P95Pdop => "95 % quantile of PDOP",
            Self::MaxPdop => "maximum PDOP",
            Self::Availability => "availability (fraction of the time)",
            Self::Pdop => "PDOP",
        }
    }
}

/// The label of a quantity's axis.
#[must_use]
pub fn quantity_label(name: &str) -> String {
    let Ok(quantity) = Quantity::from_keyword(name) else {
        return name.to_owned();
    };
    let label = match quantity {
        Quantity::JPos => "J_pos = mean PDOP + \u{3bb} CVaR of PDOP",
        Quantity::JCost => "J_cost = satellites / mean visible",
        Quantity::MeanPdop => "mean PDOP",
        Quantity::CvarPdop => "CVaR of PDOP",
        Quantity::P95Pdop => "95 % quantile of PDOP",
        Quantity::P99Pdop => "99 % quantile of PDOP",
        Quantity::MaxPdop => "maximum PDOP",
        Quantity::Satellites => "satellites",
        Quantity::Planes => "planes",
        Quantity::NewSatellites => "new satellites",
        Quantity::NewPlanes => "new planes",
        Quantity::MeanVisible => "mean visible LEO satellites",
        Quantity::Availability => "availability",
        Quantity::InformationPdop => "mean PDOP of a window",
        Quantity::Sigma3dM => "1-sigma position error (m)",
        Quantity::SigmaHM => "1-sigma horizontal error (m)",
        Quantity::SigmaVM => "1-sigma height error (m)",
        Quantity::Error953dM => "95 % position error (m)",
        Quantity::Error95HM => "95 % horizontal error (m)",
        Quantity::Error95VM => "95 % height error (m)",
        Quantity::LaunchCost => "launch cost (satellites)",
        Quantity::LeastVisible => "least number of visible LEO satellites",
        Quantity::MeanTotalVisible => "mean visible satellites, LEO and GNSS",
        Quantity::LongestOutageS => "longest outage (s)",
        Quantity::N1MaxPdop => "maximum PDOP without any one satellite",
        Quantity::N1CvarPdop => "CVaR of PDOP without any one satellite",
        Quantity::N1Availability => "availability without any one satellite",
        Quantity::ExpectedAvailability => "expected availability",
        Quantity::P95Hdop => "95 % quantile of HDOP",
        Quantity::P95Vdop => "95 % quantile of VDOP",
        coverage => return coverage_label(coverage),
    };
    label.to_owned()
}

fn coverage_label(quantity: Quantity) -> String {
    match quantity.coverage_levels() {
        Some((least, true)) => format!("fraction with at least {least} satellites, LEO and GNSS"),
        Some((least, false)) => format!("fraction with at least {least} LEO satellites"),
        None => quantity.to_string(),
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

/// A figure and the numbers behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Plate {
    /// What is drawn.
    pub chart: Chart,
    /// The numbers, with the unit of each column in its header.
    pub csv: String,
}

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Chart {
    /// Points and lines in a plane.
    Plane(PlaneChart),
    /// Coloured points or cells over coastlines.
    Map(MapChart),
    /// Groups of bars on a logarithmic axis.
    Bars(BarChart),
}

/// Points and lines in a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneChart {
    /// Title.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x: String,
    /// Label of the vertical axis, with its unit.
    pub y: String,
    /// What is drawn, from the back to the front.
    pub layers: Vec<Layer>,
}

/// Points drawn in the same style.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name in the legend; empty for none.
    pub name: String,
    /// The points (x, y).
    pub points: Vec<(f64, f64)>,
    /// The style.
    pub style: Style,
}

/// How a layer is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Style {
    /// A line in the n-th colour.
    Line(usize),
    /// A dashed grey line.
    Rule,
    /// Dots in the n-th colour.
    Dots(usize),
    /// Pale dots behind the others.
    Faint,
    /// Large marks in the n-th colour, of the n-th form.
    Marks(usize),
}

/// A measure over a region.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChart {
    /// Title.
    pub title: String,
    /// Label of the colours, with the unit.
    pub label: String,
    /// Longitude, latitude and value of each point, degrees; `None` where there is no value.
    pub cells: Vec<(f64, f64, Option<f64>)>,
    /// Names of the points of a list; empty for those without one.
    pub names: Vec<String>,
    /// Cells and borders of the region.
    pub map: RegionMap,
    /// What is shown.
    pub bounds: super::coastline::Bounds,
}

/// Groups of bars.
#[derive(Debug, Clone, PartialEq)]
pub struct BarChart {
    /// Title.
    pub title: String,
    /// Label of the vertical axis, with its unit.
    pub y: String,
    /// Names of the bars of each group.
    pub bars: Vec<String>,
    /// Name and bar heights of each group.
    pub groups: Vec<(String, Vec<f64>)>,
}

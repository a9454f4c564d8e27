//! What a figure shows, before it is drawn.

use crate::ground::RegionMap;
use crate::keyword::keywords;
use crate::report::coastline::Bounds;

/// What is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Chart {
    /// Points and lines in a plane.
    Plane(PlaneChart),
    /// Coloured cells or sites over coastlines.
    Map(MapChart),
    /// Marks on rows along a logarithmic axis.
    Rows(RowChart),
    /// Rows of bars over time.
    Timeline(TimelineChart),
    /// Dots on rows, in units of a tolerance.
    Deviations(DeviationChart),
}

impl Chart {
    /// Its title.
    pub fn title_mut(&mut self) -> &mut String {
        match self {
            Self::Plane(chart) => &mut chart.title,
            Self::Map(chart) => &mut chart.title,
            Self::Rows(chart) => &mut chart.title,
            Self::Timeline(chart) => &mut chart.title,
            Self::Deviations(chart) => &mut chart.title,
        }
    }
}

/// How values are spread along an axis or over the colours.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum AxisScale {
    /// Evenly.
    #[default]
    Linear,
    /// By their logarithms.
    Log,
}

/// An axis, or a scale of colours.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// How values are spread along it.
    pub scale: AxisScale,
    /// Its ends; those of the data if there are none.
    pub range: Option<[f64; 2]>,
    /// Whether ticks are at whole numbers only.
    pub is_whole: bool,
}

impl Axis {
    /// A linear axis that ends where the data do.
    pub fn new(label: impl Into<String>) -> Self {
        Self {
            label: label.into(),
            ..Self::default()
        }
    }

    /// An axis of probabilities: from 0 to 1.
    pub fn share(label: impl Into<String>) -> Self {
        Self {
            range: Some([0.0, 1.0]),
            ..Self::new(label)
        }
    }
}

/// The axis of a plane on which the measure is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MeasureAxis {
    /// The horizontal one.
    X,
    /// The vertical one.
    Y,
    /// None that can be chosen.
    Neither,
}

/// Points and lines in a plane.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaneChart {
    /// Title.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// On which of them the measure is.
    pub measure: MeasureAxis,
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
    /// A line in the n-th colour and dash.
    Line(usize),
    /// The area inside a closed line, in a tint of the n-th colour.
    Band(usize),
    /// A dotted grey line.
    Rule,
    /// Dots in the n-th colour.
    Dots(usize),
    /// Pale dots behind the others.
    Faint,
    /// Large marks in the n-th colour, of the n-th form.
    Marks(usize),
}

/// Which end of a measure is good.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Better {
    /// High values, as of visibility.
    High,
    /// Low values, as of PDOP.
    Low,
}

keywords! {
    /// How a map shows the Earth.
    Projection {
        /// Degrees of latitude and longitude, to scale in the middle of the map.
        PlateCarree = "plate-carree",
        /// Areas in proportion: Šavrič, Patterson and Jenny (2018).
        EqualEarth = "equal-earth",
    }
}

/// A measure over a region.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChart {
    /// Title.
    pub title: String,
    /// The scale of the colours.
    pub colours: Axis,
    /// Which end of it is good.
    pub better: Better,
    /// How the Earth is shown.
    pub projection: Projection,
    /// Longitude, latitude and value of each point, degrees; `None` where there is no value.
    pub cells: Vec<(f64, f64, Option<f64>)>,
    /// Names of the points of a list; empty for those without one.
    pub names: Vec<String>,
    /// Cells and borders of the region.
    pub map: RegionMap,
    /// What is shown.
    pub bounds: Bounds,
}

/// Rows of bars over time.
#[derive(Debug, Clone, PartialEq)]
pub struct TimelineChart {
    /// Title.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x: String,
    /// The first and the last time shown.
    pub span: [f64; 2],
    /// Name, and beginnings and ends, of each row.
    pub rows: Vec<(String, Vec<[f64; 2]>)>,
}

/// Numbers compared with published ones.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviationChart {
    /// Title.
    pub title: String,
    /// Label of the horizontal axis, with its unit.
    pub x: String,
    /// The numbers, from the top.
    pub rows: Vec<DeviationRow>,
}

/// A number compared with a published one.
#[derive(Debug, Clone, PartialEq)]
pub struct DeviationRow {
    /// Its name.
    pub name: String,
    /// Its deviation in units of the tolerance.
    pub tolerances: f64,
    /// The n-th colour.
    pub colour: usize,
}

/// Marks on rows along a logarithmic axis.
#[derive(Debug, Clone, PartialEq)]
pub struct RowChart {
    /// Title.
    pub title: String,
    /// Label of the axis, with its unit.
    pub x: String,
    /// Names of the marks of each row.
    pub marks: Vec<String>,
    /// Name and sizes of each row, from the top. A size of 0 has no mark.
    pub rows: Vec<(String, Vec<f64>)>,
}

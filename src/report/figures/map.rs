//! A measure over the region.

use super::table::{Csv, optional};
use super::{Chart, Figure, FigureError, MapChart, Measure, NamedProfile, Plate};
use crate::evaluate::PointMetrics;
use crate::ground::RegionMap;
use crate::report::coastline::Bounds;

/// Measures that a map can show.
const MEASURES: [Measure; 5] = [
    Measure::MeanVisible,
    Measure::MeanPdop,
    Measure::P95Pdop,
    Measure::MaxPdop,
    Measure::Availability,
];

/// The value of a measure at a point; `None` for PDOP without a solution.
#[must_use]
pub(in crate::report) fn at_point(measure: Measure, point: &PointMetrics) -> Option<f64> {
    match measure {
        Measure::MeanVisible => Some(point.mean_visible),
        Measure::MeanPdop | Measure::Pdop => point.mean_pdop,
        Measure::P95Pdop => point.p95_pdop,
        Measure::MaxPdop => point.max_pdop,
        Measure::Availability => Some(point.availability),
    }
}

/// A constellation's measure over the points of a region.
///
/// # Errors
/// If the measure has no value at a point.
pub fn map(
    named: &NamedProfile<'_>,
    measure: Measure,
    map: &RegionMap,
) -> Result<Plate, FigureError> {
    let figure = Figure::Map;
    if !MEASURES.contains(&measure) {
        return Err(FigureError::measure(figure, measure, &MEASURES));
    }
    let profile = named.profile;
    let places = profile
        .points
        .iter()
        .map(|p| (p.latitude_deg, p.longitude_deg));
    let Some(bounds) = Bounds::around(places, map.margin_deg()) else {
        let reason = "the region has no point";
        return Err(FigureError::Nothing { figure, reason });
    };
    let name = |p: &PointMetrics| p.name.as_deref().unwrap_or_default().to_owned();
    let cell = |p: &PointMetrics| (p.longitude_deg, p.latitude_deg, at_point(measure, p));
    let chart = MapChart {
        title: title(named),
        label: measure.label().to_owned(),
        cells: profile.points.iter().map(cell).collect(),
        names: match map.tiling {
            Some(_) => Vec::new(),
            None => profile.points.iter().map(name).collect(),
        },
        map: map.clone(),
        bounds,
    };
    Ok(Plate {
        csv: table(&profile.points)?,
        chart: Chart::Map(chart),
    })
}

/// Name and notation.
fn title(named: &NamedProfile<'_>) -> String {
    if named.name == named.notation {
        return named.name.clone();
    }
    format!("{} ({})", named.name, named.notation)
}

fn table(points: &[PointMetrics]) -> Result<String, FigureError> {
    let mut csv = Csv::new(&[
        "latitude_deg",
        "longitude_deg",
        "mean_visible",
        "mean_pdop",
        "p95_pdop",
        "max_pdop",
        "solved_fraction",
        "availability",
        "name",
    ])?;
    for p in points {
        csv.row([
            p.latitude_deg.to_string(),
            p.longitude_deg.to_string(),
            p.mean_visible.to_string(),
            optional(p.mean_pdop),
            optional(p.p95_pdop),
            optional(p.max_pdop),
            p.solved_fraction.to_string(),
            p.availability.to_string(),
            p.name.as_deref().unwrap_or_default().to_owned(),
        ])?;
    }
    csv.text()
}

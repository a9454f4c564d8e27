//! A measure over the region.

use super::table::{Csv, optional};
use super::{
    Axis, Chart, Figure, FigureError, MapChart, Measure, NamedProfile, Plate, Projection, title,
};
use crate::evaluate::{COVERAGE_COLUMNS, PointMetrics};
use crate::ground::RegionMap;
use crate::keyword::Keyword;
use crate::report::coastline::Bounds;
use crate::report::profile::Profile;

/// Measures that a map does not show.
const NOT_OF_POINTS: [Measure; 1] = [Measure::Pdop];

/// The value of a measure at a point; `None` for PDOP without a solution.
#[must_use]
pub(in crate::report) fn at_point(measure: Measure, point: &PointMetrics) -> Option<f64> {
    if let Some(least) = measure.coverage_level() {
        return point.coverage.of(least);
    }
    match measure {
        Measure::MeanVisible => Some(point.mean_visible),
        Measure::P95Pdop => point.p95_pdop,
        Measure::MaxPdop => point.max_pdop,
        Measure::Availability => Some(point.availability),
        Measure::LongestOutageS => Some(point.longest_outage_s),
        Measure::GainMeanPdop => point.gain_mean_pdop,
        _ => point.mean_pdop,
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
    if NOT_OF_POINTS.contains(&measure) {
        let choices = Measure::ALL.iter().copied();
        let choices: Vec<_> = choices.filter(|one| !NOT_OF_POINTS.contains(one)).collect();
        return Err(FigureError::measure(figure, measure, &choices));
    }
    let profile = named.profile;
    let places = profile
        .points
        .iter()
        .map(|p| (p.latitude_deg, p.longitude_deg));
    let margin_deg = match map.tiling {
        Some(_) => map.margin_deg(),
        None => margin_of_sites(profile),
    };
    let Some(bounds) = Bounds::around(places, margin_deg) else {
        let reason = "the region has no point";
        return Err(FigureError::Nothing { figure, reason });
    };
    let name = |p: &PointMetrics| p.name.as_deref().unwrap_or_default().to_owned();
    let value = |n: usize, p: &PointMetrics| match (measure, profile.one_lost.get(n)) {
        (Measure::OneLostMaxPdop, lost) => lost.and_then(|of| of.max_pdop),
        (Measure::OneLostAvailability, lost) => lost.map(|of| of.availability),
        _ => at_point(measure, p),
    };
    let cell = |(n, p): (usize, &PointMetrics)| (p.longitude_deg, p.latitude_deg, value(n, p));
    let chart = MapChart {
        title: title(named),
        colours: Axis::new(measure.label()),
        better: measure.better(),
        projection: usual_projection(&bounds),
        cells: profile.points.iter().enumerate().map(cell).collect(),
        names: match map.tiling {
            Some(_) => Vec::new(),
            None => profile.points.iter().map(name).collect(),
        },
        map: map.clone(),
        bounds,
    };
    Ok(Plate {
        csv: table(profile)?,
        chart: Chart::Map(chart),
    })
}

/// The globe has areas in proportion, a region degrees.
fn usual_projection(bounds: &Bounds) -> Projection {
    let span = |[low, high]: [f64; 2]| high - low;
    if span(bounds.longitude_deg) >= 270.0 && span(bounds.latitude_deg) >= 100.0 {
        Projection::EqualEarth
    } else {
        Projection::PlateCarree
    }
}

/// Degrees around sites: a part of their extent, and at least what the coastline resolves.
fn margin_of_sites(profile: &Profile) -> f64 {
    const SHARE: f64 = 0.2;
    const RANGE_DEG: [f64; 2] = [1.0, 10.0];
    let extent = |of: fn(&PointMetrics) -> f64| {
        let values = profile.points.iter().map(of);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        (high - low).max(0.0)
    };
    let largest = extent(|p| p.latitude_deg).max(extent(|p| p.longitude_deg));
    (SHARE * largest).clamp(RANGE_DEG[0], RANGE_DEG[1])
}

fn table(profile: &Profile) -> Result<String, FigureError> {
    let before = [
        "latitude_deg",
        "longitude_deg",
        "mean_visible",
        "mean_pdop",
        "p95_pdop",
        "max_pdop",
        "solved_fraction",
        "availability",
        "longest_outage_s",
        "gain_mean_pdop",
    ];
    let one_lost: &[&str] = match profile.one_lost.as_slice() {
        [] => &[],
        _ => &["n1_max_pdop", "n1_availability"],
    };
    let mut csv = Csv::new(&[&before[..], &COVERAGE_COLUMNS, one_lost, &["name"]].concat())?;
    for (n, p) in profile.points.iter().enumerate() {
        let numbers = [
            Some(p.latitude_deg),
            Some(p.longitude_deg),
            Some(p.mean_visible),
            p.mean_pdop,
            p.p95_pdop,
            p.max_pdop,
            Some(p.solved_fraction),
            Some(p.availability),
            Some(p.longest_outage_s),
            p.gain_mean_pdop,
        ];
        let coverage = p.coverage.shares().map(Some);
        let lost = profile.one_lost.get(n);
        let lost = lost.map(|of| [of.max_pdop, Some(of.availability)]);
        let numbers = numbers.into_iter().chain(coverage);
        let cells = numbers.chain(lost.into_iter().flatten()).map(optional);
        let name = p.name.as_deref().unwrap_or_default().to_owned();
        csv.row(cells.chain([name]))?;
    }
    csv.text()
}

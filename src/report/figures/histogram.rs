//! How often so many satellites are in view.

use super::table::Csv;
use super::{
    Axis, Chart, Figure, FigureError, Layer, MeasureAxis, NamedProfile, PlaneChart, Plate, Style,
};
use crate::evaluate::HistogramRow;

/// The histograms of the satellites in view over all points and instants: of LEO and of all for each constellation, and of
/// the GNSS.
///
/// # Errors
/// If there is no constellation.
pub fn histogram(designs: &[NamedProfile<'_>]) -> Result<Plate, FigureError> {
    let Some(first) = designs.first() else {
        return Err(FigureError::Nothing {
            figure: Figure::Histogram,
            reason: "there is no constellation",
        });
    };
    let mut csv = Csv::new(&["design", "satellites", "leo", "gnss", "all", "name"])?;
    let mut layers = Vec::new();
    for (n, named) in designs.iter().enumerate() {
        let rows = named.profile.histograms.rows();
        for row in &rows {
            csv.row([
                named.notation.clone(),
                row.satellites.to_string(),
                row.leo.to_string(),
                row.gnss.to_string(),
                row.all.to_string(),
                named.name.clone(),
            ])?;
        }
        let prefix = if designs.len() > 1 {
            format!("{}: ", named.name)
        } else {
            String::new()
        };
        layers.push(layer(format!("{prefix}LEO"), &rows, |row| row.leo, 2 * n));
        layers.push(layer(
            format!("{prefix}all"),
            &rows,
            |row| row.all,
            2 * n + 1,
        ));
    }
    let rows = first.profile.histograms.rows();
    layers.push(layer(
        "GNSS".to_owned(),
        &rows,
        |row| row.gnss,
        2 * designs.len(),
    ));
    let chart = PlaneChart {
        title: "Satellites in view".to_owned(),
        x: Axis {
            is_whole: true,
            ..Axis::new("satellites in view")
        },
        y: Axis::new("fraction of points and instants"),
        measure: MeasureAxis::Neither,
        layers,
    };
    Ok(Plate {
        chart: Chart::Plane(chart),
        csv: csv.text()?,
    })
}

/// A histogram as steps, from its first number to its last.
fn layer(
    name: String,
    rows: &[HistogramRow],
    share: fn(&HistogramRow) -> f64,
    colour: usize,
) -> Layer {
    let is_there = |row: &HistogramRow| share(row) > 0.0;
    let first = rows.iter().position(is_there).unwrap_or(0);
    let end = rows.iter().rposition(is_there).map_or(0, |last| last + 1);
    let mut points = vec![(rows[first].satellites as f64 - 0.5, 0.0)];
    for row in &rows[first..end] {
        let (centre, share) = (row.satellites as f64, share(row));
        points.extend([(centre - 0.5, share), (centre + 0.5, share)]);
    }
    points.push((points[points.len() - 1].0, 0.0));
    Layer {
        name,
        points,
        style: Style::Line(colour),
    }
}

//! Tables of values: CSV with one node of a lattice a line, in any order.

use super::RasterFileError;
use crate::ground::Raster;
use crate::printable::printable;

const PLACE: [&str; 2] = ["latitude_deg", "longitude_deg"];

/// How far nodes may be from their place in the lattice, in steps: the rounding of decimals.
const SLACK: f64 = 1e-3;

/// Whether a line is the header of a table of values.
pub(super) fn is_header(line: &str) -> bool {
    line.split(',').any(|name| name.trim() == PLACE[0])
}

/// The values in the column `value`.
pub(super) fn read(text: &str, value: &'static str) -> Result<Raster, RasterFileError> {
    let header: Vec<&str> = text.lines().next().unwrap_or_default().split(',').collect();
    let names = [PLACE[0], PLACE[1], value];
    let mut columns = [0; 3];
    for (column, name) in columns.iter_mut().zip(names) {
        let found = header.iter().position(|known| known.trim() == name);
        *column = found.ok_or_else(|| RasterFileError::Line {
            line: 1,
            reason: format!("there is no column {name}"),
        })?;
    }
    let mut nodes: Vec<[f64; 3]> = Vec::new();
    for (line, text) in (1..).zip(text.lines()).skip(1) {
        if text.trim().is_empty() {
            continue;
        }
        let fields: Vec<&str> = text.split(',').collect();
        let mut node = [0.0; 3];
        for ((number_of, column), name) in node.iter_mut().zip(columns).zip(names) {
            let field = fields.get(column).map_or("", |field| field.trim());
            let number = field
                .parse::<f64>()
                .ok()
                .filter(|number| number.is_finite());
            // An empty value is a hole.
            let number = number.or((name == value && field.is_empty()).then_some(f64::NAN));
            *number_of = number.ok_or_else(|| {
                let field = printable(field);
                let reason = format!("{name}: found \"{field}\", expected a number");
                RasterFileError::Line { line, reason }
            })?;
        }
        nodes.push(node);
    }
    lattice(&nodes)
}

/// The values of a coordinate: the first and the step of at least two.
fn axis(nodes: &[[f64; 3]], at: usize) -> Result<(f64, f64, usize), RasterFileError> {
    let mut values: Vec<f64> = nodes.iter().map(|node| node[at]).collect();
    values.sort_by(f64::total_cmp);
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else {
        return Err(RasterFileError::Irregular("there are no points".to_owned()));
    };
    let gaps = values.windows(2).map(|pair| pair[1] - pair[0]);
    // Equal values may differ by rounding, which is far below any step.
    let widest = last - first;
    let step = gaps
        .filter(|gap| *gap > 1e-7 * widest)
        .fold(f64::INFINITY, f64::min);
    let name = PLACE[at];
    if !(step.is_finite() && step > 0.0) {
        let reason = format!("there is one {name} only, {first}");
        return Err(RasterFileError::Irregular(reason));
    }
    let count = (widest / step).round();
    if count >= 1e6 {
        let reason = format!("{name} has steps as small as {step}");
        return Err(RasterFileError::Irregular(reason));
    }
    // The mean step has no rounding of single decimals.
    Ok((first, widest / count, count as usize + 1))
}

fn lattice(nodes: &[[f64; 3]]) -> Result<Raster, RasterFileError> {
    let (south, north_step, rows) = axis(nodes, 0)?;
    let (west, east_step, columns) = axis(nodes, 1)?;
    if rows * columns != nodes.len() {
        let reason = format!("found {} points, expected {rows} x {columns}", nodes.len());
        return Err(RasterFileError::Irregular(reason));
    }
    let mut heights = vec![None; nodes.len()];
    for &[latitude_deg, longitude_deg, height_m] in nodes {
        let place = [
            (latitude_deg - south) / north_step,
            (longitude_deg - west) / east_step,
        ];
        let told = |what: &str| {
            let place = format!("latitude {latitude_deg}, longitude {longitude_deg} {what}");
            RasterFileError::Irregular(place)
        };
        if place.iter().any(|at| (at - at.round()).abs() > SLACK) {
            return Err(told("is between the others"));
        }
        let at = place[0].round() as usize * columns + place[1].round() as usize;
        if heights[at].replace(height_m as f32).is_some() {
            return Err(told("is given twice"));
        }
    }
    let heights = heights.into_iter().map(|height| height.unwrap_or(f32::NAN));
    Ok(Raster::new(
        [south, west],
        [north_step, east_step],
        columns,
        heights.collect(),
    )?)
}

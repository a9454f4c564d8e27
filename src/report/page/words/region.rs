//! What a region is, in a clause.

use crate::ground::AreaPoints;
use crate::scenario::{Region, Scenario};
use crate::units::round_decimal;

/// The region, to follow "over".
pub(super) fn region(scenario: &Scenario) -> String {
    let region = &scenario.region;
    match region {
        Region::Grid(grid) => {
            let [dlat, dlon] = grid.step_deg;
            let limits = limits(grid.latitude_deg, grid.longitude_deg);
            format!("{limits} on a {dlat}\u{b0} by {dlon}\u{b0} grid")
        }
        Region::Cells(cells) => {
            let limits = limits(cells.latitude_deg, cells.longitude_deg);
            format!("{limits} {}", equal_area(cells.spacing_km))
        }
        Region::Area { points, .. } => {
            let points = match points {
                AreaPoints::Lattice {
                    step_deg: [dlat, dlon],
                    ..
                } => format!("on a {dlat}\u{b0} by {dlon}\u{b0} grid"),
                AreaPoints::Cells { spacing_km } => equal_area(*spacing_km),
            };
            format!("{} {points}", region.told())
        }
        Region::Points { .. } => region.told(),
    }
}

fn equal_area(spacing_km: f64) -> String {
    format!("on cells of equal area of about {spacing_km} km by {spacing_km} km")
}

fn limits([south, north]: [f64; 2], [west, east]: [f64; 2]) -> String {
    format!(
        "{} to {} and {} to {}",
        latitude_label(south),
        latitude_label(north),
        longitude_label(west),
        longitude_label(east)
    )
}

fn latitude_label(degrees: f64) -> String {
    hemisphere(degrees, 'N', 'S')
}

fn longitude_label(degrees: f64) -> String {
    let wrapped = crate::units::wrap_360(degrees);
    let east = if wrapped > 180.0 {
        wrapped - 360.0
    } else {
        wrapped
    };
    hemisphere(east, 'E', 'W')
}

/// `53° N`, `10° W`, and `0°` without a hemisphere.
fn hemisphere(degrees: f64, positive: char, negative: char) -> String {
    let size = round_decimal(degrees.abs(), 6);
    if size == 0.0 {
        return "0\u{b0}".to_owned();
    }
    let letter = if degrees > 0.0 { positive } else { negative };
    format!("{size}\u{b0} {letter}")
}

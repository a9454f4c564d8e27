//! Places and times for the figures of the page: the region and the globe.

use super::interval;
use crate::earth::{GMST_RATE_RAD_S, RADIUS_KM};
use crate::evaluate::Setup;
use crate::ground::{CellRow, Site, Tiling};
use crate::report::coastline::{self, Bounds};
use crate::report::page::pack::{Packed, short};
use crate::scenario::Scenario;
use crate::visibility::MaskTable;
use chrono::{DateTime, Timelike, Utc};
use serde::Serialize;

/// Most skylines that a page holds.
const MOST_SKYLINES: usize = 500;

#[derive(Serialize)]
pub(super) struct RegionData {
    latitude_deg: Vec<f64>,
    longitude_deg: Vec<f64>,
    /// Names of the points; empty for those without one.
    name: Vec<String>,
    /// Steps in latitude and longitude, of a grid.
    step_deg: Option<[f64; 2]>,
    /// The rows of cells of equal area: south and north edge and width of a cell.
    rows_deg: Vec<[f64; 3]>,
    /// The row of each point, of cells of equal area.
    row: Vec<usize>,
    /// Whether the points fill a rectangle of latitude and longitude.
    is_rectangle: bool,
    bounds: [f64; 4],
    coast: Vec<Vec<i32>>,
    /// The borders of an area.
    border: Vec<Vec<i32>>,
    elapsed_h: Packed,
    availability_pdop: f64,
}

#[derive(Serialize)]
pub(super) struct World {
    coast: Vec<Vec<i32>>,
    /// UTC; during a leap second, the second before it, since browsers cannot read second 60.
    epoch: String,
    /// Seconds from the epoch to the beginning of each leap second of the span.
    leap_seconds_s: Vec<f64>,
    gmst_deg: f64,
    gmst_rate_deg_s: f64,
    radius_km: f64,
    flattening: f64,
    mask_deg: f64,
    gnss_mask_deg: f64,
    /// Skylines: azimuth and elevation, degrees, over a full turn.
    skylines_deg: Vec<Vec<[f64; 2]>>,
    /// The skyline of each point, an index; empty if all have the same, or there are none.
    skyline_of: Vec<Option<usize>>,
}

/// Polylines as longitudes and latitudes in hundredths of a degree.
fn hundredths(lines: Vec<Vec<[f64; 2]>>) -> Vec<Vec<i32>> {
    let whole = |x: f64| (100.0 * x).round() as i32;
    let flat = |line: Vec<[f64; 2]>| line.into_iter().flatten().map(whole).collect();
    lines.into_iter().map(flat).collect()
}

fn name_of(site: &Site) -> String {
    site.name.as_deref().unwrap_or_default().to_owned()
}

impl RegionData {
    pub(super) fn new(setup: &Setup) -> Option<Self> {
        let map = &setup.map;
        let rows: &[CellRow] = match &map.tiling {
            Some(Tiling::Rows(rows)) => rows,
            _ => &[],
        };
        let row_of = |site: &Site| map.tiling.as_ref()?.row(site.latitude_deg);
        let places = setup
            .sites
            .iter()
            .map(|s| (s.latitude_deg, s.longitude_deg));
        let bounds = Bounds::around(places, map.margin_deg())?;
        let times: Vec<f64> = setup.grid.iter().collect();
        let starts = times.iter().step_by(interval(times.len()));
        Some(Self {
            latitude_deg: setup.sites.iter().map(|s| short(s.latitude_deg)).collect(),
            longitude_deg: setup.sites.iter().map(|s| short(s.longitude_deg)).collect(),
            name: match map.tiling {
                Some(_) => Vec::new(),
                None => setup.sites.iter().map(name_of).collect(),
            },
            step_deg: map.step_deg(),
            rows_deg: rows
                .iter()
                .map(|row| [row.edges_deg[0], row.edges_deg[1], row.width_deg])
                .collect(),
            row: setup.sites.iter().filter_map(row_of).collect(),
            is_rectangle: map.rectangle.is_some(),
            bounds: [
                bounds.latitude_deg[0],
                bounds.latitude_deg[1],
                bounds.longitude_deg[0],
                bounds.longitude_deg[1],
            ],
            coast: hundredths(coastline::within(&bounds)),
            border: hundredths(coastline::lines_within(&map.outlines, &bounds)),
            elapsed_h: Packed::of(starts.map(|t| t / crate::units::SECONDS_PER_HOUR)),
            availability_pdop: setup.metrics.availability_pdop,
        })
    }
}

/// The skylines of the points, each once, and that of each point.
fn skylines(setup: &Setup) -> (Vec<Vec<[f64; 2]>>, Vec<Option<usize>>) {
    let mut known: Vec<&MaskTable> = Vec::new();
    let mut of_points = Vec::with_capacity(setup.sites.len());
    for point in 0..setup.sites.len() {
        let Some(skyline) = setup.skyline_at(point) else {
            of_points.push(None);
            continue;
        };
        // Points one after the other have the same, or each its own.
        let same = known.last().is_some_and(|last| *last == skyline);
        if !same && known.len() < MOST_SKYLINES {
            known.push(skyline);
        }
        let is_known = same || known.last().is_some_and(|last| *last == skyline);
        of_points.push(is_known.then(|| known.len() - 1));
    }
    if known.len() < 2 && of_points.iter().all(Option::is_some) {
        of_points.clear();
    }
    let hundredth = |degrees: f64| (100.0 * degrees).round() / 100.0;
    let vertices = |skyline: &MaskTable| {
        let vertices = skyline.vertices().iter();
        vertices
            .map(|&(a, e)| [hundredth(a), hundredth(e)])
            .collect()
    };
    (known.into_iter().map(vertices).collect(), of_points)
}

/// A UTC date and time with seconds up to 59, since browsers cannot read second 60, which chrono writes as
/// second 59 with 1e9 nanoseconds or more.
fn readable_by_browsers(utc: DateTime<Utc>) -> String {
    let within_second = utc.with_nanosecond(utc.nanosecond() % 1_000_000_000);
    let format = "%Y-%m-%dT%H:%M:%S%.3fZ";
    within_second.unwrap_or(utc).format(format).to_string()
}

impl World {
    pub(super) fn new(setup: &Setup, scenario: &Scenario) -> Self {
        let grid = setup.grid;
        let (skylines_deg, skyline_of) = skylines(setup);
        Self {
            coast: hundredths(coastline::world()),
            epoch: readable_by_browsers(scenario.time.epoch),
            leap_seconds_s: grid
                .epoch()
                .leap_seconds_within(grid.step_s() * grid.len() as f64),
            gmst_deg: grid.epoch().gmst_rad(0.0).to_degrees(),
            gmst_rate_deg_s: GMST_RATE_RAD_S.to_degrees(),
            radius_km: RADIUS_KM,
            flattening: scenario.earth.surface.flattening(),
            mask_deg: setup.mask.degrees(),
            gnss_mask_deg: setup.gnss_mask.degrees(),
            skylines_deg,
            skyline_of,
        }
    }
}

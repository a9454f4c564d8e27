//! A measure over a region, with coastlines and a colour scale.

mod names;
mod scale;

use super::frame::{PlotFrame, clipped, x_labels_height, y_labels_width};
use super::heading::Heading;
use super::marks::Mark;
use super::projection::Plane;
use super::ruler::Ruler;
use super::sheet::{Sheet, line, points};
use super::{Area, Drawn, INK};
use crate::report::coastline;
use crate::report::figures::{MapChart, Projection};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Colour of a missing value.
const NOTHING: RGBColor = RGBColor(205, 205, 205);

/// Colour of coasts, and of parallels and meridians.
const COAST: RGBColor = RGBColor(60, 60, 60);
const GRATICULE: RGBColor = RGBColor(150, 150, 150);

/// How far a cell reaches under its neighbours to the east and north, points: no renderer leaves a seam.
const OVERLAP: f64 = 0.5;

/// Most ticks of the colour scale.
const SCALE_TICKS: usize = 7;

/// Greatest height of a map by the width of the sheet.
const TALLEST: f64 = 1.1;

/// A map lower than this may have decimals at its parallels, degrees.
const FINE_DEG: f64 = 8.0;

/// Radius of a site in heights of the text.
const SITE: f64 = 0.4;

/// Where the parts of the figure are.
struct Layout {
    frame: PlotFrame,
    plane: Plane,
    colours: Ruler,
    height: i32,
}

fn layout(chart: &MapChart, sheet: Sheet) -> Layout {
    let values = || chart.cells.iter().filter_map(|cell| cell.2);
    let colours = Ruler::new(&chart.colours, values(), SCALE_TICKS, true);
    let plane = Plane::new(chart.projection, chart.bounds);
    let left = sheet.em(
        if chart.bounds.latitude_deg[1] - chart.bounds.latitude_deg[0] < FINE_DEG {
            5.0
        } else {
            3.6
        },
    );
    let width = sheet.width() as i32;
    let beside = scale::width(sheet) + y_labels_width(&colours, sheet);
    let most = (width - left - beside).max(sheet.em(6.0));
    let tallest = (TALLEST * f64::from(width)) as i32;
    let height = ((f64::from(most) * plane.aspect()) as i32).clamp(sheet.em(6.0), tallest);
    let across = ((f64::from(height) / plane.aspect()) as i32).min(most);
    // Room for the points of the colour scale and the half of a number.
    let top = heading(chart).height(sheet) + sheet.em(0.8);
    Layout {
        frame: PlotFrame {
            left,
            right: left + across,
            top,
            bottom: top + height,
        },
        plane,
        colours,
        height: top + height + x_labels_height(sheet) - sheet.em(0.6),
    }
}

pub(super) fn height(chart: &MapChart, sheet: Sheet) -> u32 {
    layout(chart, sheet).height as u32
}

fn heading(chart: &MapChart) -> Heading<'_> {
    let mut entries = Vec::new();
    if chart.cells.iter().any(|cell| cell.2.is_none()) {
        entries.push((Mark::Patch(NOTHING), "no value".to_owned()));
    }
    if !chart.map.outlines.is_empty() {
        entries.push((Mark::Border, "border of the area".to_owned()));
    }
    Heading {
        title: &chart.title,
        entries,
    }
}

pub(super) fn draw(area: &Area<'_>, chart: &MapChart, sheet: Sheet) -> Drawn {
    heading(chart).draw(area, sheet)?;
    let layout = layout(chart, sheet);
    let colour = |value: Option<f64>| match value {
        Some(value) => super::palette::shade(layout.colours.share(value), chart.better),
        None => NOTHING,
    };
    layout.draw_cells(area, chart, colour)?;
    layout.draw_graticule(area, chart, sheet)?;
    let coasts = match chart.projection {
        Projection::PlateCarree => coastline::within(&chart.bounds),
        // Small islands would be specks.
        Projection::EqualEarth => coastline::lines_within(&coastline::world(), &chart.bounds),
    };
    layout.draw_lines(area, chart, &coasts, line(COAST, 0.5))?;
    let borders = coastline::lines_within(&chart.map.outlines, &chart.bounds);
    layout.draw_lines(area, chart, &borders, line(INK, 1.2))?;
    layout.draw_border(area)?;
    if chart.map.tiling.is_none() {
        let at = |cell: &(f64, f64, Option<f64>)| layout.at([cell.0, cell.1]);
        for cell in &chart.cells {
            let radius = sheet.em(SITE);
            area.draw(&Circle::new(at(cell), radius, colour(cell.2).filled()))?;
            area.draw(&Circle::new(at(cell), radius, line(INK, 0.7)))?;
        }
        let places: Vec<_> = chart.cells.iter().map(at).collect();
        names::draw(area, &layout.frame, (&places, &chart.names), sheet)?;
    }
    if chart.cells.iter().any(|cell| cell.2.is_some()) {
        scale::draw(area, (&layout.frame, &layout.colours), chart, sheet)?;
    }
    Ok(())
}

impl Layout {
    /// The place of a longitude and latitude in the drawing.
    fn at(&self, place: [f64; 2]) -> (i32, i32) {
        let (x, y) = self.plane.share(place);
        (self.frame.across(x), self.frame.up(y))
    }

    /// The cells from the south-west, each over the overlap of those before.
    fn draw_cells(
        &self,
        area: &Area<'_>,
        chart: &MapChart,
        colour: impl Fn(Option<f64>) -> RGBColor,
    ) -> Drawn {
        let Some(tiling) = &chart.map.tiling else {
            return Ok(());
        };
        let [south, north] = chart.bounds.latitude_deg;
        let [west, east] = chart.bounds.longitude_deg;
        let per_unit = (north - south) / f64::from(self.frame.bottom - self.frame.top);
        let overlap_deg = f64::from(points(OVERLAP)) * per_unit;
        let mut cells: Vec<([[f64; 2]; 2], Option<f64>)> = chart
            .cells
            .iter()
            .map(|&(x, y, value)| (tiling.cell([x, y]), value))
            .collect();
        cells.sort_by(|([a, _], _), ([b, _], _)| {
            let rows = a[1].total_cmp(&b[1]);
            rows.then(a[0].total_cmp(&b[0]))
        });
        for ([low, high], value) in cells {
            let across = [low[0].max(west), (high[0] + overlap_deg).min(east)];
            let up = [low[1].max(south), (high[1] + overlap_deg).min(north)];
            let ring = self
                .plane
                .ring(across, up)
                .into_iter()
                .map(|place| self.at(place));
            area.draw(&Polygon::new(
                ring.collect::<Vec<_>>(),
                colour(value).filled(),
            ))?;
        }
        Ok(())
    }

    /// Lines of longitude and latitude, cut at the border of the map.
    fn draw_lines(
        &self,
        area: &Area<'_>,
        chart: &MapChart,
        lines: &[Vec<[f64; 2]>],
        style: ShapeStyle,
    ) -> Drawn {
        let [south, north] = chart.bounds.latitude_deg;
        let [west, east] = chart.bounds.longitude_deg;
        let share =
            |&[x, y]: &[f64; 2]| ((x - west) / (east - west), (y - south) / (north - south));
        let place =
            |(x, y): (f64, f64)| self.at([west + x * (east - west), south + y * (north - south)]);
        for one in lines {
            for part in clipped(one.iter().map(share)) {
                let mut through: Vec<_> = part.into_iter().map(place).collect();
                through.dedup();
                if through.len() > 1 {
                    area.draw(&PathElement::new(through, style))?;
                }
            }
        }
        Ok(())
    }

    fn draw_border(&self, area: &Area<'_>) -> Drawn {
        let ring = self.plane.border().into_iter().map(|place| self.at(place));
        area.draw(&PathElement::new(ring.collect::<Vec<_>>(), line(INK, 0.6)))
    }

    /// Parallels and meridians at round degrees, with their numbers at the west and the south.
    fn draw_graticule(&self, area: &Area<'_>, chart: &MapChart, sheet: Sheet) -> Drawn {
        let [south, north] = chart.bounds.latitude_deg;
        let [west, east] = chart.bounds.longitude_deg;
        let room = |length: i32, each: f64| (length / sheet.em(each)).clamp(1, 12);
        let up = degrees(north - south, room(self.frame.bottom - self.frame.top, 2.5));
        let across = degrees(east - west, room(self.frame.right - self.frame.left, 5.5));
        let fine = line(GRATICULE, 0.35);
        let is_globe = chart.projection == Projection::EqualEarth;
        let mut end = i32::MAX;
        for latitude in multiples(up, south, north) {
            let parallel = [[west, latitude], [east, latitude]];
            self.draw_lines(area, chart, &[parallel.to_vec()], fine)?;
            let (x, y) = self.at([west, latitude]);
            if y + sheet.em(1.1) > end {
                continue;
            }
            end = y;
            let at = (x - sheet.em(0.4), y);
            let side = Pos::new(HPos::Right, VPos::Center);
            let text = named(latitude, ['N', 'S'], up);
            area.draw(&Text::new(text, at, sheet.font().pos(side)))?;
        }
        let mut end = i32::MIN;
        for longitude in multiples(across, west, east) {
            let mut meridian = self.plane.edge([longitude, south], [longitude, north]);
            meridian.push([longitude, north]);
            self.draw_lines(area, chart, &[meridian], fine)?;
            let (x, y) = self.at([longitude, south]);
            let text = named(wrapped(longitude), ['E', 'W'], across);
            let half = sheet.text_width(&text, 1.0) / 2;
            // On the globe only every other fits under the short line of the pole.
            if x - half < end || (is_globe && (longitude / across).round() % 2.0 != 0.0) {
                continue;
            }
            end = x + half + sheet.em(0.6);
            let below = Pos::new(HPos::Center, VPos::Top);
            area.draw(&Text::new(
                text,
                (x, y + sheet.em(0.5)),
                sheet.font().pos(below),
            ))?;
        }
        Ok(())
    }
}

/// Round degrees between lines, so that a span has at most so many.
fn degrees(span: f64, most: i32) -> f64 {
    const ROUND: [f64; 15] = [
        0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 60.0, 90.0,
    ];
    let found = ROUND
        .into_iter()
        .find(|step| span / step <= f64::from(most));
    found.unwrap_or(90.0)
}

fn multiples(step: f64, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let first = (low / step - 1e-9).ceil() as i64;
    let last = (high / step + 1e-9).floor() as i64;
    (first..=last).map(move |n| n as f64 * step)
}

/// A longitude from -180° to 180°.
fn wrapped(longitude_deg: f64) -> f64 {
    let turned = longitude_deg.rem_euclid(360.0);
    if turned > 180.0 {
        turned - 360.0
    } else {
        turned
    }
}

/// Degrees with the letter of their side.
fn named(degrees: f64, [plus, minus]: [char; 2], step: f64) -> String {
    let decimals = if step >= 1.0 {
        0
    } else if step >= 0.1 {
        1
    } else {
        2
    };
    let size = format!("{:.decimals$}°", degrees.abs());
    match degrees {
        d if d.abs() < 1e-9 || (d.abs() - 180.0).abs() < 1e-9 => size,
        d if d > 0.0 => format!("{size} {plus}"),
        _ => format!("{size} {minus}"),
    }
}

//! A measure over a region, with coastlines and a colour scale.

use super::{Area, Drawn, INK, decimals, fine, font, line, signed};
use crate::report::coastline;
use crate::report::figures::MapChart;
use plotters::prelude::*;
use plotters::style::colors::colormaps::ViridisRGB;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Space for the colour scale.
const SCALE_WIDTH: u32 = 96;

/// Margins of the map.
const TITLE: u32 = 34;
const MARGIN: u32 = 12;
const X_LABELS: u32 = 44;
const Y_LABELS: u32 = 56;

/// Colour of a missing value.
const NOTHING: RGBColor = RGBColor(215, 215, 215);

/// Most names on a map.
const MOST_NAMES: usize = 60;

/// Range of heights in which a map is readable.
const HEIGHTS: std::ops::RangeInclusive<f64> = 260.0..=900.0;

/// The height at which degrees of latitude and longitude have equal scale at the centre of the map.
pub(super) fn height(chart: &MapChart, width: u32) -> u32 {
    let [south, north] = chart.bounds.latitude_deg;
    let [west, east] = chart.bounds.longitude_deg;
    let middle = ((south + north) / 2.0).to_radians();
    let inner_width = f64::from(width - SCALE_WIDTH - 2 * MARGIN - Y_LABELS);
    let inner = inner_width * (north - south) / ((east - west) * middle.cos().max(0.1));
    let whole = inner + f64::from(TITLE + 2 * MARGIN + X_LABELS);
    whole.clamp(*HEIGHTS.start(), *HEIGHTS.end()) as u32
}

pub(super) fn draw(root: &Area<'_>, chart: &MapChart) -> Drawn {
    let (width, _) = root.dim_in_pixel();
    let (left, right) = root.split_horizontally(width - fine(SCALE_WIDTH));
    let values = chart.cells.iter().filter_map(|cell| cell.2);
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
        (lo.min(x), hi.max(x))
    });
    let range = match (lo > hi, lo == hi) {
        (true, _) => 0.0..1.0,
        (_, true) => lo - 0.01 * lo.abs().max(1e-3)..lo + 0.01 * lo.abs().max(1e-3),
        _ => lo..hi,
    };
    region(&left, chart, &range)?;
    if lo <= hi {
        colours(&right, chart, &range)?;
    }
    Ok(())
}

fn region(area: &Area<'_>, chart: &MapChart, range: &std::ops::Range<f64>) -> Drawn {
    let [south, north] = chart.bounds.latitude_deg;
    let [west, east] = chart.bounds.longitude_deg;
    let mut context = ChartBuilder::on(area)
        .caption(&chart.title, font(17))
        .margin(fine(MARGIN))
        .x_label_area_size(fine(X_LABELS))
        .y_label_area_size(fine(Y_LABELS))
        .build_cartesian_2d(west..east, south..north)?;
    let paint = |value: Option<f64>| match value {
        Some(value) => ViridisRGB::get_color_normalized(value, range.start, range.end),
        None => NOTHING,
    };
    match &chart.map.tiling {
        Some(tiling) => {
            let cell = |&(x, y, value): &(f64, f64, Option<f64>)| {
                let [low, high] = tiling.cell([x, y]);
                let low = (low[0], low[1].max(south));
                let high = (high[0], high[1].min(north));
                Rectangle::new([low, high], paint(value).filled())
            };
            context.draw_series(chart.cells.iter().map(cell))?;
        }
        None => {
            let dot = |&(x, y, value): &(f64, f64, Option<f64>)| {
                Circle::new((x, y), signed(5), paint(value).filled())
            };
            context.draw_series(chart.cells.iter().map(dot))?;
        }
    }
    let coast = line(BLACK, 1);
    for line in coastline::within(&chart.bounds) {
        let points = line.into_iter().map(|[x, y]| {
            // The last point of a coast may be outside the map.
            (x.clamp(west, east), y.clamp(south, north))
        });
        context.draw_series(LineSeries::new(points, coast))?;
    }
    let border = line(INK, 2);
    for line in coastline::lines_within(&chart.map.outlines, &chart.bounds) {
        let points = line
            .into_iter()
            .map(|[x, y]| (x.clamp(west, east), y.clamp(south, north)));
        context.draw_series(LineSeries::new(points, border))?;
    }
    if chart.names.len() <= MOST_NAMES {
        let named = chart.cells.iter().zip(&chart.names);
        let label = |(&(x, y, _), name): (&(f64, f64, Option<f64>), &String)| {
            let is_left = is_name_left((x, y), &chart.cells, [west, east]);
            let at = if is_left { HPos::Right } else { HPos::Left };
            let style = font(11).color(&BLACK).pos(Pos::new(at, VPos::Center));
            let aside = if is_left { -signed(8) } else { signed(8) };
            EmptyElement::at((x, y)) + Text::new(name.clone(), (aside, 0), style)
        };
        context.draw_series(named.map(label))?;
    }
    context
        .configure_mesh()
        .disable_mesh()
        .x_label_formatter(&|x| x.to_string())
        .y_label_formatter(&|y| y.to_string())
        .x_desc("longitude (\u{b0} E)")
        .y_desc("latitude (\u{b0} N)")
        .set_all_tick_mark_size(fine(4))
        .axis_style(line(INK, 1))
        .label_style(font(12))
        .axis_desc_style(font(14))
        .draw()
}

/// Steps of the colour scale.
const STEPS: u32 = 128;

fn colours(area: &Area<'_>, chart: &MapChart, range: &std::ops::Range<f64>) -> Drawn {
    let mut context = ChartBuilder::on(area)
        .margin_top(fine(TITLE + MARGIN / 2))
        .margin_bottom(fine(X_LABELS + MARGIN))
        .margin_right(fine(6))
        .set_label_area_size(LabelAreaPosition::Right, fine(64))
        .build_cartesian_2d(0.0..1.0, range.clone())?;
    let digits = decimals(range) + 1;
    let step = (range.end - range.start) / f64::from(STEPS);
    let band = |n: u32| {
        let low = range.start + f64::from(n) * step;
        let colour = ViridisRGB::get_color_normalized(low, range.start, range.end);
        Rectangle::new([(0.0, low), (1.0, low + step)], colour.filled())
    };
    context.draw_series((0..STEPS).map(band))?;
    context
        .configure_mesh()
        .disable_mesh()
        .disable_x_axis()
        .y_desc(&chart.label)
        .y_label_formatter(&|value| format!("{value:.digits$}"))
        .set_all_tick_mark_size(fine(4))
        .axis_style(line(INK, 1))
        .label_style(font(12))
        .axis_desc_style(font(13))
        .draw()
}

/// Whether the name of a mark is to its left: away from the nearest mark if that is close, or else where the mark is
/// in the east of the map, so that the name stays inside.
fn is_name_left(
    (x, y): (f64, f64),
    marks: &[(f64, f64, Option<f64>)],
    [west, east]: [f64; 2],
) -> bool {
    const CLOSE: f64 = 0.15;
    let distance = |mark: &&(f64, f64, Option<f64>)| (mark.0 - x).hypot(mark.1 - y);
    let others = marks.iter().filter(|mark| (mark.0, mark.1) != (x, y));
    match others.min_by(|a, b| distance(a).total_cmp(&distance(b))) {
        Some(near) if distance(&near) < CLOSE * (east - west) && near.0 != x => near.0 > x,
        _ => x > 0.5 * (west + east),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of two marks that are close, each has its name on the far side; one alone in the east has it on the left.
    #[test]
    fn names_keep_away_from_the_nearest_mark() {
        let marks = [
            (116.4, 39.9, None),
            (116.5, 39.9, None),
            (119.0, 42.0, None),
        ];
        let left = marks.map(|(x, y, _)| is_name_left((x, y), &marks, [113.0, 120.0]));
        assert_eq!(left, [true, false, true]);
    }
}

//! A measure over a region, with coastlines and a scale of colours.

use super::{Area, Drawn, INK, Scale};
use crate::report::coastline;
use crate::report::figures::MapChart;
use plotters::prelude::*;
use plotters::style::colors::colormaps::ViridisRGB;

/// Room for the scale of colours.
const SCALE_WIDTH: u32 = 96;

/// Room above, below and beside the map.
const TITLE: u32 = 34;
const MARGIN: u32 = 12;
const X_LABELS: u32 = 44;
const Y_LABELS: u32 = 56;

/// What has no value.
const NOTHING: RGBColor = RGBColor(215, 215, 215);

/// Heights between which a map stays readable.
const HEIGHTS: std::ops::RangeInclusive<f64> = 260.0..=900.0;

/// The height at which a degree is as long northwards as eastwards in the middle of the map.
pub(super) fn height(chart: &MapChart, width: u32) -> u32 {
    let [south, north] = chart.bounds.latitude_deg;
    let [west, east] = chart.bounds.longitude_deg;
    let middle = ((south + north) / 2.0).to_radians();
    let inner_width = f64::from(width - SCALE_WIDTH - 2 * MARGIN - Y_LABELS);
    let inner = inner_width * (north - south) / ((east - west) * middle.cos().max(0.1));
    let whole = inner + f64::from(TITLE + 2 * MARGIN + X_LABELS);
    whole.clamp(*HEIGHTS.start(), *HEIGHTS.end()) as u32
}

pub(super) fn draw<DB: DrawingBackend>(
    root: &Area<DB>,
    chart: &MapChart,
    scale: Scale,
) -> Drawn<DB> {
    let (width, _) = root.dim_in_pixel();
    let (left, right) = root.split_horizontally(width - scale.of(SCALE_WIDTH));
    let values = chart.cells.iter().filter_map(|cell| cell.2);
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
        (lo.min(x), hi.max(x))
    });
    let range = match (lo > hi, lo == hi) {
        (true, _) => 0.0..1.0,
        (_, true) => lo - 0.5 * lo.abs().max(1e-3)..lo + 0.5 * lo.abs().max(1e-3),
        _ => lo..hi,
    };
    region(&left, chart, &range, scale)?;
    if lo <= hi {
        colours(&right, chart, &range, scale)?;
    }
    Ok(())
}

fn region<DB: DrawingBackend>(
    area: &Area<DB>,
    chart: &MapChart,
    range: &std::ops::Range<f64>,
    scale: Scale,
) -> Drawn<DB> {
    let [south, north] = chart.bounds.latitude_deg;
    let [west, east] = chart.bounds.longitude_deg;
    let mut context = ChartBuilder::on(area)
        .caption(&chart.title, scale.font(17.0))
        .margin(scale.of(MARGIN))
        .x_label_area_size(scale.of(X_LABELS))
        .y_label_area_size(scale.of(Y_LABELS))
        .build_cartesian_2d(west..east, south..north)?;
    let paint = |value: Option<f64>| match value {
        Some(value) => ViridisRGB::get_color_normalized(value, range.start, range.end),
        None => NOTHING,
    };
    match chart.cell_deg {
        Some([height, width]) => {
            let cell = |&(x, y, value): &(f64, f64, Option<f64>)| {
                let (a, b) = (width / 2.0, height / 2.0);
                let low = (x - a, (y - b).max(south));
                let high = (x + a, (y + b).min(north));
                Rectangle::new([low, high], paint(value).filled())
            };
            context.draw_series(chart.cells.iter().map(cell))?;
        }
        None => {
            let dot = |&(x, y, value): &(f64, f64, Option<f64>)| {
                Circle::new((x, y), scale.signed(5), paint(value).filled())
            };
            context.draw_series(chart.cells.iter().map(dot))?;
        }
    }
    let coast = scale.line(BLACK, 1);
    for line in coastline::within(&chart.bounds) {
        let points = line.into_iter().map(|[x, y]| {
            // A coast may leave the map with its last point.
            (x.clamp(west, east), y.clamp(south, north))
        });
        context.draw_series(LineSeries::new(points, coast))?;
    }
    context
        .configure_mesh()
        .disable_mesh()
        .x_desc("longitude (\u{b0} E)")
        .y_desc("latitude (\u{b0} N)")
        .axis_style(scale.line(INK, 1))
        .label_style(scale.font(12.0))
        .axis_desc_style(scale.font(14.0))
        .draw()
}

/// Steps of the scale of colours.
const STEPS: u32 = 128;

fn colours<DB: DrawingBackend>(
    area: &Area<DB>,
    chart: &MapChart,
    range: &std::ops::Range<f64>,
    scale: Scale,
) -> Drawn<DB> {
    let mut context = ChartBuilder::on(area)
        .margin_top(scale.of(TITLE + MARGIN / 2))
        .margin_bottom(scale.of(X_LABELS + MARGIN))
        .margin_right(scale.of(6))
        .set_label_area_size(LabelAreaPosition::Right, scale.of(70))
        .build_cartesian_2d(0.0..1.0, range.clone())?;
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
        .axis_style(scale.line(INK, 1))
        .label_style(scale.font(12.0))
        .axis_desc_style(scale.font(13.0))
        .draw()
}

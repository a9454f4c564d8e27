//! The colours of a map, beside it and as high.

use super::super::frame::PlotFrame;
use super::super::palette::shade;
use super::super::ruler::Ruler;
use super::super::sheet::Sheet;
use super::super::{Area, Drawn};
use crate::report::figures::MapChart;
use plotters::prelude::*;

/// Steps of the colours: more than a printer or a screen tells apart.
const STEPS: u32 = 256;

/// Gap, width and label in heights of the text.
const GAP: f64 = 1.0;
const WIDTH: f64 = 1.1;
const LABEL: f64 = 1.4;

/// Height of the point of a scale with values beyond its end.
const POINT: f64 = 0.9;

/// Width of the gap, the colours and the label, without the numbers.
pub(super) fn width(sheet: Sheet) -> i32 {
    sheet.em(GAP + WIDTH + LABEL)
}

pub(super) fn draw(
    area: &Area<'_>,
    (map, colours): (&PlotFrame, &Ruler),
    chart: &MapChart,
    sheet: Sheet,
) -> Drawn {
    let left = map.right + sheet.em(GAP);
    let bar = PlotFrame {
        left,
        right: left + sheet.em(WIDTH),
        ..map.clone()
    };
    for n in 0..STEPS {
        // Each step reaches to the end, under those that follow: no renderer leaves a seam.
        let share = f64::from(n) / f64::from(STEPS);
        let colour = shade(share + 0.5 / f64::from(STEPS), chart.better);
        let corners = [(bar.left, bar.up(share)), (bar.right, bar.top)];
        area.draw(&Rectangle::new(corners, colour.filled()))?;
    }
    let shares = chart
        .cells
        .iter()
        .filter_map(|cell| Some(colours.share(cell.2?)));
    let (least, most) = shares.fold((0.0_f64, 1.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    let middle = (bar.left + bar.right) / 2;
    let slack = 1e-9;
    for (is_beyond, share, edge, away) in [
        (most > 1.0 + slack, 1.0, bar.top, -1),
        (least < -slack, 0.0, bar.bottom, 1),
    ] {
        if is_beyond {
            let tip = edge + away * sheet.em(POINT);
            let corners = vec![(bar.left, edge), (middle, tip), (bar.right, edge)];
            area.draw(&Polygon::new(corners, shade(share, chart.better).filled()))?;
        }
    }
    bar.draw_box(area)?;
    let label = format!("{} (light is better)", chart.colours.label);
    bar.draw_y(area, colours, (&label, false), sheet)
}

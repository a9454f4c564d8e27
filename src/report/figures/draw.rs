//! Charts as SVG and PNG, through plotters.
//!
//! No system font is read: text is set in Ubuntu Light, which comes with the library. PNG has
//! its shapes; SVG names a generic `sans-serif` and has its widths.

mod map;
mod plane;

use super::{BarChart, Chart, PlaneChart};
use crate::words::words;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use std::error::Error;
use std::io::Write;
use std::sync::Once;
use thiserror::Error;

words! {
    /// The form of a figure's file.
    Form {
        /// Scalable Vector Graphics.
        Svg = "svg",
        /// Portable Network Graphics, 300 dots per inch.
        Png = "png",
        /// The table behind the figure.
        Csv = "csv",
    }
}

/// Why a chart cannot be drawn.
#[derive(Debug, Error)]
pub enum DrawError {
    /// The drawing itself.
    #[error("cannot draw the figure")]
    Drawing(#[source] Box<dyn Error + Send + Sync>),
    /// The picture as a file.
    #[error("cannot encode the figure")]
    Encoding(#[from] png::EncodingError),
    /// Where it goes.
    #[error("cannot write the figure")]
    Write(#[from] std::io::Error),
}

/// Pixels of a PNG for each unit of a figure: 7.2 inches wide at 300 dots per inch.
const PNG_SCALE: u32 = 3;

/// Dots per metre of a PNG: 300 per inch.
const PNG_DOTS_PER_METRE: u32 = 11_811;

/// Width of a figure.
const WIDTH: u32 = 720;

/// Height of a figure other than a map.
const HEIGHT: u32 = 480;

/// Colours that the colour-blind tell apart: Okabe and Ito, *Color Universal Design* (2008).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

const INK: RGBColor = RGBColor(40, 40, 40);
const GRID: RGBColor = RGBColor(225, 225, 225);

type Area<DB> = DrawingArea<DB, Shift>;
type Drawn<DB> = Result<(), DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>>;

/// A length in units of the figure, as the backend counts.
#[derive(Clone, Copy)]
struct Scale(u32);

impl Scale {
    fn of(self, units: u32) -> u32 {
        units * self.0
    }

    fn signed(self, units: i32) -> i32 {
        units * i32::try_from(self.0).unwrap_or(1)
    }

    fn font(self, units: f64) -> TextStyle<'static> {
        let size = units * f64::from(self.0);
        ("sans-serif", size).into_font().color(&INK)
    }

    fn line(self, colour: RGBColor, units: u32) -> ShapeStyle {
        colour.stroke_width(self.of(units))
    }
}

/// The typeface for measuring and for PNG.
fn register_typeface() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let bytes = epaint_default_fonts::UBUNTU_LIGHT;
        // It fails for bytes that are no font; these are, and a test sets text in them.
        let _ = register_font("sans-serif", FontStyle::Normal, bytes);
    });
}

/// Writes a chart as SVG.
///
/// # Errors
/// When it cannot be drawn or written.
pub fn svg(chart: &Chart, mut to: impl Write) -> Result<(), DrawError> {
    let mut text = String::new();
    let size = size(chart);
    draw(chart, SVGBackend::with_string(&mut text, size), Scale(1))?;
    Ok(to.write_all(text.as_bytes())?)
}

/// Writes a chart as PNG.
///
/// # Errors
/// When it cannot be drawn or written.
pub fn png(chart: &Chart, to: impl Write) -> Result<(), DrawError> {
    let (width, height) = size(chart);
    let (width, height) = (width * PNG_SCALE, height * PNG_SCALE);
    let mut pixels = vec![0; 3 * width as usize * height as usize];
    let backend = BitMapBackend::with_buffer(&mut pixels, (width, height));
    draw(chart, backend, Scale(PNG_SCALE))?;
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: PNG_DOTS_PER_METRE,
        yppu: PNG_DOTS_PER_METRE,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixels)?;
    Ok(writer.finish()?)
}

/// Width and height of a figure.
fn size(chart: &Chart) -> (u32, u32) {
    match chart {
        Chart::Map(chart) => (WIDTH, map::height(chart, WIDTH)),
        Chart::Plane(_) | Chart::Bars(_) => (WIDTH, HEIGHT),
    }
}

fn draw<DB: DrawingBackend>(chart: &Chart, backend: DB, scale: Scale) -> Result<(), DrawError>
where
    DB::ErrorType: 'static,
{
    register_typeface();
    let root = backend.into_drawing_area();
    let drawn = root.fill(&WHITE).and_then(|()| match chart {
        Chart::Plane(chart) => plane::draw(&root, chart, scale),
        Chart::Map(chart) => map::draw(&root, chart, scale),
        Chart::Bars(chart) => bars(&root, chart, scale),
    });
    drawn
        .and_then(|()| root.present())
        .map_err(|error| DrawError::Drawing(error.into()))
}

/// The least and the greatest of some values with a margin on both sides; [0, 1] without values.
fn padded(values: impl Iterator<Item = f64>) -> std::ops::Range<f64> {
    let (lo, hi) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), x| {
        (lo.min(x), hi.max(x))
    });
    if lo > hi {
        return 0.0..1.0;
    }
    let margin = if hi > lo {
        0.05 * (hi - lo)
    } else {
        0.05 * hi.abs().max(1.0)
    };
    lo - margin..hi + margin
}

/// Share of the space of a group that its bars take.
const GROUP_SHARE: f64 = 0.8;

fn bars<DB: DrawingBackend>(root: &Area<DB>, chart: &BarChart, scale: Scale) -> Drawn<DB> {
    let sizes = chart.groups.iter().flat_map(|(_, sizes)| sizes).map(|x| x.abs());
    let sizes = sizes.filter(|&x| x > 0.0);
    let (least, most) = sizes.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    let (least, most) = if least > most { (0.1, 1.0) } else { (least, most) };
    // Whole powers of ten around the sizes, so that the smallest bar can be seen.
    let floor = 10_f64.powf((least / 1.5).log10().floor());
    let top = most * 2.0;
    let groups = chart.groups.len() as f64;
    let mut context = ChartBuilder::on(root)
        .caption(&chart.title, scale.font(17.0))
        .margin(scale.of(12))
        .x_label_area_size(scale.of(26))
        .y_label_area_size(scale.of(64))
        .build_cartesian_2d(0.0..groups, (floor..top).log_scale())?;
    context
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_desc(&chart.y)
        .axis_style(scale.line(INK, 1))
        .bold_line_style(scale.line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .label_style(scale.font(12.0))
        .axis_desc_style(scale.font(14.0))
        .draw()?;
    let width = GROUP_SHARE / chart.bars.len().max(1) as f64;
    for (b, name) in chart.bars.iter().enumerate() {
        let colour = COLOURS[b % COLOURS.len()];
        let bar = |(g, (_, sizes)): (usize, &(String, Vec<f64>))| {
            let left = g as f64 + (1.0 - GROUP_SHARE) / 2.0 + b as f64 * width;
            let size = sizes.get(b).map_or(floor, |x| x.abs().max(floor));
            Rectangle::new([(left, floor), (left + width * 0.92, size)], colour.filled())
        };
        context
            .draw_series(chart.groups.iter().enumerate().map(bar))?
            .label(name)
            .legend(move |(x, y)| {
                let half = scale.signed(5);
                Rectangle::new([(x, y - half), (x + 2 * half, y + half)], colour.filled())
            });
    }
    plane::legend(&mut context, scale)?;
    let across = context.plotting_area().get_x_axis_pixel_range();
    let (left, right) = (across.start, across.end);
    let bottom = context.plotting_area().get_y_axis_pixel_range().end;
    let centred = plotters::style::text_anchor::Pos::new(
        plotters::style::text_anchor::HPos::Center,
        plotters::style::text_anchor::VPos::Top,
    );
    for (g, (name, _)) in chart.groups.iter().enumerate() {
        let x = left + ((right - left) as f64 * (g as f64 + 0.5) / groups) as i32;
        let style = scale.font(12.0).pos(centred);
        root.draw(&Text::new(name.clone(), (x, bottom + scale.signed(8)), style))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;

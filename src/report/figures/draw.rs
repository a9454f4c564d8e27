//! Charts as SVG with plotters, and as PNG with resvg from the SVG.
//!
//! No system font is read: text is set in Ubuntu Light, which comes with the library. PNG has its
//! shapes; SVG names a generic `sans-serif` and uses its widths.

mod deviations;
mod map;
mod plane;
mod timeline;

use super::{BarChart, Chart, DeviationChart, PlaneChart, TimelineChart};
use crate::keyword::keywords;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg;
use std::io::{self, Write};
use std::sync::{Arc, Once};
use thiserror::Error;

keywords! {
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
    /// Drawing.
    #[error("cannot draw the figure")]
    Drawing(#[from] DrawingAreaErrorKind<io::Error>),
    /// Rasterisation.
    #[error("cannot rasterize the figure")]
    Dots(#[from] usvg::Error),
    /// The picture is larger than memory allows.
    #[error("the figure of {0} by {1} pixels is too large")]
    Size(u32, u32),
    /// Encoding the picture.
    #[error("cannot encode the figure")]
    Encoding(#[from] png::EncodingError),
    /// Writing the figure.
    #[error("cannot write the figure")]
    Write(#[from] io::Error),
}

/// Pixels of a PNG for each unit of a figure: 7.2 inches wide at 300 dots per inch.
const PNG_SCALE: u32 = 3;

/// Plotters draws at integer coordinates; this many per unit keep curves smooth.
const FINE: u32 = 4;

/// Pixels per metre of a PNG: 300 per inch.
const PNG_DOTS_PER_METRE: u32 = 11_811;

/// Width of a figure.
const WIDTH: u32 = 720;

/// Height of a figure other than a map.
const HEIGHT: u32 = 480;

/// Colours that colour-blind readers can distinguish: Okabe and Ito, *Color Universal Design* (2008).
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

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<io::Error>>;

/// A length in drawing coordinates.
const fn fine(units: u32) -> u32 {
    units * FINE
}

/// A signed length in drawing coordinates.
const fn signed(units: i32) -> i32 {
    units * FINE as i32
}

/// A line style of a given width.
fn line(colour: RGBColor, units: u32) -> ShapeStyle {
    colour.stroke_width(fine(units))
}

/// A text style of a given size.
fn font(size: u32) -> TextStyle<'static> {
    ("sans-serif", fine(size)).into_font().color(&INK)
}

/// The typeface used to measure texts.
fn register_typeface() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let bytes = epaint_default_fonts::UBUNTU_LIGHT;
        // It fails only for bytes that are not a font; a test sets text in this one.
        let _ = register_font("sans-serif", FontStyle::Normal, bytes);
    });
}

/// Writes a chart as SVG.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn svg(chart: &Chart, mut to: impl Write) -> Result<(), DrawError> {
    Ok(to.write_all(text(chart)?.as_bytes())?)
}

/// Writes a chart as PNG.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn png(chart: &Chart, to: impl Write) -> Result<(), DrawError> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(epaint_default_fonts::UBUNTU_LIGHT.to_vec());
    fonts.set_sans_serif_family("Ubuntu");
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    };
    let tree = usvg::Tree::from_str(&text(chart)?, &options)?;
    let (width, height) = size(chart);
    let (width, height) = (width * PNG_SCALE, height * PNG_SCALE);
    let mut picture = Pixmap::new(width, height).ok_or(DrawError::Size(width, height))?;
    let scale = PNG_SCALE as f32;
    resvg::render(
        &tree,
        Transform::from_scale(scale, scale),
        &mut picture.as_mut(),
    );
    let mut encoder = png::Encoder::new(to, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: PNG_DOTS_PER_METRE,
        yppu: PNG_DOTS_PER_METRE,
        unit: png::Unit::Meter,
    }));
    // Every figure has an opaque background, so colours are not scaled by opacity.
    let rgb: Vec<u8> = picture
        .data()
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&rgb)?;
    Ok(writer.finish()?)
}

/// Width and height of a figure.
fn size(chart: &Chart) -> (u32, u32) {
    match chart {
        Chart::Map(chart) => (WIDTH, map::height(chart, WIDTH)),
        Chart::Timeline(chart) => (WIDTH, timeline::height(chart)),
        Chart::Deviations(chart) => (WIDTH, deviations::height(chart)),
        Chart::Plane(_) | Chart::Bars(_) => (WIDTH, HEIGHT),
    }
}

fn text(chart: &Chart) -> Result<String, DrawError> {
    register_typeface();
    let mut text = String::new();
    let (width, height) = size(chart);
    {
        let drawn = (fine(width), fine(height));
        let root = SVGBackend::with_string(&mut text, drawn).into_drawing_area();
        root.fill(&WHITE)?;
        match chart {
            Chart::Plane(chart) => plane::draw(&root, chart)?,
            Chart::Map(chart) => map::draw(&root, chart)?,
            Chart::Bars(chart) => bars(&root, chart)?,
            Chart::Timeline(chart) => timeline::draw(&root, chart)?,
            Chart::Deviations(chart) => deviations::draw(&root, chart)?,
        }
        root.present()?;
    }
    let size = |scale: u32| {
        format!(
            "<svg width=\"{}\" height=\"{}\"",
            width * scale,
            height * scale
        )
    };
    Ok(text.replacen(&size(FINE), &size(1), 1))
}

/// Decimals needed to distinguish the ticks of an axis.
fn decimals(range: &std::ops::Range<f64>) -> usize {
    let magnitude = (range.end - range.start).abs().log10().floor();
    (1.0 - magnitude).clamp(0.0, 9.0) as usize
}

/// The range of values with a margin on both sides; [0, 1] without values.
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

/// Fraction of the width of a group that its bars take.
const GROUP_SHARE: f64 = 0.8;

fn bars(root: &Area<'_>, chart: &BarChart) -> Drawn {
    let sizes = chart
        .groups
        .iter()
        .flat_map(|(_, sizes)| sizes)
        .map(|x| x.abs());
    let sizes = sizes.filter(|&x| x > 0.0);
    let (least, most) = sizes.fold((f64::INFINITY, 0.0_f64), |(a, b), x| (a.min(x), b.max(x)));
    let (least, most) = if least > most {
        (0.1, 1.0)
    } else {
        (least, most)
    };
    // Powers of ten around the heights, so that the smallest bar is visible.
    let floor = 10_f64.powf((least / 1.5).log10().floor());
    // Room for the legend above the bars.
    let top = most * 12.0;
    let groups = chart.groups.len() as f64;
    let mut context = ChartBuilder::on(root)
        .caption(&chart.title, font(17))
        .margin(fine(12))
        .x_label_area_size(fine(26))
        .y_label_area_size(fine(64))
        .build_cartesian_2d(0.0..groups, (floor..top).log_scale())?;
    context
        .configure_mesh()
        .disable_x_mesh()
        .x_labels(0)
        .y_desc(&chart.y)
        .y_label_formatter(&|y: &f64| y.to_string())
        .set_all_tick_mark_size(fine(4))
        .axis_style(line(INK, 1))
        .bold_line_style(line(GRID, 1))
        .light_line_style(TRANSPARENT)
        .label_style(font(12))
        .axis_desc_style(font(14))
        .draw()?;
    let width = GROUP_SHARE / chart.bars.len().max(1) as f64;
    for (b, name) in chart.bars.iter().enumerate() {
        let colour = COLOURS[b % COLOURS.len()];
        let bar = |(g, (_, sizes)): (usize, &(String, Vec<f64>))| {
            let left = g as f64 + (1.0 - GROUP_SHARE) / 2.0 + b as f64 * width;
            let size = sizes.get(b).map_or(floor, |x| x.abs().max(floor));
            Rectangle::new(
                [(left, floor), (left + width * 0.92, size)],
                colour.filled(),
            )
        };
        context
            .draw_series(chart.groups.iter().enumerate().map(bar))?
            .label(name)
            .legend(move |(x, y)| {
                Rectangle::new(
                    [
                        (x + signed(4), y - signed(5)),
                        (x + signed(14), y + signed(5)),
                    ],
                    colour.filled(),
                )
            });
    }
    plane::legend(&mut context, SeriesLabelPosition::UpperRight)?;
    let across = context.plotting_area().get_x_axis_pixel_range();
    let (left, right) = (across.start, across.end);
    let bottom = context.plotting_area().get_y_axis_pixel_range().end;
    let centred = plotters::style::text_anchor::Pos::new(
        plotters::style::text_anchor::HPos::Center,
        plotters::style::text_anchor::VPos::Top,
    );
    for (g, (name, _)) in chart.groups.iter().enumerate() {
        let x = left + ((right - left) as f64 * (g as f64 + 0.5) / groups) as i32;
        let style = font(12).pos(centred);
        root.draw(&Text::new(name.clone(), (x, bottom + signed(8)), style))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests;

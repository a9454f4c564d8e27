//! Charts as SVG with plotters, and as PDF and PNG from the SVG.
//!
//! No system font is read: text is set in Arimo, which comes with the library and has the widths of Arial and Helvetica.
//! SVG embeds it, PDF and PNG have its shapes.

mod deviations;
mod frame;
mod heading;
mod map;
mod marks;
mod palette;
mod pdf;
mod plane;
mod projection;
mod rows;
mod ruler;
mod sheet;
mod timeline;
mod typeset;

pub use sheet::{Sheet, SheetError};

use super::Chart;
use crate::keyword::keywords;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::{FontStyle, register_font};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg;
use sheet::POINT;
use std::io::{self, Write};
use std::sync::{Arc, Once};
use thiserror::Error;

keywords! {
    /// The form of a figure's file.
    Form {
        /// Scalable Vector Graphics.
        Svg = "svg",
        /// Portable Document Format: vectors, with the typeface embedded.
        Pdf = "pdf",
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
    /// The sheet is too small for the text.
    #[error(transparent)]
    Sheet(#[from] SheetError),
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

/// Arimo Regular, cut down to the characters of European languages and of formulas.
const TYPEFACE: &[u8] = include_bytes!("../../../data/typeface/arimo.ttf");

/// The same, as browsers read it.
const TYPEFACE_WOFF2: &[u8] = include_bytes!("../../../data/typeface/arimo.woff2");

/// Name of the typeface, and those of equal widths where it is not embedded.
const FAMILIES: &str = "Arimo, Arial, Helvetica, sans-serif";

/// Pixels of a PNG per inch.
const PNG_DOTS_PER_INCH: f64 = 300.0;

/// The same per metre.
const PNG_DOTS_PER_METRE: u32 = 11_811;

/// Pixels per inch of an SVG's size.
const SVG_DOTS_PER_INCH: f64 = 96.0;

const INK: RGBColor = RGBColor(30, 30, 30);
const GRID: RGBColor = RGBColor(222, 222, 222);

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn = Result<(), DrawingAreaErrorKind<io::Error>>;

/// The typeface used to measure texts.
fn register_typeface() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // It fails only for bytes that are not a font; a test sets text in this one.
        let _ = register_font("sans-serif", FontStyle::Normal, TYPEFACE);
    });
}

/// The typeface as a rule of a style sheet.
pub(in crate::report) fn typeface_rule() -> String {
    format!(
        "@font-face{{font-family:Arimo;src:url(data:font/woff2;base64,{})}}",
        STANDARD.encode(TYPEFACE_WOFF2)
    )
}

/// Writes a chart as SVG, with its typeface.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn svg(chart: &Chart, sheet: Sheet, mut to: impl Write) -> Result<(), DrawError> {
    let face = format!("\n<style>{}</style>", typeface_rule());
    let text = text(chart, sheet)?;
    let (open, rest) = text.split_at(text.find('>').map_or(0, |at| at + 1));
    Ok(write!(to, "{open}{face}{rest}")?)
}

/// Writes a chart as SVG for a page, which has the typeface once for all its figures.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn inline_svg(chart: &Chart, sheet: Sheet, mut to: impl Write) -> Result<(), DrawError> {
    Ok(to.write_all(text(chart, sheet)?.as_bytes())?)
}

/// Writes a chart as PDF of one page.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn pdf(chart: &Chart, sheet: Sheet, mut to: impl Write) -> Result<(), DrawError> {
    Ok(to.write_all(&pdf::page(&tree(chart, sheet)?, TYPEFACE)?)?)
}

/// Writes a chart as PNG.
///
/// # Errors
/// If it cannot be drawn or written.
pub fn png(chart: &Chart, sheet: Sheet, to: impl Write) -> Result<(), DrawError> {
    let tree = tree(chart, sheet)?;
    let scale = PNG_DOTS_PER_INCH / SVG_DOTS_PER_INCH;
    let dots = |length: f32| (f64::from(length) * scale).round().max(1.0) as u32;
    let (width, height) = (dots(tree.size().width()), dots(tree.size().height()));
    let mut picture = Pixmap::new(width, height).ok_or(DrawError::Size(width, height))?;
    picture.fill(Color::WHITE);
    let scaled = Transform::from_scale(scale as f32, scale as f32);
    resvg::render(&tree, scaled, &mut picture.as_mut());
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

/// The figure with every text set.
fn tree(chart: &Chart, sheet: Sheet) -> Result<usvg::Tree, DrawError> {
    let mut fonts = usvg::fontdb::Database::new();
    fonts.load_font_data(TYPEFACE.to_vec());
    let options = usvg::Options {
        fontdb: Arc::new(fonts),
        ..usvg::Options::default()
    };
    Ok(usvg::Tree::from_str(&text(chart, sheet)?, &options)?)
}

/// Height of a figure in units of the drawing.
fn height(chart: &Chart, sheet: Sheet) -> u32 {
    match chart {
        Chart::Map(chart) => map::height(chart, sheet),
        Chart::Timeline(chart) => timeline::height(chart, sheet),
        Chart::Deviations(chart) => deviations::height(chart, sheet),
        Chart::Rows(chart) => rows::height(chart, sheet),
        Chart::Plane(chart) => plane::height(chart, sheet),
    }
}

fn text(chart: &Chart, sheet: Sheet) -> Result<String, DrawError> {
    register_typeface();
    let mut text = String::new();
    let (width, height) = (sheet.width(), height(chart, sheet));
    {
        let root = SVGBackend::with_string(&mut text, (width, height)).into_drawing_area();
        root.fill(&WHITE)?;
        match chart {
            Chart::Plane(chart) => plane::draw(&root, chart, sheet)?,
            Chart::Map(chart) => map::draw(&root, chart, sheet)?,
            Chart::Rows(chart) => rows::draw(&root, chart, sheet)?,
            Chart::Timeline(chart) => timeline::draw(&root, chart, sheet)?,
            Chart::Deviations(chart) => deviations::draw(&root, chart, sheet)?,
        }
        root.present()?;
    }
    let points = |length: u32| f64::from(length) / f64::from(POINT);
    let drawn = format!("<svg width=\"{width}\" height=\"{height}\"");
    let printed = format!(
        "<svg width=\"{:.2}pt\" height=\"{:.2}pt\"",
        points(width),
        points(height)
    );
    Ok(typeset::typeset(&text.replacen(&drawn, &printed, 1)))
}

#[cfg(test)]
mod tests;

//! The size of a figure in print.

use super::INK;
use plotters::prelude::*;
use std::ops::RangeInclusive;
use thiserror::Error;

/// Units of the drawing per point: plotters draws at integer coordinates, and these keep curves smooth.
pub(super) const POINT: u32 = 20;

const POINTS_PER_MM: f64 = 72.0 / 25.4;

/// Accepted widths, mm: from a thumbnail to a poster.
const WIDTHS_MM: RangeInclusive<f64> = 40.0..=1200.0;

/// Accepted sizes of text, points.
const FONTS_PT: RangeInclusive<f64> = 4.0..=72.0;

/// Least width of a figure in heights of its text: below it the labels leave no room for data.
const LEAST_WIDTH_EM: f64 = 24.0;

/// Plotters takes the height of a line for its size, and divides by this for SVG.
const LINE_HEIGHT: f64 = 1.24;

/// Why a size is rejected.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SheetError {
    /// A width out of range.
    #[error("width {0} mm is outside {least} to {most} mm", least = WIDTHS_MM.start(), most = WIDTHS_MM.end())]
    Width(f64),
    /// A size of text out of range.
    #[error("font size {0} pt is outside {least} to {most} pt", least = FONTS_PT.start(), most = FONTS_PT.end())]
    Font(f64),
    /// Text too large for the width.
    #[error(
        "a figure {width_mm} mm wide has no room for text of {font_pt} pt: at that size the least width is {least_mm:.0} mm"
    )]
    Room {
        /// The width.
        width_mm: f64,
        /// The size of the text.
        font_pt: f64,
        /// The least width for it.
        least_mm: f64,
    },
}

/// The size of a figure in print, and of its text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sheet {
    width_mm: f64,
    font_pt: f64,
}

impl Default for Sheet {
    /// Two columns of a journal, with its smallest usual text.
    fn default() -> Self {
        Self {
            width_mm: Self::WIDTH_MM,
            font_pt: Self::FONT_PT,
        }
    }
}

impl Sheet {
    /// Width of two columns of a journal, mm.
    pub const WIDTH_MM: f64 = 180.0;

    /// The smallest usual text of journals, points.
    pub const FONT_PT: f64 = 8.0;

    /// A figure of a width with text of a size.
    ///
    /// # Errors
    /// If one is out of range, or the text does not fit.
    pub fn new(width_mm: f64, font_pt: f64) -> Result<Self, SheetError> {
        if !WIDTHS_MM.contains(&width_mm) {
            return Err(SheetError::Width(width_mm));
        }
        if !FONTS_PT.contains(&font_pt) {
            return Err(SheetError::Font(font_pt));
        }
        let least_mm = LEAST_WIDTH_EM * font_pt / POINTS_PER_MM;
        if width_mm < least_mm {
            return Err(SheetError::Room {
                width_mm,
                font_pt,
                least_mm: least_mm.ceil(),
            });
        }
        Ok(Self { width_mm, font_pt })
    }

    /// Width in units of the drawing.
    pub(super) fn width(self) -> u32 {
        (self.width_mm * POINTS_PER_MM * f64::from(POINT)).round() as u32
    }

    /// A length in heights of the text.
    pub(super) fn em(self, ems: f64) -> i32 {
        (ems * self.font_pt * f64::from(POINT)).round() as i32
    }

    /// Text in ink.
    pub(super) fn font(self) -> TextStyle<'static> {
        self.font_of(1.0)
    }

    /// Text of a size relative to the usual one.
    pub(super) fn font_of(self, share: f64) -> TextStyle<'static> {
        let size = share * self.font_pt * f64::from(POINT) * LINE_HEIGHT;
        ("sans-serif", size).into_font().color(&INK)
    }

    /// Width of a text of that relative size, as drawn.
    pub(super) fn text_width(self, text: &str, share: f64) -> i32 {
        // Plotters measures a typeface by the height of its line, which is 1.117 em in Arimo.
        const MEASURED: f64 = 1.117 / LINE_HEIGHT;
        let measured = self.font_of(share).font.box_size(text);
        (f64::from(measured.map_or(0, |(width, _)| width)) * MEASURED) as i32
    }

    /// The text, or its beginning and an ellipsis where it is wider.
    pub(super) fn fitted(self, text: &str, share: f64, most: i32) -> String {
        if self.text_width(text, share) <= most {
            return text.to_owned();
        }
        let ends: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
        let fits = |n: &usize| self.text_width(&format!("{}…", &text[..*n]), share) <= most;
        // Widths grow with the text, so the longest that fits can be bisected.
        let kept = ends.partition_point(fits);
        format!("{}…", &text[..kept.checked_sub(1).map_or(0, |n| ends[n])])
    }
}

/// A line of a width in points.
pub(super) fn line(colour: RGBColor, points: f64) -> ShapeStyle {
    colour.stroke_width((points * f64::from(POINT)).round() as u32)
}

/// A length in points.
pub(super) fn points(length: f64) -> i32 {
    (length * f64::from(POINT)).round() as i32
}

/// A number of millimetres in units of the drawing.
pub(super) fn mm(length: u32) -> u32 {
    (f64::from(length) * POINTS_PER_MM * f64::from(POINT)).round() as u32
}

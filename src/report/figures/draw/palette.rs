//! Colours that colour-blind readers distinguish, and that keep their order in grey.

use crate::report::figures::Better;
use plotters::prelude::*;
use plotters::style::colors::colormaps::ViridisRGB;

/// Colours of lines and marks: Okabe and Ito, *Color Universal Design* (2008).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Dash and gap of lines, points, so that they differ in grey; none for the first.
const DASHES: [Option<(f64, f64)>; 6] = [
    None,
    Some((5.0, 2.0)),
    Some((1.5, 1.5)),
    Some((9.0, 2.5)),
    Some((3.0, 3.0)),
    Some((1.0, 3.0)),
];

pub(super) fn colour(n: usize) -> RGBColor {
    COLOURS[n % COLOURS.len()]
}

pub(super) fn dash(n: usize) -> Option<(f64, f64)> {
    DASHES[n % DASHES.len()]
}

/// The colour at a share of a scale: light where the measure is good, dark where it is bad, whichever end that is.
pub(super) fn shade(share: f64, better: Better) -> RGBColor {
    let good = match better {
        Better::High => share,
        Better::Low => 1.0 - share,
    };
    ViridisRGB::get_color_normalized(good.clamp(0.0, 1.0), 0.0, 1.0)
}

//! How a figure looks, from the arguments.

use crate::cli::args::LookArgs;
use crate::printable::printable;
use crate::report::figures::draw::Sheet;
use crate::report::figures::{AxisChoice, Chart};
use anyhow::{Context, Result, bail};

/// Its size and that of its text.
pub(super) fn sheet(args: &LookArgs) -> Result<Sheet> {
    let sheet = match (args.width_mm, args.font_size) {
        (None, None) => return Ok(Sheet::default()),
        (width_mm, font_pt) => Sheet::new(
            width_mm.unwrap_or(Sheet::WIDTH_MM),
            font_pt.unwrap_or(Sheet::FONT_PT),
        ),
    };
    sheet.context("--width-mm and --font-size")
}

/// The axis of its measure.
pub(super) fn axis(args: &LookArgs) -> Result<AxisChoice> {
    let range = match args.range.as_deref() {
        None => None,
        Some(&[low, high]) if low.is_finite() && high.is_finite() && low < high => {
            Some([low, high])
        }
        Some(given) => {
            let given: Vec<String> = given.iter().map(f64::to_string).collect();
            bail!(
                "--range {}: expected two numbers, the lower first, as in --range 1,3",
                given.join(",")
            );
        }
    };
    if let Some(percentile) = args.clip_percentile
        && !(percentile > 0.0 && percentile <= 100.0)
    {
        bail!("--clip-percentile {percentile}: expected a number above 0 and at most 100");
    }
    Ok(AxisChoice {
        is_log: args.log,
        range,
        clip_percentile: args.clip_percentile,
    })
}

/// Its title and its projection.
pub(super) fn style(args: &LookArgs, chart: &mut Chart) -> Result<()> {
    match args.title.as_deref() {
        None => {}
        Some("none") => chart.title_mut().clear(),
        Some(title) => *chart.title_mut() = printable(title).into_owned(),
    }
    match (args.projection, chart) {
        (None, _) => Ok(()),
        (Some(projection), Chart::Map(chart)) => {
            chart.projection = projection;
            Ok(())
        }
        (Some(_), _) => bail!("--projection is of the figure map"),
    }
}
